use super::*;
use crate::document::Axis;

fn sample() -> Plot {
    Plot {
        caption: "Error against rays".into(),
        x: Axis { title: "rays".into(), logarithmic: true },
        y: Axis { title: "RMSE".into(), logarithmic: true },
        series: vec![
            Series {
                name: "a < b".into(),
                points: vec![(1.0, 0.1), (10.0, 0.01), (100.0, 0.0)],
                labels: vec!["first".into(), "second".into(), "third".into()],
            },
            Series { name: "alone".into(), points: vec![(4.0, 0.05)], labels: Vec::new() },
        ],
    }
}

#[test]
fn points_lie_where_their_values_are() {
    let plot = sample();
    let field = Field::new(&plot).expect("points");
    // Logarithms of x from 0 to 1, with 6 % around: 0.06 / 1.12 and 1.06 / 1.12 of the width.
    assert!((field.x(1.0) - (LEFT + (RIGHT - LEFT) * 0.06 / 1.12)).abs() < 1e-9);
    assert!((field.x(10.0) - (LEFT + (RIGHT - LEFT) * 1.06 / 1.12)).abs() < 1e-9);
    // Smaller errors are further down.
    assert!(field.y(0.01) > field.y(0.1));
}

#[test]
fn a_point_that_cannot_be_shown_is_left_out_of_the_drawing_and_kept_in_the_values() {
    let drawn = plot(&sample(), "p").into_string();
    assert_eq!(drawn.matches(r#"class="point""#).count(), 3);
    assert!(!drawn.contains("third\n") && drawn.contains("third</th>"), "{drawn}");
    assert!(drawn.contains("Not on these axes (x, y): a &lt; b – third (100, 0)."), "{drawn}");
    assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
}

#[test]
fn labels_are_escaped_and_a_single_point_has_no_line() {
    let drawn = plot(&sample(), "p").into_string();
    assert!(drawn.contains("a &lt; b – second\nrays: 10\nRMSE: 0.01"), "{drawn}");
    let chart = drawn.split("</svg>").next().expect("a drawing");
    assert_eq!(chart.matches("<polyline").count(), 1);
}

#[test]
fn a_label_that_names_its_series_is_not_preceded_by_the_name() {
    let mut series = sample().series.swap_remove(0);
    assert_eq!(said(&series, 1), "a < b – second");
    series.labels[1] = "a < b, 8 rays".into();
    assert_eq!(said(&series, 1), "a < b, 8 rays");
    series.labels.clear();
    assert_eq!(said(&series, 1), "a < b");
}

#[test]
fn an_empty_plot_says_so() {
    let nothing = plot(&Plot::default(), "p").into_string();
    assert!(nothing.contains("Nothing was measured") && !nothing.contains("<svg"), "{nothing}");
}

#[test]
fn series_differ_by_more_than_colour() {
    let looks: std::collections::HashSet<(String, usize)> = (0..56).map(|i| (look(i), i % 8)).collect();
    assert_eq!(looks.len(), 56);
    let shapes: std::collections::HashSet<String> = (0..8).map(|i| marker::marker(i).into_string()).collect();
    assert_eq!(shapes.len(), 8);
}
