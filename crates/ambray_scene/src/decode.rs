//! Encoded images to [`Image`]s: sizes checked first, then decoded in parallel.

use std::io::Cursor;
use std::sync::Arc;

use image::{ImageReader, Limits};
use rayon::prelude::*;

use crate::error::{Fault, Outcome};
use crate::{Image, limits};

/// An encoded image and the uses it is wanted for.
#[derive(Debug)]
pub(crate) struct Encoded<'a> {
    /// PNG, JPEG or WebP.
    pub(crate) bytes: std::borrow::Cow<'a, [u8]>,
    /// Name for reports.
    pub(crate) name: String,
    /// Place in the file, for errors.
    pub(crate) at: String,
    /// One [`Image`] is made for each entry: whether it is sRGB.
    pub(crate) uses: Vec<bool>,
}

/// Decodes all images; the results are in the order of the images and their uses.
pub(crate) fn decode_all(encoded: &[Encoded<'_>]) -> Outcome<Vec<Arc<Image>>> {
    let mut left = limits::TEXELS;
    let mut texels = Vec::with_capacity(encoded.len());
    for image in encoded {
        let (width, height) = dimensions(image)?;
        texels.push(u64::from(width) * u64::from(height));
        let all = texels.last().copied().unwrap_or_default() * image.uses.len() as u64;
        left = left.checked_sub(all).ok_or_else(|| {
            Fault::too_large(&image.at, format!("images of more than {} texels in total", limits::TEXELS))
        })?;
    }
    let decoded: Vec<Outcome<Vec<Image>>> =
        encoded.par_iter().zip(texels).map(|(image, texels)| decode(image, texels)).collect();
    // The first error in file order, whichever thread was first.
    let mut images = Vec::new();
    for result in decoded {
        images.extend(result?.into_iter().map(Arc::new));
    }
    Ok(images)
}

/// Size according to the header, within limits.
fn dimensions(image: &Encoded<'_>) -> Outcome<(u32, u32)> {
    let (width, height) = reader(image, OVERHEAD)?
        .into_dimensions()
        .map_err(|error| Fault::invalid(&image.at, one_line(&error)))?;
    if width == 0 || height == 0 {
        return Err(Fault::invalid(&image.at, format!("image of {width} × {height} texels")));
    }
    if width.max(height) > limits::IMAGE_SIDE {
        let reason = format!("image of {width} × {height} texels, the limit is {}", limits::IMAGE_SIDE);
        return Err(Fault::too_large(&image.at, reason));
    }
    Ok((width, height))
}

fn decode(image: &Encoded<'_>, texels: u64) -> Outcome<Vec<Image>> {
    // 16 bits a channel need twice the memory of ours.
    let decoded = reader(image, 8 * texels + OVERHEAD)?
        .decode()
        .map_err(|error| Fault::invalid(&image.at, one_line(&error)))?;
    let rgba = decoded.into_rgba8();
    let (width, height) = rgba.dimensions();
    let texels: Vec<[u8; 4]> = rgba.pixels().map(|pixel| pixel.0).collect();
    drop(rgba);
    let (last, others) = image.uses.split_last().expect("an image is listed for its uses");
    let mut images: Vec<Image> = others
        .iter()
        .map(|&srgb| Image::new(image.name.clone(), width, height, texels.clone(), srgb))
        .collect();
    images.push(Image::new(image.name.clone(), width, height, texels, *last));
    Ok(images)
}

/// Bytes that a decoder may allocate besides the texels: tables, profiles, comments.
const OVERHEAD: u64 = 64 << 20;

fn reader<'a>(image: &'a Encoded<'_>, max_alloc: u64) -> Outcome<ImageReader<Cursor<&'a [u8]>>> {
    let mut reader = ImageReader::new(Cursor::new(image.bytes.as_ref()))
        .with_guessed_format()
        .map_err(|error| Fault::io(&image.at, error.to_string()))?;
    if reader.format().is_none() {
        let ktx = image.bytes.starts_with(b"\xabKTX");
        let found = if ktx { "a KTX image" } else { "data of no known image format" };
        return Err(Fault::invalid(&image.at, format!("{found}, only PNG, JPEG and WebP are read")));
    }
    // The sides are checked by `dimensions` with a better message.
    let mut limits = Limits::default();
    limits.max_alloc = Some(max_alloc + image.bytes.len() as u64);
    reader.limits(limits);
    Ok(reader)
}

fn one_line(error: &image::ImageError) -> String {
    format!("image cannot be decoded: {error}")
}
