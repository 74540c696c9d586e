//! Access to the data of glTF accessors, with all bounds checked.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;
use std::rc::Rc;

use base64::Engine as _;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::buffer::View;
use gltf::{Accessor, Document};

use super::error::{Fault, MAX_NAME_CHARS, excerpt};
use super::limits::{check, read_companion};
use crate::files::{stays_inside, with_separators};

/// Most points of an accessor without data, which are zero unless they are replaced: they take memory, but no bytes of
/// the file.
const MAX_ZEROS: usize = 1 << 20;

/// Padding is optional, because exporters differ.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Most bytes of all buffers of a file together.
const MAX_BYTES: usize = 2 << 30;

/// The bytes of all buffers.
pub(super) struct Buffers<'a> {
    /// The binary chunk of a GLB file.
    chunk: Option<&'a [u8]>,
    /// One entry per buffer; `None` for the one that is the binary chunk.
    loaded: Vec<Option<Rc<Vec<u8>>>>,
    /// Whether positions may be integers.
    is_quantized: bool,
}

/// The extension that allows integer positions.
const QUANTIZED: &str = "KHR_mesh_quantization";

impl<'a> Buffers<'a> {
    /// Loads all buffers, including those in other files, which must lie in `folder` or below it.
    pub(super) fn load(
        document: &Document,
        chunk: Option<&'a [u8]>,
        folder: &Path,
    ) -> Result<Self, Fault> {
        let mut loaded = Vec::new();
        let mut total = 0;
        // A buffer that is named a thousand times is loaded once.
        let mut known: HashMap<&str, Rc<Vec<u8>>> = HashMap::new();
        for buffer in document.buffers() {
            let bytes = match buffer.source() {
                Source::Bin => None,
                Source::Uri(uri) => Some(match known.entry(uri) {
                    Entry::Occupied(known) => Rc::clone(known.get()),
                    Entry::Vacant(vacant) => {
                        let bytes = Rc::new(read_uri(uri, folder)?);
                        total += bytes.len();
                        Rc::clone(vacant.insert(bytes))
                    }
                }),
            };
            check("bytes in its buffers", total, MAX_BYTES)?;
            loaded.push(bytes);
        }
        let mut extensions = document.extensions_used();
        Ok(Self {
            chunk,
            loaded,
            is_quantized: extensions.any(|name| name == QUANTIZED),
        })
    }

    /// Reads a point per item, including sparse replacements.
    pub(super) fn positions(&self, accessor: &Accessor) -> Result<Vec<[f32; 3]>, Fault> {
        let is_float = accessor.data_type() == DataType::F32;
        if accessor.dimensions() != Dimensions::Vec3 || !(is_float || self.is_quantized) {
            let why = "holds positions that are not three floats each";
            return Err(accessor_fault(accessor, why));
        }
        let mut points = if accessor.view().is_some() {
            self.numbers(accessor)?
        } else {
            // Zeros, some of which are replaced: "glTF 2.0 specification", 3.6.2.3.
            check("points without data", accessor.count(), MAX_ZEROS)?;
            vec![[0.0; 3]; accessor.count()]
        };
        let Some(sparse) = accessor.sparse() else {
            return Ok(points);
        };
        let (indices, values) = (sparse.indices(), sparse.values());
        if sparse.count() > points.len() {
            let (count, available) = (sparse.count(), points.len());
            let why = format!("replaces {count} points, but has only {available}");
            return Err(accessor_fault(accessor, why));
        }
        let size = indices.index_type().size();
        let slots = (indices.offset(), size, sparse.count());
        let indices = self.slices(&indices.view(), slots, accessor.index())?;
        let slots = (values.offset(), accessor.size(), sparse.count());
        let values = self.slices(&values.view(), slots, accessor.index())?;
        for (index, value) in indices.zip(values) {
            let index = read_uint(index) as usize;
            let Some(point) = points.get_mut(index) else {
                let why = format!("replaces point {index}, which does not exist");
                return Err(accessor_fault(accessor, why));
            };
            *point = components(value, accessor);
        }
        Ok(points)
    }

    /// Reads `N` numbers per item, without the replacements of a sparse accessor. The caller has checked that items
    /// have `N` components.
    pub(super) fn numbers<const N: usize>(
        &self,
        accessor: &Accessor,
    ) -> Result<Vec<[f32; N]>, Fault> {
        let items = self.items(accessor)?;
        Ok(items.map(|item| components(item, accessor)).collect())
    }

    /// Reads unsigned integers of one, two or four bytes.
    pub(super) fn indices(&self, accessor: &Accessor) -> Result<Vec<u32>, Fault> {
        let is_index = matches!(
            accessor.data_type(),
            DataType::U8 | DataType::U16 | DataType::U32
        );
        if !is_index || accessor.dimensions() != Dimensions::Scalar {
            let why = "holds indices that are not whole numbers";
            return Err(accessor_fault(accessor, why));
        }
        if accessor.sparse().is_some() {
            let why = "holds sparse indices, which are not supported";
            return Err(accessor_fault(accessor, why));
        }
        Ok(self.items(accessor)?.map(read_uint).collect())
    }

    /// Returns the bytes of each item. The crate's own iterator panics on some of the files that are refused here.
    fn items<'s>(
        &'s self,
        accessor: &Accessor,
    ) -> Result<impl Iterator<Item = &'s [u8]> + use<'s, 'a>, Fault> {
        let number = accessor.index();
        let Some(view) = accessor.view() else {
            return Err(Fault::new(format!("accessor {number} has no data")));
        };
        let slots = (accessor.offset(), accessor.size(), accessor.count());
        self.slices(&view, slots, number)
    }

    /// Returns the bytes of `count` items of `size` bytes, starting at `offset` in a view, for accessor `number`.
    fn slices<'s>(
        &'s self,
        view: &View,
        (offset, size, count): (usize, usize, usize),
        number: usize,
    ) -> Result<impl Iterator<Item = &'s [u8]> + use<'s, 'a>, Fault> {
        let refuse = |why: &str| Err(Fault::new(format!("accessor {number} {why}")));
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return refuse("has items that overlap");
        }
        let buffer = view.buffer().index();
        let loaded = self.loaded.get(buffer).and_then(Option::as_ref);
        let loaded = loaded.map(|bytes| bytes.as_slice());
        // Only the first buffer can be the binary chunk.
        let Some(bytes) = loaded.or(self.chunk.filter(|_| buffer == 0)) else {
            return refuse("names a buffer that does not exist");
        };
        let bytes = slice(bytes, view.offset(), view.length());
        let length = match count {
            0 => Some(0),
            _ => stride
                .checked_mul(count - 1)
                .and_then(|all| all.checked_add(size)),
        };
        let bytes = bytes
            .zip(length)
            .and_then(|(bytes, length)| slice(bytes, offset, length));
        let Some(bytes) = bytes else {
            let why = format!("declares {count} items of {size} bytes, more than its buffer holds");
            return refuse(&why);
        };
        Ok(bytes
            .chunks(stride.max(1))
            .filter_map(move |item| item.get(..size)))
    }
}

/// Reads a little-endian unsigned integer of up to four bytes.
fn read_uint(item: &[u8]) -> u32 {
    let mut bytes = [0; 4];
    for (byte, &source) in bytes.iter_mut().zip(item) {
        *byte = source;
    }
    u32::from_le_bytes(bytes)
}

/// Decodes the components of an item; missing ones are NaN. Normalized integers are scaled to −1 to 1.
fn components<const N: usize>(item: &[u8], accessor: &Accessor) -> [f32; N] {
    let (kind, is_normalized) = (accessor.data_type(), accessor.normalized());
    let size = kind.size();
    let normalize = |number: f32, max: f32| {
        if is_normalized {
            (number / max).max(-1.0)
        } else {
            number
        }
    };
    std::array::from_fn(|index| {
        let bytes = item.get(index * size..).unwrap_or_default();
        let Some(bytes) = bytes.get(..size) else {
            return f32::NAN;
        };
        let number = read_uint(bytes);
        let [low, high, ..] = number.to_le_bytes();
        let pair = [low, high];
        match kind {
            DataType::I8 => normalize(f32::from(i8::from_le_bytes([low])), 127.0),
            DataType::U8 => normalize(f32::from(low), 255.0),
            DataType::I16 => normalize(f32::from(i16::from_le_bytes(pair)), 32767.0),
            DataType::U16 => normalize(f32::from(u16::from_le_bytes(pair)), 65535.0),
            DataType::U32 => number as f32,
            DataType::F32 => f32::from_bits(number),
        }
    })
}

fn slice(bytes: &[u8], start: usize, length: usize) -> Option<&[u8]> {
    bytes.get(start..start.checked_add(length)?)
}

fn read_uri(uri: &str, folder: &Path) -> Result<Vec<u8>, Fault> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((_, text)) = data.split_once(";base64,") else {
            return Err(Fault::new("an embedded buffer is not in base64"));
        };
        return BASE64
            .decode(text)
            .map_err(|error| Fault::new(format!("an embedded buffer is broken: {error}")));
    }
    if uri.contains("://") {
        let uri = excerpt(uri, MAX_NAME_CHARS);
        return Err(Fault::new(format!(
            "its buffer {uri} is not on this machine"
        )));
    }
    let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
    let name = with_separators(folder, &name);
    if !stays_inside(folder, Path::new(&name)) {
        let name = excerpt(&name, MAX_NAME_CHARS);
        return Err(Fault::new(format!(
            "its buffer {name} is not read: it must be in the folder of the file, or below it"
        )));
    }
    let path = folder.join(&name);
    read_companion(&path).map_err(|error| {
        let name = excerpt(&name, MAX_NAME_CHARS);
        Fault::new(format!("cannot read its buffer {name}: {error}"))
    })
}

/// The fault of an accessor that is not read.
pub(super) fn accessor_fault(accessor: &Accessor, why: impl std::fmt::Display) -> Fault {
    Fault::new(format!("accessor {} {why}", accessor.index()))
}
