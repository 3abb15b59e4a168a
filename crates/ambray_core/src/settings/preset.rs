//! Named settings for usual needs.

use serde::{Deserialize, Serialize};

use super::{Sampling, SettingsPatch, Window};

/// A starting point; a settings file and flags have the last word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// 4 interleaved rays per pixel, filtered: for a first look
    Draft,
    /// 8 interleaved rays per pixel, filtered: the method as published
    #[default]
    Realtime,
    /// 1024 rays per pixel with an independent scramble in every pixel, unfiltered: the truth to compare with
    Reference,
}

impl Preset {
    /// The fields that the preset decides.
    #[must_use]
    pub fn patch(self) -> SettingsPatch {
        let (spp, sampling, filter) = match self {
            Self::Draft => (4, Sampling::Interleaved, Window::Centred),
            Self::Realtime => (8, Sampling::Interleaved, Window::Centred),
            Self::Reference => (1024, Sampling::Random, Window::Off),
        };
        SettingsPatch { spp: Some(spp), sampling: Some(sampling), filter: Some(filter), ..Default::default() }
    }
}
