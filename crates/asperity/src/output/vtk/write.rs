//! A grid to the bytes of a `.vtu`: an XML head that names every array and its offset, then the arrays themselves.

use super::array::{DataArray, Values};
use super::grid::Grid;
use crate::Error;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt::Write as _;
use std::io::Write as _;

/// Bytes of one compressed block; VTK reads the blocks one by one.
const BLOCK: usize = 1 << 20;

/// How the arrays are laid down.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Encoding {
    /// As text that survives any editor, a third larger.
    pub base64: bool,
    /// Compressed with zlib.
    pub compress: bool,
}

/// The arrays, one after another, and where each begins.
struct Appended {
    encoding: Encoding,
    bytes: Vec<u8>,
}

impl Grid {
    /// The bytes of a `.vtu` file.
    ///
    /// # Errors
    /// [`Error::Internal`] when an array does not fit the grid, or a block cannot be compressed.
    pub fn to_bytes(&self, encoding: Encoding) -> Result<Vec<u8>, Error> {
        let mut appended = Appended { encoding, bytes: Vec::new() };
        let body = self.piece(&mut appended)?;
        let compressor = if encoding.compress { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
        let form = if encoding.base64 { "base64" } else { "raw" };
        let time = self.time;
        let mut bytes = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{compressor}>\n\
             <UnstructuredGrid>\n<FieldData>\n\
             <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time}</DataArray>\n\
             </FieldData>\n{body}</UnstructuredGrid>\n<AppendedData encoding=\"{form}\">\n_"
        )
        .into_bytes();
        bytes.append(&mut appended.bytes);
        bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        Ok(bytes)
    }

    fn piece(&self, appended: &mut Appended) -> Result<String, Error> {
        let (points, cells) = (self.points.len(), self.cells.len());
        let mut text = format!("<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n");
        section(&mut text, appended, "PointData", &self.point_data, Some(points))?;
        section(&mut text, appended, "CellData", &self.cell_data, Some(cells))?;
        section(&mut text, appended, "Points", &[self.coordinates()], Some(points))?;
        section(&mut text, appended, "Cells", &self.cell_arrays(), None)?;
        text.push_str("</Piece>\n");
        Ok(text)
    }

    fn cell_arrays(&self) -> [DataArray; 3] {
        [
            DataArray::new("connectivity", 1, Values::Integer(self.cells.connectivity.clone())),
            DataArray::new("offsets", 1, Values::Integer(self.cells.offsets.clone())),
            DataArray::new("types", 1, Values::Byte(self.cells.types.clone())),
        ]
    }
}

fn section(
    text: &mut String,
    appended: &mut Appended,
    name: &str,
    arrays: &[DataArray],
    count: Option<usize>,
) -> Result<(), Error> {
    let _ = writeln!(text, "<{name}>");
    for array in arrays {
        let (found, width) = (array.values.len(), array.components);
        if count.is_some_and(|count| count * width != found) {
            return Err(Error::Internal(format!("array '{}' has {found} numbers on a grid of {count:?}", array.name)));
        }
        let _ = writeln!(text, "{}", tag(array, appended.push(&array.values.to_bytes())?));
    }
    let _ = writeln!(text, "</{name}>");
    Ok(())
}

fn tag(array: &DataArray, offset: usize) -> String {
    let (kind, name, width) = (array.values.type_name(), escape(&array.name), array.components);
    let mut text = format!("<DataArray type=\"{kind}\" Name=\"{name}\"");
    // Without a number of components readers make a plain column of it; with "1", some make a matrix.
    if width > 1 {
        let _ = write!(text, " NumberOfComponents=\"{width}\"");
    }
    for (i, component) in array.component_names().iter().enumerate() {
        let _ = write!(text, " ComponentName{i}=\"{component}\"");
    }
    let _ = write!(text, " format=\"appended\" offset=\"{offset}\"/>");
    text
}

impl Appended {
    /// Adds an array and returns its offset.
    fn push(&mut self, data: &[u8]) -> Result<usize, Error> {
        let offset = self.bytes.len();
        let (head, body) = if self.encoding.compress { compressed(data)? } else { plain(data) };
        match (self.encoding.base64, self.encoding.compress) {
            (false, _) => self.bytes.extend(head.into_iter().chain(body)),
            // A compressed array is two texts, its table of blocks and its blocks; an uncompressed one is a single text.
            (true, true) => self.push_text(&[&head[..], &body[..]]),
            (true, false) => self.push_text(&[&[head, body].concat()]),
        }
        Ok(offset)
    }
    fn push_text(&mut self, parts: &[&[u8]]) {
        for part in parts {
            self.bytes.extend(STANDARD.encode(part).into_bytes());
        }
    }
}

fn plain(data: &[u8]) -> (Vec<u8>, Vec<u8>) {
    ((data.len() as u64).to_le_bytes().to_vec(), data.to_vec())
}

/// The table of blocks (how many, their size, the size of a shorter last one, the compressed sizes) and the blocks.
fn compressed(data: &[u8]) -> Result<(Vec<u8>, Vec<u8>), Error> {
    let blocks = data.chunks(BLOCK).map(deflate).collect::<Result<Vec<_>, _>>()?;
    let numbers = [blocks.len(), BLOCK, data.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
    Ok((numbers.flat_map(|n| (n as u64).to_le_bytes()).collect(), blocks.concat()))
}

fn deflate(block: &[u8]) -> Result<Vec<u8>, Error> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    let done = encoder.write_all(block).and_then(|()| encoder.finish());
    done.map_err(|error| Error::Internal(format!("an array cannot be compressed: {error}")))
}

/// A name as it may stand in an attribute.
pub(super) fn escape(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            c if c.is_control() => text.push('?'),
            c => text.push(c),
        }
    }
    text
}
