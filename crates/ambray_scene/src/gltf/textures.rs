//! Textures, samplers and images, each read only if a material uses it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use crate::decode::{Encoded, decode_all};
use crate::error::{Fault, Outcome};
use crate::files::{Folder, scheme};
use crate::{Filter, Image, Sampler, Texture, Wrap};

use super::document::{Document, missing, read_uri};
use super::json::{self, Index};

/// A texture of the file with its use: read as sRGB or as linear data.
type Use = (Index, bool);

/// Textures in the order of their first use. The same texture as colour and as normal map counts as two.
#[derive(Debug, Default)]
pub(super) struct TextureUses {
    textures: Vec<Texture>,
    by_use: BTreeMap<Use, u32>,
    /// glTF images in order of first use, with the scene images they become.
    images: Vec<(Index, Vec<bool>)>,
    slots: BTreeMap<Index, usize>,
    /// (slot in `images`, position among its uses) of each texture; becomes its image index once all are known.
    sources: Vec<(usize, usize)>,
}

impl TextureUses {
    /// Scene index of glTF texture `index`, read as sRGB or as linear data; `at` is the place that refers to it.
    pub(super) fn add(&mut self, root: &json::Root, index: Index, srgb: bool, at: &str) -> Outcome<u32> {
        if let Some(&known) = self.by_use.get(&(index, srgb)) {
            return Ok(known);
        }
        let texture = root.textures.get(index).ok_or_else(|| missing(at, "texture", index))?;
        let sampler = sampler(root, texture, index)?;
        let image = source(texture, index)?;
        let slot = *self.slots.entry(image).or_insert_with(|| {
            self.images.push((image, Vec::new()));
            self.images.len() - 1
        });
        let uses = &mut self.images[slot].1;
        let position = uses.iter().position(|&other| other == srgb).unwrap_or_else(|| {
            uses.push(srgb);
            uses.len() - 1
        });
        self.sources.push((slot, position));
        self.textures.push(Texture { image: 0, sampler });
        let new = (self.textures.len() - 1) as u32; // bounded by twice the textures of a file below 4 GiB
        self.by_use.insert((index, srgb), new);
        Ok(new)
    }

    /// Reads and decodes what was used.
    pub(super) fn load(
        mut self,
        doc: &Document<'_>,
        folder: &mut Folder,
    ) -> Outcome<(Vec<Texture>, Vec<Arc<Image>>)> {
        // The decoder returns the uses of the first image, then those of the second, and so on.
        let mut first = Vec::with_capacity(self.images.len());
        let mut encoded = Vec::with_capacity(self.images.len());
        let mut count = 0;
        for (index, uses) in self.images {
            first.push(count);
            count += uses.len();
            encoded.push(read_image(doc, index, uses, folder)?);
        }
        for (texture, (slot, position)) in self.textures.iter_mut().zip(self.sources) {
            texture.image = (first[slot] + position) as u32;
        }
        Ok((self.textures, decode_all(&encoded)?))
    }
}

/// The image that a texture shows, in a format we read.
fn source(texture: &json::Texture, index: Index) -> Outcome<Index> {
    let at = format!("textures[{index}].source");
    let extensions = &texture.extensions;
    match (extensions.webp.as_ref().and_then(|webp| webp.source), texture.source) {
        (Some(image), _) | (None, Some(image)) => Ok(image),
        (None, None) if extensions.basisu.is_some() => {
            Err(Fault::unsupported(at, "the only source is a KTX2 image of KHR_texture_basisu"))
        }
        (None, None) => Err(Fault::invalid(at, "texture without an image")),
    }
}

fn read_image<'d>(
    doc: &'d Document<'_>,
    index: Index,
    uses: Vec<bool>,
    folder: &mut Folder,
) -> Outcome<Encoded<'d>> {
    let at = format!("images[{index}]");
    let image = doc.root.images.get(index).ok_or_else(|| missing("textures", "image", index))?;
    let bytes = match (&image.uri, image.buffer_view) {
        (Some(uri), _) => Cow::Owned(read_uri(uri, folder, &format!("{at}.uri"))?),
        (None, Some(view)) => Cow::Borrowed(doc.view(view, &format!("{at}.bufferView"))?),
        (None, None) => return Err(Fault::invalid(at, "image without uri or bufferView")),
    };
    let uri = image.uri.as_deref().filter(|uri| scheme(uri).is_none());
    let name = image.name.as_deref().or(uri).unwrap_or_default().to_owned();
    Ok(Encoded { bytes, name, at, uses })
}

fn sampler(root: &json::Root, texture: &json::Texture, index: Index) -> Outcome<Sampler> {
    let Some(slot) = texture.sampler else { return Ok(Sampler::default()) };
    let json = root
        .samplers
        .get(slot)
        .ok_or_else(|| missing(&format!("textures[{index}].sampler"), "sampler", slot))?;
    let bad = |field: &str, code: u32| {
        Fault::invalid(format!("samplers[{slot}].{field}"), format!("no such value: {code}"))
    };
    let wrap = |field: &str, code: Option<u32>| match code {
        None | Some(10497) => Ok(Wrap::Repeat),
        Some(33071) => Ok(Wrap::Clamp),
        Some(33648) => Ok(Wrap::Mirror),
        Some(code) => Err(bad(field, code)),
    };
    let mag = match json.mag_filter {
        None | Some(9729) => Filter::Linear,
        Some(9728) => Filter::Nearest,
        Some(code) => return Err(bad("magFilter", code)),
    };
    let (min, mip) = match json.min_filter {
        None | Some(9987) => (Filter::Linear, Some(Filter::Linear)),
        Some(9728) => (Filter::Nearest, None),
        Some(9729) => (Filter::Linear, None),
        Some(9984) => (Filter::Nearest, Some(Filter::Nearest)),
        Some(9985) => (Filter::Linear, Some(Filter::Nearest)),
        Some(9986) => (Filter::Nearest, Some(Filter::Linear)),
        Some(code) => return Err(bad("minFilter", code)),
    };
    Ok(Sampler { wrap: [wrap("wrapS", json.wrap_s)?, wrap("wrapT", json.wrap_t)?], mag, min, mip })
}
