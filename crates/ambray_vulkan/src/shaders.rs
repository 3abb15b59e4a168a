//! The compiled shaders. They are committed, so that building needs no shader compiler.

macro_rules! modules {
    ($($(#[$meta:meta])* $name:ident = $file:literal;)*) => {
        $( $(#[$meta])* pub(crate) const $name: &[u8] = include_bytes!(concat!("../shaders/spv/", $file, ".spv")); )*
    };
}

modules! {
    PRIMARY_RAYGEN = "primary.rgen";
    DIRECT_RAYGEN = "direct.rgen";
    AMBIENT_RAYGEN = "ambient.rgen";
    RAYS_RAYGEN = "rays.rgen";
    PRIMARY_QUERY = "primary.comp";
    DIRECT_QUERY = "direct.comp";
    AMBIENT_QUERY = "ambient.comp";
    RAYS_QUERY = "rays.comp";
    FILTER = "filter.comp";
    DEFORM = "deform.comp";
    ASSIGN = "assign.comp";
    MEASURE = "measure.comp";
    COST = "cost.comp";
    SUMS = "sums.comp";
    BOUNDS = "bounds.comp";
    SHOW = "show.comp";
    PAINT_VERTEX = "paint.vert";
    PAINT_FRAGMENT = "paint.frag";
    CLOSEST_HIT = "hit.rchit";
    MISS = "miss.rmiss";
    MASKED_ANY_HIT = "masked.rahit";
    SHAPE_ANY_HIT = "shape.rahit";
    SHAPE_INTERSECTION = "shape.rint";
    LIT = "lit.rcall";
    UNLIT = "unlit.rcall";
    EMISSIVE = "emissive.rcall";
    CHECKER = "checker.rcall";
}
