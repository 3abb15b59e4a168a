//! Frames that stay on the device that renders them.

use std::sync::Arc;

use ambray::{DeviceFrame, RenderError, Renderer, vulkan::VulkanBackend};

use super::{
    contract::{Content, Event, Order, Rendered},
    gallery::{Gallery, Look, Shot},
    outbox::Outbox,
    plan::Step,
};
use crate::model::Side;

/// The frame that the device has rendered last; it keeps no other.
#[derive(Debug)]
struct Drawing {
    step: Step,
    frame: DeviceFrame,
    /// How it was shown last.
    look: Option<Look>,
    is_copied: bool,
}

/// What is on the device.
#[derive(Debug, Default)]
pub(super) struct Easel {
    drawing: Option<Drawing>,
    looks: [Option<Look>; 2],
}

impl Easel {
    /// The side whose picture is on the device.
    pub(super) fn side(&self) -> Option<Side> {
        self.drawing.as_ref().map(|drawing| drawing.step.side)
    }

    /// Whether the planes of the picture are on the device alone.
    pub(super) fn is_uncopied(&self, side: Side) -> bool {
        self.drawing.as_ref().is_some_and(|drawing| drawing.step.side == side && !drawing.is_copied)
    }

    /// Nothing on the device can be shown any more.
    pub(super) fn clear(&mut self) {
        self.drawing = None;
    }

    /// Pictures are shown as `order` says from now on.
    pub(super) fn look(&mut self, order: &Order) {
        self.looks = Side::ALL.map(|side| Look::of(order, side));
    }

    /// Takes a new frame.
    pub(super) fn take(&mut self, step: &Step, frame: DeviceFrame) {
        self.drawing = Some(Drawing { step: step.clone(), frame, look: None, is_copied: false });
    }

    /// Shows the frame, unless it is shown already as it should be.
    pub(super) fn show(&mut self, renderer: &mut Renderer, outbox: &Outbox) -> Result<(), RenderError> {
        let Some(drawing) = &mut self.drawing else { return Ok(()) };
        let Some(look) = &self.looks[drawing.step.side as usize] else { return Ok(()) };
        if drawing.look.as_ref().is_some_and(|shown| shown.is_same(look)) {
            return Ok(());
        }
        let Step { side, settings, level, frames, .. } = &drawing.step;
        let settings = look.over(settings);
        let picture = renderer.show(look.aov, &settings)?;
        let pixels = u64::from(settings.size.width) * u64::from(settings.size.height);
        outbox.send(Event::Picture(Box::new(Rendered {
            side: *side,
            settings,
            aov: look.aov,
            view: drawing.frame.view.clone(),
            machine: renderer.machine(),
            level: *level,
            frames: *frames,
            stats: drawing.frame.stats,
            frame_bytes: VulkanBackend::bytes_per_pixel() * pixels,
            content: Content::Device { picture, frame: None },
            statistics: None,
        })));
        drawing.look = Some(look.clone());
        Ok(())
    }

    /// Copies the planes of the frame to the host, where they are inspected, counted and compared.
    pub(super) fn copy(&mut self, renderer: &mut Renderer, gallery: &Gallery) -> Result<(), RenderError> {
        let Some(drawing) = self.drawing.as_mut().filter(|drawing| !drawing.is_copied) else { return Ok(()) };
        // Also where it fails: there is nothing that could go better the next time.
        drawing.is_copied = true;
        let frame = Arc::new(renderer.read_frame()?);
        let Step { side, settings, level, frames, .. } = drawing.step.clone();
        let machine = renderer.machine();
        gallery.hang(Shot { side, settings, machine, level, frames, frame }, true);
        Ok(())
    }
}
