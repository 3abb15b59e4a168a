//! Whether a picture is there up to its end: a copy may have been cut short.

use std::{
    fs::File,
    io::{BufReader, Read as _, Seek as _, SeekFrom},
    path::Path,
};

use anyhow::Context as _;
use exr::{block, meta::MetaData};

use crate::Format;

/// The chunk that ends a PNG file: no bytes, its name, its checksum.
const PNG_END: &[u8; 12] = b"\0\0\0\0IEND\xAE\x42\x60\x82";

/// Whether the picture at `path`, of this `format`, ends where it should. The pixels are not decoded.
#[must_use]
pub(crate) fn is_whole(path: &Path, format: Format) -> bool {
    let Ok(file) = File::open(path) else { return false };
    match format {
        Format::Png8 | Format::Png16 => ends_as_png(file),
        Format::Exr => ends_as_exr(file),
    }
    .unwrap_or(false)
}

fn ends_as_png(mut file: File) -> anyhow::Result<bool> {
    let mut end = [0; PNG_END.len()];
    file.seek(SeekFrom::End(-(PNG_END.len() as i64)))?;
    file.read_exact(&mut end)?;
    Ok(end == *PNG_END)
}

/// The chunks lie in the order of their lines: if the last can be read, and nothing follows, all are there.
fn ends_as_exr(file: File) -> anyhow::Result<bool> {
    let mut file = BufReader::new(file);
    let is_last = |meta: &MetaData, block: block::BlockIndex| {
        block.pixel_position.y() + block.pixel_size.y() == meta.headers[block.layer].layer_size.y()
    };
    let mut last =
        block::read(&mut file, false)?.filter_chunks(true, |meta, _, block| is_last(meta, block))?;
    last.next().context("there are no chunks")??;
    drop(last);
    let mut rest = [0];
    Ok(file.read(&mut rest)? == 0)
}
