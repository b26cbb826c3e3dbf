//! Points of several frames, where they are, and the values at them and at cells.

use crate::pack::{Blobs, Packed, real};
use asperity_results::output::vtk::{DataArray, Grid};
use rayon::prelude::*;
use serde::Serialize;

/// Names of components by their number.
fn components(count: usize) -> Vec<String> {
    let names: &[&str] = match count {
        1 => &[""],
        3 => &["x", "y", "z"],
        6 => &["xx", "yy", "zz", "xy", "yz", "xz"],
        _ => return (0..count).map(|i| i.to_string()).collect(),
    };
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// One stored quantity in all frames.
#[derive(Debug, Clone)]
struct Field {
    name: String,
    at_cells: bool,
    /// For each component the values of all frames.
    values: Vec<Vec<f32>>,
}

/// Points and values, frame after frame.
#[derive(Debug, Clone, Default)]
pub struct Points {
    counts: Vec<usize>,
    cell_counts: Vec<usize>,
    reference: [Vec<f32>; 3],
    displacement: [Vec<f32>; 3],
    fields: Vec<Field>,
}

/// The same, packed.
#[derive(Debug, Serialize)]
pub struct PackedPoints {
    /// Points of each frame.
    counts: Vec<usize>,
    /// Cells of each frame.
    cell_counts: Vec<usize>,
    /// Where the points were before any motion: x, y, z.
    reference: Vec<Packed>,
    /// Whether that is told once, since it is the same in all frames.
    still: bool,
    /// What moves them.
    displacement: Vec<Packed>,
    /// What is stored at them and at cells.
    fields: Vec<PackedField>,
}

/// One stored quantity, packed.
#[derive(Debug, Serialize)]
struct PackedField {
    name: String,
    at_cells: bool,
    components: Vec<String>,
    values: Vec<Packed>,
}

const DISPLACEMENT: &str = "displacement";

impl Points {
    /// Adds a frame: the points and cells that are kept, or all.
    pub fn add(&mut self, grid: &Grid, kept: Option<(&[usize], &[usize])>) {
        let all = ((0..grid.points.len()).collect::<Vec<_>>(), (0..grid.cells.len()).collect::<Vec<_>>());
        let (nodes, cells) = kept.unwrap_or((&all.0, &all.1));
        let before = [self.counts.iter().sum::<usize>(), self.cell_counts.iter().sum::<usize>()];
        let moved = grid.point_array(DISPLACEMENT).map(|array| array.values.to_real());
        for &node in nodes {
            for axis in 0..3 {
                self.reference[axis].push(grid.points.get(node).map_or(f32::NAN, |point| point[axis] as f32));
                let moved = moved.as_ref().map_or(Some(&0.0), |moved| moved.get(3 * node + axis));
                self.displacement[axis].push(moved.map_or(f32::NAN, |&value| value as f32));
            }
        }
        for (at_cells, arrays, members) in [(false, &grid.point_data, nodes), (true, &grid.cell_data, cells)] {
            let told = |array: &&DataArray| array.name != DISPLACEMENT && !array.name.starts_with("group.");
            for array in arrays.iter().filter(told) {
                self.field(array, at_cells, before[usize::from(at_cells)]).take(array, members);
            }
        }
        self.counts.push(nodes.len());
        self.cell_counts.push(cells.len());
        let totals = [self.counts.iter().sum::<usize>(), self.cell_counts.iter().sum::<usize>()];
        // What this frame does not have is unknown.
        for field in &mut self.fields {
            field.values.iter_mut().for_each(|values| values.resize(totals[usize::from(field.at_cells)], f32::NAN));
        }
    }

    /// The field of an array; a new one is unknown before now.
    fn field(&mut self, array: &DataArray, at_cells: bool, before: usize) -> &mut Field {
        let same = |field: &Field| field.name == array.name && field.at_cells == at_cells;
        let place = self.fields.iter().position(same).unwrap_or_else(|| {
            let values = vec![vec![f32::NAN; before]; array.components];
            self.fields.push(Field { name: array.name.clone(), at_cells, values });
            self.fields.len() - 1
        });
        &mut self.fields[place]
    }

    /// Whether there is no point in any frame.
    pub fn is_empty(&self) -> bool {
        self.counts.iter().all(|&count| count == 0)
    }

    /// The same with these frames only.
    pub fn chosen(&self, frames: &[usize]) -> Self {
        let pick = |values: &[f32], counts: &[usize]| {
            let start = |frame: usize| counts[..frame].iter().sum::<usize>();
            frames.iter().flat_map(|&frame| values[start(frame)..start(frame) + counts[frame]].to_vec()).collect()
        };
        let axis = |lists: &[Vec<f32>; 3]| lists.each_ref().map(|values| pick(values, &self.counts));
        let field = |field: &Field| {
            let counts = if field.at_cells { &self.cell_counts } else { &self.counts };
            Field { values: field.values.iter().map(|values| pick(values, counts)).collect(), ..field.clone() }
        };
        Self {
            counts: frames.iter().map(|&frame| self.counts[frame]).collect(),
            cell_counts: frames.iter().map(|&frame| self.cell_counts[frame]).collect(),
            reference: axis(&self.reference),
            displacement: axis(&self.displacement),
            fields: self.fields.iter().map(field).collect(),
        }
    }

    /// Packs them, with so many bits for displacements and for other values. Of a plane what has no meaning there is left out.
    pub fn packed(&self, plane: bool, motion: u32, value: u32, blobs: &mut Blobs) -> PackedPoints {
        let first = self.counts.first().copied().unwrap_or(0);
        let same = |values: &Vec<f32>| values.chunks(first.max(1)).all(|frame| *frame == values[..first]);
        let still = self.counts.iter().all(|&count| count == first) && self.reference.iter().all(same);
        let counts = if still { &self.counts[..self.counts.len().min(1)] } else { &self.counts };
        let pack = |values: &Vec<f32>| real(&values[..counts.iter().sum()], counts, 23);
        let reference: Vec<Packed> = self.reference.par_iter().map(pack).collect();
        let displacement: Vec<Packed> =
            self.displacement.par_iter().map(|values| real(values, &self.counts, motion)).collect();
        let field = |field: &Field| {
            let counts = if field.at_cells { &self.cell_counts } else { &self.counts };
            let values: Vec<Packed> = field.values.par_iter().map(|values| real(values, counts, value)).collect();
            let names = components(values.len());
            let told = |(name, packed): &(String, Packed)| {
                let across = matches!(name.as_str(), "z" | "yz" | "xz");
                !(plane && across && packed.text.is_empty() && packed.low == 0.0)
            };
            let (components, values) = names.into_iter().zip(values).filter(told).unzip();
            PackedField { name: field.name.clone(), at_cells: field.at_cells, components, values }
        };
        let fields: Vec<PackedField> = self.fields.par_iter().map(field).collect();
        let mut all = |packed: Vec<Packed>| packed.into_iter().map(|packed| blobs.take(packed)).collect::<Vec<_>>();
        PackedPoints {
            counts: self.counts.clone(),
            cell_counts: self.cell_counts.clone(),
            reference: all(reference),
            still,
            displacement: all(displacement),
            fields: fields.into_iter().map(|field| PackedField { values: all(field.values), ..field }).collect(),
        }
    }
}

impl Field {
    fn take(&mut self, array: &DataArray, members: &[usize]) {
        let values = array.values.to_real();
        for (component, list) in self.values.iter_mut().enumerate() {
            let value =
                |&member: &usize| values.get(member * array.components + component).map_or(f32::NAN, |&x| x as f32);
            list.extend(members.iter().map(value));
        }
    }
}
