//! Options of sequences: which frames, how fast, which of them are made again.

use std::{fmt, str::FromStr};

use ambray_files::Rate;
use clap::Args;

const HEADING: &str = "Sequence";

/// What was expected of `--frames`.
const FRAMES: &str = "A..B (B is not shown), A..=B, either with :STEP, or one number, such as 0..120";
const EMPTY: &str = "there is no frame in it, the end must be larger than the start";

/// A sequence of frames.
#[derive(Clone, Debug, Args)]
pub struct SequenceArgs {
    /// Render a sequence: frames A to B-1, with ..= to B, with :STEP every so many; OUT holds a run of # for the number.
    /// Frame k shows the time k/fps after that of --time
    #[arg(long, value_name = "A..B", help_heading = HEADING)]
    pub frames: Option<Frames>,
    /// Frames a second, a number or a fraction such as 30000/1001 [default: 30]
    #[arg(long, value_name = "RATE", help_heading = HEADING)]
    pub fps: Option<Rate>,
    /// Time stands still at --time: with --temporal on, light accumulates over frames of one moment
    #[arg(long, help_heading = HEADING)]
    pub hold_time: bool,
    /// Keep frames whose files are there already, made by the same version with the same settings of the same scene
    #[arg(long, help_heading = HEADING)]
    pub resume: bool,
}

impl SequenceArgs {
    /// The first option that means nothing for a single picture.
    #[must_use]
    pub fn needs_frames(&self) -> Option<&'static str> {
        let fps = self.fps.map(|_| "--fps");
        let hold = self.hold_time.then_some("--hold-time");
        fps.or(hold).or_else(|| self.resume.then_some("--resume"))
    }
}

/// Numbers of the frames of a sequence: at least one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    first: u32,
    last: u32,
    step: u32,
}

impl Frames {
    /// Most frames of a sequence.
    pub const MOST: usize = 1_000_000;

    /// The first `count` frames, at least one; `None` if these are more than [`Self::MOST`].
    #[must_use]
    pub fn first(count: u32) -> Option<Self> {
        let frames = Self { first: 0, last: count.max(1) - 1, step: 1 };
        (frames.count() <= Self::MOST).then_some(frames)
    }

    /// The numbers in ascending order.
    pub fn numbers(&self) -> impl Iterator<Item = u32> + use<> {
        (self.first..=self.last).step_by(self.step as usize)
    }

    /// How many there are.
    #[must_use]
    pub const fn count(&self) -> usize {
        ((self.last - self.first) / self.step) as usize + 1
    }

    /// The smallest number.
    #[must_use]
    pub const fn start(&self) -> u32 {
        self.first
    }

    /// The largest number, which [`Self::numbers`] may step over.
    #[must_use]
    pub const fn end(&self) -> u32 {
        self.last
    }

    /// From one number to the next.
    #[must_use]
    pub const fn step(&self) -> u32 {
        self.step
    }
}

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse::<u32>().map_err(|_| FRAMES.to_owned());
        let (range, step) = match text.split_once(':') {
            Some((range, step)) => (range, number(step)?),
            None => (text, 1),
        };
        let (first, last) = match (range.split_once("..="), range.split_once("..")) {
            (Some((first, last)), _) => (number(first)?, Some(number(last)?)),
            (None, Some((first, end))) => (number(first)?, number(end)?.checked_sub(1)),
            (None, None) => (number(range)?, Some(number(range)?)),
        };
        match last.map(|last| Self { first, last, step }) {
            _ if step == 0 => Err("the step must be at least 1".to_owned()),
            Some(frames) if frames.last < first => Err(EMPTY.to_owned()),
            Some(frames) if frames.count() > Self::MOST => Err(format!("more than {} frames", Self::MOST)),
            Some(frames) => Ok(frames),
            None => Err(EMPTY.to_owned()),
        }
    }
}

impl fmt::Display for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.first == self.last {
            return self.first.fmt(f);
        }
        write!(f, "{}..={}", self.first, self.last)?;
        if self.step == 1 { Ok(()) } else { write!(f, ":{}", self.step) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_counted_as_ranges_are() {
        let numbers =
            |text: &str| text.parse::<Frames>().map(|frames| frames.numbers().collect::<Vec<_>>()).unwrap();
        assert_eq!(numbers("0..3"), [0, 1, 2]);
        assert_eq!(numbers("5..=7"), [5, 6, 7]);
        assert_eq!(numbers("7"), [7]);
        assert_eq!(numbers("0..=10:5"), [0, 5, 10]);
        assert_eq!(numbers("0..10:5"), [0, 5]);
        assert_eq!(numbers("1..11:5"), [1, 6]);
        for text in ["0..3", "5..=7", "7", "0..=10:5", "0..10:5", "1..11:5", "0..4294967295:4300"] {
            let frames: Frames = text.parse().unwrap();
            assert_eq!(frames.count(), frames.numbers().size_hint().0, "{text}");
        }
        assert_eq!("0..120".parse::<Frames>().unwrap().to_string(), "0..=119");
        assert_eq!("7".parse::<Frames>().unwrap().to_string(), "7");
        assert_eq!(Frames::first(1_000_000).map(|frames| frames.count()), Some(1_000_000));
        assert_eq!([1_000_001, u32::MAX].map(Frames::first), [None; 2]);
        assert_eq!("0..=9:3".parse::<Frames>().unwrap().to_string(), "0..=9:3");
    }

    #[test]
    fn what_is_no_range_is_refused() {
        for text in ["", "a", "1..", "..3", "0-3", "-1..3", "0..3:", "0..=4294967296", "0.5", "1...3"] {
            assert!(text.parse::<Frames>().unwrap_err().starts_with("A..B"), "{text}");
        }
        for text in ["0..0", "3..3", "4..=3"] {
            assert!(text.parse::<Frames>().unwrap_err().starts_with("there is no frame"), "{text}");
        }
        assert!("0..2000000".parse::<Frames>().unwrap_err().contains("more than 1000000"));
        assert!("0..3:0".parse::<Frames>().unwrap_err().contains("step"));
    }
}
