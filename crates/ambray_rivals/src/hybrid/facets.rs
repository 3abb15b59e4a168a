//! What the pixels show: a piece of a plane each.

use ambray_core::{camera::Camera, frame::GBufferPixel};
use glam::{Vec2, Vec3};

use crate::Screen;

/// Distance of what is seen where nothing is, scene units: nothing is behind it.
const NOWHERE: f32 = 1e30;

/// Height of a neighbour over the plane of a pixel up to which both show one surface, pixels: where two surfaces meet at 45°
/// it may be 0.7. Measured with [`GAP`] on the atrium at 320 × 180, against tracing all of 64 rays a pixel: an RMSE of 0.006
/// with 63 % of the rays; of about 0.011 with 45 % where every pixel counts as clear, and 0.005 with 69 % at 0.3 and 1.5.
const RISE: f32 = 0.4;

/// Depth of a neighbour below the plane of a pixel up to which both show one surface, pixels.
const GAP: f32 = 4.0;

/// The piece of a plane that a pixel shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    pub(super) position: Vec3,
    /// Unit geometric normal towards the viewer.
    pub(super) normal: Vec3,
}

impl Facet {
    /// Signed distance of `point` from the plane, above 0 in front of it.
    pub(super) fn height(&self, point: Vec3) -> f32 {
        self.normal.dot(point - self.position)
    }

    /// Whether it and `other` are a plane or the sides of an edge that sticks out: each is behind the plane of the other, but
    /// for `tolerance`.
    pub(super) fn makes_edge_with(&self, other: &Self, tolerance: f32) -> bool {
        self.height(other.position) <= tolerance && other.height(self.position) <= tolerance
    }

    /// Whether it and its neighbour `other` may be one surface with nothing between them, where a pixel is of size `pixel`.
    fn continues_in(&self, other: &Self, pixel: f32) -> bool {
        let (rise, fall) = (self.height(other.position), other.height(self.position));
        rise <= RISE * pixel && rise.min(fall) >= -GAP * pixel && fall <= GAP * pixel
    }
}

/// What all pixels show. Apart from the G-buffer, whose pixels are many times as large.
#[derive(Clone, Debug)]
pub(super) struct Facets {
    facets: Vec<Facet>,
    /// Whether all around each pixel is one surface.
    clear: Vec<bool>,
    /// Column and row of the last pixel.
    last: (i32, i32),
}

impl Facets {
    /// What `camera` sees.
    pub(super) fn new(camera: &Camera, gbuffer: &[GBufferPixel]) -> Self {
        let nothing = Facet { position: camera.forward() * NOWHERE, normal: -camera.forward() };
        let facet = |pixel: &GBufferPixel| {
            let seen = Facet { position: pixel.position, normal: pixel.geometric_normal };
            if pixel.is_surface() { seen } else { nothing }
        };
        let (width, height) = camera.size();
        let last = (width as i32 - 1, height as i32 - 1);
        let facets = gbuffer.iter().map(facet).collect();
        let mut all = Self { facets, clear: Vec::new(), last };
        let pixels = (0..=last.1).flat_map(|y| (0..=last.0).map(move |x| (x, y)));
        all.clear = pixels.map(|(x, y)| all.is_one_surface(camera, x, y)).collect();
        all
    }

    /// Whether pixel (x, y) and those around it show one surface.
    fn is_one_surface(&self, camera: &Camera, x: i32, y: i32) -> bool {
        let own = self.at(x, y);
        let pixel = camera.footprint(camera.depth(own.position));
        let mut around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j)));
        around.all(|(i, j)| own.continues_in(&self.at(x + i, y + j), pixel))
    }

    /// Whether the camera sees what is within a pixel of `place`. It does not where surfaces meet or where one hides another:
    /// there may be more between the centres of pixels.
    pub(super) fn is_clear(&self, place: Vec2) -> bool {
        let (x, y) = Screen::nearest(place);
        self.clear[self.index(x, y)]
    }

    /// What the four pixels around `place` show, the nearest first.
    pub(super) fn around(&self, place: Vec2) -> [Facet; 4] {
        let (x, y) = Screen::nearest(place);
        let beside =
            |nearest: i32, place: f32| if place < nearest as f32 { nearest - 1 } else { nearest + 1 };
        let (u, v) = (beside(x, place.x), beside(y, place.y));
        [(x, y), (u, y), (x, v), (u, v)].map(|(x, y)| self.at(x, y))
    }

    /// What pixel (x, y) shows, or the nearest pixel inside the picture.
    fn at(&self, x: i32, y: i32) -> Facet {
        self.facets[self.index(x, y)]
    }

    fn index(&self, x: i32, y: i32) -> usize {
        let (x, y) = (x.clamp(0, self.last.0), y.clamp(0, self.last.1));
        y as usize * (self.last.0 as usize + 1) + x as usize
    }
}
