//! Options of `ambray bench` that are about rays and the kernels that trace them.

use std::path::PathBuf;

use ambray::Isa;
use clap::{Args, ValueEnum};

use super::whole;

/// Rounds unless `--rounds` says otherwise.
const ROUNDS: u32 = 7;
/// Builds of each kind of tree unless `--builds` says otherwise.
const BUILDS: u32 = 3;

/// Measuring rays alone.
#[derive(Clone, Debug, Args)]
pub struct RaysArgs {
    /// Measure the tracer on the rays of a frame. With a SCENE its triangles and rays are written to FOLDER first, in the
    /// format of docs/performance.md; without one those that are there are measured
    #[arg(long, value_name = "FOLDER")]
    pub rays: Option<PathBuf>,
    /// Rounds of --rays, in each of which everything is measured in turn; 0 traces nothing [default: 7]
    #[arg(long, value_name = "N", value_parser = |text: &str| whole::<u32>(text, 0, 10_000))]
    pub rounds: Option<u32>,
    /// How often the trees of --rays are built to measure that, each quality in turn; 0 skips it [default: 3, or 0 with
    /// --rounds 0]
    #[arg(long, value_name = "N", value_parser = |text: &str| whole::<u32>(text, 0, 1000))]
    pub builds: Option<u32>,
    /// Files of --rays to measure, by their names without .rays, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub batches: Vec<String>,
    /// Effort spent on the trees of --rays, several separated by commas: each is measured [default: balanced]
    #[arg(long, value_enum, value_name = "QUALITY", value_delimiter = ',')]
    pub quality: Vec<Quality>,
    /// Triangles of --rays, to write with a SCENE, else only to measure: each is cut in four, the surface staying the same,
    /// until there are so many; of more, the largest are kept. The rays are those of the scene as it is
    #[arg(long, value_name = "N", value_parser = |text: &str| whole::<u64>(text, 1, 1 << 30))]
    pub triangles: Option<u64>,
    /// Write the hits of --rays to this folder, one file for each of rays
    #[arg(long, value_name = "FOLDER")]
    pub write_hits: Option<PathBuf>,
    /// Compare the hits of --rays with those in this folder, such as of another tracer
    #[arg(long, value_name = "FOLDER")]
    pub check_hits: Option<PathBuf>,
}

impl RaysArgs {
    /// Rounds to measure.
    #[must_use]
    pub fn rounds(&self) -> u32 {
        self.rounds.unwrap_or(ROUNDS)
    }

    /// Builds to measure of each kind.
    #[must_use]
    pub fn builds(&self) -> u32 {
        self.builds.unwrap_or(if self.rounds() == 0 { 0 } else { BUILDS })
    }

    /// Trees to measure.
    #[must_use]
    pub fn qualities(&self) -> &[Quality] {
        if self.quality.is_empty() { &[Quality::Balanced] } else { &self.quality }
    }

    /// The first option that means nothing without `--rays`.
    #[must_use]
    pub fn needs_rays(&self) -> Option<&'static str> {
        let given = [
            ("--rounds", self.rounds.is_some()),
            ("--quality", !self.quality.is_empty()),
            ("--builds", self.builds.is_some()),
            ("--batches", !self.batches.is_empty()),
            ("--triangles", self.triangles.is_some()),
            ("--write-hits", self.write_hits.is_some()),
            ("--check-hits", self.check_hits.is_some()),
        ];
        given.into_iter().find_map(|(name, given)| given.then_some(name))
    }
}

/// What the processor traces with, and what.
#[derive(Clone, Debug, Args)]
pub struct KernelArgs {
    /// Instruction set of the processor's kernels; with --rays several, separated by commas [default: the best of this
    /// machine; with --rays all that it has]
    #[arg(long, value_enum, value_name = "ISA", value_delimiter = ',', help_heading = "Backend")]
    pub isa: Vec<Kernels>,
    /// When the processor's rays go in packets; not with --rays, where each way is measured
    #[arg(long, value_enum, value_name = "WHEN", help_heading = "Backend")]
    pub packets: Option<Packets>,
    /// Leave out all surfaces whose materials are masked or blended
    #[arg(long, help_heading = "Backend")]
    pub opaque: bool,
}

/// Value of `--isa`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kernels {
    /// What every processor has
    Portable,
    /// AVX2 with FMA and BMI
    Avx2,
    /// AVX-512 F, VL, DQ and BW
    Avx512,
}

impl Kernels {
    /// What the tracer calls it.
    #[must_use]
    pub const fn isa(self) -> Isa {
        match self {
            Self::Portable => Isa::Portable,
            Self::Avx2 => Isa::Avx2,
            Self::Avx512 => Isa::Avx512,
        }
    }
}

/// Value of `--packets`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Packets {
    /// Where that has turned out to be quicker (the default)
    Measured,
    /// In every batch of rays
    Always,
    /// Each ray goes alone
    Never,
}

impl Packets {
    /// What the tracer calls it.
    #[must_use]
    pub const fn packets(self) -> ambray::Packets {
        match self {
            Self::Measured => ambray::Packets::Measured,
            Self::Always => ambray::Packets::Always,
            Self::Never => ambray::Packets::Never,
        }
    }
}

/// Value of `--quality`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Quality {
    /// Built fast
    FastBuild,
    /// What a renderer takes
    Balanced,
    /// Traced fast
    BestTrace,
}

impl Quality {
    /// All values, fastest build first.
    pub const ALL: [Self; 3] = [Self::FastBuild, Self::Balanced, Self::BestTrace];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::FastBuild => "fast-build",
            Self::Balanced => "balanced",
            Self::BestTrace => "best-trace",
        }
    }

    /// What the tracer calls it.
    #[must_use]
    pub const fn quality(self) -> ambray::Quality {
        match self {
            Self::FastBuild => ambray::Quality::FastBuild,
            Self::Balanced => ambray::Quality::Balanced,
            Self::BestTrace => ambray::Quality::BestTrace,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_of_the_tracer_can_be_named() {
        let isas: Vec<_> = Kernels::value_variants().iter().map(|kernels| kernels.isa()).collect();
        assert_eq!(isas, Isa::ALL);
        for (kernels, isa) in Kernels::value_variants().iter().zip(Isa::ALL) {
            assert_eq!(Kernels::from_str(isa.name(), false), Ok(*kernels));
        }
        let packets: Vec<_> = Packets::value_variants().iter().map(|packets| packets.packets()).collect();
        assert_eq!(packets, ambray::Packets::ALL);
        assert_eq!(Quality::ALL.map(Quality::quality), ambray::Quality::ALL);
        for quality in Quality::ALL {
            assert_eq!(Quality::from_str(quality.name(), false), Ok(quality));
        }
    }
}
