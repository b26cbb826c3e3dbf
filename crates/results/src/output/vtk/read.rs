//! A `.vtu` that we wrote, back to a grid: for drawing pictures of a finished run. It reads what `write` writes, in
//! all its encodings, and refuses everything else with a reason; it is no general reader of VTK files.

use super::array::{DataArray, Values};
use super::grid::{Cells, Grid};
use super::write::Encoding;
use crate::output::file;
use asperity_core::Error;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io::Read;
use std::path::Path;

/// Reads a `.vtu` written by this program.
///
/// # Errors
/// [`Error::File`] when it cannot be read or is not such a file.
pub fn read_grid(path: &Path) -> Result<Grid, Error> {
    parse(&file::read(path)?).map_err(|reason| Error::file(path, reason))
}

/// What is said of a file that is damaged or foreign.
type Reason = String;

/// Parses the bytes of a `.vtu`.
pub(super) fn parse(bytes: &[u8]) -> Result<Grid, Reason> {
    let (head, blob, encoding) = split(bytes)?;
    let mut grid = Grid { time: time(head)?, ..Grid::default() };
    let mut section = "";
    for tag in head.split('<').skip(1) {
        let name = tag.split([' ', '>', '/']).next().unwrap_or("");
        match name {
            "PointData" | "CellData" | "Points" | "Cells" => section = name,
            "DataArray" if attribute(tag, "format") == Some("appended") => {
                place(&mut grid, section, array(tag, blob, encoding)?)?;
            }
            _ => {}
        }
    }
    check(&grid)?;
    Ok(grid)
}

/// The XML head, the appended bytes after their underscore, and how these are encoded.
fn split(bytes: &[u8]) -> Result<(&str, &[u8], Encoding), Reason> {
    let mark = b"<AppendedData";
    let end = bytes.windows(mark.len()).position(|w| w == mark).ok_or("not a VTK file of this program")?;
    let start = bytes[end..].iter().position(|&b| b == b'_').ok_or("the appended data are missing")?;
    let head = std::str::from_utf8(&bytes[..end]).map_err(|e| e.to_string())?;
    let base64 = bytes[end..end + start].windows(6).any(|w| w == b"base64");
    let encoding = Encoding { base64, compress: head.contains("vtkZLibDataCompressor") };
    Ok((head, &bytes[end + start + 1..], encoding))
}

fn time(head: &str) -> Result<f64, Reason> {
    let after = head.split("Name=\"TimeValue\"").nth(1).and_then(|text| text.split('>').nth(1));
    let number = after.and_then(|text| text.split('<').next()).and_then(|text| text.trim().parse().ok());
    number.ok_or_else(|| "no TimeValue".into())
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let start = tag.find(&format!(" {name}=\""))? + name.len() + 3;
    tag[start..].split('"').next()
}

fn array(tag: &str, blob: &[u8], encoding: Encoding) -> Result<DataArray, Reason> {
    let get = |name| attribute(tag, name).ok_or_else(|| format!("an array without {name}"));
    let name = unescape(get("Name")?);
    let number = |text: &str| text.parse::<usize>().map_err(|_| format!("'{text}' is not a number"));
    let (offset, components) = (number(get("offset")?)?, number(get("NumberOfComponents").unwrap_or("1"))?);
    let bytes = blob.get(offset..).and_then(|rest| data(rest, encoding));
    let values = bytes.and_then(|bytes| Values::from_bytes(get("type").ok()?, &bytes));
    let values = values.ok_or_else(|| format!("the array '{name}' is damaged"))?;
    Ok(DataArray { name, components, values })
}

/// The bytes of one array, from where it begins.
fn data(rest: &[u8], encoding: Encoding) -> Option<Vec<u8>> {
    match (encoding.base64, encoding.compress) {
        (false, false) => rest.get(8..8usize.checked_add(word(rest, 0)?)?).map(<[u8]>::to_vec),
        (false, true) => inflate(&table(rest)?, rest.get(8 * (3 + word(rest, 0)?)..)?),
        (true, false) => text(rest, 8usize.checked_add(word(&text(rest, 8)?, 0)?)?).map(|all| all[8..].to_vec()),
        (true, true) => {
            let length = 8 * word(&text(rest, 8)?, 0)?.checked_add(3)?;
            let sizes = table(&text(rest, length)?)?;
            inflate(&sizes, &text(rest.get(encoded(length)?..)?, sizes.iter().sum())?)
        }
    }
}

fn word(bytes: &[u8], index: usize) -> Option<usize> {
    let word = bytes.as_chunks::<8>().0.get(index)?;
    usize::try_from(u64::from_le_bytes(*word)).ok().filter(|&n| n < 1 << 48)
}

/// The compressed sizes of the blocks.
fn table(bytes: &[u8]) -> Option<Vec<usize>> {
    (0..word(bytes, 0)?).map(|i| word(bytes, 3 + i)).collect()
}

fn inflate(sizes: &[usize], mut bytes: &[u8]) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    for &size in sizes {
        let (block, rest) = bytes.split_at_checked(size)?;
        flate2::read::ZlibDecoder::new(block).read_to_end(&mut out).ok()?;
        bytes = rest;
    }
    Some(out)
}

/// Characters of base64 text that hold so many bytes.
fn encoded(bytes: usize) -> Option<usize> {
    bytes.div_ceil(3).checked_mul(4)
}

/// The first `length` bytes of base64 text.
fn text(characters: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut bytes = STANDARD.decode(characters.get(..encoded(length)?)?).ok()?;
    bytes.truncate(length);
    (bytes.len() == length).then_some(bytes)
}

fn place(grid: &mut Grid, section: &str, array: DataArray) -> Result<(), Reason> {
    match (section, array.name.as_str(), array.values) {
        ("PointData", _, values) => grid.point_data.push(DataArray { values, ..array }),
        ("CellData", _, values) => grid.cell_data.push(DataArray { values, ..array }),
        ("Points", _, Values::Real(values)) => grid.points = values.as_chunks().0.to_vec(),
        ("Cells", "connectivity", Values::Integer(values)) => grid.cells.connectivity = values,
        ("Cells", "offsets", Values::Integer(values)) => grid.cells.offsets = values,
        ("Cells", "types", Values::Byte(values)) => grid.cells.types = values,
        (_, name, _) => return Err(format!("the array '{name}' is out of place")),
    }
    Ok(())
}

fn check(grid: &Grid) -> Result<(), Reason> {
    let Cells { offsets, types, .. } = &grid.cells;
    let fits = |arrays: &[DataArray], count| arrays.iter().all(|a| a.values.len() == a.components * count);
    let whole = offsets.len() == types.len() && grid.cells.iter().all(|cell| cell.is_some());
    if whole && fits(&grid.point_data, grid.points.len()) && fits(&grid.cell_data, types.len()) {
        return Ok(());
    }
    Err("its arrays do not fit together".into())
}

fn unescape(text: &str) -> String {
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}
