//! Animated glTF files made up on the spot.

use base64::Engine as _;

/// What an accessor of [`gltf`] holds.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Data<'d> {
    Scalars(&'d [f32]),
    Vec3s(&'d [[f32; 3]]),
    Vec4s(&'d [[f32; 4]]),
    /// Normalised signed bytes.
    Bytes(&'d [[i8; 4]]),
    /// Unsigned bytes as they are.
    Joints(&'d [[u8; 4]]),
    /// Any number of zeros that are not stored: count and type.
    Zeros(u64, &'d str),
}

/// A file with `accessors`, in this order, and `rest` in its root object.
pub(crate) fn gltf(accessors: &[Data<'_>], rest: &str) -> String {
    let (mut bytes, mut views, mut texts) = (Vec::new(), Vec::new(), Vec::new());
    for accessor in accessors {
        let (data, kind, count, shape): (Vec<u8>, u32, u64, &str) = match accessor {
            Data::Scalars(list) => (floats(list), 5126, list.len() as u64, "SCALAR"),
            Data::Vec3s(list) => (floats(list.as_flattened()), 5126, list.len() as u64, "VEC3"),
            Data::Vec4s(list) => (floats(list.as_flattened()), 5126, list.len() as u64, "VEC4"),
            Data::Bytes(list) => {
                (list.as_flattened().iter().map(|&x| x as u8).collect(), 5120, list.len() as u64, "VEC4")
            }
            Data::Joints(list) => (list.as_flattened().to_vec(), 5121, list.len() as u64, "VEC4"),
            Data::Zeros(count, shape) => {
                texts.push(format!(r#"{{"componentType":5126,"count":{count},"type":"{shape}"}}"#));
                continue;
            }
        };
        let normalized = matches!(accessor, Data::Bytes(_));
        views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, bytes.len(), data.len()));
        texts.push(format!(
            r#"{{"bufferView":{},"componentType":{kind},"count":{count},"type":"{shape}","normalized":{normalized}}}"#,
            views.len() - 1
        ));
        bytes.extend(data);
    }
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},
        "buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{data}"}}],
        "bufferViews":[{}],"accessors":[{}],{rest}}}"#,
        bytes.len(),
        views.join(","),
        texts.join(",")
    )
}

fn floats(list: &[f32]) -> Vec<u8> {
    list.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Positions of a triangle.
pub(crate) const TRIANGLE: Data<'_> = Data::Vec3s(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
