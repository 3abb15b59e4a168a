//! Frames of a sequence in time.

use ambray::{
    scene::animation::{Clips, Rig},
    settings::{Auto, Settings, Temporal},
};

use crate::args::{Frames, Rate};

/// From the number of a frame to the settings that show it.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    settings: Settings,
    rate: Rate,
    moves: bool,
}

impl Timeline {
    /// A sequence that begins as `settings` say; time passes only if something `moves`.
    #[must_use]
    pub const fn new(settings: Settings, rate: Rate, moves: bool) -> Self {
        Self { settings, rate, moves }
    }

    /// Frames a second.
    #[must_use]
    pub const fn rate(&self) -> Rate {
        self.rate
    }

    /// Whether light accumulates, so that a frame depends on those before it.
    #[must_use]
    pub fn accumulates(&self) -> bool {
        self.settings.temporal == Temporal::On
    }

    /// Time in the animation that frame `number` shows, seconds; `None` if nothing moves.
    #[must_use]
    pub fn time(&self, number: u32) -> Option<f64> {
        let start = f64::from(self.settings.time.unwrap_or(0.0));
        self.moves.then(|| start + self.rate.time(number))
    }

    /// The settings of frame `number`.
    ///
    /// The sample sequence goes on only where frames accumulate: otherwise every frame has the same samples, so that what
    /// stands still does not flicker.
    #[must_use]
    pub fn settings(&self, number: u32) -> Settings {
        let mut settings = self.settings.clone();
        if let Some(time) = self.time(number) {
            settings.time = Auto::Value(time as f32);
        }
        if self.accumulates() {
            settings.frame = settings.frame.wrapping_add(number);
        }
        settings
    }

    /// What a frame of this sequence depends on besides its own settings: where the accumulation began. `None` where frames
    /// stand alone.
    #[must_use]
    pub fn history(&self, frames: Frames) -> Option<String> {
        // Without movement it does not matter how fast they are.
        let pace = if self.moves { format!(" at {} fps", self.rate) } else { String::new() };
        self.accumulates().then(|| format!("accumulated from frame {}{pace}", frames.start()))
    }
}

/// What `settings` play of the animations of `rig`; `None` if there is no such animation.
#[must_use]
pub fn playing(settings: &Settings, rig: &Rig) -> Option<Clips> {
    let Some(name) = settings.animation.value() else { return Some(Clips::One(0)) };
    rig.clip(name).map(Clips::One).or_else(|| (name == "all").then_some(Clips::All))
}

/// `clips` in words.
#[must_use]
pub fn clips_name(clips: Clips, rig: &Rig) -> String {
    match clips {
        Clips::One(index) => match rig.clips[index].name.as_str() {
            "" => index.to_string(),
            name => format!("{index} ({})", name.escape_debug()),
        },
        Clips::All => "all".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_starts_where_the_settings_say() {
        let rate: Rate = "25".parse().unwrap();
        let timeline = |time, moves| Timeline::new(Settings { time, ..Settings::default() }, rate, moves);
        let time = |timeline: Timeline, number| timeline.settings(number).time;
        assert_eq!(time(timeline(Auto::Auto, true), 0), Auto::Value(0.0));
        assert_eq!(time(timeline(Auto::Auto, true), 50), Auto::Value(2.0));
        assert_eq!(time(timeline(Auto::Value(1.5), true), 50), Auto::Value(3.5));
        assert_eq!(time(timeline(Auto::Auto, false), 50), Auto::Auto);
    }

    #[test]
    fn samples_change_only_where_frames_accumulate() {
        let rate: Rate = "25".parse().unwrap();
        let frames = "0..9".parse().unwrap();
        let alone = Timeline::new(Settings { frame: 7, ..Settings::default() }, rate, true);
        assert_eq!((alone.settings(5).frame, alone.history(frames)), (7, None));
        let settings = Settings { frame: 7, temporal: Temporal::On, ..Settings::default() };
        let together = Timeline::new(settings, rate, true);
        assert_eq!(together.settings(5).frame, 12);
        assert_eq!(together.history(frames).unwrap(), "accumulated from frame 0 at 25 fps");
        let still = Timeline { moves: false, ..together };
        assert_eq!(still.history(frames).unwrap(), "accumulated from frame 0");
    }
}
