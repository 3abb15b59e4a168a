//! PNG files with 8 or 16 bits a channel. The same picture gives the same bytes: plain rounding, no dither, no date.

use std::io::Write;

use ambray::display::Picture;
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

/// Bits of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bits {
    /// 8 bits.
    Eight,
    /// 16 bits.
    Sixteen,
}

/// Writes `picture` with `texts` as keyword and text.
pub(crate) fn write(
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
