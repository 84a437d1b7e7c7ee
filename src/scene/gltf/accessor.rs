//! Accessors: typed lists in buffers, as floats or indices, with checked bounds.

use super::file::File;
use super::notes::Fault;
use gltf::json::accessor::{Accessor, ComponentType, IndexComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, buffer};

/// Most elements of one list: 32 million. An accessor without a buffer view could promise any number.
const MOST_ELEMENTS: u64 = 1 << 25;

/// The elements of an accessor of `N` components each, converted to f32; integers are scaled to 0..1 or −1..1 where
/// the accessor is normalized.
pub fn floats<const N: usize>(file: &File, index: Index<Accessor>) -> Result<Vec<[f32; N]>, Fault> {
    let accessor = get(file, index)?;
    let wanted = match N {
        1 => Type::Scalar,
        2 => Type::Vec2,
        3 => Type::Vec3,
        _ => Type::Vec4,
    };
    expect(index, accessor, &[wanted])?;
    let kind = component(index, accessor)?;
    let decode = decoder(kind, accessor.normalized);
    let size = kind.size();
    let element = |bytes: &[u8]| std::array::from_fn(|i| decode(&bytes[i * size..(i + 1) * size]));
    elements(file, index, accessor, size * N, [0.0; N], element)
}

/// The elements of an accessor of colours with or without alpha, which is 1 then.
pub fn colors(file: &File, index: Index<Accessor>) -> Result<Vec<[f32; 4]>, Fault> {
    let accessor = get(file, index)?;
    expect(index, accessor, &[Type::Vec3, Type::Vec4])?;
    match accessor.type_ {
        Checked::Valid(Type::Vec3) => {
            Ok(floats::<3>(file, index)?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
        }
        _ => floats::<4>(file, index),
    }
}

/// The elements of an accessor of unsigned integers.
pub fn indices(file: &File, index: Index<Accessor>) -> Result<Vec<u32>, Fault> {
    let accessor = get(file, index)?;
    expect(index, accessor, &[Type::Scalar])?;
    let kind = component(index, accessor)?;
    if !matches!(kind, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
        let message = format!("accessor {} holds {kind:?}; indices are U8, U16 or U32", index.value());
        return Err(Fault::new("gltf-accessor", message));
    }
    elements(file, index, accessor, kind.size(), 0, unsigned)
}

/// All elements of an accessor, `size` bytes each, as `element` reads them: from its buffer view, or else `zero`s, and
/// then those that its sparse part gives anew.
fn elements<T: Copy>(
    file: &File,
    index: Index<Accessor>,
    accessor: &Accessor,
    size: usize,
    zero: T,
    element: impl Fn(&[u8]) -> T,
) -> Result<Vec<T>, Fault> {
    let mut list: Vec<T> = match accessor.buffer_view {
        Some(view) => {
            let offset = accessor.byte_offset.unwrap_or_default().0;
            Strided::new(file, view, offset, size, accessor.count.0)?.iter().map(&element).collect()
        }
        None => vec![zero; count(accessor.count.0)?],
    };
    if let Some(sparse) = &accessor.sparse {
        let IndexComponentType(kind) = valid(&sparse.indices.component_type, index, "componentType")?;
        let (places, values) = (&sparse.indices, &sparse.values);
        let (first, number) = (places.byte_offset.0, sparse.count.0);
        let places = Strided::packed(file, places.buffer_view, first, kind.size(), number)?;
        let values = Strided::packed(file, values.buffer_view, values.byte_offset.0, size, number)?;
        for (place, value) in places.iter().zip(values.iter()) {
            let place = unsigned(place) as usize;
            let length = list.len();
            let slot =
                list.get_mut(place).ok_or_else(|| Fault::beyond("(as sparse) element", place, length))?;
            *slot = element(value);
        }
    }
    Ok(list)
}

fn get(file: &File, index: Index<Accessor>) -> Result<&Accessor, Fault> {
    /// Bytes that an element becomes while it turns from a list into vertices or corners.
    const ELEMENT: u64 = 256;
    let accessors = &file.root.accessors;
    let accessor = accessors.get(index.value());
    let accessor = accessor.ok_or_else(|| Fault::beyond("accessor", index.value(), accessors.len()))?;
    file.budget.pass(accessor.count.0.saturating_mul(ELEMENT))?;
    Ok(accessor)
}

fn valid<'a, T>(checked: &'a Checked<T>, index: Index<Accessor>, field: &str) -> Result<&'a T, Fault> {
    match checked {
        Checked::Valid(value) => Ok(value),
        Checked::Invalid => {
            let message = format!("accessor {} has a {field} that glTF doesn't know", index.value());
            Err(Fault::new("gltf-accessor", message))
        }
    }
}

fn component(index: Index<Accessor>, accessor: &Accessor) -> Result<ComponentType, Fault> {
    valid(&accessor.component_type, index, "componentType").map(|kind| kind.0)
}

fn expect(index: Index<Accessor>, accessor: &Accessor, wanted: &[Type]) -> Result<(), Fault> {
    let found = *valid(&accessor.type_, index, "type")?;
    if wanted.contains(&found) {
        return Ok(());
    }
    let message = format!("accessor {} holds {found:?}, but {wanted:?} is needed", index.value());
    Err(Fault::new("gltf-accessor", message))
}

fn count(count: u64) -> Result<usize, Fault> {
    if count <= MOST_ELEMENTS {
        return Ok(count as usize);
    }
    Err(Fault::new("gltf-size", format!("{count} elements are more than the {MOST_ELEMENTS} that are read")))
}

/// Reads one component from exactly as many bytes as it has.
fn decoder(kind: ComponentType, normalized: bool) -> impl Fn(&[u8]) -> f32 {
    let scale = match kind {
        _ if !normalized => 1.0,
        ComponentType::I8 => 127.0,
        ComponentType::U8 => 255.0,
        ComponentType::I16 => 32767.0,
        ComponentType::U16 => 65535.0,
        ComponentType::U32 | ComponentType::F32 => 1.0,
    };
    let least = if normalized { -1.0 } else { f32::NEG_INFINITY };
    move |bytes| {
        let word = unsigned(bytes);
        match kind {
            ComponentType::F32 => f32::from_bits(word),
            ComponentType::I8 => (f32::from(word as u8 as i8) / scale).max(least),
            ComponentType::I16 => (f32::from(word as u16 as i16) / scale).max(least),
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => word as f32 / scale,
        }
    }
}

/// A little-endian number of 1, 2 or 4 bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    match *bytes {
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
        [a, b] => u32::from(u16::from_le_bytes([a, b])),
        [a, ..] => u32::from(a),
        [] => 0,
    }
}

/// Elements of `size` bytes, `stride` apart; `data` ends with the last of them.
struct Strided<'a> {
    data: &'a [u8],
    size: usize,
    stride: usize,
}

impl<'a> Strided<'a> {
    /// With the buffer view's own stride, if it has one.
    fn new(
        file: &'a File,
        view: Index<buffer::View>,
        offset: u64,
        size: usize,
        count: u64,
    ) -> Result<Self, Fault> {
        let stride = file.root.buffer_views.get(view.value()).and_then(|view| view.byte_stride);
        let stride = stride.map_or(size, |stride| stride.0);
        if stride < size {
            let message =
                format!("buffer view {} steps by {stride} bytes over elements of {size}", view.value());
            return Err(Fault::new("gltf-accessor", message));
        }
        Self::checked(file, view, offset, size, stride, count)
    }

    fn packed(
        file: &'a File,
        view: Index<buffer::View>,
        offset: u64,
        size: usize,
        count: u64,
    ) -> Result<Self, Fault> {
        Self::checked(file, view, offset, size, size, count)
    }

    fn checked(
        file: &'a File,
        view: Index<buffer::View>,
        offset: u64,
        size: usize,
        stride: usize,
        elements: u64,
    ) -> Result<Self, Fault> {
        let elements = count(elements)? as u64;
        let gaps = elements.saturating_sub(1).saturating_mul(stride as u64);
        let length = if elements == 0 { 0 } else { gaps.saturating_add(size as u64) };
        Ok(Self { data: file.slice(view, offset, length)?, size, stride })
    }

    fn iter(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let size = self.size;
        self.data.chunks(self.stride).filter_map(move |chunk| chunk.get(..size))
    }
}
