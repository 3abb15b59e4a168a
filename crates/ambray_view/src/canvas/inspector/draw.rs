//! Draws on the picture what a pixel did.

use ambray::{
    Frame,
    inspect::{Inspection, Meeting},
};
use egui::{Color32, Painter, Pos2, Stroke, StrokeKind, Vec2};
use glam::Vec3;

use super::{
    super::placement::Placement,
    legend::{Kind, Wanted},
    lines::{Segment, is_hidden, project},
};

/// Opacity of what is behind a visible surface.
const HIDDEN: f32 = 0.3;
/// Most lines of a kind that are drawn.
const MOST: usize = 4096;
/// Smallest pixel in which the verdict on a tap is outlined, points.
const SMALLEST_TAP: f32 = 4.0;

/// Where lines are drawn.
pub(super) struct Drawing<'a> {
    pub(super) painter: &'a Painter,
    pub(super) placement: &'a Placement,
    pub(super) frame: &'a Frame,
}

impl Drawing<'_> {
    /// Draws what is wanted of an inspection.
    pub(super) fn inspection(&self, inspection: &Inspection, wanted: Wanted) {
        if wanted.taps {
            self.taps(inspection);
        }
        if wanted.misses {
            for ray in inspection.rays.iter().filter(|ray| ray.is_traced && ray.hit.is_none()).take(MOST) {
                let reach = ray.t_max.min(self.frame.view.radius);
                self.line(ray.origin, ray.origin + reach * ray.direction, Kind::Miss, 1.0, 0.5);
            }
        }
        if wanted.shadows {
            for ray in inspection.shadows.iter().take(MOST) {
                let reach = ray.t_max.min(2.0 * self.frame.view.radius);
                let kind = if ray.blocked { Kind::Shadow } else { Kind::Light };
                self.line(ray.origin, ray.origin + reach * ray.direction, kind, 1.0, 0.8);
            }
        }
        if wanted.chords {
            for chord in inspection.chords.iter().take(MOST) {
                let kind = if chord.blocked > 0.0 { Kind::Blocked } else { Kind::Chord };
                self.line(chord.from, chord.to, kind, 1.0, 0.8);
                if let Some(Meeting { position, .. }) = chord.hit {
                    self.cross(position, kind);
                }
            }
        }
        if wanted.hits {
            for ray in inspection.rays.iter().take(MOST) {
                if let Some(hit) = ray.hit {
                    self.line(ray.origin, hit.position, Kind::Hit, 1.5, 1.0);
                    self.dot(hit.position, Kind::Hit);
                }
            }
        }
        self.pixel(inspection.pixel);
    }

    /// Outlines a pixel, and marks it where it is too small to be seen.
    pub(super) fn pixel(&self, pixel: (u32, u32)) {
        let rect = self.placement.pixel_rect(pixel, self.size());
        let around = rect.expand(1.0);
        self.painter.rect_stroke(
            around,
            0.0,
            Stroke::new(3.0, Color32::from_black_alpha(160)),
            StrokeKind::Outside,
        );
        self.painter.rect_stroke(around, 0.0, Stroke::new(1.0, Color32::WHITE), StrokeKind::Outside);
        if rect.width() < SMALLEST_TAP {
            self.painter.circle_stroke(rect.center(), 9.0, Stroke::new(1.0, Color32::WHITE));
        }
    }

    fn taps(&self, inspection: &Inspection) {
        for tap in &inspection.taps {
            let Some(pixel) = tap.pixel else { continue };
            let rect = self.placement.pixel_rect(pixel, self.size());
            if rect.width() < SMALLEST_TAP {
                return;
            }
            let kind = if tap.verdict.is_accepted() { Kind::Accepted } else { Kind::Refused };
            let stroke = Stroke::new(1.0 + rect.width() / 24.0, kind.color());
            self.painter.rect_stroke(rect.shrink(0.5), 0.0, stroke, StrokeKind::Inside);
        }
    }

    fn line(&self, from: Vec3, to: Vec3, kind: Kind, width: f32, opacity: f32) {
        let Some(segment) = Segment::new(&self.frame.view.camera, from, to) else { return };
        for piece in segment.pieces(self.frame) {
            let opacity = if piece.is_hidden { HIDDEN * opacity } else { opacity };
            let ends = piece.ends.map(|end| self.place(end));
            self.painter.line_segment(ends, Stroke::new(width, kind.color().gamma_multiply(opacity)));
        }
    }

    fn dot(&self, point: Vec3, kind: Kind) {
        if let Some((place, color)) = self.mark(point, kind) {
            self.painter.circle_filled(place, 2.5, color);
        }
    }

    fn cross(&self, point: Vec3, kind: Kind) {
        if let Some((place, color)) = self.mark(point, kind) {
            for arm in [Vec2::splat(4.0), Vec2::new(4.0, -4.0)] {
                self.painter.line_segment([place - arm, place + arm], Stroke::new(1.5, color));
            }
        }
    }

    /// Place and colour of a mark at a point of the world.
    fn mark(&self, point: Vec3, kind: Kind) -> Option<(Pos2, Color32)> {
        let camera = &self.frame.view.camera;
        let depth = camera.depth(point);
        let place = (depth > 0.0).then(|| project(camera, point)).flatten()?;
        let opacity = if is_hidden(self.frame, place, depth) { HIDDEN } else { 1.0 };
        Some((self.place(place), kind.color().gamma_multiply(opacity)))
    }

    fn place(&self, at: glam::Vec2) -> Pos2 {
        self.placement.place(Vec2::new(at.x, at.y), self.size())
    }

    const fn size(&self) -> (u32, u32) {
        (self.frame.width, self.frame.height)
    }
}
