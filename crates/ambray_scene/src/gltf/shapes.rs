//! Shapes of KHR_implicit_shapes, and the fields that AMBRAY_shape_field adds to them.

use ambray_core::shape::{Shape, SignedDistanceField};
use glam::Vec3;

use crate::error::{Fault, Outcome, quoted};
use crate::limits;

use super::accessor::Accept;
use super::document::Document;
use super::json::{self, Index};

/// Shape `index` of the file, which exists. Sizes that are missing are the extension's defaults.
pub(super) fn read_shape(doc: &Document<'_>, index: Index) -> Outcome<Shape> {
    let at = format!("extensions.KHR_implicit_shapes.shapes[{index}]");
    let json = &doc.root.shapes()[index];
    match json.kind.as_str() {
        "sphere" => {
            let radius = json.sphere.as_ref().and_then(|sphere| sphere.radius).unwrap_or(0.5);
            positive(radius, &format!("{at}.sphere.radius"))?;
            Ok(Shape::Sphere { radius })
        }
        "box" => {
            let size = json.cuboid.as_ref().and_then(|cuboid| cuboid.size).unwrap_or([1.0; 3]);
            size.iter().try_for_each(|&size| positive(size, &format!("{at}.box.size")))?;
            Ok(Shape::Box { half_extents: 0.5 * Vec3::from(size) })
        }
        "capsule" => {
            let (height, radius_bottom, radius_top) = round(json.capsule.as_ref(), &format!("{at}.capsule"))?;
            Ok(Shape::Capsule { height, radius_bottom, radius_top })
        }
        "cylinder" => {
            let at = format!("{at}.cylinder");
            let (height, radius_bottom, radius_top) = round(json.cylinder.as_ref(), &at)?;
            Ok(Shape::Cylinder { height, radius_bottom, radius_top })
        }
        "field" => read_field(doc, json, &format!("{at}.extensions.AMBRAY_shape_field")).map(Shape::Field),
        other => {
            let reason = format!("shapes of type {} cannot be shown", quoted(other));
            Err(Fault::unsupported(format!("{at}.type"), reason))
        }
    }
}

/// Height, lower and upper radius.
fn round(json: Option<&json::RoundShape>, at: &str) -> Outcome<(f32, f32, f32)> {
    let of = |number: fn(&json::RoundShape) -> Option<f32>, default| json.and_then(number).unwrap_or(default);
    let height = of(|json| json.height, 0.5);
    let (bottom, top) = (of(|json| json.radius_bottom, 0.25), of(|json| json.radius_top, 0.25));
    positive(height, &format!("{at}.height"))?;
    for (name, radius) in [("radiusBottom", bottom), ("radiusTop", top)] {
        if radius != 0.0 {
            positive(radius, &format!("{at}.{name}"))?;
        }
    }
    if bottom == 0.0 && top == 0.0 {
        return Err(Fault::invalid(at, "both radii are 0"));
    }
    Ok((height, bottom, top))
}

/// Sizes are positive and neither so large nor so small that their products leave the range of numbers.
fn positive(size: f32, at: &str) -> Outcome<()> {
    if size.is_nan() || size <= 0.0 {
        return Err(Fault::invalid(at, format!("{size} is not positive")));
    }
    if !limits::SHAPE_SIZES.contains(&size) {
        let (least, most) = (limits::SHAPE_SIZES.start(), limits::SHAPE_SIZES.end());
        return Err(Fault::too_large(at, format!("{size:e} is not within {least:e} and {most:e}")));
    }
    Ok(())
}

fn read_field(doc: &Document<'_>, json: &json::Shape, at: &str) -> Outcome<SignedDistanceField> {
    let Some(field) = &json.extensions.field else {
        return Err(Fault::invalid(at, "field without its samples"));
    };
    let longest = u64::from(SignedDistanceField::LONGEST_AXIS);
    let [x, y, z] = field.samples;
    if field.samples.iter().any(|&n| n < 2) {
        return Err(Fault::invalid(
            format!("{at}.samples"),
            format!("{x} × {y} × {z}, each must be 2 at least"),
        ));
    }
    // Each is checked first, so that the product cannot overflow.
    let most = limits::FIELD_SAMPLES;
    if field.samples.iter().any(|&n| n > longest) || x * y * z > most {
        let reason =
            format!("{x} × {y} × {z} samples, at most {longest} an axis and {most} in all are allowed");
        return Err(Fault::too_large(format!("{at}.samples"), reason));
    }
    field.size.iter().try_for_each(|&size| positive(size, &format!("{at}.size")))?;
    let place = format!("{at}.distances");
    let count = doc.count(field.distances, &place)?;
    if count != x * y * z {
        let reason = format!("{count} values for {x} × {y} × {z} samples");
        return Err(Fault::invalid(place, reason));
    }
    let distances: Vec<[f32; 1]> = doc.read(field.distances, Accept::Float, &place)?;
    let distances = distances.into_iter().map(|[distance]| distance).collect();
    SignedDistanceField::new(field.samples.map(|n| n as u32), field.size.into(), distances)
        .map_err(|error| Fault::invalid(place, error.to_string()))
}
