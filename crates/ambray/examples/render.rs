//! Renders the built-in scene through the library and writes `example.png`: the shortest way to a picture.
//!
//! `cargo run --release -p ambray --example render`

use ambray::{Aov, Control, Renderer, scene::atrium, settings::Settings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut renderer = Renderer::new(atrium::atrium());
    let progress = |share: f32| eprint!("\r{:3.0} %", 100.0 * share);
    let control = Control { progress: &progress, ..Control::default() };
    let frame = renderer.render(&Settings::default(), control)?;

    let rays = frame.stats.rays.total() as f64;
    let seconds = frame.stats.times.total.as_secs_f64();
    eprintln!("\r{rays} rays in {seconds:.2} s: {:.1} million a second", rays / seconds / 1e6);

    // Linear radiance to sRGB, highlights clipped; the program has a tone map as well.
    let beauty = frame.plane(Aov::Beauty);
    let bytes = beauty.iter().map(|&v| (255.0 * srgb(v)).round() as u8).collect();
    let picture =
        image::RgbImage::from_raw(frame.width, frame.height, bytes).ok_or("a picture of three channels")?;
    picture.save("example.png")?;
    Ok(())
}

fn srgb(linear: f32) -> f32 {
    let v = linear.clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}
