//! PNG files with 8 or 16 bits a channel. The same picture gives the same bytes: plain rounding, no dither, no date.

use std::io::Write;

use ambray::display::Picture;
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

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
    writer.write_image_data(&match bits {
        Bits::Eight => picture.eight_bit(),
        Bits::Sixteen => picture.sixteen_bit(),
    })?;
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use ambray::{display, settings::Ramp};

    use super::*;

    fn decoded(picture: &Picture, bits: Bits) -> (ColorType, Vec<u8>) {
        let mut file = Vec::new();
        write(&mut file, (3, 1), picture, bits, &[]).unwrap();
        let mut reader = png::Decoder::new(Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        (info.color_type, bytes)
    }

    #[test]
    fn files_hold_the_bytes_that_windows_show() {
        let grey = Picture::Grey(vec![0.0, 0.3, 1.0]);
        let (color, bytes) = decoded(&grey, Bits::Eight);
        let shown: Vec<_> = bytes.iter().flat_map(|&v| [v, v, v, 255]).collect();
        assert_eq!((color, shown), (ColorType::Grayscale, grey.rgba8()));
        assert_eq!(decoded(&grey, Bits::Sixteen), (ColorType::Grayscale, vec![0, 0, 0x4C, 0xCD, 255, 255]));

        let pixels = [0.0, 0.3, 1.0].map(|t| display::shade(Ramp::Turbo, t)).to_vec();
        let coloured = Picture::Rgb { pixels, is_color: true };
        let (color, bytes) = decoded(&coloured, Bits::Eight);
        let shown: Vec<_> = bytes.chunks_exact(3).flat_map(|v| [v[0], v[1], v[2], 255]).collect();
        assert_eq!((color, shown), (ColorType::Rgb, coloured.rgba8()));
    }
}
