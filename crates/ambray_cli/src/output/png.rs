//! PNG files with 8 or 16 bits a channel. The same picture gives the same bytes: plain rounding, no dither, no date.

use std::io::Write;

use glam::Vec3;
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

use super::false_colour::Picture;

/// Bits of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bits {
    /// 8 bits.
    Eight,
    /// 16 bits.
    Sixteen,
}

/// Writes `picture` with `texts` as keyword and text.
pub fn write(
    output: impl Write,
    (width, height): (u32, u32),
    picture: &Picture,
    bits: Bits,
    texts: &[(&str, &str)],
) -> anyhow::Result<()> {
    let mut encoder = Encoder::new(output, width, height);
    encoder.set_compression(Compression::Fast); // a tenth of the time for files a little larger
    encoder.set_depth(match bits {
        Bits::Eight => BitDepth::Eight,
        Bits::Sixteen => BitDepth::Sixteen,
    });
    match picture {
        Picture::Grey(_) => encoder.set_color(ColorType::Grayscale),
        Picture::Rgb { is_color, .. } => {
            encoder.set_color(ColorType::Rgb);
            if *is_color {
                encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
            }
        }
    }
    for (keyword, text) in texts {
        encoder.add_itxt_chunk((*keyword).to_owned(), (*text).to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&samples(picture, bits))?;
    Ok(writer.finish()?)
}

/// The values of `picture` as bytes, row by row from the top, most significant byte first.
pub(super) fn samples(picture: &Picture, bits: Bits) -> Vec<u8> {
    match picture {
        Picture::Grey(values) => quantize(values.iter().copied(), bits),
        Picture::Rgb { pixels, .. } => {
            quantize(pixels.iter().flat_map(|pixel: &Vec3| pixel.to_array()), bits)
        }
    }
}

fn quantize(values: impl Iterator<Item = f32>, bits: Bits) -> Vec<u8> {
    // The casts saturate, and NaN becomes 0.
    match bits {
        Bits::Eight => values.map(|v| (v * 255.0 + 0.5) as u8).collect(),
        Bits::Sixteen => values.flat_map(|v| ((v * 65535.0 + 0.5) as u16).to_be_bytes()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_round_to_the_nearest() {
        let values = [0.0, 1.0, 0.5, 0.499 / 255.0, 0.501 / 255.0, -3.0, 7.0, f32::NAN];
        assert_eq!(quantize(values.into_iter(), Bits::Eight), [0, 255, 128, 0, 1, 0, 255, 0]);
        assert_eq!(quantize([0.5, 1.0].into_iter(), Bits::Sixteen), [0x80, 0x00, 0xFF, 0xFF]);
    }
}
