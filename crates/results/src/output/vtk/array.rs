//! Arrays as a VTK file holds them: a type, a width, bytes.

use std::io::Write;

/// The values of an array, in the three types that the files use.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// `Float64`.
    Real(Vec<f64>),
    /// `Int64`.
    Integer(Vec<i64>),
    /// `UInt8`.
    Byte(Vec<u8>),
}

/// A named array of tuples.
#[derive(Debug, Clone, PartialEq)]
pub struct DataArray {
    /// Its name.
    pub name: String,
    /// Numbers in a tuple.
    pub components: usize,
    /// The numbers, tuple after tuple.
    pub values: Values,
}

impl Values {
    /// The name of the type in the file.
    pub(super) fn type_name(&self) -> &'static str {
        match self {
            Self::Real(_) => "Float64",
            Self::Integer(_) => "Int64",
            Self::Byte(_) => "UInt8",
        }
    }
    /// Number of bytes.
    pub(super) fn size(&self) -> usize {
        match self {
            Self::Real(_) | Self::Integer(_) => 8 * self.len(),
            Self::Byte(values) => values.len(),
        }
    }
    /// Writes the bytes, little-endian.
    pub(super) fn write(&self, out: &mut dyn Write) -> std::io::Result<()> {
        match self {
            Self::Real(values) => write_words(values, |x| x.to_le_bytes(), out),
            Self::Integer(values) => write_words(values, |x| x.to_le_bytes(), out),
            Self::Byte(values) => out.write_all(values),
        }
    }
    /// From bytes; none for a type that we do not write, or a length that is no whole number of values.
    pub(super) fn from_bytes(type_name: &str, bytes: &[u8]) -> Option<Self> {
        let (words, rest) = bytes.as_chunks::<8>();
        match type_name {
            "UInt8" => Some(Self::Byte(bytes.to_vec())),
            "Float64" if rest.is_empty() => Some(Self::Real(words.iter().map(|w| f64::from_le_bytes(*w)).collect())),
            "Int64" if rest.is_empty() => Some(Self::Integer(words.iter().map(|w| i64::from_le_bytes(*w)).collect())),
            _ => None,
        }
    }
    /// Number of numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Integer(values) => values.len(),
            Self::Byte(values) => values.len(),
        }
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// All as real numbers.
    pub fn to_real(&self) -> Vec<f64> {
        match self {
            Self::Real(values) => values.clone(),
            Self::Integer(values) => values.iter().map(|&x| x as f64).collect(),
            Self::Byte(values) => values.iter().map(|&x| f64::from(x)).collect(),
        }
    }
}

impl DataArray {
    /// An array of tuples.
    pub fn new(name: impl Into<String>, components: usize, values: Values) -> Self {
        Self { name: name.into(), components, values }
    }
    /// What the components are called, where a name says more than a number.
    pub(super) fn component_names(&self) -> &'static [&'static str] {
        match self.components {
            3 => &["X", "Y", "Z"],
            6 => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
            _ => &[],
        }
    }
}

/// Writes numbers by a few thousand.
fn write_words<T: Copy>(values: &[T], word: impl Fn(T) -> [u8; 8], out: &mut dyn Write) -> std::io::Result<()> {
    let mut bytes = [0; 1 << 15];
    for values in values.chunks(bytes.len() / 8) {
        let words = &mut bytes.as_chunks_mut::<8>().0[..values.len()];
        words.iter_mut().zip(values).for_each(|(to, value)| *to = word(*value));
        out.write_all(words.as_flattened())?;
    }
    Ok(())
}
