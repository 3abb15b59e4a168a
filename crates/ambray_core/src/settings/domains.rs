//! Which values settings may have, in numbers and in words.

use super::{Auto, Range, Rgb, Size, Triple, field::Domain};

/// Pictures up to this many pixels a side.
const MAX_SIDE: u32 = 32_768;
/// Pixels of a picture: their planes take 55 GB.
const MAX_PIXELS: u64 = 1 << 28;
/// Longest time in an animation, seconds: single precision tells milliseconds apart there.
const MAX_TIME: f32 = 1e4;

pub(super) const SIZE: Domain<Size> = Domain {
    allowed: "1 to 32768 pixels a side, at most 268435456 in all",
    contains: |size| {
        let fits = |side| (1..=MAX_SIDE).contains(&side);
        let pixels = u64::from(size.width) * u64::from(size.height);
        fits(size.width) && fits(size.height) && pixels <= MAX_PIXELS
    },
};

pub(super) const STOPS: Domain<f32> =
    Domain { allowed: "-64 to 64 stops", contains: |v| (-64.0..=64.0).contains(v) };

pub(super) const RAMP_ENDS: Domain<Auto<Range>> = Domain {
    allowed: "auto or two finite numbers, the smaller first",
    contains: |range| {
        range.value().is_none_or(|Range([low, high])| low.is_finite() && high.is_finite() && low < high)
    },
};

pub(super) const RAYS: Domain<u32> = Domain { allowed: "1 to 65536", contains: |v| (1..=65_536).contains(v) };

/// Far enough from the ends of single precision that squares of lengths stay numbers.
fn is_length(v: f32) -> bool {
    (1e-15..=1e15).contains(&v)
}

pub(super) const LENGTH: Domain<f32> = Domain { allowed: "1e-15 to 1e15", contains: |v| is_length(*v) };

pub(super) const AUTO_LENGTH: Domain<Auto<f32>> = Domain {
    allowed: "auto or 1e-15 to 1e15",
    contains: |length| length.value().is_none_or(|&v| is_length(v)),
};

fn is_color(color: &Rgb) -> bool {
    color.0.iter().all(|v| v.is_finite() && *v >= 0.0)
}

pub(super) const COLOR: Domain<Rgb> =
    Domain { allowed: "three finite numbers, none negative", contains: is_color };

pub(super) const AUTO_COLOR: Domain<Auto<Rgb>> =
    Domain { allowed: COLOR.allowed, contains: |color| color.value().is_none_or(is_color) };

pub(super) const COSINE: Domain<f32> = Domain { allowed: "-1 to 1", contains: |v| (-1.0..=1.0).contains(v) };

pub(super) const TIME: Domain<Auto<f32>> = Domain {
    allowed: "auto or 0 to 10000 seconds",
    contains: |time| (0.0..=MAX_TIME).contains(&time.unwrap_or(0.0)),
};

pub(super) const STRENGTH: Domain<Auto<f32>> = Domain {
    allowed: "auto or a finite number, not negative",
    contains: |strength| strength.value().is_none_or(|v| v.is_finite() && *v >= 0.0),
};

fn is_finite(triple: &Triple) -> bool {
    triple.0.iter().all(|v| v.is_finite())
}

pub(super) const POINT: Domain<Auto<Triple>> =
    Domain { allowed: "auto or three finite numbers", contains: |point| point.value().is_none_or(is_finite) };

pub(super) const DIRECTION: Domain<Auto<Triple>> = Domain {
    allowed: "auto or three finite numbers, not all 0",
    contains: |direction| direction.value().is_none_or(|v| is_finite(v) && v.0.iter().any(|&v| v != 0.0)),
};

pub(super) const DEGREES: Domain<Auto<f32>> = Domain {
    allowed: "auto or degrees above 0 and below 180",
    contains: |degrees| degrees.value().is_none_or(|v| *v > 0.0 && *v < 180.0),
};
