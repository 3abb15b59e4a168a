//! Names of numbered files: `out/frame_####.png`.

use std::{
    ffi::OsStr,
    path::{Path, PathBuf},
};

use anyhow::{anyhow, bail};

use crate::problem::with_hint;

/// The name of a file with a run of `#` that stands for the number of the frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbering {
    path: PathBuf,
    /// The name before the run, its length, and the name after it; `None` if there is none.
    run: Option<(String, usize, String)>,
}

impl Numbering {
    /// Finds the run of `#` in the name of `path`; folders may be called as they like.
    pub fn of(path: &Path) -> anyhow::Result<Self> {
        let name = path.file_name().map(OsStr::to_string_lossy).unwrap_or_default();
        let Some(start) = name.find('#') else { return Ok(Self { path: path.to_owned(), run: None }) };
        if path.file_name().and_then(OsStr::to_str).is_none() {
            bail!("output {}: the name is not UTF-8 text, and # needs one", path.display());
        }
        let rest = name[start..].trim_start_matches('#');
        if rest.contains('#') {
            let error = anyhow!("output {}: # stands in two places", path.display());
            return Err(with_hint(error, "one run of # is the number of the frame, such as frame_####.png"));
        }
        let digits = name.len() - start - rest.len();
        Ok(Self { run: Some((name[..start].to_owned(), digits, rest.to_owned())), path: path.to_owned() })
    }

    /// Whether each frame has a name of its own.
    #[must_use]
    pub const fn is_numbered(&self) -> bool {
        self.run.is_some()
    }

    /// The file of frame `number`: padded with zeros to the length of the run, longer where the number is.
    #[must_use]
    pub fn path(&self, number: u32) -> PathBuf {
        match &self.run {
            Some((before, digits, after)) => {
                self.path.with_file_name(format!("{before}{number:0digits$}{after}"))
            }
            None => self.path.clone(),
        }
    }

    /// A name with a run in it, for advice.
    #[must_use]
    pub fn suggestion(&self) -> PathBuf {
        let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let (stem, extension) = (part(self.path.file_stem()), part(self.path.extension()));
        self.path.with_file_name(format!("{stem}_####.{extension}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_padded_and_may_be_longer() {
        let file = |path: &str, number| Numbering::of(Path::new(path)).unwrap().path(number);
        assert_eq!(file("out/f_####.png", 7), Path::new("out/f_0007.png"));
        assert_eq!(file("#.exr", 123), Path::new("123.exr"));
        assert_eq!(file("take #2/##.png", 1), Path::new("take #2/01.png"));
        assert_eq!(file("ü###b.png", 12_345), Path::new("ü12345b.png"));
        assert_eq!(file("still.png", 3), Path::new("still.png"));
    }

    #[test]
    fn one_run_is_allowed() {
        let error = Numbering::of(Path::new("#_##.png")).unwrap_err();
        assert!(error.to_string().contains("two places"), "{error}");
        assert!(!Numbering::of(Path::new("a.png")).unwrap().is_numbered());
        let plain = Numbering::of(Path::new("d/a.b.png")).unwrap();
        assert_eq!(plain.suggestion(), Path::new("d/a.b_####.png"));
    }
}
