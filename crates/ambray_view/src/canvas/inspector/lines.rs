//! Straight lines of the world in the picture: clipped where they go behind the camera, and told what hides them.

use ambray::{
    Frame,
    camera::{Camera, Projection},
};
use glam::{Vec2, Vec3};

/// Nearest depth that is drawn, share of the farther end.
const NEAR: f32 = 1e-3;
/// Length of the pieces that a line is compared with the picture in, pixels.
const PIECE: f32 = 2.0;
/// Most pieces of a line.
const PIECES: usize = 1024;
/// How far behind a surface counts as on it, share of the depth.
const SLACK: f32 = 2e-3;

/// A straight line in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Segment {
    /// Ends, in pixels from the top left corner of the picture.
    pub(super) ends: [Vec2; 2],
    /// View depths of the ends.
    depths: [f32; 2],
    is_perspective: bool,
}

/// A part of a line in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// Ends, in pixels from the top left corner of the picture.
    pub(super) ends: [Vec2; 2],
    /// Whether a visible surface is in front of it.
    pub(super) is_hidden: bool,
}

impl Segment {
    /// The line from `from` to `to` in the world as `camera` sees it; `None` if all of it is behind the camera or beside the
    /// picture.
    pub(super) fn new(camera: &Camera, from: Vec3, to: Vec3) -> Option<Self> {
        let depths = [camera.depth(from), camera.depth(to)];
        let is_perspective = matches!(camera.projection(), Projection::Perspective { .. });
        let near = if is_perspective { NEAR * depths[0].max(depths[1]) } else { 0.0 };
        if depths[0].max(depths[1]) <= near {
            return None;
        }
        let at_near = |far: Vec3, behind: Vec3, far_depth: f32, depth: f32| {
            far.lerp(behind, ((far_depth - near) / (far_depth - depth)).clamp(0.0, 1.0))
        };
        let from_seen = if depths[0] < near { at_near(to, from, depths[1], depths[0]) } else { from };
        let to_seen = if depths[1] < near { at_near(from, to, depths[0], depths[1]) } else { to };
        let (a, b) = (project(camera, from_seen)?, project(camera, to_seen)?);
        let segment = Self { ends: [a, b], depths: depths.map(|depth| depth.max(near)), is_perspective };
        let (width, height) = camera.size();
        segment.clipped(Vec2::new(width as f32, height as f32))
    }

    /// The part within a picture of `size`.
    fn clipped(&self, size: Vec2) -> Option<Self> {
        // Liang, Barsky 1984: the parameters at which the line enters and leaves.
        let [a, b] = self.ends;
        let way = b - a;
        let (mut enter, mut leave) = (0.0_f32, 1.0_f32);
        for (step, room) in [(-way.x, a.x), (way.x, size.x - a.x), (-way.y, a.y), (way.y, size.y - a.y)] {
            if step == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if step < 0.0 {
                enter = enter.max(room / step);
            } else {
                leave = leave.min(room / step);
            }
        }
        let ends = [a + enter * way, a + leave * way];
        let depths = [self.depth(enter), self.depth(leave)];
        (enter <= leave).then_some(Self { ends, depths, ..*self })
    }

    /// View depth at a share of the way in the picture: in perspective its inverse is linear there.
    fn depth(&self, share: f32) -> f32 {
        let [a, b] = self.depths;
        if self.is_perspective { 1.0 / (1.0 / a + share * (1.0 / b - 1.0 / a)) } else { a + share * (b - a) }
    }

    /// The line in pieces, each either hidden by what `frame` shows or not.
    pub(super) fn pieces(&self, frame: &Frame) -> Vec<Piece> {
        let [a, b] = self.ends;
        let count = ((a.distance(b) / PIECE).ceil() as usize).clamp(1, PIECES);
        let at = |i: usize| a.lerp(b, i as f32 / count as f32);
        let mut pieces: Vec<Piece> = Vec::new();
        for i in 0..count {
            let middle = (i as f32 + 0.5) / count as f32;
            let is_hidden = is_hidden(frame, a.lerp(b, middle), self.depth(middle));
            match pieces.last_mut().filter(|last| last.is_hidden == is_hidden) {
                Some(last) => last.ends[1] = at(i + 1),
                None => pieces.push(Piece { ends: [at(i), at(i + 1)], is_hidden }),
            }
        }
        pieces
    }
}

/// Where a point of the world is in the picture, in pixels from its top left corner.
pub(super) fn project(camera: &Camera, point: Vec3) -> Option<Vec2> {
    camera.project(point).map(|(place, _)| place + Vec2::splat(0.5))
}

/// Whether what `frame` shows at `place` is in front of `depth`.
pub(super) fn is_hidden(frame: &Frame, place: Vec2, depth: f32) -> bool {
    let (x, y) = (place.x.floor(), place.y.floor());
    let is_inside = x >= 0.0 && y >= 0.0 && x < frame.width as f32 && y < frame.height as f32;
    is_inside && frame.gbuffer[y as usize * frame.width as usize + x as usize].depth * (1.0 + SLACK) < depth
}

#[cfg(test)]
mod tests {
    use ambray::{
        Control, Renderer,
        scene::atrium,
        settings::{Settings, Size},
    };

    use super::*;

    const PROJECTIONS: [Projection; 2] =
        [Projection::Perspective { vertical_fov: 0.9 }, Projection::Orthographic { height: 6.0 }];

    fn camera(projection: Projection) -> Camera {
        Camera::new(Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z, Vec3::Y, projection, 160, 100)
    }

    #[test]
    fn ends_within_the_picture_are_where_the_camera_sees_them() {
        for projection in PROJECTIONS {
            let camera = camera(projection);
            let (from, to) = (Vec3::new(-0.5, 0.3, 1.0), Vec3::new(0.8, -0.4, -7.0));
            let segment = Segment::new(&camera, from, to).expect("is seen");
            for (end, point) in segment.ends.into_iter().zip([from, to]) {
                let (place, _) = camera.project(point).expect("in front");
                assert!((end - place - 0.5).length() < 1e-3, "{projection:?}");
            }
        }
    }

    #[test]
    fn points_of_the_line_have_their_depth() {
        for projection in PROJECTIONS {
            let camera = camera(projection);
            let (from, to) = (Vec3::new(-0.5, 0.3, 3.0), Vec3::new(0.8, -0.4, -7.0));
            let segment = Segment::new(&camera, from, to).expect("is seen");
            for t in [0.1, 0.5, 0.9] {
                let point = from.lerp(to, t);
                let place = project(&camera, point).expect("in front");
                let [a, b] = segment.ends;
                let share = (place - a).length() / (b - a).length();
                let depth = segment.depth(share);
                assert!((depth / camera.depth(point) - 1.0).abs() < 1e-2, "{depth} at {t}, {projection:?}");
            }
        }
    }

    #[test]
    fn lines_that_pass_the_camera_end_before_it() {
        for projection in PROJECTIONS {
            let camera = camera(projection);
            let (ahead, behind) = (Vec3::new(0.2, 0.1, 0.0), Vec3::new(0.4, 0.3, 9.0));
            for (from, to) in [(ahead, behind), (behind, ahead)] {
                let segment = Segment::new(&camera, from, to).expect("its front part is seen");
                let start = project(&camera, ahead).expect("in front");
                let near_end = if from == ahead { 0 } else { 1 };
                assert!((segment.ends[near_end] - start).length() < 1e-2, "{projection:?}");
                for end in segment.ends {
                    assert!(
                        end.cmpge(Vec2::splat(-0.01)).all() && end.cmple(Vec2::new(160.01, 100.01)).all()
                    );
                }
                // Every point of what is left is a point of the line in front of the camera.
                let way = segment.ends[1 - near_end] - start;
                let further = project(&camera, ahead.lerp(behind, 0.3)).expect("in front") - start;
                assert!(way.normalize().dot(further.normalize()) > 0.999, "{projection:?}");
            }
            assert_eq!(Segment::new(&camera, behind, behind + Vec3::Z), None);
        }
    }

    #[test]
    fn lines_beside_the_picture_are_left_out() {
        let camera = camera(PROJECTIONS[0]);
        assert_eq!(Segment::new(&camera, Vec3::new(50.0, 0.0, 0.0), Vec3::new(60.0, 9.0, 0.0)), None);
        let across = Segment::new(&camera, Vec3::new(-50.0, 0.0, 0.0), Vec3::new(50.0, 0.0, 0.0));
        let ends = across.expect("crosses it").ends;
        let expected = [Vec2::new(0.0, 50.0), Vec2::new(160.0, 50.0)];
        assert!(ends[0].distance(expected[0]).max(ends[1].distance(expected[1])) < 1e-2, "{ends:?}");
    }

    #[test]
    fn what_is_behind_a_surface_is_hidden() {
        let settings = Settings { size: Size { width: 40, height: 30 }, spp: 1, ..Settings::default() };
        let mut renderer = Renderer::new(atrium::atrium());
        let frame = renderer.render(&settings, Control::default()).expect("renders");
        let camera = frame.view.camera;
        let seen = frame.gbuffer[15 * 40 + 20];
        assert!(seen.is_surface());
        let ray = camera.primary_ray(20, 15, 0);
        let distance = ray.origin.distance(seen.position);
        // Nearly along the ray, so that all of it is within the pixel.
        let aside = 0.1 * camera.footprint(seen.depth) * camera.right();
        let at = |share: f32| ray.origin + share * distance * ray.direction;
        let front = Segment::new(&camera, at(0.5), at(0.9) + aside).expect("is seen");
        assert!(front.pieces(&frame).iter().all(|piece| !piece.is_hidden));
        let back = Segment::new(&camera, at(1.1), at(2.0) + aside).expect("is seen");
        assert!(back.pieces(&frame).iter().all(|piece| piece.is_hidden));
    }
}
