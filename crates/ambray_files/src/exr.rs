//! OpenEXR files: the picture as R, G, B, every other plane as a layer `plane.channel`; 32-bit floats, linear, ZIP.

use ambray::{
    Aov, Frame,
    camera::{Camera, Projection},
};
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Compression, Encoding, FlatSamples, Image, Layer,
    LayerAttributes, LineOrder, SmallVec, Text, WritableImage as _, attribute::Matrix4x4,
};

use crate::{atomic::Output, head::SOFTWARE};

/// Attribute that holds the settings as TOML.
pub(crate) const SETTINGS_ATTRIBUTE: &str = "ambraySettings";

/// Writes the picture and `planes` of `frame`; `settings` as TOML and the name of the scene go to the header.
pub(crate) fn write(
    output: &mut dyn Output,
    frame: &Frame,
    planes: &[Aov],
    settings: &str,
    scene: &str,
) -> anyhow::Result<()> {
    let size = (frame.width as usize, frame.height as usize);
    let mut channels = SmallVec::new();
    for aov in with_picture(planes) {
        channels.extend(layer(frame, aov));
    }
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: exr::image::Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let attributes = attributes(frame, settings, scene);
    let image = Image::from_layer(Layer::new(size, attributes, encoding, AnyChannels::sort(channels)));
    Ok(image.write().to_buffered(output)?)
}

/// Names of the channels of a file with `planes` besides the picture, in its order.
#[must_use]
pub(crate) fn channel_names(planes: &[Aov]) -> Vec<String> {
    let mut names: Vec<_> = with_picture(planes).flat_map(names).collect();
    names.sort();
    names
}

fn with_picture(planes: &[Aov]) -> impl Iterator<Item = Aov> {
    std::iter::once(Aov::Beauty).chain(planes.iter().copied().filter(|aov| *aov != Aov::Beauty))
}

fn names(aov: Aov) -> impl Iterator<Item = String> {
    let name = move |channel: &&str| {
        if aov == Aov::Beauty { (*channel).to_owned() } else { format!("{aov}.{channel}") }
    };
    aov.channels().iter().map(name)
}

fn layer(frame: &Frame, aov: Aov) -> impl Iterator<Item = AnyChannel<FlatSamples>> {
    let values = frame.plane(aov);
    let count = aov.channels().len();
    names(aov).enumerate().map(move |(i, name)| {
        let samples = values.iter().skip(i).step_by(count).copied().collect();
        AnyChannel::new(name.as_str(), FlatSamples::F32(samples))
    })
}

fn attributes(frame: &Frame, settings: &str, scene: &str) -> LayerAttributes {
    let camera = &frame.view.camera;
    let vertical = match camera.projection() {
        Projection::Perspective { vertical_fov } => Some(vertical_fov.to_degrees()),
        Projection::Orthographic { .. } => None,
    };
    let horizontal = vertical.map(|degrees| {
        let half_height = (0.5 * degrees.to_radians()).tan();
        (2.0 * (half_height * frame.width as f32 / frame.height as f32).atan()).to_degrees()
    });
    // exr keeps other attributes in no particular order: a second one would make the bytes of the file random.
    let other = [(Text::from(SETTINGS_ATTRIBUTE), AttributeValue::Text(utf8(settings)))];
    LayerAttributes {
        software_name: Some(Text::from(SOFTWARE)),
        comments: Some(utf8(scene)),
        world_to_camera: Some(world_to_camera(camera)),
        vertical_field_of_view: vertical,
        horizontal_field_of_view: horizontal,
        other: other.into_iter().collect(),
        ..LayerAttributes::default()
    }
}

/// Text as UTF-8, as other programs write it; the `From` of [`Text`] would refuse what Latin-1 lacks.
fn utf8(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

/// For row vectors, p · M, as OpenEXR has it: x right, y up, z forward.
fn world_to_camera(camera: &Camera) -> Matrix4x4 {
    let axes = [camera.right(), camera.up(), camera.forward()].map(|axis| axis.to_array());
    let position = camera.position().to_array();
    let dot = |axis: [f32; 3]| (0..3).map(|i| axis[i] * position[i]).sum::<f32>();
    let mut matrix = [0.0; 16];
    for (column, axis) in axes.into_iter().enumerate() {
        for row in 0..3 {
            matrix[4 * row + column] = axis[row];
        }
        matrix[12 + column] = -dot(axis);
    }
    matrix[15] = 1.0;
    matrix
}
