//! Sample sets: 16 classes of N directions, good alone and together (spec §6).

/// Permuted congruential hash of 32 bits (PCG-RXS-M-XS, O'Neill 2014; spec §6).
#[must_use]
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
