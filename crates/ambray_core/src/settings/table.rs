//! The one list of settings, from which the struct, the patch, the file format and the flags are made.

use serde::{Deserialize, Serialize};

use super::{
    Auto, Falloff, FilterTest, NearRadiance, Normals, RadianceSource, Ramp, Range, Rgb, Sampling, Sequence,
    Size, Temporal, Thin, ThinMinimum, ToneMap, Triple, Window,
};

macro_rules! settings {
    ($(
        [$heading:literal]
        $( $(#[doc = $doc:literal])+ $(#[arg($($arg:tt)*)])? $name:ident: $type:ty = $default:expr; )+
    )+) => {
        /// Everything that decides a picture, apart from the scene. The same settings give the same picture.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
        pub struct Settings {
            $($( $(#[doc = $doc])+ pub $name: $type, )+)+
        }

        impl Default for Settings {
            fn default() -> Self {
                Self { $($( $name: $default, )+)+ }
            }
        }

        /// Some of the [`Settings`]: a preset, a settings file, or the flags of a command.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        #[cfg_attr(feature = "clap", derive(clap::Args))]
        #[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
        pub struct SettingsPatch {
            $($(
                $(#[doc = $doc])+
                #[cfg_attr(feature = "clap", arg(long, help_heading = $heading $(, $($arg)*)?))]
                #[serde(skip_serializing_if = "Option::is_none")]
                pub $name: Option<$type>,
            )+)+
        }

        impl SettingsPatch {
            /// Overwrites the fields of `settings` that are given here.
            pub fn apply(&self, settings: &mut Settings) {
                $($( if let Some(value) = &self.$name { settings.$name = value.clone(); } )+)+
            }

            /// Patch with every field of `settings`.
            #[must_use]
            pub fn full(settings: &Settings) -> Self {
                Self { $($( $name: Some(settings.$name.clone()), )+)+ }
            }
        }
    };
}

settings! {
    ["Picture"]
    /// Width and height of the picture, pixels
    #[arg(value_name = "WIDTHxHEIGHT")]
    size: Size = Size { width: 1280, height: 720 };
    /// Normals that direct rays and light
    #[arg(value_enum, value_name = "KIND")]
    normals: Normals = Normals::Shading;
    /// Brightness of the picture in stops, PNG only: +1 doubles it
    #[arg(value_name = "STOPS", allow_negative_numbers = true)]
    exposure: f32 = 0.0;
    /// Mapping of radiance to the display, PNG only
    #[arg(value_enum, value_name = "KIND")]
    tone_map: ToneMap = ToneMap::Neutral;
    /// Colours of openness, depth and counts, PNG only
    #[arg(value_enum, value_name = "COLOURS")]
    ramp: Ramp = Ramp::Grey;
    /// Values at the ends of the ramp, PNG only, or auto (openness from 0 to 1, depth over what is seen, counts from 0)
    #[arg(value_name = "LOW,HIGH", allow_hyphen_values = true)]
    range: Auto<Range> = Auto::Auto;

    ["Ambient light"]
    /// Ambient rays per pixel, 1 to 65536: more is smoother; beyond 8 the eye sees little
    #[arg(value_name = "N")]
    spp: u32 = 8;
    /// Near-field radius in scene units, or auto (a tenth of the scene's smaller extents): farther blockers do not count
    #[arg(value_name = "LENGTH")]
    radius: Auto<f32> = Auto::Auto;
    /// Kind of the fuzzy measure μ(d) of the distance to the first hit
    #[arg(value_enum, value_name = "KIND")]
    falloff: Falloff = Falloff::Power;
    /// Exponent of the power falloff, above 0: larger darkens more
    #[arg(value_name = "NUMBER")]
    exponent: f32 = 1.0;
    /// Rate of the exponential falloffs per scene unit, or auto (3/radius)
    #[arg(value_name = "RATE")]
    sigma: Auto<f32> = Auto::Auto;
    /// Ambient radiance of the far environment, linear RGB, or auto (the scene's, else white)
    #[arg(value_name = "R,G,B")]
    ambient: Auto<Rgb> = Auto::Auto;
    /// Colour where no surface is seen, linear RGB, or auto (the ambient radiance if one is set, else grey)
    #[arg(value_name = "R,G,B")]
    background: Auto<Rgb> = Auto::Auto;

    ["Colour bleeding"]
    /// How near-field radiance is estimated from the hits
    #[arg(value_enum, value_name = "MODE")]
    near_radiance: NearRadiance = NearRadiance::Averaged;
    /// Distance in scene units below which hits enter the averages, or auto (all hits; the radius for averaged-plain)
    #[arg(value_name = "LENGTH")]
    near_limit: Auto<f32> = Auto::Auto;
    /// Radiance that leaves a hit
    #[arg(value_enum, value_name = "SOURCE")]
    radiance_source: RadianceSource = RadianceSource::Ambient;

    ["Thin objects"]
    /// Second batch of rays that finds thin objects
    #[arg(value_enum, value_name = "MODE")]
    thin: Thin = Thin::Off;
    /// With `--thin sheet`, count only surfaces seen edge-on
    #[arg(value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    thin_edge: bool = false;
    /// Where the smaller of the two batches is taken
    #[arg(value_enum, value_name = "PLACE")]
    thin_minimum: ThinMinimum = ThinMinimum::BeforeFilter;

    ["Sampling"]
    /// Which set of directions a pixel uses
    #[arg(value_enum, value_name = "MODE")]
    sampling: Sampling = Sampling::Interleaved;
    /// Generator of the sets
    #[arg(value_enum, value_name = "KIND")]
    sequence: Sequence = Sequence::Auto;
    /// Frame number: each frame continues the sample sequence
    #[arg(value_name = "N")]
    frame: u32 = 0;
    /// Scramble of the sample sets: another seed gives another picture of the same quality
    #[arg(value_name = "N")]
    seed: u32 = 0;

    ["Filter"]
    /// Window of the geometry-aware filter
    #[arg(long = "filter", value_enum, value_name = "WINDOW")]
    filter: Window = Window::Centred;
    /// Depth test that a neighbour must pass
    #[arg(value_enum, value_name = "TEST")]
    filter_test: FilterTest = FilterTest::Plane;
    /// Plane test: largest distance from the tangent plane, pixel footprints
    #[arg(value_name = "FOOTPRINTS")]
    filter_plane: f32 = 1.0;
    /// Absolute test: largest difference of depth, scene units
    #[arg(value_name = "LENGTH")]
    filter_absolute: f32 = 0.05;
    /// Relative test: largest difference of depth, share of the depth
    #[arg(value_name = "SHARE")]
    filter_relative: f32 = 0.01;
    /// Smallest cosine between the normals of neighbours, -1 to 1; -1 accepts all
    #[arg(value_name = "COSINE", allow_negative_numbers = true)]
    filter_cos_normal: f32 = 0.95;

    ["Animation"]
    /// Animation of the file, by name or number from 0, or the word all for all at once; auto is the first
    #[arg(value_name = "NAME")]
    animation: Auto<String> = Auto::Auto;
    /// Time in the animation, seconds; auto is its start if an animation is named, else the scene at rest
    #[arg(value_name = "SECONDS")]
    time: Auto<f32> = Auto::Auto;
    /// Start over after the end of the animation; otherwise its last pose holds
    #[arg(value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    animation_loop: bool = true;
    /// Accumulation over the frames of a sequence: each continues the sample sequence, and keeps what is still true
    #[arg(value_enum, value_name = "MODE")]
    temporal: Temporal = Temporal::Off;

    ["Direct light"]
    /// Use the lights of the scene
    #[arg(value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    lights: bool = true;
    /// Direction from the scene towards an additional sun; auto is no sun, or 0.4,1,0.3 if a strength is set
    #[arg(value_name = "X,Y,Z", allow_hyphen_values = true)]
    sun_direction: Auto<Triple> = Auto::Auto;
    /// Colour of the additional sun, linear RGB
    #[arg(value_name = "R,G,B")]
    sun_color: Rgb = Rgb([1.0; 3]);
    /// Irradiance of a surface that faces the additional sun; auto is 3 if a direction is set, else 0
    #[arg(value_name = "NUMBER")]
    sun_strength: Auto<f32> = Auto::Auto;

    ["Camera"]
    /// Camera of the file, by name or number from 0; auto takes the first, or frames the scene
    #[arg(value_name = "NAME")]
    camera: Auto<String> = Auto::Auto;
    /// Position of the camera, world space
    #[arg(value_name = "X,Y,Z", allow_hyphen_values = true)]
    camera_position: Auto<Triple> = Auto::Auto;
    /// Point that the camera looks at, world space
    #[arg(value_name = "X,Y,Z", allow_hyphen_values = true)]
    camera_target: Auto<Triple> = Auto::Auto;
    /// Direction that is upright in the picture
    #[arg(value_name = "X,Y,Z", allow_hyphen_values = true)]
    camera_up: Auto<Triple> = Auto::Auto;
    /// Full vertical angle of view, degrees above 0 and below 180; auto keeps the camera's, else 50
    #[arg(value_name = "DEGREES")]
    vertical_fov: Auto<f32> = Auto::Auto;
    /// Height of an orthographic view, scene units; auto is perspective unless the camera says otherwise
    #[arg(value_name = "LENGTH")]
    orthographic_height: Auto<f32> = Auto::Auto;
}
