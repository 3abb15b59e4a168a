//! Pictures of the window, compared.

use std::{fs::File, io::BufReader, path::Path};

/// Pixels with red, green and blue.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Picture {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) rgb: Vec<[u8; 3]>,
}

impl Picture {
    #[track_caller]
    pub(crate) fn read(path: &Path) -> Self {
        let file =
            BufReader::new(File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
        let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
        let info = reader.next_frame(&mut bytes).expect("pixels");
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        let rgb = bytes.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Self { width: info.width as usize, height: info.height as usize, rgb }
    }

    pub(crate) fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.rgb[y * self.width + x]
    }

    /// Where `part` lies in this picture: the place of its top left corner, if all of it is there within `tolerance`.
    pub(crate) fn find(&self, part: &Self, tolerance: Tolerance) -> Option<(usize, usize)> {
        // A few pixels decide about most places at once.
        let probe: Vec<(usize, usize)> =
            (0..256).map(|i| ((i * 7919) % part.width, (i * 104_729) % part.height)).collect();
        let may_fit = |(x, y): (usize, usize)| {
            let off =
                |&&(px, py): &&(usize, usize)| tolerance.is_off(self.at(x + px, y + py), part.at(px, py));
            // One of them may be an outlier where there may be some.
            probe.iter().filter(off).nth(if tolerance.outliers > 0.0 { 8 } else { 0 }).is_none()
        };
        let rows = 0..=self.height.checked_sub(part.height)?;
        let columns = 0..=self.width.checked_sub(part.width)?;
        let mut places = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        places.find(|&at| may_fit(at) && self.part(at, part.width, part.height).is_like(part, tolerance))
    }

    /// The part at `(x, y)`.
    pub(crate) fn part(&self, (x, y): (usize, usize), width: usize, height: usize) -> Self {
        let rgb = (y..y + height).flat_map(|row| (x..x + width).map(move |column| self.at(column, row)));
        Self { width, height, rgb: rgb.collect() }
    }

    /// The same with `factor` pixels for each, on both sides.
    pub(crate) fn magnified(&self, factor: usize) -> Self {
        let (width, height) = (factor * self.width, factor * self.height);
        let rgb = (0..height).flat_map(|y| (0..width).map(move |x| self.at(x / factor, y / factor)));
        Self { width, height, rgb: rgb.collect() }
    }

    /// Whether all pixels are those of `other`, but for what the tolerance allows.
    pub(crate) fn is_like(&self, other: &Self, tolerance: Tolerance) -> bool {
        assert_eq!((self.width, self.height), (other.width, other.height));
        let off = self.rgb.iter().zip(&other.rgb).filter(|(a, b)| tolerance.is_off(**a, **b)).count();
        off as f64 <= tolerance.outliers * self.rgb.len() as f64
    }

    /// The columns in which it differs from `other`.
    pub(crate) fn differing_columns(&self, other: &Self) -> Vec<usize> {
        let differs = |&x: &usize| (0..self.height).any(|y| self.at(x, y) != other.at(x, y));
        (0..self.width).filter(differs).collect()
    }

    /// How many different colours there are.
    pub(crate) fn colours(&self) -> usize {
        self.rgb.iter().collect::<std::collections::HashSet<_>>().len()
    }
}

/// How far pixels may be apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tolerance {
    /// By how much a byte may differ.
    bytes: u8,
    /// Share of the pixels that may differ by more.
    outliers: f64,
}

impl Tolerance {
    /// Every byte is the same.
    pub(crate) const NONE: Self = Self { bytes: 0, outliers: 0.0 };
    /// What the backends promise each other: 10⁻³ but for a pixel in a thousand. Near black, where display values are steepest,
    /// 10⁻³ are 12.92 · 255 · 10⁻³ bytes.
    pub(crate) const PARITY: Self = Self { bytes: 4, outliers: 1e-3 };

    fn is_off(self, a: [u8; 3], b: [u8; 3]) -> bool {
        a.iter().zip(b).any(|(&a, b)| a.abs_diff(b) > self.bytes)
    }
}
