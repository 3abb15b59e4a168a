//! What the measurements say about what is claimed, in words.

use ambray::settings::Method;

use crate::{
    document::Block,
    experiment::{Outcome, Row},
};

/// Sampling part of interleaved rays over that of random ones, at most (spec §11).
const INTERLEAVED_OVER_RANDOM: f64 = 0.5;
/// Sampling part of one set over that of interleaved ones, at least: spec §11 has 1.2 times that of random rays.
const SAME_OVER_INTERLEAVED: f64 = 1.2 / INTERLEAVED_OVER_RANDOM;

/// Findings about the methods that were measured.
pub(super) fn of(outcome: &Outcome) -> Vec<Block> {
    let row = |method| outcome.rows.iter().find(|row| row.method == method);
    let Some(ambray) = row(Method::Ambray) else { return Vec::new() };
    // Where nothing is seen there is nothing to say.
    let against =
        |method, say: fn(&Row, &Row) -> Option<Block>| row(method).and_then(|other| say(ambray, other));
    let screen: Vec<&Row> = outcome
        .rows
        .iter()
        .filter(|row| row.method.is_screen_space() && row.method != Method::Hybrid)
        .collect();
    let mut findings: Vec<Block> = [
        against(Method::TracedRandom, random),
        against(Method::TracedSame, same),
        against(Method::Hybrid, hybrid),
    ]
    .into_iter()
    .flatten()
    .collect();
    let is_seen = ambray.rays_per_pixel > 0.0;
    findings.extend((is_seen && !screen.is_empty()).then(|| screen_space(ambray, &screen)));
    findings
}

fn sampling_part(row: &Row) -> f64 {
    row.measures.sampling_part.unwrap_or_default()
}

fn random(ambray: &Row, random: &Row) -> Option<Block> {
    let (ours, theirs) = (sampling_part(ambray), sampling_part(random));
    (theirs > 0.0).then(|| Block::Finding {
        claim: format!(
            "With {}, interleaved sets err less than half of what random directions do.",
            ambray.effort
        ),
        measured: format!("Sampling part {ours:.5} against {theirs:.5}: {:.2} of it.", ours / theirs),
        holds: ours < INTERLEAVED_OVER_RANDOM * theirs,
    })
}

fn same(ambray: &Row, same: &Row) -> Option<Block> {
    let (ours, theirs) = (sampling_part(ambray), sampling_part(same));
    (ours > 0.0).then(|| Block::Finding {
        claim: "One set of directions for all pixels leaves bands that the filter does not remove."
            .to_owned(),
        measured: format!(
            "Sampling part {theirs:.5} with one set, {ours:.5} interleaved: {:.1} times as much.",
            theirs / ours
        ),
        holds: theirs > SAME_OVER_INTERLEAVED * ours,
    })
}

fn hybrid(ambray: &Row, hybrid: &Row) -> Option<Block> {
    let share = hybrid.rays_per_pixel / ambray.rays_per_pixel;
    let one_machine = ambray.who == hybrid.who;
    let slower = hybrid.milliseconds.median / ambray.milliseconds.median;
    let time = if one_machine { format!(", {slower:.2} times the time") } else { String::new() };
    (ambray.rays_per_pixel > 0.0).then(|| Block::Finding {
        claim: "Walking through the depth buffer first saves rays and time without spoiling the picture."
            .to_owned(),
        measured: format!(
            "{share:.2} of the rays, RMSE {:.5} against {:.5}{time}.{}",
            hybrid.measures.rmse,
            ambray.measures.rmse,
            if one_machine { "" } else { " They ran on different machines, so times say nothing." }
        ),
        holds: share < 1.0
            && hybrid.measures.rmse < 1.25 * ambray.measures.rmse
            && (!one_machine || slower < 1.0),
    })
}

fn screen_space(ambray: &Row, screen: &[&Row]) -> Block {
    let nearest = |value: fn(&Row) -> f64| {
        screen.iter().copied().min_by(|a, b| value(a).total_cmp(&value(b))).expect("at least one")
    };
    let (best, fitted) = (nearest(|row| row.measures.rmse), nearest(|row| row.fitted_rmse));
    Block::Finding {
        claim: "A few rays are nearer to the truth than what the depth buffer alone can tell.".to_owned(),
        measured: format!(
            "RMSE {:.5}; the best in screen space is {} with {:.5} (bias {:+.4}). Whatever their strength, the best is {} with \
             {:.5} against {:.5}.",
            ambray.measures.rmse,
            best.name,
            best.measures.rmse,
            best.measures.bias,
            fitted.name,
            fitted.fitted_rmse,
            ambray.fitted_rmse
        ),
        holds: ambray.measures.rmse < best.measures.rmse && ambray.fitted_rmse < fitted.fitted_rmse,
    }
}
