//! The window's icon: a ball on a floor, darker where they meet.

use winit::window::Icon;

/// Pixels on a side.
const SIDE: u32 = 64;
/// Radius of the ball, sides of the icon.
const RADIUS: f32 = 0.3;
/// Centre of the ball; it touches the floor below.
const CENTRE: (f32, f32) = (0.5, 0.46);

/// The icon.
pub(super) fn icon() -> Option<Icon> {
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    let rgba = pixels.flat_map(|(x, y)| {
        let at = |i: u32| (i as f32 + 0.5) / SIDE as f32;
        pixel(at(x), at(y))
    });
    Icon::from_rgba(rgba.collect(), SIDE, SIDE).ok()
}

/// Colour at a place of the icon, both from 0 to 1, y down.
fn pixel(x: f32, y: f32) -> [u8; 4] {
    let (dx, dy) = (x - CENTRE.0, y - CENTRE.1);
    let r2 = (dx * dx + dy * dy) / (RADIUS * RADIUS);
    let (light, tint) = if r2 <= 1.0 {
        // Openness of a ball on a floor by the height of its normal: (1 + cos θ)/2.
        let up = -dy / RADIUS;
        (0.35 + 0.65 * (0.5 + 0.5 * up), [1.0, 0.86, 0.66])
    } else {
        // Openness of the floor falls towards the ball's shadow.
        let floor = CENTRE.1 + RADIUS;
        let (u, v) = (dx / 0.42, (y - floor) / 0.12);
        let shadow = 1.0 / (1.0 + 3.0 * (u * u + v * v));
        if y > floor - 0.12 { (0.75 * (1.0 - shadow), [0.8, 0.86, 1.0]) } else { (0.16, [0.8, 0.86, 1.0]) }
    };
    let byte = |tint: f32| (255.0 * (light * tint).clamp(0.0, 1.0)) as u8;
    [byte(tint[0]), byte(tint[1]), byte(tint[2]), 255]
}
