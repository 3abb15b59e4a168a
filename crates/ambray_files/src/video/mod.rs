//! Videos: GIF by a library, everything else by an installed ffmpeg.

mod ffmpeg;
mod gif;

use std::{path::Path, sync::atomic::AtomicBool};

use ambray::{Aov, Frame, display, settings::Settings, settings::Size};
use anyhow::{anyhow, bail};

use crate::{Rate, atomic::Pending, problem::with_hint};

/// Kind of a video file, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// GIF with a palette of 256 colours for each frame, which repeats for ever.
    Gif,
    /// H.264 in MP4.
    Mp4,
    /// VP9 in WebM.
    Webm,
    /// Animated WebP, which repeats for ever.
    Webp,
}

impl Kind {
    /// The kind that the extension of `path` names.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "gif" => Some(Self::Gif),
            "mp4" => Some(Self::Mp4),
            "webm" => Some(Self::Webm),
            "webp" => Some(Self::Webp),
            _ => None,
        }
    }

    /// Finds out before the work whether such a video can be made.
    pub fn check(self, size: Size, rate: Rate) -> anyhow::Result<()> {
        if self == Self::Gif {
            return gif::check(rate);
        }
        if self == Self::Mp4 && !(size.width.is_multiple_of(2) && size.height.is_multiple_of(2)) {
            let even =
                Size { width: size.width.next_multiple_of(2), height: size.height.next_multiple_of(2) };
            let error = anyhow!("--size {size} is not allowed here: H.264 in MP4 needs even sides");
            return Err(with_hint(error, format!("--size {even}, or a .webm")));
        }
        if !ffmpeg::is_installed() {
            let error = anyhow!("ffmpeg is not installed, and it makes all videos but GIF");
            return Err(with_hint(
                error,
                "install ffmpeg, or write a .gif, or numbered pictures such as out_####.png",
            ));
        }
        Ok(())
    }

    /// Begins a video in the file `pending`; the flag `cancel` ends waits for other programs.
    pub fn begin<'a>(
        self,
        pending: &'a Pending,
        size: Size,
        rate: Rate,
        cancel: &'a AtomicBool,
    ) -> anyhow::Result<Box<dyn Encode + 'a>> {
        Ok(match self {
            Self::Gif => Box::new(gif::Gif::new(pending.file(), size, rate)?),
            _ => Box::new(ffmpeg::Ffmpeg::start(self, pending.path(), size, rate, cancel)?),
        })
    }
}

/// A video that is being made. What is dropped before its end leaves nothing running.
pub trait Encode {
    /// Adds a frame: red, green and blue of all pixels, row by row from the top.
    fn frame(&mut self, rgb: &[u8]) -> anyhow::Result<()>;
    /// Ends it.
    fn finish(self: Box<Self>) -> anyhow::Result<()>;
}

/// The picture of `frame` as 8-bit RGB, as PNG would have it.
pub fn pixels(frame: &Frame, settings: &Settings) -> anyhow::Result<Vec<u8>> {
    let rgb = display::show(frame, Aov::Beauty, settings).eight_bit();
    if rgb.len() != 3 * frame.beauty.len() {
        bail!("the picture has no colours");
    }
    Ok(rgb)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_names_the_kind() {
        let kind = |path: &str| Kind::of(Path::new(path));
        assert_eq!([kind("a.gif"), kind("d/a.MP4")], [Some(Kind::Gif), Some(Kind::Mp4)]);
        assert_eq!([kind("a.webm"), kind("a.webp")], [Some(Kind::Webm), Some(Kind::Webp)]);
        assert_eq!([kind("a.png"), kind("gif"), kind("-")], [None; 3]);
    }

    #[test]
    fn odd_sides_do_not_fit_mp4() {
        let size = Size { width: 641, height: 360 };
        let error = Kind::Mp4.check(size, Rate::default()).unwrap_err();
        assert!(error.to_string().contains("needs even sides"), "{error}");
        assert!(Kind::Gif.check(size, Rate::default()).is_ok());
    }
}
