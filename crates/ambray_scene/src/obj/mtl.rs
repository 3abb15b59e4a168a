//! Material libraries of OBJ files.

use std::collections::HashMap;

use glam::{Affine2, Vec3};

use crate::error::{Fault, Outcome, quoted};
use crate::warnings::Warnings;
use crate::{AlphaMode, Material, TextureRef};

use super::parse::{logical_lines, numbers};

/// Materials by name.
#[derive(Debug, Default)]
pub(super) struct Library {
    entries: Vec<Entry>,
    by_name: HashMap<String, u32>,
}

/// A material with the files of its textures.
#[derive(Debug, Default)]
struct Entry {
    material: Material,
    color: Option<String>,
    alpha: Option<String>,
    emission: Option<String>,
    normal: Option<String>,
}

impl Library {
    /// Number of materials.
    pub(super) fn len(&self) -> usize {
        self.entries.len()
    }

    /// Index of the material `name`.
    pub(super) fn index(&self, name: &str) -> Option<u32> {
        self.by_name.get(name).copied()
    }

    /// Adds the materials in the `text` of the library `file`.
    pub(super) fn add(&mut self, file: &str, text: &str, warnings: &mut Warnings) -> Outcome<()> {
        let mut current: Option<usize> = None;
        for (number, line) in logical_lines(text) {
            let line = line.trim();
            let (keyword, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((line, ""));
            let rest = rest.trim();
            if keyword == "newmtl" {
                current = Some(self.entries.len());
                self.by_name.insert(rest.to_owned(), self.entries.len() as u32);
                let material = Material { name: rest.to_owned(), ..Material::default() };
                self.entries.push(Entry { material, ..Entry::default() });
            } else if let Some(entry) = current.map(|index| &mut self.entries[index]) {
                entry
                    .line(keyword, rest, warnings)
                    .map_err(|reason| Fault::syntax(format!("{} line {number}", quoted(file)), reason))?;
            }
        }
        Ok(())
    }

    /// All materials. The files of their textures are appended to `images`, with whether they are sRGB.
    pub(super) fn materials(&self, images: &mut Vec<(String, bool)>) -> Vec<Material> {
        let mut known: HashMap<(String, bool), usize> = HashMap::new();
        let mut texture = |file: &Option<String>, srgb: bool| {
            let key = (file.clone()?, srgb);
            let index = *known.entry(key).or_insert_with_key(|key| {
                images.push(key.clone());
                images.len() - 1
            });
            Some(TextureRef { texture: index as u32, uv_set: 0, transform: Affine2::IDENTITY })
        };
        let mut finish = |entry: &Entry| {
            let mut material = entry.material.clone();
            material.base_color_texture = texture(&entry.color, true);
            material.emission_texture = texture(&entry.emission, true);
            material.normal_texture = texture(&entry.normal, false);
            // The same file as colour and as opacity means: use its alpha channel.
            if entry.alpha.is_some() && entry.alpha == entry.color {
                material.alpha_mode = AlphaMode::Mask(0.5);
            } else if material.base_color.w < 1.0 {
                material.alpha_mode = AlphaMode::Blend;
            }
            material
        };
        self.entries.iter().map(&mut finish).collect()
    }
}

impl Entry {
    fn line(&mut self, keyword: &str, rest: &str, warnings: &mut Warnings) -> Result<(), String> {
        let mut words = rest.split_ascii_whitespace();
        match keyword {
            "Kd" => {
                let alpha = self.material.base_color.w;
                self.material.base_color = color(&mut words, warnings)?.extend(alpha);
            }
            "Ke" => self.material.emission = color(&mut words, warnings)?,
            "d" => self.material.base_color.w = alpha(numbers::<1>(&mut words, 1)?[0]),
            "Tr" => self.material.base_color.w = 1.0 - alpha(numbers::<1>(&mut words, 1)?[0]),
            "map_Kd" => self.color = Some(file_name(rest, warnings)),
            "map_Ke" => self.emission = Some(file_name(rest, warnings)),
            "norm" => self.normal = Some(file_name(rest, warnings)),
            "map_d" => {
                self.alpha = Some(file_name(rest, warnings));
                if self.alpha != self.color {
                    warnings.tally("opacity maps in files of their own may be ignored", 1);
                }
            }
            "map_Bump" | "map_bump" | "bump" => warnings.tally("bump maps are ignored", 1),
            _ => {}
        }
        Ok(())
    }
}

/// `r g b`, or one number for grey; spectral files and CIE colours read as white.
fn color(words: &mut std::str::SplitAsciiWhitespace<'_>, warnings: &mut Warnings) -> Result<Vec3, String> {
    if matches!(words.clone().next(), Some("spectral" | "xyz")) {
        warnings.tally("spectral and CIE colours are read as white", 1);
        return Ok(Vec3::ONE);
    }
    let given = words.clone().count();
    let [r, g, b] = numbers::<3>(words, 1)?;
    let color = if given == 1 { Vec3::splat(r) } else { Vec3::new(r, g, b) };
    if color.is_finite() { Ok(color.max(Vec3::ZERO)) } else { Err("colour is not finite".into()) }
}

/// Opacity in [0, 1]; what is not a number is opaque.
fn alpha(number: f32) -> f32 {
    if number.is_nan() { 1.0 } else { number.clamp(0.0, 1.0) }
}

/// File of a texture map, which may be preceded by options such as `-s 1 1 1`.
fn file_name(rest: &str, warnings: &mut Warnings) -> String {
    let name = if rest.starts_with('-') {
        warnings.tally("options of texture maps are ignored", 1);
        rest.rsplit(|c: char| c.is_ascii_whitespace()).next().unwrap_or_default()
    } else {
        rest
    };
    name.replace('\\', "/") // as exporters on Windows write
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    #[test]
    fn materials_and_their_files() {
        let text = "Kd 9 9 9\nnewmtl a\nKd 1 0.5 0\nKe 2\nd 0.5\nmap_Kd tex\\my colour.png\n\
                    newmtl leaf\nmap_Kd -s 1 1 1 leaf.png\nmap_d leaf.png\nnorm leaf.png\n";
        let (mut library, mut warnings) = (Library::default(), Warnings::default());
        library.add("x.mtl", text, &mut warnings).expect("well-formed");
        let mut images = Vec::new();
        let materials = library.materials(&mut images);
        assert_eq!(materials[0].base_color, Vec4::new(1.0, 0.5, 0.0, 0.5));
        assert_eq!((materials[0].emission, materials[0].alpha_mode), (Vec3::splat(2.0), AlphaMode::Blend));
        assert_eq!(materials[1].alpha_mode, AlphaMode::Mask(0.5));
        let names: Vec<_> = images.iter().map(|(name, srgb)| (name.as_str(), *srgb)).collect();
        assert_eq!(names, [("tex/my colour.png", true), ("leaf.png", true), ("leaf.png", false)]);
        assert_eq!(library.index("leaf"), Some(1));
    }

    #[test]
    fn errors_name_file_and_line() {
        let check = |text: &str, expected: &str| {
            let fault = Library::default().add("x.mtl", text, &mut Warnings::default()).expect_err("wrong");
            assert_eq!(fault.in_file(std::path::Path::new("x.obj")).to_string(), expected);
        };
        check("newmtl a\nKd\n", "x.obj: 'x.mtl' line 2: 0 numbers where 1 are needed");
        check("newmtl a\nKd 1 b 1\n", "x.obj: 'x.mtl' line 2: 'b' is not a number");
        check("newmtl a\nKe inf\n", "x.obj: 'x.mtl' line 2: colour is not finite");
    }
}
