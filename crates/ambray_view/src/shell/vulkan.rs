//! Draws with Vulkan, on the device that renders: pictures never leave it.

use std::sync::Arc;

use ambray::{
    BackendChoice, Device, RendererOptions,
    vulkan::{
        Context, DeviceOptions, VulkanError,
        window::{Corner, Filter, Mesh, Painting as Triangles, Sampling, Screen, Upload},
    },
};
use anyhow::Context as _;
use egui::{ClippedPrimitive, ImageData, TextureFilter, TextureId, TexturesDelta, epaint::Primitive};
use winit::{
    dpi::PhysicalSize,
    event_loop::ActiveEventLoop,
    window::{Window, WindowAttributes},
};

use super::{
    pictures::DevicePictures,
    present::{Painting, Presenter},
};
use crate::{canvas::Scaling, engine::Pixels};

/// A window that Vulkan draws into.
#[derive(Debug)]
pub(super) struct Vulkan {
    screen: Screen,
    pictures: DevicePictures,
    device: Device,
}

/// The device that `options` mean.
pub(super) fn wanted(options: &RendererOptions) -> DeviceOptions {
    // A device that is really the processor is slower than the CPU backend, but better than an error.
    let software = options.device.software || options.backend == BackendChoice::Vulkan;
    DeviceOptions { software, ..options.device.clone() }
}

impl Vulkan {
    /// Opens a window with `attributes`, and the device that `options` mean to draw into it.
    pub(super) fn open(
        event_loop: &ActiveEventLoop,
        attributes: WindowAttributes,
        options: &RendererOptions,
    ) -> anyhow::Result<(Arc<Window>, Self)> {
        let window = Arc::new(event_loop.create_window(attributes).context("the window")?);
        let context = Context::for_window(&wanted(options), Arc::clone(&window) as _)?;
        let screen = Screen::new(&context, window.inner_size().into())?;
        let pictures = DevicePictures::default();
        Ok((window, Self { screen, pictures, device: Device::of(context) }))
    }

    /// The device that draws.
    pub(super) const fn device(&self) -> &Device {
        &self.device
    }

    /// The pictures that it draws.
    pub(super) const fn pictures(&self) -> &DevicePictures {
        &self.pictures
    }

    /// Brings the textures up to date.
    fn update(&mut self, textures: &mut TexturesDelta) -> Result<(), VulkanError> {
        // Taken at once: what is left of them where this fails is nobody's.
        let (set, free) = (std::mem::take(&mut textures.set), std::mem::take(&mut textures.free));
        for (id, deltas) in set {
            for delta in deltas {
                let ImageData::Color(image) = &delta.image;
                let whole = |at: [usize; 2]| at.map(|side| side as u32);
                if image.pixels.is_empty() {
                    continue;
                }
                let (magnified, minified) =
                    (filter(delta.options.magnification), filter(delta.options.minification));
                let upload = Upload {
                    at: delta.pos.map(whole),
                    size: whole(image.size),
                    rgba: image.as_raw(),
                    sampling: Sampling { magnified, minified },
                };
                self.screen.upload(number(id), &upload)?;
            }
        }
        for id in free {
            self.screen.forget(number(id));
        }
        let screen = &mut self.screen;
        for entry in self.pictures.of_frame(|gone| screen.forget(number(TextureId::User(gone)))) {
            let texture = number(TextureId::User(entry.number));
            if !screen.has(texture) {
                let filter = if entry.scaling == Scaling::Exact { Filter::Nearest } else { Filter::Linear };
                let sampling = Sampling { magnified: filter, minified: filter };
                screen.adopt(texture, entry.picture, sampling)?;
            }
        }
        Ok(())
    }
}

impl Presenter for Vulkan {
    fn max_texture_side(&self) -> usize {
        self.screen.max_texture_side() as usize
    }

    fn resize(&mut self, size: PhysicalSize<u32>) {
        self.screen.resize(size.into());
    }

    fn paint(&mut self, window: &Window, mut painting: Painting) -> anyhow::Result<Option<Pixels>> {
        self.update(&mut painting.textures)?;
        let size = window.inner_size();
        let triangles = triangles(&painting.primitives, painting.pixels_per_point, size);
        self.screen.resize(size.into());
        window.pre_present_notify();
        let copy = self.screen.paint(&triangles, painting.wants_copy)?;
        Ok(copy.map(|copy| Pixels { width: copy.size[0], height: copy.size[1], rgba: copy.rgba }))
    }
}

/// Egui's triangles as the screen takes them.
fn triangles(primitives: &[ClippedPrimitive], scale: f32, size: PhysicalSize<u32>) -> Triangles {
    let mut all =
        Triangles { size: [size.width as f32 / scale, size.height as f32 / scale], ..Triangles::default() };
    for ClippedPrimitive { clip_rect, primitive } in primitives {
        // Callbacks of OpenGL and others are not for us.
        let Primitive::Mesh(mesh) = primitive else { continue };
        let pixel = |at: f32, most: u32| (at * scale).round().clamp(0.0, most as f32) as u32;
        let (left, top) = (pixel(clip_rect.min.x, size.width), pixel(clip_rect.min.y, size.height));
        let (right, bottom) = (pixel(clip_rect.max.x, size.width), pixel(clip_rect.max.y, size.height));
        let first = all.indices.len() as u32;
        all.indices.extend_from_slice(&mesh.indices);
        all.meshes.push(Mesh {
            clip: [left, top, right.saturating_sub(left), bottom.saturating_sub(top)],
            texture: number(mesh.texture_id),
            indices: first..all.indices.len() as u32,
            first_corner: all.corners.len() as u32,
        });
        all.corners.extend(mesh.vertices.iter().map(|vertex| Corner {
            position: vertex.pos.into(),
            uv: vertex.uv.into(),
            colour: vertex.color.to_array(),
        }));
    }
    all
}

/// The number of a texture: egui's own and those of pictures are counted apart.
const fn number(id: TextureId) -> u64 {
    match id {
        TextureId::Managed(number) => 2 * number,
        TextureId::User(number) => 2 * number + 1,
    }
}

const fn filter(filter: TextureFilter) -> Filter {
    match filter {
        TextureFilter::Nearest => Filter::Nearest,
        TextureFilter::Linear => Filter::Linear,
    }
}

#[cfg(test)]
mod tests {
    use egui::{Color32, Mesh as EguiMesh, Rect, pos2};

    use super::*;

    #[test]
    fn meshes_follow_each_other_in_one_list() {
        let mesh = |texture, x: f32| {
            let mut mesh = EguiMesh::with_texture(texture);
            let corner = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            mesh.add_rect_with_uv(corner.translate(egui::vec2(x, 0.0)), corner, Color32::WHITE);
            let clip_rect = Rect::from_min_max(pos2(-5.0, 0.25), pos2(10.2, 500.0));
            ClippedPrimitive { clip_rect, primitive: Primitive::Mesh(mesh) }
        };
        let primitives = [mesh(TextureId::Managed(3), 0.0), mesh(TextureId::User(3), 7.0)];
        let all = triangles(&primitives, 2.0, PhysicalSize::new(100, 60));
        assert_eq!((all.corners.len(), all.indices.len()), (8, 12));
        assert_eq!(all.size, [50.0, 30.0]);
        assert_eq!(all.meshes[0].clip, [0, 1, 20, 59]);
        assert_eq!((all.meshes[0].texture, all.meshes[1].texture), (6, 7));
        assert_eq!((all.meshes[1].indices.clone(), all.meshes[1].first_corner), (6..12, 4));
        assert_eq!(all.corners[4].position, [7.0, 0.0]);
    }
}
