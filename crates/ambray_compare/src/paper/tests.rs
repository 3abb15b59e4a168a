use ambray::{
    Control,
    scene::atrium::atrium,
    settings::{Thin, Window},
};

use super::*;
use crate::document::Block;

#[test]
fn every_figure_says_what_was_measured() {
    let mut renderer = Renderer::new(atrium());
    let content = Content::of(renderer.scene());
    let size = Size { width: 64, height: 36 };
    let settings = Settings { size, ..Settings::default() };
    let views = Views::of(renderer.scene(), &settings);
    let truth = TruthOptions { bound: 0.01, ..TruthOptions::default() };
    let options = PaperOptions { truth, runs: 2, table_size: size };
    let work = Work::new(Control::default(), &|_| ());
    let (document, paper) = run(&mut renderer, &content, &views, &options, work).expect("renders");

    let titles: Vec<_> = document.sections.iter().map(|section| &section.title[..8]).collect();
    assert_eq!(titles, ["Figure 1", "Figure 2", "Figures ", "Figure 6", "Table: t"]);
    let holds = |i: usize| {
        let of = |block: &Block| match block {
            Block::Finding { holds, measured, .. } => Some((*holds, measured.clone())),
            _ => None,
        };
        document.sections[i].blocks.iter().filter_map(of).collect::<Vec<_>>()
    };
    // Whether the first one holds depends on times, the second on a larger picture.
    assert_eq!([0, 1, 2, 3].map(|i| holds(i).len()), [1; 4]);
    assert!(!holds(2)[0].0, "the paper's batch leads away from the truth: {:?}", holds(2));
    assert!(holds(3)[0].0, "32 rays look like 8: {:?}", holds(3));
    assert!(paper.truth.is_reached());

    let rmse = |name: &str| {
        paper.pictures.iter().find(|picture| picture.name == name).expect("measured").measures.rmse
    };
    assert!(rmse("1 ray") > rmse("4 rays") && rmse("4 rays") > rmse("32 rays"));
    assert_eq!(paper.times.len(), 3);
    let [off, batch, sheet] = &paper.times[..] else { panic!("three kinds") };
    assert_eq!(off.chords_per_pixel, 0.0);
    assert!(batch.chords_per_pixel > sheet.chords_per_pixel && sheet.chords_per_pixel > 0.0);
    assert!(paper.times.iter().all(|times| times.total.count == 2 && times.total.min > 0.0));
}

#[test]
fn what_the_figures_choose_is_told() {
    let asked = Settings { thin: Thin::Sheet, filter: Window::Off, spp: 4, ..Settings::default() };
    assert_eq!(chosen(&asked), ["thin", "filter"]);
    assert_eq!(chosen(&Settings::default()), <[&str; 0]>::default());
}
