//! What a person sets: plain data with meaning, unit, range and default beside each field.
//!
//! [`Settings`] is complete; a [`SettingsPatch`] holds some of the fields and comes from a preset, a file or the
//! command line. Both are declared once, by the `settings!` table in `table.rs`, which also makes the flags and the
//! [descriptions](Settings::fields) of all fields.

mod choices;
mod domains;
mod field;
mod method;
mod preset;
mod spelling;
mod table;
mod validate;
mod values;

pub use choices::{
    Falloff, FilterTest, Method, NearRadiance, Normals, Preset, RadianceSource, Ramp, Sampling,
    ScreenQuality, Sequence, Temporal, Thin, ThinMinimum, ToneMap, Window,
};
pub use field::{Field, Kind, SetError, Value};
pub use table::{Settings, SettingsPatch};
pub use validate::SettingsError;
pub use values::{Auto, Range, Rgb, Size, Triple, ValueError};

impl Settings {
    /// Whether there is a second batch, and the minimum of both is taken after the filter.
    #[must_use]
    pub fn takes_minimum_after_filter(&self) -> bool {
        self.thin != Thin::Off && self.thin_minimum == ThinMinimum::AfterFilter
    }
}
