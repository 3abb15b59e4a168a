//! A rendered frame: planes of one value a pixel, row by row from the top.

use std::{ops::Range, time::Duration};

use glam::{Vec2, Vec3, Vec4};
use serde::Serialize;

use crate::{
    aov::Aov, camera::Camera, direct::Receiver, filter::Guide, gather::ShadedPoint, sampling::PixelKey,
    view::View,
};

/// What pass 1 saw at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GBufferPixel {
    /// Position, world space.
    pub position: Vec3,
    /// View depth, scene units; infinite where nothing is seen.
    pub depth: f32,
    /// Unit normal of the triangle towards the viewer.
    pub geometric_normal: Vec3,
    /// Reach of the triangle (see [`RayOffset::apply`](crate::offset::RayOffset::apply)), scene units.
    pub reach: f32,
    /// Unit normal that directs the rays.
    pub shading_normal: Vec3,
    /// Unit normal without normal map, which the filter compares.
    pub smooth_normal: Vec3,
    /// Albedo.
    pub albedo: Vec3,
    /// Emitted radiance; the base colour of unlit surfaces; the background where nothing is seen.
    pub emission: Vec3,
    /// Direct light reflected by the surface.
    pub direct: Vec3,
    /// Material index, `u32::MAX` where nothing is seen.
    pub material: u32,
    /// Instance index, `u32::MAX` where nothing is seen.
    pub instance: u32,
    /// Rays traced for the pixel, of all types.
    pub rays: u32,
    /// How far the surface point moved in the picture since the last frame, pixels to the right and down; 0 unless light is
    /// accumulated over frames.
    pub motion: Vec2,
}

impl GBufferPixel {
    /// A pixel that sees no surface.
    pub const NOTHING: Self = Self {
        position: Vec3::ZERO,
        depth: f32::INFINITY,
        geometric_normal: Vec3::ZERO,
        reach: 0.0,
        shading_normal: Vec3::ZERO,
        smooth_normal: Vec3::ZERO,
        albedo: Vec3::ZERO,
        emission: Vec3::ZERO,
        direct: Vec3::ZERO,
        material: u32::MAX,
        instance: u32::MAX,
        rays: 0,
        motion: Vec2::ZERO,
    };

    /// Whether the pixel sees a surface.
    #[must_use]
    #[inline(always)]
    pub const fn is_surface(&self) -> bool {
        self.instance != u32::MAX
    }

    /// What the filter knows about the pixel, seen by `camera`.
    #[must_use]
    #[inline(always)]
    pub fn guide(&self, camera: &Camera) -> Guide {
        if !self.is_surface() {
            return Guide::NOTHING;
        }
        let (position, normal) = (self.position, self.smooth_normal);
        Guide { position, depth: self.depth, normal, footprint: camera.footprint(self.depth) }
    }

    /// The surface as the gather sees it, with the samples of `key`.
    #[must_use]
    #[inline(always)]
    pub const fn shaded_point(&self, key: PixelKey) -> ShadedPoint {
        ShadedPoint {
            position: self.position,
            geometric_normal: self.geometric_normal,
            reach: self.reach,
            normal: self.shading_normal,
            instance: self.instance,
            key,
        }
    }

    /// The surface as lights see it. Its shadow rays take the seed of a ray of `key` that no batch has.
    #[must_use]
    #[inline(always)]
    pub const fn receiver(&self, key: PixelKey) -> Receiver {
        Receiver {
            position: self.position,
            geometric_normal: self.geometric_normal,
            normal: self.shading_normal,
            reach: self.reach,
            seed: key.ray_seed(u32::MAX),
        }
    }
}

/// A rendered frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The picture: linear RGB radiance.
    pub beauty: Vec<Vec3>,
    /// Attributes of what is seen.
    pub gbuffer: Vec<GBufferPixel>,
    /// Openness (x) and near radiance (yzw) before the filter.
    pub ambient_raw: Vec<Vec4>,
    /// Openness (x) and near radiance (yzw) after the filter.
    pub ambient: Vec<Vec4>,
    /// Mean open direction after the filter, not normalised.
    pub bent: Vec<Vec3>,
    /// Frames whose mean [`ambient`](Self::ambient) and [`bent`](Self::bent) are: 1 unless light is accumulated over
    /// frames.
    pub history: Vec<f32>,
    /// The view with everything chosen: camera, radius, lights.
    pub view: View,
    /// What it took.
    pub stats: FrameStats,
}

/// Rays traced, by type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RayCounts {
    /// From the camera.
    pub primary: u64,
    /// First batch: openness and near radiance.
    pub ambient: u64,
    /// Second batch: thin objects.
    pub chord: u64,
    /// To lights.
    pub shadow: u64,
}

impl RayCounts {
    /// Sum over the types.
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.primary + self.ambient + self.chord + self.shadow
    }
}

impl std::ops::Add for RayCounts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            primary: self.primary + other.primary,
            ambient: self.ambient + other.ambient,
            chord: self.chord + other.chord,
            shadow: self.shadow + other.shadow,
        }
    }
}

/// Wall time of the stages of a frame. Stages of pass 1 run interleaved over tiles; each gets its share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTimes {
    /// Primary rays and surface attributes.
    pub primary: Duration,
    /// Direct light with its shadow rays.
    pub direct: Duration,
    /// First and second batch of ambient rays.
    pub ambient: Duration,
    /// Geometry-aware filter and composition.
    pub filter: Duration,
    /// Tracing rays, of whatever type and for whatever method: part of the stages above. Zero on a device, whose passes cannot
    /// tell it apart.
    pub tracing: Duration,
    /// What the stages of both passes leave of their wall time, mean over the threads: waiting for work or for other threads,
    /// and what one thread does alone between the loops of all, such as handing out work and mapping planes. A method in screen
    /// space runs between the passes and is left out. Zero on a device.
    pub idle: Duration,
    /// Bending the vertices of what deforms to the pose of the frame.
    pub deformation: Duration,
    /// Refitting or rebuilding the bottom-level structures of what deforms.
    pub bottom_level: Duration,
    /// Building the top-level structure; on the CPU its share of moving the scene.
    pub top_level: Duration,
    /// Copying the planes from a device to the host.
    pub transfer: Duration,
    /// The whole frame, without building the scene.
    pub total: Duration,
}

/// What a frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Rays by type.
    pub rays: RayCounts,
    /// Wall time by stage.
    pub times: StageTimes,
    /// Threads used.
    pub threads: usize,
}

/// What moving the scene to another pose took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseStats {
    /// Bending the vertices of what deforms.
    pub deformation: Duration,
    /// Refitting or rebuilding the bottom-level structures of what deforms.
    pub bottom_level: Duration,
    /// Building the top-level structure; zero where each frame builds its own.
    pub top_level: Duration,
    /// The whole move, evaluation of the animation included.
    pub total: Duration,
    /// Structures that were refitted.
    pub refitted: u32,
    /// Structures that were built anew.
    pub rebuilt: u32,
    /// Structures kept for what deforms, all poses counted.
    pub kept: u32,
    /// How much of their quality the refitted structures have lost: the largest loss; 1 where nothing was refitted, or lost.
    /// On the processor the surface-area cost of the tree over that at its build. A device does not show its trees: there
    /// the cost of clusters of triangles as they were at the build, over that of clusters made for this pose.
    pub decay: f32,
}

impl Frame {
    /// The values of a plane, channel after channel within a pixel ([`Aov::channels`]), pixels row by row from the top.
    #[must_use]
    pub fn plane(&self, aov: Aov) -> Vec<f32> {
        self.values(aov, 0..self.beauty.len())
    }

    /// The values of a plane at pixel `(x, y)`, channel after channel.
    ///
    /// # Panics
    /// If the pixel is outside the picture.
    #[must_use]
    pub fn pixel(&self, aov: Aov, (x, y): (u32, u32)) -> Vec<f32> {
        assert!(x < self.width && y < self.height, "pixel {x}, {y} is outside the picture");
        let i = y as usize * self.width as usize + x as usize;
        self.values(aov, i..i + 1)
    }

    fn values(&self, aov: Aov, pixels: Range<usize>) -> Vec<f32> {
        let vectors = |f: &dyn Fn(usize) -> Vec3| pixels.clone().flat_map(|i| f(i).to_array()).collect();
        let scalars = |f: &dyn Fn(usize) -> f32| pixels.clone().map(f).collect();
        let index = |id: u32| if id == u32::MAX { -1.0 } else { id as f32 };
        match aov {
            Aov::Beauty => vectors(&|i| self.beauty[i]),
            Aov::Openness => scalars(&|i| self.ambient[i].x),
            Aov::OpennessRaw => scalars(&|i| self.ambient_raw[i].x),
            Aov::NearRadiance => vectors(&|i| yzw(self.ambient[i])),
            Aov::NearRadianceRaw => vectors(&|i| yzw(self.ambient_raw[i])),
            Aov::Direct => vectors(&|i| self.gbuffer[i].direct),
            Aov::Albedo => vectors(&|i| self.gbuffer[i].albedo),
            Aov::Emission => vectors(&|i| self.gbuffer[i].emission),
            Aov::Depth => scalars(&|i| self.gbuffer[i].depth),
            Aov::Position => vectors(&|i| self.gbuffer[i].position),
            Aov::GeometricNormal => vectors(&|i| self.gbuffer[i].geometric_normal),
            Aov::ShadingNormal => vectors(&|i| self.gbuffer[i].shading_normal),
            Aov::BentNormal => vectors(&|i| self.bent[i].normalize_or_zero()),
            Aov::Material => scalars(&|i| index(self.gbuffer[i].material)),
            Aov::Instance => scalars(&|i| index(self.gbuffer[i].instance)),
            Aov::SampleClass => scalars(&|i| f32::from(self.class_of(i))),
            Aov::Motion => pixels.flat_map(|i| self.gbuffer[i].motion.to_array()).collect(),
            Aov::History => scalars(&|i| self.history[i]),
            Aov::RayCount => scalars(&|i| self.gbuffer[i].rays as f32),
        }
    }

    fn class_of(&self, i: usize) -> u8 {
        let width = self.width as usize;
        crate::sampling::sample_class((i % width) as u32, (i / width) as u32)
    }
}

fn yzw(v: Vec4) -> Vec3 {
    Vec3::new(v.y, v.z, v.w)
}
