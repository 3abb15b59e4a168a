//! Settings that choose among named alternatives.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

use super::{
    ValueError,
    field::{Kind, Value},
    spelling::kebab,
    values::expected,
};

/// Declares enums whose variants are spelled in kebab case in files and flags alike.
macro_rules! choices {
    ($(
        $(#[doc = $doc:literal])*
        $name:ident {
            $( $(#[doc = $help:literal])+ $(#[default $($default:tt)?])? $variant:ident, )*
        }
    )*) => { $(
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
        #[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
        #[serde(rename_all = "kebab-case")]
        pub enum $name { $( $(#[doc = $help])+ $(#[default $($default)?])? $variant, )* }

        impl $name {
            /// All alternatives, in the order of the documentation.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Its name in files and on the command line.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => kebab!($variant),)* }
            }

            /// What it means.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => concat!($($help),+).trim_ascii(),)* }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }

        impl FromStr for $name {
            type Err = ValueError;

            fn from_str(name: &str) -> Result<Self, ValueError> {
                Self::ALL.iter().copied().find(|choice| choice.name() == name).ok_or_else(|| {
                    expected(&format!("one of {}", [$(kebab!($variant)),*].join(", ")))
                })
            }
        }

        impl Value for $name {
            const KIND: Kind = Kind::Choice(&[
                $((kebab!($variant), concat!($($help),+).trim_ascii()),)*
            ]);

            fn read(text: &str) -> Result<Self, ValueError> {
                text.parse()
            }
        }
    )* };
}

choices! {
    /// Who finds how open a pixel is: Ambray, or one of the methods that it is compared with.
    Method {
        /// interleaved rays, by the other settings
        #[default]
        Ambray,
        /// rays as Ambray's, but independent random directions in every pixel
        TracedRandom,
        /// rays as Ambray's, but one set of directions for all pixels
        TracedSame,
        /// rays as Ambray's, but every hit within the radius blocks fully
        TracedStep,
        /// screen-space ambient occlusion with a hemisphere of samples (Mittring 2007, Chapman 2013)
        Ssao,
        /// horizon-based ambient occlusion (Bavoil and Sainz 2008)
        Hbao,
        /// ground-truth ambient occlusion as in XeGTAO (Jimenez et al. 2016, Strugar 2021)
        Gtao,
        /// ambient occlusion by a visibility bitmask, for surfaces of some thickness (Therrien et al. 2023)
        Bitmask,
        /// screen-space rays, and traced ones where the depth buffer cannot know (Bavoil et al. 2018)
        Hybrid,
    }
    /// Samples that the screen-space methods take.
    ScreenQuality {
        /// a third or less of what was published as good
        Low,
        /// between low and high
        Medium,
        /// the published default
        #[default]
        High,
        /// several times that
        Ultra,
    }
    /// Kind of the fuzzy measure μ(d) (spec §2).
    Falloff {
        /// (d/R)^exponent, 1 from the radius on
        #[default]
        Power,
        /// 1 − exp(−sigma d), without an end
        Exponential,
        /// the same, scaled to reach 1 at the radius
        ExponentialTruncated,
        /// 0 below the radius, 1 beyond: classical ambient occlusion
        Step,
    }
    /// How near-field radiance I is estimated from the hits (spec §3).
    NearRadiance {
        /// mean radiance of the hits weighted by 1 − μ, times 1 − O
        #[default]
        Averaged,
        /// plain mean radiance of the hits nearer than the near limit, times 1 − O
        AveragedPlain,
        /// sum over the hits of (1 − μ) times their radiance
        PerHit,
        /// no colour bleeding
        Off,
    }
    /// Radiance L_r leaving a hit (spec §3).
    RadianceSource {
        /// albedo of the hit, whatever the ambient radiance
        Albedo,
        /// albedo times ambient radiance
        #[default]
        Ambient,
        /// as ambient, with infinite bounces between surfaces as open as the shaded point
        SelfSimilar,
        /// albedo times ambient radiance and direct light, with shadows
        Lit,
        /// the same without shadows
        LitUnshadowed,
    }
    /// Detection of thin objects that the rays slip past (spec §8).
    Thin {
        /// none: the measured result
        #[default]
        Off,
        /// the paper's second batch: all pairs of missed rays
        Paper,
        /// opposite pairs with fuzzy visibility: fills the bright line under curtains
        Sheet,
    }
    /// Where the minimum of the first and the second batch is taken (spec §8.3).
    ThinMinimum {
        /// per pixel, before the filter
        #[default]
        BeforeFilter,
        /// after filtering both batches: less downward bias
        AfterFilter,
    }
    /// Accumulation of ambient light over frames (spec §12).
    Temporal {
        /// every frame by itself
        #[default]
        Off,
        /// with earlier frames where the surface was seen, as far as nothing that moves makes them untrue
        On,
    }
    /// Which sample set a pixel uses (spec §6).
    Sampling {
        /// 16 classes over 4 × 4 pixels, each good alone and all good together
        #[default]
        Interleaved,
        /// one set for all pixels: bands
        Same,
        /// one good set per pixel, scrambled by a hash of the pixel: dot noise
        Random,
        /// independent random directions, as in plain Monte Carlo
        Independent,
    }
    /// Generator of the sample sets (spec §6).
    Sequence {
        /// owen where spp is a power of two, r2 elsewhere
        #[default]
        Auto,
        /// Owen-scrambled (0,2)-sequence
        Owen,
        /// R2 sequence
        R2,
    }
    /// Window of the low-pass filter over one 4 × 4 pattern (spec §7).
    Window {
        /// no filter
        Off,
        /// 4 × 4 taps, shifted by half a pixel
        Box,
        /// 5 × 5 taps, the outer ones by half
        #[default]
        Centred,
    }
    /// Which neighbours the filter accepts by depth (spec §7).
    FilterTest {
        /// distance from the tangent plane in pixel footprints
        #[default]
        Plane,
        /// difference of depth in scene units
        Absolute,
        /// difference of depth as a share of the depth
        Relative,
        /// all of them
        None,
    }
    /// Which normal directs the ambient rays and the sun.
    Normals {
        /// interpolated vertex normals with normal maps
        #[default]
        Shading,
        /// interpolated vertex normals
        Smooth,
        /// the plane of each triangle
        Geometric,
    }
    /// Mapping of linear radiance to the display in PNG pictures; OpenEXR stays linear.
    ToneMap {
        /// clip at 1
        None,
        /// Khronos PBR Neutral: colours below 0.8 keep their look, highlights roll off
        #[default]
        Neutral,
    }
    /// Colours of planes of one number a pixel in PNG pictures; OpenEXR keeps the numbers.
    Ramp {
        /// black to white
        #[default]
        Grey,
        /// dark violet to yellow, even to the eye
        Viridis,
        /// black over purple to a light yellow, even to the eye
        Magma,
        /// blue over green to red: tells most values apart
        Turbo,
        /// dark blue to yellow, the same to those who see red and green alike
        Cividis,
    }
    /// A starting point; a settings file and flags have the last word.
    Preset {
        /// 4 interleaved rays per pixel, filtered: for a first look
        Draft,
        /// 8 interleaved rays per pixel, filtered: the method as published
        #[default]
        Realtime,
        /// 1024 rays per pixel with an independent scramble in every pixel, unfiltered: the truth to compare with
        Reference,
    }
}
