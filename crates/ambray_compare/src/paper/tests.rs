use ambray::{Control, scene::atrium::atrium};

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
    assert!(holds(0)[0].0, "colour bleeding costs no ray: {:?}", holds(0));
    assert!(holds(1)[0].0, "the filter removes the pattern: {:?}", holds(1));
    let thin = holds(2);
    assert!(thin[0].0 && !thin[1].0 && thin[2].0, "found, not nearer to the truth, sheet better: {thin:?}");

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
