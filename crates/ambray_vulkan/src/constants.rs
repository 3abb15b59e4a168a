//! From settings and views to what shaders read.

use ambray_core::{
    camera::Projection,
    filter::Filter,
    gather::GatherParams,
    light::Light,
    openness::Openness,
    sampling::{CLASS_COUNT, PixelKey, SampleSets},
    settings::{Sampling, Settings},
    view::View,
};
use glam::Vec3;

use crate::layout::{self, FilterConstants, GatherConstants, finite};

/// The constants of a frame, still without addresses.
pub(crate) fn view(settings: &Settings, view: &View) -> layout::View {
    let camera = &view.camera;
    let (width, height) = camera.size();
    let [tolerance, cos_normal] = Filter::from(settings).constants();
    layout::View {
        gather: gather(settings, view),
        filter_by: FilterConstants { tolerance: finite(tolerance), cos_normal },
        eye: camera.position().to_array(),
        forward: camera.forward().to_array(),
        right: camera.right().to_array(),
        up: camera.up().to_array(),
        half_height: camera.half_height(),
        orthographic: matches!(camera.projection(), Projection::Orthographic { .. }).into(),
        size: [width, height],
        count: width * height,
        frame: settings.frame,
        seed: settings.seed,
        background: view.background.to_array(),
        ..layout::View::default()
    }
}

fn gather(settings: &Settings, view: &View) -> GatherConstants {
    let (exponent, sigma) = match view.openness {
        Openness::Power { exponent, .. } => (exponent, 0.0),
        Openness::Exponential { sigma } | Openness::ExponentialTruncated { sigma, .. } => (1.0, sigma),
        Openness::Step { .. } => (1.0, 0.0),
    };
    let [offset_near_zero, offset_distance] = view.offset.constants();
    GatherConstants {
        light_count: view.lights.len() as u32,
        radius: view.radius,
        reach: finite(view.openness.reach()),
        exponent,
        sigma,
        near_limit: finite(view.near_limit),
        ambient: view.ambient.to_array(),
        offset_near_zero,
        offset_distance,
        cone_width: GatherParams::cone_width_of(settings.spp),
        ..GatherConstants::default()
    }
}

pub(crate) fn light(light: &Light) -> layout::Light {
    match *light {
        Light::Directional { to_light, irradiance } => layout::Light {
            kind: layout::LIGHT_DIRECTIONAL,
            place: to_light.to_array(),
            strength: irradiance.to_array(),
            range: layout::FAR,
            ..layout::Light::default()
        },
        Light::Point { position, intensity, range, cone } => layout::Light {
            kind: if cone.is_some() { layout::LIGHT_SPOT } else { layout::LIGHT_POINT },
            place: position.to_array(),
            strength: intensity.to_array(),
            range: finite(range),
            axis: cone.map_or(Vec3::ZERO, |cone| cone.axis).to_array(),
            cos_inner: cone.map_or(1.0, |cone| cone.cos_inner),
            cos_outer: cone.map_or(-1.0, |cone| cone.cos_outer),
        },
    }
}

/// The directions of all classes, and the sample numbers of each class by azimuth.
pub(crate) struct SampleTables {
    /// Local direction and azimuth, class after class.
    pub(crate) directions: Vec<[f32; 4]>,
    pub(crate) by_azimuth: Vec<u32>,
}

impl SampleTables {
    /// Tables for `settings`; empty where each pixel has a set of its own.
    pub(crate) fn of(settings: &Settings) -> Self {
        let classes = match settings.sampling {
            Sampling::Interleaved => CLASS_COUNT,
            Sampling::Same => 1,
            Sampling::Random | Sampling::Independent => 0,
        };
        Self::of_sets(&SampleSets::of(settings), classes)
    }

    /// Tables of the first `classes` of `sets`.
    pub(crate) fn of_sets(sets: &SampleSets, classes: u32) -> Self {
        let spp = sets.spp();
        let mut tables = Self { directions: Vec::new(), by_azimuth: Vec::new() };
        for class in 0..classes as u8 {
            let key = PixelKey { class, hash: 0 };
            let start = tables.directions.len();
            tables.directions.extend((0..spp).map(|j| {
                let sample = sets.direction(key, j);
                sample.local.extend(sample.azimuth).to_array()
            }));
            let set = &tables.directions[start..];
            let mut order: Vec<u32> = (0..spp).collect();
            order.sort_by(|&a, &b| set[a as usize][3].total_cmp(&set[b as usize][3]));
            tables.by_azimuth.extend(order);
        }
        tables
    }
}
