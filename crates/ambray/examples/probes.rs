//! Evaluates ambient light at points instead of pixels: openness along a line over the floor of the built-in scene.
//!
//! `cargo run --release -p ambray --example probes`

use ambray::{
    Control, QueryPoint, Renderer,
    scene::atrium,
    settings::{Auto, Settings},
};
use glam::Vec3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut renderer = Renderer::new(atrium::atrium());
    let settings = Settings { spp: 256, radius: Auto::Value(1.0), ..Settings::default() };
    let at = |i: u16| Vec3::new(-6.0 + 0.5 * f32::from(i), 0.05, 0.0);
    let points: Vec<_> = (0..25).map(|i| QueryPoint { position: at(i), normal: Vec3::Y, class: 0 }).collect();
    println!("     x  openness  near radiance");
    for (point, result) in points.iter().zip(renderer.query(&settings, &points, Control::default())?) {
        let near = result.near_radiance;
        println!(
            "{:6.2}  {:8.4}  {:.4} {:.4} {:.4}",
            point.position.x, result.openness, near.x, near.y, near.z
        );
    }
    Ok(())
}
