//! Accessors to plain vectors. Every byte is reached through checked slices, so no file can make this panic.

use std::ops::Range;

use crate::error::{Fault, Outcome, quoted};

use super::document::{Document, missing, slice};
use super::json::{Accessor, Index, Sparse};

/// Elements without any stored data that one accessor may claim.
const MOST_ZEROS: u64 = 1 << 24;
/// glTF 2.0 allows 4 to 252; files of the wild have more, and reading them harms nobody.
const LARGEST_STRIDE: u64 = 1 << 16;

/// Scalar type of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn parse(code: u32, at: &str) -> Outcome<Self> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(Fault::invalid(format!("{at}.componentType"), format!("no such type: {code}"))),
        })
    }

    const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// What an attribute may be stored as.
#[derive(Clone, Copy, Debug)]
pub(super) enum Accept {
    /// Floats only.
    Float,
    /// Floats or normalised integers.
    FloatOrNormalized,
    /// Any of 8 and 16 bits, normalised or not, or floats (KHR_mesh_quantization).
    Quantized,
    /// Unsigned integers of 8 and 16 bits, kept as they are.
    Unsigned,
}

impl Accept {
    fn allows(self, component: Component, normalized: bool) -> bool {
        let small = component.size() < 4;
        match self {
            Self::Float => component == Component::F32,
            Self::FloatOrNormalized => component == Component::F32 || (normalized && small),
            Self::Quantized => component == Component::F32 || small,
            Self::Unsigned => matches!(component, Component::U8 | Component::U16) && !normalized,
        }
    }
}

impl Document<'_> {
    /// Number of elements of accessor `index`, not yet trusted.
    pub(super) fn count(&self, index: Index, at: &str) -> Outcome<u64> {
        self.root.accessors.get(index).map(|a| a.count).ok_or_else(|| missing(at, "accessor", index))
    }

    /// Accessor `index` as vectors of `N` numbers; normalised integers become `[0, 1]` or `[-1, 1]`.
    pub(super) fn read<const N: usize>(
        &self,
        index: Index,
        accept: Accept,
        at: &str,
    ) -> Outcome<Vec<[f32; N]>> {
        self.read_range(index, accept, 0..self.count(index, at)?, at)
    }

    /// The elements `range` of accessor `index`, which must have them.
    pub(super) fn read_range<const N: usize>(
        &self,
        index: Index,
        accept: Accept,
        range: Range<u64>,
        at: &str,
    ) -> Outcome<Vec<[f32; N]>> {
        let accessor = self.root.accessors.get(index).ok_or_else(|| missing(at, "accessor", index))?;
        let place = format!("accessors[{index}]");
        let component = Component::parse(accessor.component_type, &place)?;
        expect_shape(accessor, N, &place)?;
        if accessor.normalized && component == Component::F32 {
            return Err(Fault::invalid(format!("{place}.normalized"), "floats cannot be normalised"));
        }
        if !accept.allows(component, accessor.normalized) {
            let normalized = if accessor.normalized { "normalised " } else { "" };
            let reason = format!("{normalized}{component:?} is not allowed for {at}");
            return Err(Fault::invalid(format!("{place}.componentType"), reason));
        }
        self.elements(accessor, component, range, [0.0; N], &place, |bytes| {
            floats(bytes, component, accessor.normalized)
        })
    }

    /// Accessor `index` as unsigned scalars: indices.
    pub(super) fn read_indices(&self, index: Index, at: &str) -> Outcome<Vec<u32>> {
        let accessor = self.root.accessors.get(index).ok_or_else(|| missing(at, "accessor", index))?;
        let place = format!("accessors[{index}]");
        let component = Component::parse(accessor.component_type, &place)?;
        expect_shape(accessor, 1, &place)?;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) || accessor.normalized {
            let reason = format!("indices must be unsigned integers, not {component:?}");
            return Err(Fault::invalid(format!("{place}.componentType"), reason));
        }
        self.elements(accessor, component, 0..accessor.count, 0, &place, |bytes| unsigned(bytes, component))
    }

    /// Decodes the elements `range`: the dense part, or zeros, then the sparse replacements.
    fn elements<T: Clone>(
        &self,
        accessor: &Accessor,
        component: Component,
        range: Range<u64>,
        zero: T,
        at: &str,
        decode: impl Fn(&[u8]) -> T,
    ) -> Outcome<Vec<T>> {
        let size = element_size(accessor, component);
        debug_assert!(range.start <= range.end && range.end <= accessor.count, "callers check the count");
        let count = range.end - range.start;
        self.reserve(count.saturating_mul(size_of::<T>() as u64), &format!("{at}.count"))?;
        let mut elements = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.strided(accessor, view, size, at)?;
                let elements = bytes.chunks(stride).skip(range.start as usize).take(count as usize);
                elements.map(|element| decode(&element[..size as usize])).collect()
            }
            None if count <= MOST_ZEROS => vec![zero; count as usize],
            None => {
                let reason = format!("{count} elements without a buffer view");
                return Err(Fault::too_large(format!("{at}.count"), reason));
            }
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(
                &mut elements,
                range,
                accessor.count,
                sparse,
                size,
                &format!("{at}.sparse"),
                decode,
            )?;
        }
        Ok(elements)
    }

    /// The bytes from the accessor's first element to its last, and their stride.
    fn strided(&self, accessor: &Accessor, view: Index, size: u64, at: &str) -> Outcome<(&[u8], usize)> {
        let bytes = self.view(view, &format!("{at}.bufferView"))?;
        let stride = self.root.buffer_views[view].byte_stride.unwrap_or(size);
        if stride < size {
            let reason = format!("{stride} bytes for elements of {size} bytes");
            return Err(Fault::invalid(format!("bufferViews[{view}].byteStride"), reason));
        }
        if stride > LARGEST_STRIDE {
            let reason = format!("{stride} bytes, at most {LARGEST_STRIDE} are allowed");
            return Err(Fault::invalid(format!("bufferViews[{view}].byteStride"), reason));
        }
        let Some(last) = accessor.count.checked_sub(1) else { return Ok((&[], stride as usize)) };
        // The last element needs no padding up to the stride.
        let length = last.checked_mul(stride).and_then(|length| length.checked_add(size));
        let data = length.and_then(|length| slice(bytes, accessor.byte_offset, length)).ok_or_else(|| {
            let length = u128::from(last) * u128::from(stride) + u128::from(size);
            let end = u128::from(accessor.byte_offset) + length;
            Fault::invalid(at, format!("ends at byte {end} of a {}-byte view", bytes.len()))
        })?;
        Ok((data, stride as usize))
    }

    /// Applies the sparse replacements to `elements`, which are those of `range` out of `total`.
    #[expect(clippy::too_many_arguments, reason = "one step of `elements`, split off for its length")]
    fn replace<T>(
        &self,
        elements: &mut [T],
        range: Range<u64>,
        total: u64,
        sparse: &Sparse,
        size: u64,
        at: &str,
        decode: impl Fn(&[u8]) -> T,
    ) -> Outcome<()> {
        if sparse.count > total {
            let reason = format!("{} replacements of {total} elements", sparse.count);
            return Err(Fault::invalid(format!("{at}.count"), reason));
        }
        let component = Component::parse(sparse.indices.component_type, &format!("{at}.indices"))?;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) {
            let place = format!("{at}.indices.componentType");
            return Err(Fault::invalid(place, "indices must be unsigned integers"));
        }
        let part = |view: Index, offset: u64, size: u64, at: String| {
            let bytes = self.view(view, &at)?;
            let length = sparse.count.checked_mul(size);
            length.and_then(|length| slice(bytes, offset, length)).ok_or_else(|| {
                let end = u128::from(offset) + u128::from(sparse.count) * u128::from(size);
                Fault::invalid(at, format!("ends at byte {end} of a {}-byte view", bytes.len()))
            })
        };
        let (indices, values) = (&sparse.indices, &sparse.values);
        let index_size = component.size();
        let index_bytes =
            part(indices.buffer_view, indices.byte_offset, index_size as u64, format!("{at}.indices"))?;
        let value_bytes = part(values.buffer_view, values.byte_offset, size, format!("{at}.values"))?;
        for (index, value) in
            index_bytes.chunks_exact(index_size).zip(value_bytes.chunks_exact(size as usize))
        {
            let index = u64::from(unsigned(index, component));
            if index >= total {
                let reason = format!("index {index} of {total} elements");
                return Err(Fault::invalid(format!("{at}.indices"), reason));
            }
            if range.contains(&index) {
                elements[(index - range.start) as usize] = decode(value);
            }
        }
        Ok(())
    }
}

/// Numbers in an element of this shape.
fn shape_len(shape: &str) -> Option<usize> {
    Some(match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => return None,
    })
}

fn expect_shape(accessor: &Accessor, len: usize, at: &str) -> Outcome<()> {
    // VEC4 and MAT2 both hold four numbers; matrices of 2 and 3 rows have no use in what we read.
    if shape_len(&accessor.shape) == Some(len) {
        return Ok(());
    }
    let wanted = ["", "SCALAR", "VEC2", "VEC3", "VEC4"].get(len).unwrap_or(&"MAT4");
    Err(Fault::invalid(format!("{at}.type"), format!("{} where {wanted} is needed", quoted(&accessor.shape))))
}

/// Bytes of an element without padding; its shape has been checked.
fn element_size(accessor: &Accessor, component: Component) -> u64 {
    (shape_len(&accessor.shape).unwrap_or(1) * component.size()) as u64
}

/// One little-endian number; `bytes` has the component's size.
fn unsigned(bytes: &[u8], component: Component) -> u32 {
    match component {
        Component::U8 | Component::I8 => u32::from(bytes[0]),
        Component::U16 | Component::I16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        Component::U32 | Component::F32 => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}

/// `N` numbers; `bytes` holds as many components. Normalisation is glTF 2.0 §3.11's.
fn floats<const N: usize>(bytes: &[u8], component: Component, normalized: bool) -> [f32; N] {
    let size = component.size();
    std::array::from_fn(|i| {
        let raw = unsigned(&bytes[i * size..(i + 1) * size], component);
        match (component, normalized) {
            (Component::F32, _) => f32::from_bits(raw),
            (Component::I8, false) => f32::from(raw as u8 as i8),
            (Component::I8, true) => (f32::from(raw as u8 as i8) / 127.0).max(-1.0),
            (Component::I16, false) => f32::from(raw as u16 as i16),
            (Component::I16, true) => (f32::from(raw as u16 as i16) / 32767.0).max(-1.0),
            (Component::U8, true) => raw as f32 / 255.0,
            (Component::U16, true) => raw as f32 / 65535.0,
            (Component::U8 | Component::U16 | Component::U32, _) => raw as f32,
        }
    })
}
