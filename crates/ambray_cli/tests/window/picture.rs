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

    /// Where the middle of `part` lies in this picture: the place of its top left corner, within `tolerance`.
    pub(crate) fn find(&self, part: &Self, tolerance: u8) -> Option<(usize, usize)> {
        // The middle is free of labels. A window shows one picture, so the first fit is it.
        let probe: Vec<(usize, usize)> = (0..64)
            .map(|i| {
                (part.width / 4 + (i * 37) % (part.width / 2), part.height / 4 + (i * 53) % (part.height / 2))
            })
            .collect();
        let fits = |x: usize, y: usize| {
            probe.iter().all(|&(px, py)| is_close(self.at(x + px, y + py), part.at(px, py), tolerance))
        };
        let rows = 0..=self.height.checked_sub(part.height)?;
        let columns = 0..=self.width.checked_sub(part.width)?;
        rows.flat_map(|y| columns.clone().map(move |x| (x, y))).find(|&(x, y)| fits(x, y))
    }

    /// How many different colours there are.
    pub(crate) fn colours(&self) -> usize {
        self.rgb.iter().collect::<std::collections::HashSet<_>>().len()
    }
}

pub(crate) fn is_close(a: [u8; 3], b: [u8; 3], tolerance: u8) -> bool {
    a.iter().zip(b).all(|(&a, b)| a.abs_diff(b) <= tolerance)
}

/// Share of the pixels of `part` at `(x, y)` of `whole` that differ by more than `tolerance`: of all, and of the middle, where
/// nothing is drawn over the picture.
pub(crate) fn differing(
    whole: &Picture,
    part: &Picture,
    (x, y): (usize, usize),
    tolerance: u8,
) -> (f64, f64) {
    let is_off = |px: usize, py: usize| !is_close(whole.at(x + px, y + py), part.at(px, py), tolerance);
    let share = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
        let count = (columns.len() * rows.len()) as f64;
        rows.flat_map(|py| columns.clone().map(move |px| (px, py))).filter(|&(px, py)| is_off(px, py)).count()
            as f64
            / count
    };
    let (w, h) = (part.width, part.height);
    (share(0..w, 0..h), share(w / 5..4 * w / 5, h / 5..4 * h / 5))
}
