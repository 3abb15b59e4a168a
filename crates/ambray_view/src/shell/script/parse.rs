//! Steps of a script from their lines.

use ambray::Aov;
use anyhow::{Context as _, bail};
use egui::{Key, Modifiers, PointerButton};

use super::Step;
use crate::{
    engine::MOST_FRAMES,
    model::{Comparison, Side},
};

/// The step that `line` says; it is not empty.
pub(super) fn step(line: &str) -> anyhow::Result<Step> {
    let (verb, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    let words: Vec<&str> = rest.split_whitespace().collect();
    Ok(match verb {
        "wait" => nothing(rest, Step::Wait)?,
        "open" => Step::Open(some(rest, "a scene")?.into()),
        "drop" => Step::Drop(some(rest, "a file")?.into()),
        "set" => {
            let (name, value) = rest.split_once(char::is_whitespace).context("expected NAME VALUE")?;
            Step::Set { name: name.to_owned(), value: value.trim().to_owned() }
        }
        "side" => Step::Edit(match rest {
            "a" => Side::A,
            "b" => Side::B,
            _ => bail!("expected a or b, not '{rest}'"),
        }),
        "compare" => Step::Compare(match rest {
            "off" => Comparison::Off,
            "split" => Comparison::Split,
            "difference" => Comparison::Difference,
            _ => bail!("expected off, split or difference, not '{rest}'"),
        }),
        "divider" => {
            let share = numbers::<1>(&words, "SHARE")?[0];
            if !(0.0..=1.0).contains(&share) {
                bail!("expected a share from 0 to 1, not {share}");
            }
            Step::Divider(share)
        }
        "aov" => Step::Show(rest.parse::<Aov>().map_err(anyhow::Error::msg)?),
        "overlays" => Step::Overlays(match rest {
            "on" => true,
            "off" => false,
            _ => bail!("expected on or off, not '{rest}'"),
        }),
        "frames" => {
            let count = rest.parse().ok().filter(|count| (1..=MOST_FRAMES).contains(count));
            Step::Frames(
                count.with_context(|| format!("expected COUNT from 1 to {MOST_FRAMES}, not '{rest}'"))?,
            )
        }
        "resize" => {
            let side = |word: &str| word.parse().ok().filter(|side| (1..=16384).contains(side));
            match words[..] {
                [width, height] if side(width).is_some() && side(height).is_some() => {
                    Step::Resize(side(width).unwrap_or(1), side(height).unwrap_or(1))
                }
                _ => bail!("expected WIDTH HEIGHT, whole numbers from 1 to 16384, not '{rest}'"),
            }
        }
        "key" => key(rest)?,
        "type" => Step::Type(some(rest, "text")?.to_owned()),
        "move" => Step::Move(numbers::<2>(&words, "X Y")?[0], numbers::<2>(&words, "X Y")?[1]),
        "click" | "double-click" | "alt-click" => {
            let [x, y] = numbers(&words, "X Y")?;
            let count = if verb == "double-click" { 2 } else { 1 };
            let modifiers = if verb == "alt-click" { Modifiers::ALT } else { Modifiers::NONE };
            Step::Click { at: (x, y), count, modifiers }
        }
        "scroll" => {
            let [x, y, lines] = numbers(&words, "X Y LINES")?;
            Step::Scroll { at: (x, y), lines }
        }
        "drag" => {
            let (places, with) = match words[..] {
                [.., "left"] => (&words[..words.len() - 1], PointerButton::Primary),
                [.., "middle"] => (&words[..words.len() - 1], PointerButton::Middle),
                [.., "right"] => (&words[..words.len() - 1], PointerButton::Secondary),
                _ => (&words[..], PointerButton::Primary),
            };
            let [x, y, dx, dy] = numbers(places, "X Y DX DY [left, middle or right]")?;
            Step::Drag { from: (x, y), by: (dx, dy), with }
        }
        "screenshot" => Step::Screenshot(some(rest, "FILE.png")?.into()),
        "turntable" => {
            let (path, frames) = rest.rsplit_once(char::is_whitespace).context("expected FILE FRAMES")?;
            let frames = frames.parse().ok().filter(|frames| *frames > 0);
            let frames = frames.with_context(|| format!("expected FILE FRAMES, not '{rest}'"))?;
            Step::Turntable { path: path.trim().into(), frames }
        }
        "copy" => Step::Copy(some(rest, "a file")?.into()),
        "expect" => match rest.split_once(char::is_whitespace).unwrap_or((rest, "")) {
            ("error", text) => Step::ExpectError(text.trim().to_owned()),
            ("no-error", "") => Step::ExpectNoError,
            _ => bail!("expected 'error TEXT' or 'no-error', not '{rest}'"),
        },
        "quit" => nothing(rest, Step::Quit)?,
        _ => bail!("no step is called '{verb}'"),
    })
}

/// A key with modifiers before it: `Ctrl+Shift+Z`. Plus itself is `Plus`.
fn key(text: &str) -> anyhow::Result<Step> {
    let mut parts: Vec<&str> = text.split('+').map(str::trim).collect();
    let name = parts.pop().unwrap_or_default();
    let mut modifiers = Modifiers::NONE;
    for part in parts {
        modifiers |= match part {
            "Ctrl" => Modifiers::CTRL | Modifiers::COMMAND,
            "Shift" => Modifiers::SHIFT,
            "Alt" => Modifiers::ALT,
            _ => bail!("expected Ctrl, Shift or Alt before the key, not '{part}'"),
        };
    }
    let key = Key::from_name(name).with_context(|| format!("no key is called '{name}'"))?;
    // Single characters are typed, too, as a keyboard does.
    let is_typed = name.chars().count() == 1 && !modifiers.ctrl && !modifiers.alt;
    let text = is_typed.then(|| if modifiers.shift { name.to_owned() } else { name.to_lowercase() });
    Ok(Step::Key { key, modifiers, text })
}

fn nothing(rest: &str, step: Step) -> anyhow::Result<Step> {
    if rest.is_empty() { Ok(step) } else { bail!("nothing is expected after it, not '{rest}'") }
}

fn some<'a>(rest: &'a str, what: &str) -> anyhow::Result<&'a str> {
    if rest.is_empty() { bail!("expected {what}") } else { Ok(rest) }
}

fn numbers<const N: usize>(words: &[&str], what: &str) -> anyhow::Result<[f32; N]> {
    let numbers: Option<Vec<f32>> = words.iter().map(|word| word.parse().ok()).collect();
    (numbers.and_then(|numbers| <[f32; N]>::try_from(numbers).ok()))
        .filter(|numbers| numbers.iter().all(|number| number.is_finite()))
        .with_context(|| format!("expected {what}, not '{}'", words.join(" ")))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{super::Script, *};

    #[test]
    fn steps_are_read_from_lines() {
        let text = "# a walk\n\nwait\n  set radius 0.5\nkey Ctrl+Z\nkey ?\ndrag 1 2 30 -4 right\nexpect error no such\n";
        let script = Script::parse(Path::new("walk.txt"), text).expect("steps");
        let steps: Vec<_> = script.steps.into_iter().rev().collect();
        assert_eq!(steps.len(), 6);
        assert_eq!(steps[0], (3, Step::Wait));
        assert_eq!(steps[1], (4, Step::Set { name: "radius".into(), value: "0.5".into() }));
        let undo = Modifiers::CTRL | Modifiers::COMMAND;
        assert_eq!(steps[2].1, Step::Key { key: Key::Z, modifiers: undo, text: None });
        let help = Step::Key { key: Key::Questionmark, modifiers: Modifiers::NONE, text: Some("?".into()) };
        assert_eq!(steps[3].1, help);
        let right = PointerButton::Secondary;
        assert_eq!(steps[4].1, Step::Drag { from: (1.0, 2.0), by: (30.0, -4.0), with: right });
        assert_eq!(steps[5].1, Step::ExpectError("no such".into()));
    }

    #[test]
    fn what_is_no_step_is_named_with_its_line() {
        for (line, why) in [
            ("paint", "no step is called 'paint'"),
            ("wait 5", "nothing is expected"),
            ("set radius", "NAME VALUE"),
            ("side c", "a or b"),
            ("divider 2", "0 to 1"),
            ("aov wood", "expected one of beauty"),
            ("turntable turn.gif", "FILE FRAMES"),
            ("turntable turn.gif 0", "FILE FRAMES"),
            ("overlays perhaps", "on or off"),
            ("frames 257", "1 to 256"),
            ("resize 640", "WIDTH HEIGHT"),
            ("resize 0 5", "WIDTH HEIGHT"),
            ("click 1", "X Y"),
            ("drag 1 2 3 nan", "X Y DX DY"),
            ("key Hyper+A", "Ctrl, Shift or Alt"),
            ("key Any", "no key is called 'Any'"),
            ("expect nothing", "no-error"),
        ] {
            let error = Script::parse(Path::new("walk.txt"), &format!("wait\n{line}\n")).unwrap_err();
            let text = format!("{error:#}");
            assert!(text.starts_with("walk.txt:2: ") && text.contains(why), "{text}");
        }
    }
}
