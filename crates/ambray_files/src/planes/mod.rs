//! Pictures in: the values of PNG and OpenEXR files, layer by layer.
//!
//! Files are hostile: before anything is allocated for the pixels, the size that the head claims is held against that of
//! the file and against a limit.

mod exr;
mod png;

use std::{fs::File, path::Path};

use ambray::{Aov, AovKind};
use anyhow::{Context as _, bail};

use crate::{Format, head::Head};

/// Values take so many bytes of memory at most, as they are held.
const MOST_BYTES: u64 = 4 << 30;
/// No compression of PNG and OpenEXR makes more bytes of one: DEFLATE reaches 1032 (RFC 1951: 258 bytes for 2 bits), the
/// others less.
const MOST_EXPANSION: u64 = 1032;
/// What a small file may claim in any case.
const ALWAYS_ALLOWED: u64 = 1 << 20;

/// All values of a picture file.
#[derive(Clone, Debug)]
pub struct Planes {
    /// What its head says.
    pub head: Head,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Its layers, the picture first, the others by the alphabet.
    pub layers: Vec<Layer>,
}

/// A layer of a picture file.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its name, that of the plane where ambray wrote it: `beauty`, `depth`. The picture of a PNG file is `picture`.
    pub name: String,
    /// Names of its channels, in the order of the plane.
    pub channels: Vec<String>,
    /// What the values are.
    pub meaning: Meaning,
    /// Values of each channel, row by row from the top.
    pub values: Vec<Vec<f32>>,
}

/// What the values of a layer are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Display values in `[0, 1]`, one channel of grey or three of colours in sRGB.
    Shown,
    /// The values of a plane.
    Plane(Aov),
    /// Linear red, green and blue.
    Color,
    /// A share from 0 to 1.
    Unit,
    /// Something that only its maker knows.
    Unknown,
}

impl Meaning {
    /// Kind of the values of a layer with linear values, if it is known.
    #[must_use]
    pub const fn kind(self) -> Option<AovKind> {
        match self {
            Self::Plane(aov) => Some(aov.kind()),
            Self::Color => Some(AovKind::Color),
            Self::Unit => Some(AovKind::Unit),
            Self::Shown | Self::Unknown => None,
        }
    }
}

impl Planes {
    /// Reads the picture at `path`.
    ///
    /// # Errors
    /// If it is no picture, is damaged, or claims to be larger than it can be or than the limit of 4 GiB.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        Self::read_file(path).with_context(|| format!("picture {}", path.display()))
    }

    fn read_file(path: &Path) -> anyhow::Result<Self> {
        if path.is_dir() {
            bail!("is a folder");
        }
        let head = Head::read(path)?.context("is neither PNG nor OpenEXR")?;
        let file = File::open(path)?;
        match head.format {
            Format::Png8 | Format::Png16 => png::read(file, head),
            Format::Exr => exr::read(file, head),
        }
    }

    /// The layer of this name.
    #[must_use]
    pub fn layer(&self, name: &str) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.name == name)
    }
}

/// Refuses pictures of `samples` a pixel, which have `bits` in the file before it is compressed, if a file of `file_size`
/// bytes cannot hold them, or if they take too much memory.
fn check_size(
    (width, height): (usize, usize),
    samples: usize,
    bits: u64,
    file_size: u64,
) -> anyhow::Result<()> {
    let pixels = width as u128 * height as u128;
    if pixels == 0 || samples == 0 {
        bail!("the picture has no pixels");
    }
    let claimed = pixels.saturating_mul(bits.into()) / 8;
    if claimed > u128::from(file_size) * u128::from(MOST_EXPANSION) + u128::from(ALWAYS_ALLOWED) {
        bail!(
            "claims {width}x{height} pixels with {samples} values each, which a file of {file_size} bytes cannot hold"
        );
    }
    let memory = pixels.saturating_mul(samples as u128 * size_of::<f32>() as u128);
    if memory > u128::from(MOST_BYTES) {
        let gibibytes = |bytes: u128| bytes >> 30;
        bail!(
            "{width}x{height} pixels with {samples} values each take {} GiB; the limit is {} GiB",
            gibibytes(memory),
            gibibytes(MOST_BYTES.into())
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_holds_at_most_what_its_compression_allows() {
        let told = |size, samples, file_size| {
            check_size(size, samples, 32 * samples as u64, file_size).map_err(|error| error.to_string())
        };
        assert_eq!(told((640, 360), 3, 1 << 20), Ok(()));
        assert_eq!(told((100, 100), 3, 10), Ok(()), "small pictures are read, and then found to be damaged");
        let forged = told((1 << 30, 1 << 30), 1, 1000).unwrap_err();
        assert!(forged.contains("which a file of 1000 bytes cannot hold"), "{forged}");
        let large = told((1 << 16, 1 << 16), 45, 1 << 30).unwrap_err();
        assert!(large.contains("take 720 GiB; the limit is 4 GiB"), "{large}");
        assert!(told((0, 5), 1, 100).is_err());
        assert!(told((usize::MAX, usize::MAX), 1, u64::MAX).is_err());
    }
}
