//! The stencil of one node of the field: weighted gap and slips with their gradients, and the forces of its stresses.
//!
//! With `y = (-g_i, s_i)` the coordinates and `t = (p_i, tau_i)` the stresses over them, the forces are `F = H(u) t`, and the tangent is
//! `H C G + sum_c t_c dH_c`, `G = dy/du`. Two sweeps over the points of the node: the first finds `y`, `G` and `H`; then the law
//! is asked; the second adds what turning and moving the stresses does.

use super::column::PointColumn;
use super::contact::{FieldContact, FieldTarget, RULE};
use super::cover::{FaceInPlace, Patch};
use super::face::{CORNERS, FieldFace, PlacedFace, ShapeFunctions, moved};
use super::patch::PatchInPlace;
use super::point::{FieldPoint, PointRates, Sight, Touched};
use super::surface::NodalNormal;
use super::tool::ToolInPlace;
use super::triad::MaterialLine;
use crate::tensor::Vec3;
use std::ops::Range;

/// Coordinates of a node: penetration and two slips.
pub const COUNT: usize = 3;

/// Which unknowns a stencil has, and the patches that it sums.
#[derive(Debug, Clone)]
pub struct Support {
    /// The patches; the node's own number among the corners of each face.
    pub patches: Vec<(Patch, usize)>,
    /// Nodes of the mesh on which they depend, ascending.
    pub nodes: Vec<usize>,
    /// The target came through the body here.
    pub through: bool,
    /// Deformed over undeformed area of the faces of the patches around the node.
    pub stretch: f64,
}

impl Default for Support {
    fn default() -> Self {
        Self { patches: Vec::new(), nodes: Vec::new(), through: false, stretch: 1.0 }
    }
}

impl Support {
    /// The faces of its patches, each once, with the node's number among their corners; none for a tip.
    pub fn faces(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let faces = self.patches.iter().enumerate();
        let fresh = |i: usize, face: usize| !self.patches[..i].iter().any(|(other, _)| other.face == face);
        faces
            .filter(move |(i, (patch, _))| patch.tip.is_none() && fresh(*i, patch.face))
            .map(|(_, (patch, corner))| (patch.face, *corner))
    }
}

/// Sums over the points of a node. Its buffers are kept from stencil to stencil.
#[derive(Debug, Default)]
pub struct NodeSums {
    /// Undeformed area of what the node stands for and sees.
    pub area: f64,
    /// Penetration and slips.
    pub y: [f64; COUNT],
    /// Derivatives of `y` along each unknown, coordinate after coordinate.
    pub gradients: Vec<f64>,
    /// Forces on each unknown of a unit of each stress, stress after stress.
    pub forces: Vec<f64>,
    /// Mean position, weighted by area.
    pub place: Vec3,
    pub(super) points: Vec<FieldPoint>,
    /// Derivatives of the points along the unknowns on which they depend, with the numbers of these.
    pub(super) rates: Vec<(usize, PointRates)>,
    /// Where those of each point begin.
    pub(super) starts: Vec<usize>,
    pub(super) columns: Vec<PointColumn>,
}

/// A stencil at values of its unknowns.
pub struct StencilInPlace<'a> {
    /// The contact.
    pub contact: &'a FieldContact,
    /// Its unknowns and patches.
    pub support: &'a Support,
    /// Values of its unknowns: those of its nodes, then those of the tool.
    pub u: &'a [f64],
    /// The tool where these put it.
    pub tool: Option<ToolInPlace<'a>>,
}

/// What a place of the surface saw at the accepted state.
pub type Recall<'a> = &'a dyn Fn(&Patch, [f64; 2]) -> Option<Touched>;

impl<'a> StencilInPlace<'a> {
    /// Of a contact.
    pub fn new(contact: &'a FieldContact, support: &'a Support, u: &'a [f64]) -> Self {
        let motion = support.nodes.len() * contact.parts.dofs.per_node();
        let tool =
            contact.parts.target.as_tool().filter(|_| motion < u.len()).map(|rigid| rigid.in_place(&u[motion..]));
        Self { contact, support, u, tool }
    }

    fn axes(&self) -> usize {
        self.contact.parts.dofs.per_node()
    }

    /// A face with its nodes in place.
    pub(super) fn placed(&self, face: &FieldFace) -> PlacedFace {
        PlacedFace::new(face.nodes.iter().map(|&node| self.position(node)))
    }

    fn position(&self, node: usize) -> Vec3 {
        let (x, axes) = (self.contact.parts.mesh.points[node], self.axes());
        let place = self.support.nodes.binary_search(&node);
        place.map_or(x, |place| moved(x, &self.u[place * axes..(place + 1) * axes]))
    }

    /// The unknowns of the tool.
    pub(super) fn motion(&self) -> &'a [f64] {
        &self.u[self.support.nodes.len() * self.axes()..]
    }

    fn patch(&self, patch: &Patch) -> PatchInPlace<'a> {
        let surface = &self.contact.parts.surface;
        let face = &surface.faces[patch.face];
        let (mut normals, mut units) = ([None; CORNERS], [Vec3::zero(); CORNERS]);
        if self.contact.needs_normals() {
            for c in 0..face.corners() {
                let node = surface.field[patch.face][c];
                let normal: NodalNormal = surface.normal(node, |f| self.placed(&surface.faces[f]));
                (normals[c], units[c]) = (Some(normal), normal.unit);
            }
        }
        let face = FaceInPlace { face, placed: self.placed(face), normals: units, plane: surface.plane };
        let (tool, seen) = match &self.contact.parts.target {
            FieldTarget::Tool(_) => (self.tool, None),
            FieldTarget::Faces(faces) => (None, Some((faces, self.placed(&faces.surface.faces[patch.target])))),
        };
        let (line, degree) = (self.line(), self.contact.overlap_degree(patch));
        let mut patch = PatchInPlace { face, normals, tool, seen, patch: *patch, interval: [-1.0, 1.0], line, degree };
        if surface.plane {
            patch.find_interval();
        }
        patch
    }

    /// What the tangents of the node follow, in space.
    fn line(&self) -> Option<MaterialLine> {
        let surface = &self.contact.parts.surface;
        let (patch, corner) = self.support.patches.first().filter(|_| !surface.plane)?;
        let nodes = surface.line(surface.field[patch.face][*corner]);
        let [from, to] = nodes.map(|node| self.position(node));
        Some(MaterialLine { d: to - from, nodes })
    }

    /// Nodes of a face of the target.
    fn seen_nodes(&self, face: usize) -> &'a [usize] {
        self.contact.parts.target.as_faces().map_or(&[], |faces| &faces.surface.faces[face].nodes)
    }

    pub(super) fn list_columns(&self, patch: &Patch, columns: &mut Vec<PointColumn>) {
        columns.clear();
        let own = &self.contact.parts.surface.faces[patch.face].nodes;
        let seen = match &self.contact.parts.target {
            FieldTarget::Tool(_) => &[][..],
            FieldTarget::Faces(faces) => &faces.surface.faces[patch.target].nodes,
        };
        let place = |nodes: &[usize], node: usize| nodes.iter().position(|&other| other == node);
        for &node in &self.support.nodes {
            let (own, seen) = (place(own, node), place(seen, node));
            columns.extend((0..self.axes()).map(|axis| PointColumn::Node { axis, own, seen, node }));
        }
        columns.extend((0..self.motion().len()).map(PointColumn::Tool));
    }

    /// Derivatives of the sums of area vectors at the corners of a face along each unknown.
    fn turning(&self, patch: &Patch, out: &mut Vec<[Vec3; CORNERS]>) {
        let (surface, axes) = (&self.contact.parts.surface, self.axes());
        out.clear();
        out.resize(self.u.len(), [Vec3::zero(); CORNERS]);
        if !self.contact.needs_normals() {
            return;
        }
        let corners = surface.faces[patch.face].corners();
        for (c, &node) in surface.field[patch.face][..corners].iter().enumerate() {
            surface.normal_rates(
                node,
                |f| self.placed(&surface.faces[f]),
                |node, rates| {
                    if let Ok(place) = self.support.nodes.binary_search(&node) {
                        (0..axes).for_each(|axis| out[place * axes + axis][c] += rates[axis]);
                    }
                },
            );
        }
    }

    /// Deformed over undeformed area of the faces of the patches, and its derivatives along each unknown; one for a tip.
    pub fn stretch(&self) -> (f64, Vec<f64>) {
        let (surface, axes) = (&self.contact.parts.surface, self.axes());
        let (mut areas, mut slopes) = ([0.0; 2], vec![0.0; self.u.len()]);
        for (number, corner) in self.support.faces() {
            let face = &surface.faces[number];
            areas[1] += surface.corner_area(face, &face.at_rest(&self.contact.parts.mesh), corner).0;
            let (area, rates) = surface.corner_area(face, &self.placed(face), corner);
            areas[0] += area;
            for (node, rate) in face.nodes.iter().zip(rates) {
                let Ok(place) = self.support.nodes.binary_search(node) else { continue };
                (0..axes).for_each(|axis| slopes[place * axes + axis] += rate[axis]);
            }
        }
        if areas[1] == 0.0 {
            return (1.0, slopes);
        }
        slopes.iter_mut().for_each(|slope| *slope /= areas[1]);
        (areas[0] / areas[1], slopes)
    }

    /// First sweep. None where the node sees nothing, or a ray runs along the target.
    pub fn sum(&self, recall: Recall, derivatives: bool, sums: &mut NodeSums) -> Option<()> {
        let n = self.u.len();
        sums.points.clear();
        sums.rates.clear();
        sums.starts.clear();
        let (mut area, mut moments, mut place) = (0.0, [0.0; COUNT], Vec3::zero());
        let mut turning = Vec::new();
        for (number, (patch, corner)) in self.support.patches.iter().enumerate() {
            if let Some(landing) = patch.tip {
                self.sum_tip((number, patch, landing), recall, derivatives, sums)?;
                continue;
            }
            let in_place = self.patch(patch);
            let surface = &self.contact.parts.surface;
            let rest = in_place.face.face.at_rest(&self.contact.parts.mesh);
            let mut ends = Vec::new();
            if derivatives {
                self.list_columns(patch, &mut sums.columns);
                self.turning(patch, &mut turning);
                ends.extend(
                    sums.columns.iter().zip(&turning).map(|(column, turning)| in_place.interval_rates(column, turning)),
                );
            }
            let depends = |(column, turning)| in_place.depends(column, turning);
            let active: Vec<bool> = sums.columns.iter().zip(&turning).map(depends).collect();
            let still = !derivatives || (in_place.tool.is_some() && !surface.plane);
            for spot in in_place.spots(&RULE, derivatives) {
                let xi = spot.xi;
                let at = in_place.face.at(xi);
                let (sight, n_out, gap, y) = in_place.look(&at)?;
                if matches!(&sight, Sight::Tool(foot) if foot.beyond.is_some() && !surface.plane) {
                    continue;
                }
                let face = in_place.face.face;
                let value = || (surface.density_at(face, &rest, xi), [0.0; 2]);
                let density = if still { value() } else { surface.density(face, &rest, xi) };
                let function = (at.corners.n[*corner], at.corners.dn[*corner]);
                let facing = in_place.facing(xi, n_out);
                let weight = spot.weight * density.0 * facing[0] * function.0;
                let e = in_place.tangents(n_out);
                let touched = recall(patch, xi);
                let v = touched.map_or(Vec3::zero(), |touched| touched.now - at.x);
                let slip = e.map(|e| e.dot(v));
                let shape = at.shape;
                let point = FieldPoint { patch: number, weight, shape, gap, n: n_out, e, slip, y, sight };
                if derivatives {
                    sums.starts.push(sums.rates.len());
                    let before = touched.and_then(|touched| touched.face).map(|(face, _)| self.seen_nodes(face));
                    for (j, (column, (ends, turning))) in sums.columns.iter().zip(ends.iter().zip(&turning)).enumerate()
                    {
                        let node = if let PointColumn::Node { node, .. } = column { Some(node) } else { None };
                        if active[j] || node.is_some_and(|node| before.is_some_and(|nodes| nodes.contains(node))) {
                            let shapes = (&density, &function, &touched);
                            let rates = in_place.rates(&point, column, (&spot, &at, facing), shapes, (ends, turning));
                            sums.rates.push((j, rates));
                        }
                    }
                }
                sums.points.push(point);
            }
        }
        for point in &sums.points {
            area += point.weight;
            place += (point.y - point.n * point.gap) * point.weight;
            for (moment, value) in moments.iter_mut().zip([-point.gap, point.slip[0], point.slip[1]]) {
                *moment += point.weight * value;
            }
        }
        if area <= 0.0 {
            return None;
        }
        (sums.area, sums.place) = (area, place * area.recip());
        sums.y = moments.map(|moment| moment / area);
        if derivatives {
            self.differentiate(n, sums);
        }
        Some(())
    }

    fn differentiate(&self, n: usize, sums: &mut NodeSums) {
        let NodeSums { area, y, gradients, points, rates, starts, .. } = sums;
        gradients.clear();
        gradients.resize(COUNT * n, 0.0);
        for (point, range) in points.iter().zip(ranges(starts, rates.len())) {
            for &(j, ref rate) in &rates[range] {
                let values = [-point.gap - y[0], point.slip[0] - y[1], point.slip[1] - y[2]];
                let slopes = [-rate.gap, rate.slip[0], rate.slip[1]];
                for c in 0..COUNT {
                    gradients[c * n + j] += rate.weight * values[c] + point.weight * slopes[c];
                }
            }
        }
        gradients.iter_mut().for_each(|gradient| *gradient /= *area);
    }

    /// Forces of a unit of each stress on each unknown.
    pub fn find_forces(&self, sums: &mut NodeSums) {
        let n = self.u.len();
        let NodeSums { forces, points, .. } = sums;
        forces.clear();
        forces.resize(COUNT * n, 0.0);
        for point in points.iter() {
            for (c, direction) in [-point.n, point.e[0], point.e[1]].into_iter().enumerate() {
                self.load(point, direction * point.weight, &mut forces[c * n..(c + 1) * n]);
            }
        }
    }

    /// Adds what a force on the surface at a point does to the unknowns: `-N_L f` and the opposite on the target.
    fn load(&self, point: &FieldPoint, f: Vec3, rows: &mut [f64]) {
        let (patch, axes) = (&self.support.patches[point.patch].0, self.axes());
        let mut push = |nodes: &[usize], shape: &[f64], sign: f64| {
            for (node, n) in nodes.iter().zip(shape) {
                let Ok(place) = self.support.nodes.binary_search(node) else { continue };
                (0..axes).for_each(|axis| rows[place * axes + axis] += sign * n * f[axis]);
            }
        };
        push(&self.contact.parts.surface.faces[patch.face].nodes, &point.shape.n, -1.0);
        match (&point.sight, &self.tool) {
            (Sight::Face(hit), None) => push(self.seen_nodes(patch.target), &hit.shape.n, 1.0),
            (Sight::Tool(_) | Sight::Tip, Some(tool)) => {
                let received = tool.receive(point.y, f);
                let first = self.support.nodes.len() * axes;
                rows[first..].iter_mut().zip(received).for_each(|(row, f)| *row += f);
            }
            _ => {}
        }
    }

    /// Second sweep: adds `factor` times what turning and moving stresses `t` does to the tangent.
    pub fn add_geometric(&self, t: [f64; COUNT], factor: f64, sums: &NodeSums, tangent: &mut [f64]) {
        let (n, axes) = (self.u.len(), self.axes());
        let NodeSums { points, rates, starts, .. } = sums;
        let first = self.support.nodes.len() * axes;
        let spin_rates: Vec<_> =
            self.tool.iter().flat_map(|tool| (first..n).map(|j| tool.spin_rates(j - first))).collect();
        for (point, range) in points.iter().zip(ranges(starts, rates.len())) {
            let patch = &self.support.patches[point.patch].0;
            let traction = (point.e[0] * t[1] + point.e[1] * t[2] - point.n * t[0]) * factor;
            let place = |&node: &usize| self.support.nodes.binary_search(&node).ok();
            let own: Vec<Option<usize>> =
                self.contact.parts.surface.faces[patch.face].nodes.iter().map(place).collect();
            let seen = if let Sight::Face(_) = &point.sight { self.seen_nodes(patch.target) } else { &[] };
            let seen: Vec<Option<usize>> = seen.iter().map(place).collect();
            for &(j, ref rate) in &rates[range] {
                let turned = (rate.e[0] * t[1] + rate.e[1] * t[2] - rate.n * t[0]) * factor;
                let mut push = |places: &[Option<usize>], shape: &ShapeFunctions, at: [f64; 2], sign: f64| {
                    for (k, place) in places.iter().enumerate() {
                        let Some(place) = *place else { continue };
                        let (value, [a, b]) = (shape.n[k], shape.dn[k]);
                        let slope = rate.weight * value + point.weight * (a * at[0] + b * at[1]);
                        let change = (traction * slope + turned * (point.weight * value)) * sign;
                        (0..axes).for_each(|axis| tangent[(place * axes + axis) * n + j] += change[axis]);
                    }
                };
                push(&own, &point.shape, rate.xi, -1.0);
                match (&point.sight, &self.tool) {
                    (Sight::Face(hit), None) => push(&seen, &hit.shape, rate.s, 1.0),
                    (Sight::Tool(_) | Sight::Tip, Some(tool)) => {
                        let along = j.checked_sub(first).map(|along| (along, &spin_rates[along]));
                        let f = traction * point.weight;
                        let df = traction * rate.weight + turned * point.weight;
                        let received = tool.receive_rate((point.y, f), (rate.y, df), along);
                        (first..n).for_each(|row| tangent[row * n + j] += received[row - first]);
                    }
                    _ => {}
                }
            }
        }
    }

    /// Resultant of stresses `t` on the surface, the mean direction of pressure, and the mean first and second tangents.
    pub fn directions(&self, sums: &NodeSums) -> [Vec3; COUNT] {
        let mut mean = [Vec3::zero(); COUNT];
        for point in &sums.points {
            for (mean, direction) in mean.iter_mut().zip([-point.n, point.e[0], point.e[1]]) {
                *mean += direction * (point.weight / sums.area);
            }
        }
        mean
    }
}

/// Ranges that begin at `starts` and end where the next begins, the last at `end`.
fn ranges(starts: &[usize], end: usize) -> impl Iterator<Item = Range<usize>> + '_ {
    starts.iter().enumerate().map(move |(k, &start)| start..starts.get(k + 1).copied().unwrap_or(end))
}
