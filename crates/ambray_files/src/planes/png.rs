//! PNG files of any kind as display values.

use std::{fs::File, io::BufReader};

use anyhow::Context as _;
use png::{BitDepth, Decoder, Transformations};

use super::{Layer, Meaning, Planes, check_size};
use crate::head::Head;

/// Reads a PNG file: the picture as grey or red, green and blue, the alpha channel as a layer of its own.
pub(super) fn read(file: File, head: Head) -> anyhow::Result<Planes> {
    let file_size = file.metadata()?.len();
    let mut decoder = Decoder::new(BufReader::new(file));
    // Palettes become colours, and less than 8 bits 8; the decoder keeps its own limit of 64 MiB besides the pixels.
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let (color, depth) = reader.output_color_type();
    let size = (reader.info().width as usize, reader.info().height as usize);
    let samples = color.samples();
    check_size(size, samples, reader.info().bits_per_pixel() as u64, file_size)?;
    let mut bytes = vec![0; reader.output_buffer_size().context("the picture is too large")?];
    let frame = reader.next_frame(&mut bytes)?;
    // What follows the pixels is read too, so that a file that was cut short is noticed.
    reader.finish()?;
    bytes.truncate(frame.buffer_size());
    let values = |channel: usize| -> Vec<f32> {
        if depth == BitDepth::Sixteen {
            let pixels = bytes.chunks_exact(2 * samples);
            let value = |pixel: &[u8]| u16::from_be_bytes([pixel[2 * channel], pixel[2 * channel + 1]]);
            pixels.map(|pixel| f32::from(value(pixel)) / 65535.0).collect()
        } else {
            bytes.chunks_exact(samples).map(|pixel| f32::from(pixel[channel]) / 255.0).collect()
        }
    };
    let layer = |name: &str, meaning: Meaning, channels: &[&str], first: usize| Layer {
        name: name.to_owned(),
        channels: channels.iter().map(|&channel| channel.to_owned()).collect(),
        meaning,
        values: (first..first + channels.len()).map(values).collect(),
    };
    let colors: &[&str] = if samples < 3 { &["Y"] } else { &["R", "G", "B"] };
    let mut layers = vec![layer("picture", Meaning::Shown, colors, 0)];
    if samples > colors.len() {
        layers.push(layer("alpha", Meaning::Unit, &["A"], colors.len()));
    }
    Ok(Planes { head, width: size.0, height: size.1, layers })
}
