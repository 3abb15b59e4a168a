//! Lists of points: CSV or JSON lines in, line by line with bounded memory, results out.

use std::io::{BufRead, Read as _};

use ambray::{QueryPoint, QueryResult};
use anyhow::{Context as _, bail};
use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::args::PointsFormat;

/// Longer lines are refused.
const LONGEST_LINE: u64 = 1 << 16;

/// A point and the line that it stands on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located {
    /// The point.
    pub point: QueryPoint,
    /// Its line, from 1.
    pub line: u64,
}

/// Reads points from a stream.
#[derive(Debug)]
pub struct Reader<R> {
    input: R,
    name: String,
    line: u64,
    bytes: u64,
    format: Option<PointsFormat>,
    columns: Option<Columns>,
}

impl<R: BufRead> Reader<R> {
    /// Reader of `input`, called `name` in errors; the format is found out if it is not given.
    pub fn new(input: R, name: impl Into<String>, format: Option<PointsFormat>) -> Self {
        Self { input, name: name.into(), line: 0, bytes: 0, format, columns: None }
    }

    /// Bytes read so far.
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The name given, for errors.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// At most `most` further points; none at the end. Errors name the file and the line.
    pub fn next_chunk(&mut self, most: usize) -> anyhow::Result<Vec<Located>> {
        let mut points = Vec::new();
        while points.len() < most {
            let Some(text) = self.next_line().with_context(|| self.place())? else { break };
            if let Some(point) = self.parse(&text).with_context(|| self.place())? {
                points.push(Located { point, line: self.line });
            }
        }
        Ok(points)
    }

    fn place(&self) -> String {
        format!("{}:{}", self.name, self.line)
    }

    fn next_line(&mut self) -> anyhow::Result<Option<String>> {
        let mut bytes = Vec::new();
        let count = (&mut self.input).take(LONGEST_LINE).read_until(b'\n', &mut bytes)? as u64;
        if count == 0 {
            return Ok(None);
        }
        self.line += 1;
        self.bytes += count;
        if count == LONGEST_LINE && !bytes.ends_with(b"\n") {
            bail!("longer than {LONGEST_LINE} bytes");
        }
        let text = String::from_utf8(bytes).ok().context("not UTF-8 text")?;
        let text = if self.line == 1 { text.trim_start_matches('\u{feff}') } else { &text };
        Ok(Some(text.trim().to_owned()))
    }

    /// The point of a line; `None` for empty lines, comments and the header.
    fn parse(&mut self, text: &str) -> anyhow::Result<Option<QueryPoint>> {
        if text.is_empty() || text.starts_with('#') {
            return Ok(None);
        }
        let guess = if text.starts_with('{') { PointsFormat::Jsonl } else { PointsFormat::Csv };
        match *self.format.get_or_insert(guess) {
            PointsFormat::Jsonl => parse_json(text).map(Some),
            PointsFormat::Csv => match &self.columns {
                Some(columns) => columns.parse(text).map(Some),
                None => {
                    let (columns, is_header) = Columns::of(text)?;
                    let columns = self.columns.insert(columns);
                    if is_header { Ok(None) } else { columns.parse(text).map(Some) }
                }
            },
        }
    }
}

/// Order of the columns: place of x, y, z, nx, ny, nz and class.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Columns {
    places: [Option<usize>; 7],
    count: usize,
}

const NAMES: [&str; 7] = ["x", "y", "z", "nx", "ny", "nz", "class"];

impl Columns {
    /// Columns by the first line, and whether that line is a header.
    fn of(text: &str) -> anyhow::Result<(Self, bool)> {
        let names: Vec<_> = fields(text).collect();
        let count = names.len();
        if names[0].parse::<f32>().is_ok() {
            if !(6..=7).contains(&count) {
                bail!("{count} columns; expected x,y,z,nx,ny,nz and optionally class");
            }
            let places = std::array::from_fn(|i| (i < count).then_some(i));
            return Ok((Self { places, count }, false));
        }
        let mut places = [None; 7];
        for (place, name) in names.iter().enumerate() {
            let known = NAMES.iter().position(|known| known.eq_ignore_ascii_case(name));
            match known.map(|i| &mut places[i]) {
                Some(free @ None) => *free = Some(place),
                Some(Some(_)) => bail!("column {name} comes twice"),
                None => bail!("column {name:?} is not allowed: expected {}", NAMES.join(",")),
            }
        }
        if let Some(missing) = (0..6).find(|&i| places[i].is_none()) {
            bail!("column {} is missing: expected x,y,z,nx,ny,nz and optionally class", NAMES[missing]);
        }
        Ok((Self { places, count }, true))
    }

    fn parse(&self, text: &str) -> anyhow::Result<QueryPoint> {
        let values: Vec<_> = fields(text).collect();
        if values.len() != self.count {
            bail!("{} columns instead of {}", values.len(), self.count);
        }
        let number = |i: usize| -> anyhow::Result<f32> {
            let value = self.places[i].map_or("", |place| values[place]);
            value.parse().ok().with_context(|| format!("{} {value:?} is not a number", NAMES[i]))
        };
        let position = Vec3::new(number(0)?, number(1)?, number(2)?);
        let normal = Vec3::new(number(3)?, number(4)?, number(5)?);
        let class = match self.places[6].map(|place| values[place]) {
            None => 0,
            Some(value) => value
                .parse()
                .ok()
                .with_context(|| format!("class {value:?} is not allowed: a whole number from 0 to 15"))?,
        };
        checked(QueryPoint { position, normal, class })
    }
}

fn fields(text: &str) -> impl Iterator<Item = &str> {
    text.split(',').map(|field| field.trim().trim_matches('"').trim())
}

fn parse_json(text: &str) -> anyhow::Result<QueryPoint> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Line {
        position: [f32; 3],
        normal: [f32; 3],
        #[serde(default)]
        class: u8,
    }
    let Line { position, normal, class } = serde_json::from_str(text)
        .context("expected {\"position\": [x,y,z], \"normal\": [x,y,z], \"class\": 0 to 15}")?;
    checked(QueryPoint { position: position.into(), normal: normal.into(), class })
}

fn checked(point: QueryPoint) -> anyhow::Result<QueryPoint> {
    if !point.position.is_finite() {
        bail!("position {} is not finite", point.position);
    }
    if point.normal.try_normalize().is_none() {
        bail!("normal {} has no direction: three finite numbers, not all 0, are allowed", point.normal);
    }
    if point.class > 15 {
        bail!("class {} is not allowed: a whole number from 0 to 15", point.class);
    }
    Ok(point)
}

/// Header of the results in CSV.
pub const RESULT_HEADER: &str = "x,y,z,nx,ny,nz,class,openness,near_r,near_g,near_b,bent_x,bent_y,bent_z,\
first_batch,second_batch,ambient_rays,ambient_hits,chord_rays,chord_hits,shadow_rays\n";

/// Appends a result as a line of CSV; numbers are written so that they read back exactly.
pub fn push_csv(text: &mut String, point: &QueryPoint, result: &QueryResult) {
    use std::fmt::Write as _;
    let vector = |v: Vec3| format!("{},{},{}", v.x, v.y, v.z);
    let QueryResult { openness, first_batch, second_batch, ambient_rays, ambient_hits, .. } = result;
    let QueryResult { chord_rays, chord_hits, shadow_rays, .. } = result;
    let (position, normal, class) = (vector(point.position), vector(point.normal), point.class);
    let (near, bent) = (vector(result.near_radiance), vector(result.bent_normal));
    let _ = writeln!(
        text,
        "{position},{normal},{class},{openness},{near},{bent},{first_batch},{second_batch},\
         {ambient_rays},{ambient_hits},{chord_rays},{chord_hits},{shadow_rays}"
    ); // writing to a string cannot fail
}

/// Appends a result as a line of JSON.
pub fn push_json(text: &mut String, point: &QueryPoint, result: &QueryResult) -> anyhow::Result<()> {
    #[derive(Serialize)]
    struct Line {
        position: [f32; 3],
        normal: [f32; 3],
        class: u8,
        openness: f32,
        near_radiance: [f32; 3],
        bent_normal: [f32; 3],
        first_batch: f32,
        second_batch: f32,
        ambient_rays: u32,
        ambient_hits: u32,
        chord_rays: u32,
        chord_hits: u32,
        shadow_rays: u32,
    }
    let line = Line {
        position: point.position.to_array(),
        normal: point.normal.to_array(),
        class: point.class,
        openness: result.openness,
        near_radiance: result.near_radiance.to_array(),
        bent_normal: result.bent_normal.to_array(),
        first_batch: result.first_batch,
        second_batch: result.second_batch,
        ambient_rays: result.ambient_rays,
        ambient_hits: result.ambient_hits,
        chord_rays: result.chord_rays,
        chord_hits: result.chord_hits,
        shadow_rays: result.shadow_rays,
    };
    text.push_str(&serde_json::to_string(&line)?);
    text.push('\n');
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: QueryPoint = QueryPoint { position: Vec3::new(1.0, 2.0, 3.0), normal: Vec3::Y, class: 0 };

    fn read(text: &str) -> anyhow::Result<Vec<Located>> {
        Reader::new(text.as_bytes(), "points", None).next_chunk(100)
    }

    #[track_caller]
    fn accepts(text: &str, expected: &[(QueryPoint, u64)]) {
        let points = read(text).unwrap_or_else(|error| panic!("{text:?}: {error:#}"));
        let expected: Vec<_> = expected.iter().map(|&(point, line)| Located { point, line }).collect();
        assert_eq!(points, expected, "{text:?}");
    }

    #[track_caller]
    fn refuses(text: &str, part: &str) {
        let error = format!("{:#}", read(text).expect_err(text));
        assert!(error.starts_with("points:") && error.contains(part), "{text:?}: {error} lacks {part}");
    }

    #[test]
    fn csv_with_and_without_header() {
        accepts("1,2,3,0,1,0", &[(UP, 1)]);
        accepts("# comment\n\n 1, 2 ,3,\"0\",1,0,7\r\n", &[(QueryPoint { class: 7, ..UP }, 3)]);
        accepts("x,y,z,nx,ny,nz\n1,2,3,0,1,0\n", &[(UP, 2)]);
        accepts("\u{feff}nx,ny,nz,class,X,Y,Z\n0,1,0,15,1,2,3", &[(QueryPoint { class: 15, ..UP }, 2)]);
        accepts("", &[]);
        accepts("x,y,z,nx,ny,nz\n", &[]);
    }

    #[test]
    fn json_lines() {
        let line = r#"{"position":[1,2,3],"normal":[0,1.0,0]}"#;
        accepts(&format!("{line}\n\n{line}\n"), &[(UP, 1), (UP, 3)]);
        accepts(r#"{"position":[1,2,3],"normal":[0,1,0],"class":3}"#, &[(QueryPoint { class: 3, ..UP }, 1)]);
    }

    #[test]
    fn bad_lines_are_named() {
        refuses("1,2,3,0,1,0\n1,2,3,0,1", "points:2: 5 columns instead of 6");
        refuses("1,2,3", "points:1: 3 columns");
        refuses("x,y,z,nx,ny,nz\n1,2,here,0,1,0", "points:2: z \"here\" is not a number");
        refuses("x,y,z,nx,ny", "column nz is missing");
        refuses("x,y,z,nx,ny,nz,w", "column \"w\" is not allowed");
        refuses("x,x,y,z,nx,ny,nz", "column x comes twice");
        refuses("1,2,3,0,0,0", "has no direction");
        refuses("inf,2,3,0,1,0", "is not finite");
        refuses("1,2,3,0,1,0,16", "class 16 is not allowed");
        refuses("1,2,3,0,1,0,-1", "class \"-1\" is not allowed");
        refuses("{\"position\":[1,2],\"normal\":[0,1,0]}", "points:1: expected {\"position\"");
        refuses("{\"position\":[1,2,3],\"normal\":[0,1,0],\"klass\":1}", "klass");
        refuses(&"1".repeat(1 << 17), "longer than 65536 bytes");
        let binary = Reader::new(&b"\xff\xfe,\n"[..], "points", None).next_chunk(9);
        assert!(format!("{:#}", binary.unwrap_err()).contains("not UTF-8"));
    }

    #[test]
    fn chunks_follow_each_other() {
        let text = "1,2,3,0,1,0\n".repeat(5);
        let mut reader = Reader::new(text.as_bytes(), "points", None);
        let lengths: Vec<_> = (0..4).map(|_| reader.next_chunk(2).unwrap().len()).collect();
        assert_eq!(lengths, [2, 2, 1, 0]);
        assert_eq!(reader.bytes(), 60);
    }

    #[test]
    fn results_have_the_columns_of_the_header() {
        let mut text = String::new();
        push_csv(&mut text, &UP, &QueryResult { openness: 0.1, ..Default::default() });
        assert_eq!(text.split(',').count(), RESULT_HEADER.split(',').count());
        assert!(text.starts_with("1,2,3,0,1,0,0,0.1,"), "{text}");
        let mut text = String::new();
        push_json(&mut text, &UP, &QueryResult { openness: 0.1, ..Default::default() }).unwrap();
        assert!(text.contains("\"openness\":0.1,"), "{text}");
    }
}
