//! What a reader does to tables and plots.

use conformance::browser::{Look, Page};

use crate::{kept, open};

#[test]
fn a_heading_sorts_its_column_up_down_and_back() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let names = |page: &mut Page| {
        page.text(
            "[...document.querySelectorAll('.sortable tbody tr')].map(r => r.cells[0].textContent).join()",
        )
    };
    let original = "Truth,Ambray, 8 rays,Random, 8 rays,SSAO,GTAO,Bitmask";
    assert_eq!(names(&mut page), original);
    let click = |page: &mut Page, column: usize| {
        let heading = page.find(&format!(".sortable th:nth-child({column}) button"));
        page.click(heading.at(0.5, 0.5), 1);
    };
    // Time: the truth has none and stays last both ways.
    click(&mut page, 6);
    assert_eq!(names(&mut page), "SSAO,GTAO,Bitmask,Ambray, 8 rays,Random, 8 rays,Truth");
    click(&mut page, 6);
    assert_eq!(names(&mut page), "Random, 8 rays,Ambray, 8 rays,Bitmask,GTAO,SSAO,Truth");
    click(&mut page, 6);
    assert_eq!(names(&mut page), original);
    // PSNR: the largest first; infinity is larger than any.
    click(&mut page, 4);
    assert_eq!(names(&mut page), "Truth,Ambray, 8 rays,Random, 8 rays,Bitmask,GTAO,SSAO");
    // Bias: nearest to zero first, whatever the sign.
    click(&mut page, 5);
    assert_eq!(names(&mut page), "Truth,Random, 8 rays,Ambray, 8 rays,Bitmask,GTAO,SSAO");
    assert_eq!(page.number("document.querySelectorAll('th[aria-sort$=ending]').length"), 1.0);
    page.screenshot(&kept("table.png"));
}

#[test]
fn a_point_of_a_plot_says_what_it_is_and_the_legend_hides_curves() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let point = page.find(".series[data-series='0'] .point:nth-of-type(4) .mark");
    page.hover(point.at(0.5, 0.5));
    page.settle();
    assert!(page.value("!document.querySelector('.tip').hidden").as_bool().expect("a truth"));
    let text = page.text("document.querySelector('.tip').innerText");
    assert_eq!(text, "Ambray – 8 rays\nrays per pixel: 8\nRMSE of openness: 0.025");
    page.screenshot(&kept("tip.png"));
    let button = page.find(".legend button");
    page.click(button.at(0.5, 0.5), 1);
    assert_eq!(page.text("getComputedStyle(document.querySelector('.series')).display"), "none");
    page.click(button.at(0.5, 0.5), 1);
    assert_ne!(page.text("getComputedStyle(document.querySelector('.series')).display"), "none");
}
