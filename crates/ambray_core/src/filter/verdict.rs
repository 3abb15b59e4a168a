//! What the filter makes of a neighbour, in words and numbers.

use std::fmt;

/// What the filter makes of a pixel in its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It enters the mean.
    Accepted,
    /// It does not.
    Refused(Refusal),
}

/// Why a pixel of the window does not enter the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The window reaches beyond the picture.
    OutsidePicture,
    /// Nothing is seen there.
    NoSurface,
    /// Too far from the tangent plane.
    Plane {
        /// Distance from the plane, pixel footprints.
        footprints: f32,
        /// It must be below this.
        allowed: f32,
    },
    /// Too far in depth.
    Absolute {
        /// Difference of depth, scene units.
        difference: f32,
        /// It must be below this.
        allowed: f32,
    },
    /// Too far in depth for how far away the surface is.
    Relative {
        /// Difference of depth, share of the depth.
        share: f32,
        /// It must be below this.
        allowed: f32,
    },
    /// Facing another way.
    Normal {
        /// Cosine between the normals.
        cosine: f32,
        /// It must be above this.
        required: f32,
    },
}

impl Verdict {
    /// Whether it enters the mean.
    #[must_use]
    pub const fn is_accepted(&self) -> bool {
        matches!(self, Self::Accepted)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Accepted => f.write_str("accepted"),
            Self::Refused(refusal) => write!(f, "refused: {refusal}"),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::OutsidePicture => f.write_str("outside the picture"),
            Self::NoSurface => f.write_str("no surface"),
            Self::Plane { footprints, allowed } => {
                write!(
                    f,
                    "{} footprints from the tangent plane, {allowed} allowed",
                    beside(footprints, allowed)
                )
            }
            Self::Absolute { difference, allowed } => {
                write!(f, "{} scene units off in depth, {allowed} allowed", beside(difference, allowed))
            }
            Self::Relative { share, allowed } => {
                write!(f, "{} of the depth off, {allowed} allowed", beside(share, allowed))
            }
            Self::Normal { cosine, required } => {
                write!(f, "cosine {} between the normals, {required} required", beside(cosine, required))
            }
        }
    }
}

/// `value` with two significant digits, or as many as it takes to read otherwise than `limit`.
fn beside(value: f32, limit: f32) -> String {
    let rounded = |digits: usize| format!("{value:.digits$e}").parse().unwrap_or(value);
    (1..9).map(rounded).find(|&rounded: &f32| rounded != limit).unwrap_or(value).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_say_what_was_found_and_what_is_allowed() {
        let said = |refusal| Verdict::Refused(refusal).to_string();
        assert_eq!(Verdict::Accepted.to_string(), "accepted");
        assert_eq!(said(Refusal::OutsidePicture), "refused: outside the picture");
        assert_eq!(said(Refusal::NoSurface), "refused: no surface");
        assert_eq!(
            said(Refusal::Plane { footprints: 2.3416, allowed: 1.0 }),
            "refused: 2.3 footprints from the tangent plane, 1 allowed"
        );
        assert_eq!(
            said(Refusal::Absolute { difference: 0.08123, allowed: 0.05 }),
            "refused: 0.081 scene units off in depth, 0.05 allowed"
        );
        assert_eq!(
            said(Refusal::Relative { share: 0.5, allowed: 0.01 }),
            "refused: 0.5 of the depth off, 0.01 allowed"
        );
        assert_eq!(
            said(Refusal::Normal { cosine: -0.00001, required: 0.95 }),
            "refused: cosine -0.00001 between the normals, 0.95 required"
        );
    }

    #[test]
    fn a_near_miss_does_not_read_like_the_limit() {
        assert_eq!(beside(1.000_31, 1.0), "1.0003");
        assert_eq!(beside(1.0, 1.0), "1");
        assert_eq!(beside(f32::INFINITY, 1.0), "inf");
    }
}
