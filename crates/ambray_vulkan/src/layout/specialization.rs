//! Specialisation constants: one shader for all settings, compiled for those in use.

use ambray_core::settings::{Settings, Temporal};

macro_rules! specialization {
    ($( $(#[$meta:meta])* $name:ident $constant:ident = $default:literal, )*) => {
        /// Values of the specialisation constants, in the order of their numbers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, bytemuck::Pod, bytemuck::Zeroable)]
        #[repr(C)]
        pub struct Specialization { $( $(#[$meta])* pub $name: u32, )* }

        impl Specialization {
            /// Number of constants.
            pub const COUNT: u32 = (size_of::<Self>() / 4) as u32;
        }

        pub(super) fn glsl() -> String {
            let declarations = [$( (stringify!($constant), $default as u32), )*];
            let line = |(id, (name, default)): (usize, &(&str, u32))| {
                format!("layout(constant_id = {id}) const uint {name} = {default}u;\n")
            };
            declarations.iter().enumerate().map(line).collect()
        }
    };
}

specialization! {
    /// Rays N of the first batch.
    spp SPP = 8,
    /// `SAMPLING_` constant.
    sampling SAMPLING = 0,
    /// `SEQUENCE_` constant of per-pixel sets.
    sequence SEQUENCE = 1,
    /// `FALLOFF_` constant.
    falloff FALLOFF = 0,
    /// `NEAR_` constant.
    near_radiance NEAR_RADIANCE = 0,
    /// `SOURCE_` constant.
    source SOURCE = 1,
    /// `THIN_` constant.
    thin THIN = 0,
    /// 1 where only surfaces seen edge-on count.
    thin_edge THIN_EDGE = 0,
    /// 1 where the minimum of both batches is taken after the filter.
    after_filter AFTER_FILTER = 0,
    /// `NORMALS_` constant.
    normals NORMALS = 0,
    /// `WINDOW_` constant.
    window WINDOW = 2,
    /// `TEST_` constant.
    test TEST = 0,
    /// 1 where light is accumulated over frames.
    temporal TEMPORAL = 0,
    /// 1 where the scene has triangles that are not opaque.
    masked MASKED = 1,
    /// 1 where the scene has shapes.
    shapes SHAPES = 1,
}

impl Specialization {
    /// The constants for `settings`, in a scene that has triangles which are not opaque, and shapes, as said.
    #[must_use]
    pub fn of(settings: &Settings, masked: bool, shapes: bool) -> Self {
        Self {
            spp: settings.spp,
            sampling: settings.sampling as u32,
            sequence: settings.sequence.for_spp(settings.spp) as u32,
            falloff: settings.falloff as u32,
            near_radiance: settings.near_radiance as u32,
            source: settings.radiance_source as u32,
            thin: settings.thin as u32,
            thin_edge: settings.thin_edge.into(),
            after_filter: settings.takes_minimum_after_filter().into(),
            normals: settings.normals as u32,
            window: settings.filter as u32,
            test: settings.filter_test as u32,
            temporal: (settings.temporal == Temporal::On).into(),
            masked: masked.into(),
            shapes: shapes.into(),
        }
    }
}
