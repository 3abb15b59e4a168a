//! GIF files. Each frame has a palette of its own, chosen by the library's neural network, without dither.

use std::{
    fs::File,
    io::{BufWriter, Write as _},
};

use ::gif::{Encoder, Frame, Repeat};
use ambray::settings::Size;
use anyhow::{Context as _, bail};

use super::Encode;
use crate::Rate;

/// Effort of choosing colours, 1 best to 30 fastest, as the library has it by default for whole videos.
const SPEED: i32 = 10;

/// A GIF file that is being made.
pub(super) struct Gif<'a> {
    encoder: Encoder<BufWriter<&'a File>>,
    width: u16,
    height: u16,
    rate: Rate,
    frames: u32,
}

/// Refuses rates that GIF cannot show.
pub(super) fn check(rate: Rate) -> anyhow::Result<()> {
    // Viewers take delays below two hundredths of a second for mistakes, and show ten.
    if !(0.002..=50.0).contains(&rate.per_second()) {
        bail!("--fps {rate} is not allowed here: GIF shows 0.002 to 50 frames a second");
    }
    Ok(())
}

/// When frame `number` begins, hundredths of a second.
///
/// GIF counts time in them. Rounding the beginnings, not the durations, keeps the whole as long as it should be: at 30
/// frames a second, frames last 3, 4 and 3 of them in turn.
fn begins(number: u32, rate: Rate) -> u64 {
    (rate.time(number) * 100.0).round() as u64
}

impl<'a> Gif<'a> {
    pub(super) fn new(file: &'a File, size: Size, rate: Rate) -> anyhow::Result<Self> {
        let side = |pixels: u32| u16::try_from(pixels).context("GIF has at most 65535 pixels a side");
        let (width, height) = (side(size.width)?, side(size.height)?);
        let mut encoder = Encoder::new(BufWriter::new(file), width, height, &[])?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self { encoder, width, height, rate, frames: 0 })
    }
}

impl Encode for Gif<'_> {
    fn frame(&mut self, rgb: &[u8]) -> anyhow::Result<()> {
        let mut frame = Frame::from_rgb_speed(self.width, self.height, rgb, SPEED);
        let lasts = begins(self.frames + 1, self.rate) - begins(self.frames, self.rate);
        frame.delay = u16::try_from(lasts).unwrap_or(u16::MAX);
        self.frames += 1;
        Ok(self.encoder.write_frame(&frame)?)
    }

    fn finish(self: Box<Self>) -> anyhow::Result<()> {
        Ok(self.encoder.into_inner()?.flush()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_lasts_as_long_as_it_should() {
        let delays = |rate: &str, count| {
            let rate = rate.parse().unwrap();
            (0..count).map(|i| begins(i + 1, rate) - begins(i, rate)).collect::<Vec<_>>()
        };
        assert_eq!(delays("30", 6), [3, 4, 3, 3, 4, 3]);
        assert_eq!(delays("25", 3), [4, 4, 4]);
        assert_eq!(delays("30", 300).iter().sum::<u64>(), 1000);
        assert_eq!(delays("23.976", 23_976).iter().sum::<u64>(), 100_000);
        assert!(delays("50", 100).iter().all(|&delay| delay == 2));
    }

    #[test]
    fn rates_that_viewers_do_not_show_are_refused() {
        assert!(check("50".parse().unwrap()).is_ok());
        assert!(check("60".parse().unwrap()).unwrap_err().to_string().starts_with("--fps 60 is not allowed"));
        assert!(check("0.001".parse().unwrap()).is_err());
    }
}
