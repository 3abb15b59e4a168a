//! Which triangles of which instances the numbers in the blocks of baked triangles mean.
//!
//! A block has room for one number a triangle. Triangles are numbered in the order in which they were baked, so long runs of
//! numbers are triangles of one instance, one after the other.

use super::build::Triangle;

/// Numbers whose first run is looked up in one step.
const CHUNK: usize = 64;

/// Triangles with successive numbers that also succeed each other in one instance.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// Number of the first.
    first: u32,
    instance: u32,
    /// Index of the first in its mesh.
    triangle: u32,
}

/// See the module.
#[derive(Debug, Default)]
pub(crate) struct Names {
    runs: Vec<Run>,
    /// For the first number of each chunk the run that it is in.
    chunks: Vec<u32>,
}

impl Names {
    /// The number of a triangle is its place in `triangles`.
    pub(crate) fn of(triangles: &[Triangle]) -> Self {
        let mut names = Self::default();
        for (number, triangle) in triangles.iter().enumerate() {
            let follows = number > 0 && {
                let before = &triangles[number - 1];
                (before.instance, before.triangle.wrapping_add(1)) == (triangle.instance, triangle.triangle)
            };
            if !follows {
                let Triangle { instance, triangle, .. } = *triangle;
                names.runs.push(Run { first: number as u32, instance, triangle });
            }
            if number % CHUNK == 0 {
                names.chunks.push(names.runs.len() as u32 - 1);
            }
        }
        names
    }

    /// Instance and triangle that `number` means.
    #[inline]
    pub(crate) fn of_number(&self, number: u32) -> (u32, u32) {
        let mut run = self.chunks[number as usize / CHUNK] as usize;
        while self.runs.get(run + 1).is_some_and(|next| next.first <= number) {
            run += 1;
        }
        let Run { first, instance, triangle } = self.runs[run];
        (instance, triangle + (number - first))
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.runs[..]) + size_of_val(&self.chunks[..])
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn every_number_means_its_triangle() {
        // Instances of one triangle and of many, with gaps where triangles were dropped.
        let named: Vec<_> = (0..300_u32)
            .flat_map(|instance| {
                (0..instance % 97 + 1)
                    .filter(move |t| (t * 7 + instance) % 11 != 0)
                    .map(move |t| (instance, t))
            })
            .collect();
        let triangle = |&(instance, triangle): &(u32, u32)| Triangle {
            corners: [Vec3::ZERO; 3],
            instance,
            triangle,
            masked: false,
        };
        let triangles: Vec<_> = named.iter().map(triangle).collect();
        let names = Names::of(&triangles);
        for (number, &name) in (0..).zip(&named) {
            assert_eq!(names.of_number(number), name, "{number}");
        }
        assert!(names.bytes() < size_of_val(&named[..]));
    }
}
