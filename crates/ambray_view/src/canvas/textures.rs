//! Pictures as textures of the window.

use std::{fmt, sync::Arc};

use egui::{
    Color32, ColorImage, Context, Mesh, Painter, Pos2, Rect, TextureHandle, TextureId, TextureOptions, Vec2,
    pos2, vec2,
};

use crate::engine::{Pixels, Rendered};

/// How pixels of a picture become pixels of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scaling {
    /// As they are: at the picture's own size, or as squares.
    Exact,
    /// Blended with their neighbours: for previews, and where the picture is larger than its place.
    Smooth,
}

impl Scaling {
    const fn options(self) -> TextureOptions {
        match self {
            Self::Exact => TextureOptions::NEAREST,
            Self::Smooth => TextureOptions::LINEAR,
        }
    }
}

/// Pictures that are on a device already, as the one who draws the window knows them.
pub trait PictureTextures: fmt::Debug {
    /// The texture of a picture on the device; `None` if it is not there.
    fn texture(&mut self, rendered: &Rendered, scaling: Scaling) -> Option<TextureId>;
}

/// A picture from the memory of the processor, uploaded once.
#[derive(Debug, Default)]
pub(super) struct HostTexture {
    /// What was uploaded. It is kept, so that another picture cannot come to lie at its address.
    shown: Option<(Arc<Pixels>, Scaling)>,
    tiles: Vec<Tile>,
}

/// A part of a picture no larger than the window's textures may be.
struct Tile {
    texture: TextureHandle,
    /// Where in the picture, as shares of it.
    place: Rect,
}

impl fmt::Debug for Tile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tile").field("texture", &self.texture.id()).field("place", &self.place).finish()
    }
}

impl HostTexture {
    /// Uploads `pixels` unless they are there.
    pub(super) fn update(&mut self, ctx: &Context, name: &str, pixels: &Arc<Pixels>, scaling: Scaling) {
        let is_there = |(shown, how): &(Arc<Pixels>, Scaling)| Arc::ptr_eq(shown, pixels) && *how == scaling;
        if self.shown.as_ref().is_some_and(is_there) {
            return;
        }
        let largest = ctx.input(|input| input.max_texture_side).max(1);
        let parts = parts((pixels.width as usize, pixels.height as usize), largest);
        self.tiles.truncate(parts.len());
        for (i, &(corner, size)) in parts.iter().enumerate() {
            let image = image(pixels, corner, size);
            let whole = vec2(pixels.width as f32, pixels.height as f32);
            let vec2 = |(x, y): (usize, usize)| Vec2::new(x as f32, y as f32);
            let place = Rect::from_min_size((vec2(corner) / whole).to_pos2(), vec2(size) / whole);
            match self.tiles.get_mut(i) {
                Some(tile) => {
                    tile.texture.set(image, scaling.options());
                    tile.place = place;
                }
                None => {
                    let texture = ctx.load_texture(format!("{name} {i}"), image, scaling.options());
                    self.tiles.push(Tile { texture, place });
                }
            }
        }
        self.shown = Some((Arc::clone(pixels), scaling));
    }

    /// Draws the picture at `rect`.
    pub(super) fn paint(&self, painter: &Painter, rect: Rect) {
        for tile in &self.tiles {
            let place = |at: Pos2| rect.min + at.to_vec2() * rect.size();
            let rect = Rect::from_min_max(place(tile.place.min), place(tile.place.max));
            paint(painter, tile.texture.id(), rect);
        }
    }
}

/// Draws a texture at `rect`: as a mesh, which nothing rounds and nothing softens.
pub(super) fn paint(painter: &Painter, texture: TextureId, rect: Rect) {
    let mut mesh = Mesh::with_texture(texture);
    let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
    mesh.add_rect_with_uv(rect, whole, Color32::WHITE);
    painter.add(mesh);
}

/// Corners and sizes of the parts of a picture, none larger than `largest` a side.
fn parts((width, height): (usize, usize), largest: usize) -> Vec<((usize, usize), (usize, usize))> {
    let columns = (0..width).step_by(largest);
    let parts = columns.flat_map(|x| (0..height).step_by(largest).map(move |y| (x, y)));
    parts.map(|(x, y)| ((x, y), ((width - x).min(largest), (height - y).min(largest)))).collect()
}

/// Part of a picture, byte for byte. Pictures are opaque, so that it does not matter when alpha is multiplied.
fn image(pixels: &Pixels, (x, y): (usize, usize), (width, height): (usize, usize)) -> ColorImage {
    let row = 4 * pixels.width as usize;
    if width == pixels.width as usize {
        let rows = &pixels.rgba[y * row..(y + height) * row];
        return ColorImage::from_rgba_premultiplied([width, height], rows);
    }
    let rows = pixels.rgba.chunks_exact(row).skip(y).take(height);
    let part: Vec<u8> = rows.flat_map(|row| &row[4 * x..4 * (x + width)]).copied().collect();
    ColorImage::from_rgba_premultiplied([width, height], &part)
}

#[cfg(test)]
mod tests {
    use egui::{ImageData, RawInput};

    use super::*;

    fn pixels(width: u32, height: u32, salt: u8) -> Arc<Pixels> {
        let value = |i: u32| if i % 4 == 3 { 255 } else { (i as u8).wrapping_mul(31) ^ salt };
        Arc::new(Pixels { width, height, rgba: (0..4 * width * height).map(value).collect() })
    }

    /// Runs `show` in a frame of a window with textures up to `largest`, and gives what was uploaded.
    fn uploads(
        ctx: &Context,
        largest: usize,
        mut show: impl FnMut(&Context),
    ) -> Vec<(TextureOptions, Vec<u8>)> {
        let input = RawInput { max_texture_side: Some(largest), ..RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| show(ui.ctx()));
        let set = output.textures_delta.set.iter().filter(|&(&id, _)| id != TextureId::default());
        let mut set: Vec<_> = set.collect();
        set.sort_by_key(|&(&id, _)| id);
        let uploaded = set
            .into_iter()
            .flat_map(|(_, deltas)| deltas)
            .map(|delta| {
                let ImageData::Color(image) = &delta.image;
                (delta.options, image.as_raw().to_vec())
            })
            .collect();
        output.textures_delta.clear();
        uploaded
    }

    #[test]
    fn the_texture_has_the_bytes_of_the_picture() {
        let (ctx, mut texture) = (Context::default(), HostTexture::default());
        let picture = pixels(37, 11, 0);
        let uploaded = uploads(&ctx, 2048, |ctx| texture.update(ctx, "a", &picture, Scaling::Exact));
        assert!(uploaded == [(TextureOptions::NEAREST, picture.rgba.clone())]);
    }

    #[test]
    fn a_picture_is_uploaded_once() {
        let (ctx, mut texture) = (Context::default(), HostTexture::default());
        let (first, second) = (pixels(8, 8, 0), pixels(8, 8, 77));
        let mut count = |picture: &Arc<Pixels>, scaling| {
            uploads(&ctx, 2048, |ctx| texture.update(ctx, "a", picture, scaling)).len()
        };
        assert_eq!(count(&first, Scaling::Exact), 1);
        assert_eq!(count(&first, Scaling::Exact), 0);
        assert_eq!(count(&second, Scaling::Exact), 1);
        assert_eq!(count(&second, Scaling::Smooth), 1, "how it is scaled belongs to the texture");
        assert_eq!(count(&second, Scaling::Smooth), 0);
    }

    #[test]
    fn large_pictures_are_cut_into_parts() {
        let (ctx, mut texture) = (Context::default(), HostTexture::default());
        let picture = pixels(2100, 3, 5);
        let uploaded = uploads(&ctx, 2048, |ctx| texture.update(ctx, "a", &picture, Scaling::Exact));
        assert_eq!(uploaded.len(), 2);
        let rows = picture.rgba.chunks_exact(4 * 2100);
        let left: Vec<u8> = rows.clone().flat_map(|row| &row[..4 * 2048]).copied().collect();
        let right: Vec<u8> = rows.flat_map(|row| &row[4 * 2048..]).copied().collect();
        assert!(uploaded[0].1 == left && uploaded[1].1 == right);
        assert_eq!(texture.tiles[1].place.max, pos2(1.0, 1.0));
    }
}
