//! How a plane of a frame is shown.

use super::declare::structures;

structures! {
    /// A plane as a picture (`ambray_core::display`). The [`View`](super::View) is that of the frame.
    Display {
        /// `uint` of each byte of grey: red, green, blue and alpha from the lowest byte. 0 for grey itself.
        ramp: u64,
        /// Box of the values, [`BOX_WORDS`](super::BOX_WORDS) words that are ordered as the numbers are.
        bounds: u64,
        /// `AOV_` constant.
        plane: u32,
        /// `TONE_` constant.
        tone_map: u32,
        /// 2 to the power of the exposure.
        brightness: f32,
        /// 1 where the values at the ends of the ramp are set.
        has_range: u32,
        /// Values at the ends of the ramp.
        range: [f32; 2],
    }
}
