//! Truths that are kept: OpenEXR files named by what they depend on.

use std::{fs, path::Path};

use ambray_metrics::Map;
use anyhow::Context as _;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels as _,
    ReadLayers as _, SmallVec, Text, WritableImage as _,
};
use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::{AboutTruth, Truth};

/// Channels of the file, in the order in which OpenEXR keeps them.
const CHANNELS: [&str; 4] = ["near.B", "near.G", "near.R", "openness.Y"];

/// What is kept beside the values.
#[derive(Debug, Serialize, Deserialize)]
struct Kept {
    spp: u32,
    standard_error: f64,
    bound: f64,
}

/// The truth called `key`; `None` if it is not there, or not whole.
pub(super) fn read(folder: &Path, key: &str, (width, height): (u32, u32)) -> Option<Truth> {
    let bytes = fs::read(folder.join(format!("{key}.exr"))).ok()?;
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let image =
        reader.first_valid_layer().all_attributes().from_buffered(std::io::Cursor::new(bytes)).ok()?;
    let layer = image.layer_data;
    let kept: Kept = serde_json::from_str(&layer.attributes.comments?.to_string()).ok()?;
    let pixels = width as usize * height as usize;
    if (layer.size.width(), layer.size.height()) != (width as usize, height as usize) {
        return None;
    }
    let plane = |name: &str| {
        let channel = layer.channel_data.list.iter().find(|channel| channel.name.eq(name))?;
        match &channel.sample_data {
            FlatSamples::F32(values) if values.len() == pixels => Some(values.clone()),
            _ => None,
        }
    };
    let [blue, green, red, openness] = CHANNELS.map(plane);
    let (blue, green, red) = (blue?, green?, red?);
    let near = (0..pixels).map(|i| Vec3::new(red[i], green[i], blue[i])).collect();
    let Kept { spp, standard_error, bound } = kept;
    Some(Truth {
        openness: Map { width: width as usize, values: openness? },
        near,
        about: AboutTruth { spp, standard_error, bound, cached: true, seconds: 0.0 },
    })
}

/// Keeps `truth` as `key`. Who reads meanwhile sees the whole file or none.
pub(super) fn write(folder: &Path, key: &str, truth: &Truth) -> anyhow::Result<()> {
    fs::create_dir_all(folder).context("the folder cannot be made")?;
    let width = truth.openness.width;
    let plane = |values: Vec<f32>| FlatSamples::F32(values);
    let near = |axis: usize| plane(truth.near.iter().map(|v| v[axis]).collect());
    let planes = [near(2), near(1), near(0), plane(truth.openness.values.clone())];
    let channels = CHANNELS.iter().zip(planes).map(|(name, samples)| AnyChannel::new(*name, samples));
    let AboutTruth { spp, standard_error, bound, .. } = truth.about;
    let attributes = LayerAttributes {
        comments: Some(Text::from(serde_json::to_string(&Kept { spp, standard_error, bound })?.as_str())),
        ..LayerAttributes::default()
    };
    let size = (width, truth.openness.height());
    let channels = AnyChannels::sort(channels.collect::<SmallVec<[_; 4]>>());
    let image = Image::from_layer(Layer::new(size, attributes, Encoding::FAST_LOSSLESS, channels));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).context("it cannot be encoded")?;
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    std::io::Write::write_all(&mut file, bytes.get_ref())?;
    file.persist(folder.join(format!("{key}.exr")))?;
    Ok(())
}
