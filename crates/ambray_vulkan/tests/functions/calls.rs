//! Calls of GLSL functions, and their values.

use std::sync::Arc;

use ambray_core::{
    camera::{Camera, Projection},
    control::Control,
    settings::Settings,
    view::View,
};
use ambray_scene::Scene;
use ambray_vulkan::{
    DeviceKind, VulkanBackend, VulkanOptions,
    layout::{ARGUMENTS, FAR},
    testing::Functions,
};
use glam::{Vec3, Vec4};

use crate::common;

/// A scene on a device, whose functions are called.
pub(crate) struct Device {
    backend: VulkanBackend,
}

/// Arguments of a call, written one after the other.
#[derive(Clone, Copy, Default)]
pub(crate) struct Call {
    words: [u32; ARGUMENTS as usize],
    used: usize,
}

/// Values of a call.
#[derive(Clone, Copy)]
pub(crate) struct Values([u32; 8]);

impl Device {
    /// `None` where there is no Vulkan.
    pub(crate) fn open(scene: Scene) -> Option<Self> {
        let context = common::context()?;
        let scene = Arc::new(scene);
        let backend = VulkanBackend::new(&context, &scene, VulkanOptions::default(), &Control::default());
        Some(Self { backend: backend.unwrap_or_else(|error| panic!("{error}")) })
    }

    /// Whether the device rounds ÷ and square roots as the standard says, as all processors do.
    pub(crate) fn is_exact(&self) -> bool {
        self.backend.context().report().kind == DeviceKind::Software
    }

    /// The functions as they are compiled for `settings`.
    pub(crate) fn functions(&self, settings: &Settings) -> Compiled<'_> {
        Compiled(Functions::new(&self.backend, settings).unwrap_or_else(|error| panic!("{error}")), self)
    }
}

/// Functions of a [`Device`].
pub(crate) struct Compiled<'a>(Functions<'a>, &'a Device);

impl Compiled<'_> {
    pub(crate) fn call(&self, function: u32, view: &View, calls: &[Call]) -> Vec<Values> {
        let words: Vec<_> = calls.iter().map(|call| call.words).collect();
        let values = self.0.call(function, view, &words).unwrap_or_else(|error| panic!("{error}"));
        common::assert_valid(self.1.backend.context());
        values.into_iter().map(Values).collect()
    }
}

impl Call {
    pub(crate) fn word(mut self, word: u32) -> Self {
        self.words[self.used] = word;
        self.used += 1;
        self
    }

    /// A length may be infinite: shaders see [`FAR`].
    pub(crate) fn number(self, number: f32) -> Self {
        self.word(if number == f32::INFINITY { FAR } else { number }.to_bits())
    }

    pub(crate) fn vector(self, v: Vec3) -> Self {
        self.number(v.x).number(v.y).number(v.z)
    }

    pub(crate) fn vector4(self, v: Vec4) -> Self {
        self.vector(v.truncate()).number(v.w)
    }
}

impl Values {
    pub(crate) fn word(&self, i: usize) -> u32 {
        self.0[i]
    }

    pub(crate) fn number(&self, i: usize) -> f32 {
        f32::from_bits(self.0[i])
    }

    pub(crate) fn vector(&self, i: usize) -> Vec3 {
        Vec3::new(self.number(i), self.number(i + 1), self.number(i + 2))
    }

    pub(crate) fn vector4(&self, i: usize) -> Vec4 {
        self.vector(i).extend(self.number(i + 3))
    }
}

/// A view, for functions of the defaults.
pub(crate) fn view() -> View {
    let projection = Projection::Perspective { vertical_fov: 1.0 };
    View::new(Camera::new(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, projection, 4, 4), 1.0)
}
