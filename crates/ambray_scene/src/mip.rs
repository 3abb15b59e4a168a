//! Mip levels by area averaging.

use crate::srgb::{UNIT, decoded, encode};
use crate::texture::ImageLevel;

/// The level of half the size, rounded down but at least 1; each texel is the mean of the area it covers.
///
/// With `srgb`, colours are averaged in linear light and weighted by alpha, so that what is invisible has no say.
pub(crate) fn half(from: &ImageLevel, srgb: bool) -> ImageLevel {
    let (width, height) = ((from.width / 2).max(1), (from.height / 2).max(1));
    let columns = coverage(from.width, width);
    let rows = coverage(from.height, height);
    let table = if srgb { decoded() } else { &UNIT };
    let mut texels = Vec::with_capacity(width as usize * height as usize);
    for row in &rows {
        for column in &columns {
            texels.push(average(from, row, column, table, srgb));
        }
    }
    ImageLevel { width, height, texels }
}

/// Texels along one axis that lie under a smaller texel, with their shares; these add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cover {
    first: usize,
    /// Half a size rounded down covers at most three texels: 2 + 1/⌊n/2⌋ ≤ 3 of them.
    shares: [f32; 3],
}

fn coverage(from: u32, to: u32) -> Vec<Cover> {
    // In units of 1/to of a texel everything is an integer: the smaller texel i covers [i·from, (i + 1)·from).
    let cover = |i: u64| {
        let (from, to) = (u64::from(from), u64::from(to));
        let (begin, end) = (i * from, (i + 1) * from);
        let first = begin / to;
        let share = |k: u64| {
            let (left, right) = ((first + k) * to, (first + k + 1) * to);
            right.min(end).saturating_sub(left.max(begin)) as f32 / from as f32
        };
        Cover { first: first as usize, shares: [share(0), share(1), share(2)] }
    };
    (0..u64::from(to)).map(cover).collect()
}

fn average(from: &ImageLevel, row: &Cover, column: &Cover, table: &[f32; 256], by_alpha: bool) -> [u8; 4] {
    let (mut plain, mut weighted, mut alpha) = ([0.0_f32; 3], [0.0_f32; 3], 0.0_f32);
    let under = |cover: &Cover| cover.shares.into_iter().enumerate().filter(|(_, share)| *share > 0.0);
    for (j, row_share) in under(row) {
        let line = (row.first + j) * from.width as usize + column.first;
        for (i, column_share) in under(column) {
            let texel = from.texels[line + i];
            let share = row_share * column_share;
            let covered = share * UNIT[usize::from(texel[3])];
            alpha += covered;
            for channel in 0..3 {
                let value = table[usize::from(texel[channel])];
                plain[channel] += share * value;
                weighted[channel] += covered * value;
            }
        }
    }
    let color = if by_alpha && alpha > 0.0 { weighted.map(|sum| sum / alpha) } else { plain };
    let byte = |value: f32| (value * 255.0 + 0.5) as u8;
    let [r, g, b] = if by_alpha { color.map(encode) } else { color.map(byte) };
    [r, g, b, byte(alpha)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(width: u32, height: u32, texels: Vec<[u8; 4]>) -> ImageLevel {
        ImageLevel { width, height, texels }
    }

    #[test]
    fn linear_mean_of_four() {
        let from = level(2, 2, vec![[0, 10, 0, 255], [0, 20, 0, 255], [0, 30, 0, 255], [200, 40, 0, 255]]);
        assert_eq!(half(&from, false), level(1, 1, vec![[50, 25, 0, 255]]));
    }

    #[test]
    fn srgb_is_averaged_in_linear_light() {
        let from = level(2, 1, vec![[0, 0, 0, 255], [255, 255, 255, 255]]);
        assert_eq!(half(&from, true).texels, [[188, 188, 188, 255]]);
    }

    #[test]
    fn invisible_texels_have_no_say() {
        let from = level(2, 1, vec![[0, 255, 0, 0], [255, 0, 0, 255]]);
        assert_eq!(half(&from, true).texels, [[255, 0, 0, 128]]);
        let nothing = level(2, 1, vec![[0, 255, 0, 0], [0, 255, 0, 0]]);
        assert_eq!(half(&nothing, true).texels, [[0, 255, 0, 0]]);
    }

    #[test]
    fn odd_sizes_cover_fractions() {
        // 5 texels under 2: each covers 2½.
        let covers = coverage(5, 2);
        assert_eq!(covers[0], Cover { first: 0, shares: [0.4, 0.4, 0.2] });
        assert_eq!(covers[1], Cover { first: 2, shares: [0.2, 0.4, 0.4] });
        assert_eq!(coverage(3, 1), [Cover { first: 0, shares: [1.0 / 3.0; 3] }]);
        assert_eq!(coverage(1, 1), [Cover { first: 0, shares: [1.0, 0.0, 0.0] }]);
        let from = level(3, 1, vec![[30, 0, 0, 255], [60, 0, 0, 255], [90, 0, 0, 255]]);
        assert_eq!(half(&from, false), level(1, 1, vec![[60, 0, 0, 255]]));
    }
}
