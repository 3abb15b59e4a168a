//! Accumulation of ambient light over frames (spec §12).
//!
//! Each frame continues the sample sequence, so the mean over T frames is the estimate with T·N rays. A pixel finds the
//! earlier mean where its surface point was in the last frame (*reprojection*): motion vectors follow rigid and deforming
//! objects, and the acceptance test A of the filter says whether the same surface was seen there. What is kept is
//! O, I and the bent normal after the filter; albedo and direct light are always of the frame.
//!
//! The mean loses weight where it may have become untrue:
//!
//! * *Disocclusion*: taps that fail the test do not count; without any the mean starts anew.
//! * *Movement in the picture* blurs what is resampled at every frame, so a mean that moves covers [`MOVING`] frames.
//! * *Moving occluders* change the openness of surfaces that do not move at all. So with O its share M is kept that
//!   is due to hits which may move against the point ([`Gathered::changing`](crate::gather::Gathered::changing)). Where M
//!   differs between the frame and the mean, something came or went, and the mean is dropped ([`CHANGED`]). Where M is
//!   not zero, the mean covers [`CHANGING`] frames, and its openness is drawn to within [`TOLERANCE`] of the frame's.
//!
//! While neither camera nor scene move, nothing is lost, and the mean converges to the truth of the filter.
//! `shaders/include/temporal.glsl` of the Vulkan backend is the twin of this file: change both.

use glam::{Vec4, Vec4Swizzles};

use crate::{
    camera::Camera,
    filter::{Filter, Guide},
    settings::{RadianceSource, Settings},
    view::View,
};

/// Most frames of a mean. Beyond 2²⁴ single precision cannot count them.
pub const LONGEST: f32 = 1_048_576.0;
/// Most frames of a mean that moves in the picture.
pub const MOVING: f32 = 16.0;
/// Most frames of a mean where M is [`CHANGING_SHARE`] or more; below, down to M = 0, the limit rises to [`MOVING`].
pub const CHANGING: f32 = 2.0;
/// See [`CHANGING`].
pub const CHANGING_SHARE: f32 = 0.1;
/// Difference of M between the frame and the mean, relative to the larger one and [`CHANGED_FLOOR`], up to which nothing is
/// lost (what few rays make of it), and from which on nothing is left.
pub const CHANGED: [f32; 2] = [0.15, 0.6];
/// What is added to M before differences are compared with it: changes that are small against this are left alone.
pub const CHANGED_FLOOR: f32 = 0.02;
/// Difference of openness that the few rays of a frame explain after the filter, times √N: about a standard deviation
/// (spec §11: the sampling part). Twice as much halved the flicker gained, but left ghosts twice as dark.
pub const TOLERANCE: f32 = 0.02;

/// What is kept of a pixel from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mean {
    /// Openness (x) and near radiance (yzw) after the filter; see [`near_radiance`](crate::compose::near_radiance) for
    /// what is still to be done to the latter.
    pub ambient: Vec4,
    /// Bent normal (xyz), and the share M of 1 - O that may change (w).
    pub bent: Vec4,
    /// Frames of which this is the mean; 0 for none.
    pub frames: f32,
}

/// The last frame, as far as the next one wants to know.
#[derive(Clone, Copy, Debug)]
pub struct Earlier<'a> {
    /// Its camera.
    pub camera: &'a Camera,
    /// What its pixels saw, row by row from the top.
    pub guides: &'a [Guide],
    /// What was kept of them.
    pub means: &'a [Mean],
}

/// Surface point of a pixel, now and in the last frame.
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    /// What the pixel sees.
    pub now: &'a Guide,
    /// The same point of the same surface where it was in the last frame, as its camera saw it.
    pub then: &'a Guide,
}

/// How means are carried from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulation {
    /// The acceptance test.
    filter: Filter,
    /// Whether anything in the scene has moved since the last frame.
    scene_moved: bool,
    /// Whether the camera has.
    camera_moved: bool,
    /// Whether near radiance may change although no occluder moves.
    lit: bool,
    /// Difference of openness between frame and mean that is left where something changes.
    tolerance: f32,
}

impl Accumulation {
    /// For a frame with `camera` after `earlier`; `scene_moved` says whether anything in the scene has moved since.
    #[must_use]
    pub fn new(settings: &Settings, camera: &Camera, earlier: &Camera, scene_moved: bool) -> Self {
        let lit = matches!(settings.radiance_source, RadianceSource::Lit | RadianceSource::LitUnshadowed);
        let tolerance = tolerance(settings);
        Self { filter: Filter::from(settings), scene_moved, camera_moved: camera != earlier, lit, tolerance }
    }

    /// The mean of pixel `pixel` with its values `now` of this frame, which count as one frame.
    #[must_use]
    pub fn update(&self, pixel: usize, path: &Path<'_>, earlier: &Earlier<'_>, now: &Mean) -> Mean {
        let is_still = !self.camera_moved && path.then == path.now;
        let kept = if is_still {
            // No resampling, so nothing is lost.
            let is_same =
                earlier.guides[pixel].is_surface() && self.filter.accepts(path.then, &earlier.guides[pixel]);
            if is_same { earlier.means[pixel] } else { Mean::default() }
        } else {
            self.resample(path, earlier)
        };
        let kept = self.drawn(kept, now);
        let frames = self.confidence(kept.bent.w, now.bent.w) * kept.frames;
        let frames = frames.min(self.longest(is_still, kept.bent.w.max(now.bent.w)));
        let share = 1.0 / (frames + 1.0);
        Mean {
            ambient: kept.ambient + (now.ambient - kept.ambient) * share,
            bent: kept.bent + (now.bent - kept.bent) * share,
            frames: frames + 1.0,
        }
    }

    /// What was kept around the place of the point in the last frame, bilinear over the pixels that saw its surface.
    fn resample(&self, path: &Path<'_>, earlier: &Earlier<'_>) -> Mean {
        let Some((place, _)) = earlier.camera.project(path.then.position) else { return Mean::default() };
        let (width, height) = earlier.camera.size();
        let corner = place.floor();
        let share = place - corner;
        let mut sum = Mean::default();
        let mut weight = 0.0;
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let (x, y) = (corner.x + dx, corner.y + dy);
            if !(x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32) {
                continue;
            }
            let q = y as usize * width as usize + x as usize;
            if earlier.guides[q].is_surface() && self.filter.accepts(path.then, &earlier.guides[q]) {
                let k = (if dx > 0.0 { share.x } else { 1.0 - share.x })
                    * (if dy > 0.0 { share.y } else { 1.0 - share.y });
                let mean = &earlier.means[q];
                sum.ambient += k * mean.ambient;
                sum.bent += k * mean.bent;
                sum.frames += k * mean.frames;
                weight += k;
            }
        }
        if weight <= 0.0 {
            return Mean::default();
        }
        // Where part of the taps was not seen, the rest stands for less: frames are not divided by the weight.
        Mean { ambient: sum.ambient / weight, bent: sum.bent / weight, frames: sum.frames }
    }

    /// The mean `kept`, drawn to the frame `now` where something changes.
    fn drawn(&self, kept: Mean, now: &Mean) -> Mean {
        let (open, changing) = (kept.ambient.x, kept.bent.w.max(now.bent.w));
        if !self.scene_moved || changing <= 0.0 || kept.frames <= 0.0 {
            return kept;
        }
        let drawn =
            open.clamp(now.ambient.x - self.tolerance, now.ambient.x + self.tolerance).clamp(0.0, 1.0);
        // Near radiance goes with what is not open: I = Lt (1 - O).
        let near =
            if open < 1.0 { kept.ambient.yzw() * ((1.0 - drawn) / (1.0 - open)) } else { now.ambient.yzw() };
        Mean { ambient: near.extend(drawn).wxyz(), ..kept }
    }

    /// Share of a mean that is still true, by the shares M of the mean and of the frame.
    fn confidence(&self, kept: f32, now: f32) -> f32 {
        if !self.scene_moved {
            return 1.0;
        }
        let [least, most] = CHANGED;
        let difference = (now - kept).abs() / (now.max(kept) + CHANGED_FLOOR);
        ((most - difference) / (most - least)).clamp(0.0, 1.0)
    }

    /// Most frames of a mean.
    fn longest(&self, is_still: bool, share: f32) -> f32 {
        let longest = if is_still { LONGEST } else { MOVING };
        if !self.scene_moved {
            return longest;
        }
        let changing = (share / CHANGING_SHARE).clamp(0.0, 1.0);
        let changing = if self.lit { 1.0 } else { changing };
        // From MOVING down to CHANGING; where nothing can change there is no such limit.
        if changing > 0.0 { longest.min(MOVING + (CHANGING - MOVING) * changing) } else { longest }
    }
}

/// Difference of openness between frame and mean that is left where something changes.
#[must_use]
pub fn tolerance(settings: &Settings) -> f32 {
    TOLERANCE / (settings.spp as f32).sqrt()
}

/// Whether means of a frame with one of these settings and views are of any use for the other: the same light is measured,
/// in pictures of the same size. Camera and time may differ.
#[must_use]
pub fn is_comparable(a: (&Settings, &View), b: (&Settings, &View)) -> bool {
    let neutral = |settings: &Settings| {
        let mut settings = settings.clone();
        let any = Settings::default();
        (settings.animation, settings.time, settings.frame) = (any.animation, any.time, any.frame);
        (settings.camera, settings.camera_up) = (any.camera, any.camera_up);
        (settings.camera_position, settings.camera_target) = (any.camera_position, any.camera_target);
        (settings.vertical_fov, settings.orthographic_height) = (any.vertical_fov, any.orthographic_height);
        settings
    };
    let decided = |view: &View| (view.radius, view.openness, view.near_limit, view.ambient);
    let lit = matches!(a.0.radiance_source, RadianceSource::Lit | RadianceSource::LitUnshadowed);
    neutral(a.0) == neutral(b.0)
        && decided(a.1) == decided(b.1)
        && a.1.camera.size() == b.1.camera.size()
        && (!lit || a.1.lights == b.1.lights)
}
