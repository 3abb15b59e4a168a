//! One number a pixel.

/// A map of one value a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Pixels in a row.
    pub width: usize,
    /// Values, row by row from the top.
    pub values: Vec<f32>,
}

impl Map {
    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    /// Mean value.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|&v| f64::from(v)).sum::<f64>() / self.values.len().max(1) as f64
    }

    /// The differences `self - other`, exact but for one rounding to double precision.
    ///
    /// # Panics
    /// If the sizes differ.
    pub(crate) fn minus<'a>(&'a self, other: &'a Self) -> impl ExactSizeIterator<Item = f64> + 'a {
        self.check_size(other);
        self.values.iter().zip(&other.values).map(|(&a, &b)| f64::from(a) - f64::from(b))
    }

    #[track_caller]
    pub(crate) fn check_size(&self, other: &Self) {
        assert_eq!(
            (self.width, self.values.len()),
            (other.width, other.values.len()),
            "maps to compare have one size"
        );
    }
}
