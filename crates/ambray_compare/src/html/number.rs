//! Numbers as words.

/// `value` with so many decimals; a zero has no sign.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    if value.is_nan() {
        return "n/a".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "-∞" }.to_owned();
    }
    let text = format!("{value:.decimals$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// `value` with three significant digits and no trailing zeros, as on an axis.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return fixed(value, 0);
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..=6).contains(&exponent) {
        let text = format!("{value:.2e}");
        let (mantissa, exponent) = text.split_once('e').expect("an exponent was asked for");
        return format!("{}e{exponent}", without_zeros(mantissa));
    }
    without_zeros(&fixed(value, (2 - exponent).max(0) as usize)).to_owned()
}

fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_numbers_have_their_decimals() {
        assert_eq!(fixed(0.0254, 3), "0.025");
        assert_eq!(fixed(-0.0004, 3), "0.000");
        assert_eq!(fixed(-0.5, 1), "-0.5");
        assert_eq!(fixed(f64::INFINITY, 1), "∞");
        assert_eq!(fixed(f64::NAN, 1), "n/a");
    }

    #[test]
    fn short_numbers_have_three_digits_that_count() {
        let cases =
            [(0.0, "0"), (8.0, "8"), (0.025, "0.025"), (1234.0, "1234"), (0.000_01, "1e-5"), (-0.3, "-0.3")];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
        assert_eq!(short(12.345), "12.3");
        assert_eq!(short(2.5e8), "2.5e8");
    }
}
