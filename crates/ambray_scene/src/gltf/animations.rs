//! Animations of the file to clips (glTF 2.0 §3.11).

use std::collections::HashSet;

use crate::animation::{Channel, Clip, Interpolation, Local, Node, Property};
use crate::error::{Fault, Outcome, quoted};
use crate::limits;
use crate::warnings::Warnings;

use super::accessor::Accept;
use super::document::Document;
use super::json::{self, Index};
use super::nodes::{Hierarchy, decompose};

/// All animations, in their order, ignored channels left out. References exist. Nodes of `nodes` that are given by a matrix
/// come apart where a channel moves them.
pub(super) fn read_clips(
    doc: &Document<'_>,
    hierarchy: &Hierarchy,
    nodes: &mut [Node],
    warnings: &mut Warnings,
) -> Outcome<Vec<Clip>> {
    let mut reader = Reader { doc, hierarchy, nodes, warnings, channels: 0 };
    let animations = doc.root.animations.iter().enumerate();
    animations.map(|(i, animation)| reader.clip(animation, &format!("animations[{i}]"))).collect()
}

struct Reader<'a, 'd> {
    doc: &'a Document<'d>,
    hierarchy: &'a Hierarchy,
    nodes: &'a mut [Node],
    warnings: &'a mut Warnings,
    /// Channels so far.
    channels: u64,
}

impl Reader<'_, '_> {
    fn clip(&mut self, animation: &json::Animation, at: &str) -> Outcome<Clip> {
        let mut clip = Clip { name: animation.name.clone().unwrap_or_default(), ..Clip::default() };
        let mut moved = HashSet::new();
        for (i, channel) in animation.channels.iter().enumerate() {
            let place = format!("{at}.channels[{i}]");
            self.channels += 1;
            if self.channels > limits::CHANNELS {
                let reason = format!("more than {} channels of animations", limits::CHANNELS);
                return Err(Fault::too_large(place, reason));
            }
            let Some((node, property)) = self.target(&channel.target) else { continue };
            if !moved.insert((node, property)) {
                let reason = "another channel of this animation moves the same";
                return Err(Fault::invalid(format!("{place}.target"), reason));
            }
            let sampler = &animation.samplers[channel.sampler];
            let targets = self.morph_targets(node);
            if property == Property::Weights && targets == 0 {
                self.warnings.tally("animated morph weights of nodes without morph targets are ignored", 1);
                continue;
            }
            if property != Property::Weights && !self.come_apart(node) {
                self.warnings.tally("animated nodes with a matrix that shears stay as they are", 1);
                continue;
            }
            let at = format!("{at}.samplers[{}]", channel.sampler);
            clip.channels.push(read_channel(
                self.doc,
                self.hierarchy.rank[node],
                property,
                targets,
                sampler,
                &at,
            )?);
        }
        let ends = clip.channels.iter().filter_map(|channel| channel.times.last());
        clip.duration = ends.copied().fold(0.0, f32::max);
        self.warnings.tally("animations move nothing", clip.channels.is_empty().into());
        Ok(clip)
    }

    /// What a channel moves; `None` if it is to be ignored.
    fn target(&mut self, target: &json::ChannelTarget) -> Option<(Index, Property)> {
        let property = match target.path.as_str() {
            "translation" => Property::Translation,
            "rotation" => Property::Rotation,
            "scale" => Property::Scale,
            "weights" => Property::Weights,
            _ => {
                self.warnings.tally("animated properties that are not known are ignored", 1);
                return None;
            }
        };
        // Extensions may name another target than a node; the specification has us ignore such channels.
        target.node.map(|node| (node, property))
    }

    /// Number of morph targets of what `node` shows.
    fn morph_targets(&self, node: Index) -> usize {
        let root = self.doc.root;
        let mesh = root.nodes[node].mesh.map(|mesh| &root.meshes[mesh]);
        let primitives = mesh.iter().flat_map(|mesh| &mesh.primitives);
        primitives.map(|primitive| primitive.targets.len()).max().unwrap_or(0)
    }

    /// Makes translation, rotation and scale of the `node` accessible; `false` where that is impossible.
    fn come_apart(&mut self, node: Index) -> bool {
        let local = &mut self.nodes[self.hierarchy.rank[node] as usize].local;
        if let Local::Matrix(matrix) = local {
            let Some(parts) = decompose(matrix) else { return false };
            *local = Local::Trs(parts);
        }
        true
    }
}

/// Keyframes of `property` of a node with `targets` morph targets.
fn read_channel(
    doc: &Document<'_>,
    node: u32,
    property: Property,
    targets: usize,
    sampler: &json::AnimationSampler,
    at: &str,
) -> Outcome<Channel> {
    let interpolation = match sampler.interpolation.as_deref() {
        None | Some("LINEAR") => Interpolation::Linear,
        Some("STEP") => Interpolation::Step,
        Some("CUBICSPLINE") => Interpolation::Cubic,
        Some(other) => {
            let reason = format!("no such interpolation: {}", quoted(other));
            return Err(Fault::invalid(format!("{at}.interpolation"), reason));
        }
    };
    let elements = if interpolation == Interpolation::Cubic { 3 } else { 1 };
    let per_keyframe = elements * if property == Property::Weights { targets as u64 } else { 1 };
    expect_counts(doc, sampler, per_keyframe, at)?;
    let times = read_times(doc, sampler.input, &format!("{at}.input"))?;
    let place = format!("{at}.output");
    let values = match property {
        Property::Translation | Property::Scale => {
            doc.read::<3>(sampler.output, Accept::Float, &place)?.into_flattened()
        }
        Property::Rotation => {
            doc.read::<4>(sampler.output, Accept::FloatOrNormalized, &place)?.into_flattened()
        }
        Property::Weights => {
            doc.read::<1>(sampler.output, Accept::FloatOrNormalized, &place)?.into_flattened()
        }
    };
    let width = values.len() / (times.len() * elements as usize);
    for (keyframe, values) in values.chunks_exact(width * elements as usize).enumerate() {
        if values.iter().any(|value| !value.is_finite()) {
            let reason = format!("keyframe {keyframe}: beyond the range of numbers");
            return Err(Fault::invalid(place, reason));
        }
        // The value itself lies between the tangents; these may be zero.
        let value = &values[elements as usize / 2 * width..][..width];
        if property == Property::Rotation && value.iter().all(|&x| x == 0.0) {
            return Err(Fault::invalid(place, format!("keyframe {keyframe}: quaternion of length zero")));
        }
    }
    Ok(Channel { node, property, interpolation, times, values })
}

/// There is a keyframe, and the output has `per_keyframe` elements for each.
fn expect_counts(
    doc: &Document<'_>,
    sampler: &json::AnimationSampler,
    per_keyframe: u64,
    at: &str,
) -> Outcome<()> {
    let place = format!("{at}.output");
    let keyframes = doc.count(sampler.input, &format!("{at}.input"))?;
    let values = doc.count(sampler.output, &place)?;
    if keyframes == 0 {
        return Err(Fault::invalid(format!("{at}.input"), "no keyframes"));
    }
    if keyframes.checked_mul(per_keyframe) != Some(values) {
        let needed = u128::from(keyframes) * u128::from(per_keyframe);
        let reason = format!("{values} elements, {keyframes} keyframes need {needed}");
        return Err(Fault::invalid(place, reason));
    }
    Ok(())
}

fn read_times(doc: &Document<'_>, accessor: Index, at: &str) -> Outcome<Vec<f32>> {
    let times = doc.read::<1>(accessor, Accept::Float, at)?.into_flattened();
    let fault = |i: usize, reason: &str| {
        let reason = format!("keyframe {i} at {} s {reason}", times[i]);
        Err(Fault::invalid(at, format!("accessor {accessor}: {reason}")))
    };
    if let Some(i) = times.iter().position(|time| !(time.is_finite() && *time >= 0.0)) {
        return fault(i, "is not at a time from 0 on");
    }
    if let Some(i) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        return fault(i + 1, "does not come after the one before");
    }
    Ok(times)
}
