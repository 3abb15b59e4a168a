//! The call of `ambray render` that makes the picture that is seen.

use std::path::Path;

use ambray::settings::Settings;

/// The call `ambray render SCENE ...` whose settings are exactly `settings`, for a POSIX shell; `more` are further arguments
/// such as `--aov depth`, one word each.
///
/// Only settings that differ from their default are named. Numbers are spelled so that they are read back to the same bits.
/// A path that is not Unicode is spelled with replacement characters.
#[must_use]
pub fn render_command(
    scene: &Path,
    gltf_scene: Option<&str>,
    settings: &Settings,
    more: &[String],
) -> String {
    let scene = scene.to_string_lossy();
    // A path that begins with a dash would be taken for an option.
    let scene = if scene.starts_with('-') { format!("./{scene}") } else { scene.into_owned() };
    let mut words = vec!["ambray".to_owned(), "render".to_owned(), scene];
    words.extend(gltf_scene.map(|name| format!("--gltf-scene={name}")));
    let (defaults, names) = (Settings::default(), Settings::fields().iter().map(|field| field.name));
    for (name, value) in names.filter_map(|name| Some((name, settings.get(name)?))) {
        if defaults.get(name).as_ref() != Some(&value) {
            words.push(format!("--{name}={value}"));
        }
    }
    words.extend_from_slice(more);
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// A word as a shell reads it: of `--name=value` the value alone is quoted, and only where it must be.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.,:/+@".contains(c);
    let (option, value) = match word.split_once('=') {
        Some((name, value)) if name.starts_with("--") && name.chars().all(is_plain) => {
            (&word[..=name.len()], value)
        }
        _ => ("", word),
    };
    if !value.is_empty() && value.chars().all(is_plain) {
        return word.to_owned();
    }
    // No shell can pass a NUL, but it is better seen in the line than lost with the line.
    let value = shlex::Quoter::new().allow_nul(true).quote(value).unwrap_or_default();
    format!("{option}{value}")
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Auto, Rgb, Thin, Triple};

    use super::*;

    #[test]
    fn only_what_differs_is_named() {
        let line = |settings: &Settings| render_command(Path::new("a.glb"), None, settings, &[]);
        assert_eq!(line(&Settings::default()), "ambray render a.glb");
        let settings = Settings {
            exposure: -0.1,
            radius: Auto::Value(1e-7),
            ambient: Auto::Value(Rgb([0.1, 0.5, 1.0])),
            thin: Thin::Sheet,
            lights: false,
            camera_position: Auto::Value(Triple([-1.0, 1.6, 0.0])),
            ..Settings::default()
        };
        assert_eq!(
            line(&settings),
            "ambray render a.glb --exposure=-0.1 --radius=0.0000001 --ambient=0.1,0.5,1 --thin=sheet \
             --lights=false --camera-position=-1,1.6,0"
        );
    }

    #[test]
    fn words_that_mean_something_to_a_shell_are_quoted() {
        let settings = Settings { camera: Auto::Value("it's $HOME".to_owned()), ..Settings::default() };
        let more = ["-o".to_owned(), "my picture.png".to_owned()];
        let line = render_command(Path::new("-a scene.glb"), Some("Scène *"), &settings, &more);
        let words = shlex::split(&line).expect("quotes are closed");
        let expected = [
            "ambray",
            "render",
            "./-a scene.glb",
            "--gltf-scene=Scène *",
            "--camera=it's $HOME",
            "-o",
            "my picture.png",
        ];
        assert_eq!(words, expected, "{line}");
        assert!(line.contains(" --gltf-scene='Scène *' "), "{line}");
    }
}
