//! Display values, and their rounding to bytes: the one place where it is decided.

use glam::Vec3;

/// Display values in `[0, 1]`, pixels row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// One value a pixel.
    Grey(Vec<f32>),
    /// Red, green and blue; whether they stand for colours in sRGB rather than for plain numbers.
    Rgb {
        /// Values of the pixels.
        pixels: Vec<Vec3>,
        /// Whether they are colours.
        is_color: bool,
    },
}

impl Picture {
    /// The values of all channels, one or three a pixel.
    fn values(&self) -> Box<dyn Iterator<Item = f32> + '_> {
        match self {
            Self::Grey(values) => Box::new(values.iter().copied()),
            Self::Rgb { pixels, .. } => Box::new(pixels.iter().flat_map(Vec3::to_array)),
        }
    }

    /// The values of all channels in 8 bits, one or three bytes a pixel.
    #[must_use]
    pub fn eight_bit(&self) -> Vec<u8> {
        self.values().map(eight_bit).collect()
    }

    /// The values of all channels in 16 bits, most significant byte first.
    #[must_use]
    pub fn sixteen_bit(&self) -> Vec<u8> {
        self.values().flat_map(|value| ((value * 65535.0 + 0.5) as u16).to_be_bytes()).collect()
    }

    /// Red, green, blue and alpha 255 of all pixels in 8 bits: the bytes that an 8-bit PNG shows.
    #[must_use]
    pub fn rgba8(&self) -> Vec<u8> {
        let pixel = |[r, g, b]: [f32; 3]| [eight_bit(r), eight_bit(g), eight_bit(b), u8::MAX];
        match self {
            Self::Grey(values) => values.iter().flat_map(|&value| pixel([value; 3])).collect(),
            Self::Rgb { pixels, .. } => pixels.iter().flat_map(|v| pixel(v.to_array())).collect(),
        }
    }
}

/// Plain rounding without dither, so that the same picture gives the same bytes. Casts saturate, and NaN becomes 0.
pub(super) fn eight_bit(value: f32) -> u8 {
    (value * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_round_to_the_nearest() {
        let values = vec![0.0, 1.0, 0.5, 0.499 / 255.0, 0.501 / 255.0, -3.0, 7.0, f32::NAN];
        assert_eq!(Picture::Grey(values).eight_bit(), [0, 255, 128, 0, 1, 0, 255, 0]);
        assert_eq!(Picture::Grey(vec![0.5, 1.0]).sixteen_bit(), [0x80, 0x00, 0xFF, 0xFF]);
    }

    #[test]
    fn windows_show_the_bytes_of_the_file() {
        let grey = Picture::Grey(vec![0.2, f32::NAN]);
        assert_eq!(grey.eight_bit(), [51, 0]);
        assert_eq!(grey.rgba8(), [51, 51, 51, 255, 0, 0, 0, 255]);
        let pixels = vec![Vec3::new(0.2, 0.4, 2.0), Vec3::new(-1.0, 1.0, 0.6)];
        let rgb = Picture::Rgb { pixels, is_color: true };
        assert_eq!(rgb.eight_bit(), [51, 102, 255, 0, 255, 153]);
        assert_eq!(rgb.rgba8(), [51, 102, 255, 255, 0, 255, 153, 255]);
    }
}
