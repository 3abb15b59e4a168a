//! Memory of planes, kept from frame to frame: a fresh plane costs a page fault for every four kilobytes, and the system
//! clears what it maps.

use ambray_core::{
    filter::Guide,
    frame::{Frame, GBufferPixel},
};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::pass1::Scratches;

/// Planes that nobody needs any more, and other memory that frames take.
#[derive(Debug, Default)]
pub(super) struct Planes {
    gbuffer: Shelf<GBufferPixel>,
    guides: Shelf<Guide>,
    fours: Shelf<Vec4>,
    threes: Shelf<Vec3>,
    ones: Shelf<f32>,
    /// Buffers of the tasks of pass 1.
    pub(super) scratches: Scratches,
}

/// Planes of one kind, all of one size.
#[derive(Debug)]
struct Shelf<T>(Vec<Vec<T>>);

/// A value of a plane.
pub(super) trait Pixel: Copy + Send + Sync + 'static {
    /// What a fresh plane is filled with.
    const FRESH: Self;
    /// Planes of this kind that a frame takes, at most.
    const MOST: usize;
    #[doc(hidden)]
    fn shelf(planes: &mut Planes) -> &mut Vec<Vec<Self>>;
}

macro_rules! pixels {
    ($($kind:ty, $field:ident, $most:literal, $fresh:expr;)+) => {
        $(impl Pixel for $kind {
            const FRESH: Self = $fresh;
            const MOST: usize = $most;
            fn shelf(planes: &mut Planes) -> &mut Vec<Vec<Self>> {
                &mut planes.$field.0
            }
        })+
    };
}
pixels! {
    GBufferPixel, gbuffer, 1, Self::NOTHING;
    Guide, guides, 2, Self::NOTHING;
    Vec4, fours, 4, Self::ZERO;
    Vec3, threes, 2, Self::ZERO;
    f32, ones, 1, 0.0;
}

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl Planes {
    /// A plane of `pixels` pixels whose values are to be written: they are those of some earlier plane.
    pub(super) fn take<T: Pixel>(&mut self, pixels: usize) -> Vec<T> {
        let shelf = T::shelf(self);
        match shelf.pop() {
            Some(plane) if plane.len() == pixels => plane,
            _ => {
                // Planes of another size are of no use.
                shelf.clear();
                // By all threads, which share the page faults.
                (0..pixels).into_par_iter().with_min_len(1 << 16).map(|_| T::FRESH).collect()
            }
        }
    }

    /// Takes back a plane that is not needed any more.
    pub(super) fn give<T: Pixel>(&mut self, plane: Vec<T>) {
        let shelf = T::shelf(self);
        if shelf.len() < T::MOST && !plane.is_empty() {
            shelf.push(plane);
        }
    }

    /// Takes back all planes of `frame`.
    pub(super) fn give_frame(&mut self, frame: Frame) {
        let Frame { beauty, gbuffer, ambient_raw, ambient, bent, history, .. } = frame;
        self.give(gbuffer);
        self.give(ambient_raw);
        self.give(ambient);
        self.give(beauty);
        self.give(bent);
        self.give(history);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_come_back_if_they_fit() {
        let mut planes = Planes::default();
        let plane: Vec<Vec4> = planes.take(300_000);
        assert!(plane.len() == 300_000 && plane.iter().all(|&v| v == Vec4::ZERO));
        let memory = plane.as_ptr();
        planes.give(plane);
        let again: Vec<Vec4> = planes.take(300_000);
        assert_eq!(again.as_ptr(), memory);
        planes.give(again);
        assert_eq!(planes.take::<Vec4>(10).len(), 10);
        assert!(planes.fours.0.is_empty());
        (0..10).for_each(|_| planes.give(vec![0.0; 5]));
        assert_eq!(planes.ones.0.len(), 1);
    }
}
