//! All measures of a pair of maps or pictures.

use serde::{Deserialize, Serialize};

use crate::{
    Map, Measure, edges, errors,
    errors::{psnr_of, root_mean_square},
    flip, flip_rgb, grain, pattern_left, rmse, ssim,
};

/// The measures of an estimate against its reference; those that do not apply are `None`, and left out of files.
///
/// JSON knows no infinity: the PSNR of equal maps is `null` there, and read back as infinite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Measures {
    /// Root mean square error, in the unit of the values; 0 is best.
    pub rmse: f64,
    /// Peak signal-to-noise ratio for a peak of 1, decibel; larger is better. `None` where values have no peak.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "infinite_is_null")]
    pub psnr: Option<f64>,
    /// Mean of estimate minus reference, in the unit of the values; 0 is best.
    pub bias: f64,
    /// Absolute error that 99 % of the values do not exceed; 0 is best.
    pub p99: f64,
    /// Largest absolute error; 0 is best.
    pub max: f64,
    /// Mean FLIP error at 67 pixels a degree, in `[0, 1]`; 0 is best. `None` where values cannot be shown as they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flip: Option<f64>,
    /// Mean structural similarity, at most 1, which is best. `None` as for FLIP, and if a side is below 11 pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ssim: Option<f64>,
    /// Root mean square error at edges of the reference; 0 is best. `None` without edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edge_rmse: Option<f64>,
    /// Root mean square error away from edges of the reference; 0 is best. `None` if all is edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flat_rmse: Option<f64>,
    /// Root mean square error against the filtered reference; 0 is best.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampling_part: Option<f64>,
    /// Root mean square error of the filtered reference; it is the same for every estimate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter_loss: Option<f64>,
    /// Root mean square of the error left by the filter, without its mean over 9 × 9 pixels; 0 is best.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grain: Option<f64>,
    /// Power of the interleaved pattern in the error over that around it, without unit; 0 is best.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pattern_left: Option<f64>,
}

impl Measures {
    /// Measures of an `estimate` of values from 0 to 1, such as openness, which are shown as grey.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn of(estimate: &Map, reference: &Map) -> Self {
        let [estimate, reference] = [estimate, reference].map(std::slice::from_ref);
        Self::of_levels(estimate, reference).seen_as(estimate, reference)
    }

    /// Measures of the `filtered` estimate against the `truth`, with those that tell apart what rays and what the filter
    /// cost; `filtered_truth` is the truth after the same filter.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn of_filtered(filtered: &Map, truth: &Map, filtered_truth: &Map) -> Self {
        Self {
            sampling_part: Some(rmse(filtered, filtered_truth)),
            filter_loss: Some(rmse(filtered_truth, truth)),
            grain: Some(grain(filtered, filtered_truth)),
            pattern_left: Some(pattern_left(filtered, filtered_truth, &edges(truth))),
            ..Self::of(filtered, truth)
        }
    }

    /// Measures of values in any unit, over all channels together.
    ///
    /// # Panics
    /// If the sizes or the numbers of channels differ.
    #[must_use]
    pub fn of_values(estimate: &[Map], reference: &[Map]) -> Self {
        assert_eq!(estimate.len(), reference.len(), "pictures to compare have the same channels");
        let errors = || estimate.iter().zip(reference).flat_map(|(a, b)| a.minus(b));
        let absolute: Vec<f64> = errors().map(f64::abs).collect();
        Self {
            rmse: root_mean_square(errors()),
            bias: errors().sum::<f64>() / absolute.len().max(1) as f64,
            max: absolute.iter().copied().fold(0.0, f64::max),
            p99: errors::quantile(absolute, 0.99),
            ..Self::default()
        }
    }

    /// Measures of values where 0 to 1 is the range to be expected, such as openness and radiance: also PSNR, and the error
    /// at edges and outside. A pixel is at an edge if it is in one of the channels.
    ///
    /// # Panics
    /// If the sizes or the numbers of channels differ.
    #[must_use]
    pub fn of_levels(estimate: &[Map], reference: &[Map]) -> Self {
        let values = Self::of_values(estimate, reference);
        let edges = reference.iter().map(edges).reduce(|a, b| a.iter().zip(&b).map(|(a, b)| a | b).collect());
        let edges = edges.unwrap_or_default();
        let part = |at_edges: bool| {
            let errors = estimate.iter().zip(reference).flat_map(|(a, b)| a.minus(b).zip(&edges));
            let chosen = errors.filter(|&(_, &edge)| edge == at_edges).map(|(error, _)| error);
            edges.contains(&at_edges).then(|| root_mean_square(chosen))
        };
        Self { psnr: Some(psnr_of(values.rmse)), edge_rmse: part(true), flat_rmse: part(false), ..values }
    }

    /// The same with FLIP and SSIM of how estimate and reference are shown: display values in sRGB, one channel of grey or
    /// three of colours. The SSIM of colours is the mean over the channels.
    ///
    /// # Panics
    /// If the sizes differ, or there are neither one nor three channels.
    #[must_use]
    pub fn seen_as(self, estimate: &[Map], reference: &[Map]) -> Self {
        let flip = match (reference, estimate) {
            ([reference], [estimate]) => flip(reference, estimate),
            _ => {
                let rgb =
                    |maps: &[Map]| <[Map; 3]>::try_from(maps.to_vec()).expect("grey or red, green and blue");
                flip_rgb(&rgb(reference), &rgb(estimate))
            }
        };
        let similarities: Option<Vec<f64>> =
            estimate.iter().zip(reference).map(|(a, b)| ssim(a, b)).collect();
        let ssim = similarities.map(|values| values.iter().sum::<f64>() / values.len() as f64);
        Self { flip: Some(flip), ssim, ..self }
    }

    /// The value of `measure`; `None` where it does not apply.
    #[must_use]
    pub const fn get(&self, measure: Measure) -> Option<f64> {
        match measure {
            Measure::Rmse => Some(self.rmse),
            Measure::Psnr => self.psnr,
            Measure::Bias => Some(self.bias),
            Measure::P99 => Some(self.p99),
            Measure::Max => Some(self.max),
            Measure::Flip => self.flip,
            Measure::Ssim => self.ssim,
            Measure::EdgeRmse => self.edge_rmse,
            Measure::FlatRmse => self.flat_rmse,
            Measure::SamplingPart => self.sampling_part,
            Measure::FilterLoss => self.filter_loss,
            Measure::Grain => self.grain,
            Measure::PatternLeft => self.pattern_left,
        }
    }
}

/// A value that is infinite for equal maps, as `null`; `None` is not written at all.
mod infinite_is_null {
    use serde::{Deserialize as _, Deserializer, Serialize as _, Serializer};

    #[expect(clippy::ref_option, reason = "the signature is serde's")]
    pub(super) fn serialize<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        value.filter(|value| value.is_finite()).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
        Ok(Some(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(f: impl Fn(usize) -> f32) -> Map {
        Map { width: 32, values: (0..32 * 24).map(f).collect() }
    }

    #[test]
    fn files_hold_every_measure_under_its_name() {
        let (a, b) = (map(|i| (i % 7) as f32 / 7.0), map(|i| (i % 5) as f32 / 5.0));
        let measures = Measures::of_filtered(&a, &b, &map(|i| (i % 6) as f32 / 6.0));
        let json = serde_json::to_value(measures).unwrap();
        for &measure in Measure::ALL {
            // This reference is full of edges: nothing is flat.
            let expected = measures.get(measure);
            assert_eq!(json.get(measure.name()).and_then(serde_json::Value::as_f64), expected, "{measure}");
            assert_eq!(expected.is_none(), measure == Measure::FlatRmse, "{measure}");
        }
        assert_eq!(json.as_object().unwrap().len(), Measure::ALL.len() - 1);
    }

    #[test]
    fn equal_maps_are_written_and_read_back() {
        let same = map(|i| i as f32 / 1000.0);
        let measures = Measures::of(&same, &same);
        let json = serde_json::to_string(&measures).unwrap();
        assert!(json.contains("\"rmse\":0.0,\"psnr\":null,"), "{json}");
        assert!(!json.contains("grain"), "{json}");
        assert_eq!(serde_json::from_str::<Measures>(&json).unwrap(), measures);
        assert_eq!(measures.psnr, Some(f64::INFINITY));
        let bare = Measures::of_values(std::slice::from_ref(&same), std::slice::from_ref(&same));
        let json = serde_json::to_string(&bare).unwrap();
        assert_eq!(serde_json::from_str::<Measures>(&json).unwrap(), bare, "{json}");
    }

    #[test]
    fn channels_are_measured_together() {
        let zero = map(|_| 0.0);
        let measures = Measures::of_levels(
            &[map(|_| 0.5), zero.clone(), zero.clone()],
            &[zero.clone(), zero.clone(), zero],
        );
        assert!((measures.rmse - (0.25_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((measures.bias - 0.5 / 3.0).abs() < 1e-12);
        assert_eq!((measures.max, measures.edge_rmse), (0.5, None));
        assert_eq!(measures.flat_rmse, Some(measures.rmse));
    }

    #[test]
    fn grey_is_a_colour_with_three_equal_channels() {
        let (a, b) = (map(|i| (i % 7) as f32 / 7.0), map(|i| (i % 5) as f32 / 5.0));
        let grey = Measures::of(&a, &b);
        let [a, b] = [a, b].map(|map| [map.clone(), map.clone(), map]);
        let rgb = Measures::of_levels(&a, &b).seen_as(&a, &b);
        assert_eq!(grey.flip, rgb.flip);
        assert!((grey.ssim.unwrap() - rgb.ssim.unwrap()).abs() < 1e-12);
        assert!((grey.rmse - rgb.rmse).abs() < 1e-12);
    }
}
