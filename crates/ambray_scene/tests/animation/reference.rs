//! Poses by another way: straight from the JSON, with matrices of doubles, arcs by their cosine and curves by de Casteljau.

use std::path::Path;

use serde_json::Value;

/// Columns of a 4 × 4 matrix.
pub(crate) type Matrix = [[f64; 4]; 4];
/// World positions and unit normals of a triangle's corners; normals are NaN where the file has none.
pub(crate) type Corners = [([f64; 3], [f64; 3]); 3];

/// A file and its buffers.
#[derive(Debug)]
pub(crate) struct Reference {
    json: Value,
    buffers: Vec<Vec<u8>>,
}

impl Reference {
    pub(crate) fn read(path: &Path) -> Self {
        use base64::Engine as _;
        let bytes = std::fs::read(path).expect("a file");
        let glb = bytes.starts_with(b"glTF");
        let length = if glb { u32::from_le_bytes(bytes[12..16].try_into().expect("4")) as usize } else { 0 };
        let text = if glb { &bytes[20..20 + length] } else { &bytes[..] };
        let json: Value = serde_json::from_slice(text).expect("JSON");
        let buffer = |buffer: &Value| match buffer["uri"].as_str() {
            None => bytes[28 + length..].to_vec(),
            Some(uri) => match uri.split_once(";base64,") {
                Some((_, data)) => base64::engine::general_purpose::STANDARD.decode(data).expect("base64"),
                None => {
                    let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy().into_owned();
                    std::fs::read(path.with_file_name(name)).expect("a buffer")
                }
            },
        };
        let buffers = list(&json["buffers"]).iter().map(buffer).collect();
        Self { json, buffers }
    }

    /// Number of animations.
    pub(crate) fn clips(&self) -> usize {
        list(&self.json["animations"]).len()
    }

    /// Times of all keyframes of animation `clip`.
    pub(crate) fn times(&self, clip: usize) -> Vec<f64> {
        let samplers = list(&self.json["animations"][clip]["samplers"]);
        let mut times: Vec<f64> =
            samplers.iter().flat_map(|s| self.accessor(index(&s["input"])).concat()).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Elements of an accessor.
    fn accessor(&self, index: usize) -> Vec<Vec<f64>> {
        let accessor = &self.json["accessors"][index];
        assert!(accessor["sparse"].is_null(), "sparse accessors are not read here");
        let size = |t: &Value| match t.as_str() {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            _ => 16,
        };
        let (n, kind) = (size(&accessor["type"]), number(&accessor["componentType"], 0.0) as u32);
        let bytes = match kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        };
        let count = number(&accessor["count"], 0.0) as usize;
        if accessor["bufferView"].is_null() {
            return vec![vec![0.0; n]; count];
        }
        let view = &self.json["bufferViews"][self::index(&accessor["bufferView"])];
        let data = &self.buffers[self::index(&view["buffer"])];
        let offset = number(&view["byteOffset"], 0.0) + number(&accessor["byteOffset"], 0.0);
        let stride = number(&view["byteStride"], (n * bytes) as f64) as usize;
        let normalized = accessor["normalized"] == Value::Bool(true);
        let component = |at: usize| {
            let b = &data[at..at + bytes];
            let (value, largest) = match kind {
                5120 => (f64::from(b[0] as i8), 127.0),
                5121 => (f64::from(b[0]), 255.0),
                5122 => (f64::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
                5123 => (f64::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
                5125 => (f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.0),
                _ => (f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.0),
            };
            if normalized { (value / largest).max(-1.0) } else { value }
        };
        let element =
            |k: usize| (0..n).map(|i| component(offset as usize + k * stride + i * bytes)).collect();
        (0..count).map(element).collect()
    }

    /// Value of a sampler at `time`; `rotation` for quaternions.
    fn sample(&self, sampler: &Value, time: f64, rotation: bool) -> Vec<f64> {
        let times = self.accessor(index(&sampler["input"])).concat();
        let output = self.accessor(index(&sampler["output"])).concat();
        let mode = sampler["interpolation"].as_str().unwrap_or("LINEAR");
        let thirds = if mode == "CUBICSPLINE" { 3 } else { 1 };
        let width = output.len() / times.len() / thirds;
        let part = |key: usize, third: usize| &output[(key * thirds + third) * width..][..width];
        let value = |key: usize| part(key, if thirds == 3 { 1 } else { 0 }).to_vec();
        // A plain search from the front.
        let Some(next) = times.iter().position(|&t| t > time) else { return value(times.len() - 1) };
        if next == 0 {
            return value(0);
        }
        let gap = times[next] - times[next - 1];
        let t = (time - times[next - 1]) / gap;
        let (a, b) = (value(next - 1), value(next));
        match mode {
            "STEP" => a,
            "LINEAR" if rotation => arc(&a, &b, t),
            "LINEAR" => a.iter().zip(&b).map(|(a, b)| a * (1.0 - t) + b * t).collect(),
            _ => {
                let (leave, arrive) = (part(next - 1, 2), part(next, 0));
                let point = |i: usize| {
                    casteljau([a[i], a[i] + leave[i] * gap / 3.0, b[i] - arrive[i] * gap / 3.0, b[i]], t)
                };
                (0..width).map(point).collect()
            }
        }
    }

    /// The sampler that moves `path` of `node` in animation `clip`.
    fn sampler(&self, clip: Option<usize>, node: usize, path: &str) -> Option<&Value> {
        let animation = &self.json["animations"][clip?];
        let of =
            |c: &&Value| c["target"]["node"].as_u64() == Some(node as u64) && c["target"]["path"] == path;
        let channel = list(&animation["channels"]).iter().find(of)?;
        Some(&animation["samplers"][index(&channel["sampler"])])
    }

    fn local(&self, node: usize, clip: Option<usize>, time: f64) -> Matrix {
        let json = &self.json["nodes"][node];
        if let Some(matrix) = json["matrix"].as_array() {
            let m: Vec<f64> = matrix.iter().map(|x| number(x, 0.0)).collect();
            return std::array::from_fn(|c| std::array::from_fn(|r| m[4 * c + r]));
        }
        let property = |path: &str, default: &[f64]| match self.sampler(clip, node, path) {
            Some(sampler) => self.sample(sampler, time, path == "rotation"),
            None if json[path].is_null() => default.to_vec(),
            None => list(&json[path]).iter().map(|x| number(x, 0.0)).collect(),
        };
        let (t, s) = (property("translation", &[0.0; 3]), property("scale", &[1.0; 3]));
        let q = property("rotation", &[0.0, 0.0, 0.0, 1.0]);
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [x, y, z, w] = std::array::from_fn(|i| q[i] / length);
        let rows = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let column = |c: usize| [rows[0][c] * s[c], rows[1][c] * s[c], rows[2][c] * s[c], 0.0];
        [column(0), column(1), column(2), [t[0], t[1], t[2], 1.0]]
    }

    fn children(&self, node: usize) -> Vec<usize> {
        list(&self.json["nodes"][node]["children"]).iter().map(index).collect()
    }

    /// World matrices of all nodes.
    pub(crate) fn world(&self, clip: Option<usize>, time: f64) -> Vec<Matrix> {
        let count = list(&self.json["nodes"]).len();
        let parent = |node: usize| (0..count).find(|&p| self.children(p).contains(&node));
        let world = |node: usize| {
            let mut matrix = self.local(node, clip, time);
            let mut above = parent(node);
            while let Some(node) = above {
                matrix = product(&self.local(node, clip, time), &matrix);
                above = parent(node);
            }
            matrix
        };
        (0..count).map(world).collect()
    }

    /// Nodes in depth-first order: all, or those of the scene that is shown.
    pub(crate) fn order(&self, shown: bool) -> Vec<usize> {
        let count = list(&self.json["nodes"]).len();
        let is_child = |node: usize| (0..count).any(|p| self.children(p).contains(&node));
        let scene = &self.json["scenes"][number(&self.json["scene"], 0.0) as usize];
        let roots: Vec<usize> = match scene["nodes"].as_array() {
            Some(nodes) if shown => nodes.iter().map(index).collect(),
            _ => (0..count).filter(|&node| !is_child(node)).collect(),
        };
        let mut order = Vec::new();
        roots.into_iter().for_each(|root| self.descend(root, &mut order));
        order
    }

    fn descend(&self, node: usize, order: &mut Vec<usize>) {
        order.push(node);
        self.children(node).into_iter().for_each(|child| self.descend(child, order));
    }

    /// Joint matrices of skin `skin`.
    pub(crate) fn joints(&self, skin: usize, world: &[Matrix]) -> Vec<Matrix> {
        let json = &self.json["skins"][skin];
        let binds = json["inverseBindMatrices"].as_u64().map(|i| self.accessor(i as usize));
        let joint = |(i, joint): (usize, &Value)| match &binds {
            Some(binds) => {
                let bind = std::array::from_fn(|c| std::array::from_fn(|r| binds[i][4 * c + r]));
                product(&world[index(joint)], &bind)
            }
            None => world[index(joint)],
        };
        list(&json["joints"]).iter().enumerate().map(joint).collect()
    }

    /// Skin of the first node that is shown and has one.
    pub(crate) fn first_skin(&self) -> Option<usize> {
        self.order(true)
            .into_iter()
            .find_map(|node| Some(self.json["nodes"][node]["skin"].as_u64()? as usize))
    }

    /// Triangles in the world: a list for each primitive of each node that is shown.
    pub(crate) fn triangles(&self, clip: Option<usize>, time: f64) -> Vec<Vec<Corners>> {
        let world = self.world(clip, time);
        let mut lists = Vec::new();
        for node in self.order(true) {
            let json = &self.json["nodes"][node];
            if json["mesh"].is_null() {
                continue;
            }
            let mesh = &self.json["meshes"][index(&json["mesh"])];
            let weights = match self.sampler(clip, node, "weights") {
                Some(sampler) => {
                    // A keyframe's weights are one element of the accessor each.
                    self.sample(sampler, time, false)
                }
                None => {
                    let own = list(&json["weights"]);
                    let at_rest = if own.is_empty() { list(&mesh["weights"]) } else { own };
                    at_rest.iter().map(|x| number(x, 0.0)).collect()
                }
            };
            let joints = json["skin"].as_u64().map(|skin| self.joints(skin as usize, &world));
            for primitive in list(&mesh["primitives"]) {
                assert!(number(&primitive["mode"], 4.0) == 4.0, "only triangle lists are read here");
                lists.push(self.primitive(primitive, &weights, joints.as_deref(), &world[node]));
            }
        }
        lists
    }

    fn primitive(
        &self,
        primitive: &Value,
        weights: &[f64],
        joints: Option<&[Matrix]>,
        world: &Matrix,
    ) -> Vec<Corners> {
        let attribute = |set: &Value, name: &str| set[name].as_u64().map(|i| self.accessor(i as usize));
        let attributes = &primitive["attributes"];
        let mut positions = attribute(attributes, "POSITION").expect("positions");
        let mut normals = attribute(attributes, "NORMAL");
        for (target, weight) in list(&primitive["targets"]).iter().zip(weights) {
            let add = |to: &mut Vec<Vec<f64>>, name: &str| {
                for (to, delta) in to.iter_mut().zip(attribute(target, name).unwrap_or_default()) {
                    to.iter_mut().zip(delta).for_each(|(to, delta)| *to += weight * delta);
                }
            };
            add(&mut positions, "POSITION");
            if let Some(normals) = &mut normals {
                add(normals, "NORMAL");
            }
        }
        let mut pulls: Vec<Vec<(usize, f64)>> = vec![Vec::new(); positions.len()];
        for set in 0.. {
            let of = |name: &str| attribute(attributes, &format!("{name}_{set}"));
            let (Some(j), Some(w)) = (of("JOINTS"), of("WEIGHTS")) else { break };
            for (i, pulls) in pulls.iter_mut().enumerate() {
                pulls.extend(j[i].iter().map(|&joint| joint as usize).zip(w[i].iter().copied()));
            }
        }
        let matrix = |i: usize| match joints.filter(|_| !pulls[i].is_empty()) {
            None => *world,
            Some(joints) => {
                let total: f64 = pulls[i].iter().map(|(_, weight)| weight).sum();
                let entry = |c: usize, r: usize| {
                    let sum: f64 = pulls[i].iter().map(|&(joint, w)| w * joints[joint][c][r]).sum();
                    if total > 0.0 { sum / total } else { joints[pulls[i][0].0][c][r] }
                };
                std::array::from_fn(|c| std::array::from_fn(|r| entry(c, r)))
            }
        };
        let corner = |i: usize| {
            let m = matrix(i);
            let p = &positions[i];
            let position =
                std::array::from_fn(|r| m[0][r] * p[0] + m[1][r] * p[1] + m[2][r] * p[2] + m[3][r]);
            let normal = normals.as_ref().map_or([f64::NAN; 3], |normals| turn_normal(&m, &normals[i]));
            (position, normal)
        };
        let indices: Vec<usize> = match primitive["indices"].as_u64() {
            Some(indices) => self.accessor(indices as usize).concat().iter().map(|&i| i as usize).collect(),
            None => (0..positions.len()).collect(),
        };
        indices.chunks_exact(3).map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]).collect()
    }
}

/// The normal of a plane that `m` moves: by the images of two vectors in the plane.
fn turn_normal(m: &Matrix, n: &[f64]) -> [f64; 3] {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let turn = |v: [f64; 3]| std::array::from_fn(|r| m[0][r] * v[0] + m[1][r] * v[1] + m[2][r] * v[2]);
    let n = [n[0], n[1], n[2]];
    let helper = if n[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let u = cross(n, helper);
    let v = cross(n, u);
    let normal: [f64; 3] = cross(turn(u), turn(v));
    // Mirroring turns the pair around.
    let [x, y, z] = [turn([1.0, 0.0, 0.0]), turn([0.0, 1.0, 0.0]), turn([0.0, 0.0, 1.0])];
    let c: [f64; 3] = cross(x, y);
    let mirrors = c[0] * z[0] + c[1] * z[1] + c[2] * z[2] < 0.0;
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt() * if mirrors { -1.0 } else { 1.0 };
    normal.map(|x| x / length)
}

/// The point at `t` of the shorter great arc between two quaternions.
fn arc(a: &[f64], b: &[f64], t: f64) -> Vec<f64> {
    let unit = |q: &[f64]| -> Vec<f64> {
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        q.iter().map(|x| x / length).collect()
    };
    let (a, mut b) = (unit(a), unit(b));
    let mut cos: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    if cos < 0.0 {
        b.iter_mut().for_each(|x| *x = -*x);
        cos = -cos;
    }
    // The part of b that is orthogonal to a.
    let across: Vec<f64> = a.iter().zip(&b).map(|(a, b)| b - cos * a).collect();
    let length = across.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length < 1e-12 {
        return a;
    }
    let angle = t * length.atan2(cos);
    a.iter().zip(&across).map(|(a, x)| a * angle.cos() + x / length * angle.sin()).collect()
}

/// Point of a Bézier curve.
fn casteljau(p: [f64; 4], t: f64) -> f64 {
    let mut points = p.to_vec();
    while points.len() > 1 {
        points = points.windows(2).map(|pair| pair[0] + t * (pair[1] - pair[0])).collect();
    }
    points[0]
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|c| std::array::from_fn(|r| (0..4).map(|k| a[k][r] * b[c][k]).sum()))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn number(value: &Value, default: f64) -> f64 {
    value.as_f64().unwrap_or(default)
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("an index") as usize
}
