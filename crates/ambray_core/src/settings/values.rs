//! Values of settings with their spelling in files and on the command line.

use std::{fmt, str::FromStr};

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A value that could not be read; says what was expected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}")]
pub struct ValueError {
    expected: String,
}

impl ValueError {
    /// What was expected.
    #[must_use]
    pub fn expected(&self) -> &str {
        &self.expected
    }
}

pub(super) fn expected(what: &str) -> ValueError {
    ValueError { expected: what.to_owned() }
}

/// A value, or `auto`: chosen from the scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a value or \"auto\"")]
pub enum Auto<T> {
    /// Chosen from the scene. The word comes first, so that it is not taken for a name.
    #[serde(with = "auto_word")]
    #[default]
    Auto,
    /// The value itself.
    Value(T),
}

mod auto_word {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("auto")
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "auto" => Ok(()),
            other => Err(D::Error::custom(format!("expected a value or \"auto\", found \"{other}\""))),
        }
    }
}

impl<T> Auto<T> {
    /// The value, if one was set.
    #[must_use]
    pub const fn value(&self) -> Option<&T> {
        match self {
            Self::Value(value) => Some(value),
            Self::Auto => None,
        }
    }
}

impl<T: Copy> Auto<T> {
    /// The value, or `default` for `auto`.
    #[must_use]
    pub fn unwrap_or(&self, default: T) -> T {
        self.value().copied().unwrap_or(default)
    }
}

impl<T: FromStr> FromStr for Auto<T>
where
    T::Err: fmt::Display,
{
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        text.parse().map(Self::Value).map_err(|error: T::Err| expected(&format!("auto or a value ({error})")))
    }
}

impl<T: fmt::Display> fmt::Display for Auto<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value(value) => value.fmt(f),
            Self::Auto => f.write_str("auto"),
        }
    }
}

/// Width and height in pixels, written `640x360`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Size {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl FromStr for Size {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        let error = || expected("WIDTHxHEIGHT, such as 640x360");
        let (width, height) = text.split_once('x').ok_or_else(error)?;
        Ok(Self { width: width.parse().map_err(|_| error())?, height: height.parse().map_err(|_| error())? })
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

impl TryFrom<String> for Size {
    type Error = ValueError;

    fn try_from(text: String) -> Result<Self, ValueError> {
        text.parse()
    }
}

impl From<Size> for String {
    fn from(size: Size) -> Self {
        size.to_string()
    }
}

/// Linear RGB, written `0.6,0.7,0.9` (or `0.7` for grey) on the command line and `[0.6, 0.7, 0.9]` in files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Rgb(pub [f32; 3]);

/// A point or a direction in the world, written `1,2,3` on the command line and `[1, 2, 3]` in files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Triple(pub [f32; 3]);

/// The two ends of a range of values, written `0,2.5` on the command line and `[0, 2.5]` in files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Range(pub [f32; 2]);

fn numbers(text: &str) -> Option<Vec<f32>> {
    text.split(',').map(|part| part.trim().parse().ok()).collect()
}

impl FromStr for Rgb {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        match numbers(text).as_deref() {
            Some(&[grey]) => Ok(Self([grey; 3])),
            Some(&[r, g, b]) => Ok(Self([r, g, b])),
            _ => Err(expected("R,G,B in linear light, such as 0.6,0.7,0.9, or one number for grey")),
        }
    }
}

impl FromStr for Triple {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        match numbers(text).as_deref() {
            Some(&[x, y, z]) => Ok(Self([x, y, z])),
            _ => Err(expected("X,Y,Z, such as 0,1.6,-3")),
        }
    }
}

impl FromStr for Range {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        match numbers(text).as_deref() {
            Some(&[low, high]) => Ok(Self([low, high])),
            _ => Err(expected("LOW,HIGH, such as 0,2.5")),
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.0[0], self.0[1])
    }
}

macro_rules! three_numbers {
    ($($name:ident)*) => { $(
        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{},{},{}", self.0[0], self.0[1], self.0[2])
            }
        }
        impl From<Vec3> for $name {
            fn from(v: Vec3) -> Self {
                Self(v.to_array())
            }
        }
        impl From<$name> for Vec3 {
            fn from(v: $name) -> Self {
                Self::from_array(v.0)
            }
        }
    )* };
}
three_numbers!(Rgb Triple);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_as_they_are_written() {
        assert_eq!("640x360".parse(), Ok(Size { width: 640, height: 360 }));
        assert_eq!("-9,1.6,-.3".parse(), Ok(Triple([-9.0, 1.6, -0.3])));
        assert_eq!("0.5".parse(), Ok(Rgb([0.5; 3])));
        assert_eq!("auto".parse::<Auto<f32>>(), Ok(Auto::Auto));
        assert_eq!("2".parse::<Auto<f32>>(), Ok(Auto::Value(2.0)));
        assert_eq!("auto".parse::<Auto<String>>(), Ok(Auto::Auto));
        assert_eq!("nave".parse(), Ok(Auto::Value("nave".to_owned())));
        for size in ["640", "640x", "x", "-1x4", "640x360x1", "4294967296x1"] {
            assert!(size.parse::<Size>().is_err(), "{size}");
        }
        assert_eq!("-1,2.5".parse(), Ok(Range([-1.0, 2.5])));
        assert_eq!(Range([-1.0, 2.5]).to_string(), "-1,2.5");
        assert!("1".parse::<Range>().is_err() && "1,2,3".parse::<Range>().is_err());
        assert!("1,2".parse::<Triple>().is_err());
        assert!("red".parse::<Rgb>().is_err());
    }
}
