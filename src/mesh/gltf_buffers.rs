//! The numbers that a glTF file refers to: which bytes they are, and that they are there.

use std::path::Path;

use base64::Engine as _;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::{Accessor, Document};

use super::error::{Fault, excerpt};
use super::limits::read_companion;
use crate::files::stays_inside;

/// Exporters do and do not pad.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Most bytes of all buffers of a file.
const MAX_BYTES: usize = 2 << 30;

/// The bytes of all buffers.
pub(super) struct Buffers<'a> {
    /// What a GLB file has behind its JSON.
    chunk: Option<&'a [u8]>,
    /// Nothing for the buffer that is the chunk.
    loaded: Vec<Option<Vec<u8>>>,
}

impl<'a> Buffers<'a> {
    /// Reads the buffers that are not in the file, too: they lie in `folder`.
    pub(super) fn load(
        document: &Document,
        chunk: Option<&'a [u8]>,
        folder: &Path,
    ) -> Result<Self, Fault> {
        let mut loaded = Vec::new();
        let mut total = 0;
        for buffer in document.buffers() {
            let bytes = match buffer.source() {
                Source::Bin => None,
                Source::Uri(uri) => Some(read_uri(uri, folder)?),
            };
            total += bytes.as_ref().map_or(0, Vec::len);
            if total > MAX_BYTES {
                let what = "bytes in its buffers";
                let limit = MAX_BYTES;
                return Err(Fault::TooMany { what, limit });
            }
            loaded.push(bytes);
        }
        Ok(Self { chunk, loaded })
    }

    /// Three floats for each point.
    pub(super) fn positions(&self, accessor: &Accessor) -> Result<Vec<[f32; 3]>, Fault> {
        let (kind, dimensions) = (accessor.data_type(), accessor.dimensions());
        if (kind, dimensions) != (DataType::F32, Dimensions::Vec3) {
            let number = accessor.index();
            return Err(Fault::new(format!(
                "accessor {number} holds positions that are not three floats each"
            )));
        }
        let items = self.items(accessor)?;
        let float = |item: &[u8], at: usize| {
            let bytes = item.get(at..).and_then(<[u8]>::first_chunk);
            bytes.map_or(f32::NAN, |bytes| f32::from_le_bytes(*bytes))
        };
        Ok(items
            .map(|item| [0, 4, 8].map(|at| float(item, at)))
            .collect())
    }

    /// Whole numbers of one to four bytes.
    pub(super) fn indices(&self, accessor: &Accessor) -> Result<Vec<u32>, Fault> {
        let is_index = matches!(
            accessor.data_type(),
            DataType::U8 | DataType::U16 | DataType::U32
        );
        if !is_index || accessor.dimensions() != Dimensions::Scalar {
            let number = accessor.index();
            return Err(Fault::new(format!(
                "accessor {number} holds indices that are not whole numbers"
            )));
        }
        let number = |item: &[u8]| {
            let mut bytes = [0; 4];
            for (byte, &from) in bytes.iter_mut().zip(item) {
                *byte = from;
            }
            u32::from_le_bytes(bytes)
        };
        Ok(self.items(accessor)?.map(number).collect())
    }

    /// The bytes of each item. The crate's own iterator panics on some of what is refused here.
    fn items(&self, accessor: &Accessor) -> Result<impl Iterator<Item = &[u8]>, Fault> {
        let number = accessor.index();
        let refuse = |why: &str| Err(Fault::new(format!("accessor {number} {why}")));
        if accessor.sparse().is_some() {
            return refuse("is sparse, which is not read");
        }
        let (size, count) = (accessor.size(), accessor.count());
        let Some(view) = accessor.view() else {
            return refuse("has no bytes");
        };
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return refuse("has items that overlap");
        }
        let buffer = view.buffer().index();
        let loaded = self.loaded.get(buffer).and_then(Option::as_deref);
        let Some(bytes) = loaded.or(self.chunk) else {
            return refuse("names a buffer that is not there");
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
            .and_then(|(bytes, length)| slice(bytes, accessor.offset(), length));
        let Some(bytes) = bytes else {
            let why = format!(
                "promises {count} items of {size} bytes, which are more than its buffer holds"
            );
            return refuse(&why);
        };
        Ok(bytes
            .chunks(stride.max(1))
            .filter_map(move |item| item.get(..size)))
    }
}

fn slice(bytes: &[u8], start: usize, length: usize) -> Option<&[u8]> {
    bytes.get(start..start.checked_add(length)?)
}

fn read_uri(uri: &str, folder: &Path) -> Result<Vec<u8>, Fault> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((_, text)) = data.split_once(";base64,") else {
            return Err(Fault::new("a buffer inside the file is not in base64"));
        };
        return BASE64
            .decode(text)
            .map_err(|error| Fault::new(format!("a buffer inside the file is broken: {error}")));
    }
    if uri.contains("://") {
        let uri = excerpt(uri, 80);
        return Err(Fault::new(format!(
            "its buffer {uri} is not on this machine"
        )));
    }
    let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
    if !stays_inside(folder, Path::new(name.as_ref())) {
        let name = excerpt(&name, 80);
        return Err(Fault::new(format!(
            "its buffer {name} is not read: it must lie in the folder of the file, or in one within it"
        )));
    }
    let path = folder.join(name.as_ref());
    read_companion(&path).map_err(|error| {
        let name = excerpt(&name, 80);
        Fault::new(format!("cannot read its buffer {name}: {error}"))
    })
}
