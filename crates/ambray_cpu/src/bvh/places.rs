//! Which boxes are in one place: the builder of binary trees takes the square of their number.

use std::collections::HashMap;

use super::layout::Bounds;

/// Boxes in one place up to this many are left to the builder: it joins two of them as well as anybody.
const FEW: u32 = 64;
/// Counters by which crowded places are found.
const COUNTERS: usize = 1 << 16;

/// Primitives by the place of their boxes.
pub(super) struct Places {
    /// Primitives, place after place.
    primitives: Vec<u32>,
    /// Where each place begins in them, and the end; empty where every primitive has a place of its own.
    starts: Vec<u32>,
}

impl Places {
    /// Primitive i has `boxes[i]`. Unless some place is crowded, each has a place of its own.
    pub(super) fn of(boxes: &[Bounds]) -> Self {
        let all = 0..boxes.len() as u32;
        if !is_crowded(boxes) {
            return Self { primitives: all.collect(), starts: Vec::new() };
        }
        let mut places: HashMap<[u32; 6], u32> = HashMap::new();
        let mut members: Vec<Vec<u32>> = Vec::new();
        for primitive in all {
            let place = *places.entry(bits(&boxes[primitive as usize])).or_insert_with(|| {
                members.push(Vec::new());
                members.len() as u32 - 1
            });
            members[place as usize].push(primitive);
        }
        let mut starts = vec![0];
        starts.extend(members.iter().scan(0, |end, place| {
            *end += place.len() as u32;
            Some(*end)
        }));
        Self { primitives: members.concat(), starts }
    }

    /// Number of places.
    pub(super) const fn count(&self) -> usize {
        if self.starts.is_empty() { self.primitives.len() } else { self.starts.len() - 1 }
    }

    /// Primitives at a place, in ascending order.
    pub(super) fn primitives(&self, place: usize) -> &[u32] {
        match self.starts.get(place..place + 2) {
            Some(range) => &self.primitives[range[0] as usize..range[1] as usize],
            None => &self.primitives[place..=place],
        }
    }
}

/// Whether more than some boxes may be in one place: by counters, which places share by chance.
fn is_crowded(boxes: &[Bounds]) -> bool {
    let limit = FEW + (4 * boxes.len() / COUNTERS) as u32;
    if boxes.len() <= FEW as usize {
        return false;
    }
    let mut counts = vec![0_u32; COUNTERS];
    boxes.iter().any(|b| {
        // Fowler, Noll and Vo's hash, word by word.
        let hash = bits(b).iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &word| {
            (hash ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        let counter = &mut counts[(hash >> 48) as usize];
        *counter += 1;
        *counter > limit
    })
}

fn bits(b: &Bounds) -> [u32; 6] {
    let ([a, b, c], [d, e, f]) = (b.lo.to_array(), b.hi.to_array());
    [a, b, c, d, e, f].map(f32::to_bits)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn at(x: u32) -> Bounds {
        let lo = Vec3::splat(x as f32);
        Bounds { lo, hi: lo + 1.0 }
    }

    #[test]
    fn crowds_share_a_place() {
        // Every third of a thousand is at 7.
        let boxes: Vec<_> = (0..1000).map(|i| at(if i % 3 == 0 { 7 } else { 100 + i })).collect();
        let places = Places::of(&boxes);
        let sizes: Vec<_> = (0..places.count()).map(|place| places.primitives(place).len()).collect();
        assert_eq!((sizes.iter().sum::<usize>(), sizes.iter().max()), (1000, Some(&334)));
        for place in 0..places.count() {
            let members = places.primitives(place);
            assert!(members.iter().all(|&i| boxes[i as usize] == boxes[members[0] as usize]));
        }
    }

    #[test]
    fn others_have_places_of_their_own() {
        // Pairs in one place, as the two triangles of a quad.
        let boxes: Vec<_> = (0..300_000).map(|i| at(i / 2)).collect();
        let places = Places::of(&boxes);
        assert_eq!(places.count(), boxes.len());
        assert_eq!(places.primitives(77), [77]);
        assert_eq!(Places::of(&[]).count(), 0);
    }
}
