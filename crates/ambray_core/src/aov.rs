//! Named output planes of a frame.

use std::{fmt, str::FromStr};

macro_rules! aovs {
    ($( $(#[doc = $doc:literal])+ $variant:ident = $name:literal [$($channel:literal)+], $kind:ident; )+) => {
        /// An output plane: arbitrary output variable, in the language of renderers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Aov { $( $(#[doc = $doc])+ $variant, )+ }

        impl Aov {
            /// All planes, in the order of the documentation.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// Name on the command line and of the layer in OpenEXR files.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// Names of the channels: `R G B`, `X Y Z`, `X Y`, or a single one.
            #[must_use]
            pub const fn channels(self) -> &'static [&'static str] {
                match self { $(Self::$variant => &[$($channel),+],)+ }
            }

            /// What the values are, which decides how a PNG shows them.
            #[must_use]
            pub const fn kind(self) -> AovKind {
                match self { $(Self::$variant => AovKind::$kind,)+ }
            }

            /// One sentence about the plane: content and unit.
            #[must_use]
            pub const fn description(self) -> &'static str {
                match self { $(Self::$variant => concat!($($doc),+).trim_ascii(),)+ }
            }
        }
    };
}

aovs! {
    /// The picture: emission + albedo · (ambient · O + I) + direct light
    Beauty = "beauty" ["R" "G" "B"], Color;
    /// Openness O after the filter, 1 = open
    Openness = "openness" ["Y"], Unit;
    /// Openness before the filter
    OpennessRaw = "openness-raw" ["Y"], Unit;
    /// Near-field radiance I after the filter
    NearRadiance = "near-radiance" ["R" "G" "B"], Color;
    /// Near-field radiance before the filter
    NearRadianceRaw = "near-radiance-raw" ["R" "G" "B"], Color;
    /// Direct light reflected by the surface
    Direct = "direct" ["R" "G" "B"], Color;
    /// Albedo
    Albedo = "albedo" ["R" "G" "B"], Color;
    /// Emitted radiance, and the base colour of unlit surfaces
    Emission = "emission" ["R" "G" "B"], Color;
    /// View depth in scene units, infinite where nothing is seen
    Depth = "depth" ["Z"], Depth;
    /// Position in the world, 0 where nothing is seen
    Position = "position" ["X" "Y" "Z"], Position;
    /// Unit normal of the triangle, towards the viewer, world space
    GeometricNormal = "geometric-normal" ["X" "Y" "Z"], Normal;
    /// Unit normal that directs the rays, world space
    ShadingNormal = "shading-normal" ["X" "Y" "Z"], Normal;
    /// Unit mean open direction after the filter, world space
    BentNormal = "bent-normal" ["X" "Y" "Z"], Normal;
    /// Index of the material, -1 where nothing is seen
    Material = "material" ["Y"], Id;
    /// Index of the instance, -1 where nothing is seen
    Instance = "instance" ["Y"], Id;
    /// Sample class of the pixel, 0 to 15
    SampleClass = "sample-class" ["Y"], Id;
    /// Rays traced for the pixel, of all types
    RayCount = "ray-count" ["Y"], Count;
    /// Movement of the surface point since the last frame, pixels to the right and down; 0 without --temporal on
    Motion = "motion" ["X" "Y"], Motion;
    /// Frames whose mean the ambient light is; 1 without --temporal on
    History = "history" ["Y"], Count;
}

/// What the values of a plane are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AovKind {
    /// Linear RGB radiance or albedo, not negative.
    Color,
    /// A number in `[0, 1]`, shown as it is.
    Unit,
    /// A distance, possibly infinite.
    Depth,
    /// A point in the world.
    Position,
    /// A unit vector, or 0.
    Normal,
    /// An index, or -1.
    Id,
    /// A count.
    Count,
    /// A movement in the picture, pixels.
    Motion,
}

impl fmt::Display for Aov {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Aov {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.iter().copied().find(|aov| aov.name() == name).ok_or_else(|| {
            let names: Vec<_> = Self::ALL.iter().map(|aov| aov.name()).collect();
            format!("expected one of {}", names.join(", "))
        })
    }
}
