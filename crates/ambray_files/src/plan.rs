//! Pictures out: which files, in which format, with which planes.

use std::{
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::SystemTime,
};

use ambray::{Aov, Frame, display, settings::Settings};
use anyhow::{anyhow, bail};

use crate::{
    Format,
    atomic::{Batch, Target},
    exr,
    head::{Head, SCENE_KEYWORD, SOFTWARE},
    interruption,
    png::{self, Bits},
    problem::with_hint,
    settings_file, whole,
};

/// Which files a frame becomes. Made before the frame, so that what cannot be written is refused early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The picture, in OpenEXR with all planes.
    pub main: Target,
    /// Format of all files.
    pub format: Format,
    /// Planes besides the picture.
    pub planes: Vec<Aov>,
}

impl Plan {
    /// Decides the format by option and extension; without an output, the file has the stem `default`.
    pub fn new(
        output: Option<&Path>,
        default: &str,
        format: Option<Format>,
        planes: &[Aov],
    ) -> anyhow::Result<Self> {
        let default = Path::new(default).with_extension(format.unwrap_or(Format::Png8).extension());
        let main = Target::of(output.unwrap_or(&default));
        if let Target::File(path) = &main
            && path.is_dir()
        {
            let inside = path.join(&default);
            let folder = anyhow!("output {}: is a folder, not a file", path.display());
            return Err(with_hint(folder, format!("to write into it: -o {}", inside.display())));
        }
        let plan = Self { format: decide_format(&main, format)?, planes: distinct(planes), main };
        if plan.main == Target::Stdout && plan.format != Format::Exr && !plan.planes.is_empty() {
            return Err(with_hint(
                anyhow!("--aov with -o -: PNG needs a file for each plane, and stdout is one"),
                "--format exr puts all planes into one file",
            ));
        }
        Ok(plan)
    }

    /// Checks that the files can be written.
    pub fn check(&self) -> anyhow::Result<()> {
        self.main.check_binary()?;
        self.files().iter().try_for_each(|(target, _)| target.check())
    }

    /// The same with the picture at `path`.
    #[must_use]
    pub fn at(&self, path: PathBuf) -> Self {
        Self { main: Target::File(path), ..self.clone() }
    }

    /// The files with their planes.
    #[must_use]
    pub fn files(&self) -> Vec<(Target, Aov)> {
        let mut files = vec![(self.main.clone(), Aov::Beauty)];
        if let (Target::File(path), true) = (&self.main, self.format != Format::Exr) {
            files.extend(self.planes.iter().map(|&aov| (Target::File(plane_path(path, aov)), aov)));
        }
        files
    }

    /// Memory that writing takes at most, bytes a pixel.
    #[must_use]
    pub fn bytes_per_pixel(&self) -> u64 {
        let channels: usize = self.planes.iter().map(|aov| aov.channels().len()).sum();
        // OpenEXR holds every plane twice, as values and as channels; PNG one plane at a time, with its display values.
        if self.format == Format::Exr { 8 * (3 + channels as u64) } else { 32 }
    }

    /// Whether all files are there already, made by this version with these settings of this `scene`, and not before
    /// `since`.
    #[must_use]
    pub fn is_made(&self, settings: &Settings, scene: &str, since: Option<SystemTime>) -> bool {
        let toml = settings_file::write(settings);
        self.files().iter().all(|(target, _)| match target {
            Target::Stdout => false,
            Target::File(path) => {
                let written = path.metadata().and_then(|metadata| metadata.modified()).ok();
                let is_fresh = since.is_none() || written >= since;
                is_fresh && is_made(path, &self.planes, self.format, &toml, scene)
            }
        })
    }

    /// Writes the plane `aov` of `frame` alone to `batch`, as PNG in the place of the picture.
    pub fn write_plane(
        &self,
        frame: &Frame,
        aov: Aov,
        settings: &Settings,
        scene: &str,
        batch: &mut Batch,
    ) -> anyhow::Result<()> {
        let toml = settings_file::write(settings);
        let bits = if self.format == Format::Png16 { Bits::Sixteen } else { Bits::Eight };
        let picture = display::show(frame, aov, settings);
        let size = (frame.width, frame.height);
        batch.add(&self.main, |out| png::write(out, size, &picture, bits, &texts(scene, &toml)))
    }

    /// Writes the files of `frame` to `batch`; the flag `cancel` ends it between two files.
    pub fn write(
        &self,
        frame: &Frame,
        settings: &Settings,
        scene: &str,
        batch: &mut Batch,
        cancel: &AtomicBool,
    ) -> anyhow::Result<()> {
        let toml = settings_file::write(settings);
        let bits = match self.format {
            Format::Exr => {
                return batch.add(&self.main, |out| exr::write(out, frame, &self.planes, &toml, scene));
            }
            Format::Png8 => Bits::Eight,
            Format::Png16 => Bits::Sixteen,
        };
        let texts = texts(scene, &toml);
        for (target, aov) in self.files() {
            let picture = display::show(frame, aov, settings);
            let size = (frame.width, frame.height);
            batch.add(&target, |out| png::write(out, size, &picture, bits, &texts))?;
            interruption::check(cancel)?;
        }
        Ok(())
    }
}

/// What a PNG says of itself: keywords and texts.
const fn texts<'a>(scene: &'a str, settings: &'a str) -> [(&'static str, &'a str); 3] {
    [("Software", SOFTWARE), (SCENE_KEYWORD, scene), (settings_file::PNG_KEYWORD, settings)]
}

/// Whether the file at `path` is what [`Plan::write`] would write, as far as its head and its end tell.
fn is_made(path: &Path, planes: &[Aov], format: Format, settings: &str, scene: &str) -> bool {
    let Ok(Some(head)) = Head::read(path) else { return false };
    let channels = if format == Format::Exr { exr::channel_names(planes) } else { Vec::new() };
    let expected = Head {
        format,
        software: Some(SOFTWARE.to_owned()),
        scene: Some(scene.to_owned()),
        settings: Some(settings.to_owned()),
        channels,
    };
    head == expected && whole::is_whole(path, format)
}

fn decide_format(target: &Target, format: Option<Format>) -> anyhow::Result<Format> {
    let Target::File(path) = target else { return Ok(format.unwrap_or(Format::Png8)) };
    let extension = path.extension().map(|ext| ext.to_string_lossy().to_ascii_lowercase());
    match (extension.as_deref(), format) {
        (Some(known @ ("png" | "exr")), Some(format)) if known != format.extension() => {
            bail!(
                "--format {} is not allowed with output {}: the formats differ",
                format.name(),
                path.display()
            )
        }
        (_, Some(format)) => Ok(format),
        (Some("png"), None) => Ok(Format::Png8),
        (Some("exr"), None) => Ok(Format::Exr),
        (_, None) => Err(with_hint(
            anyhow!(
                "output {}: the extension says no format; allowed are .png and .exr, .gif, .mp4, .webm and .webp",
                path.display()
            ),
            "or choose a format with --format png8, png16 or exr",
        )),
    }
}

/// The planes of the list besides the picture itself, each once.
fn distinct(planes: &[Aov]) -> Vec<Aov> {
    Aov::ALL.iter().copied().filter(|aov| *aov != Aov::Beauty && planes.contains(aov)).collect()
}

/// `dir/out.png` becomes `dir/out.depth.png`.
fn plane_path(path: &Path, aov: Aov) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!(".{aov}.png"));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(path: &str, format: Option<Format>, expected: Result<Format, &str>) {
        match (decide_format(&Target::of(Path::new(path)), format), expected) {
            (Ok(actual), Ok(expected)) => assert_eq!(actual, expected, "{path}"),
            (Err(error), Err(part)) => assert!(format!("{error:#}").contains(part), "{path}: {error:#}"),
            (actual, expected) => panic!("{path}: {actual:?} is not {expected:?}"),
        }
    }

    #[test]
    fn format_follows_option_and_extension() {
        check("a.png", None, Ok(Format::Png8));
        check("a.EXR", None, Ok(Format::Exr));
        check("a.png", Some(Format::Png16), Ok(Format::Png16));
        check("a", Some(Format::Exr), Ok(Format::Exr));
        check("-", None, Ok(Format::Png8));
        check("a.png", Some(Format::Exr), Err("the formats differ"));
        check("a.exr", Some(Format::Png8), Err("the formats differ"));
        check("a.jpg", None, Err("allowed are .png and .exr"));
        check("a", None, Err("allowed are .png and .exr"));
    }

    #[test]
    fn planes_are_listed_once_and_without_the_picture() {
        assert_eq!(distinct(&[Aov::Depth, Aov::Beauty, Aov::Depth]), [Aov::Depth]);
        assert_eq!(distinct(Aov::ALL).len(), Aov::ALL.len() - 1);
        assert_eq!(plane_path(Path::new("d/a.b.png"), Aov::Depth), Path::new("d/a.b.depth.png"));
    }
}
