//! The materials of the atrium.

use glam::{Affine2, Vec3};

use super::textures;
use crate::modelling::builder::{Builder, MaterialId};
use crate::{AlphaMode, Material, TextureRef};

/// Handles of all materials.
#[derive(Clone, Copy, Debug)]
pub(super) struct Palette {
    /// Carved limestone: columns, arches, mouldings.
    pub(super) stone: MaterialId,
    /// Cream plaster of the court's fronts and of the vaults.
    pub(super) plaster: MaterialId,
    /// The saturated red walls behind the arcades.
    pub(super) terracotta: MaterialId,
    /// Ochre walls of the gallery.
    pub(super) ochre: MaterialId,
    /// Pale tiles.
    pub(super) tiles: MaterialId,
    /// Darker tiles of patterns.
    pub(super) dark_tiles: MaterialId,
    /// Bed of the tiles.
    pub(super) mortar: MaterialId,
    /// Doors, crates and benches.
    pub(super) wood: MaterialId,
    /// Beams of ceilings.
    pub(super) dark_wood: MaterialId,
    /// Roof tiles.
    pub(super) roof: MaterialId,
    /// Vases and amphorae.
    pub(super) pottery: MaterialId,
    /// Blue glaze.
    pub(super) glaze: MaterialId,
    /// Rods and rings.
    pub(super) bronze: MaterialId,
    /// Water of the fountain.
    pub(super) water: MaterialId,
    /// Earth in pots.
    pub(super) soil: MaterialId,
    /// Stems and trunks.
    pub(super) bark: MaterialId,
    /// Leaf cards, alpha-masked.
    pub(super) leaf: MaterialId,
    /// Oranges.
    pub(super) orange: MaterialId,
    /// Cloths.
    pub(super) red: MaterialId,
    pub(super) green: MaterialId,
    pub(super) blue: MaterialId,
    pub(super) striped: MaterialId,
    pub(super) banner: MaterialId,
    /// Pages of books.
    pub(super) paper: MaterialId,
}

impl Palette {
    /// Paints the textures and mixes the materials.
    pub(super) fn new(builder: &mut Builder) -> Self {
        let stone = builder.texture(textures::stone(), 1.0);
        let plaster = builder.texture(textures::plaster(), 2.0);
        let relief = builder.texture(textures::plaster_relief(), 1.0);
        let marble = builder.texture(textures::marble(), 2.0);
        let wood = builder.texture(textures::wood(), 0.5);
        let weave = builder.texture(textures::weave(), 0.25);
        let stripes = builder.texture(textures::stripes(), 1.0);
        let banner = builder.texture(textures::banner(), 1.0);
        let leaf = builder.texture(textures::leaf(), 1.0);
        let stripes = TextureRef { transform: Affine2::from_scale(glam::vec2(1.6, 4.0)), ..stripes };

        let rough = |material| Material { normal_texture: Some(relief), normal_scale: 0.8, ..material };
        let leafy = |material| Material { alpha_mode: AlphaMode::Mask(0.5), double_sided: true, ..material };
        let mut add = |material| builder.material(material);
        Self {
            stone: add(opaque("stone", [0.74, 0.66, 0.53], Some(stone))),
            plaster: add(opaque("plaster", [0.82, 0.71, 0.55], Some(plaster))),
            tiles: add(opaque("pale tiles", [0.82, 0.77, 0.69], Some(marble))),
            dark_tiles: add(opaque("red tiles", [0.50, 0.25, 0.17], Some(marble))),
            mortar: add(opaque("mortar", [0.50, 0.45, 0.38], None)),
            wood: add(opaque("wood", [0.50, 0.31, 0.16], Some(wood))),
            dark_wood: add(opaque("dark wood", [0.30, 0.18, 0.10], Some(wood))),
            roof: add(opaque("roof tiles", [0.62, 0.28, 0.16], Some(stone))),
            pottery: add(opaque("pottery", [0.66, 0.33, 0.18], Some(stone))),
            glaze: add(opaque("blue glaze", [0.07, 0.22, 0.46], Some(stone))),
            bronze: add(opaque("bronze", [0.36, 0.24, 0.11], None)),
            water: add(opaque("water", [0.07, 0.20, 0.21], None)),
            soil: add(opaque("soil", [0.11, 0.07, 0.045], None)),
            bark: add(opaque("bark", [0.26, 0.18, 0.11], Some(stone))),
            orange: add(opaque("orange", [0.90, 0.36, 0.03], None)),
            red: add(opaque("red cloth", [0.78, 0.045, 0.04], Some(weave))),
            green: add(opaque("green cloth", [0.06, 0.42, 0.13], Some(weave))),
            blue: add(opaque("blue cloth", [0.05, 0.15, 0.62], Some(weave))),
            striped: add(opaque("striped cloth", [1.0; 3], Some(stripes))),
            banner: add(opaque("banner cloth", [1.0; 3], Some(banner))),
            paper: add(opaque("paper", [0.82, 0.77, 0.64], None)),
            terracotta: add(rough(opaque("terracotta plaster", [0.66, 0.15, 0.075], Some(plaster)))),
            ochre: add(rough(opaque("ochre plaster", [0.86, 0.63, 0.34], Some(plaster)))),
            leaf: add(leafy(opaque("leaf", [1.0; 3], Some(leaf)))),
        }
    }
}

fn opaque(name: &str, colour: [f32; 3], texture: Option<TextureRef>) -> Material {
    Material {
        name: name.to_owned(),
        base_color: Vec3::from(colour).extend(1.0),
        base_color_texture: texture,
        ..Material::default()
    }
}
