//! Files of triangles, rays and hits come back as they were written, and broken ones are refused.

use std::{fs, path::Path};

use ambray::{
    cpu::rays::{RayBatch, RayKind, Triangles},
    trace::{Hit, Ray},
};
use ambray_files::rays::{Hits, read_batch, read_triangles, write_batch, write_triangles};
use glam::Vec3;

fn triangles() -> Triangles {
    Triangles {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(-0.0, 1e-40, 3.5e30)],
        indices: vec![[0, 1, 2], [2, 1, 0]],
    }
}

fn batch() -> RayBatch {
    let ray = |x: f32, t_max| Ray { origin: Vec3::new(x, -0.25, 7.0), t_max, direction: Vec3::Y, seed: 0 };
    RayBatch {
        kind: RayKind::Any,
        width: 3,
        height: 2,
        per_pixel: 4,
        rays: vec![ray(1.5, 0.125), ray(-2.0, f32::INFINITY)],
        tags: vec![23, 0],
    }
}

fn bytes(write: impl FnOnce(&mut Vec<u8>) -> anyhow::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    bytes
}

/// The file of words of 32 bits after a magic word.
fn file(magic: &str, words: &[u32]) -> Vec<u8> {
    magic.bytes().chain(words.iter().flat_map(|word| word.to_le_bytes())).collect()
}

#[track_caller]
fn read<T: std::fmt::Debug>(
    bytes: &[u8],
    read: impl FnOnce(&Path) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    fs::write(&path, bytes).unwrap();
    read(&path)
}

/// The file is refused in one line that names it and says `expected`.
#[track_caller]
fn refused<T: std::fmt::Debug>(bytes: &[u8], with: impl FnOnce(&Path) -> anyhow::Result<T>, expected: &str) {
    let error = format!("{:#}", read(bytes, with).unwrap_err());
    assert!(error.contains(expected), "{error:?} lacks {expected:?}");
    assert!(error.contains("file") && error.lines().count() == 1, "{error:?}");
}

#[test]
fn the_format_is_the_one_that_is_documented() {
    let one = 1_f32.to_bits();
    let triangle = Triangles { positions: vec![Vec3::X], indices: vec![[0, 0, 0]] };
    let expected = file("TRIS", &[1, 1, 1, one, 0, 0, 0, 0, 0]);
    assert_eq!(bytes(|out| write_triangles(out, &triangle)), expected);

    let mut batch = batch();
    batch.rays.truncate(1);
    batch.tags.truncate(1);
    let ray = [1.5_f32, -0.25, 7.0, 0.0, 0.0, 1.0, 0.0, 0.125].map(f32::to_bits);
    let expected = file("RAYS", &[&[1, 1, 1, 3, 2, 4, 0], &ray[..], &[23]].concat());
    assert_eq!(bytes(|out| write_batch(out, &batch)), expected);

    let hits = Hits { distances: vec![1.0], triangles: vec![u32::MAX] };
    assert_eq!(bytes(|out| hits.write(out)), file("HITS", &[1, 1, one, u32::MAX]));
}

#[test]
fn files_come_back_as_they_were_written() {
    let written = bytes(|out| write_triangles(out, &triangles()));
    let back = read(&written, read_triangles).unwrap();
    assert_eq!(back, triangles());
    assert!(back.positions[2].x.is_sign_negative(), "every bit");
    let written = bytes(|out| write_batch(out, &batch()));
    assert_eq!(read(&written, read_batch).unwrap(), batch());
    let closest = RayBatch { kind: RayKind::Closest, rays: Vec::new(), tags: Vec::new(), ..batch() };
    let written = bytes(|out| write_batch(out, &closest));
    assert_eq!(read(&written, read_batch).unwrap(), closest);
    let hits = Hits { distances: vec![0.5, f32::NEG_INFINITY], triangles: vec![7, 0] };
    let written = bytes(|out| hits.write(out));
    assert_eq!(read(&written, Hits::read).unwrap(), hits);
    // More than one buffer of the reader.
    let many = Hits { distances: (0..50_000).map(|i| i as f32).collect(), triangles: (0..50_000).collect() };
    let written = bytes(|out| many.write(out));
    assert_eq!(read(&written, Hits::read).unwrap(), many);
}

#[test]
fn broken_triangles_are_refused() {
    let whole = bytes(|out| write_triangles(out, &triangles()));
    for length in 0..whole.len() {
        assert!(read(&whole[..length], read_triangles).is_err(), "{length} bytes");
    }
    refused(b"", read_triangles, "does not begin with TRIS");
    refused(&file("RAYS", &[1, 0, 0]), read_triangles, "is no TRIS file");
    refused(&file("TRIS", &[2, 0, 0]), read_triangles, "version 2");
    refused(&[&whole[..], &[0; 4]].concat(), read_triangles, "is too long: 1 number");
    refused(&[&whole[..], &[0; 3]].concat(), read_triangles, "multiple of 4");
    // As many as the header can say: nothing is allocated for them.
    refused(&file("TRIS", &[1, u32::MAX, u32::MAX]), read_triangles, "is too short");
    refused(&file("TRIS", &[1, 1, 1, 0, 0, 0, 0, 0, 1]), read_triangles, "beyond the 1 there are");
    let infinite = f32::INFINITY.to_bits();
    refused(&file("TRIS", &[1, 1, 1, 0, infinite, 0, 0, 0, 0]), read_triangles, "not finite");
    let missing = format!("{:#}", read_triangles(Path::new("no-such-file")).unwrap_err());
    assert!(missing.starts_with("no-such-file: "), "{missing}");
}

#[test]
fn broken_rays_are_refused() {
    let whole = bytes(|out| write_batch(out, &batch()));
    for length in 0..whole.len() {
        assert!(read(&whole[..length], read_batch).is_err(), "{length} bytes");
    }
    refused(&file("RAYS", &[1, u32::MAX, 0, 9, 9, 9, 0]), read_batch, "is too short");
    refused(&file("RAYS", &[1, 0, 2, 1, 1, 1, 0]), read_batch, "kind 2");
    refused(&file("RAYS", &[1, 0, 0, 0, 1, 1, 0]), read_batch, "0 x 1 pixels");
    refused(&file("RAYS", &[1, 0, 0, 1, 1, 0, 0]), read_batch, "with 0 rays");
    refused(&file("RAYS", &[1, 0, 0, 1 << 16, 1 << 16, 2, 0]), read_batch, "too much");
    // The second ray begins at word 8 + 8.
    let broken = |word: usize, value: f32| {
        let mut bytes = whole.clone();
        bytes[4 * word..][..4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let ray = 8 + 8;
    refused(&broken(ray + 1, f32::NAN), read_batch, "ray 1: its origin is not finite");
    refused(&broken(ray + 3, 0.5), read_batch, "ray 1: it begins at 0.5");
    refused(&broken(ray + 4, 0.5), read_batch, "ray 1: its direction is no unit vector");
    refused(&broken(ray + 4, f32::NAN), read_batch, "ray 1: its direction is no unit vector");
    refused(&broken(ray + 7, f32::NAN), read_batch, "ray 1: it ends at NaN");
    refused(&broken(ray + 7, -1.0), read_batch, "ray 1: it ends at -1");
    // 3 x 2 pixels with 4 rays: 23 is the last tag.
    refused(&broken(ray + 8, f32::from_bits(24)), read_batch, "ray 0: its tag 24 is outside the picture");
}

#[test]
fn hits_are_told_as_other_tracers_tell_them() {
    let rays = batch().rays;
    let hit = Hit { t: 0.1, triangle: 6, instance: 0, ..Hit::MISS };
    let closest = Hits::closest(&rays, &[hit, Hit::MISS]);
    assert_eq!(closest, Hits { distances: vec![0.1, f32::INFINITY], triangles: vec![6, u32::MAX] });
    let any = Hits::any(&rays, &[false, true]);
    assert_eq!(any, Hits { distances: vec![0.125, f32::NEG_INFINITY], triangles: vec![u32::MAX, 0] });
    assert_eq!([closest.count(), any.count()], [1, 1]);
}

#[test]
fn agreement_counts_what_differs() {
    let hits = |distances: &[f32], triangles: &[u32]| Hits {
        distances: distances.to_vec(),
        triangles: triangles.to_vec(),
    };
    let none = u32::MAX;
    let ours = hits(&[1.0, 2.0, 9.0, 4.0, 9.0, 0.0], &[0, 1, none, 3, none, 5]);
    // The same but for rounding, elsewhere, hit by one only, missed by one only, missed by both, at 0.
    let theirs = hits(&[1.0001, 3.0, 1.0, 9.0, 9.0, 0.0], &[8, 1, 2, none, none, 5]);
    let agreement = ours.agreement(&theirs, RayKind::Closest).unwrap();
    assert_eq!((agreement.differing, agreement.far), (2, 1));
    assert!((agreement.largest_difference - 1e-4).abs() < 1e-6, "{agreement:?}");
    assert_eq!(
        ours.agreement(&theirs, RayKind::Closest).unwrap(),
        theirs.agreement(&ours, RayKind::Closest).unwrap()
    );
    // A hit without a distance agrees with none.
    let nowhere = hits(&[f32::NEG_INFINITY, f32::NAN, 9.0, 4.0, 9.0, 0.0], &[0, 1, none, 3, none, 5]);
    assert_eq!(ours.agreement(&nowhere, RayKind::Closest).unwrap().far, 2);
    // Distances of any hit say nothing.
    let any = ours.agreement(&theirs, RayKind::Any).unwrap();
    assert_eq!((any.differing, any.far, any.largest_difference), (2, 0, 0.0));
    let error = ours.agreement(&Hits::default(), RayKind::Any).unwrap_err().to_string();
    assert!(error.contains("hits of 0 rays, not of the 6"), "{error}");
}

#[cfg(unix)]
#[test]
fn pipes_are_refused_without_waiting() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("hits.hits");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let error = format!("{:#}", Hits::read(&pipe).unwrap_err());
    assert!(error.contains("is no regular file"), "{error}");
}
