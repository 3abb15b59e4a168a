//! What is compared: methods with their settings, and where they come from.

use std::collections::BTreeSet;

use ambray::settings::{Method, ScreenQuality, Settings, Temporal};
use serde::Serialize;

/// One of the things that are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// Its name in tables.
    pub name: String,
    /// How it is rendered.
    pub settings: Settings,
}

impl Subject {
    /// `method` with everything else of `settings`.
    #[must_use]
    pub fn of(method: Method, settings: &Settings) -> Self {
        let mut settings = Settings { method, ..settings.clone() };
        if method != Method::Ambray {
            // Thin objects are Ambray's own, and what is accumulated is compared in sequences.
            settings.thin = Settings::default().thin;
            settings.temporal = Temporal::Off;
        }
        Self { name: About::of(method).title.to_owned(), settings }
    }

    /// The same with `spp` rays, or with `quality` where the method takes no rays.
    #[must_use]
    pub fn with(&self, effort: Effort) -> Self {
        let mut settings = self.settings.clone();
        match effort {
            Effort::Rays(spp) => settings.spp = spp,
            Effort::Quality(quality) => settings.screen_quality = quality,
        }
        Self { name: self.name.clone(), settings }
    }

    /// What makes it better and slower: each of `rays` once and in order, or all qualities.
    #[must_use]
    pub fn efforts(&self, rays: &[u32]) -> Vec<Effort> {
        match self.settings.method {
            Method::Ssao | Method::Hbao | Method::Gtao | Method::Bitmask => {
                ScreenQuality::ALL.iter().map(|&quality| Effort::Quality(quality)).collect()
            }
            _ => {
                let rays: BTreeSet<u32> = rays.iter().copied().collect();
                rays.into_iter().map(Effort::Rays).collect()
            }
        }
    }

    /// How much it does.
    #[must_use]
    pub fn effort(&self) -> Effort {
        match self.settings.method {
            Method::Ssao | Method::Hbao | Method::Gtao | Method::Bitmask => {
                Effort::Quality(self.settings.screen_quality)
            }
            _ => Effort::Rays(self.settings.spp),
        }
    }
}

/// How much a method does for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Effort {
    /// Rays a pixel.
    Rays(u32),
    /// Samples of a method that takes no rays.
    Quality(ScreenQuality),
}

impl std::fmt::Display for Effort {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Rays(1) => write!(f, "1 ray"),
            Self::Rays(spp) => write!(f, "{spp} rays"),
            Self::Quality(quality) => quality.fmt(f),
        }
    }
}

/// What there is to say about a method.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// Its name.
    pub title: &'static str,
    /// What it does, and what it is known not to do.
    pub text: &'static str,
    /// Where it was published.
    pub source: &'static str,
}

impl About {
    /// What there is to say about `method`.
    #[must_use]
    pub const fn of(method: Method) -> Self {
        let (title, text, source) = match method {
            Method::Ambray => (
                "Ambray",
                "Cosine-weighted rays from 16 sample sets that interleave over 4 × 4 pixels, each good alone and all good \
                 together, then a filter over one such pattern that stops at edges.",
                "Fridvalszky and Tóth, Real-time ambient lighting with raytracing",
            ),
            Method::TracedRandom => (
                "Rays, random",
                "The same rays, falloff and filter, but independent random directions in every pixel: plain Monte Carlo.",
                "Cook, Porter, Carpenter 1984, Distributed ray tracing",
            ),
            Method::TracedSame => (
                "Rays, one set",
                "The same rays, falloff and filter, but one good set of directions for all pixels: the error turns into bands, \
                 which no filter of this size removes.",
                "what the paper begins with (figure 2)",
            ),
            Method::TracedStep => (
                "Rays, step falloff",
                "The same rays and filter, but every hit within the radius blocks fully: classical ambient occlusion. It answers \
                 another question, so its difference from the truth does not vanish with more rays.",
                "Landis 2002, Production-ready global illumination",
            ),
            Method::Ssao => (
                "SSAO",
                "Points in the hemisphere above the pixel are compared with the depth buffer, then a 4 × 4 box blur.",
                "Mittring 2007, Finding next gen: CryEngine 2; in the form of Chapman 2013",
            ),
            Method::Hbao => (
                "HBAO",
                "The horizon of the depth buffer in a few directions, with attenuation by distance, then a depth-aware blur.",
                "Bavoil, Sainz, Dimitrov 2008, Image-space horizon-based ambient occlusion",
            ),
            Method::Gtao => (
                "GTAO",
                "Two horizons a slice and the cosine-weighted integral between them, with the defaults of XeGTAO and its denoiser. \
                 These were fitted to traced ambient occlusion, with a falloff of their own.",
                "Jimenez, Wu, Pesce, Jarabo 2016, Practical real-time strategies for accurate indirect occlusion; Strugar 2021, \
                 XeGTAO",
            ),
            Method::Bitmask => (
                "Visibility bitmask",
                "Each sample of the depth buffer covers the angles of a surface of some thickness, so that light passes behind thin \
                 things.",
                "Therrien, Levesque, Gilet 2023, Screen space indirect lighting with visibility bitmask",
            ),
            Method::Hybrid => (
                "Hybrid",
                "Ambray's rays and filter, but each ray walks through the depth buffer first, and is traced only where that cannot \
                 know the answer.",
                "after Bavoil et al. 2018",
            ),
        };
        Self { title, text, source }
    }
}

#[cfg(test)]
mod tests {
    use ambray::settings::Thin;

    use super::*;

    #[test]
    fn every_subject_can_be_rendered() {
        let asked = Settings { thin: Thin::Sheet, temporal: Temporal::On, ..Settings::default() };
        for &method in Method::ALL {
            let subject = Subject::of(method, &asked);
            for effort in subject.efforts(&[1, 8]) {
                let subject = subject.with(effort);
                assert_eq!(subject.settings.validate(), [], "{method}");
                assert_eq!(subject.effort(), effort);
            }
        }
    }
}
