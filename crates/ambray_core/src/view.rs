//! A view: settings in which every `auto` has been replaced by a value of the scene.

use glam::Vec3;

use crate::{camera::Camera, light::Light, offset::RayOffset, openness::Openness};

/// What a frame is rendered with once every `auto` is decided.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The camera, sized to the picture.
    pub camera: Camera,
    /// Where the camera came from, in words.
    pub camera_origin: String,
    /// Near-field radius R, scene units.
    pub radius: f32,
    /// Fuzzy measure μ.
    pub openness: Openness,
    /// Distance R_c below which hits enter the average of the near radiance, scene units.
    pub near_limit: f32,
    /// Ambient radiance L_a, linear RGB.
    pub ambient: Vec3,
    /// Colour where nothing is seen, linear RGB.
    pub background: Vec3,
    /// How rays leave their surface, by the scale of the scene.
    pub offset: RayOffset,
    /// All lights that shine.
    pub lights: Vec<Light>,
}

impl View {
    /// What `camera` sees with near-field radius `radius`, in scene units, and nothing else said: μ(d) = d/R, near radiance of
    /// all hits within R, white ambient light, a black background, no lights, and rays of a scene whose size is that of a room.
    #[must_use]
    pub const fn new(camera: Camera, radius: f32) -> Self {
        Self {
            camera,
            camera_origin: String::new(),
            radius,
            openness: Openness::Power { radius, exponent: 1.0 },
            near_limit: radius,
            ambient: Vec3::ONE,
            background: Vec3::ZERO,
            offset: RayOffset::UNIT,
            lights: Vec::new(),
        }
    }
}
