//! A grid to the bytes of a `.vtu`: an XML head that names every array and its offset, then the arrays themselves.

use super::array::{DataArray, Values};
use super::grid::Grid;
use asperity_core::Error;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::collections::BTreeSet;
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
    pub fn to_bytes(&self, mut encoding: Encoding) -> Result<Vec<u8>, Error> {
        let (coordinates, cells) = ([self.coordinates()], self.cell_arrays());
        let (count, cell_count) = (Some(self.points.len()), Some(self.cells.len()));
        let sections = [
            Section { name: "PointData", arrays: &self.point_data, count },
            Section { name: "CellData", arrays: &self.cell_data, count: cell_count },
            Section { name: "Points", arrays: &coordinates, count },
            Section { name: "Cells", arrays: &cells, count: None },
        ];
        encoding.base64 |= encoding == Encoding::default() && is_misread(&sections);
        let mut appended = Appended { encoding, bytes: Vec::new() };
        let mut head = self.head(encoding);
        appended.bytes.reserve(sections.iter().map(Section::size).sum());
        sections.iter().try_for_each(|section| section.write(&mut head, &mut appended))?;
        let form = if encoding.base64 { "base64" } else { "raw" };
        let _ = write!(head, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"{form}\">\n_");
        // In the memory of the arrays, which is that of a whole grid.
        let mut bytes = appended.bytes;
        bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        bytes.splice(..0, head.into_bytes());
        Ok(bytes)
    }

    fn head(&self, encoding: Encoding) -> String {
        let compressor = if encoding.compress { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
        let (time, points, cells) = (self.time, self.points.len(), self.cells.len());
        format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{compressor}>\n\
             <UnstructuredGrid>\n<FieldData>\n\
             <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time}</DataArray>\n\
             </FieldData>\n<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n"
        )
    }

    fn cell_arrays(&self) -> [DataArray; 3] {
        [
            DataArray::new("connectivity", 1, Values::Integer(self.cells.connectivity.clone())),
            DataArray::new("offsets", 1, Values::Integer(self.cells.offsets.clone())),
            DataArray::new("types", 1, Values::Byte(self.cells.types.clone())),
        ]
    }
}

/// The arrays of one part of a grid, one tuple for each of `count` things where that is said.
struct Section<'a> {
    name: &'static str,
    arrays: &'a [DataArray],
    count: Option<usize>,
}

impl Section<'_> {
    /// Bytes of the arrays and of their lengths as they are laid down plainly.
    fn size(&self) -> usize {
        self.arrays.iter().map(|array| array.values.size() + 8).sum()
    }

    fn write(&self, head: &mut String, appended: &mut Appended) -> Result<(), Error> {
        let Self { name, arrays, count } = self;
        let _ = writeln!(head, "<{name}>");
        for array in *arrays {
            let (found, width) = (array.values.len(), array.components);
            if count.is_some_and(|count| count * width != found) {
                let text = format!("array '{}' has {found} numbers on a grid of {count:?}", array.name);
                return Err(Error::Internal(text));
            }
            let _ = writeln!(head, "{}", tag(array, appended.push(&array.values)?));
        }
        let _ = writeln!(head, "</{name}>");
        Ok(())
    }
}

/// Whether raw arrays at these offsets are mistaken for one another by meshio 5, which turns them into base64 one by one,
/// writes down their new offsets and looks for the next one by its old offset, first from the front.
fn is_misread(sections: &[Section]) -> bool {
    let sizes = sections.iter().flat_map(|section| section.arrays).map(|array| array.values.size() + 8);
    let (mut old, mut new, mut before) = (0, 0, BTreeSet::new());
    for size in sizes {
        if before.contains(&old) {
            return true;
        }
        before.insert(new);
        old += size;
        new += 4 * size.div_ceil(3);
    }
    false
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
    fn push(&mut self, values: &Values) -> Result<usize, Error> {
        let offset = self.bytes.len();
        if self.encoding == Encoding::default() {
            add_plain(values, &mut self.bytes);
            return Ok(offset);
        }
        let mut data = Vec::with_capacity(values.size() + 8);
        if self.encoding.compress {
            values.append_to(&mut data);
            let (head, body) = compressed(&data)?;
            match self.encoding.base64 {
                false => self.bytes.extend(head.into_iter().chain(body)),
                // A compressed array is two texts, its table of blocks and its blocks; an uncompressed one is a single text.
                true => self.push_text(&[&head[..], &body[..]]),
            }
        } else {
            add_plain(values, &mut data);
            self.push_text(&[&data]);
        }
        Ok(offset)
    }
    fn push_text(&mut self, parts: &[&[u8]]) {
        for part in parts {
            self.bytes.extend(STANDARD.encode(part).into_bytes());
        }
    }
}

/// The length and the bytes.
fn add_plain(values: &Values, out: &mut Vec<u8>) {
    out.extend_from_slice(&(values.size() as u64).to_le_bytes());
    values.append_to(out);
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
pub(in crate::output) fn escape(name: &str) -> String {
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
