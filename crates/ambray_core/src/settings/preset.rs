//! Named settings for usual needs.

use super::{Preset, Sampling, SettingsPatch, Window};

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
