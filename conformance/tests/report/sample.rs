//! A report of everything that there can be in one, about pictures whose every value is known.

use std::sync::Arc;

use ambray_compare::document::{
    Axis, Best, Block, Cell, Column, Document, Picture, Plot, Section, Series, Table,
};

pub(crate) const WIDTH: u32 = 320;
pub(crate) const HEIGHT: u32 = 180;

/// A PNG file of pixels by place.
pub(crate) fn png(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 3]) -> Arc<[u8]> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let pixels: Vec<u8> = (0..width * height).flat_map(|i| pixel(i % width, i / width)).collect();
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&pixels).expect("pixels");
    writer.finish().expect("a file");
    file.into()
}

fn picture(name: &str, caption: &str, pixel: impl Fn(u32, u32) -> [u8; 3]) -> Picture {
    let png = png(WIDTH, HEIGHT, pixel);
    Picture { name: name.into(), caption: caption.into(), width: WIDTH, height: HEIGHT, png }
}

/// Value of the truth: tells its column and row.
pub(crate) fn truth(x: u32, y: u32) -> [u8; 3] {
    [(x % 256) as u8, y as u8, 40]
}

/// Value of the picture with a pattern.
pub(crate) fn pattern(x: u32, y: u32) -> [u8; 3] {
    let [r, g, b] = truth(x, y);
    if (x / 4 + y / 4).is_multiple_of(2) { [r, g, b + 100] } else { [r, g, b] }
}

pub(crate) fn pictures() -> Vec<Picture> {
    vec![
        picture("Truth", "4096 rays a pixel; standard error under 0.001.", truth),
        picture("Interleaved, 8 rays", "Before the filter: a pattern of 4 × 4 pixels.", pattern),
        picture("SSAO <hemisphere>", "Darkens what \"only\" seems near & is not.", |x, y| {
            [90, truth(x, y)[1], 200]
        }),
        picture("GTAO", "XeGTAO's defaults.", |x, y| [truth(x, y)[0], 128, 128]),
    ]
}

fn methods() -> Table {
    let column =
        |title: &str, meaning: &str, best| Column { title: title.into(), meaning: meaning.into(), best };
    let row = |name: &str, rays: f64, rmse: f64, psnr: f64, bias: f64, time: Option<f64>| {
        vec![
            Cell::Text(name.into()),
            Cell::Number(rays, 0),
            Cell::Number(rmse, 4),
            Cell::Number(psnr, 1),
            Cell::Number(bias, 4),
            time.map_or(Cell::Empty, |time| Cell::Number(time, 1)),
        ]
    };
    Table {
        caption: "Errors of openness in the nave, 640 × 360".into(),
        columns: vec![
            column("Method", "", Best::None),
            column(
                "Rays per pixel",
                "Rays of the ambient pass; screen-space methods trace none.",
                Best::None,
            ),
            column("RMSE", "Root mean square of the difference from the truth.", Best::Smallest),
            column("PSNR, dB", "Peak signal-to-noise ratio for a peak of 1.", Best::Largest),
            column("Bias", "Mean signed difference from the truth.", Best::NearestZero),
            column("Time, ms", "Median of a frame.", Best::Smallest),
        ],
        rows: vec![
            row("Truth", 4096.0, 0.0, f64::INFINITY, 0.0, None),
            row("Ambray, 8 rays", 8.0, 0.0251, 32.0, -0.0012, Some(41.3)),
            row("Random, 8 rays", 8.0, 0.0612, 24.3, 0.0007, Some(44.9)),
            row("SSAO", 0.0, 0.1834, 14.7, -0.1021, Some(9.8)),
            row("GTAO", 0.0, 0.0977, 20.2, -0.0410, Some(12.6)),
            row("Bitmask", 0.0, 0.0803, 21.9, 0.0233, Some(17.2)),
        ],
    }
}

fn plot() -> Plot {
    let series = |name: &str, points: &[(f64, f64)]| Series {
        name: name.into(),
        points: points.to_vec(),
        labels: points.iter().map(|(x, _)| format!("{x} rays")).collect(),
    };
    Plot {
        caption: "Error against rays per pixel".into(),
        x: Axis { title: "rays per pixel".into(), logarithmic: true },
        y: Axis { title: "RMSE of openness".into(), logarithmic: true },
        series: vec![
            series(
                "Ambray",
                &[(1.0, 0.09), (2.0, 0.061), (4.0, 0.037), (8.0, 0.025), (16.0, 0.018), (32.0, 0.013)],
            ),
            series(
                "Random",
                &[(1.0, 0.31), (2.0, 0.21), (4.0, 0.14), (8.0, 0.1), (16.0, 0.07), (32.0, 0.05)],
            ),
            series("One set for all", &[(1.0, 0.4), (4.0, 0.2), (8.0, 0.13), (32.0, 0.06)]),
            series("Hybrid <after Bavoil et al. 2018>", &[(1.3, 0.08)]),
            series("Step falloff", &[(8.0, 0.2), (16.0, 0.19)]),
            series("SSAO", &[(0.0, 0.18)]),
        ],
    }
}

fn times() -> Plot {
    let names = ["Ambray", "Random", "SSAO", "HBAO", "GTAO", "Bitmask", "Hybrid", "Step", "One set"];
    let point = |i: usize| (9.0 + 7.0 * i as f64, 0.02 + 0.03 * ((i * 5) % 9) as f64);
    let series = |(i, name): (usize, &&str)| Series {
        name: (*name).into(),
        points: vec![point(i)],
        labels: vec!["nave".into()],
    };
    Plot {
        caption: "Error against time".into(),
        x: Axis { title: "time, ms".into(), logarithmic: false },
        y: Axis { title: "RMSE of openness".into(), logarithmic: false },
        series: names.iter().enumerate().map(series).collect(),
    }
}

/// The sample.
pub(crate) fn document() -> Document {
    let all = pictures();
    let section = |title: &str, blocks| Section { title: title.into(), blocks };
    let finding = |claim: &str, measured: &str, holds| Block::Finding {
        claim: claim.into(),
        measured: measured.into(),
        holds,
    };
    Document {
        title: "Ambray against the truth: atrium".into(),
        summary: "What each part of the method buys, and what screen-space methods miss.".into(),
        facts: [
            ("Scene", "atrium"),
            ("Size", "320 × 180"),
            ("Radius", "1.0"),
            ("Command", "ambray compare atrium"),
        ]
        .map(|(name, value)| (name.into(), value.into()))
        .into(),
        sections: vec![
            section(
                "Pictures",
                vec![
                    Block::Text("Text with <script>alert('no')</script> & \"quotes\".".into()),
                    Block::Slider {
                        caption: "The nave from above".into(),
                        pictures: all.clone(),
                        left: 0,
                        right: 1,
                    },
                    finding("Eight rays a pixel are enough.", "RMSE 0.0251, PSNR 32.0 dB.", true),
                ],
            ),
            section(
                "Errors and times",
                vec![
                    Block::Table(methods()),
                    Block::Plot(plot()),
                    Block::Plot(times()),
                    finding(
                        "Filtered pictures show no pattern.",
                        "21 times the noise around it at (1/4, 0).",
                        false,
                    ),
                ],
            ),
            section("Errors and times", vec![Block::Plot(Plot::default())]),
            section(
                "Figure 2",
                vec![
                    Block::Gallery {
                        caption: "Same set, interleaved, filtered".into(),
                        pictures: all[..3].to_vec(),
                        columns: 3,
                    },
                    Block::Command("ambray compare atrium --paper --output report.html".into()),
                ],
            ),
        ],
    }
}
