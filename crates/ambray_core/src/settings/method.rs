//! What the methods that Ambray is compared with mean for the other settings.

use std::borrow::Cow;

use super::{Falloff, Method, Sampling, Settings, SettingsError, Temporal, Thin};

impl Method {
    /// Whether it looks for blockers in the depth buffer, alone or first. Such methods need a picture, and have neither
    /// colour bleeding nor accumulation.
    #[must_use]
    pub const fn is_screen_space(self) -> bool {
        matches!(self, Self::Ssao | Self::Hbao | Self::Gtao | Self::Bitmask | Self::Hybrid)
    }
}

impl Settings {
    /// The settings by which Ambray itself does what [`method`](Self::method) asks for: the traced methods are Ambray with one
    /// part replaced. Others stay as they are.
    #[must_use]
    pub fn by_method(&self) -> Cow<'_, Self> {
        let replaced = |change: &dyn Fn(&mut Self)| {
            let mut settings = Self { method: Method::Ambray, ..self.clone() };
            change(&mut settings);
            Cow::Owned(settings)
        };
        match self.method {
            Method::TracedRandom => replaced(&|settings| settings.sampling = Sampling::Independent),
            Method::TracedSame => replaced(&|settings| settings.sampling = Sampling::Same),
            Method::TracedStep => replaced(&|settings| settings.falloff = Falloff::Step),
            _ => Cow::Borrowed(self),
        }
    }

    /// Settings that the method cannot follow.
    pub(super) fn method_errors(&self) -> Vec<SettingsError> {
        let mut errors = Vec::new();
        if !self.method.is_screen_space() {
            return errors;
        }
        let mut refuse = |name, value: String, allowed| errors.push(SettingsError { name, value, allowed });
        if self.thin != Thin::Off {
            refuse("thin", self.thin.to_string(), "off where the method works in screen space");
        }
        if self.temporal != Temporal::Off {
            refuse("temporal", self.temporal.to_string(), "off where the method works in screen space");
        }
        errors
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn traced_methods_replace_one_part() {
        let settings = |method| Settings { method, spp: 4, ..Settings::default() };
        let plain = settings(Method::Ambray);
        assert_eq!(*plain.by_method(), plain);
        let random = Settings { sampling: Sampling::Independent, ..plain.clone() };
        assert_eq!(*settings(Method::TracedRandom).by_method(), random);
        let same = Settings { sampling: Sampling::Same, ..plain.clone() };
        assert_eq!(*settings(Method::TracedSame).by_method(), same);
        let step = Settings { falloff: Falloff::Step, ..plain };
        assert_eq!(*settings(Method::TracedStep).by_method(), step);
        let gtao = settings(Method::Gtao);
        assert_eq!(*gtao.by_method(), gtao);
    }

    #[test]
    fn what_a_method_cannot_do_is_refused() {
        let errors = |method| {
            let settings =
                Settings { method, thin: Thin::Sheet, temporal: Temporal::On, ..Settings::default() };
            settings.validate().into_iter().map(|error| error.name).collect::<Vec<_>>()
        };
        assert_eq!(errors(Method::TracedStep), <[&str; 0]>::default());
        for method in Method::ALL.iter().filter(|method| method.is_screen_space()) {
            assert_eq!(errors(*method), ["thin", "temporal"], "{method}");
        }
    }
}
