//! Where the picture lies in the window: letterbox, zoom, and the way between places of the window and pixels.

use ambray::settings::Size;
use egui::{Pos2, Rect, Vec2, pos2, vec2};

/// Most pixels of the window that one pixel of the picture is shown on, a side.
const LARGEST_PIXEL: f32 = 64.0;

/// How a picture comes to the size of the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    /// It covers the canvas; its size was made for that.
    Fill,
    /// It keeps its shape; its pixels become whole numbers of pixels of the window where it is smaller.
    Keep,
}

/// The part of the picture that the user looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Zoom {
    /// Magnification, at least 1.
    factor: f32,
    /// The place in the middle of the canvas, share of the picture.
    middle: Vec2,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { factor: 1.0, middle: vec2(0.5, 0.5) }
    }
}

impl Zoom {
    /// Whether the whole picture is shown.
    pub(super) fn is_whole(&self) -> bool {
        self.factor <= 1.0
    }

    /// Magnification over the whole picture.
    pub(super) const fn factor(&self) -> f32 {
        self.factor
    }

    /// Magnifies by `factor`; what is at `fixed` stays there.
    pub(super) fn magnify(&mut self, placement: &Placement, factor: f32, fixed: Pos2) {
        let largest = (LARGEST_PIXEL / placement.whole_scale()).max(1.0);
        let wanted = (self.factor * factor).clamp(1.0, largest);
        let share = placement.share(fixed);
        let size = placement.picture.size() * (wanted / self.factor);
        self.factor = wanted;
        self.middle = share + (placement.canvas.center() - fixed) / size;
        self.clamp(placement.canvas.size(), size);
    }

    /// Moves the picture by `delta` points.
    pub(super) fn pan(&mut self, placement: &Placement, delta: Vec2) {
        self.middle -= delta / placement.picture.size();
        self.clamp(placement.canvas.size(), placement.picture.size());
    }

    /// Leaves no room between the picture and the edge of the canvas where the picture is larger.
    fn clamp(&mut self, canvas: Vec2, picture: Vec2) {
        let margin = (0.5 * canvas / picture).min(Vec2::splat(0.5));
        self.middle = self.middle.clamp(margin, Vec2::splat(1.0) - margin);
    }
}

/// Where the picture lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    /// The canvas, points, on whole pixels of the window.
    pub(super) canvas: Rect,
    /// The picture, points; it reaches beyond the canvas where it is magnified.
    pub(super) picture: Rect,
    /// Pixels of the picture as it was asked for.
    size: Size,
    pixels_per_point: f32,
    factor: f32,
}

impl Placement {
    /// Puts a picture of `size` pixels into `canvas`.
    pub(super) fn new(canvas: Rect, pixels_per_point: f32, size: Size, fit: Fit, zoom: &Zoom) -> Self {
        let canvas = aligned(canvas, pixels_per_point);
        let room = canvas.size() * pixels_per_point;
        let pixels = vec2(size.width as f32, size.height as f32);
        let whole = match fit {
            Fit::Fill => room,
            Fit::Keep => {
                let scale = (room / pixels).min_elem();
                pixels * if scale >= 1.0 { scale.floor() } else { scale }
            }
        };
        let shown = whole * zoom.factor;
        let corner = canvas.min.to_vec2() * pixels_per_point + 0.5 * room - zoom.middle * shown;
        // Neither half pixels nor room at an edge that the picture could fill.
        let first = canvas.min.to_vec2() * pixels_per_point;
        let corner = vec2(
            edge(corner.x, first.x, room.x, shown.x).round(),
            edge(corner.y, first.y, room.y, shown.y).round(),
        );
        let picture = Rect::from_min_size((corner / pixels_per_point).to_pos2(), shown / pixels_per_point);
        Self { canvas, picture, size, pixels_per_point, factor: zoom.factor }
    }

    /// Pixels of the window to a point.
    pub(super) const fn pixels_per_point(&self) -> f32 {
        self.pixels_per_point
    }

    /// Pixels of the window to a pixel of the picture as it was asked for, a side.
    pub(super) fn scale(&self) -> f32 {
        let scale = self.picture.size() * self.pixels_per_point
            / vec2(self.size.width as f32, self.size.height as f32);
        scale.min_elem()
    }

    /// The same with the whole picture shown.
    fn whole_scale(&self) -> f32 {
        self.scale() / self.factor
    }

    /// Place of the window as a share of the picture; outside it beyond 0 to 1.
    pub(super) fn share(&self, place: Pos2) -> Vec2 {
        (place - self.picture.min) / self.picture.size()
    }

    /// The pixel at a place of the window, of a picture of `size` pixels.
    pub(super) fn pixel_at(&self, place: Pos2, (width, height): (u32, u32)) -> Option<(u32, u32)> {
        let share = self.share(place);
        let is_inside = self.canvas.contains(place) && share.min_elem() >= 0.0 && share.max_elem() < 1.0;
        let index = |share: f32, end: u32| ((share * end as f32) as u32).min(end - 1);
        is_inside.then(|| (index(share.x, width), index(share.y, height)))
    }

    /// Place in the window of a place in a picture of `size` pixels, in pixels from its top left corner.
    pub(super) fn place(&self, at: Vec2, (width, height): (u32, u32)) -> Pos2 {
        self.picture.min + at / vec2(width as f32, height as f32) * self.picture.size()
    }

    /// Where a pixel of a picture of `size` pixels is shown.
    pub(super) fn pixel_rect(&self, (x, y): (u32, u32), size: (u32, u32)) -> Rect {
        let corner = vec2(x as f32, y as f32);
        Rect::from_min_max(self.place(corner, size), self.place(corner + Vec2::splat(1.0), size))
    }
}

/// The whole pixels of the window within `rect`.
pub(super) fn aligned(rect: Rect, pixels_per_point: f32) -> Rect {
    // A hair's breadth off a pixel is rounding.
    let up = |v: f32| (v * pixels_per_point - 0.01).ceil() / pixels_per_point;
    let down = |v: f32| (v * pixels_per_point + 0.01).floor() / pixels_per_point;
    let min = pos2(up(rect.min.x), up(rect.min.y));
    Rect::from_min_max(min, pos2(down(rect.max.x).max(min.x), down(rect.max.y).max(min.y)))
}

fn edge(corner: f32, first: f32, room: f32, shown: f32) -> f32 {
    if shown <= room {
        first + (0.5 * (room - shown)).floor()
    } else {
        corner.clamp(first + room - shown, first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CANVAS: Rect = Rect { min: pos2(100.0, 40.0), max: pos2(740.0, 400.0) };
    const SIZE: Size = Size { width: 640, height: 360 };

    fn placed(size: Size, fit: Fit, zoom: &Zoom) -> Placement {
        Placement::new(CANVAS, 1.0, size, fit, zoom)
    }

    #[test]
    fn a_picture_made_for_the_canvas_covers_it_pixel_for_pixel() {
        for pixels_per_point in [1.0, 1.25, 1.5, 2.0] {
            let canvas = Rect::from_min_max(pos2(33.3, 21.7), pos2(700.9, 512.2));
            let room = aligned(canvas, pixels_per_point).size() * pixels_per_point;
            let size = Size { width: room.x.round() as u32, height: room.y.round() as u32 };
            let placement = Placement::new(canvas, pixels_per_point, size, Fit::Fill, &Zoom::default());
            for edge in [placement.picture.min, placement.picture.max] {
                let edge = edge.to_vec2() * pixels_per_point;
                assert!((edge - edge.round()).length() < 1e-2, "{edge:?} at {pixels_per_point}");
            }
            assert!((placement.scale() - 1.0).abs() < 1e-5);
            assert_eq!(placement.pixel_at(placement.picture.min, (size.width, size.height)), Some((0, 0)));
        }
    }

    #[test]
    fn a_fixed_size_keeps_its_shape() {
        let wide = placed(Size { width: 2000, height: 500 }, Fit::Keep, &Zoom::default());
        assert_eq!(wide.picture.size(), vec2(640.0, 160.0));
        assert_eq!(wide.picture.center().y, CANVAS.center().y);
        let small = placed(Size { width: 100, height: 100 }, Fit::Keep, &Zoom::default());
        assert_eq!(small.picture.size(), vec2(300.0, 300.0), "three whole pixels a pixel");
        assert_eq!(small.scale(), 3.0);
    }

    #[test]
    fn the_place_under_the_cursor_stays_there() {
        let mut zoom = Zoom::default();
        let cursor = pos2(300.0, 150.0);
        for factor in [1.5, 3.0, 2.0, 0.5] {
            let before = placed(SIZE, Fit::Fill, &zoom);
            zoom.magnify(&before, factor, cursor);
            let after = placed(SIZE, Fit::Fill, &zoom);
            let pixels = (after.share(cursor) - before.share(cursor)) * after.picture.size();
            assert!(pixels.length() < 1.0, "{pixels:?}");
        }
        assert!((zoom.factor() - 4.5).abs() < 1e-5);
    }

    #[test]
    fn a_pixel_becomes_64_pixels_at_most_and_the_whole_picture_at_least() {
        let mut zoom = Zoom::default();
        zoom.magnify(&placed(SIZE, Fit::Fill, &zoom), 1e6, CANVAS.center());
        assert!((placed(SIZE, Fit::Fill, &zoom).scale() - 64.0).abs() < 1e-3);
        zoom.magnify(&placed(SIZE, Fit::Fill, &zoom), 1e-9, CANVAS.left_top());
        assert_eq!(zoom, Zoom::default());
    }

    #[test]
    fn panning_ends_at_the_edges() {
        let mut zoom = Zoom::default();
        zoom.magnify(&placed(SIZE, Fit::Fill, &zoom), 8.0, CANVAS.center());
        let before = placed(SIZE, Fit::Fill, &zoom);
        zoom.pan(&before, vec2(10.0, -20.0));
        assert_eq!(placed(SIZE, Fit::Fill, &zoom).picture.min, before.picture.min + vec2(10.0, -20.0));
        zoom.pan(&before, vec2(1e6, 1e6));
        assert_eq!(placed(SIZE, Fit::Fill, &zoom).picture.min, CANVAS.min);
        zoom.pan(&before, vec2(-1e6, -1e6));
        assert_eq!(placed(SIZE, Fit::Fill, &zoom).picture.max, CANVAS.max);
    }

    #[test]
    fn pixels_and_places_belong_together() {
        let mut zoom = Zoom::default();
        for _ in 0..3 {
            let placement = placed(SIZE, Fit::Fill, &zoom);
            for size in [(640, 360), (80, 45)] {
                for pixel in [(0, 0), (size.0 / 2, size.1 / 2), (size.0 - 1, size.1 - 1)] {
                    let middle = placement.pixel_rect(pixel, size).center();
                    let expected = placement.canvas.contains(middle).then_some(pixel);
                    assert_eq!(placement.pixel_at(middle, size), expected);
                }
            }
            zoom.magnify(&placement, 3.0, pos2(200.0, 100.0));
        }
        let whole = placed(SIZE, Fit::Keep, &Zoom::default());
        assert_eq!(whole.pixel_at(pos2(99.0, 50.0), (640, 360)), None);
    }
}
