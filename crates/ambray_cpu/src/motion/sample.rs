//! How far apart two poses of a mesh are.

use ambray_scene::Mesh;
use glam::Vec3;

/// Most vertices of a sample: enough to tell poses apart, little enough to keep one a tree.
const VERTICES: usize = 256;

/// Some vertices of a mesh in one pose: the same ones in each, spread evenly over its list.
#[derive(Debug)]
pub(crate) struct Sample(Vec<Vec3>);

impl Sample {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let all = &mesh.positions;
        let count = all.len().min(VERTICES);
        Self((0..count).map(|i| all[i * all.len() / count]).collect())
    }

    /// Mean of the squared distances between the vertices in both poses, in squared units of the mesh.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let squared = |(a, b): (&Vec3, &Vec3)| a.as_dvec3().distance_squared(b.as_dvec3());
        let sum: f64 = self.0.iter().zip(&other.0).map(squared).sum();
        let mean = sum / self.0.len().max(1) as f64;
        // Nothing is near a vertex that is nowhere.
        if mean.is_nan() { f64::INFINITY } else { mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_is_the_mean_square() {
        let mesh = |count: usize, offset: f32| Mesh {
            positions: (0..count).map(|i| Vec3::new(i as f32, offset, 0.0)).collect(),
            ..Mesh::default()
        };
        for count in [1, 255, 256, 257, 1000] {
            let (a, b) = (Sample::of(&mesh(count, 0.0)), Sample::of(&mesh(count, 3.0)));
            assert_eq!(a.0.len(), count.min(256));
            assert_eq!(a.distance(&b), 9.0);
            assert_eq!(a.distance(&a), 0.0);
        }
        assert_eq!(Sample::of(&mesh(0, 0.0)).distance(&Sample::of(&mesh(0, 1.0))), 0.0);
    }
}
