//! Wrong command lines in the program's own voice: one line that names the option, the value and what is allowed.

use std::{error::Error as _, ffi::OsString};

use anyhow::anyhow;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::{args, failure::with_hint};

/// What is wrong with `arguments`, the program's name first, that clap refused with `error`.
#[must_use]
pub fn explain(error: &clap::Error, arguments: &[OsString]) -> anyhow::Error {
    let told = anyhow!(problem(error));
    match suggestion(error).or_else(|| args::hint(arguments)) {
        Some(hint) => with_hint(told, hint),
        None => told,
    }
}

fn problem(error: &clap::Error) -> String {
    let argument = arguments(error);
    let value = text(error, ContextKind::InvalidValue);
    match (error.kind(), argument, value) {
        (ErrorKind::ValueValidation, Some(name), Some(value)) => {
            let reason = error.source().map(ToString::to_string).unwrap_or_default();
            format!("{name} {value} is not allowed: {reason}")
        }
        (ErrorKind::InvalidValue, Some(name), Some(value)) if !value.is_empty() => {
            format!("{name} {value} is not allowed{}", allowed(error))
        }
        (ErrorKind::InvalidValue | ErrorKind::NoEquals, Some(name), _) => {
            format!("{name} needs a value{}", allowed(error))
        }
        (ErrorKind::UnknownArgument, Some(name), _) if name.starts_with('-') => {
            format!("there is no option {name}")
        }
        (ErrorKind::UnknownArgument, Some(name), _) => format!("{name} is one word too many"),
        (ErrorKind::TooManyValues, Some(name), Some(value)) => {
            format!("{name}: {value} is one value too many")
        }
        (ErrorKind::MissingRequiredArgument, Some(names), _) => {
            format!("{names} {} missing", if names.contains(" and ") { "are" } else { "is" })
        }
        _ => match text(error, ContextKind::InvalidSubcommand) {
            Some(name) => format!("there is no command {name}"),
            None => plain(error),
        },
    }
}

/// The first paragraph of clap's own words.
fn plain(error: &clap::Error) -> String {
    let words = error.to_string();
    let paragraph = words.split("\n\n").next().unwrap_or_default();
    paragraph.strip_prefix("error: ").unwrap_or(paragraph).to_owned()
}

fn suggestion(error: &clap::Error) -> Option<String> {
    let kinds = [ContextKind::SuggestedValue, ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand];
    let near = kinds.into_iter().find_map(|kind| text(error, kind))?;
    Some(format!("did you mean {near}?"))
}

fn allowed(error: &clap::Error) -> String {
    let values = text(error, ContextKind::ValidValue).filter(|values| !values.is_empty());
    values.map(|values| format!(": {values}")).unwrap_or_default()
}

fn text(error: &clap::Error, kind: ContextKind) -> Option<String> {
    match error.get(kind)? {
        ContextValue::String(text) => Some(text.clone()),
        ContextValue::Strings(texts) => Some(texts.join(", ")),
        _ => None,
    }
}

/// The names of what `error` is about, each without what clap spells around it.
fn arguments(error: &clap::Error) -> Option<String> {
    match error.get(ContextKind::InvalidArg)? {
        ContextValue::String(spelled) => Some(option(spelled).to_owned()),
        ContextValue::Strings(spelled) => {
            let names: Vec<&str> = spelled.iter().map(|spelled| option(spelled)).collect();
            let (last, before) = names.split_last()?;
            Some(if before.is_empty() {
                (*last).to_owned()
            } else {
                format!("{} and {last}", before.join(", "))
            })
        }
        _ => None,
    }
}

/// The name of an option that clap spells `--size <WIDTHxHEIGHT>`, `--lights[=<BOOL>]` or `[SCENE]`.
fn option(spelled: &str) -> &str {
    let end = spelled.find([' ', '=']).unwrap_or(spelled.len());
    let name = spelled[..end].trim_matches(['[', ']', '<', '>']);
    if name.is_empty() { spelled } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(arguments: &[&str], expected: &str) {
        let arguments: Vec<OsString> = ["ambray"].iter().chain(arguments).map(OsString::from).collect();
        let error = args::parse_from(&arguments).expect_err("a wrong command line");
        let told = format!("{:#}", explain(&error, &arguments));
        assert_eq!(told, expected);
    }

    #[test]
    fn values_are_told_with_what_is_allowed() {
        let whole = "a whole number, 0 to 4294967295";
        check(&["render", "--frame=-1"], &format!("--frame -1 is not allowed: {whole}"));
        check(&["render", "--seed", "many"], &format!("--seed many is not allowed: {whole}"));
        check(&["render", "--spp=1.5"], "--spp 1.5 is not allowed: a whole number, 1 to 65536");
        check(&["render", "--threads=-1"], "--threads -1 is not allowed: a whole number, 0 to 1024");
        check(&["bench", "--frames=0"], "--frames 0 is not allowed: a whole number, 1 to 1000000");
        check(&["bench", "--seconds=-1"], "--seconds -1 is not allowed: seconds from 0 to 86400");
        check(&["render", "--radius=big"], "--radius big is not allowed: auto or a number");
        check(&["render", "--exponent=big"], "--exponent big is not allowed: a number");
        check(&["render", "--size", "-3x4"], "--size -3x4 is not allowed: WIDTHxHEIGHT, such as 640x360");
        check(
            &["render", "--sun-direction=1,2"],
            "--sun-direction 1,2 is not allowed: auto or X,Y,Z, such as 0,1.6,-3",
        );
        check(&["render", "--thin=thick"], "--thin thick is not allowed: off, paper, sheet");
        check(&["render", "--thin-edge=maybe"], "--thin-edge maybe is not allowed: true, false");
        check(&["render", "--preset"], "--preset needs a value: draft, realtime, reference");
        check(&["render", "-o", ""], "--output needs a value");
        check(&["render", ""], "SCENE needs a value");
    }

    #[test]
    fn words_that_do_not_belong_are_told() {
        check(&["render", "--sise=3x3"], "there is no option --sise");
        check(&["rendre"], "there is no command rendre");
        check(&["render", "a.glb", "b.glb"], "b.glb is one word too many");
        check(&["query", "a.glb"], "--points is missing");
        check(&["diff"], "PICTURE and REFERENCE are missing");
        check(&["diff", "a.png"], "REFERENCE is missing");
    }
}
