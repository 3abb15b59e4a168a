//! What the settings as they are do not allow of one another, for widgets that should not offer it.

use ambray::settings::{Method, Settings, SettingsError};

/// Why `settings` do not allow `value` for their setting `name`; `None` where they do.
pub(super) fn of_choice(settings: &Settings, name: &str, value: &str) -> Option<String> {
    let mut tried = settings.clone();
    tried.set(name, value).ok()?;
    tried.validate().into_iter().find(|problem| problem.name == name).map(|problem| problem.to_string())
}

/// What `settings` could keep, were it not for their method.
pub(super) fn by_method(settings: &Settings) -> Vec<SettingsError> {
    let without = Settings { method: Method::Ambray, ..settings.clone() }.validate();
    settings.validate().into_iter().filter(|problem| !without.contains(problem)).collect()
}

/// Names as a sentence has them: a, b and c.
pub(super) fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [name] => (*name).to_owned(),
        [before @ .., last] => format!("{} and {last}", before.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Temporal, Thin};

    use super::*;

    #[test]
    fn choices_are_refused_with_the_reason_and_only_where_the_method_works_in_screen_space() {
        let settings = |method| Settings { method, ..Settings::default() };
        let reason = of_choice(&settings(Method::Gtao), "thin", "sheet");
        assert_eq!(
            reason.as_deref(),
            Some("thin sheet is not allowed: off where the method works in screen space")
        );
        assert_eq!(of_choice(&settings(Method::Gtao), "thin", "off"), None);
        assert_eq!(of_choice(&settings(Method::TracedStep), "thin", "sheet"), None);
        // A method may be chosen, whatever it will not go with: by_method says so afterwards.
        let sheet = Settings { thin: Thin::Sheet, ..settings(Method::Ambray) };
        assert_eq!(of_choice(&sheet, "method", "gtao"), None);
    }

    #[test]
    fn the_method_answers_for_nothing_but_what_it_refuses() {
        let wrong = Settings {
            method: Method::Ssao,
            thin: Thin::Sheet,
            temporal: Temporal::On,
            filter_cos_normal: 7.0,
            ..Settings::default()
        };
        let names: Vec<_> = by_method(&wrong).iter().map(|problem| problem.name).collect();
        assert_eq!(names, ["thin", "temporal"]);
        assert_eq!(listed(&names), "thin and temporal");
        assert!(by_method(&Settings { method: Method::Ambray, ..wrong }).is_empty());
    }
}
