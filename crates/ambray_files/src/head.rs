//! What the head of a picture says: who made it, from which scene, with which settings.

use std::{
    fs::File,
    io::{Cursor, Read as _},
    path::Path,
};

use anyhow::Context as _;
use exr::prelude::{AttributeValue, Text};

use crate::{Format, exr::SETTINGS_ATTRIBUTE, settings_file::PNG_KEYWORD};

/// Keyword of the text in a PNG picture that names its scene.
pub const SCENE_KEYWORD: &str = "ambray:scene";
/// The program as pictures name it.
pub const SOFTWARE: &str = concat!("ambray ", env!("CARGO_PKG_VERSION"));

/// Everything that is read stands before the pixels, within so many bytes.
pub(crate) const LARGEST_HEAD: u64 = 1 << 20;
const PNG_SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
const EXR_SIGNATURE: &[u8] = b"\x76\x2f\x31\x01";

/// The head of a picture file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// Format of the file; PNG pictures of another depth than 16 bits count as 8.
    pub format: Format,
    /// Program and version.
    pub software: Option<String>,
    /// The scene, and what else the picture depends on.
    pub scene: Option<String>,
    /// The settings as TOML.
    pub settings: Option<String>,
    /// Names of the channels of an OpenEXR file, in its order.
    pub channels: Vec<String>,
}

impl Head {
    /// Reads the head of the picture at `path`; `None` if it is neither PNG nor OpenEXR.
    pub fn read(path: &Path) -> anyhow::Result<Option<Self>> {
        let mut signature = [0; PNG_SIGNATURE.len()];
        let is_whole = File::open(path)?.read_exact(&mut signature).is_ok();
        let head = File::open(path)?.take(LARGEST_HEAD);
        if is_whole && signature == *PNG_SIGNATURE {
            Self::of_png(head).map(Some)
        } else if is_whole && signature.starts_with(EXR_SIGNATURE) {
            Self::of_exr(head).map(Some)
        } else {
            Ok(None)
        }
    }

    fn of_png(mut head: impl std::io::Read) -> anyhow::Result<Self> {
        let mut bytes = Vec::new();
        head.read_to_end(&mut bytes)?;
        let reader = png::Decoder::new(Cursor::new(bytes)).read_info()?;
        let info = reader.info();
        let text = |keyword: &str| {
            let chunk = info.utf8_text.iter().find(|chunk| chunk.keyword == keyword);
            chunk.map(png::text_metadata::ITXtChunk::get_text).transpose()
        };
        let is_deep = info.bit_depth == png::BitDepth::Sixteen;
        Ok(Self {
            format: if is_deep { Format::Png16 } else { Format::Png8 },
            software: text("Software")?,
            scene: text(SCENE_KEYWORD)?,
            settings: text(PNG_KEYWORD)?,
            channels: Vec::new(),
        })
    }

    fn of_exr(head: impl std::io::Read) -> anyhow::Result<Self> {
        let headers = exr::meta::MetaData::read_from_unbuffered(head, false)?.headers;
        let header = headers.first().context("the picture has no layer")?;
        let attributes = &header.own_attributes;
        let settings = match attributes.other.get(&Text::from(SETTINGS_ATTRIBUTE)) {
            Some(AttributeValue::Text(settings)) => {
                Some(utf8(settings).context("the settings are not UTF-8 text")?)
            }
            _ => None,
        };
        Ok(Self {
            format: Format::Exr,
            software: attributes.software_name.as_ref().and_then(utf8),
            scene: attributes.comments.as_ref().and_then(utf8),
            settings,
            channels: header.channels.list.iter().map(|channel| channel.name.to_string()).collect(),
        })
    }
}

/// Text as UTF-8, as it was written.
fn utf8(text: &Text) -> Option<String> {
    String::from_utf8(text.as_slice().to_vec()).ok()
}
