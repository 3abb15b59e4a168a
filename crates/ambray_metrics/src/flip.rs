//! FLIP, the difference that people see when two pictures alternate (Andersson et al. 2020), by NVIDIA's implementation.
//!
//! Values are display values in sRGB from 0 to 1, clipped, and rounded to the 8 bits that a screen shows: what differs by
//! less counts as equal.

use crate::Map;

/// Pixels a degree of the viewer's sight: a screen of 3840 pixels and 0.7 m at 0.7 m, FLIP's own default.
pub const PIXELS_PER_DEGREE: f32 = 67.0;

/// Mean FLIP error of the maps shown as grey, in `[0, 1]`; 0 is best.
#[must_use]
pub fn flip(reference: &Map, test: &Map) -> f64 {
    flip_map(reference, test).mean()
}

/// Mean FLIP error of pictures in red, green and blue, in `[0, 1]`; 0 is best.
#[must_use]
pub fn flip_rgb(reference: &[Map; 3], test: &[Map; 3]) -> f64 {
    flip_rgb_map(reference, test).mean()
}

/// FLIP error of every pixel of the maps shown as grey.
#[must_use]
pub fn flip_map(reference: &Map, test: &Map) -> Map {
    errors([reference; 3], [test; 3])
}

/// FLIP error of every pixel of pictures in red, green and blue.
#[must_use]
pub fn flip_rgb_map(reference: &[Map; 3], test: &[Map; 3]) -> Map {
    errors(reference.each_ref(), test.each_ref())
}

fn errors(reference: [&Map; 3], test: [&Map; 3]) -> Map {
    for map in reference.iter().chain(&test) {
        map.check_size(reference[0]);
    }
    let error = nv_flip::flip(image(reference), image(test), PIXELS_PER_DEGREE);
    Map { width: reference[0].width, values: error.to_vec() }
}

fn image([red, green, blue]: [&Map; 3]) -> nv_flip::FlipImageRgb8 {
    let byte = |v: f32| (v * 255.0 + 0.5) as u8; // as `display::Picture` rounds; the cast clips
    let pixels = red.values.iter().zip(&green.values).zip(&blue.values);
    let bytes: Vec<u8> = pixels.flat_map(|((&r, &g), &b)| [r, g, b].map(byte)).collect();
    nv_flip::FlipImageRgb8::with_data(red.width as u32, red.height() as u32, &bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: f32) -> Map {
        Map { width: 64, values: vec![value; 64 * 48] }
    }

    #[test]
    fn equal_maps_have_no_error_and_black_on_white_has_nearly_all() {
        assert_eq!(flip(&flat(0.5), &flat(0.5)), 0.0);
        assert_eq!(flip(&flat(0.5), &flat(0.5 + 1e-4)), 0.0, "both are the byte 128");
        let most = flip(&flat(0.0), &flat(1.0));
        assert!((0.9..=1.0).contains(&most), "{most}");
    }

    #[test]
    fn colours_count() {
        let grey = [0.5; 3].map(flat);
        let tinted = [0.5, 0.4, 0.5].map(flat);
        assert!(flip_rgb(&grey, &tinted) > 0.05);
        assert_eq!(flip_rgb(&grey, &grey), flip(&grey[0], &grey[0]));
    }
}
