//! Bounds on what a file may make us read, allocate or loop over. Exceeding one is [`LoadError::TooLarge`](crate::LoadError::TooLarge).
//!
//! They sit far above real scenes and below what exhausts a workstation; each is checked before the allocation it guards.

/// Bytes of one file, and of all files of a scene together.
pub const FILE_BYTES: u64 = 4 << 30;
/// Bytes of the JSON part of a glTF file.
pub const JSON_BYTES: u64 = 256 << 20;
/// Nesting of the JSON part of a glTF file.
pub const JSON_DEPTH: usize = 128;
/// Bytes of vertex data that may be decoded whatever the size of the files.
pub const DECODED_BYTES_BASE: u64 = 64 << 20;
/// Bytes of vertex data that may be decoded for each byte of file: files can refer to the same bytes many times.
pub const DECODED_BYTES_PER_BYTE: u64 = 128;
/// Bytes of vertex data that may be decoded in any case.
pub const DECODED_BYTES: u64 = 8 << 30;
/// Instances of a scene.
pub const INSTANCES: u64 = 1 << 22;
/// Triangles of a scene, instances counted each time.
pub const TRIANGLES: u64 = 1 << 32;
/// Width and height of an image in texels.
pub const IMAGE_SIDE: u32 = 16384;
/// Texels of all images of a scene together, mip levels not counted. An image used as colour and as normal map counts twice.
pub const TEXELS: u64 = 1 << 29;
/// Morph targets of a primitive.
pub const MORPH_TARGETS: usize = 4096;
/// Channels of all animations together.
pub const CHANNELS: u64 = 1 << 20;
/// Samples of a signed-distance field.
pub const FIELD_SAMPLES: u64 = 1 << 28;
/// Radii, heights and edges of shapes in their own units: squares and quotients of them stay normal numbers.
pub const SHAPE_SIZES: std::ops::RangeInclusive<f32> = 1e-6..=1e9;
