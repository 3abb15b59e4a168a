//! OpenEXR files with their layers, by whatever program.

use std::{
    collections::BTreeMap,
    fs::File,
    io::{BufReader, Read as _, Seek as _},
};

use ambray::Aov;
use anyhow::{Context as _, bail};
use exr::{
    meta::{MetaData, header::Header},
    prelude::{AnyChannel, FlatSamples, ReadChannels as _, ReadLayers as _, read as read_exr},
};

use super::{Layer, Meaning, Planes, check_size};
use crate::head::{Head, LARGEST_HEAD};

/// Reads an OpenEXR file: parts of a file and groups of channels `layer.channel` alike as layers.
pub(super) fn read(mut file: File, head: Head) -> anyhow::Result<Planes> {
    let file_size = file.metadata()?.len();
    let headers = MetaData::read_from_unbuffered((&mut file).take(LARGEST_HEAD), false)?.headers;
    let size = check(&headers, file_size)?;
    file.rewind()?;
    let parts = read_exr()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(BufReader::new(file))?;
    let mut found = BTreeMap::<String, Vec<(String, Vec<f32>)>>::new();
    for part in parts.layer_data {
        let prefix = part.attributes.layer_name.map(|name| name.to_string());
        for AnyChannel { name, sample_data, .. } in part.channel_data.list {
            let (layer, channel) = place(prefix.as_deref(), &name.to_string());
            let channels = found.entry(layer.clone()).or_default();
            if channels.iter().any(|(known, _)| *known == channel) {
                bail!("the channel {channel} of layer {layer} is there twice");
            }
            channels.push((channel, single(sample_data)));
        }
    }
    let mut layers: Vec<_> = found.into_iter().map(|(name, channels)| layer(name, channels)).collect();
    layers.sort_by_key(|layer| layer.name != Aov::Beauty.name()); // stable: the others keep their order
    Ok(Planes { head, width: size.0, height: size.1, layers })
}

/// The size of all parts, if they are of a kind and a size that can be read.
fn check(headers: &[Header], file_size: u64) -> anyhow::Result<(usize, usize)> {
    let first = headers.first().context("the picture has no layer")?;
    let (mut samples, mut bytes) = (0, 0);
    for header in headers {
        if header.deep {
            bail!("has several samples a pixel (deep data), which cannot be compared");
        }
        if header.layer_size != first.layer_size {
            bail!("has parts of several sizes, which cannot be compared");
        }
        if header.channels.list.iter().any(|channel| channel.sampling.0 != 1 || channel.sampling.1 != 1) {
            bail!("has channels of less resolution than the picture, which cannot be compared");
        }
        samples += header.channels.list.len();
        bytes += header.channels.list.iter().map(|c| c.sample_type.bytes_per_sample()).sum::<usize>();
    }
    let size = (first.layer_size.width(), first.layer_size.height());
    check_size(size, samples, 8 * bytes as u64, file_size)?;
    Ok(size)
}

/// Layer and channel of the channel `name` in a part that is called `prefix`.
fn place(prefix: Option<&str>, name: &str) -> (String, String) {
    let full = prefix.filter(|prefix| !prefix.is_empty()).map_or(name.to_owned(), |p| format!("{p}.{name}"));
    match full.rsplit_once('.') {
        Some((layer, "A")) => (format!("{layer}.alpha"), "A".to_owned()),
        Some((layer, channel)) => (layer.to_owned(), channel.to_owned()),
        None if full == "A" => ("alpha".to_owned(), full),
        None if ["R", "G", "B"].contains(&name) => (Aov::Beauty.name().to_owned(), full),
        None => (full.clone(), full),
    }
}

fn layer(name: String, mut channels: Vec<(String, Vec<f32>)>) -> Layer {
    let has = |names: &[&str]| {
        channels.len() == names.len()
            && names.iter().all(|name| channels.iter().any(|(known, _)| known == name))
    };
    let known = name.parse::<Aov>().ok().filter(|aov| has(aov.channels()));
    let meaning = match known {
        Some(aov) => Meaning::Plane(aov),
        None if has(&["R", "G", "B"]) => Meaning::Color,
        None if has(&["A"]) => Meaning::Unit,
        None => Meaning::Unknown,
    };
    let order = known.map_or(&["R", "G", "B"][..], Aov::channels);
    channels.sort_by_key(|(name, _)| order.iter().position(|known| known == name).unwrap_or(order.len()));
    let (channels, values) = channels.into_iter().unzip();
    Layer { name, channels, meaning, values }
}

/// In single precision; whole numbers beyond 2²⁴ are rounded.
fn single(samples: FlatSamples) -> Vec<f32> {
    match samples {
        FlatSamples::F32(values) => values,
        FlatSamples::F16(values) => values.into_iter().map(f32::from).collect(),
        FlatSamples::U32(values) => values.into_iter().map(|value| value as f32).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_placed_by_their_names() {
        let placed = |prefix, name| {
            let (layer, channel) = place(prefix, name);
            format!("{layer} {channel}")
        };
        assert_eq!(placed(None, "G"), "beauty G");
        assert_eq!(placed(None, "A"), "alpha A");
        assert_eq!(placed(None, "Z"), "Z Z");
        assert_eq!(placed(None, "bent-normal.X"), "bent-normal X");
        assert_eq!(placed(Some("ViewLayer"), "Combined.R"), "ViewLayer.Combined R");
        assert_eq!(placed(Some("diffuse"), "A"), "diffuse.alpha A");
        assert_eq!(placed(Some(""), "R"), "beauty R");
    }

    #[test]
    fn channels_have_the_order_of_their_plane() {
        let channels =
            |names: &[&str]| names.iter().map(|name| (name.to_string(), vec![0.0])).collect::<Vec<_>>();
        let beauty = layer("beauty".to_owned(), channels(&["B", "G", "R"]));
        assert_eq!(
            (beauty.channels.concat(), beauty.meaning),
            ("RGB".to_owned(), Meaning::Plane(Aov::Beauty))
        );
        let other = layer("diffuse".to_owned(), channels(&["B", "G", "R"]));
        assert_eq!((other.channels.concat(), other.meaning), ("RGB".to_owned(), Meaning::Color));
        assert_eq!(layer("depth".to_owned(), channels(&["Q"])).meaning, Meaning::Unknown);
    }
}
