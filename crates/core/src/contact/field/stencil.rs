//! The stencil of one node of the field: weighted gap and slips with their gradients, and the forces of its stresses.
//!
//! With `y = (-g_i, s_i)` the coordinates and `t = (p_i, tau_i)` the stresses over them, the forces are `F = H(u) t`, and the tangent is
//! `H C G + sum_c t_c dH_c`, `G = dy/du`. Two sweeps over the points of the node: the first finds `y`, `G` and `H`; then the law
//! is asked; the second adds what turning and moving the stresses does.

use super::contact::FieldContact;
use super::corners::BodyCorner;
use super::cover::Patch;
use super::dual::BLENDED;
use super::face::{FieldFace, ShapeFunctions};
use super::nodes::NodesInPlace;
use super::point::{Facing, PatchPoint, PointRates, Sight};
use super::points::{PatchPoints, Recall};
use super::support::FieldSearch;
use super::triad::MaterialLine;
use super::twist::{Twist, spin};
use crate::mesh::Side;
use crate::tensor::Vec3;
use std::rc::Rc;
use vertex::VertexShare;

mod vertex;

/// Coordinates of a node: penetration and two slips.
pub const COUNT: usize = 3;

/// A point as one node sums it.
#[derive(Debug, Clone, Copy)]
struct NodePoint {
    /// Its patch among those of the node, and its number there.
    of: (usize, usize),
    /// Undeformed area it stands for times the node's function there, and the derivative of that along the share of the vertex.
    weight: f64,
    shift: f64,
    /// The same area times what of the function is dual.
    dual: f64,
    /// The two tangents, and the slip of the increment along them.
    e: [Vec3; 2],
    slip: [f64; 2],
}

/// The function of a node at a point, with its slopes.
type NodeFunction = (f64, [f64; 2]);

/// Derivatives of what one node makes of a point, along one unknown.
#[derive(Debug, Clone, Copy)]
struct NodeRates {
    weight: f64,
    dual: f64,
    e: [Vec3; 2],
    slip: [f64; 2],
}

impl NodeRates {
    /// Derivatives of penetration and slips at the point, whose own are `of_point`; of the line behind it there are none.
    fn slopes(&self, of_point: Option<&PointRates>) -> [f64; COUNT] {
        [of_point.map_or(0.0, |rate| -rate.gap), self.slip[0], self.slip[1]]
    }
}

/// The triad that a point had at the accepted state, moved with the tool, and the line that its tangents follow.
#[derive(Debug, Clone, Copy)]
struct CarriedTriad {
    line: Option<MaterialLine>,
    facing: Facing,
    e: [Vec3; 2],
}

impl CarriedTriad {
    fn twist(&self, point: &PatchPoint, e: [Vec3; 2], middle: &FaceMiddle) -> Twist {
        // In the plane there is one line alone.
        let [re, im] = self.line.map_or([1.0, 0.0], |_| self.turned(&e, &self.e, &middle.tangents));
        let [cosine, sine] = [re, im].map(|z| z / re.hypot(im));
        let triad = [point.n, e[0] * cosine + e[1] * sine, e[1] * cosine - e[0] * sine];
        Twist::of(&triad, &[self.facing.n, self.e[0], self.e[1]], point.v - point.n * point.gap)
    }

    /// Cosine and sine, by a common factor, of the angle by which the surface turns about the gap beyond the line that its tangents follow:
    /// the rotation of its gradient in the plane, linear in both pairs of tangents and those in the middle of the face.
    fn turned(&self, e: &[Vec3; 2], f: &[Vec3; 2], tangents: &[Vec3; 2]) -> [f64; 2] {
        tangents.iter().zip(&self.facing.contravariant).fold([0.0; 2], |[re, im], (now, dual)| {
            let ([a, b], [c, d]) = (e.map(|e| e.dot(*now)), f.map(|f| f.dot(*dual)));
            [re + a * c + b * d, im + b * c - a * d]
        })
    }

    /// Rates of both tangents where the place moves on the face.
    fn rates(&self, dxi: [f64; 2]) -> (Vec3, [Vec3; 2]) {
        let dn = self.facing.slopes[0] * dxi[0] + self.facing.slopes[1] * dxi[1];
        (dn, self.line.map_or([dn.left(), Vec3::zero()], |line| line.rates(None, (self.facing.n, dn), &self.e)))
    }
}

/// The middle of a face in space.
struct FaceMiddle<'a> {
    face: &'a FieldFace,
    shape: ShapeFunctions,
    tangents: [Vec3; 2],
}

impl FaceMiddle<'_> {
    /// Derivatives of its tangents along a displacement of a node.
    fn rates(&self, node: usize, axis: usize) -> [Vec3; 2] {
        let slopes = self.face.nodes.iter().position(|&own| own == node).map(|k| self.shape.dn[k]);
        slopes.unwrap_or_default().map(|slope| Vec3::axis(axis) * slope)
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
    patches: Vec<Rc<PatchPoints>>,
    points: Vec<NodePoint>,
    /// Where the unknowns of each patch are among those of the node, patch after patch; behind them those of the line that
    /// tangents follow which the patch does not have.
    columns: Vec<usize>,
    /// Where those of each patch begin.
    starts: Vec<usize>,
    /// Derivatives of each point along them.
    rates: Vec<NodeRates>,
    /// The number of the vertex among the points, where it lies deeper than the mean of the node.
    vertex: Option<usize>,
    held: VertexShare,
    values: Vec<f64>,
    block: Vec<f64>,
    turned: Vec<Vec3>,
}

/// A stencil at values of its unknowns.
pub struct StencilInPlace<'a> {
    /// What a search found,
    found: &'a FieldSearch,
    /// and its number there.
    slot: usize,
    /// Its nodes and the tool.
    pub at: NodesInPlace<'a>,
}

impl<'a> StencilInPlace<'a> {
    /// The stencil of a slot at values `u` of its unknowns.
    pub fn new(contact: &'a FieldContact, (found, slot): (&'a FieldSearch, usize), u: &'a [f64]) -> Self {
        let nodes = &found.supports[slot].nodes;
        let motion = nodes.len() * contact.parts.dofs.per_node();
        let tool =
            contact.parts.target.as_tool().filter(|_| motion < u.len()).map(|rigid| rigid.in_place(&u[motion..]));
        Self { found, slot, at: NodesInPlace { contact, nodes, u, arcs: &found.arcs, tool } }
    }

    /// Whether it sees something.
    pub fn sees(&self) -> bool {
        !self.found.supports[self.slot].patches.is_empty()
    }

    /// Gap of a node that was closed and sees nothing any more.
    pub fn parted(&self) -> f64 {
        self.found.supports[self.slot].parted
    }

    /// How far such a node has slid along its shear, where it slipped.
    pub fn slid(&self) -> [f64; 2] {
        self.found.supports[self.slot].slid
    }

    /// What corners of the body take of the node at least.
    pub fn taken(&self) -> f64 {
        let patches = self.found.supports[self.slot].patches.iter();
        patches.map(|&(number, corner)| self.found.patches[number].patch.taken[corner]).reduce(f64::min).unwrap_or(0.0)
    }

    /// Whether the target came through the body here.
    pub fn is_through(&self) -> bool {
        self.found.supports[self.slot].through
    }

    /// What its history knows it by: of a foot of a tip, or a corner, the face on which that lies; of a node over a body a face that it sees.
    pub fn segment(&self) -> f64 {
        let Some((patch, _)) = self.patches().next() else { return 0.0 };
        let by_point = patch.tip.is_some() || patch.corner.is_some();
        let seen = self.at.contact.parts.target.as_faces().map_or(0, |_| patch.target);
        (if by_point { patch.face } else { seen }) as f64
    }

    /// The faces of its patches.
    pub fn faces(&self) -> impl Iterator<Item = usize> + '_ {
        self.patches().map(|(patch, _)| patch.face)
    }

    /// Its patches; the node's own number among the corners of each face.
    fn patches(&self) -> impl Iterator<Item = (&'a Patch, usize)> {
        let found = self.found;
        found.supports[self.slot].patches.iter().map(|&(number, corner)| (&found.patches[number].patch, corner))
    }

    /// The undeformed area over which it stands, point by point, around each corner of the sides of both bodies.
    pub fn sides<'b>(&'b self, sums: &'b NodeSums) -> impl Iterator<Item = (Side, usize, f64)> + 'b {
        let (parts, patches) = (&self.at.contact.parts, self.patches().collect::<Vec<_>>());
        sums.points.iter().flat_map(move |&NodePoint { of: (number, k), weight, .. }| {
            let (patch, point) = (patches[number].0, &sums.patches[number].points[k]);
            let seen = parts.target.as_faces().zip(match &point.sight {
                Sight::Face(hit) | Sight::Corner(hit) => Some(hit.s),
                _ => None,
            });
            let seen = seen.map(|(faces, s)| (&faces.surface.faces[patch.target], s));
            [Some((&parts.surface.faces[patch.face], point.xi)), seen].into_iter().flatten().flat_map(
                move |(face, xi)| {
                    let functions = face.corner_functions(xi);
                    let around = move |corner| (face.side, face.corner_node(corner), weight * functions.n[corner]);
                    (0..face.corners()).map(around)
                },
            )
        })
    }

    /// Mean outward normal of the smooth surface that the node sees; of a body that is narrow against its faces of what is nearer than in the mean.
    pub fn facing(&self, sums: &NodeSums, is_narrow: bool) -> Vec3 {
        let patches: Vec<_> = self.patches().collect();
        let target = self.at.contact.parts.target.as_faces();
        let normal = |of: usize, point: &PatchPoint| match (&point.sight, target) {
            (Sight::Face(hit), Some(faces)) => {
                let (n, [a, b]) = (hit.normal(), hit.tangents);
                let (_, [along, across]) = faces.surface.rise(patches[of].0.target, &self.at.arcs.seen, hit.s);
                (a + n * along).cross(b + n * across).unit()
            }
            _ => -point.n,
        };
        let (mut all, mut nearest) = (Vec3::zero(), Vec3::zero());
        for &NodePoint { of: (number, k), weight, .. } in &sums.points {
            let point = &sums.patches[number].points[k];
            let facing = normal(number, point);
            all += facing * weight;
            // Dual functions are negative in part.
            nearest += facing * (weight.abs() * (-sums.y[0] - point.gap).max(0.0).powi(2));
        }
        if is_narrow && target.is_some() && nearest.norm() > 0.0 { nearest.unit() } else { all.unit() }
    }

    /// The mean of the field with values `pressure` at its slots over what the node sees, and of the node's own function there.
    pub fn means(&self, sums: &NodeSums, pressure: impl Fn(usize) -> f64) -> [f64; 2] {
        let (contact, patches) = (self.at.contact, self.patches().collect::<Vec<_>>());
        let (surface, piece, mut means) = (&contact.parts.surface, self.slot % contact.pieces, [0.0; 2]);
        for &NodePoint { of: (number, k), weight, .. } in &sums.points {
            let (patch, corner) = patches[number];
            let face = &surface.faces[patch.face];
            let functions = face.corner_functions(sums.patches[number].points[k].xi).n;
            let corners = surface.field[patch.face][..face.corners()].iter().zip(functions);
            let here: f64 = corners.map(|(&node, n)| n * pressure(contact.slot(node, piece))).sum();
            means = [means[0] + weight * here, means[1] + weight * functions[corner]];
        }
        means.map(|sum| sum / sums.area)
    }

    /// What the tangents of the node follow, in space.
    pub fn line(&self) -> Option<MaterialLine> {
        let surface = &self.at.contact.parts.surface;
        let (patch, corner) = self.patches().next().filter(|_| !surface.plane)?;
        let of_corner = self.at.contact.corner_of(self.slot).map(BodyCorner::line);
        let nodes = of_corner.unwrap_or_else(|| surface.line(surface.field[patch.face][corner]));
        let [from, to] = nodes.map(|node| self.at.position(node));
        Some(MaterialLine { d: to - from, nodes })
    }

    /// Deformed over undeformed area of the faces of the patches, and its derivatives along each unknown; one for a tip.
    pub fn stretch(&self) -> (f64, Vec<f64>) {
        let (at, contact) = (&self.at, self.at.contact);
        let (surface, axes) = (&contact.parts.surface, at.axes());
        let (mut areas, mut slopes) = ([0.0; 2], vec![0.0; at.u.len()]);
        for (number, corner) in self.found.faces(self.slot) {
            let face = &surface.faces[number];
            areas[1] += surface.corner_area(face, &face.at_rest(&contact.parts.mesh), corner).0;
            let (area, rates) = surface.corner_area(face, &at.placed(face), corner);
            areas[0] += area;
            for (node, rate) in face.nodes.iter().zip(rates) {
                let Some(place) = at.place(*node) else { continue };
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
    /// `carried` is what the tangents of the node followed at the accepted state, moved with the tool, in space.
    pub fn sum(&self, (recall, carried): (Recall, Option<Vec3>), derivatives: bool, sums: &mut NodeSums) -> Option<()> {
        sums.patches.clear();
        sums.points.clear();
        sums.columns.clear();
        sums.starts.clear();
        sums.rates.clear();
        sums.vertex = None;
        // How far the mean of a node is from the place of its vertex, over that of ordinary functions; half at least, since the dual part
        // of it in second degree knows no bulge.
        let mut apart = 1.0;
        let (line, surface) = (self.line(), &self.at.contact.parts.surface);
        for &(number, corner) in &self.found.supports[self.slot].patches {
            let patch = &self.found.patches[number];
            let left = patch.patch.left[corner];
            sums.starts.push(sums.columns.len());
            self.list_columns((&patch.nodes, line), &mut sums.columns);
            let columns = &sums.columns[sums.starts[sums.patches.len()]..];
            let unknowns = patch.nodes.len() * self.at.axes() + self.at.motion().len();
            sums.values.clear();
            sums.values.extend(columns[..unknowns].iter().map(|&column| self.at.u[column]));
            let at = NodesInPlace { nodes: &patch.nodes, u: &sums.values, ..self.at };
            let points = PatchPoints::of((self.found.number, number, patch), &at, recall, derivatives)?;
            let face = &surface.faces[patch.patch.face];
            let shape = face.shape(face.middle());
            let middle = FaceMiddle { face, shape, tangents: shape.tangents(at.placed(face).nodes(), surface.plane) };
            for (k, point) in points.points.iter().enumerate() {
                if point.vertex.is_some_and(|vertex| vertex != corner || sums.vertex.is_some()) {
                    continue;
                }
                if point.vertex.is_some() {
                    (sums.vertex, apart) = (Some(sums.points.len()), (1.0 - patch.patch.dual).max(BLENDED));
                }
                let tangents = |line: Option<MaterialLine>, n: Vec3| {
                    line.map_or([n.left(), Vec3::axis(2)], |line| line.tangents(n))
                };
                let e = tangents(line, point.n);
                let facing = point.touched.and_then(|touched| touched.facing);
                let turn = facing.map(|facing| {
                    let line = line.zip(carried).map(|(line, d)| MaterialLine { d, ..line });
                    CarriedTriad { line, facing, e: tangents(line, facing.n) }
                });
                let twist = turn.map(|turn| turn.twist(point, e, &middle));
                let way = twist.map_or(point.v, |twist| twist.way);
                let functions = [&point.functions, &point.dual];
                let [weight, dual] = functions.map(|functions| left * point.weight * functions.n[corner]);
                let (of, slip) = ((sums.patches.len(), k), e.map(|e| e.dot(way)));
                sums.points.push(NodePoint { of, weight, shift: -weight, dual, e, slip });
                if derivatives {
                    let functions = functions
                        .map(|functions| (left * functions.n[corner], functions.dn[corner].map(|slope| left * slope)));
                    let (of_point, node, turn) = ((point, points.rates(k)), (&at, line, functions, e), turn.zip(twist));
                    let turn = turn.map(|(carried, twist)| (carried, twist, &middle));
                    differentiate(of_point, node, turn, columns.len(), &mut sums.rates);
                }
            }
            sums.patches.push(points);
        }
        sums.starts.push(sums.columns.len());
        let (mut area, mut moments, mut place) = (0.0, [0.0; COUNT], Vec3::zero());
        for NodePoint { of: (patch, k), weight, dual, slip, .. } in &sums.points {
            let point = &sums.patches[*patch].points[*k];
            area += weight;
            moments[0] -= dual * left_out(point, self.at.contact.size_at(self.slot))[0] * point.bulge;
            place += (point.y - point.n * point.gap) * *weight;
            for (moment, value) in moments.iter_mut().zip([-point.gap, slip[0], slip[1]]) {
                *moment += weight * value;
            }
        }
        if area <= 0.0 {
            return None;
        }
        (sums.area, sums.place) = (area, place * area.recip());
        sums.y = moments.map(|moment| moment / area);
        if derivatives {
            sums.find_gradients(self.at.u.len(), self.at.contact.size_at(self.slot));
        }
        sums.press_vertex(apart * self.at.contact.size_at(self.slot), derivatives.then_some(self.at.u.len()));
        Some(())
    }

    /// Lists where the unknowns of a patch with these nodes are, and those of the line behind them.
    fn list_columns(&self, (nodes, line): (&[usize], Option<MaterialLine>), columns: &mut Vec<usize>) {
        let axes = self.at.axes();
        let of = |node: usize| self.at.place(node).into_iter().flat_map(move |place| place * axes..(place + 1) * axes);
        columns.extend(nodes.iter().flat_map(|&node| of(node)));
        columns.extend(self.at.nodes.len() * axes..self.at.u.len());
        columns.extend(line.into_iter().flat_map(|line| beside(line, nodes).flat_map(of)));
    }

    /// Forces of a unit of each stress on each unknown.
    pub fn find_forces(&self, sums: &mut NodeSums) {
        let (mut forces, mut held) = (std::mem::take(&mut sums.forces), std::mem::take(&mut sums.held.forces));
        self.forces_by(sums, |_, point| point.weight, &mut forces);
        if let Some(vertex) = sums.vertex {
            let share = sums.held.share;
            self.forces_by(sums, |_, point| point.shift, &mut held[0]);
            self.forces_by(sums, |k, _| if k == vertex { share } else { 0.0 }, &mut held[1]);
        }
        (sums.forces, sums.held.forces) = (forces, held);
    }

    /// The same of any weights of the points.
    fn forces_by(&self, sums: &NodeSums, weight: impl Fn(usize, &NodePoint) -> f64, forces: &mut Vec<f64>) {
        let (n, axes) = (self.at.u.len(), self.at.axes());
        let NodeSums { points, patches, .. } = sums;
        forces.clear();
        forces.resize(COUNT * n, 0.0);
        let mut last = usize::MAX;
        let (mut own, mut seen) = (Vec::new(), Vec::new());
        for (number, here) in points.iter().enumerate() {
            let (NodePoint { of: (patch, k), e, .. }, weight) = (here, weight(number, here));
            let point = &patches[*patch].points[*k];
            if last != *patch {
                [own, seen] = self.loaded(*patch);
                last = *patch;
            }
            for (c, direction) in [-point.n, e[0], e[1]].into_iter().enumerate() {
                let (f, rows) = (direction * weight, &mut forces[c * n..(c + 1) * n]);
                let mut push = |places: &[usize], shape: &[f64], sign: f64| {
                    for (place, n) in places.iter().zip(shape) {
                        (0..axes).for_each(|axis| rows[place + axis] += sign * n * f[axis]);
                    }
                };
                push(&own, &point.shape.n, -1.0);
                match (&point.sight, &self.at.tool) {
                    (Sight::Face(hit) | Sight::Corner(hit), None) => push(&seen, &hit.shape.n, 1.0),
                    (Sight::Tool(_) | Sight::Tip, Some(tool)) => {
                        let received = tool.receive(point.y, f);
                        let first = self.at.nodes.len() * axes;
                        rows[first..].iter_mut().zip(received).for_each(|(row, f)| *row += f);
                    }
                    _ => {}
                }
            }
        }
    }

    /// First unknowns of the nodes of the face of a patch, and of those of the face that it sees, which its forces load.
    fn loaded(&self, patch: usize) -> [Vec<usize>; 2] {
        let (patch, _) = self.found.supports[self.slot].patches[patch];
        let patch = &self.found.patches[patch].patch;
        let own = &self.at.contact.parts.surface.faces[patch.face].nodes[..];
        let seen = if patch.tip.is_some() { &[] } else { self.at.seen_nodes(patch.target) };
        let axes = self.at.axes();
        [own, seen].map(|nodes| nodes.iter().filter_map(|&node| self.at.place(node)).map(|k| k * axes).collect())
    }

    /// Second sweep: adds `factor` times what turning and moving stresses `t` does to the tangent.
    pub fn add_geometric(&self, t: [f64; COUNT], factor: f64, sums: &mut NodeSums, tangent: &mut [f64]) {
        let (n, axes) = (self.at.u.len(), self.at.axes());
        let NodeSums { patches, points, rates, columns, starts, block, turned, vertex, held, .. } = sums;
        let first = self.at.nodes.len() * axes;
        let spin_rates: Vec<_> =
            self.at.tool.iter().flat_map(|tool| (first..n).map(|j| tool.spin_rates(j - first))).collect();
        let (mut points, mut rates) = (points.iter().peekable(), &rates[..]);
        for (number, patch) in patches.iter().enumerate() {
            let columns = &columns[starts[number]..starts[number + 1]];
            let [own, seen] = self.loaded(number);
            let m = columns.len();
            block.clear();
            block.resize((own.len() + seen.len()) * axes * m, 0.0);
            while let Some(here) = points.next_if(|point| point.of.0 == number) {
                let point = &patch.points[here.of.1];
                let (of_node, rest) = rates.split_at(m);
                rates = rest;
                let traction = (here.e[0] * t[1] + here.e[1] * t[2] - point.n * t[0]) * factor;
                let of_point = patch.rates(here.of.1);
                let still = PointRates::default();
                let each = || of_node.iter().enumerate().map(|(j, node)| (node, of_point.get(j).unwrap_or(&still)));
                turned.clear();
                turned
                    .extend(each().map(|(node, rate)| (node.e[0] * t[1] + node.e[1] * t[2] - rate.n * t[0]) * factor));
                let push = |rows: &mut [f64], shape: &ShapeFunctions, on_target: bool| {
                    let (sign, weight) = (if on_target { 1.0 } else { -1.0 }, here.weight);
                    for (k, rows) in rows.chunks_exact_mut(axes * m).enumerate() {
                        let (value, [a, b]) = (shape.n[k] * sign, shape.dn[k].map(|dn| dn * sign));
                        for (j, ((node, rate), turned)) in each().zip(turned.iter()).enumerate() {
                            let at = if on_target { rate.s } else { rate.xi };
                            let slope = node.weight * value + weight * (a * at[0] + b * at[1]);
                            let change = traction * slope + *turned * (weight * value);
                            (0..axes).for_each(|axis| rows[axis * m + j] += change[axis]);
                        }
                    }
                };
                let (on_own, on_seen) = block.split_at_mut(own.len() * axes * m);
                push(on_own, &point.shape, false);
                match (&point.sight, &self.at.tool) {
                    (Sight::Face(hit) | Sight::Corner(hit), None) => push(on_seen, &hit.shape, true),
                    (Sight::Tool(_) | Sight::Tip, Some(tool)) => {
                        for (((node, rate), turned), &j) in each().zip(turned.iter()).zip(columns) {
                            let along = j.checked_sub(first).map(|along| (along, &spin_rates[along]));
                            let f = traction * here.weight;
                            let df = traction * node.weight + *turned * here.weight;
                            let received = tool.receive_rate((point.y, f), (rate.y, df), along);
                            (first..n).for_each(|row| tangent[row * n + j] += received[row - first]);
                        }
                    }
                    _ => {}
                }
            }
            for (rows, place) in block.chunks_exact(axes * m).zip(own.iter().chain(&seen)) {
                for (axis, row) in rows.chunks_exact(m).enumerate() {
                    let to = &mut tangent[(place + axis) * n..(place + axis + 1) * n];
                    row.iter().zip(columns).for_each(|(change, &j)| to[j] += change);
                }
            }
        }
        if vertex.is_some() {
            held.add_slopes(t.map(|t| t * factor), tangent);
        }
    }

    /// Resultant of stresses `t` on the surface, the mean direction of pressure, and the mean first and second tangents.
    pub fn directions(&self, sums: &NodeSums) -> [Vec3; COUNT] {
        let mut mean = [Vec3::zero(); COUNT];
        for NodePoint { of: (patch, k), weight, e, .. } in &sums.points {
            let n = sums.patches[*patch].points[*k].n;
            for (mean, direction) in mean.iter_mut().zip([-n, e[0], e[1]]) {
                *mean += direction * (weight / sums.area);
            }
        }
        mean
    }
}

impl NodeSums {
    fn find_gradients(&mut self, n: usize, size: f64) {
        let Self { area, y, gradients, patches, points, rates, columns, starts, .. } = self;
        gradients.clear();
        gradients.resize(COUNT * n, 0.0);
        let mut rates = &rates[..];
        for NodePoint { of: (patch, k), weight, dual, slip, .. } in points.iter() {
            let (columns, point) = (&columns[starts[*patch]..starts[*patch + 1]], &patches[*patch].points[*k]);
            let (of_node, rest) = rates.split_at(columns.len());
            rates = rest;
            let of_point = patches[*patch].rates(*k);
            let values = [-point.gap - y[0], slip[0] - y[1], slip[1] - y[2]];
            let [part, slope] = left_out(point, size);
            for (i, (node, &j)) in of_node.iter().zip(columns).enumerate() {
                let slopes = node.slopes(of_point.get(i));
                (0..COUNT).for_each(|c| gradients[c * n + j] += node.weight * values[c] + weight * slopes[c]);
                let bulge = of_point.get(i).map_or(0.0, |rate| part * rate.bulge + slope * rate.gap * point.bulge);
                gradients[j] -= node.dual * part * point.bulge + dual * bulge;
            }
        }
        gradients.iter_mut().for_each(|gradient| *gradient /= *area);
    }
}

/// Depth in the target, over the size of a face, from which on all of its bulge counts: as deep as the audit lets bodies lie in each other.
const DEEP: f64 = 0.1;

/// Part of the bulge of a face of this `size` that the dual part of a gap leaves out, less the deeper the face lies in the target; and its
/// slope along the gap.
fn left_out(point: &PatchPoint, size: f64) -> [f64; 2] {
    let t = (-point.gap / (DEEP * size)).clamp(0.0, 1.0);
    [1.0 - t * t * t * (10.0 - 15.0 * t + 6.0 * t * t), 30.0 * (t * (1.0 - t)).powi(2) / (DEEP * size)]
}

/// Nodes of a line that are not among those of a patch.
fn beside(line: MaterialLine, nodes: &[usize]) -> impl Iterator<Item = usize> {
    line.nodes.into_iter().filter(move |node| nodes.binary_search(node).is_err())
}

/// Adds what a node makes of the derivatives of a point, `functions` its function there and what of it is dual, with their slopes: along
/// the unknowns of the patch, and along `count` in all with those of the line beside it.
fn differentiate(
    (point, rates): (&PatchPoint, &[PointRates]),
    (at, line, functions, e): (&NodesInPlace, Option<MaterialLine>, [NodeFunction; 2], [Vec3; 2]),
    turn: Option<(CarriedTriad, Twist, &FaceMiddle)>,
    count: usize,
    out: &mut Vec<NodeRates>,
) {
    let (axes, still) = (at.axes(), PointRates::default());
    let way = turn.map_or(point.v, |(_, twist, _)| twist.way);
    let slopes = turn.map(|(_, twist, _)| e.map(|e| twist.slopes(e)));
    let beside: Vec<usize> = line.into_iter().flat_map(|line| beside(line, at.nodes)).collect();
    for j in 0..count {
        let rate = rates.get(j).unwrap_or(&still);
        let node = at.nodes.get(j / axes).copied();
        let behind = || j.checked_sub(rates.len()).map(|k| (beside[k / axes], k % axes));
        let column = node.map(|node| (node, j % axes)).or_else(behind);
        let turned = |line: MaterialLine| line.rates(column, (point.n, rate.n), &e);
        let de = line.map_or([rate.n.left(), Vec3::zero()], turned);
        let [weight, dual] = functions.map(|(value, slopes)| {
            rate.weight * value + point.weight * (slopes[0] * rate.xi[0] + slopes[1] * rate.xi[1])
        });
        let rest = match (&turn, &slopes) {
            (Some((carried, twist, middle)), Some(slopes)) => {
                let moved = rate.v - rate.n * point.gap - point.n * rate.gap;
                let spun = at.tool.filter(|_| node.is_none() && j < rates.len());
                let spun = spun.map_or(Vec3::zero(), |tool| tool.spins()[j - at.nodes.len() * axes]);
                let (f, (dn, df)) = (carried.e, carried.rates(rate.xi));
                let mut own = spin(&[point.n, e[0], e[1]], &[rate.n, de[0], de[1]]);
                if carried.line.is_some() {
                    let (g, dg) = (middle.tangents, column.map(|(node, axis)| middle.rates(node, axis)));
                    let [re, im] = carried.turned(&e, &f, &g);
                    let parts = [(&de, &f, &g), (&e, &df, &g), (&e, &f, &dg.unwrap_or_default())];
                    let slope = parts.into_iter().fold(0.0, |sum, (e, f, g)| {
                        let [dre, dim] = carried.turned(e, f, g);
                        sum + re * dim - im * dre
                    });
                    own += point.n * (slope / (re * re + im * im));
                }
                let spins = twist.beside([own, spun + spin(&[carried.facing.n, f[0], f[1]], &[dn, df[0], df[1]])]);
                slopes.map(|[along, turned]| along.dot(moved) + turned.dot(spins))
            }
            _ => e.map(|e| e.dot(rate.v)),
        };
        out.push(NodeRates { weight, dual, e: de, slip: [0, 1].map(|a| de[a].dot(way) + rest[a]) });
    }
}
