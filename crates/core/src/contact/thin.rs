//! What the surface of a thin body can follow: it does so by bending, and by stretching where it is curved.
//!
//! Pressure whose sign changes over half a wavelength `l` meets the bending stiffness `M t^3 / 12 (pi / l)^4` of a body of
//! thickness `t`, and where the surface has the curvature `k` that of its membrane, `M t k^2` (Timoshenko and
//! Woinowsky-Krieger, Theory of Plates and Shells). A penalty far above that of the waves that the body feels as a plate has the
//! points of a sheet lift off and close again with every small motion.

use crate::mesh::{Mesh, Side, Space};
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// A body is thin that is longer than so many of its thicknesses.
const THIN: f64 = 20.0;
/// Half a wavelength, in thicknesses: shorter waves squeeze a plate more than they bend it.
const WAVE: f64 = 3.5;
/// Share of the membrane against that of bending: what presses a curved body is mostly how far it is driven apart, and the
/// penetration is missing there.
const MEMBRANE: f64 = 200.0;
/// Edges or faces that meet at more than this angle, in radians, meet at a corner.
const CORNER: f64 = 0.5;

/// A body that is longer than many of its thicknesses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// Its thickness: its volume over half of its boundary.
    pub thickness: f64,
    /// Half of its boundary.
    pub area: f64,
}

/// What hangs together behind each cell, where it is thin.
pub fn plates<'a>(mesh: &'a Mesh, cells: &[usize]) -> impl Iterator<Item = (usize, Option<Plate>)> + 'a {
    let wholes = mesh.wholes_of(cells);
    let mut pieces = vec![Vec::new(); wholes.iter().map(|whole| whole + 1).max().unwrap_or(0)];
    cells.iter().zip(wholes).for_each(|(&cell, whole)| pieces[whole].push(cell));
    pieces.into_iter().flat_map(|piece| {
        let plate = plate(mesh, &piece);
        piece.into_iter().map(move |cell| (cell, plate))
    })
}

fn plate(mesh: &Mesh, cells: &[usize]) -> Option<Plate> {
    let volume: f64 = cells.iter().map(|&cell| mesh.measure(cell)).sum();
    let area = 0.5 * area(mesh, &mesh.boundary(cells));
    let thickness = volume / area;
    let length = if mesh.dimension() == 3 { area.sqrt() } else { area };
    (length > THIN * thickness).then_some(Plate { thickness, area })
}

/// Area of sides, in the plane their length.
pub fn area(mesh: &Mesh, sides: &[Side]) -> f64 {
    sides.iter().map(|&side| mesh.extent(side)).sum()
}

/// Stiffness against pressure, a stress per length, of the surface of a thin body over its modulus.
pub fn stiffness(thickness: f64, curvature: f64) -> f64 {
    let bending = (std::f64::consts::PI / WAVE).powi(4) / (12.0 * thickness);
    bending + MEMBRANE * thickness * curvature * curvature
}

/// Mean square root of the squares of a surface's curvatures, from the turn between neighbours that meet without a corner; in
/// axial symmetry with that around the axis.
pub fn curvature(mesh: &Mesh, sides: &[Side], space: Space) -> f64 {
    let frames: Vec<(Vec3, Vec3)> = sides.iter().map(|&side| mesh.frame(side)).collect();
    let mut around: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, &side) in sides.iter().enumerate() {
        mesh.side(side).1.for_each(|node| around.entry(node).or_default().push(number));
    }
    let (mut sum, mut count) = (0.0, 0_usize);
    for faces in around.values() {
        for (a, b) in pairs(faces) {
            let ((x, n), (y, m)) = (frames[a], frames[b]);
            let turn = n.cross(m).norm().atan2(n.dot(m));
            if turn < CORNER {
                sum += (turn / (x - y).norm()).powi(2);
                count += 1;
            }
        }
    }
    let along = sum / count.max(1) as f64;
    let hoop = |(x, n): &(Vec3, Vec3)| if x[0] > 0.0 { (n[0] / x[0]).powi(2) } else { 0.0 };
    let hoop = match space {
        Space::Axisymmetric => frames.iter().map(hoop).sum::<f64>() / frames.len().max(1) as f64,
        _ => 0.0,
    };
    (along + hoop).sqrt()
}

fn pairs(faces: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    faces.iter().enumerate().flat_map(move |(i, &a)| faces[i + 1..].iter().map(move |&b| (a, b)))
}
