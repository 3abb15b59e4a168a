//! SSAO against the expected value of its published kernel on closed forms, and its known faults.

mod common;

use ambray_core::{
    control::Control,
    settings::{Method, Settings},
};
use ambray_rivals::{Screen, Ssao};
use common::{Scene, Seen, Shape, mean, parallel, perspective, see, truth};
use glam::DVec3;

const DOWN: DVec3 = DVec3::NEG_Y;

fn raw(ssao: &Ssao, screen: &Screen) -> Vec<f32> {
    ssao.estimate(screen, &Control::default()).unwrap()
}

fn default() -> Ssao {
    Ssao::of(&Settings::default())
}

/// Mean of a column over its middle 16 rows: whole tiles of rotations.
fn column(seen: &Seen, values: &[f32], x: usize) -> f64 {
    let (width, height) = seen.screen.size();
    mean((height / 2 - 8..height / 2 + 8).map(|y| values[y * width + x]))
}

#[test]
fn the_published_default_has_64_points() {
    assert_eq!(default().samples, 64);
}

#[test]
fn an_open_plane_is_open() {
    let floor = Scene(vec![Shape::level(0.0, -50.0, 50.0)]);
    let cameras = [
        parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (48, 32), 20.0),
        // Depth rises by half a pixel, 1/40, from the centre of a pixel to its corner at most: less than the bias of 1/20.
        parallel(DVec3::new(0.0, 5.0, 0.0), DVec3::new(1.0, -1.0, 0.0), (48, 32), 20.0),
        perspective(DVec3::new(0.0, 2.0, 0.0), DVec3::new(1.0, 0.0, 0.3), (96, 64)),
    ];
    for camera in cameras {
        let seen = see(&floor, camera, 1.0, &Settings::default());
        assert!(raw(&default(), &seen.screen).iter().all(|o| *o == 1.0));
    }
}

#[test]
fn without_a_bias_a_steep_plane_blocks_itself() {
    let floor = Scene(vec![Shape::level(0.0, -50.0, 50.0)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DVec3::new(2.0, -1.0, 0.0), (48, 32), 10.0);
    let seen = see(&floor, camera, 1.0, &Settings::default());
    assert!(mean(raw(&Ssao { bias: 0.0, ..default() }, &seen.screen)) < 0.99);
}

/// Expected openness at the point (`x`, 0, 0) of the floor of a corner, by 400 000 points of the published distribution in
/// double precision: standard error below 0.5/√400 000 = 0.0008.
///
/// Floor y = 0 and wall x = 0, seen by parallel rays along (−1, −1, 0)/√2. With u the axis of the picture that points up,
/// (−1, 1, 0)/√2, a point is seen at the depth u where u < 0 (the floor), −u above (the wall).
fn in_a_corner(x: f64, bias: f64) -> f64 {
    let (forward, up) = (DVec3::new(-1.0, -1.0, 0.0).normalize(), DVec3::new(-1.0, 1.0, 0.0).normalize());
    let (right, normal, origin) = (forward.cross(up), DVec3::Y, DVec3::new(x, 0.0, 0.0));
    let mut random = fastrand::Rng::with_seed(1);
    let mut between = move |low: f64, high: f64| low + (high - low) * random.f64();
    let count = 400_000;
    let mut blocked = 0.0;
    for _ in 0..count {
        let turn = (right * between(-1.0, 1.0) + up * between(-1.0, 1.0)).normalize();
        let tangent = (turn - normal * turn.dot(normal)).normalize();
        let bitangent = normal.cross(tangent);
        let box_point = DVec3::new(between(-1.0, 1.0), between(-1.0, 1.0), between(0.0, 1.0));
        let scale = 0.1 + 0.9 * between(0.0, 1.0).powi(2);
        let local = box_point.normalize() * scale;
        let point = origin + tangent * local.x + bitangent * local.y + normal * local.z;
        let seen = -point.dot(up).abs();
        if seen <= point.dot(forward) - bias {
            let range = (1.0 / (origin.dot(forward) - seen).abs()).min(1.0);
            blocked += range * range * (3.0 - 2.0 * range);
        }
    }
    1.0 - blocked / f64::from(count)
}

#[test]
fn a_corner_is_on_average_what_the_kernel_expects() {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::upright(0.0, 0.0, 50.0)]);
    let camera = parallel(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0), (144, 128), 48.0);
    let rows: Vec<usize> = (65..110).step_by(6).collect();
    // 64 kernels with 16 rotations: 65 536 points a row, of 1024 radii and directions that are independent.
    let mut found = vec![0.0; rows.len()];
    let mut places = Vec::new();
    for seed in 0..64 {
        let seen = see(&scene, camera, 1.0, &Settings { seed, ..Settings::default() });
        let values = raw(&default(), &seen.screen);
        for (sum, y) in found.iter_mut().zip(&rows) {
            *sum += mean(values[y * 144 + 64..y * 144 + 80].iter().copied()) / 64.0;
        }
        places = rows.iter().map(|y| f64::from(seen.gbuffer[y * 144].position.x)).collect();
    }
    for (x, found) in places.into_iter().zip(found) {
        let expected = in_a_corner(x, 0.05);
        assert!((found - expected).abs() < 0.01, "x = {x}: {found} for {expected}");
    }
}

#[test]
fn any_quality_has_the_same_mean() {
    common::any_quality_has_the_same_mean(Method::Ssao, 0.02);
}

#[test]
fn what_is_outside_the_picture_is_not_seen() {
    let (scene, camera) = common::beside_a_wall_that_is_not_seen();
    let seen = see(&scene, camera, 1.0, &truth());
    assert!(raw(&default(), &seen.screen).iter().all(|o| *o == 1.0));
    let truth = column(&seen, &common::traced(&scene, &seen, &truth()), 0);
    assert!(truth < 0.75, "{truth}");
}

#[test]
fn what_is_hidden_is_not_seen() {
    // Under a table top stands a wall beside the visible floor, or does not: it makes no difference.
    let table = [Shape::level(0.0, -50.0, 50.0), Shape::level(1.5, -50.0, 0.0)];
    let with_wall = Scene([table.as_slice(), &[Shape::upright(0.0, 0.0, 1.5)]].concat());
    let without = Scene(table.to_vec());
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (40, 20), 20.0);
    let of = |scene| {
        let seen = see(scene, camera, 1.0, &truth());
        (raw(&default(), &seen.screen), column(&seen, &common::traced(scene, &seen, &truth()), 20))
    };
    let ((seen_with, true_with), (seen_without, true_without)) = (of(&with_wall), of(&without));
    assert_eq!(seen_with, seen_without);
    assert!(true_without == 1.0 && true_with < 0.75, "{true_without} {true_with}");
}

#[test]
fn what_is_far_in_front_casts_a_halo() {
    // A sheet three radii above the floor takes no light within the radius, but dz = 3R still counts smoothstep(1/3) = 7/27 for
    // the points that it covers. Half a pixel or δ = 1/40 beside its edge, those are the points with a coordinate below −δ. A
    // coordinate of a direction is even in [−1, 1] (but for the corners of the box), so they are the share (1 − δ E[1/s])/2;
    // with s = 0.1 + 0.9 u², E[1/s] = atan(3)/0.3 = 4.16, and openness is 1 − 0.448 · 7/27 = 0.884.
    let scene = Scene(vec![Shape::level(0.0, -50.0, 50.0), Shape::level(3.0, -50.0, 0.0)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (80, 60), 20.0);
    let values = |seed| raw(&default(), &see(&scene, camera, 1.0, &Settings { seed, ..truth() }).screen);
    let seen = see(&scene, camera, 1.0, &truth());
    let halo = (0..32).map(|seed| column(&seen, &values(seed), 40)).sum::<f64>() / 32.0;
    assert!((halo - 0.884).abs() < 0.01, "{halo}");
    assert_eq!(column(&seen, &common::traced(&scene, &seen, &truth()), 40), 1.0);
    assert_eq!(column(&seen, &values(0), 65), 1.0);
}

#[test]
fn the_filter_removes_a_tile_and_bleeds_over_edges_of_depth() {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::level(1.0, -50.0, 0.0)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (40, 20), 20.0);
    let seen = see(&scene, camera, 1.0, &Settings::default());
    let filter = |values: &[f32]| default().filter(&seen.screen, values, &Control::default()).unwrap();
    let tiled: Vec<f32> = (0..800).map(|i| ((i % 40 % 4) + 4 * (i / 40 % 4)) as f32 / 16.0).collect();
    let inside = |i: &usize| (2..39).contains(&(i % 40)) && (2..19).contains(&(i / 40));
    let filtered = filter(&tiled);
    assert!((0..800).filter(inside).all(|i| filtered[i] == 7.5 / 16.0));
    // Columns 18 to 21 of a row whose first 20 are 0: 2, 1, 0 dark ones of 4 from the edge on.
    let halves: Vec<f32> = (0..800).map(|i| if i % 40 < 20 { 0.0 } else { 1.0 }).collect();
    assert_eq!(filter(&halves)[10 * 40 + 18..][..5], [0.0, 0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn threads_change_nothing_and_work_can_be_stopped() {
    common::threads_change_nothing_and_work_can_be_stopped(&default());
}

#[test]
fn where_nothing_is_seen_it_is_open() {
    common::where_nothing_is_seen_it_is_open(&default());
}
