//! The list of measures, from which tables, headings of CSV files and options are made.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

/// Which value of a measure is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Better {
    /// The smaller; 0 is best.
    Smaller,
    /// The larger.
    Larger,
    /// The one nearer to zero.
    NearerZero,
}

macro_rules! measures {
    ($( $variant:ident = $name:literal, $title:literal, $unit:literal, $decimals:literal, $better:ident: $meaning:literal; )+) => {
        /// A measure of error between an estimate and a reference.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum Measure { $( #[doc = $meaning] $variant, )+ }

        impl Measure {
            /// All measures, in the order of tables.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// Name in files and on the command line, as [`Measures`](crate::Measures) are serialised.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// Heading of a column.
            #[must_use]
            pub const fn title(self) -> &'static str {
                match self { $(Self::$variant => $title,)+ }
            }

            /// One sentence: what is measured, and how to read it.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)+ }
            }

            /// Unit, empty where it is that of the values or there is none.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$variant => $unit,)+ }
            }

            /// Decimals that tell something.
            #[must_use]
            pub const fn decimals(self) -> usize {
                match self { $(Self::$variant => $decimals,)+ }
            }

            /// Which value is better.
            #[must_use]
            pub const fn better(self) -> Better {
                match self { $(Self::$variant => Better::$better,)+ }
            }
        }
    };
}

measures! {
    Rmse = "rmse", "RMSE", "", 5, Smaller: "Root mean square error, in the unit of the values.";
    Psnr = "psnr", "PSNR", "dB", 2, Larger: "Peak signal-to-noise ratio for a peak of 1; infinite for equal maps.";
    Bias = "bias", "bias", "", 5, NearerZero: "Mean of estimate minus reference: above 0 where the estimate is too bright on the whole.";
    P99 = "p99", "p99", "", 4, Smaller: "Absolute error that 99 % of the values do not exceed.";
    Max = "max", "max", "", 4, Smaller: "Largest absolute error.";
    Flip = "flip", "FLIP", "", 4, Smaller: "Difference seen when both alternate on a screen of 67 pixels a degree, 0 to 1 (Andersson et al. 2020).";
    Ssim = "ssim", "SSIM", "", 4, Larger: "Structural similarity, at most 1 (Wang et al. 2004).";
    EdgeRmse = "edge-rmse", "edge RMSE", "", 5, Smaller: "Root mean square error at edges of the reference: lost detail.";
    FlatRmse = "flat-rmse", "flat RMSE", "", 5, Smaller: "Root mean square error away from edges of the reference: noise.";
    SamplingPart = "sampling-part", "sampling part", "", 5, Smaller: "Root mean square error against the filtered reference: what the few rays cost, apart from the filter.";
    FilterLoss = "filter-loss", "filter loss", "", 5, Smaller: "Root mean square error of the filtered reference: what the filter costs, however many the rays.";
    Grain = "grain", "grain", "", 5, Smaller: "Root mean square of the error left by the filter, without its mean over 9 × 9 pixels.";
    PatternLeft = "pattern-left", "pattern left", "", 1, Smaller: "Power of the error at the frequencies of the interleaved pattern over that around them; noise gives a few.";
}

impl Measure {
    /// Whether it needs a reference after the filter of the estimate, besides the pair.
    #[must_use]
    pub const fn needs_filter(self) -> bool {
        matches!(self, Self::SamplingPart | Self::FilterLoss | Self::Grain | Self::PatternLeft)
    }

    /// Whether `value` is as good as `tolerance` or better. Nothing is as good as NaN, nor is NaN as good as anything.
    #[must_use]
    pub fn is_within(self, value: f64, tolerance: f64) -> bool {
        match self.better() {
            Better::Smaller => value <= tolerance,
            Better::Larger => value >= tolerance,
            Better::NearerZero => value.abs() <= tolerance,
        }
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Measure {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.iter().copied().find(|measure| measure.name() == name).ok_or_else(|| {
            let names: Vec<_> = Self::ALL.iter().map(|measure| measure.name()).collect();
            format!("expected one of {}", names.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back_and_are_those_of_files() {
        for &measure in Measure::ALL {
            assert_eq!(measure.name().parse(), Ok(measure));
            assert_eq!(serde_json::to_value(measure).unwrap(), measure.name());
            assert!(measure.meaning().ends_with('.'), "{measure}");
        }
        assert!("mse".parse::<Measure>().unwrap_err().contains("rmse, psnr"));
    }

    #[test]
    fn tolerances_look_the_way_of_the_measure() {
        assert!(Measure::Rmse.is_within(0.0, 0.0) && !Measure::Rmse.is_within(0.1, 0.0));
        assert!(Measure::Psnr.is_within(f64::INFINITY, 40.0) && !Measure::Psnr.is_within(39.0, 40.0));
        assert!(Measure::Bias.is_within(-0.1, 0.1) && !Measure::Bias.is_within(-0.2, 0.1));
        assert!(Measure::ALL.iter().all(|measure| !measure.is_within(f64::NAN, 1.0)));
    }
}
