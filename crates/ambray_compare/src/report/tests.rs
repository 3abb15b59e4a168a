use ambray::{
    Control, Renderer,
    scene::atrium::atrium,
    settings::{Settings, Size},
};

use super::*;
use crate::{
    document::Cell,
    experiment::{self, Options, Work},
    output,
    truth::{Content, TruthOptions},
};

fn outcome() -> Outcome {
    let mut renderer = Renderer::new(atrium());
    let content = Content::of(renderer.scene());
    let settings = Settings { size: Size { width: 48, height: 27 }, ..Settings::default() };
    let options = Options {
        methods: vec![Method::TracedRandom, Method::TracedSame, Method::Gtao],
        rays: vec![1, 8],
        runs: 1,
        truth: TruthOptions { bound: 0.01, ..TruthOptions::default() },
        sequence: None,
    };
    let work = Work::new(Control::default(), &|_| ());
    experiment::run(&mut renderer, &content, &settings, &options, work).expect("renders")
}

#[test]
fn the_report_says_what_was_measured() {
    let outcome = outcome();
    let document = document("Test".to_owned(), &outcome, Vec::new(), "ambray compare".to_owned());
    let titles: Vec<_> = document.sections.iter().map(|section| section.title.as_str()).collect();
    let expected = ["Summary", "Openness", "Light", "Error against rays", "Error against time", "Methods"];
    assert_eq!(titles[..6], expected);
    let summary = &document.sections[0].blocks;
    let findings = summary.iter().filter(|block| matches!(block, Block::Finding { .. })).count();
    assert_eq!(findings, 3, "random, one set, screen space: {summary:?}");
    let Some(Block::Table(table)) = summary.last() else { panic!("the table comes last") };
    assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
    let rmse = table.columns.iter().position(|column| column.title == "RMSE").expect("a column");
    assert_eq!(table.rows[0][rmse], Cell::Number(outcome.rows[0].measures.rmse, 5));
    // Methods without rays have no place on an axis of rays.
    let Some(Block::Plot(plot)) = document.sections[3].blocks.get(1) else { panic!("a plot") };
    assert_eq!(plot.series.len(), 3);

    let csv = output::csv(&outcome);
    let mut lines = csv.lines();
    let heading: Vec<_> = lines.next().expect("a heading").split(',').collect();
    assert!(heading.contains(&"rmse") && heading.contains(&"median-ms"), "{heading:?}");
    let rows: Vec<_> = lines.collect();
    assert_eq!(rows.len(), 4 + 3 * 2 + 4, "{csv}");
    assert!(rows[0].starts_with("table,Ambray,ambray,8 rays,"), "{csv}");
    let json = serde_json::to_value(&outcome).expect("plain data");
    assert_eq!(json["rows"][0]["measures"]["rmse"].as_f64(), Some(outcome.rows[0].measures.rmse));
    assert_eq!(json["truth"]["spp"].as_u64(), Some(u64::from(outcome.truth.spp)));
}
