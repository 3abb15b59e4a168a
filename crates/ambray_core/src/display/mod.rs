//! How the planes of a frame are shown: in PNG files, videos and windows alike.
//!
//! | kind | shown as |
//! |---|---|
//! | colours | exposure, tone map, sRGB, as the picture; the albedo by sRGB alone |
//! | openness | a shade of the ramp, from 0 to 1 |
//! | depth | the same, from the nearest surface to the farthest; the end of the ramp where nothing is seen |
//! | counts | the same, from 0 to the largest |
//! | position | x, y, z as red, green, blue over the box of what is seen; black where nothing is seen |
//! | normals | (n + 1)/2 as red, green, blue; black where there is none |
//! | indices | a colour of their own each; black where nothing is seen |
//! | motion | to the right and down as red and green about grey, relative to the largest movement |
//!
//! The ramp is [`Settings::ramp`](crate::settings::Settings::ramp), black to white by default;
//! [`Settings::range`](crate::settings::Settings::range) sets the values at its ends.

mod false_colour;
mod picture;
mod scalar;
mod tone_map;

pub use false_colour::show;
pub use picture::Picture;
pub use scalar::{color, ends, shade};
pub use tone_map::{display, encode, neutral};
