//! The filters that SSAO and HBAO are usually shown with: a plain mean, and one that stops at edges of depth.

use ambray_core::control::{Cancelled, Control};

use crate::Screen;

/// Mean over the 4 × 4 pixels from −2 to +1 (Chapman 2013): one period of the random tile. It does not look at depth, so
/// darkness bleeds over edges; the picture goes on as its border.
pub(crate) fn box_blur(
    screen: &Screen,
    values: &[f32],
    control: &Control<'_>,
) -> Result<Vec<f32>, Cancelled> {
    let (width, height) = screen.size();
    let inside = |at: usize, offset: isize, end: usize| at.saturating_add_signed(offset).min(end - 1);
    screen.map(control, |x, y| {
        let rows = (-2..2).map(|dy| &values[inside(y, dy, height) * width..][..width]);
        rows.map(|row| (-2..2).map(|dx| row[inside(x, dx, width)]).sum::<f32>()).sum::<f32>() / 16.0
    })
}

/// Gaussian over the picture that stops at edges of depth, first along rows, then along columns: the cross-bilateral filter
/// of NVIDIA's samples of HBAO (`hbao_blur.frag.glsl` of nvpro-samples/gl_ssao).
#[derive(Clone, Copy, Debug)]
pub(crate) struct CrossBilateral {
    /// Pixels to each side; the deviation σ of the Gaussian is half of it.
    pub(crate) radius: usize,
    /// Sharpness s, per scene unit: a tap that is Δz deeper counts 2^−(s Δz)² as much.
    pub(crate) sharpness: f32,
}

impl CrossBilateral {
    pub(crate) fn apply(
        &self,
        screen: &Screen,
        values: &[f32],
        control: &Control<'_>,
    ) -> Result<Vec<f32>, Cancelled> {
        let (width, height) = screen.size();
        // As in the sample, powers of 2: 2^−r²/2σ².
        let sigma = 0.5 * self.radius as f32;
        let gaussian: Vec<f32> = (0..=self.radius)
            .map(|r| libm::exp2f(-((r * r) as f32) / (2.0 * sigma * sigma).max(f32::MIN_POSITIVE)))
            .collect();
        let rows = screen.map(control, |x, y| {
            self.along(&gaussian, &screen.depths()[y * width..][..width], &values[y * width..][..width], 1, x)
        })?;
        screen.map(control, |x, y| {
            let last = (height - 1) * width + x + 1;
            self.along(&gaussian, &screen.depths()[x..last], &rows[x..last], width, y)
        })
    }

    /// Weighted mean around place `at` of a line whose values lie `stride` apart. Taps outside the picture are skipped.
    fn along(&self, gaussian: &[f32], depths: &[f32], values: &[f32], stride: usize, at: usize) -> f32 {
        let count = values.len().div_ceil(stride);
        let depth = depths[at * stride];
        let (mut sum, mut weight) = (0.0, 0.0);
        for tap in at.saturating_sub(self.radius)..=(at + self.radius).min(count - 1) {
            // Where nothing is seen the depth is infinite and the weight 0.
            let apart = (depths[tap * stride] - depth) * self.sharpness;
            let w = gaussian[tap.abs_diff(at)] * libm::exp2f(-apart * apart);
            sum += w * values[tap * stride];
            weight += w;
        }
        sum / weight
    }
}
