//! Pictures that stay on the device, as textures of the window.

use std::{cell::RefCell, rc::Rc, sync::Arc};

use ambray::vulkan::Picture;
use egui::TextureId;

use crate::{
    canvas::{PictureTextures, Scaling},
    engine::{Content, Rendered},
};

/// The pictures that the canvas draws; clones share them.
#[derive(Clone, Debug, Default)]
pub(super) struct DevicePictures(Rc<RefCell<Known>>);

#[derive(Debug, Default)]
struct Known {
    pictures: Vec<Entry>,
    /// Number of the next one.
    next: u64,
}

/// A picture that was drawn.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) picture: Arc<Picture>,
    pub(super) scaling: Scaling,
    /// Its texture is `TextureId::User` of this.
    pub(super) number: u64,
    is_used: bool,
}

impl DevicePictures {
    /// The pictures that are drawn in this frame; those that are not are let go, and told to `forget`.
    pub(super) fn of_frame(&self, mut forget: impl FnMut(u64)) -> Vec<Entry> {
        let mut known = self.0.borrow_mut();
        known.pictures.retain(|entry| {
            if !entry.is_used {
                forget(entry.number);
            }
            entry.is_used
        });
        let drawn = known.pictures.clone();
        for entry in &mut known.pictures {
            entry.is_used = false;
        }
        drawn
    }
}

impl PictureTextures for DevicePictures {
    fn texture(&mut self, rendered: &Rendered, scaling: Scaling) -> Option<TextureId> {
        let Content::Device { picture, .. } = &rendered.content else { return None };
        let mut known = self.0.borrow_mut();
        let is_it = |entry: &&mut Entry| Arc::ptr_eq(&entry.picture, picture) && entry.scaling == scaling;
        if let Some(entry) = known.pictures.iter_mut().find(is_it) {
            entry.is_used = true;
            return Some(TextureId::User(entry.number));
        }
        let number = known.next;
        known.next += 1;
        known.pictures.push(Entry { picture: Arc::clone(picture), scaling, number, is_used: true });
        Some(TextureId::User(number))
    }
}
