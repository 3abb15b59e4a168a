//! Options of `ambray bench --animate`.

use ambray::scene::animation::UpdatePolicy;
use clap::{Args, ValueEnum};

use super::{Rate, whole};

/// How acceleration structures follow what deforms.
#[derive(Clone, Copy, Debug, Args)]
pub struct UpdatesArgs {
    /// How acceleration structures follow what deforms; pictures do not depend on it [default: auto]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Backend")]
    pub updates: Option<Updates>,
}

/// Value of `--updates`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Updates {
    /// Refit, and rebuild what has become poor
    Auto,
    /// Refit, however poor
    Refit,
    /// Rebuild at every pose
    Rebuild,
    /// Keep structures of several poses, and refit the nearest
    Cache,
}

impl Updates {
    /// All values, the default first.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Refit, Self::Rebuild, Self::Cache];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Refit => "refit",
            Self::Rebuild => "rebuild",
            Self::Cache => "cache",
        }
    }

    /// The policy of the backends.
    #[must_use]
    pub const fn policy(self) -> UpdatePolicy {
        match self {
            Self::Auto => UpdatePolicy::Auto,
            Self::Refit => UpdatePolicy::Refit,
            Self::Rebuild => UpdatePolicy::Rebuild,
            Self::Cache => UpdatePolicy::Cache,
        }
    }
}

/// Measuring scenes that move.
#[derive(Clone, Copy, Debug, Args)]
pub struct AnimateArgs {
    /// Play the animation of each scene, and measure how acceleration structures follow it: all ways of --updates in turn,
    /// or the one that is given; --frames limits the number of poses [default: the whole animation, at most 120]
    #[arg(long)]
    pub animate: bool,
    /// Frames a second of --animate, a number or a fraction such as 30000/1001 [default: 30]
    #[arg(long, value_name = "RATE")]
    pub fps: Option<Rate>,
    /// Frames to trace at each pose of --animate, of which the fastest counts [default: 3, or 1 with --temporal
    /// on, which a second frame of the same pose would not measure]
    #[arg(long, value_name = "N", value_parser = |text: &str| whole::<u32>(text, 1, 1000))]
    pub repeats: Option<u32>,
}

impl AnimateArgs {
    /// The first option that means nothing without `--animate`.
    #[must_use]
    pub fn needs_animate(&self) -> Option<&'static str> {
        self.fps.map(|_| "--fps").or(self.repeats.map(|_| "--repeats"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_command_line() {
        for updates in Updates::ALL {
            assert_eq!(Updates::from_str(updates.name(), false), Ok(updates));
        }
        assert_eq!(Updates::ALL.len(), Updates::value_variants().len());
        assert_eq!(Updates::ALL[0].policy(), UpdatePolicy::default());
    }
}
