//! Files are read back as they were written, in every encoding; damaged ones are refused without a panic.

use super::*;
use crate::output::file;
use asperity_core::mesh::cells::ALL;
use asperity_core::mesh::{Cell, Mesh};
use asperity_core::tensor::Vec3;
use proptest::prelude::*;
use std::path::Path;

/// The bytes of the file of a grid.
fn bytes(grid: &Grid, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    grid.to_vtu(encoding).unwrap().write(&mut bytes).unwrap();
    bytes
}

const ENCODINGS: [Encoding; 4] = [
    Encoding { base64: false, compress: false },
    Encoding { base64: false, compress: true },
    Encoding { base64: true, compress: false },
    Encoding { base64: true, compress: true },
];

/// One cell of every kind, side by side.
pub(super) fn zoo() -> Mesh {
    let mut mesh = Mesh::new();
    for (i, cell) in ALL.iter().enumerate() {
        let first = mesh.points.len();
        let shifted = |x: &[f64; 3]| Vec3::new(x[0] + 3.0 * i as f64, x[1], x[2]);
        mesh.points.extend(cell.nodes.iter().map(shifted));
        mesh.push_cell(cell, &(first..mesh.points.len()).collect::<Vec<_>>());
    }
    mesh
}

fn sample() -> Grid {
    let mesh = zoo();
    let n = mesh.points.len();
    let wave = (0..3 * n).map(|i| (i as f64).sin() * 1e-7).collect();
    let odd = vec![f64::NAN, f64::INFINITY, -0.0, f64::MIN_POSITIVE].into_iter().cycle().take(n).collect();
    let cells = Cells::of_mesh(&mesh).unwrap();
    Grid {
        time: 0.1 + 0.2,
        points: mesh.points.iter().map(|p| p.0).collect(),
        point_data: vec![
            DataArray::new("displacement", 3, Values::Real(wave)),
            DataArray::new("odd <&\"numbers\">", 1, Values::Real(odd)),
        ],
        cell_data: vec![
            DataArray::new("body", 1, Values::Integer((0..cells.len() as i64).map(|i| i - 1).collect())),
            DataArray::new("group.left", 1, Values::Byte(vec![1; cells.len()])),
        ],
        cells,
    }
}

/// Bits, so that a NaN equals itself.
fn bits(grid: &Grid) -> Vec<u64> {
    let arrays = grid.point_data.iter().chain(&grid.cell_data);
    arrays.flat_map(|a| a.values.to_real()).chain(grid.points.as_flattened().to_vec()).map(f64::to_bits).collect()
}

#[test]
fn every_encoding_reads_back_the_same_bits() {
    let grid = sample();
    for encoding in ENCODINGS {
        let back = read::parse(&bytes(&grid, encoding)).unwrap();
        assert_eq!(bits(&back), bits(&grid), "{encoding:?}");
        assert_eq!((back.time, &back.cells), (grid.time, &grid.cells), "{encoding:?}");
        let names = |grid: &Grid| grid.point_data.iter().map(|a| a.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&back), names(&grid));
    }
}

#[test]
fn arrays_of_several_blocks_read_back() {
    let points = 200_000;
    let grid = Grid {
        points: (0..points).map(|i| [i as f64, 0.5, -1.0]).collect(),
        cells: Cells::vertices(points),
        ..Grid::default()
    };
    for encoding in ENCODINGS {
        assert_eq!(read::parse(&bytes(&grid, encoding)).unwrap(), grid);
    }
}

#[test]
fn a_mesh_comes_back_in_our_order_of_nodes() {
    let mesh = zoo();
    let grid = sample();
    let back = grid.to_mesh().unwrap();
    let kinds = |mesh: &Mesh| mesh.kinds.iter().map(|k: &&Cell| k.name).collect::<Vec<_>>();
    assert_eq!(
        (back.nodes.clone(), back.starts.clone(), kinds(&back)),
        (mesh.nodes.clone(), mesh.starts.clone(), kinds(&mesh))
    );
}

#[test]
fn an_array_that_does_not_fit_is_refused() {
    let mut grid = sample();
    grid.cell_data[0].values = Values::Integer(vec![1]);
    assert!(grid.to_vtu(Encoding::default()).is_err());
}

#[test]
fn a_series_lists_its_frames_and_resumes() {
    let directory = tempfile::tempdir().unwrap();
    let mut series = PvdSeries::create(directory.path(), "bodies", Encoding::default()).unwrap();
    let mut grid = sample();
    for time in [0.0, 0.1, 1.0 / 3.0] {
        grid.time = time;
        series.push(&grid).unwrap();
        let frames = read_series(&series.path()).unwrap();
        assert_eq!(frames.len(), series.len());
        assert!(frames.iter().all(|(at, name)| read_grid(&directory.path().join(name)).unwrap().time == *at));
    }
    let frames = || std::fs::read_dir(directory.path().join("bodies")).unwrap().count();
    std::fs::write(directory.path().join("bodies/notes.txt"), "the user's own").unwrap();
    let resumed = PvdSeries::resume(directory.path(), "bodies", Encoding::default(), 0.1).unwrap();
    assert_eq!((resumed.len(), read_series(&resumed.path()).unwrap().len(), frames()), (2, 2, 3));
    PvdSeries::create(directory.path(), "bodies", Encoding::default()).unwrap();
    assert_eq!(frames(), 1, "only the user's own file is left");
}

#[test]
fn a_foreign_file_is_told_by_name() {
    let path = Path::new("/no/such/file.vtu");
    assert!(matches!(read_grid(path), Err(asperity_core::Error::File { .. })));
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.vtu");
    file::write_atomic(&path, b"<?xml version=\"1.0\"?><svg/>", file::Durability::Process).unwrap();
    assert!(read_grid(&path).unwrap_err().to_string().contains("a.vtu"));
}

proptest! {
    #[test]
    fn damaged_files_never_panic(place in 0usize..1 << 20, byte: u8, cut in 0usize..1 << 20, which in 0usize..4) {
        let bytes = bytes(&sample(), ENCODINGS[which]);
        let mut hurt = bytes.clone();
        hurt[place % bytes.len()] = byte;
        let _ = read::parse(&hurt).map(|grid| grid.to_mesh());
        let _ = read::parse(&bytes[..cut % bytes.len()]).map(|grid| grid.to_mesh());
    }
}

/// Four contact points, whose arrays meshio 5.3 mistook for one another: raw offset 196 of the fourth array is that of the
/// third in base64.
#[test]
fn offsets_that_are_mistaken_are_not_written() {
    let reals = |n: usize| Values::Real((0..n).map(|i| i as f64).collect());
    let grid = |count: usize| Grid {
        points: vec![[0.0; 3]; count],
        cells: Cells::vertices(count),
        point_data: vec![
            DataArray::new("displacement", 3, reals(3 * count)),
            DataArray::new("contact", 1, Values::Integer(vec![0; count])),
            DataArray::new("contact_status", 1, Values::Byte(vec![1; count])),
            DataArray::new("contact_pressure", 1, reals(count)),
            DataArray::new("contact_traction", 3, reals(3 * count)),
        ],
        ..Grid::default()
    };
    let of = |count: usize| bytes(&grid(count), Encoding::default());
    let is_raw = |bytes: &[u8]| bytes.windows(14).any(|window| window == b"encoding=\"raw\"");
    assert!(!is_raw(&of(4)) && is_raw(&of(5)));
    assert_eq!(read::parse(&of(4)).unwrap(), grid(4));
}
