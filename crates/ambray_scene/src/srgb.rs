//! The sRGB transfer function for bytes (IEC 61966-2-1).

use std::sync::LazyLock;

/// Bytes as numbers in [0, 1].
pub(crate) static UNIT: [f32; 256] = {
    let mut table = [0.0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = i as f32 / 255.0;
        i += 1;
    }
    table
};

static DECODED: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| decode(i as f64 / 255.0) as f32));

/// sRGB bytes as linear numbers in [0, 1].
pub(crate) fn decoded() -> &'static [f32; 256] {
    &DECODED
}

fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Steps of the first guess of [`encode`].
const GUESSES: usize = 4096;

/// Encoder: for each step of linear light the smallest byte it can be, and for each byte where the next one begins.
static ENCODER: LazyLock<(Vec<u8>, [f32; 255])> = LazyLock::new(|| {
    let next: [f32; 255] = std::array::from_fn(|i| decode((i as f64 + 0.5) / 255.0) as f32);
    let guesses = (0..=GUESSES).map(|i| next.partition_point(|&t| t <= i as f32 / GUESSES as f32) as u8);
    (guesses.collect(), next)
});

/// The sRGB byte closest to `linear`, which is clamped to [0, 1].
pub(crate) fn encode(linear: f32) -> u8 {
    let (guesses, next) = &*ENCODER;
    let linear = linear.clamp(0.0, 1.0);
    let mut byte = guesses[(linear * GUESSES as f32) as usize];
    while byte < 255 && linear >= next[usize::from(byte)] {
        byte += 1;
    }
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_round_trip() {
        assert_eq!((decoded()[0], decoded()[255]), (0.0, 1.0));
        assert!((decoded()[188] - 0.502_886).abs() < 1e-5);
        for byte in 0..=255_u8 {
            assert_eq!(encode(decoded()[usize::from(byte)]), byte);
        }
        assert_eq!(encode(0.5), 188); // 187.52
        assert_eq!((encode(-1.0), encode(2.0)), (0, 255));
    }
}
