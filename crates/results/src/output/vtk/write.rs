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
use std::io::Write;

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

/// A grid as the file that holds it.
pub struct Vtu<'a> {
    grid: &'a Grid,
    coordinates: [DataArray; 1],
    cells: [DataArray; 3],
    head: String,
    /// What the arrays are laid down as, one after another, where that is not plain.
    encoded: Vec<Option<Vec<u8>>>,
}

impl Vtu<'_> {
    fn sections(&self) -> [Section<'_>; 4] {
        let Self { grid, coordinates, cells, .. } = self;
        let (count, cell_count) = (Some(grid.points.len()), Some(grid.cells.len()));
        [
            Section { name: "PointData", arrays: &grid.point_data, count },
            Section { name: "CellData", arrays: &grid.cell_data, count: cell_count },
            Section { name: "Points", arrays: coordinates, count },
            Section { name: "Cells", arrays: cells, count: None },
        ]
    }

    /// Writes all of it. What is plain goes through a small memory.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn Write) -> std::io::Result<()> {
        out.write_all(self.head.as_bytes())?;
        let arrays = self.sections().into_iter().flat_map(|section| section.arrays);
        for (array, encoded) in arrays.zip(&self.encoded) {
            match encoded {
                Some(bytes) => out.write_all(bytes)?,
                None => write_plain(&array.values, out)?,
            }
        }
        out.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }
}

impl Grid {
    /// The `.vtu` file of it.
    ///
    /// # Errors
    /// [`Error::Internal`] when an array does not fit the grid, or a block cannot be compressed.
    pub fn to_vtu(&self, mut encoding: Encoding) -> Result<Vtu<'_>, Error> {
        let (coordinates, cells) = ([self.coordinates()], self.cell_arrays());
        let mut made = Vtu { grid: self, coordinates, cells, head: String::new(), encoded: Vec::new() };
        encoding.base64 |= encoding == Encoding::default() && is_misread(&made.sections());
        let (mut head, mut encoded, mut offset) = (self.head(encoding), Vec::new(), 0);
        for section in made.sections() {
            let _ = writeln!(head, "<{}>", section.name);
            for array in section.checked()? {
                let _ = writeln!(head, "{}", tag(array, offset));
                let bytes = encoding.encode(&array.values)?;
                offset += bytes.as_ref().map_or(array.values.size() + LENGTH, Vec::len);
                encoded.push(bytes);
            }
            let _ = writeln!(head, "</{}>", section.name);
        }
        let form = if encoding.base64 { "base64" } else { "raw" };
        let _ = write!(head, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"{form}\">\n_");
        (made.head, made.encoded) = (head, encoded);
        Ok(made)
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

impl<'a> Section<'a> {
    /// Its arrays, as long as they must be.
    fn checked(&self) -> Result<&'a [DataArray], Error> {
        let Self { arrays, count, .. } = *self;
        for array in arrays {
            let (found, width) = (array.values.len(), array.components);
            if count.is_some_and(|count| count * width != found) {
                let text = format!("array '{}' has {found} numbers on a grid of {count:?}", array.name);
                return Err(Error::Internal(text));
            }
        }
        Ok(arrays)
    }
}

/// Whether raw arrays at these offsets are mistaken for one another by meshio 5, which turns them into base64 one by one,
/// writes down their new offsets and looks for the next one by its old offset, first from the front.
fn is_misread(sections: &[Section]) -> bool {
    let sizes = sections.iter().flat_map(|section| section.arrays).map(|array| array.values.size() + LENGTH);
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

impl Encoding {
    /// What an array is laid down as where that is not plain.
    fn encode(self, values: &Values) -> Result<Option<Vec<u8>>, Error> {
        if self == Self::default() {
            return Ok(None);
        }
        let mut data = Vec::with_capacity(values.size() + LENGTH);
        let bytes = match (self.compress, self.base64) {
            (true, base64) => {
                values.write(&mut data).map_err(broken)?;
                let (head, body) = compressed(&data)?;
                // A compressed array is two texts, its table of blocks and its blocks; an uncompressed one is a single text.
                if base64 { [head, body].map(|part| STANDARD.encode(part).into_bytes()) } else { [head, body] }.concat()
            }
            (false, _) => {
                write_plain(values, &mut data).map_err(broken)?;
                STANDARD.encode(&data).into_bytes()
            }
        };
        Ok(Some(bytes))
    }
}

/// Bytes of the length of an array.
const LENGTH: usize = 8;

/// The length and the bytes.
fn write_plain(values: &Values, out: &mut dyn Write) -> std::io::Result<()> {
    out.write_all(&(values.size() as u64).to_le_bytes())?;
    values.write(out)
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
    done.map_err(broken)
}

fn broken(error: std::io::Error) -> Error {
    Error::Internal(format!("an array cannot be compressed: {error}"))
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
