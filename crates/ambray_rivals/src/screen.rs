//! What a method that works on the picture knows: depth and normals of the pixels, and the camera.

use ambray_core::{
    camera::{Camera, Projection},
    control::{Cancelled, Control},
    frame::GBufferPixel,
    openness::Openness,
    settings::Settings,
    view::View,
};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// The G-buffer of pass 1 in view space: x to the right, y up, z the view depth.
#[derive(Clone, Debug)]
pub struct Screen {
    camera: Camera,
    /// View depth of each pixel, scene units; infinite where nothing is seen.
    depths: Vec<f32>,
    /// Unit normal of each pixel towards the viewer, view space; 0 where nothing is seen.
    normals: Vec<Vec3>,
    /// Near-field radius R, scene units.
    pub radius: f32,
    /// Fuzzy measure μ of the distance, for methods that have none of their own.
    pub openness: Openness,
    /// Scramble of noise.
    pub seed: u32,
    /// Number of the frame.
    pub frame: u32,
}

impl Screen {
    /// The pixels that `view` sees, row by row from the top.
    #[must_use]
    pub fn new(gbuffer: &[GBufferPixel], view: &View, settings: &Settings) -> Self {
        let camera = view.camera;
        let into_view =
            |v: Vec3| Vec3::new(v.dot(camera.right()), v.dot(camera.up()), v.dot(camera.forward()));
        Self {
            camera,
            depths: gbuffer.iter().map(|pixel| pixel.depth).collect(),
            normals: gbuffer.iter().map(|pixel| into_view(pixel.shading_normal)).collect(),
            radius: view.radius,
            openness: view.openness,
            seed: settings.seed,
            frame: settings.frame,
        }
    }

    /// Pixels in a row, and rows.
    #[must_use]
    pub const fn size(&self) -> (usize, usize) {
        let (width, height) = self.camera.size();
        (width as usize, height as usize)
    }

    /// The camera.
    #[must_use]
    pub const fn camera(&self) -> &Camera {
        &self.camera
    }

    /// View depths, scene units, row by row from the top; infinite where nothing is seen.
    #[must_use]
    pub fn depths(&self) -> &[f32] {
        &self.depths
    }

    /// View depth at pixel (x, y): infinite where nothing is seen, `None` outside the picture.
    #[must_use]
    pub fn depth_at(&self, x: i32, y: i32) -> Option<f32> {
        let (width, height) = self.size();
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x < width && y < height).then(|| self.depths[y * width + x])
    }

    /// Unit normal at pixel (x, y), view space; 0 where nothing is seen.
    ///
    /// # Panics
    /// Outside the picture.
    #[must_use]
    pub fn normal(&self, x: usize, y: usize) -> Vec3 {
        self.normals[y * self.size().0 + x]
    }

    /// Position of pixel (x, y), view space; `None` where nothing is seen.
    #[must_use]
    pub fn position(&self, x: usize, y: usize) -> Option<Vec3> {
        let depth = self.depths[y * self.size().0 + x];
        depth.is_finite().then(|| self.unproject(Vec2::new(x as f32, y as f32), depth))
    }

    /// The point at `depth` under `pixel`, in pixels from the centre of pixel (0, 0) to the right and down; view space.
    #[must_use]
    pub fn unproject(&self, pixel: Vec2, depth: f32) -> Vec3 {
        let (width, height) = self.size();
        let scale = self.camera.footprint(depth);
        let right = (pixel.x - 0.5 * (width as f32 - 1.0)) * scale;
        let up = (0.5 * (height as f32 - 1.0) - pixel.y) * scale;
        Vec3::new(right, up, depth)
    }

    /// Where the view-space `point` is in the picture, in pixels from the centre of pixel (0, 0) to the right and down;
    /// `None` behind a perspective camera. It may be outside the picture.
    #[must_use]
    pub fn project(&self, point: Vec3) -> Option<Vec2> {
        let (width, height) = self.size();
        let scale = self.camera.footprint(point.z);
        (scale > 0.0).then(|| {
            let x = point.x / scale + 0.5 * (width as f32 - 1.0);
            Vec2::new(x, 0.5 * (height as f32 - 1.0) - point.y / scale)
        })
    }

    /// Unit vector from the view-space `point` towards the viewer.
    #[must_use]
    pub fn towards_viewer(&self, point: Vec3) -> Vec3 {
        match self.camera.projection() {
            Projection::Perspective { .. } => -point.normalize(),
            Projection::Orthographic { .. } => Vec3::NEG_Z,
        }
    }

    /// The pixel that `pixel`, in pixels from the centre of pixel (0, 0) to the right and down, is in; it may be outside the
    /// picture.
    ///
    /// Without `f32::round`, which is a call of a function where the processor is not known to have it.
    #[must_use]
    pub fn nearest(pixel: Vec2) -> (i32, i32) {
        let floor = |v: f32| {
            let towards_zero = v as i32;
            towards_zero - i32::from(towards_zero as f32 > v)
        };
        (floor(pixel.x + 0.5), floor(pixel.y + 0.5))
    }

    /// `value` of every pixel that sees a surface, in parallel; 1 elsewhere.
    pub fn map(
        &self,
        control: &Control<'_>,
        value: impl Fn(usize, usize) -> f32 + Sync,
    ) -> Result<Vec<f32>, Cancelled> {
        let (width, height) = self.size();
        let mut values = vec![1.0; width * height];
        values.par_chunks_mut(width).enumerate().try_for_each(|(y, row)| {
            control.check()?;
            for (x, out) in row.iter_mut().enumerate() {
                if self.depths[y * width + x].is_finite() {
                    *out = value(x, y);
                }
            }
            Ok(())
        })?;
        Ok(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_reaches_half_a_pixel_from_its_centre() {
        for (place, pixel) in
            [(0.0, 0), (0.49, 0), (0.5, 1), (-0.5, 0), (-0.51, -1), (-1.6, -2), (799.7, 800)]
        {
            assert_eq!(Screen::nearest(Vec2::new(place, -3.0)), (pixel, -3), "{place}");
        }
    }
}
