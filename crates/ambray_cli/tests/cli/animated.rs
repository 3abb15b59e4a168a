//! A small animated scene as glTF text.

use super::Bench;

/// Numbers of the scene's buffer, one after the other.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Buffer {
    /// Adds an accessor of floats, `width` numbers an element, and returns its index.
    fn floats(&mut self, values: &[f32], width: usize) -> usize {
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        let corner = |pick: fn(f32, f32) -> f32, start: f32| {
            let of = |i: usize| values.iter().skip(i).step_by(width).copied().fold(start, pick);
            (0..width).map(|i| of(i).to_string()).collect::<Vec<_>>().join(",")
        };
        let (low, high) = (corner(f32::min, 1e9), corner(f32::max, -1e9));
        let count = values.len() / width;
        self.views.push(format!(
            "{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}",
            self.bytes.len(),
            4 * values.len()
        ));
        self.accessors.push(format!(
            "{{\"bufferView\":{},\"componentType\":5126,\"count\":{count},\"type\":\"{kind}\",\"min\":[{low}],\"max\":[{high}]}}",
            self.accessors.len()
        ));
        self.bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self.accessors.len() - 1
    }

    /// As a data URI.
    fn uri(&self) -> String {
        const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = "data:application/octet-stream;base64,".to_owned();
        assert!(self.bytes.len().is_multiple_of(3), "three bytes become four digits");
        for three in self.bytes.chunks_exact(3) {
            let bits = u32::from_be_bytes([0, three[0], three[1], three[2]]);
            text.extend([18, 12, 6, 0].map(|shift| char::from(DIGITS[(bits >> shift & 63) as usize])));
        }
        text
    }
}

/// A floor of 4 × 4 units, and above it a lid of two triangles. The animation "Slide" moves the lid by 1 along x within one
/// second and back in another; "Bend" bends it up by a morph target in half a second.
pub(super) fn gltf() -> String {
    lasting(2.0)
}

/// The same where "Slide" ends after so many seconds.
pub(super) fn lasting(end: f32) -> String {
    let mut buffer = Buffer::default();
    let quad = |half: f32, y: f32| {
        let corners = [[-half, y, -half], [-half, y, half], [half, y, half], [half, y, -half]];
        [0, 1, 2, 0, 2, 3].map(|i: usize| corners[i]).concat()
    };
    let floor = buffer.floats(&quad(2.0, 0.0), 3);
    let lid = buffer.floats(&quad(0.8, 0.5), 3);
    let bend: Vec<f32> = quad(0.8, 0.5).chunks(3).flat_map(|p| [0.0, 0.5 * (p[0] + 0.8), 0.0]).collect();
    let bend = buffer.floats(&bend, 3);
    let seconds = buffer.floats(&[0.0, 1.0, end], 1);
    let places = buffer.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 3);
    let half = buffer.floats(&[0.0, 0.25, 0.5], 1);
    let weights = buffer.floats(&[0.0, 1.0, 0.0], 1);
    let clip = |name: &str, times: usize, values: usize, path: &str| {
        format!(
            "{{\"name\":\"{name}\",\"samplers\":[{{\"input\":{times},\"output\":{values}}}],\
             \"channels\":[{{\"sampler\":0,\"target\":{{\"node\":1,\"path\":\"{path}\"}}}}]}}"
        )
    };
    format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0,1,2]}}],\n\
         \"nodes\":[{{\"name\":\"floor\",\"mesh\":0}},{{\"name\":\"lid\",\"mesh\":1}},\
         {{\"camera\":0,\"translation\":[0,1.5,5]}}],\n\
         \"cameras\":[{{\"type\":\"perspective\",\"perspective\":{{\"yfov\":0.8,\"znear\":0.1}}}}],\n\
         \"meshes\":[{{\"name\":\"floor\",\"primitives\":[{{\"attributes\":{{\"POSITION\":{floor}}}}}]}},\n\
         {{\"name\":\"lid\",\"primitives\":[{{\"attributes\":{{\"POSITION\":{lid}}},\"targets\":[{{\"POSITION\":{bend}}}]}}]}}],\n\
         \"animations\":[{},{}],\n\
         \"buffers\":[{{\"byteLength\":{},\"uri\":\"{}\"}}],\n\"bufferViews\":[{}],\n\"accessors\":[{}]}}\n",
        clip("Slide", seconds, places, "translation"),
        clip("Bend", half, weights, "weights"),
        buffer.bytes.len(),
        buffer.uri(),
        buffer.views.join(","),
        buffer.accessors.join(",")
    )
}

impl Bench {
    /// With the animated scene in the file `moving.gltf`.
    pub(super) fn animated() -> Self {
        let bench = Self::new();
        bench.write("moving.gltf", &gltf());
        bench
    }

    /// Renders the animated scene quickly with further arguments.
    pub(super) fn animate(&self, arguments: &[&str]) -> super::Run {
        self.run(&[&["render", "moving.gltf"], &super::QUICK[..], arguments].concat())
    }

    /// Names of the files besides the scenes, sorted, also those in the folder `out`.
    pub(super) fn made(&self) -> Vec<String> {
        let mut names = self.files();
        names.retain(|name| name != "moving.gltf" && name != "out");
        if let Ok(entries) = std::fs::read_dir(self.path("out")) {
            names.extend(entries.map(|e| format!("out/{}", e.expect("entry").file_name().to_string_lossy())));
        }
        names.sort();
        names
    }
}
