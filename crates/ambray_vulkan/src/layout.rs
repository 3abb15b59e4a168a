//! Everything that Rust and GLSL share, declared once: structures, constants and specialisation constants.
//!
//! [`glsl`] is the GLSL of all of it; `cargo xtask shaders` writes it to `shaders/include/layout.glsl`, and a test holds
//! the two together. Structures use the scalar block layout, which is that of `repr(C)` for these types; infinite lengths
//! are stored as [`FAR`], since GPUs need not preserve infinities.

mod declare;
mod display;
mod motion;
mod scene;
mod specialization;
mod view;

pub use display::Display;
pub use motion::{Clusters, Deformation, Influence, Target};
pub(crate) use motion::{ordered, unordered};
pub use scene::{
    ImageLevel, Instance, Light, Material, Mesh, Placement, SceneTables, Shape, ShapeInstance, Texture,
    TextureUse,
};
pub use specialization::Specialization;
pub use view::{
    FilterConstants, GatherConstants, MeanPlanes, Push, Ray, RayHit, Tally, TemporalConstants, View,
};

use declare::constants;

constants! {
    /// Stands for "none" in indices.
    NONE: u32 = 4294967295;
    /// Stands for infinite lengths.
    FAR: f32 = 3.4028235e38;

    /// Ray types: offsets into the shader binding table, and bits of the instance masks.
    RAY_PRIMARY: u32 = 0;
    RAY_AMBIENT: u32 = 1;
    RAY_CHORD: u32 = 2;
    RAY_SHADOW: u32 = 3;
    /// Number of ray types: stride of the hit groups of one kind of geometry.
    RAY_TYPES: u32 = 4;

    /// Kinds of geometry: each has its hit groups.
    GEOMETRY_OPAQUE: u32 = 0;
    GEOMETRY_MASKED: u32 = 1;
    GEOMETRY_SHAPE: u32 = 2;
    GEOMETRY_KINDS: u32 = 3;

    /// Kinds of materials: indices of the callable shaders.
    MATERIAL_LIT: u32 = 0;
    MATERIAL_UNLIT: u32 = 1;
    MATERIAL_EMISSIVE: u32 = 2;
    MATERIAL_CHECKER: u32 = 3;
    MATERIAL_KINDS: u32 = 4;

    ALPHA_OPAQUE: u32 = 0;
    ALPHA_MASK: u32 = 1;
    ALPHA_BLEND: u32 = 2;

    WRAP_REPEAT: u32 = 0;
    WRAP_MIRROR: u32 = 1;
    WRAP_CLAMP: u32 = 2;
    TEXEL_NEAREST: u32 = 0;
    TEXEL_LINEAR: u32 = 1;

    SHAPE_SPHERE: u32 = 0;
    SHAPE_BOX: u32 = 1;
    SHAPE_CAPSULE: u32 = 2;
    SHAPE_CYLINDER: u32 = 3;
    SHAPE_FIELD: u32 = 4;

    MOTION_STATIC: u32 = 0;
    MOTION_RIGID: u32 = 1;
    MOTION_DEFORMING: u32 = 2;

    LIGHT_DIRECTIONAL: u32 = 0;
    LIGHT_POINT: u32 = 1;
    LIGHT_SPOT: u32 = 2;

    NORMALS_SHADING: u32 = 0;
    NORMALS_SMOOTH: u32 = 1;
    NORMALS_GEOMETRIC: u32 = 2;

    FALLOFF_POWER: u32 = 0;
    FALLOFF_EXPONENTIAL: u32 = 1;
    FALLOFF_EXPONENTIAL_TRUNCATED: u32 = 2;
    FALLOFF_STEP: u32 = 3;

    NEAR_AVERAGED: u32 = 0;
    NEAR_AVERAGED_PLAIN: u32 = 1;
    NEAR_PER_HIT: u32 = 2;
    NEAR_OFF: u32 = 3;

    SOURCE_ALBEDO: u32 = 0;
    SOURCE_AMBIENT: u32 = 1;
    SOURCE_SELF_SIMILAR: u32 = 2;
    SOURCE_LIT: u32 = 3;
    SOURCE_LIT_UNSHADOWED: u32 = 4;

    THIN_OFF: u32 = 0;
    THIN_PAPER: u32 = 1;
    THIN_SHEET: u32 = 2;

    SAMPLING_INTERLEAVED: u32 = 0;
    SAMPLING_SAME: u32 = 1;
    SAMPLING_RANDOM: u32 = 2;
    SAMPLING_INDEPENDENT: u32 = 3;

    SEQUENCE_OWEN: u32 = 1;
    SEQUENCE_R2: u32 = 2;

    WINDOW_OFF: u32 = 0;
    WINDOW_BOX: u32 = 1;
    WINDOW_CENTRED: u32 = 2;

    TEST_PLANE: u32 = 0;
    TEST_ABSOLUTE: u32 = 1;
    TEST_RELATIVE: u32 = 2;
    TEST_NONE: u32 = 3;

    /// Planes by name.
    AOV_BEAUTY: u32 = 0;
    AOV_OPENNESS: u32 = 1;
    AOV_OPENNESS_RAW: u32 = 2;
    AOV_NEAR_RADIANCE: u32 = 3;
    AOV_NEAR_RADIANCE_RAW: u32 = 4;
    AOV_DIRECT: u32 = 5;
    AOV_ALBEDO: u32 = 6;
    AOV_EMISSION: u32 = 7;
    AOV_DEPTH: u32 = 8;
    AOV_POSITION: u32 = 9;
    AOV_GEOMETRIC_NORMAL: u32 = 10;
    AOV_SHADING_NORMAL: u32 = 11;
    AOV_BENT_NORMAL: u32 = 12;
    AOV_MATERIAL: u32 = 13;
    AOV_INSTANCE: u32 = 14;
    AOV_SAMPLE_CLASS: u32 = 15;
    AOV_RAY_COUNT: u32 = 16;
    AOV_MOTION: u32 = 17;
    AOV_HISTORY: u32 = 18;

    TONE_NONE: u32 = 0;
    TONE_NEUTRAL: u32 = 1;

    /// Least movement that colours are relative to: the smallest normal number.
    LEAST_MOTION: f32 = 1.1754944e-38;

    /// Accumulation over frames (`ambray_core::temporal`).
    LONGEST: f32 = 1048576.0;
    MOVING: f32 = 16.0;
    CHANGING: f32 = 2.0;
    CHANGING_SHARE: f32 = 0.1;
    CHANGED_LEAST: f32 = 0.15;
    CHANGED_MOST: f32 = 0.6;
    CHANGED_FLOOR: f32 = 0.02;

    /// Pixels of a workgroup of the filter, and how far its taps reach.
    FILTER_WIDTH: u32 = 16;
    FILTER_HEIGHT: u32 = 8;
    FILTER_REACH: u32 = 2;
    /// Pixels of a workgroup of the passes that trace by ray queries.
    QUERY_WIDTH: u32 = 8;
    QUERY_HEIGHT: u32 = 4;

    /// Invocations of a workgroup of what deforms meshes and measures them.
    MOTION_WIDTH: u32 = 64;
    /// Invocations of a workgroup of sums and boxes over all pixels.
    REDUCE_WIDTH: u32 = 128;
    /// Words of a box, and of a cluster: lowest corner, then the negated highest corner, then a count.
    BOX_WORDS: u32 = 6;
    CLUSTER_WORDS: u32 = 7;

    /// Functions under test, and words of the arguments and of the values of a call.
    FUNCTION_INTEGERS: u32 = 0;
    FUNCTION_PIXELS: u32 = 1;
    FUNCTION_ALPHA: u32 = 2;
    FUNCTION_SAMPLES: u32 = 3;
    FUNCTION_BASIS: u32 = 4;
    FUNCTION_OPENNESS: u32 = 5;
    FUNCTION_OFFSET: u32 = 6;
    FUNCTION_LIGHT: u32 = 7;
    FUNCTION_CAMERA: u32 = 8;
    FUNCTION_TEXTURE: u32 = 9;
    FUNCTION_CHECKER: u32 = 10;
    FUNCTION_SHAPE_RAY: u32 = 11;
    FUNCTION_SHAPE_SURFACE: u32 = 12;
    FUNCTION_FINISH: u32 = 13;
    FUNCTION_COMPOSE: u32 = 14;
    FUNCTION_PREVIOUS: u32 = 15;
    FUNCTION_TONE_MAP: u32 = 16;
    ARGUMENTS: u32 = 16;
    VALUES: u32 = 8;
}

/// The GLSL of everything in this module.
#[must_use]
pub fn glsl() -> String {
    let mut text = String::from(
        "// Made by `cargo xtask shaders` from src/layout.rs. Do not edit.\n#ifndef LAYOUT_GLSL\n#define LAYOUT_GLSL\n\n",
    );
    text.push_str(CONSTANTS_GLSL);
    text.push('\n');
    text.push_str(&specialization::glsl());
    scene::glsl(&mut text);
    motion::glsl(&mut text);
    view::glsl(&mut text);
    display::glsl(&mut text);
    text.push_str("\n#endif\n");
    text
}

/// `length`, with infinity as [`FAR`].
#[must_use]
pub(crate) const fn finite(length: f32) -> f32 {
    length.min(FAR)
}

#[cfg(test)]
mod tests {
    use ambray_core::aov::Aov;
    use ambray_core::settings::{
        Falloff, FilterTest, NearRadiance, Normals, RadianceSource, Sampling, Sequence, Thin, ToneMap, Window,
    };
    use ambray_core::trace::Motion;

    use super::*;

    #[test]
    fn accumulation_has_one_set_of_constants() {
        use ambray_core::temporal;
        assert_eq!([LONGEST, MOVING], [temporal::LONGEST, temporal::MOVING]);
        assert_eq!([CHANGING, CHANGING_SHARE], [temporal::CHANGING, temporal::CHANGING_SHARE]);
        assert_eq!([CHANGED_LEAST, CHANGED_MOST], temporal::CHANGED);
        assert_eq!(CHANGED_FLOOR, temporal::CHANGED_FLOOR);
        let motions = [Motion::Static, Motion::Rigid, Motion::Deforming].map(|motion| motion as u32);
        assert_eq!([MOTION_STATIC, MOTION_RIGID, MOTION_DEFORMING], motions);
    }

    /// Choices of the settings are handed over as their discriminants.
    #[test]
    fn constants_are_the_discriminants_of_the_settings() {
        assert_eq!([NORMALS_SHADING, NORMALS_SMOOTH, NORMALS_GEOMETRIC], of(Normals::ALL, |c| c as u32));
        let falloffs = [FALLOFF_POWER, FALLOFF_EXPONENTIAL, FALLOFF_EXPONENTIAL_TRUNCATED, FALLOFF_STEP];
        assert_eq!(falloffs, of(Falloff::ALL, |c| c as u32));
        let near = [NEAR_AVERAGED, NEAR_AVERAGED_PLAIN, NEAR_PER_HIT, NEAR_OFF];
        assert_eq!(near, of(NearRadiance::ALL, |c| c as u32));
        let sources = [SOURCE_ALBEDO, SOURCE_AMBIENT, SOURCE_SELF_SIMILAR, SOURCE_LIT, SOURCE_LIT_UNSHADOWED];
        assert_eq!(sources, of(RadianceSource::ALL, |c| c as u32));
        assert_eq!([THIN_OFF, THIN_PAPER, THIN_SHEET], of(Thin::ALL, |c| c as u32));
        let sampling = [SAMPLING_INTERLEAVED, SAMPLING_SAME, SAMPLING_RANDOM, SAMPLING_INDEPENDENT];
        assert_eq!(sampling, of(Sampling::ALL, |c| c as u32));
        assert_eq!([0, SEQUENCE_OWEN, SEQUENCE_R2], of(Sequence::ALL, |c| c as u32));
        assert_eq!([WINDOW_OFF, WINDOW_BOX, WINDOW_CENTRED], of(Window::ALL, |c| c as u32));
        assert_eq!([TEST_PLANE, TEST_ABSOLUTE, TEST_RELATIVE, TEST_NONE], of(FilterTest::ALL, |c| c as u32));
    }

    /// Planes go by their place in the list, and the names of constants by those of planes.
    #[test]
    fn planes_have_one_list() {
        assert_eq!([TONE_NONE, TONE_NEUTRAL], of(ToneMap::ALL, |c| c as u32));
        assert_eq!(LEAST_MOTION, f32::MIN_POSITIVE);
        for (number, aov) in Aov::ALL.iter().enumerate() {
            assert_eq!(*aov as usize, number);
            let name = aov.name().replace('-', "_").to_uppercase();
            let declared = format!("const uint AOV_{name} = {number}u;\n");
            assert!(CONSTANTS_GLSL.contains(&declared), "{declared}");
        }
        assert_eq!(CONSTANTS_GLSL.matches(" AOV_").count(), Aov::ALL.len());
    }

    #[track_caller]
    fn of<T: Copy, const N: usize>(all: &[T], number: impl Fn(T) -> u32) -> [u32; N] {
        all.iter().map(|&choice| number(choice)).collect::<Vec<_>>().try_into().expect("as many alternatives")
    }

    #[test]
    fn committed_glsl_is_this() {
        assert_eq!(include_str!("../shaders/include/layout.glsl"), glsl(), "run `cargo xtask shaders`");
    }
}
