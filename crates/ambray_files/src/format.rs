//! Formats of picture files.

/// Format of a picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Format {
    /// PNG with 8 bits a channel, tone-mapped
    Png8,
    /// PNG with 16 bits a channel, tone-mapped
    Png16,
    /// OpenEXR with 32-bit floats, linear
    Exr,
}

impl Format {
    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Png8 => "png8",
            Self::Png16 => "png16",
            Self::Exr => "exr",
        }
    }

    /// Extension of its files.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Png8 | Self::Png16 => "png",
            Self::Exr => "exr",
        }
    }
}
