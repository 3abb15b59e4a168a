//! Pictures of maps and frames for documents.

use std::{io::Cursor, sync::Arc};

use ambray::{Aov, Frame, display, settings::Settings};
use ambray_metrics::Map;

use crate::document::Picture;

/// `map` as grey: 0 black, 1 white.
#[must_use]
pub fn grey(name: impl Into<String>, caption: impl Into<String>, map: &Map) -> Picture {
    let bytes: Vec<u8> =
        map.values.iter().map(|value| (value.clamp(0.0, 1.0) * 255.0).round() as u8).collect();
    picture(name.into(), caption.into(), map.width, png::ColorType::Grayscale, &bytes)
}

/// Signed error of `estimate`: blue where it is darker than `truth`, red where it is brighter, full colour at `scale`.
#[must_use]
pub fn error(
    name: impl Into<String>,
    caption: impl Into<String>,
    estimate: &Map,
    truth: &Map,
    scale: f32,
) -> Picture {
    let errors =
        estimate.values.iter().zip(&truth.values).map(|(estimate, truth)| (estimate - truth) / scale);
    let bytes: Vec<u8> = errors.flat_map(signed).collect();
    picture(name.into(), caption.into(), truth.width, png::ColorType::Rgb, &bytes)
}

/// The colour of a signed value from -1 (blue) over 0 (white) to 1 (red).
fn signed(value: f32) -> [u8; 3] {
    let colour = colorous::RED_BLUE.eval_continuous(f64::from(0.5 - 0.5 * value.clamp(-1.0, 1.0)));
    [colour.r, colour.g, colour.b]
}

/// The plane `aov` of `frame` as `ambray render` shows it.
#[must_use]
pub fn shown(
    name: impl Into<String>,
    caption: impl Into<String>,
    frame: &Frame,
    aov: Aov,
    settings: &Settings,
) -> Picture {
    let rgba = display::show(frame, aov, settings).rgba8();
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    picture(name.into(), caption.into(), frame.width as usize, png::ColorType::Rgb, &rgb)
}

fn picture(name: String, caption: String, width: usize, color: png::ColorType, bytes: &[u8]) -> Picture {
    let height = bytes.len() / (width * color.samples());
    let mut file = Cursor::new(Vec::new());
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().expect("memory takes everything");
    writer.write_image_data(bytes).expect("as many bytes as the header says");
    writer.finish().expect("memory takes everything");
    Picture {
        name,
        caption,
        width: width as u32,
        height: height as u32,
        png: Arc::from(file.into_inner().into_boxed_slice()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(picture: &Picture) -> Vec<u8> {
        let mut reader = png::Decoder::new(Cursor::new(&picture.png[..])).read_info().expect("a PNG file");
        let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut bytes).expect("a picture");
        bytes
    }

    #[test]
    fn values_are_shown_as_they_are() {
        let map = Map { width: 2, values: vec![0.0, 0.5, 1.0, 2.0] };
        let picture = grey("a", "b", &map);
        assert_eq!((picture.width, picture.height), (2, 2));
        assert_eq!(pixels(&picture), [0, 128, 255, 255]);
    }

    #[test]
    fn errors_are_blue_where_it_is_too_dark_and_red_where_it_is_too_bright() {
        let truth = Map { width: 3, values: vec![0.5; 3] };
        let estimate = Map { width: 3, values: vec![0.3, 0.5, 0.7] };
        let bytes = pixels(&error("a", "b", &estimate, &truth, 0.2));
        let (dark, same, bright) = (&bytes[..3], &bytes[3..6], &bytes[6..]);
        assert!(dark[2] > 2 * dark[0], "{dark:?}");
        assert!(same.iter().all(|&v| v > 235), "{same:?}");
        assert!(bright[0] > 2 * bright[2], "{bright:?}");
    }
}
