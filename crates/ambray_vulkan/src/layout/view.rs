//! What a frame is rendered with, and the planes it is rendered to.

use super::declare::structures;

structures! {
    /// What decides the estimate (`ambray_core::gather::GatherParams`).
    GatherConstants {
        /// Address of the N local directions of each class: `vec4` with the azimuth in w.
        directions: u64,
        /// Address of the sample numbers of each class by azimuth: `uint`.
        by_azimuth: u64,
        /// Address of the lights.
        lights: u64,
        /// Number of lights.
        light_count: u32,
        /// Near-field radius R.
        radius: f32,
        /// `t_max` of ambient rays.
        reach: f32,
        /// Exponent of the power falloff.
        exponent: f32,
        /// Rate of the exponential falloffs.
        sigma: f32,
        /// Distance R_c below which hits enter the average.
        near_limit: f32,
        /// Ambient radiance L_a.
        ambient: [f32; 3],
        /// Ray offset: coordinates below this take the fixed distance.
        offset_near_zero: f32,
        /// Ray offset: the fixed distance.
        offset_distance: f32,
        /// Width of the footprint of a hit at distance 1.
        cone_width: f32,
    }

    /// Acceptance test of the filter (`ambray_core::filter::Filter`).
    FilterConstants {
        /// Tolerance of the test in use.
        tolerance: f32,
        /// Smallest cosine between normals.
        cos_normal: f32,
    }

    /// What is kept of each pixel from frame to frame (`ambray_core::temporal::Mean` and the guide of the filter): arrays of
    /// one entry a pixel.
    MeanPlanes {
        /// `vec4`: position, view depth.
        positions: u64,
        /// `vec4`: normal without normal map.
        normals: u64,
        /// `vec4`: openness and near radiance after the filter.
        ambient: u64,
        /// `vec4`: bent normal, share of 1 - O that may change.
        bent: u64,
        /// `float`: frames of the mean.
        frames: u64,
    }

    /// Accumulation over frames (`ambray_core::temporal`).
    TemporalConstants {
        /// Of the last frame.
        earlier: MeanPlanes,
        /// For the next frame.
        next: MeanPlanes,
        /// `vec4`: where the surface points were in the last frame.
        then_positions: u64,
        /// `vec4`: their normals there.
        then_normals: u64,
        /// Camera of the last frame: eye point.
        eye: [f32; 3],
        /// Unit viewing direction.
        forward: [f32; 3],
        /// Unit vector to the right.
        right: [f32; 3],
        /// Unit vector up in the picture.
        up: [f32; 3],
        /// Half the height of the picture at depth 1, or anywhere in parallel projection.
        half_height: f32,
        /// 1 for parallel projection.
        orthographic: u32,
        /// 1 where there is a last frame to go on from.
        has_earlier: u32,
        /// 1 where anything in the scene has moved since.
        scene_moved: u32,
        /// 1 where the camera has.
        camera_moved: u32,
        /// Difference of openness between frame and mean that is left where something changes.
        tolerance: f32,
    }

    /// Camera, estimate, filter, and the planes of a frame: arrays of one entry a pixel, row by row from the top.
    View {
        /// The estimate.
        gather: GatherConstants,
        /// `vec4`: position, view depth.
        positions: u64,
        /// `vec4`: geometric normal, reach of the triangle.
        geometric: u64,
        /// `vec4`: normal that directs the rays, material (bits).
        shading: u64,
        /// `vec4`: normal without normal map, instance (bits).
        smooth_normals: u64,
        /// `vec4`: albedo.
        albedo: u64,
        /// `vec4`: emission, sample class (bits).
        emission: u64,
        /// `vec4`: reflected direct light, hash of the pixel (bits).
        direct: u64,
        /// `vec4`: openness and near radiance before the filter, of the first batch if the minimum comes later.
        ambient: u64,
        /// `vec4`: openness and near radiance of the second batch.
        second: u64,
        /// `vec4`: bent normal before the filter, openness of the first batch; where light is accumulated, the share of 1 - O
        /// that may change.
        bent: u64,
        /// [`Tally`].
        tallies: u64,
        /// `vec4`: openness and near radiance after the filter.
        filtered: u64,
        /// `vec4`: bent normal after the filter.
        filtered_bent: u64,
        /// `vec4`: the picture.
        beauty: u64,
        /// Inputs of a batch: [`Ray`]s, how a plane is shown ([`Display`](super::Display)), or the arguments of a function under
        /// test.
        inputs: u64,
        /// Outputs of a batch: [`RayHit`]s, sums, the bytes of a picture, or the values of a function under test.
        outputs: u64,
        /// Accumulation over frames.
        temporal: TemporalConstants,
        /// Acceptance test of the filter.
        filter_by: FilterConstants,
        /// Eye point.
        eye: [f32; 3],
        /// Unit viewing direction.
        forward: [f32; 3],
        /// Unit vector to the right.
        right: [f32; 3],
        /// Unit vector up in the picture.
        up: [f32; 3],
        /// Half the height of the picture at depth 1, or anywhere in parallel projection.
        half_height: f32,
        /// 1 for parallel projection.
        orthographic: u32,
        /// Width and height in pixels.
        size: [u32; 2],
        /// Number of pixels, points or rays: the last row may be shorter.
        count: u32,
        /// Of a batch of rays: 1 where any hit will do. Of functions: which one.
        mode: u32,
        /// Frame number.
        frame: u32,
        /// Seed.
        seed: u32,
        /// Colour where nothing is seen.
        background: [f32; 3],
        /// Unused.
        padding: u32,
    }

    /// Rays of a pixel, by what became of them.
    Tally {
        /// Rays of the first batch.
        ambient_rays: u32,
        /// Those that hit something.
        ambient_hits: u32,
        /// Chords.
        chord_rays: u32,
        /// Those that were blocked.
        chord_hits: u32,
        /// Shadow rays of the surface seen.
        direct_shadow_rays: u32,
        /// Shadow rays of the hits.
        shadow_rays: u32,
    }

    /// A ray of a batch (`ambray_core::trace::Ray`).
    Ray {
        /// Start, world space.
        origin: [f32; 3],
        /// End, scene units along the direction.
        t_max: f32,
        /// Unit direction.
        direction: [f32; 3],
        /// Randomness for stochastic transparency.
        seed: u32,
    }

    /// What a ray of a batch hit (`ambray_core::trace::Hit`).
    RayHit {
        /// Distance; [`FAR`](super::FAR) on a miss.
        t: f32,
        /// Barycentric weight of the second vertex.
        u: f32,
        /// Barycentric weight of the third vertex.
        v: f32,
        /// Instance, or none.
        instance: u32,
        /// Triangle.
        triangle: u32,
    }

    /// Push constants of all passes.
    Push {
        /// Address of the [`SceneTables`](super::SceneTables).
        scene: u64,
        /// Address of the [`View`].
        view: u64,
        /// First pixel of the dispatch.
        origin: [u32; 2],
        /// Pixels of the dispatch.
        extent: [u32; 2],
    }
}
