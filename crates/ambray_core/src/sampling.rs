//! Sample sets: 16 classes of N directions, good alone and together (spec §6), and the hemisphere warp (spec §1).
//!
//! Everything here is a pure function of (pixel, frame, sample, dimension). Integer parts are exact on every machine;
//! directions of the interleaved classes are computed once in double precision, so backends can share the table.

use std::f64::consts::TAU;

use glam::{Vec2, Vec3};

use crate::settings::{Sampling, Sequence, Settings};

/// Number of sample classes: one for each pixel of a 4 × 4 block.
pub const CLASS_COUNT: u32 = 16;

/// Class of pixel (x, y) at `[y & 3][x & 3]`, annealed so that partial windows of the filter are good too (spec §6).
pub const CLASS_TABLE: [[u8; 4]; 4] = [[1, 8, 3, 10], [12, 5, 14, 7], [2, 11, 0, 9], [15, 6, 13, 4]];

/// Default scrambles of the two dimensions (spec §6).
pub const DEFAULT_SEEDS: [u32; 2] = [0xe25e_5511, 0x7187_64de];

/// Sample class of pixel (x, y).
#[must_use]
#[inline(always)]
pub const fn sample_class(x: u32, y: u32) -> u8 {
    CLASS_TABLE[(y & 3) as usize][(x & 3) as usize]
}

/// Permuted congruential hash of 32 bits (PCG-RXS-M-XS, O'Neill 2014; spec §6).
#[must_use]
#[inline(always)]
pub const fn pcg(v: u32) -> u32 {
    let s = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let w = ((s >> ((s >> 28) + 4)) ^ s).wrapping_mul(277_803_737);
    (w >> 22) ^ w
}

/// Maps 32 random bits to `[0, 1)` in steps of 2⁻²⁴, exactly.
#[must_use]
pub const fn unit_float(x: u32) -> f32 {
    (x >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Second dimension of the Sobol' sequence; the first is the bit reversal (spec §6).
#[must_use]
pub const fn sobol1(mut i: u32) -> u32 {
    let (mut r, mut v) = (0, 1 << 31);
    while i != 0 {
        if i & 1 != 0 {
            r ^= v;
        }
        i >>= 1;
        v ^= v >> 1;
    }
    r
}

/// Hash-based Owen scrambling (Burley 2020, "Practical hash-based Owen scrambling"; spec §6).
#[must_use]
pub const fn owen(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits().wrapping_add(seed);
    x ^= x.wrapping_mul(0x6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638);
    x ^= x.wrapping_mul(0x8d22_f6e6);
    x.reverse_bits()
}

/// Point `i` of the scrambled (0,2)-sequence, as 32-bit fractions.
#[must_use]
pub const fn owen_point(i: u32, seeds: [u32; 2]) -> [u32; 2] {
    [owen(i.reverse_bits(), seeds[0]), owen(sobol1(i), seeds[1])]
}

/// Point `i` of the R2 sequence (Roberts 2018), shifted by `seeds`, as 32-bit fractions.
///
/// The steps are 1/g and 1/g² of the plastic number g = 1.3247…, rounded to 32 bits.
#[must_use]
pub const fn r2_point(i: u32, seeds: [u32; 2]) -> [u32; 2] {
    const STEP: [u32; 2] = [3_242_174_889, 2_447_445_414];
    [seeds[0].wrapping_add(i.wrapping_mul(STEP[0])), seeds[1].wrapping_add(i.wrapping_mul(STEP[1]))]
}

/// Cosine-weighted direction in the frame (t, b, n) = (x, y, z) for `xi` in `[0, 1)²`, pdf cos θ/π (spec §1, polar warp).
#[must_use]
pub fn cosine_hemisphere(xi: Vec2) -> Vec3 {
    let (u, v) = (f64::from(xi.x), f64::from(xi.y));
    let (sin, cos) = libm::sincos(TAU * v);
    let r = u.sqrt();
    Vec3::new((r * cos) as f32, (r * sin) as f32, (1.0 - u).sqrt() as f32)
}

/// Density of [`cosine_hemisphere`] with respect to solid angle, for a unit direction in the local frame.
#[must_use]
pub fn cosine_hemisphere_pdf(local: Vec3) -> f32 {
    local.z.max(0.0) * std::f32::consts::FRAC_1_PI
}

/// Inverse of [`cosine_hemisphere`].
#[must_use]
pub fn invert_cosine_hemisphere(local: Vec3) -> Vec2 {
    let v = libm::atan2(f64::from(local.y), f64::from(local.x)) / TAU;
    Vec2::new(1.0 - local.z * local.z, (v - v.floor()) as f32)
}

/// A sample direction in the frame of the shading normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampleDirection {
    /// Unit direction (t, b, n) components.
    pub local: Vec3,
    /// Azimuth v in `[0, 1)`: thin-object detection orders rays by it.
    pub azimuth: f32,
}

impl SampleDirection {
    /// Direction for the point `bits`/2³² of the unit square.
    #[must_use]
    pub fn from_bits(bits: [u32; 2]) -> Self {
        let xi = Vec2::new(unit_float(bits[0]), unit_float(bits[1]));
        Self { local: cosine_hemisphere(xi), azimuth: xi.y }
    }
}

/// Identity of a pixel for sampling: which class it uses, and a hash for per-pixel randomness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelKey {
    /// Sample class, below [`CLASS_COUNT`].
    pub class: u8,
    /// Hash of (x, y, frame, seed).
    pub hash: u32,
}

impl PixelKey {
    /// Key of pixel (x, y) in `frame`.
    #[must_use]
    #[inline(always)]
    pub const fn new(x: u32, y: u32, frame: u32, seed: u32) -> Self {
        // Nested hashing: consecutive inputs must not give correlated scrambles (spec §6).
        let hash = pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(frame.wrapping_add(pcg(seed)))))));
        Self { class: sample_class(x, y), hash }
    }

    /// Seed of primary rays: the 16 pixels of a block share the hash and differ in the stratum
    /// (see [`alpha_threshold`](crate::trace::alpha_threshold)). They do not depend on the seed of the sample sets: pictures with
    /// other seeds are estimates of the same surfaces, so that their mean converges.
    #[must_use]
    #[inline(always)]
    pub const fn primary_seed(x: u32, y: u32, frame: u32) -> u32 {
        (Self::new(x >> 2, y >> 2, frame, 0).hash << 4) | sample_class(x, y) as u32
    }

    /// Seed of the pixel's secondary ray number `ray`.
    #[must_use]
    #[inline(always)]
    pub const fn ray_seed(&self, ray: u32) -> u32 {
        pcg(self.hash ^ pcg(ray))
    }
}

/// The sample sets of one frame: N directions for every pixel.
#[derive(Clone, Debug)]
pub struct SampleSets {
    sampling: Sampling,
    sequence: Sequence,
    spp: u32,
    /// Directions of class k at `[k·N, (k+1)·N)`; only class 0 for `same`, empty for per-pixel sets.
    table: Vec<SampleDirection>,
}

impl SampleSets {
    /// Sets of `spp` directions for `frame`. `seed` 0 is the default scramble.
    #[must_use]
    pub fn new(sampling: Sampling, sequence: Sequence, spp: u32, frame: u32, seed: u32) -> Self {
        let sequence = sequence.for_spp(spp);
        let seeds = if seed == 0 { DEFAULT_SEEDS } else { seed_pair(pcg(seed)) };
        let classes = match sampling {
            Sampling::Interleaved => CLASS_COUNT,
            Sampling::Same => 1,
            Sampling::Random | Sampling::Independent => 0,
        };
        let first = frame.wrapping_mul(CLASS_COUNT).wrapping_mul(spp);
        let table = (0..classes * spp)
            .map(|i| SampleDirection::from_bits(sequence_point(sequence, first.wrapping_add(i), seeds)))
            .collect();
        Self { sampling, sequence, spp, table }
    }

    /// The sets that `settings` ask for.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        Self::new(settings.sampling, settings.sequence, settings.spp, settings.frame, settings.seed)
    }

    /// The same given points of the unit square for every pixel.
    #[must_use]
    pub fn from_points(points: &[Vec2]) -> Self {
        let table: Vec<_> = points
            .iter()
            .map(|&xi| SampleDirection { local: cosine_hemisphere(xi), azimuth: xi.y })
            .collect();
        let spp = table.len() as u32;
        Self { sampling: Sampling::Same, sequence: Sequence::Auto, spp, table }
    }

    /// Number N of directions in a set.
    #[must_use]
    pub const fn spp(&self) -> u32 {
        self.spp
    }

    /// Direction number `j` < N of all pixels of a class, where they share it.
    #[inline]
    #[must_use]
    pub fn shared(&self, class: u8, j: u32) -> Option<SampleDirection> {
        match self.sampling {
            Sampling::Interleaved => Some(self.table[(u32::from(class) * self.spp + j) as usize]),
            Sampling::Same => Some(self.table[j as usize]),
            Sampling::Random | Sampling::Independent => None,
        }
    }

    /// Direction number `j` < N of the pixel.
    #[must_use]
    pub fn direction(&self, pixel: PixelKey, j: u32) -> SampleDirection {
        self.shared(pixel.class, j).unwrap_or_else(|| match self.sampling {
            Sampling::Independent => SampleDirection::from_bits(seed_pair(pixel.ray_seed(j))),
            _ => SampleDirection::from_bits(sequence_point(self.sequence, j, seed_pair(pixel.hash))),
        })
    }
}

impl Sequence {
    /// The generator itself: `Auto` is R2 where blocks of `spp` points of a (0,2)-sequence are not elementary (spec §6).
    #[must_use]
    pub const fn for_spp(self, spp: u32) -> Self {
        match self {
            Self::Auto if spp.is_power_of_two() => Self::Owen,
            Self::Auto => Self::R2,
            chosen => chosen,
        }
    }
}

const fn sequence_point(sequence: Sequence, i: u32, seeds: [u32; 2]) -> [u32; 2] {
    match sequence {
        Sequence::R2 => r2_point(i, seeds),
        Sequence::Owen | Sequence::Auto => owen_point(i, seeds),
    }
}

/// Two independent seeds from one hash.
const fn seed_pair(hash: u32) -> [u32; 2] {
    let first = pcg(hash);
    [first, pcg(first ^ 0x9e37_79b9)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warp_and_inverse_agree() {
        for i in 0..1000 {
            let bits = owen_point(i, DEFAULT_SEEDS);
            let xi = Vec2::new(unit_float(bits[0]), unit_float(bits[1]));
            let back = invert_cosine_hemisphere(cosine_hemisphere(xi));
            let dv = (back.y - xi.y).abs();
            assert!((back.x - xi.x).abs() < 1e-5 && dv.min(1.0 - dv) < 1e-4, "{xi} came back as {back}");
        }
    }

    /// χ² of directions binned by equal probability under cos θ/π: 8 rings of equal u, 8 sectors.
    #[test]
    fn warp_follows_its_density() {
        let mut bins = [0_u32; 64];
        let count = 64_000_u32;
        for i in 0..count {
            let w = SampleDirection::from_bits([pcg(2 * i), pcg(2 * i + 1)]).local;
            let ring = ((1.0 - w.z * w.z) * 8.0).min(7.0) as usize;
            let sector = ((w.y.atan2(w.x) / std::f32::consts::TAU).rem_euclid(1.0) * 8.0).min(7.0) as usize;
            bins[ring * 8 + sector] += 1;
        }
        let expected = f64::from(count) / 64.0;
        let chi2: f64 = bins.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
        // 63 degrees of freedom: the 99.99 % quantile is 113.
        assert!(chi2 < 113.0, "χ² = {chi2}");
        assert!((cosine_hemisphere_pdf(Vec3::Z) - std::f32::consts::FRAC_1_PI).abs() < 1e-6);
    }

    #[test]
    fn every_class_appears_once_in_a_block() {
        let mut seen = [false; 16];
        for (x, y) in (0..4).flat_map(|y| (0..4).map(move |x| (x + 8, y + 4))) {
            seen[sample_class(x, y) as usize] = true;
        }
        assert_eq!(seen, [true; 16]);
    }

    #[test]
    fn frames_continue_the_sequence() {
        let sets = |frame| SampleSets::new(Sampling::Interleaved, Sequence::Auto, 4, frame, 0);
        let key = PixelKey { class: 3, hash: 0 };
        let expected = SampleDirection::from_bits(owen_point((16 * 2 + 3) * 4 + 1, DEFAULT_SEEDS));
        assert_eq!(sets(2).direction(key, 1), expected);
    }

    #[test]
    fn other_counts_use_r2() {
        let sets = SampleSets::new(Sampling::Interleaved, Sequence::Auto, 6, 0, 0);
        let expected = SampleDirection::from_bits(r2_point(6 * 2, DEFAULT_SEEDS));
        assert_eq!(sets.direction(PixelKey { class: 2, hash: 0 }, 0), expected);
    }

    #[test]
    fn pixels_differ_in_the_random_modes_and_agree_in_the_others() {
        let (a, b) = (PixelKey::new(4, 0, 0, 0), PixelKey::new(8, 0, 0, 0));
        for (sampling, equal) in [
            (Sampling::Interleaved, true),
            (Sampling::Same, true),
            (Sampling::Random, false),
            (Sampling::Independent, false),
        ] {
            let sets = SampleSets::new(sampling, Sequence::Auto, 8, 0, 0);
            assert_eq!(sets.direction(a, 3) == sets.direction(b, 3), equal, "{sampling:?}");
        }
    }
}
