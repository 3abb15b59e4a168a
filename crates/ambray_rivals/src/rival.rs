//! Which method settings ask for.

use std::fmt::Debug;

use ambray_core::{
    control::{Cancelled, Control},
    settings::{Method, Settings},
};

use crate::{Bitmask, Gtao, Hbao, Screen, Ssao};

/// A method that needs nothing but the picture.
pub trait Rival: Debug + Sync {
    /// Openness of each pixel (1 = open, or nothing is seen there), before the method's filter.
    fn estimate(&self, screen: &Screen, control: &Control<'_>) -> Result<Vec<f32>, Cancelled>;
    /// What the filter that the method is usually shown with makes of `raw`.
    fn filter(&self, screen: &Screen, raw: &[f32], control: &Control<'_>) -> Result<Vec<f32>, Cancelled>;
}

/// The method that `settings` ask for, if it needs nothing but the picture.
#[must_use]
pub fn rival(settings: &Settings) -> Option<Box<dyn Rival>> {
    match settings.method {
        Method::Ssao => Some(Box::new(Ssao::of(settings))),
        Method::Hbao => Some(Box::new(Hbao::of(settings))),
        Method::Gtao => Some(Box::new(Gtao::of(settings))),
        Method::Bitmask => Some(Box::new(Bitmask::of(settings))),
        Method::Hybrid | Method::Ambray | Method::TracedRandom | Method::TracedSame | Method::TracedStep => {
            None
        }
    }
}

/// The methods share names with the trait.
macro_rules! rivals {
    ($($method:ident)+) => { $(
        impl Rival for $method {
            fn estimate(&self, screen: &Screen, control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
                self.estimate(screen, control)
            }

            fn filter(
                &self,
                screen: &Screen,
                raw: &[f32],
                control: &Control<'_>,
            ) -> Result<Vec<f32>, Cancelled> {
                self.filter(screen, raw, control)
            }
        }
    )+ };
}

rivals!(Ssao Hbao Gtao Bitmask);
