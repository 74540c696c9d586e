//! One vertex or face of a PLY file, for all number types.

use ply_rs_bw::ply::{
    ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::error::{MAX_WORD_CHARS, excerpt};

/// The properties of an element that a mesh needs.
#[derive(Debug)]
pub(super) struct Element {
    /// Position of a vertex.
    pub position: [f64; 3],
    /// Vertex indices of a face.
    pub corners: Vec<i64>,
}

impl Element {
    /// Sets a scalar property; all but coordinates are ignored.
    fn set_scalar(&mut self, name: &str, value: f64) {
        match name {
            "x" => self.position[0] = value,
            "y" => self.position[1] = value,
            "z" => self.position[2] = value,
            _ => {}
        }
    }

    /// Parses an element from its line in a text file, or returns what is wrong with it.
    pub(super) fn from_text(line: &str, element: &ElementDef) -> Result<Self, String> {
        let mut read = Self::new();
        let mut words = line.split_ascii_whitespace();
        for (name, property) in &element.properties {
            let mut next = || {
                words
                    .next()
                    .ok_or_else(|| format!("the {} ends before its {name}", element.name))
            };
            let wrong = |word: &str| {
                let word = excerpt(word, MAX_WORD_CHARS);
                format!(
                    "{word:?} is not a number for {name} of this {}",
                    element.name
                )
            };
            match property.data_type {
                PropertyType::Scalar(_) => {
                    let word = next()?;
                    // Properties that are not needed may be malformed.
                    if matches!(name.as_str(), "x" | "y" | "z") {
                        read.set_scalar(name, word.parse().map_err(|_| wrong(word))?);
                    }
                }
                PropertyType::List(..) => {
                    let word = next()?;
                    let count: usize = word.parse().map_err(|_| wrong(word))?;
                    for _ in 0..count {
                        let word = next()?;
                        if is_corners(name) {
                            read.corners.push(word.parse().map_err(|_| wrong(word))?);
                        }
                    }
                }
            }
        }
        Ok(read)
    }
}

/// Returns whether the property holds the vertex indices of a face.
pub(super) fn is_corners(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self {
            position: [f64::NAN; 3],
            corners: Vec::new(),
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        match property {
            Property::Float(value) => self.set_scalar(name, value.into()),
            Property::Double(value) => self.set_scalar(name, value),
            Property::Char(value) => self.set_scalar(name, value.into()),
            Property::UChar(value) => self.set_scalar(name, value.into()),
            Property::Short(value) => self.set_scalar(name, value.into()),
            Property::UShort(value) => self.set_scalar(name, value.into()),
            Property::Int(value) => self.set_scalar(name, value.into()),
            Property::UInt(value) => self.set_scalar(name, value.into()),
            _ if !is_corners(name) => return PropertyAccessResult::Ignored,
            Property::ListInt(list) => self.corners = to_i64(list),
            Property::ListUInt(list) => self.corners = to_i64(list),
            Property::ListShort(list) => self.corners = to_i64(list),
            Property::ListUShort(list) => self.corners = to_i64(list),
            Property::ListChar(list) => self.corners = to_i64(list),
            Property::ListUChar(list) => self.corners = to_i64(list),
            Property::ListFloat(_) | Property::ListDouble(_) => {
                return PropertyAccessResult::UnsupportedType;
            }
        }
        PropertyAccessResult::Set
    }
}

fn to_i64<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
    list.into_iter().map(Into::into).collect()
}

/// Least number of bytes that an element takes in a file.
pub(super) fn least_bytes(element: &ElementDef, is_text: bool) -> usize {
    let properties = element.properties.values();
    if is_text {
        // A digit and a separator for each property.
        return 2 * properties.len();
    }
    let bytes = properties.map(|property| match &property.data_type {
        PropertyType::Scalar(scalar) | PropertyType::List(scalar, _) => bytes_of(scalar),
    });
    bytes.sum()
}

fn bytes_of(scalar: &ScalarType) -> usize {
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}
