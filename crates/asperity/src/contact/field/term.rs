//! The field as a term of equilibrium: one stencil for each node of the field and each smooth piece of the target.

use super::attempt::FieldAttempt;
use super::configuration::{Configuration, TargetInPlace};
use super::cover::Patch;
use super::faces::{FaceRay, TargetFaces};
use super::stencil::{NodeSums, StencilInPlace, Support};
use super::surface::FieldSurface;
use super::tool::RigidTool;
use crate::Failure;
use crate::contact::increment::{CLOSED, ahead, reach};
use crate::contact::record::{ContactRecord, entry, largest_penetration};
use crate::contact::{ContactOptions, Move, Overlap};
use crate::interface::{Interface, Rule};
use crate::mesh::{Mesh, Side, Space};
use crate::system::{Attempt, Dofs, History, Instant, State, Term};
use crate::tensor::Vec3;
use crate::tool::{self, ProfileTool, Tip};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, RwLock};

/// What the field may touch.
#[derive(Debug)]
pub enum FieldTarget {
    /// A rigid tool.
    Tool(RigidTool),
    /// Faces of bodies.
    Faces(TargetFaces),
}

impl FieldTarget {
    /// A rigid tool, number `number` in the numbering of the unknowns.
    pub fn tool(tool: Arc<ProfileTool>, number: usize, dofs: &Dofs) -> Self {
        Self::Tool(RigidTool::new(tool, number, dofs))
    }
    /// A rigid tool in space.
    pub fn solid_tool(tool: Arc<tool::space::SpaceTool>, number: usize, dofs: &Dofs) -> Self {
        Self::Tool(RigidTool::in_space(tool, number, dofs))
    }
    /// Faces of bodies.
    pub fn faces(surface: FieldSurface, mesh: &Mesh) -> Self {
        Self::Faces(TargetFaces::new(surface, mesh))
    }
    /// The faces, if it is made of faces.
    pub fn as_faces(&self) -> Option<&TargetFaces> {
        match self {
            Self::Tool(_) => None,
            Self::Faces(faces) => Some(faces),
        }
    }
    /// The tool, if it is one.
    pub fn as_tool(&self) -> Option<&RigidTool> {
        match self {
            Self::Tool(rigid) => Some(rigid),
            Self::Faces(_) => None,
        }
    }
}

/// What a field is made of.
pub struct FieldParts {
    /// The user's name for it.
    pub name: String,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// What the coordinates mean.
    pub space: Space,
    /// The faces that carry the field.
    pub surface: FieldSurface,
    /// The whole outer boundary of the bodies behind the surface.
    pub boundary: Vec<Side>,
    /// What they may touch.
    pub target: FieldTarget,
    /// Whether that is the surface itself.
    pub itself: bool,
    /// Whether the user calls the target the surface: forces are reported on that.
    pub swapped: bool,
    /// The law of the interface.
    pub law: Rule,
    /// How it is computed.
    pub options: ContactOptions,
}

/// Contact whose stress is a field of nodal values.
pub struct FieldContact {
    name: String,
    pub(super) mesh: Arc<Mesh>,
    pub(super) dofs: Dofs,
    pub(super) surface: FieldSurface,
    pub(super) target: FieldTarget,
    itself: bool,
    swapped: bool,
    boundary: TargetFaces,
    pub(super) law: Rule,
    pub(super) options: ContactOptions,
    /// Penetration from which a node counts as closed.
    pub(super) least: f64,
    /// For each face of a target its smooth piece, counted from zero.
    labels: Vec<usize>,
    /// Number of smooth pieces of the target.
    pub(super) pieces: usize,
    pub(super) longest: f64,
    sizes: Vec<f64>,
    rule: Vec<(f64, f64)>,
}

impl FieldContact {
    /// A contact of these parts.
    pub fn new(parts: FieldParts) -> Self {
        let FieldParts { name, mesh, dofs, space, surface, boundary, mut target, itself, swapped, law, options } =
            parts;
        let boundary = TargetFaces::new(FieldSurface::whole(&mesh, &boundary, space, 1.0), &mesh);
        let [mut shortest, mut longest] = surface.sizes(&mesh);
        let (labels, pieces) = match &mut target {
            FieldTarget::Tool(rigid) => {
                rigid.sharpen(SMALL * shortest);
                (Vec::new(), rigid.pieces())
            }
            FieldTarget::Faces(faces) => labels(&faces.surface.pieces),
        };
        if let FieldTarget::Faces(faces) = &target {
            let [least, most] = faces.surface.sizes(&mesh);
            (shortest, longest) = (shortest.min(least), longest.max(most));
        }
        let size = |node: &super::surface::FieldNode| {
            node.support.iter().map(|&(f, _)| surface.size(f, &mesh)).fold(f64::INFINITY, f64::min)
        };
        let sizes = surface.nodes.iter().map(size).collect();
        let rule = rule();
        let least = CLOSED * shortest;
        Self {
            name,
            mesh,
            dofs,
            surface,
            target,
            itself,
            swapped,
            boundary,
            law,
            options,
            least,
            labels,
            pieces,
            longest,
            sizes,
            rule,
        }
    }

    /// The user's name for it.
    pub fn title(&self) -> &str {
        &self.name
    }
    /// The surface.
    pub fn surface(&self) -> &FieldSurface {
        &self.surface
    }
    /// What it may touch.
    pub fn target(&self) -> &FieldTarget {
        &self.target
    }
    /// The law of the interface.
    pub fn law(&self) -> &dyn Interface {
        self.law.first()
    }
    /// The largest penetration of a closed node in an accepted state.
    pub fn largest_penetration(&self, history: &History) -> f64 {
        largest_penetration(history, self.slots())
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.options
    }
    /// Where moments are taken about: the present place of a tool's reference point, or the origin.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.target.as_tool().map_or(Vec3::zero(), |rigid| rigid.at(u).reference())
    }

    /// Number of stencils: those of the nodes, then those of the tool's tips.
    pub(super) fn slots(&self) -> usize {
        self.nodal_slots() + self.tips().len()
    }
    /// Tips of the tool.
    pub(super) fn tips(&self) -> &[Tip] {
        self.target.as_tool().map_or(&[], RigidTool::tips)
    }
    /// Number of stencils of nodes.
    pub(super) fn nodal_slots(&self) -> usize {
        self.surface.nodes.len() * self.pieces
    }
    /// The node of the mesh that a record stands for; none for that of a tip.
    pub fn node_at(&self, record: usize) -> Option<usize> {
        self.node_of(record).map(|node| self.surface.nodes[node].node)
    }
    /// The node of a stencil; none for that of a tip.
    fn node_of(&self, slot: usize) -> Option<usize> {
        (slot < self.nodal_slots()).then(|| slot / self.pieces)
    }
    /// The stencil of a node of the field and a piece of the target.
    pub(super) fn slot(&self, node: usize, piece: usize) -> usize {
        node * self.pieces + piece
    }
    /// The smooth piece of a target's segment.
    pub(super) fn piece_of(&self, target: usize) -> usize {
        self.labels.get(target).copied().unwrap_or(target)
    }
    /// Whether the averaged normals of the surface matter.
    pub(super) fn needs_normals(&self) -> bool {
        matches!(self.target, FieldTarget::Faces(_))
    }
    /// Number of coordinates of a node: penetration and slips.
    pub(super) fn coordinates(&self) -> usize {
        self.dofs.per_node()
    }
    /// Quadrature on an interval from -1 to 1: places and weights.
    pub(super) fn rule(&self) -> &[(f64, f64)] {
        &self.rule
    }
    /// Degree of the rule on overlaps: functions of second degree on both sides are products of those of their corners.
    pub(super) fn overlap_degree(&self, patch: &Patch) -> usize {
        let own = self.surface.faces[patch.face].kind.degree;
        own.max(self.target.as_faces().map_or(1, |faces| faces.surface.faces[patch.target].kind.degree))
    }
    /// Size of the faces at the node of a slot, a length.
    pub(super) fn size_at(&self, slot: usize) -> f64 {
        self.node_of(slot).map_or(self.longest, |node| self.sizes[node])
    }

    /// Whether a face of the surface may touch a face of the target. Where a surface touches itself, of two faces the one
    /// that comes first carries the stress (unique roles: Yang & Laursen, Comput. Mech. 41, 2008).
    pub(super) fn may_touch(&self, face: usize, target: usize) -> bool {
        let Some(faces) = self.target.as_faces() else { return true };
        let (own, other) = (&self.surface.faces[face], &faces.surface.faces[target]);
        (!self.itself || own.side < other.side) && !own.nodes.iter().any(|node| other.nodes.contains(node))
    }

    /// Half the distance from the middle of each face, along its inward normal, to where the ray leaves the body.
    fn depths(&self, u: &[f64]) -> Vec<f64> {
        let boundary = self.boundary.in_place((&*self.mesh, &self.dofs), u);
        let depth = |face: &super::face::FieldFace| {
            let placed = face.placed(&self.mesh, &self.dofs, u);
            let shape = face.shape(face.middle());
            let [a, b] = shape.tangents(placed.nodes(), self.surface.plane);
            let ray = FaceRay { x: shape.value(placed.nodes()), n: -a.cross(b).unit() };
            let least = 1e-3 * a.norm();
            let own = |number: usize| self.boundary.surface.faces[number].side == face.side;
            let leaves = boundary.nearest(&ray, [least, f64::MAX], |number, hit| !own(number) && hit.gap > least);
            leaves.map_or(f64::INFINITY, |(_, hit)| 0.5 * hit.gap)
        };
        self.surface.faces.iter().map(depth).collect()
    }

    /// What each node sees at displacements `u`, as far as the accepted state alone tells.
    fn supports(&self, u: &[f64], reach: f64, whole: bool) -> Vec<Support> {
        let (now, depths) = (Configuration::new(self, u), self.depths(u));
        let tips = now.tips(self.longest, if whole { None } else { Some(&[]) });
        self.find((&now, tips), reach, &depths, |_, _, _| {})
    }

    /// Values of a stencil's unknowns.
    fn values(&self, support: &Support, u: &[f64]) -> Vec<f64> {
        let axes = self.dofs.per_node();
        let first = |&node: &usize| self.dofs.node(node)..self.dofs.node(node) + axes;
        let mut values: Vec<f64> = support.nodes.iter().flat_map(first).map(|dof| u[dof]).collect();
        values.extend(self.target.as_tool().into_iter().flat_map(|rigid| rigid.unknowns()).map(|dof| u[dof]));
        values
    }

    /// Calls `take` with the slots that see something at displacements `u`.
    fn each_seen(
        &self,
        u: &[f64],
        (reach, whole): (f64, bool),
        mut take: impl FnMut(usize, &StencilInPlace, &NodeSums),
    ) {
        let mut sums = NodeSums::default();
        for (slot, support) in self.supports(u, reach, whole).iter().enumerate().filter(|(_, s)| !s.patches.is_empty())
        {
            let values = self.values(support, u);
            let stencil = StencilInPlace::new(self, support, &values);
            if stencil.sum(&|_, _| None, false, &mut sums).is_some() {
                take(slot, &stencil, &sums);
            }
        }
    }

    /// The tangential penalties of an attempt after an accepted history: a node that is about to slide under its pressure has
    /// slipped elastically by the stated part of its faces, and one under less than the mean pressure as under that. A stiffer
    /// interface resolves nothing that the mesh shows, and has nodes change between stick and slip with every small motion.
    fn tangential_penalties(&self, law: &dyn Interface, history: &History) -> Vec<f64> {
        let most = self.options.tangential_penalty;
        let Some(part) = self.options.elastic_slip else { return vec![most; self.slots()] };
        let stiffness = |slot: usize| {
            let values = history.slot(slot);
            let sliding = law.sliding_stress(values[entry::PRESSURE]).unwrap_or(0.0);
            (values[entry::STATUS] > 0.0).then(|| sliding * values[entry::HALF] / (part * self.size_at(slot)))
        };
        let closed: Vec<f64> = (0..self.slots()).filter_map(stiffness).filter(|found| *found > 0.0).collect();
        let mean = if closed.is_empty() { 0.0 } else { closed.iter().sum::<f64>() / closed.len() as f64 };
        let least = mean.max(SOFTEST * most);
        (0..self.slots()).map(|slot| stiffness(slot).unwrap_or(0.0).max(least).min(most)).collect()
    }

    fn reach(&self, last_change: &[f64]) -> f64 {
        if self.needs_normals() { reach(self.longest, last_change) } else { f64::INFINITY }
    }

    /// Penetration at each node that sees the target before any motion, negative for a gap, and the same over the size of
    /// the faces there.
    pub fn initial_gaps(&self) -> Vec<(f64, f64)> {
        let (still, mut found) = (vec![0.0; self.dofs.count()], Vec::new());
        self.each_seen(&still, (self.reach(&still), false), |slot, _, sums| {
            found.push((sums.y[0], sums.y[0] / self.size_at(slot)));
        });
        found
    }

    /// Of these the penetrations.
    pub fn initial_penetrations(&self) -> Vec<(f64, f64)> {
        self.initial_gaps().into_iter().filter(|(penetration, _)| *penetration > self.least).collect()
    }

    /// What takes the nodes of the undeformed surface out of the target.
    pub fn moves(&self) -> Vec<Move> {
        let still = vec![0.0; self.dofs.count()];
        let (now, mut moves) = (Configuration::new(self, &still), BTreeMap::new());
        let supports = self.supports(&still, self.reach(&still), false);
        for (patch, _) in supports.iter().flat_map(|support| &support.patches) {
            let (face, own) = (now.face(patch.face), &self.surface.faces[patch.face]);
            for (k, &node) in own.nodes.iter().enumerate() {
                let at = face.at(own.place(k));
                let by = match &now.target {
                    TargetInPlace::Tool(tool) => {
                        let foot = tool.closest(patch.target, at.x);
                        (foot.beyond.is_none() && foot.gap < -self.least).then(|| foot.normal * -foot.gap)
                    }
                    TargetInPlace::Faces(faces) => {
                        let ray = FaceRay { x: at.x, n: at.normal.unit() };
                        let hit = self.target.as_faces().and_then(|all| {
                            let hit = all.project(patch.target, faces.placed(patch.target), &ray)?;
                            all.surface.faces[patch.target].holds(hit.s, 1e-6).then_some(hit)
                        });
                        hit.filter(|hit| hit.gap < -self.least).map(|hit| ray.n * hit.gap)
                    }
                };
                let farther = |by: &Vec3, other: Option<&Move>| other.is_none_or(|other| by.norm() > other.by.norm());
                if let Some(by) = by.filter(|by| farther(by, moves.get(&node))) {
                    moves.insert(node, Move { node, by, cell: own.side.cell });
                }
            }
        }
        moves.into_values().collect()
    }

    /// All nodes in an accepted state, with this term's lane of its history: one record for each slot.
    pub fn records(&self, u: &[f64], history: &History) -> Vec<ContactRecord> {
        let mut records: Vec<ContactRecord> =
            (0..self.slots()).map(|slot| self.unseen(slot, u, history.slot(slot))).collect();
        self.each_seen(u, (self.reach(&vec![0.0; u.len()]), true), |slot, stencil, sums| {
            let values = history.slot(slot);
            if values[entry::SEGMENT] < 0.0 {
                return;
            }
            let [thrust, e1, e2] = stencil.directions(sums);
            let record = &mut records[slot];
            let sheared = e1 * values[entry::SHEAR] + e2 * values[entry::SHEAR2];
            let stretch = values[entry::HALF];
            // The part that a tip has in its face is that of the increment.
            let area = if self.node_of(slot).is_some() { sums.area } else { values[entry::XI] };
            record.area = area * stretch;
            let force = (thrust * values[entry::PRESSURE] + sheared) * record.area;
            record.resultant = Some([force, sums.place]);
            (record.thrust, record.inward, record.facing) = (thrust.unit(), thrust.unit(), thrust.unit());
            record.along = e1.unit();
            if !self.surface.plane && sheared.norm() > 0.0 {
                record.along = sheared.unit();
            }
        });
        // Ends of a plate that touch nothing are no points of the contact.
        let tips = records.split_off(self.nodal_slots()).into_iter().zip(self.nodal_slots()..);
        let seen = |slot: usize| history.slot(slot)[entry::SEGMENT] >= 0.0;
        records.extend(tips.filter(|(_, slot)| seen(*slot)).map(|(tip, _)| tip));
        if self.swapped {
            records.iter_mut().for_each(ContactRecord::turn);
        }
        records
    }

    /// The line that tangents at a node of the field follow in space, before any motion.
    fn rest_line(&self, node: usize) -> Vec3 {
        let [from, to] = self.surface.line(node).map(|node| self.mesh.points[node]);
        (to - from).unit()
    }

    /// The record of a node that sees nothing.
    fn unseen(&self, slot: usize, u: &[f64], values: &[f64]) -> ContactRecord {
        let (position, outward, edge) = match self.node_of(slot) {
            Some(node) => {
                let super::surface::FieldNode { node: number, support, .. } = &self.surface.nodes[node];
                let mut position = self.mesh.points[*number];
                (0..self.dofs.per_node()).for_each(|axis| position[axis] += u[self.dofs.node(*number) + axis]);
                let normal = self.surface.normal(node, |f| self.surface.faces[f].placed(&self.mesh, &self.dofs, u));
                (position, normal.unit, support.first().map_or(0, |(face, _)| *face))
            }
            None => {
                let tip = &self.tips()[slot - self.nodal_slots()];
                let tool = self.target.as_tool().map(|rigid| rigid.at(u));
                let place = |tool: super::tool::ToolInPlace| (tool.place(tip.point), -tool.rotate(tip.outward), 0);
                tool.map_or((tip.point, -tip.outward, 0), place)
            }
        };
        ContactRecord {
            position,
            inward: -outward,
            thrust: -outward,
            facing: -outward,
            along: match self.node_of(slot) {
                Some(node) if !self.surface.plane => self.rest_line(node),
                _ => outward.left(),
            },
            segment: (values[entry::SEGMENT] >= 0.0).then_some(slot % self.pieces),
            edge,
            ..ContactRecord::of(values, self.surface.plane)
        }
    }

    /// The largest penetration that augmentation leaves at a node, over the size of its faces, where there is any.
    pub fn nodal_penetration(&self, history: &History) -> Option<f64> {
        self.options.augmentation?;
        let closed = (0..self.slots()).filter(|&slot| history.slot(slot)[entry::STATUS] > 0.0);
        Some(closed.map(|slot| history.slot(slot)[entry::PENETRATION] / self.size_at(slot)).fold(0.0, f64::max))
    }

    /// Facets of first degree whose mean distance is not that of the curved surfaces they stand for: with an overlap that is to
    /// be pressed apart, what they add to it or take from it is pressure.
    pub fn facets(&self, history: &History) -> Option<String> {
        let faces = self.target.as_faces().filter(|_| self.options.overlap != Overlap::Fit)?;
        let overlaps =
            (0..self.slots()).map(|slot| history.slot(slot)[entry::OVERLAP]).filter(|overlap| *overlap > 0.0);
        let (sum, count) = overlaps.fold((0.0, 0.0), |(sum, count), overlap| (sum + overlap, count + 1.0));
        // Of a parabola over a chord the mean height is two thirds of the largest.
        let stands = |surface: &FieldSurface| {
            let all = (0..surface.nodes.len()).map(|node| surface.sagitta(node, &self.mesh)).sum::<f64>();
            2.0 / 3.0 * all / surface.nodes.len().max(1) as f64
        };
        let [overlap, apart] = [sum / count, (stands(&self.surface) - stands(&faces.surface)).abs()];
        (count > 0.0 && apart > MISPLACED * overlap).then(|| {
            format!(
                "contact '{}': its facets stand {apart:.2e} farther apart, or less, than the curved surfaces that they are meant for, \
                 {:.0} % of the overlap of {overlap:.2e}, and the pressure is off by about as much; cells of second degree, matching \
                 or finer facets, or the clearance of a smooth fit by overlap = \"fit\"",
                self.name,
                100.0 * apart / overlap
            )
        })
    }

    /// How far the facets of both sides stand off a smooth surface at most, a length.
    fn sagitta(&self) -> f64 {
        let most = |surface: &FieldSurface| {
            (0..surface.nodes.len()).map(|node| surface.sagitta(node, &self.mesh)).fold(0.0, f64::max)
        };
        most(&self.surface) + self.target.as_faces().map_or(0.0, |faces| most(&faces.surface))
    }

    /// Words for a slot.
    pub(super) fn describe(&self, slot: usize) -> String {
        match self.node_of(slot) {
            Some(node) => format!("node {} of contact '{}'", self.surface.nodes[node].node, self.name),
            None => format!("tip {} of the tool of contact '{}'", slot - self.nodal_slots() + 1, self.name),
        }
    }
}

/// Least tangential penalty over the largest, which is many times the stiffness of the cells behind: what slips elastically stays
/// small against what those shear, also in a metal, whose friction is small against its modulus.
const SOFTEST: f64 = 0.05;
/// Largest radius of a tip over the length of the shortest face: a larger one is felt by the faces around it.
const SMALL: f64 = 1.0;
/// Mean distance of facets from curved surfaces over the overlap from which on it is told.
const MISPLACED: f64 = 0.02;
/// Gaps up to this multiple of what the facets of both sides stand off a smooth surface are theirs, where bodies fit.
const FITS: f64 = 2.0;

/// Labels counted from zero, in the order of their first use.
fn labels(roots: &[usize]) -> (Vec<usize>, usize) {
    let mut numbers = BTreeMap::new();
    for &root in roots {
        let next = numbers.len();
        numbers.entry(root).or_insert(next);
    }
    (roots.iter().map(|root| numbers[root]).collect(), numbers.len())
}

/// Four Gauss points in the plane: the integrals of linear functions times those of second degree over a density of first.
fn rule() -> Vec<(f64, f64)> {
    let (a, b) = ((3.0 / 7.0 - 2.0 / 7.0 * 1.2_f64.sqrt()).sqrt(), (3.0 / 7.0 + 2.0 / 7.0 * 1.2_f64.sqrt()).sqrt());
    let [p, q] = [(18.0 + 30.0_f64.sqrt()) / 36.0, (18.0 - 30.0_f64.sqrt()) / 36.0];
    vec![(-b, q), (-a, p), (a, p), (b, q)]
}

impl Term for FieldContact {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial(&self) -> History {
        let vars: usize = self.law.first().variables().iter().map(|v| v.len()).sum();
        let slots = (0..self.slots()).map(|_| entry::COUNT + vars);
        let mut history = History::new(slots.chain(self.options.augmentation.map(|_| self.slots())));
        for slot in 0..self.slots() {
            let values = history.slot_mut(slot);
            values[entry::SEGMENT] = -1.0;
            values[entry::HALF] = 1.0;
            self.law.first().initial(&mut values[entry::COUNT..]);
        }
        let (still, fits) = (vec![0.0; self.dofs.count()], FITS * self.sagitta());
        self.each_seen(&still, (self.reach(&still), false), |slot, _, sums| {
            let values = history.slot_mut(slot);
            (values[entry::SEGMENT], values[entry::PENETRATION], values[entry::XI]) = (0.0, sums.y[0], sums.area);
            let gap = -sums.y[0];
            if self.options.overlap == Overlap::Fit && gap > 0.0 && gap <= fits {
                (values[entry::OVERLAP], values[entry::CLOSURE]) = (sums.y[0], gap);
            }
            self.options.overlap.begin(values, self.least);
        });
        history
    }

    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let augmented = self.options.augmentation.is_some();
        let before = Configuration::new(self, &accepted.u);
        let shifts = if augmented { history.slot(self.slots()) } else { &[] };
        let law = self.law.at(at.step, at.step_time)?;
        Ok(Box::new(FieldAttempt {
            contact: self,
            history,
            accepted: &accepted.u,
            tips_before: before.tips(f64::INFINITY, Some(&[])),
            before,
            depths: self.depths(&accepted.u),
            reach: self.reach(&accepted.last_change),
            ahead: ahead(accepted, at.dt),
            shifts: shifts.iter().map(|&closure| [closure, 0.0, 0.0]).collect(),
            augmented: 0,
            settled: self.options.overlap.settled(at),
            tangential: self.tangential_penalties(&*law, history),
            law,
            dt: at.dt,
            found: RwLock::default(),
            linear: (0..self.slots()).map(|_| Mutex::default()).collect(),
            far: reach(self.longest, &accepted.last_change),
        }))
    }

    fn name_of(&self, stencil: usize) -> String {
        self.describe(stencil)
    }

    fn bends(&self) -> bool {
        true
    }

    fn branches(&self) -> &'static [&'static str] {
        &["open", "stick", "slip"]
    }
}
