//! A parsed file with its buffers, and the bounds-checked way from a buffer view to bytes.

use std::borrow::Cow;
use std::cell::Cell;

use base64::Engine as _;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use crate::error::{Fault, Outcome, quoted};
use crate::files::{Folder, scheme};
use crate::limits;

use super::json::{Buffer, Index, Root};

/// Everything that reading accessors needs.
#[derive(Debug)]
pub(super) struct Document<'a> {
    pub(super) root: &'a Root,
    buffers: Vec<Option<Cow<'a, [u8]>>>,
    /// Bytes of vertex data that may still be decoded.
    decode_left: Cell<u64>,
}

impl<'a> Document<'a> {
    /// Reads the buffers of `root`. `binary` is the GLB chunk, `folder` holds the external files.
    pub(super) fn open(root: &'a Root, binary: Option<&'a [u8]>, folder: &mut Folder) -> Outcome<Self> {
        let mut buffers = Vec::with_capacity(root.buffers.len());
        let mut bytes = 0;
        for (index, buffer) in root.buffers.iter().enumerate() {
            let data = open_buffer(buffer, index, binary, folder)?;
            bytes += data.as_ref().map_or(0, |data| data.len() as u64);
            buffers.push(data);
        }
        let budget = (limits::DECODED_BYTES_BASE + bytes.saturating_mul(limits::DECODED_BYTES_PER_BYTE))
            .min(limits::DECODED_BYTES);
        Ok(Self { root, buffers, decode_left: Cell::new(budget) })
    }

    /// Takes `bytes` from the budget of decoded data; call before allocating them.
    pub(super) fn reserve(&self, bytes: u64, at: &str) -> Outcome<()> {
        let left = self.decode_left.get().checked_sub(bytes).ok_or_else(|| {
            Fault::too_large(at, "the file expands to more vertex data than its size allows")
        })?;
        self.decode_left.set(left);
        Ok(())
    }

    /// Bytes of buffer view `index`; `at` is the place that refers to it.
    pub(super) fn view(&self, index: Index, at: &str) -> Outcome<&[u8]> {
        let place = format!("bufferViews[{index}]");
        let view = self.root.buffer_views.get(index).ok_or_else(|| missing(at, "buffer view", index))?;
        let buffer = self
            .buffers
            .get(view.buffer)
            .ok_or_else(|| missing(&format!("{place}.buffer"), "buffer", view.buffer))?;
        let Some(buffer) = buffer else {
            return Err(Fault::unsupported(place, "EXT_meshopt_compression data without a fallback buffer"));
        };
        slice(buffer, view.byte_offset, view.byte_length).ok_or_else(|| {
            let end = u128::from(view.byte_offset) + u128::from(view.byte_length);
            Fault::invalid(place, format!("ends at byte {end} of a {}-byte buffer", buffer.len()))
        })
    }
}

/// `bytes[offset..offset + length]`, or `None` where that overflows or leaves the slice.
pub(super) fn slice(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let end = offset.checked_add(length)?;
    bytes.get(usize::try_from(offset).ok()?..usize::try_from(end).ok()?)
}

/// Error for an index that refers to nothing.
pub(super) fn missing(at: &str, what: &str, index: Index) -> Fault {
    Fault::invalid(at, format!("{what} {index} does not exist"))
}

/// Bytes of one buffer; `None` for the empty stand-ins of compressed data.
fn open_buffer<'a>(
    buffer: &Buffer,
    index: Index,
    binary: Option<&'a [u8]>,
    folder: &mut Folder,
) -> Outcome<Option<Cow<'a, [u8]>>> {
    let at = format!("buffers[{index}].uri");
    let data: Cow<'a, [u8]> = match (&buffer.uri, binary) {
        (Some(uri), _) => Cow::Owned(read_uri(uri, folder, &at)?),
        (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
        (None, _) if buffer.extensions.meshopt.is_some() => return Ok(None),
        (None, _) => return Err(Fault::invalid(at, "buffer without data")),
    };
    if (data.len() as u64) < buffer.byte_length {
        let at = format!("buffers[{index}].byteLength");
        let reason = format!("{} bytes wanted, the data has {}", buffer.byte_length, data.len());
        return Err(Fault::invalid(at, reason));
    }
    let length = buffer.byte_length as usize; // fits, it is at most the length of a slice
    Ok(Some(match data {
        Cow::Borrowed(data) => Cow::Borrowed(&data[..length]),
        Cow::Owned(mut data) => {
            data.truncate(length);
            Cow::Owned(data)
        }
    }))
}

/// Bytes of a data URI, or of a file beside the scene.
pub(super) fn read_uri(uri: &str, folder: &mut Folder, at: &str) -> Outcome<Vec<u8>> {
    if !scheme(uri).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data")) {
        return folder.read(uri, at);
    }
    let Some((head, body)) = uri.split_once(',').filter(|(head, _)| head.ends_with(";base64")) else {
        return Err(Fault::invalid(at, format!("data URI {} is not base64", quoted(uri))));
    };
    // RFC 2397 wants padding, some exporters omit it.
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
    engine
        .decode(body)
        .map_err(|error| Fault::invalid(at, format!("data URI after {}: {error}", quoted(head))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_check_their_arithmetic() {
        let bytes = [1, 2, 3, 4];
        assert_eq!(slice(&bytes, 1, 2), Some(&bytes[1..3]));
        assert_eq!(slice(&bytes, 4, 0), Some(&bytes[4..]));
        assert_eq!(slice(&bytes, 3, 2), None);
        assert_eq!(slice(&bytes, u64::MAX, 2), None);
    }

    #[test]
    fn data_uris() {
        let mut folder = Folder::of(std::path::Path::new("nowhere/x.gltf"), 0);
        let mut read = |uri| read_uri(uri, &mut folder, "x");
        assert_eq!(read("data:application/octet-stream;base64,AQID"), Ok(vec![1, 2, 3]));
        assert_eq!(read("data:;base64,AQI"), Ok(vec![1, 2]));
        assert!(read("data:;base64,A*ID").is_err());
        assert!(read("data:text/plain,abc").is_err());
        assert!(read("data:").is_err());
    }
}
