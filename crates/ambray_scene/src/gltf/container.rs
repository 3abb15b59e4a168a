//! The outer shell of a glTF file: JSON text, alone or in a GLB container.

use crate::error::{Fault, Outcome};
use crate::limits;

use super::json::Root;

const MAGIC: &[u8; 4] = b"glTF";
const CHUNK_JSON: u32 = u32::from_le_bytes(*b"JSON");
const CHUNK_BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Whether `bytes` begin like a GLB file.
pub(crate) fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Parts of a glTF file.
#[derive(Debug)]
pub(super) struct Parts<'a> {
    pub(super) root: Root,
    /// The binary chunk of a GLB file.
    pub(super) binary: Option<&'a [u8]>,
}

/// Splits `bytes` into JSON and binary chunk and parses the JSON. `expect_glb` says what the file's name promises.
pub(super) fn parse(bytes: &[u8], expect_glb: bool) -> Outcome<Parts<'_>> {
    if bytes.is_empty() {
        return Err(Fault::syntax("byte 0", "the file is empty"));
    }
    let (text, binary) = if expect_glb || is_glb(bytes) { split_glb(bytes)? } else { (bytes, None) };
    Ok(Parts { root: parse_json(text)?, binary })
}

/// glTF 2.0 §4.4: a 12-byte header, then chunks of length, type and data.
fn split_glb(bytes: &[u8]) -> Outcome<(&[u8], Option<&[u8]>)> {
    let word = |at: usize| {
        let end = at.checked_add(4)?;
        Some(u32::from_le_bytes(bytes.get(at..end)?.try_into().expect("four bytes")))
    };
    let header = (word(0), word(4), word(8));
    let (Some(_), Some(version), Some(length)) = header else {
        return Err(Fault::syntax(
            "byte 0",
            format!("GLB header needs 12 bytes, the file has {}", bytes.len()),
        ));
    };
    if !is_glb(bytes) {
        return Err(Fault::syntax("byte 0", "not a GLB file: it does not begin with 'glTF'"));
    }
    if version != 2 {
        return Err(Fault::unsupported("byte 4", format!("GLB version {version}, only 2 is read")));
    }
    if length as usize != bytes.len() {
        let reason = format!("GLB header says {length} bytes, the file has {}", bytes.len());
        return Err(Fault::syntax("byte 8", reason));
    }
    let (mut json, mut binary, mut at, mut index) = (None, None, 12_usize, 0);
    while at < bytes.len() {
        let place = format!("byte {at}");
        let (Some(length), Some(kind)) = (word(at), word(at + 4)) else {
            return Err(Fault::syntax(place, "GLB chunk header is cut off"));
        };
        let start = at + 8;
        let chunk =
            start.checked_add(length as usize).and_then(|end| bytes.get(start..end)).ok_or_else(|| {
                let left = bytes.len() - start;
                Fault::syntax(&place, format!("GLB chunk of {length} bytes, the file has {left} left"))
            })?;
        match (kind, index) {
            (CHUNK_JSON, 0) => json = Some(chunk),
            (CHUNK_BIN, 1) => binary = Some(chunk),
            (CHUNK_JSON | CHUNK_BIN, _) => {
                return Err(Fault::syntax(place, "GLB chunks are not one JSON then at most one BIN"));
            }
            (_, 0) => return Err(Fault::syntax(place, "first GLB chunk is not JSON")),
            _ => {} // the specification reserves other chunks for extensions
        }
        at = start + chunk.len();
        index += 1;
    }
    json.map(|json| (json, binary)).ok_or_else(|| Fault::syntax("byte 12", "GLB file without a JSON chunk"))
}

/// Parses the JSON, with the JSON path in errors.
fn parse_json(text: &[u8]) -> Outcome<Root> {
    if text.len() as u64 > limits::JSON_BYTES {
        let reason = format!("JSON of {} bytes, the limit is {}", text.len(), limits::JSON_BYTES);
        return Err(Fault::too_large("byte 0", reason));
    }
    if text.starts_with(b"\xef\xbb\xbf") {
        return Err(Fault::syntax("byte 0", "JSON begins with a byte order mark, which glTF forbids"));
    }
    check_depth(text)?;
    let mut reader = serde_json::Deserializer::from_slice(text);
    let root = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
        let path = error.path().to_string();
        let inner = error.into_inner();
        if inner.is_data() {
            // serde appends the position; the path is what people look for, the position what editors want: keep both.
            Fault::invalid(if path == "." { "JSON".into() } else { path }, inner.to_string())
        } else {
            Fault::syntax(format!("line {} column {}", inner.line(), inner.column()), bare(&inner))
        }
    })?;
    reader.end().map_err(|error| {
        Fault::syntax(format!("line {} column {}", error.line(), error.column()), bare(&error))
    })?;
    Ok(root)
}

/// The error's text without the position that serde_json appends.
fn bare(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or_default().to_owned()
}

/// Refuses deep nesting before anything recursive sees the text.
fn check_depth(text: &[u8]) -> Outcome<()> {
    let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
    for (at, &byte) in text.iter().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            _ if in_string => {}
            b'[' | b'{' => {
                depth += 1;
                if depth > limits::JSON_DEPTH {
                    let reason = format!("JSON is nested deeper than {} levels", limits::JSON_DEPTH);
                    return Err(Fault::too_large(format!("byte {at}"), reason));
                }
            }
            b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check_error(bytes: &[u8], glb: bool, expected: &str) {
        let fault = parse(bytes, glb).expect_err("must be refused");
        let text = fault.in_file(std::path::Path::new("x")).to_string();
        assert!(text.contains(expected), "{text}");
    }

    #[test]
    fn says_where_json_is_wrong() {
        check_error(b"", false, "x: byte 0: the file is empty");
        check_error(b"{\"asset\":", false, "line 1 column 9: EOF");
        check_error(b"{\"nodes\":[{},{\"mesh\":\"a\"}]}", false, "nodes[1].mesh: invalid type: string");
        check_error(b"{} x", false, "line 1 column 4: trailing characters");
        check_error(&[b'['; 200], false, "byte 128: JSON is nested deeper than 128 levels");
    }

    #[test]
    fn brackets_in_strings_do_not_nest() {
        let text = format!("{{\"extras\":\"{}\\\"[\"}}", "[".repeat(500));
        assert!(parse(text.as_bytes(), false).is_ok());
    }

    #[test]
    fn says_where_glb_is_wrong() {
        check_error(b"glTF", false, "GLB header needs 12 bytes, the file has 4");
        check_error(b"Hello World!", true, "does not begin with 'glTF'");
        check_error(b"glTF\x01\0\0\0\x0c\0\0\0", true, "byte 4: GLB version 1");
        check_error(b"glTF\x02\0\0\0\x0d\0\0\0", true, "byte 8: GLB header says 13 bytes, the file has 12");
        check_error(b"glTF\x02\0\0\0\x0c\0\0\0", true, "without a JSON chunk");
        check_error(
            b"glTF\x02\0\0\0\x14\0\0\0\xff\0\0\0JSON",
            true,
            "chunk of 255 bytes, the file has 0 left",
        );
    }
}
