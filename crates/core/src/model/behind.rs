//! What stands behind the surfaces of contacts: the stiffness that a default penalty follows, the boundary, the better side.

use crate::contact::field::{FieldSurface, FieldTarget};
use crate::contact::{Backing, Plate, plates};
use crate::material::{Flow, Material};
use crate::mesh::{Mesh, Side, Space, flat_normal};
use crate::solid::Body;
use crate::system::Dofs;
use crate::tensor::Tensor2;
use crate::tool::ProfileTool;
use crate::tool::space::SpaceTool;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Elastic slip under the friction that the pressure allows, over the length of an edge or face, where nothing is said.
pub const ELASTIC_SLIP: f64 = 0.005;

/// Multiple of the shear modulus above which the confined modulus says nothing of a surface: a half-space yields to pressure
/// by `2 G / (1 - nu)`, the incompressible one by `4 G`.
const SURFACE: f64 = 4.0;

/// Part of half of the boundary of a thin body that must be held for it to rest on what holds it and not to bend.
const RESTS: f64 = 0.5;
/// Component of a normal from which on what is held along that axis is held across the face.
const ACROSS: f64 = 0.1;

/// Strain at which a secant modulus is taken, the offset by which a proof stress is defined, in so many increments. Over larger ones a
/// rim that slides off a tool's end under a load sinks into it, deeper than the audit lets it, before the tool is lost.
const STRAIN: f64 = 0.002;
const INCREMENTS: usize = 10;
/// Least that flow leaves of the stiffness of a plate.
const LEAST: f64 = 0.01;

/// What stands behind the faces of each cell: the confined modulus of its material, at most four shear moduli, and the
/// thickness of what it belongs to where that is thin and free to bend, with what flow leaves of the modulus then. `holds` names the groups that the first step holds or
/// moves, and along which axes.
pub fn backings<'b>(
    mesh: &Mesh,
    holds: impl IntoIterator<Item = (String, [bool; 3])>,
    bodies: impl IntoIterator<Item = &'b Body>,
) -> Vec<Backing> {
    let (mut backings, wholes) =
        (vec![Backing { modulus: 0.0, confined: 0.0, secant: 1.0, plate: None }; mesh.cell_count()], mesh.wholes());
    let held = held(mesh, &wholes, holds);
    for body in bodies {
        let [confined, shear] = body.material().moduli();
        let modulus = if shear > 0.0 { confined.min(SURFACE * shear) } else { confined };
        let secant = secant(&**body.material(), shear).max(LEAST);
        body.cells().iter().for_each(|&cell| backings[cell] = Backing { modulus, confined, secant, plate: None });
        let bends = |cell: usize, plate: &Plate| held.get(&wholes[cell]).is_none_or(|held| *held <= RESTS * plate.area);
        plates(mesh, body.cells())
            .for_each(|(cell, plate)| backings[cell].plate = plate.filter(|plate| bends(cell, plate)));
    }
    backings
}

/// Secant modulus over the elastic one, of a law that flows, where it is drawn in plane strain without change of volume; one where it
/// cannot answer.
fn secant(material: &dyn Material, shear: f64) -> f64 {
    if matches!(material.flow(), Flow::None | Flow::Unknown) {
        return 1.0;
    }
    let part = STRAIN / INCREMENTS as f64;
    let mut f = Tensor2::identity();
    (f.0[0][0], f.0[1][1]) = (part.exp(), (-part).exp());
    let mut state = vec![0.0; material.state_len()];
    material.initialise(&mut state);
    for _ in 0..INCREMENTS {
        let old = state.clone();
        if material.update(&f, (1.0 / INCREMENTS as f64).into(), &old, &mut state).is_err() {
            return 1.0;
        }
    }
    let ratio = 0.25 * (state[0] - state[1]) / (shear * STRAIN);
    if ratio.is_finite() { ratio.min(1.0) } else { 1.0 }
}

/// Area of the faces of each connected whole that are held along their normals.
fn held(mesh: &Mesh, wholes: &[usize], holds: impl IntoIterator<Item = (String, [bool; 3])>) -> BTreeMap<usize, f64> {
    let mut areas = BTreeMap::new();
    for (name, axes) in holds {
        let sides = mesh.groups.get(&name).map_or(&[][..], |group| &group.sides);
        let normal = flat_normal(mesh, sides);
        let across = |axis: usize| normal.is_none_or(|normal| normal[axis].abs() > ACROSS);
        if (0..mesh.dimension()).all(|axis| axes[axis] || !across(axis)) {
            sides.iter().for_each(|side| *areas.entry(wholes[side.cell]).or_default() += mesh.extent(*side));
        }
    }
    areas
}

/// The whole outer boundary of those of the cells that hang together with the cells behind the sides.
pub fn boundary_behind(mesh: &Mesh, sides: &[Side], cells: impl Iterator<Item = usize>) -> Vec<Side> {
    mesh.boundary(&mesh.cells_behind(sides, cells))
}

/// Sides whose faces differ in size by less than this factor are alike.
const ALIKE: f64 = 1.2;
/// Faces of the smaller of two flat sides over those of the larger up to which it carries the field: a stiff block on a soft one is right
/// to a percent up to there, and 1 to 3 per cent too soft beyond.
const COARSE: f64 = 3.0;
/// Stiffness behind one of two flat sides over that behind the other from which on one of them is softer: it carries the field, although it may be the larger, where
/// a corner of the stiffer would flip as it is pressed in.
const STIFFER: f64 = 2.0;
/// The same from which on the other is rigid beside it, and size of its faces over those of the rigid one from which on it carries the field: the edge of a fine rigid block
/// within a coarse face of a soft one makes that 33 % too stiff in place of 13.
const RIGID: [f64; 2] = [10.0, 1.5];
/// Facets that stand off a smooth surface by more than this part of their size are those of a curve.
const CURVED: f64 = 1e-3;

/// A tool as what a contact may touch, of those of the plane or of space.
pub fn tool_target(
    (plane, solid): (&[Arc<ProfileTool>], &[Arc<SpaceTool>]),
    number: usize,
    dofs: &Dofs,
) -> Option<FieldTarget> {
    let of_plane = plane.get(number).map(|tool| FieldTarget::tool(tool.clone(), number, dofs));
    of_plane.or_else(|| solid.get(number).map(|tool| FieldTarget::solid_tool(tool.clone(), number, dofs)))
}

/// Which of two surfaces carries the field of their contact.
pub struct FieldSides<'a> {
    /// Those that carry it.
    pub carrier: &'a [Side],
    /// The others.
    pub target: FieldTarget,
    /// Whether both are the same: a surface that touches itself.
    pub itself: bool,
    /// Whether the carrier is what the user calls the target.
    pub swapped: bool,
}

impl<'a> FieldSides<'a> {
    /// The better side of a surface and its target, or the surface where they may not be swapped. `backings` are those of the cells.
    pub fn new(
        [surface, target]: [&'a [Side]; 2],
        may_swap: bool,
        (mesh, space, thickness): (&Mesh, Space, f64),
        backings: &[Backing],
    ) -> Self {
        let whole = |sides: &[Side]| FieldSurface::whole(mesh, sides, space, thickness);
        let stiffness = |sides: &[Side]| {
            let behind = sides.iter().map(|side| &backings[side.cell]);
            behind.map(|behind| behind.modulus * behind.secant).fold(0.0, f64::max)
        };
        let itself = target == surface;
        let sides = [target, surface].map(|sides| (whole(sides), stiffness(sides)));
        let swapped = !itself && may_swap && suits_better(&sides, mesh);
        let (carrier, other) = if swapped { (target, surface) } else { (surface, target) };
        Self { carrier, target: FieldTarget::faces(whole(other), mesh), itself, swapped }
    }
}

/// Whether the first is clearly the better side to carry the field: a flat one beside one in chords, whose normals lean to and fro as its nodes pass;
/// of two in chords the coarser; else the much softer of two where the stiffer has corners or much finer faces; else the smaller, whose edges lie
/// within the other, as long as it is not much coarser: faces that are covered in part have peaks of pressure at their nodes beyond. Of sides as large it is the
/// finer, since a coarse field on a fine target misses what lies between its nodes.
fn suits_better([(other, stiffness), (surface, own_stiffness)]: &[(FieldSurface, f64); 2], mesh: &Mesh) -> bool {
    let [[fine, bow], [own, own_bow]] = [other.coarseness(mesh), surface.coarseness(mesh)];
    if bow.max(own_bow) > CURVED {
        let [is_flat, own_is_flat] = [other, surface].map(|side| !side.curved.iter().any(|curved| *curved));
        return if is_flat == own_is_flat { fine > ALIKE * own } else { is_flat };
    }
    let [extent, own_extent] = [other, surface].map(|side| side.extent(mesh));
    let alike = extent.max(own_extent) <= ALIKE * extent.min(own_extent);
    let contrast = stiffness.max(*own_stiffness) / stiffness.min(*own_stiffness);
    let softer = stiffness < own_stiffness;
    let (soft, stiff, stiff_side) = if softer { (fine, own, surface) } else { (own, fine, other) };
    let has_corners = stiff_side.pieces.iter().any(|&piece| piece != stiff_side.pieces[0]);
    let is_coarse = contrast > RIGID[0] && soft > RIGID[1] * stiff;
    if !alike && (is_coarse || contrast > STIFFER && has_corners) {
        return softer;
    }
    if extent * ALIKE < own_extent {
        fine < COARSE * own
    } else {
        own > if own_extent * ALIKE < extent { COARSE } else { ALIKE } * fine
    }
}
