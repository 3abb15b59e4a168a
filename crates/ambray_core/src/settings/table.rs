//! The one list of settings, from which the struct, the patch, the descriptions, the file format and the flags are made.

use serde::{Deserialize, Serialize};

use super::{
    Auto, Falloff, Field, FilterTest, Method, NearRadiance, Normals, RadianceSource, Ramp, Range, Rgb,
    Sampling, ScreenQuality, Sequence, SetError, SettingsError, Size, Temporal, Thin, ThinMinimum, ToneMap,
    Triple, Window, domains,
    field::{Domain, Value},
    spelling::kebab,
};

macro_rules! settings {
    ($(
        [$heading:literal]
        $(
            $(#[doc = $doc:literal])+
            $(#[arg($($arg:tt)*)])?
            $name:ident: $type:ty = $default:expr, $value_name:literal $(in $domain:ident)?;
        )+
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

        impl Settings {
            /// Descriptions of all settings, in the order of the documentation.
            #[must_use]
            pub const fn fields() -> &'static [Field] {
                const FIELDS: &[Field] = &[$($(
                    Field {
                        name: kebab!($name),
                        heading: $heading,
                        doc: concat!($($doc),+).trim_ascii(),
                        value_name: $value_name,
                        kind: <$type as Value>::KIND,
                        allowed: { const DOMAIN: Domain<$type> = domain!($($domain)?); DOMAIN.allowed },
                    },
                )+)+];
                FIELDS
            }

            /// The description of the setting called `name`.
            #[must_use]
            pub fn field(name: &str) -> Option<&'static Field> {
                Self::fields().iter().find(|field| field.name == name)
            }

            /// The value of the setting called `name`, spelled as on the command line; `None` if there is no such setting.
            #[must_use]
            pub fn get(&self, name: &str) -> Option<String> {
                $($( if name == kebab!($name) { return Some(self.$name.to_string()); } )+)+
                None
            }

            /// Sets the setting called `name` from `text`, spelled as on the command line. Whether the value is allowed is
            /// for [`validate`](Self::validate) to say.
            ///
            /// # Errors
            ///
            /// If there is no such setting, or if the text is not a value of its kind.
            pub fn set(&mut self, name: &str, text: &str) -> Result<(), SetError> {
                $($(
                    if name == kebab!($name) {
                        let refused = |error| {
                            SetError::Value { name: kebab!($name), value: text.to_owned(), error }
                        };
                        self.$name = <$type as Value>::read(text).map_err(refused)?;
                        return Ok(());
                    }
                )+)+
                Err(SetError::Unknown(name.to_owned()))
            }

            /// The settings outside their domains, each by itself.
            pub(super) fn outside(&self) -> Vec<SettingsError> {
                let mut errors = Vec::new();
                $($(
                    let domain: Domain<$type> = domain!($($domain)?);
                    if !(domain.contains)(&self.$name) {
                        let value = self.$name.to_string();
                        errors.push(SettingsError { name: kebab!($name), value, allowed: domain.allowed });
                    }
                )+)+
                errors
            }
        }

        /// Some of the [`Settings`]: a preset, a settings file, or the flags of a command.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        #[cfg_attr(feature = "clap", derive(clap::Args))]
        #[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
        pub struct SettingsPatch {
            $($(
                $(#[doc = $doc])+
                #[cfg_attr(
                    feature = "clap",
                    arg(long, help_heading = $heading, value_name = $value_name $(, $($arg)*)?)
                )]
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

/// The domain of a setting, where one is named.
macro_rules! domain {
    () => {
        Domain::ALL
    };
    ($domain:ident) => {
        domains::$domain
    };
}

settings! {
    ["Picture"]
    /// Width and height of the picture, pixels
    size: Size = Size { width: 1280, height: 720 }, "WIDTHxHEIGHT" in SIZE;
    /// Normals that direct rays and light
    #[arg(value_enum)]
    normals: Normals = Normals::Shading, "KIND";
    /// Brightness of the picture in stops, PNG only: +1 doubles it
    #[arg(allow_negative_numbers = true)]
    exposure: f32 = 0.0, "STOPS" in STOPS;
    /// Mapping of radiance to the display, PNG only
    #[arg(value_enum)]
    tone_map: ToneMap = ToneMap::Neutral, "KIND";
    /// Colours of openness, depth and counts, PNG only
    #[arg(value_enum)]
    ramp: Ramp = Ramp::Grey, "COLOURS";
    /// Values at the ends of the ramp, PNG only, or auto (openness from 0 to 1, depth over what is seen, counts from 0)
    #[arg(allow_hyphen_values = true)]
    range: Auto<Range> = Auto::Auto, "LOW,HIGH" in RAMP_ENDS;

    ["Ambient light"]
    /// Ambient rays per pixel, 1 to 65536: more is smoother; beyond 8 the eye sees little
    spp: u32 = 8, "N" in RAYS;
    /// Near-field radius in scene units, or auto (a tenth of the scene's smaller extents): farther blockers do not count
    radius: Auto<f32> = Auto::Auto, "LENGTH" in AUTO_LENGTH;
    /// Kind of the fuzzy measure μ(d) of the distance to the first hit
    #[arg(value_enum)]
    falloff: Falloff = Falloff::Power, "KIND";
    /// Exponent of the power falloff, above 0: larger darkens more
    exponent: f32 = 1.0, "NUMBER" in LENGTH;
    /// Rate of the exponential falloffs per scene unit, or auto (3/radius)
    sigma: Auto<f32> = Auto::Auto, "RATE" in AUTO_LENGTH;
    /// Ambient radiance of the far environment, linear RGB, or auto (the scene's, else white)
    ambient: Auto<Rgb> = Auto::Auto, "R,G,B" in AUTO_COLOR;
    /// Colour where no surface is seen, linear RGB, or auto (the ambient radiance if one is set, else grey)
    background: Auto<Rgb> = Auto::Auto, "R,G,B" in AUTO_COLOR;

    ["Method"]
    /// Who finds openness: Ambray, or a method to compare it with
    #[arg(value_enum)]
    method: Method = Method::Ambray, "METHOD";
    /// Samples of the methods ssao, hbao, gtao, bitmask and hybrid
    #[arg(value_enum)]
    screen_quality: ScreenQuality = ScreenQuality::High, "QUALITY";
    /// Thickness of what the depth buffer shows, scene units, or auto (bitmask: a quarter of the radius; hybrid: none)
    thickness: Auto<f32> = Auto::Auto, "LENGTH" in AUTO_LENGTH;

    ["Colour bleeding"]
    /// How near-field radiance is estimated from the hits
    #[arg(value_enum)]
    near_radiance: NearRadiance = NearRadiance::Averaged, "MODE";
    /// Distance in scene units below which hits enter the averages, or auto (all hits; the radius for averaged-plain)
    near_limit: Auto<f32> = Auto::Auto, "LENGTH" in AUTO_LENGTH;
    /// Radiance that leaves a hit
    #[arg(value_enum)]
    radiance_source: RadianceSource = RadianceSource::Ambient, "SOURCE";

    ["Thin objects"]
    /// Second batch of rays that finds thin objects
    #[arg(value_enum)]
    thin: Thin = Thin::Off, "MODE";
    /// With `--thin sheet`, count only surfaces seen edge-on
    #[arg(num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    thin_edge: bool = false, "BOOL";
    /// Where the smaller of the two batches is taken
    #[arg(value_enum)]
    thin_minimum: ThinMinimum = ThinMinimum::BeforeFilter, "PLACE";

    ["Sampling"]
    /// Which set of directions a pixel uses
    #[arg(value_enum)]
    sampling: Sampling = Sampling::Interleaved, "MODE";
    /// Generator of the sets
    #[arg(value_enum)]
    sequence: Sequence = Sequence::Auto, "KIND";
    /// Frame number: each frame continues the sample sequence
    frame: u32 = 0, "N";
    /// Scramble of the sample sets: another seed gives another picture of the same quality
    seed: u32 = 0, "N";

    ["Filter"]
    /// Window of the geometry-aware filter
    #[arg(long = "filter", value_enum)]
    filter: Window = Window::Centred, "WINDOW";
    /// Depth test that a neighbour must pass
    #[arg(value_enum)]
    filter_test: FilterTest = FilterTest::Plane, "TEST";
    /// Plane test: largest distance from the tangent plane, pixel footprints
    filter_plane: f32 = 1.0, "FOOTPRINTS" in LENGTH;
    /// Absolute test: largest difference of depth, scene units
    filter_absolute: f32 = 0.05, "LENGTH" in LENGTH;
    /// Relative test: largest difference of depth, share of the depth
    filter_relative: f32 = 0.01, "SHARE" in LENGTH;
    /// Smallest cosine between the normals of neighbours, -1 to 1; -1 accepts all
    #[arg(allow_negative_numbers = true)]
    filter_cos_normal: f32 = 0.95, "COSINE" in COSINE;

    ["Animation"]
    /// Animation of the file, by name or number from 0, or the word all for all at once; auto is the first
    animation: Auto<String> = Auto::Auto, "NAME";
    /// Time in the animation, seconds; auto is its start if an animation is named, else the scene at rest
    time: Auto<f32> = Auto::Auto, "SECONDS" in TIME;
    /// Start over after the end of the animation; otherwise its last pose holds
    #[arg(num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    animation_loop: bool = true, "BOOL";
    /// Accumulation over the frames of a sequence: each continues the sample sequence, and keeps what is still true
    #[arg(value_enum)]
    temporal: Temporal = Temporal::Off, "MODE";

    ["Direct light"]
    /// Use the lights of the scene
    #[arg(num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    lights: bool = true, "BOOL";
    /// Direction from the scene towards an additional sun; auto is no sun, or 0.4,1,0.3 if a strength is set
    #[arg(allow_hyphen_values = true)]
    sun_direction: Auto<Triple> = Auto::Auto, "X,Y,Z" in DIRECTION;
    /// Colour of the additional sun, linear RGB
    sun_color: Rgb = Rgb([1.0; 3]), "R,G,B" in COLOR;
    /// Irradiance of a surface that faces the additional sun; auto is 3 if a direction is set, else 0
    sun_strength: Auto<f32> = Auto::Auto, "NUMBER" in STRENGTH;

    ["Camera"]
    /// Camera of the file, by name or number from 0; auto takes the first, or frames the scene
    camera: Auto<String> = Auto::Auto, "NAME";
    /// Position of the camera, world space
    #[arg(allow_hyphen_values = true)]
    camera_position: Auto<Triple> = Auto::Auto, "X,Y,Z" in POINT;
    /// Point that the camera looks at, world space
    #[arg(allow_hyphen_values = true)]
    camera_target: Auto<Triple> = Auto::Auto, "X,Y,Z" in POINT;
    /// Direction that is upright in the picture
    #[arg(allow_hyphen_values = true)]
    camera_up: Auto<Triple> = Auto::Auto, "X,Y,Z" in DIRECTION;
    /// Full vertical angle of view, degrees above 0 and below 180; auto keeps the camera's, else 50
    vertical_fov: Auto<f32> = Auto::Auto, "DEGREES" in DEGREES;
    /// Height of an orthographic view, scene units; auto is perspective unless the camera says otherwise
    orthographic_height: Auto<f32> = Auto::Auto, "LENGTH" in AUTO_LENGTH;
}
