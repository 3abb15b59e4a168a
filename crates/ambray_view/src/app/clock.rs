//! The time of the animation: it goes on when a picture has arrived, as fast as the clock on the wall.

use ambray::settings::Auto;

use crate::{engine::Opened, model::Model, panels::duration};

/// Longest step in wall time, seconds: after a pause of the window the animation does not leap.
const LONGEST_STEP: f64 = 0.5;

/// When the animation went on last.
#[derive(Debug, Default)]
pub(super) struct Clock {
    last: Option<f64>,
}

impl Clock {
    /// Moves the time of `model` on where it plays and the picture of its time `has_arrived`.
    pub(super) fn tick(&mut self, model: &mut Model, opened: Option<&Opened>, has_arrived: bool, now: f64) {
        let length = length(model, opened);
        if !model.playback.is_playing || length <= 0.0 {
            model.playback.is_playing &= length > 0.0;
            self.last = None;
            return;
        }
        let last = *self.last.get_or_insert(now);
        if has_arrived && now > last {
            let step = (now - last).min(LONGEST_STEP) as f32 * model.playback.speed;
            self.last = Some(now);
            advance(model, length, step);
        }
    }
}

/// Moves on by `frames` frames, and stops to play.
pub(super) fn step(model: &mut Model, opened: Option<&Opened>, frames: i32) {
    let length = length(model, opened);
    if length > 0.0 {
        model.playback.is_playing = false;
        let step = frames as f32 / model.playback.fps;
        advance(model, length, step);
    }
}

/// Length of the animation that is chosen, 0 where there is none.
fn length(model: &Model, opened: Option<&Opened>) -> f32 {
    let animations = opened.iter().flat_map(|opened| &opened.animations);
    let animations: Vec<_> = animations.map(|a| (a.name.clone(), a.duration)).collect();
    if animations.is_empty() { 0.0 } else { duration(model.edited(), &animations) }
}

fn advance(model: &mut Model, length: f32, step: f32) {
    let time = model.edited().time.unwrap_or(0.0) + step;
    let time = if model.edited().animation_loop {
        time.rem_euclid(length)
    } else {
        model.playback.is_playing &= time < length;
        time.clamp(0.0, length)
    };
    model.edited_mut().time = Auto::Value(time);
}

#[cfg(test)]
mod tests {
    use ambray::settings::Settings;

    use super::*;
    use crate::model::SceneRef;

    fn playing(is_loop: bool) -> Model {
        let settings = Settings { animation_loop: is_loop, ..Settings::default() };
        let mut model = Model::new(SceneRef::new("banner"), settings);
        model.playback.is_playing = true;
        model
    }

    #[test]
    fn time_goes_round_or_ends() {
        let mut model = playing(true);
        advance(&mut model, 2.0, 1.5);
        advance(&mut model, 2.0, 1.0);
        assert_eq!(model.edited().time, Auto::Value(0.5));
        advance(&mut model, 2.0, -1.0);
        assert_eq!(model.edited().time, Auto::Value(1.5));
        let mut model = playing(false);
        advance(&mut model, 2.0, 5.0);
        assert_eq!(model.edited().time, Auto::Value(2.0));
        assert!(!model.playback.is_playing);
    }

    #[test]
    fn nothing_plays_without_an_animation() {
        let mut model = playing(true);
        Clock::default().tick(&mut model, None, true, 1.0);
        assert!(!model.playback.is_playing);
        assert_eq!(model.edited().time, Auto::Auto);
    }
}
