//! The text of an OBJ file to meshes.

use std::collections::HashMap;
use std::str::SplitAsciiWhitespace;

use glam::{Vec2, Vec3, Vec4};

use crate::Mesh;
use crate::error::{Fault, Outcome, quoted};
use crate::warnings::Warnings;

/// What an OBJ file holds.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    /// Meshes with the names of their materials, in file order.
    pub(super) meshes: Vec<(Mesh, Option<String>)>,
    /// Material libraries, each once.
    pub(super) libraries: Vec<String>,
}

/// Parses the text; errors name the line.
pub(super) fn parse(text: &str, warnings: &mut Warnings) -> Outcome<Parsed> {
    let mut parser = Parser::default();
    for (number, line) in logical_lines(text) {
        parser.line(&line, warnings).map_err(|reason| Fault::syntax(format!("line {number}"), reason))?;
    }
    parser.finish_mesh();
    Ok(parser.parsed)
}

/// Lines with their numbers, those that end in a backslash joined to the next.
pub(super) fn logical_lines(text: &str) -> impl Iterator<Item = (usize, String)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (number, first) = lines.next()?;
        let mut line = first.to_owned();
        while line.ends_with('\\') {
            line.pop();
            line.push(' ');
            match lines.next() {
                Some((_, more)) => line.push_str(more),
                None => break,
            }
        }
        Some((number + 1, line))
    })
}

/// Material libraries of a file; each may cost a warning.
const MOST_LIBRARIES: usize = 64;

/// Position, texture coordinate and normal of a face's corner.
type Corner = (u32, Option<u32>, Option<u32>);

#[derive(Debug, Default)]
struct Parser {
    positions: Vec<Vec3>,
    /// Empty until the first coloured vertex.
    colors: Vec<Vec4>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// The mesh being filled, and its vertex for each corner.
    mesh: Mesh,
    vertices: HashMap<Corner, u32>,
    has_uvs: bool,
    has_normals: bool,
    name: String,
    material: Option<String>,
    parsed: Parsed,
}

impl Parser {
    fn line(&mut self, line: &str, warnings: &mut Warnings) -> Result<(), String> {
        let line = line.split(" #").next().unwrap_or_default().trim(); // a `#` within a word belongs to a name
        let (keyword, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((line, ""));
        let rest = rest.trim();
        match keyword {
            "v" => self.vertex(rest)?,
            "vt" => {
                let [u, v] = numbers(&mut rest.split_ascii_whitespace(), 1)?;
                self.uvs.push(Vec2::new(u, 1.0 - v)); // OBJ counts v from the bottom
            }
            "vn" => self.normals.push(numbers(&mut rest.split_ascii_whitespace(), 3).map(Vec3::from_array)?),
            "f" => self.face(rest, warnings)?,
            "o" | "g" => {
                self.finish_mesh();
                rest.clone_into(&mut self.name);
            }
            "usemtl" => {
                self.finish_mesh();
                self.material = Some(rest.to_owned());
            }
            "mtllib" if !self.parsed.libraries.iter().any(|known| known == rest) => {
                if self.parsed.libraries.len() == MOST_LIBRARIES {
                    warnings.tally("material libraries beyond the first 64 are ignored", 1);
                } else {
                    self.parsed.libraries.push(rest.to_owned());
                }
            }
            "p" | "l" => warnings.tally("points and lines are skipped", 1),
            _ => {} // comments, smoothing groups and what we do not know
        }
        Ok(())
    }

    /// `x y z`, and optionally `w` or `r g b`.
    fn vertex(&mut self, rest: &str) -> Result<(), String> {
        let mut words = rest.split_ascii_whitespace();
        self.positions.push(numbers(&mut words, 3).map(Vec3::from_array)?);
        let colored = words.clone().count() >= 3;
        if colored && self.colors.is_empty() {
            self.colors = vec![Vec4::ONE; self.positions.len() - 1];
        }
        if colored {
            self.colors.push(numbers(&mut words, 3).map(Vec3::from_array)?.extend(1.0));
        } else if !self.colors.is_empty() {
            self.colors.push(Vec4::ONE);
        }
        Ok(())
    }

    fn face(&mut self, rest: &str, warnings: &mut Warnings) -> Result<(), String> {
        let corners: Result<Vec<u32>, String> =
            rest.split_ascii_whitespace().map(|word| self.corner(word)).collect();
        let corners = corners?;
        if corners.len() < 3 {
            warnings.tally("faces of fewer than three corners are skipped", 1);
        }
        let fan = corners.windows(2).skip(1).map(|edge| [corners[0], edge[0], edge[1]]);
        self.mesh.triangles.extend(fan);
        Ok(())
    }

    /// Vertex of the current mesh for `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, word: &str) -> Result<u32, String> {
        let mut parts = word.split('/');
        let position = index(parts.next().unwrap_or_default(), self.positions.len(), "vertex")?
            .ok_or_else(|| format!("corner {} without a vertex", quoted(word)))?;
        let uv = index(parts.next().unwrap_or_default(), self.uvs.len(), "texture coordinate")?;
        let normal = index(parts.next().unwrap_or_default(), self.normals.len(), "normal")?;
        let corner = (position, uv, normal);
        if let Some(&vertex) = self.vertices.get(&corner) {
            return Ok(vertex);
        }
        let mesh = &mut self.mesh;
        let vertex = u32::try_from(mesh.positions.len()).map_err(|_| "more than 2³² vertices")?;
        mesh.positions.push(self.positions[position as usize]);
        if let Some(color) = self.colors.get(position as usize) {
            // Vertices before the first coloured one are white.
            mesh.colors.resize(vertex as usize, Vec4::ONE);
            mesh.colors.push(*color);
        }
        if mesh.uvs.is_empty() {
            mesh.uvs.push(Vec::new());
        }
        mesh.uvs[0].push(uv.map_or(Vec2::ZERO, |uv| self.uvs[uv as usize]));
        // Corners without a normal among others that have one are repaired from their faces.
        mesh.normals.push(normal.map_or(Vec3::ZERO, |normal| self.normals[normal as usize]));
        self.has_uvs |= uv.is_some();
        self.has_normals |= normal.is_some();
        self.vertices.insert(corner, vertex);
        Ok(vertex)
    }

    fn finish_mesh(&mut self) {
        let mut mesh = std::mem::take(&mut self.mesh);
        self.vertices.clear();
        let (has_uvs, has_normals) =
            (std::mem::take(&mut self.has_uvs), std::mem::take(&mut self.has_normals));
        if mesh.triangles.is_empty() {
            return;
        }
        mesh.name.clone_from(&self.name);
        if !has_uvs {
            mesh.uvs.clear();
        }
        if !has_normals {
            mesh.normals.clear();
        }
        if !mesh.colors.is_empty() {
            mesh.colors.resize(mesh.positions.len(), Vec4::ONE);
        }
        self.parsed.meshes.push((mesh, self.material.clone()));
    }
}

/// The next numbers, at least `least` of them, missing ones 0.
pub(super) fn numbers<const N: usize>(
    words: &mut SplitAsciiWhitespace<'_>,
    least: usize,
) -> Result<[f32; N], String> {
    let mut numbers = [0.0; N];
    for (i, number) in numbers.iter_mut().enumerate() {
        match words.next() {
            Some(word) => *number = word.parse().map_err(|_| format!("{} is not a number", quoted(word)))?,
            None if i >= least => break,
            None => return Err(format!("{i} numbers where {least} are needed")),
        }
    }
    Ok(numbers)
}

/// Index into a list of `count` things: from 1, or from its end if negative; empty for none.
fn index(text: &str, count: usize, what: &str) -> Result<Option<u32>, String> {
    if text.is_empty() {
        return Ok(None);
    }
    let number: i64 = text.parse().map_err(|_| format!("{} is not an index", quoted(text)))?;
    let from_zero = if number < 0 { count as i64 + number } else { number - 1 };
    if from_zero < 0 || from_zero >= count as i64 {
        return Err(format!("{what} {number} of {count}"));
    }
    u32::try_from(from_zero).map(Some).map_err(|_| format!("{what} {number} is beyond 2³²"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse_ok(text: &str) -> Parsed {
        parse(text, &mut Warnings::default()).expect("well-formed")
    }

    #[track_caller]
    fn check_error(text: &str, expected: &str) {
        let fault = parse(text, &mut Warnings::default()).expect_err("must be refused");
        assert_eq!(fault.in_file(std::path::Path::new("x.obj")).to_string(), format!("x.obj: {expected}"));
    }

    #[test]
    fn polygons_shared_corners_and_relative_indices() {
        let parsed = parse_ok("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf -4 -2 \\\n -1 # fan\n");
        assert_eq!(parsed.meshes.len(), 1);
        let mesh = &parsed.meshes[0].0;
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
        assert!(mesh.normals.is_empty() && mesh.uvs.is_empty() && mesh.colors.is_empty());
    }

    #[test]
    fn attributes_and_groups() {
        let parsed = parse_ok(
            "v 0 0 0\nv 1 0 0 0.5 0.25 0\nv 0 1 0\nvt 0.25 0.25\nvn 0 0 1\n\
             o one\nf 1/1/1 2/1/1 3//1\ng two\nusemtl red\nf 1 2 3\n",
        );
        let (one, two) = (&parsed.meshes[0], &parsed.meshes[1]);
        assert_eq!((one.0.name.as_str(), two.0.name.as_str()), ("one", "two"));
        assert_eq!((&one.1, two.1.as_deref()), (&None, Some("red")));
        assert_eq!(one.0.uvs[0], [Vec2::new(0.25, 0.75), Vec2::new(0.25, 0.75), Vec2::ZERO]);
        assert_eq!(one.0.normals, [Vec3::Z; 3]);
        assert_eq!(one.0.colors[1], Vec4::new(0.5, 0.25, 0.0, 1.0));
        assert!(two.0.normals.is_empty());
        one.0.validate().and(two.0.validate()).expect("valid meshes");
    }

    #[test]
    fn errors_name_the_line() {
        check_error("v 0 0\n", "line 1: 2 numbers where 3 are needed");
        check_error("v 0 0 0\nv 0 a 0\n", "line 2: 'a' is not a number");
        check_error("v 0 0 0\nf 1 2 3\n", "line 2: vertex 2 of 1");
        check_error("v 0 0 0\nf 1/1 1 1\n", "line 2: texture coordinate 1 of 0");
        check_error("v 0 0 0\nf 0 1 1\n", "line 2: vertex 0 of 1");
        check_error("v 0 0 0\nf -9223372036854775808 1 1\n", "line 2: vertex -9223372036854775808 of 1");
        check_error("v 0 0 0\nf x 1 1\n", "line 2: 'x' is not an index");
        check_error("v 0 0 0\nf /1 1 1\n", "line 2: corner '/1' without a vertex");
    }
}
