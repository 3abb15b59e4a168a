//! How fast frames follow each other.

use std::{fmt, str::FromStr};

/// What was expected of a rate.
const RATE: &str = "frames a second from 0.001 to 1000, such as 30, 23.976 or 30000/1001";

/// Frames a second as an exact fraction, which broadcast rates such as 30000/1001 need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    frames: u64,
    seconds: u64,
}

impl Rate {
    /// When frame `number` is shown, seconds after frame 0: rounded once, so that long sequences do not drift.
    #[must_use]
    pub fn time(&self, number: u32) -> f64 {
        (u64::from(number) * self.seconds) as f64 / self.frames as f64
    }

    /// The rate of every `step`-th frame.
    #[must_use]
    pub fn every(&self, step: u32) -> Self {
        let seconds = self.seconds * u64::from(step);
        let divisor = common_divisor(self.frames, seconds);
        Self { frames: self.frames / divisor, seconds: seconds / divisor }
    }

    /// How many frames show `seconds`, rounded to the nearest; at least one.
    #[must_use]
    pub fn frames_in(&self, seconds: f64) -> u32 {
        (seconds * self.per_second()).round().clamp(1.0, f64::from(u32::MAX)) as u32
    }

    /// Frames a second.
    #[must_use]
    pub fn per_second(&self) -> f64 {
        self.frames as f64 / self.seconds as f64
    }

    /// Frames in so many seconds, the smallest numbers that say it.
    #[must_use]
    pub const fn fraction(&self) -> (u64, u64) {
        (self.frames, self.seconds)
    }
}

impl Default for Rate {
    fn default() -> Self {
        Self { frames: 30, seconds: 1 }
    }
}

impl FromStr for Rate {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, &'static str> {
        let fraction = match text.split_once('/') {
            Some((frames, seconds)) => digits(frames).zip(digits(seconds)),
            None => decimal(text),
        };
        let (frames, seconds) = fraction.filter(|&(_, seconds)| seconds > 0).ok_or(RATE)?;
        let divisor = common_divisor(frames, seconds);
        let rate = Self { frames: frames / divisor, seconds: seconds / divisor };
        if (0.001..=1000.0).contains(&rate.per_second()) { Ok(rate) } else { Err(RATE) }
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Factors of ten in the denominator come from decimals.
        if 1_000_000 % self.seconds == 0 {
            self.per_second().fmt(f)
        } else {
            write!(f, "{}/{}", self.frames, self.seconds)
        }
    }
}

/// A whole number small enough that products with a number of a frame fit 64 bits.
fn digits(text: &str) -> Option<u64> {
    let is_plain = (1..=9).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|_| is_plain)
}

/// A decimal number as a fraction of whole numbers.
fn decimal(text: &str) -> Option<(u64, u64)> {
    let (whole, places) = text.split_once('.').unwrap_or((text, "0"));
    let (whole, scale) = (digits(whole)?, 10_u64.pow(places.len().min(7) as u32));
    (places.len() <= 6).then_some((whole.checked_mul(scale)? + digits(places)?, scale))
}

const fn common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_exact() {
        let rate = |text: &str| text.parse::<Rate>().unwrap();
        assert_eq!(rate("30").fraction(), (30, 1));
        assert_eq!(rate("23.976").fraction(), (2997, 125));
        assert_eq!(rate("30000/1001").fraction(), (30000, 1001));
        assert_eq!(rate("60/2"), rate("30.0"));
        assert_eq!(
            ["30", "23.976", "30000/1001", "0.5"].map(|text| rate(text).to_string()),
            ["30", "23.976", "30000/1001", "0.5"]
        );
        assert_eq!(rate("30").every(5), rate("6"));
        assert_eq!(rate("25").time(50), 2.0);
        assert_eq!(rate("30000/1001").time(30000), 1001.0);
        assert_eq!((rate("30").frames_in(1.99), rate("30").frames_in(0.0)), (60, 1));
    }

    #[test]
    fn what_is_no_rate_is_refused() {
        for text in ["", "0", "-30", "1001", "0.0001", "1/0", "30/", "nan", "inf", "1e3", "1.0000001", "30 "]
        {
            assert_eq!(text.parse::<Rate>(), Err(RATE), "{text}");
        }
    }
}
