//! The shapes of points. The colours of Okabe and Ito (2008) are told apart with any colour vision; the shapes see to it
//! that no two series of a plot differ by colour alone.

use maud::{Markup, html};

/// Colours of the style sheet.
pub(super) const COLOURS: usize = 7;

/// The marker of series `index` around the origin.
pub(super) fn marker(index: usize) -> Markup {
    html! {
        @match index % 8 {
            0 => circle.mark r="4.5" {},
            1 => rect.mark x="-4" y="-4" width="8" height="8" {},
            2 => polygon.mark points="0,-5.5 5,3.5 -5,3.5" {},
            3 => polygon.mark points="0,-6 6,0 0,6 -6,0" {},
            4 => path.mark.stroke d="M-4.5-4.5 4.5 4.5M-4.5 4.5 4.5-4.5" {},
            5 => polygon.mark points="0,5.5 5,-3.5 -5,-3.5" {},
            6 => path.mark.stroke d="M-5.5 0H5.5M0-5.5V5.5" {},
            _ => circle.mark.stroke r="4.5" {},
        }
    }
}
