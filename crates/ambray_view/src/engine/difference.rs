//! A − B.

use std::sync::Arc;

use ambray::{Aov, AovKind, Frame};
use rayon::prelude::*;

use super::contract::{Difference, Pixels};

/// Values that a task takes. Sums are made of such parts in their order, so they do not depend on the number of threads.
const PART: usize = 3 << 14;

/// Sums over values that are finite in both pictures.
#[derive(Clone, Copy, Default)]
struct Sums {
    squares: f64,
    plain: f64,
    count: u64,
    largest: f32,
}

impl Sums {
    fn of(part: &[f32]) -> Self {
        part.iter().filter(|d| d.is_finite()).fold(Self::default(), |sums, &d| {
            let wide = f64::from(d);
            sums.and(&Self { squares: wide * wide, plain: wide, count: 1, largest: d.abs() })
        })
    }

    fn and(self, other: &Self) -> Self {
        Self {
            squares: self.squares + other.squares,
            plain: self.plain + other.plain,
            count: self.count + other.count,
            largest: self.largest.max(other.largest),
        }
    }
}

impl Difference {
    /// The plane `aov` of `a` less that of `b`; `None` if their sizes differ.
    ///
    /// Numbers are shown with a sign: grey where they are equal, towards red where A is larger, towards blue where B is. Colours,
    /// normals and other vectors are shown as |A − B| of each channel on black. Both are scaled so that the largest difference
    /// is at the end of the scale. Indices are equal (0) or not (1).
    #[must_use]
    pub fn of(a: &Frame, b: &Frame, aov: Aov) -> Option<Self> {
        if (a.width, a.height) != (b.width, b.height) {
            return None;
        }
        let (mut values, other) = (a.plane(aov), b.plane(aov));
        let is_index = aov.kind() == AovKind::Id;
        values.par_iter_mut().zip(&other).for_each(|(a, b)| {
            *a = if is_index { f32::from(*a != *b) } else { *a - b };
        });
        let parts: Vec<Sums> = values.par_chunks(PART).map(Sums::of).collect();
        let sums = parts.iter().fold(Sums::default(), Sums::and);
        let count = sums.count.max(1) as f64;
        let rgba = picture(&values, aov.channels().len(), sums.largest);
        Some(Self {
            pixels: Arc::new(Pixels { width: a.width, height: a.height, rgba }),
            rmse: (sums.squares / count).sqrt(),
            bias: sums.plain / count,
            largest: sums.largest,
        })
    }
}

/// The differences as RGBA, relative to the `largest`.
fn picture(values: &[f32], channels: usize, largest: f32) -> Vec<u8> {
    let scale = if largest > 0.0 { largest.recip() } else { 0.0 };
    let byte = |value: f32| (value * 255.0 + 0.5) as u8;
    let part = |d: f32| if d.is_finite() { (d * scale).clamp(-1.0, 1.0) } else { 0.0 };
    let pixel = |d: &[f32]| match *d {
        [d] => {
            let (t, rest) = (part(d), 0.5 - 0.5 * part(d).abs());
            [
                byte(if t > 0.0 { 0.5 + 0.5 * t } else { rest }),
                byte(rest),
                byte(if t < 0.0 { 0.5 - 0.5 * t } else { rest }),
                u8::MAX,
            ]
        }
        _ => {
            let channel = |c: usize| d.get(c).map_or(0, |d| byte(part(*d).abs()));
            [channel(0), channel(1), channel(2), u8::MAX]
        }
    };
    values.par_chunks(channels).flat_map_iter(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_red_where_a_is_larger_and_blue_where_b_is() {
        let rgba = picture(&[0.0, 2.0, -2.0, 1.0, f32::NAN], 1, 2.0);
        let pixels: Vec<_> = rgba.chunks(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        assert_eq!(pixels, [[128; 3], [255, 0, 0], [0, 0, 255], [191, 64, 64], [128; 3]]);
    }

    #[test]
    fn colours_are_shown_channel_by_channel() {
        assert_eq!(picture(&[0.5, -1.0, 0.0], 3, 1.0), [128, 255, 0, 255]);
        assert_eq!(picture(&[0.0, -3.0], 2, 3.0), [0, 255, 0, 255]);
        assert_eq!(picture(&[0.0; 3], 3, 0.0), [0, 0, 0, 255]);
    }

    #[test]
    fn what_is_not_finite_does_not_count() {
        let sums = Sums::of(&[3.0, f32::INFINITY, -4.0, f32::NAN]);
        assert_eq!((sums.squares, sums.plain, sums.count, sums.largest), (25.0, -1.0, 2, 4.0));
    }
}
