//! The check of a state: all pairs of wholes, tools and the axis, each point of one against the boundary of the other.

use super::grazing::grazed;
use super::hierarchy::{bounds, meet};
use super::inside::{Way, depth, is_inside};
use super::rigid::Rigid;
use super::surface::{Placed, Surface};
use crate::mesh::Mesh;
use crate::system::{Dofs, History, Interpenetration};
use crate::tensor::Vec3;
use crate::{Failure, FailureKind};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

/// What a contact claims, in the words of the audit.
pub struct Claim {
    /// Nodes of its surface.
    pub surface: Vec<usize>,
    /// Nodes of its target, or the number of a tool.
    pub target: Result<Vec<usize>, usize>,
    /// The term that it is.
    pub term: usize,
    /// The largest penetration that it reports of a state, from its history; a length.
    pub penetration: Box<dyn Fn(&History) -> f64 + Send + Sync>,
}

/// What is audited.
pub struct Subject {
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// Whether `x = 0` is an axis that nothing may cross.
    pub axisymmetric: bool,
    /// Names and cells of the bodies.
    pub bodies: Vec<(String, Vec<usize>)>,
    /// The tools in the plane, in the order of their unknowns.
    pub tools: Vec<Arc<crate::tool::ProfileTool>>,
    /// The tools in space, in the order of their unknowns.
    pub solid_tools: Vec<Arc<crate::tool::space::SpaceTool>>,
    /// The contacts.
    pub claims: Vec<Claim>,
    /// Size of the smallest cell, a length.
    pub cell_size: f64,
    /// An increment is refused above this interpenetration, over the size of the cell: between what no contact is declared
    /// for, and
    pub limit: f64,
    /// between the two sides of a contact, which bears its points and leaves a part of a cell between and beyond them.
    pub contact_limit: f64,
}

/// The audit of a model.
pub struct Audit {
    subject: Subject,
    prepared: OnceLock<Prepared>,
}

/// What follows from the undeformed model, found at the first check.
pub(super) struct Prepared {
    surfaces: Vec<Surface>,
    /// The bodies of each, by their terms.
    bodies: Vec<BTreeSet<usize>>,
    tools: Vec<Rigid>,
    /// For each contact the pairs that it is about.
    claimed: Vec<Vec<usize>>,
    /// For each pair the depth before any motion, a length.
    pub(super) initial: Vec<f64>,
    /// For each pair whether a contact knows of it.
    known: Vec<bool>,
    /// For each pair of a contact the nodes of its sides that the contact bears.
    borne: BTreeMap<usize, BTreeSet<usize>>,
}

/// What a whole may lie in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Other {
    Whole(usize),
    Tool(usize),
    Axis,
}

/// One point that lies where it must not, or came through.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    own: usize,
    pub(super) other: Other,
    /// Bodies of the two sides, by number.
    bodies: [usize; 2],
    pub(super) depth: f64,
    /// What the shape of the two sides explains.
    pub(super) sagitta: f64,
    pub(super) size: f64,
    /// The vertex; none for points of tools.
    vertex: Option<usize>,
    place: Vec3,
    pub(super) manner: Manner,
}

/// How a point comes to lie where it must not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Manner {
    /// It lies deep.
    Deep,
    /// It came through.
    Through,
    /// It lies behind an open profile that a contact presses against: told, and not refused.
    Behind,
}

/// The worst so far, and how bad it is.
pub(super) type Worst = Option<(f64, Found)>;

/// A state between the accepted unknowns and new ones, with what explains depth between pairs.
pub(super) struct Look<'a> {
    subject: &'a Subject,
    pub(super) prepared: &'a Prepared,
    pub(super) placed: Vec<Placed<'a>>,
    accepted: &'a [f64],
    u: &'a [f64],
    /// For each pair the depth that contacts report.
    pub(super) reported: Vec<f64>,
}

/// Straight parts into which the way of a point is divided.
const STEPS: usize = 4;

impl Audit {
    /// Of a model; nothing is computed before the first check.
    pub fn new(subject: Subject) -> Self {
        Self { subject, prepared: OnceLock::new() }
    }

    /// What of the state at `u`, with histories of the terms and those that are idle, lies where it must not, or came through something on the way
    /// from the accepted unknowns; bodies are looked at between too where that way was `straight`. First what nothing explains, over
    /// the size of the cell, then the deepest node of all that contacts bear, over the length of its sides.
    ///
    /// # Errors
    /// A [`Failure`] when the interpenetration exceeds the limit.
    pub fn check(
        &self,
        [accepted, u]: [&[f64]; 2],
        (histories, idle): (&[History], &[usize]),
        straight: bool,
    ) -> Result<[Interpenetration; 2], Failure> {
        let prepared = self.prepared();
        let mut reported = vec![0.0_f64; prepared.initial.len()];
        let claimed = || self.subject.claims.iter().map(|claim| claim.term).zip(&prepared.claimed);
        for (_, pairs) in claimed().filter(|(term, _)| idle.contains(term)) {
            pairs.iter().for_each(|&pair| reported[pair] = f64::INFINITY);
        }
        for (_, pairs) in claimed().filter(|(term, _)| !idle.contains(term)) {
            pairs.iter().for_each(|&pair| reported[pair] = 0.0);
        }
        for (claim, pairs) in self.subject.claims.iter().zip(&prepared.claimed) {
            let most = histories.get(claim.term).map_or(0.0, |history| (claim.penetration)(history));
            pairs.iter().for_each(|&pair| reported[pair] = reported[pair].max(most));
        }
        // A body that is not there has no inside.
        let is_idle = |bodies: &BTreeSet<usize>| bodies.iter().all(|body| idle.contains(body));
        for own in (0..prepared.bodies.len()).filter(|&own| is_idle(&prepared.bodies[own])) {
            prepared.pairs_with(own).for_each(|pair| reported[pair] = f64::INFINITY);
        }
        let look = self.look(prepared, accepted, u, reported);
        let found = look.verdict()?;
        let halts = if straight { look.halts() } else { 0 };
        for part in (1..halts).map(|i| i as f64 / halts as f64) {
            let between: Vec<f64> = accepted.iter().zip(u).map(|(from, to)| from + (to - from) * part).collect();
            self.look(prepared, &between, &between, look.reported.clone()).grazes()?;
        }
        Ok(found)
    }

    fn look<'a>(&'a self, prepared: &'a Prepared, accepted: &'a [f64], u: &'a [f64], reported: Vec<f64>) -> Look<'a> {
        let model = (self.subject.mesh.as_ref(), &self.subject.dofs);
        let placed = prepared.surfaces.iter().map(|surface| surface.place(model, accepted, u)).collect();
        Look { subject: &self.subject, prepared, placed, accepted, u, reported }
    }

    /// Distance of a point from a tool where that stands first, by its number, negative in its material.
    pub fn distance(&self, tool: usize, p: Vec3) -> f64 {
        self.prepared().tools[tool].distance(p)
    }

    fn prepared(&self) -> &Prepared {
        self.prepared.get_or_init(|| {
            let mut prepared = Prepared::new(&self.subject);
            let still = vec![0.0; self.subject.dofs.count()];
            let mut initial = vec![0.0_f64; prepared.initial.len()];
            let look = self.look(&prepared, &still, &still, initial.clone());
            look.find(&mut |found| {
                let depth = &mut initial[prepared.pair(found.own, found.other)];
                *depth = depth.max(found.depth - found.sagitta);
            });
            drop(look);
            prepared.initial = initial;
            prepared
        })
    }
}

impl Prepared {
    fn new(subject: &Subject) -> Self {
        let (mesh, dofs) = (&subject.mesh, &subject.dofs);
        let plane = dofs.per_node() == 2;
        let surfaces = surfaces(subject, plane);
        let cell = subject.cell_size;
        let flat = subject.tools.iter().enumerate().map(|(i, tool)| Rigid::plane(tool, i, dofs, cell));
        let solid = subject.solid_tools.iter().enumerate().map(|(i, tool)| Rigid::space(tool, i, dofs, cell));
        let tools: Vec<Rigid> = flat.chain(solid).collect();
        let mut whole = vec![usize::MAX; mesh.points.len()];
        for (i, surface) in surfaces.iter().enumerate() {
            surface.nodes.iter().for_each(|&node| whole[node] = i);
        }
        let mut bodies = vec![BTreeSet::new(); surfaces.len()];
        for (body, (_, cells)) in subject.bodies.iter().enumerate() {
            let nodes = cells.iter().flat_map(|&cell| mesh.cell(cell).nodes);
            nodes.filter(|node| whole[**node] != usize::MAX).for_each(|&node| _ = bodies[whole[node]].insert(body));
        }
        let pairs = surfaces.len() * (surfaces.len() + tools.len() + 1);
        let (initial, known) = (vec![0.0; pairs], vec![false; pairs]);
        let mut prepared =
            Self { surfaces, bodies, tools, claimed: Vec::new(), initial, known, borne: BTreeMap::new() };
        for claim in &subject.claims {
            let pairs = prepared.pairs_of(claim, &whole);
            for &pair in &pairs {
                prepared.known[pair] = true;
                let sides = claim.surface.iter().chain(claim.target.as_ref().into_iter().flatten());
                prepared.borne.entry(pair).or_default().extend(sides);
            }
            prepared.claimed.push(pairs);
        }
        prepared
    }

    /// The number of a pair, which has no order.
    pub(super) fn pair(&self, own: usize, other: Other) -> usize {
        let wholes = self.surfaces.len();
        let (own, other) = match other {
            Other::Whole(other) => (own.min(other), own.max(other)),
            Other::Tool(tool) => (own, wholes + tool),
            Other::Axis => (own, wholes + self.tools.len()),
        };
        own * (wholes + self.tools.len() + 1) + other
    }

    /// Whether a contact of the pair bears a vertex.
    fn bears(&self, pair: usize, surface: &Surface, vertex: usize) -> bool {
        self.borne.get(&pair).is_some_and(|nodes| surface.lies_among(vertex, nodes))
    }

    /// All pairs of a whole.
    fn pairs_with(&self, own: usize) -> impl Iterator<Item = usize> + '_ {
        let wholes = (0..self.surfaces.len()).map(Other::Whole);
        let others = wholes.chain((0..self.tools.len()).map(Other::Tool)).chain([Other::Axis]);
        others.map(move |other| self.pair(own, other))
    }

    fn pairs_of(&self, claim: &Claim, whole: &[usize]) -> Vec<usize> {
        let wholes = |nodes: &[usize]| {
            let mut all: Vec<usize> = nodes.iter().map(|&node| whole[node]).filter(|&w| w != usize::MAX).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let others: Vec<Other> = match &claim.target {
            Ok(nodes) => wholes(nodes).into_iter().map(Other::Whole).collect(),
            Err(tool) => vec![Other::Tool(*tool)],
        };
        let own = wholes(&claim.surface);
        own.iter().flat_map(|&own| others.iter().map(move |&other| self.pair(own, other))).collect()
    }
}

/// The boundaries of what hangs together by nodes.
fn surfaces(subject: &Subject, plane: bool) -> Vec<Surface> {
    let mesh = &subject.mesh;
    let mut body = vec![usize::MAX; mesh.cell_count()];
    for (i, (_, cells)) in subject.bodies.iter().enumerate() {
        cells.iter().for_each(|&cell| body[cell] = i);
    }
    let mut leader: Vec<usize> = (0..mesh.points.len()).collect();
    let cells = || (0..mesh.cell_count()).filter(|&cell| body[cell] != usize::MAX);
    for cell in cells() {
        let nodes = mesh.cell(cell).nodes;
        let first = nodes.iter().map(|&node| lead(&mut leader, node)).fold(usize::MAX, usize::min);
        for &node in nodes {
            let end = lead(&mut leader, node);
            leader[end] = first;
        }
    }
    let mut wholes: Vec<(usize, usize)> =
        cells().map(|cell| (lead(&mut leader, mesh.cell(cell).nodes[0]), cell)).collect();
    wholes.sort_unstable();
    let whole = |run: &[(usize, usize)]| {
        let cells: Vec<usize> = run.iter().map(|(_, cell)| *cell).collect();
        Surface::new(mesh, &cells, &|cell| body[cell], plane)
    };
    wholes.chunk_by(|a, b| a.0 == b.0).map(whole).collect()
}

/// The node that stands for all which hang together with this one.
fn lead(leader: &mut [usize], node: usize) -> usize {
    let mut end = node;
    while leader[end] != end {
        end = leader[end];
    }
    leader[node] = end;
    end
}

impl Look<'_> {
    /// Shows every point that lies behind a boundary or came through one.
    fn find(&self, found: &mut dyn FnMut(Found)) {
        for own in 0..self.placed.len() {
            self.in_itself(own, found);
            self.beyond_axis(own, found);
            for other in (0..self.placed.len()).filter(|&other| other != own) {
                self.in_other(own, other, found);
            }
            for tool in 0..self.prepared.tools.len() {
                self.in_tool(own, tool, found);
                self.pierced(own, tool, found);
            }
        }
    }

    /// How far a point may lie below a piece and still rest on it.
    fn near(&self, own: usize, other: Other, size: f64, sagitta: f64) -> f64 {
        let pair = self.prepared.pair(own, other);
        self.reported[pair] + self.prepared.initial[pair] + sagitta + self.limit(pair) * size
    }

    fn limit(&self, pair: usize) -> f64 {
        if self.prepared.known[pair] { self.subject.contact_limit } else { self.subject.limit }
    }

    pub(super) fn in_other(&self, own: usize, other: usize, found: &mut dyn FnMut(Found)) {
        let (a, b) = (&self.placed[own], &self.placed[other]);
        if !meet(&a.swept, &b.swept) {
            return;
        }
        for vertex in 0..a.surface.len() {
            let (from, to) = (a.before[vertex], a.now[vertex]);
            if !meet(&bounds([from, to]), &b.swept) {
                continue;
            }
            let mut report = |depth: f64, piece: usize, manner: Manner| {
                let sagitta = a.sagitta_at(vertex) + b.sagitta_of(piece);
                // Where an edge presses into a face the cells behind that tell how far it can follow.
                let size = match (a.surface.is_sharp(vertex), b.surface.is_at_edge(piece)) {
                    (true, _) => b.size_of(piece),
                    (false, true) => a.size_at(vertex),
                    (false, false) => a.size_at(vertex).min(b.size_of(piece)),
                };
                let bodies = [a.surface.body_at(vertex), b.surface.body_of(piece)];
                let other = Other::Whole(other);
                let vertex = Some(vertex);
                found(Found { own, other, bodies, depth, sagitta, size, vertex, place: to, manner });
            };
            if meet(&[to, to], &b.bounds)
                && let Some(deep) = b.depth(to)
            {
                report(deep.depth, deep.piece, Manner::Deep);
            }
            let (at, piece) = (|part| a.at(vertex, part), |number, part| b.piece_at(number, part));
            let near = self.near(own, Other::Whole(other), a.size_at(vertex), a.sagitta_at(vertex));
            let way = Way { at: &at, piece: &piece, steps: STEPS, near };
            if let Some(passage) = way.passage(&b.tree, &|_| true) {
                report(passage.depth, passage.piece, Manner::Through);
            }
        }
    }

    fn in_itself(&self, own: usize, found: &mut dyn FnMut(Found)) {
        let a = &self.placed[own];
        for (vertex, normal) in a.vertex_normals().into_iter().enumerate() {
            let place = a.now[vertex];
            let far = |piece: usize| !a.surface.is_near(vertex, piece);
            let mut report = |depth: f64, piece: usize, manner: Manner| {
                let sagitta = a.sagitta_at(vertex) + a.sagitta_of(piece);
                let size = a.size_at(vertex).min(a.size_of(piece));
                let bodies = [a.surface.body_at(vertex), a.surface.body_of(piece)];
                let (other, vertex) = (Other::Whole(own), Some(vertex));
                found(Found { own, other, bodies, depth, sagitta, size, vertex, place, manner });
            };
            if is_inside(&a.tree, a.bounds, (place, normal), &|piece| !a.surface.touches(vertex, piece)) {
                let facing = |piece: usize| far(piece) && a.normals[piece].dot(normal) < 0.0;
                if let Some(deep) = depth(&a.tree, place, (f64::INFINITY, false), &|piece, _| facing(piece)) {
                    report(deep.depth, deep.piece, Manner::Deep);
                }
            }
            let (at, piece) = (|part| a.at(vertex, part), |number, part| a.piece_at(number, part));
            let near = self.near(own, Other::Whole(own), a.size_at(vertex), a.sagitta_at(vertex));
            let way = Way { at: &at, piece: &piece, steps: STEPS, near };
            if let Some(passage) = way.passage(&a.tree, &far) {
                report(passage.depth, passage.piece, Manner::Through);
            }
        }
    }

    fn beyond_axis(&self, own: usize, found: &mut dyn FnMut(Found)) {
        let a = &self.placed[own];
        if !self.subject.axisymmetric || a.bounds[0][0] >= 0.0 {
            return;
        }
        for (vertex, &place) in a.now.iter().enumerate().filter(|(_, x)| x[0] < 0.0) {
            let body = a.surface.body_at(vertex);
            let size = a.size_at(vertex);
            let (depth, sagitta, manner) = (-place[0], 0.0, Manner::Deep);
            let (other, bodies, vertex) = (Other::Axis, [body, body], Some(vertex));
            found(Found { own, other, bodies, depth, sagitta, size, vertex, place, manner });
        }
    }

    fn in_tool(&self, own: usize, number: usize, found: &mut dyn FnMut(Found)) {
        let (a, tool) = (&self.placed[own], &self.prepared.tools[number]);
        let other = Other::Tool(number);
        let pair = self.prepared.pair(own, other);
        // A profile without an inside has a side on which nothing is meant to be that began on the other.
        if !tool.closed && self.prepared.initial[pair] > 0.0 && !self.prepared.known[pair] {
            return;
        }
        let steps = STEPS.max(tool.turns(self.accepted, self.u));
        let poses: Vec<_> = (0..=steps).map(|i| tool.pose(self.accepted, self.u, i as f64 / steps as f64)).collect();
        for (vertex, &place) in a.now.iter().enumerate() {
            let (size, sagitta) = (a.size_at(vertex), a.sagitta_at(vertex) + tool.sagitta);
            let body = a.surface.body_at(vertex);
            let mut report = |depth: f64, bulge: f64, manner: Manner| {
                let (sagitta, vertex) = (sagitta + bulge, Some(vertex));
                found(Found { own, other, bodies: [body, body], depth, sagitta, size, vertex, place, manner });
            };
            let at = |(i, pose)| tool.withdraw(pose, a.at(vertex, i as f64 / steps as f64));
            let path: Vec<Vec3> = poses.iter().enumerate().map(at).collect();
            let here = path[steps];
            // Behind an open profile lies what no box about it holds.
            let behind = Vec3([if tool.closed { 0.0 } else { size }; 3]);
            if meet(&[here - behind, here + behind], &tool.bounds)
                && let Some(deep) = tool.depth(here, size)
            {
                // Only a contact bears points, and lies in the tool between them.
                let bears = self.prepared.known[pair];
                let bulge = if bears { tool.bulge(here, deep.piece, a.length_at(vertex)) } else { 0.0 };
                let manner = if bears && !tool.closed { Manner::Behind } else { Manner::Deep };
                report(deep.depth, bulge, manner);
            }
            self.through_tool(&path, tool, self.near(own, other, size, sagitta), &mut report);
            if let Some(depth) = grazed(&path, tool, size) {
                report(depth, 0.0, Manner::Through);
            }
        }
    }

    /// Reports a point that came through a tool: a thin one, or from behind.
    fn through_tool(&self, path: &[Vec3], tool: &Rigid, near: f64, report: &mut dyn FnMut(f64, f64, Manner)) {
        if !meet(&bounds(path.iter().copied()), &tool.bounds) {
            return;
        }
        let (at, piece) = (|part| along(path, part), |number: usize, _| tool.pieces[number]);
        let way = Way { at: &at, piece: &piece, steps: path.len() - 1, near };
        if let Some(passage) = way.passage(&tool.tree, &|_| true) {
            report(passage.depth, 0.0, Manner::Through);
        }
    }

    /// Points of a tool in a body, or through it.
    fn pierced(&self, own: usize, number: usize, found: &mut dyn FnMut(Found)) {
        let (a, tool) = (&self.placed[own], &self.prepared.tools[number]);
        let other = Other::Tool(number);
        let poses: Vec<_> = (0..=STEPS).map(|i| tool.pose(self.accepted, self.u, i as f64 / STEPS as f64)).collect();
        let bears = self.prepared.known[self.prepared.pair(own, other)];
        for &point in &tool.points {
            let path: Vec<Vec3> = poses.iter().map(|pose| tool.place(pose, point.0)).collect();
            let here = path[STEPS];
            if !meet(&bounds(path.iter().copied()), &a.swept) {
                continue;
            }
            let mut report = |depth: f64, piece: usize, manner: Manner| {
                let size = a.size_of(piece);
                // Only between the points of a contact.
                let nose = if bears { tool.nose(point, a.length_of(piece)) } else { 0.0 };
                let (sagitta, body) = (a.sagitta_of(piece) + nose, a.surface.body_of(piece));
                let (bodies, vertex, place) = ([body, body], None, here);
                found(Found { own, other, bodies, depth, sagitta, size, vertex, place, manner });
            };
            if meet(&[here, here], &a.bounds)
                && let Some(deep) = a.depth(here)
            {
                report(deep.depth, deep.piece, Manner::Deep);
            }
            let (at, piece) = (|part| along(&path, part), |number, part| a.piece_at(number, part));
            let way =
                Way { at: &at, piece: &piece, steps: STEPS, near: self.near(own, other, self.subject.cell_size, 0.0) };
            if let Some(passage) = way.passage(&a.tree, &|_| true) {
                report(passage.depth, passage.piece, Manner::Through);
            }
        }
    }

    /// The worst of all, refused where it exceeds the limit and was not there before any motion; then the deepest node.
    fn verdict(&self) -> Result<[Interpenetration; 2], Failure> {
        let (mut worst, mut refused, mut deepest): (Worst, Worst, Worst) = (None, None, None);
        self.find(&mut |found| {
            let pair = self.prepared.pair(found.own, found.other);
            let (initial, reported) = (self.prepared.initial[pair], self.reported[pair]);
            let known = if self.prepared.known[pair] { initial } else { 0.0 };
            let own = &self.placed[found.own];
            // A point of a tool belongs to no side.
            let borne = found.vertex.is_none_or(|vertex| self.prepared.bears(pair, own.surface, vertex));
            let beyond = |excused: f64| (found.depth - found.sagitta - excused) / found.size;
            // What a contact reports is the penetration of what it bears, and excuses nothing beside that.
            let told = if borne || reported.is_infinite() { reported } else { 0.0 };
            // Nor does it leave what it bears unexplained behind an open profile, which has no inside.
            if !(borne && found.manner == Manner::Behind) {
                keep(&mut worst, (beyond(told + known), found));
            }
            let pressed = borne && found.manner != Manner::Through && reported.is_finite();
            if let Some(vertex) = found.vertex.filter(|_| pressed) {
                keep(&mut deepest, ((found.depth - initial) / own.length_at(vertex), found));
            }
            // What came through came through, whatever is left between the points of a contact.
            let limit = if found.manner == Manner::Through { self.subject.limit } else { self.limit(pair) };
            if found.manner != Manner::Behind {
                keep(&mut refused, (beyond(reported + initial) / limit, found));
            }
        });
        if let Some((_, found)) = refused.filter(|(part, _)| *part > 1.0) {
            return Err(self.refusal(&found));
        }
        Ok([worst, deepest].map(|worst| match worst.filter(|(part, _)| *part > 0.0) {
            Some((part, found)) => self.describe(part, &found),
            None => Interpenetration::default(),
        }))
    }

    fn names(&self, found: &Found) -> [String; 2] {
        let body = |i: usize| format!("body '{}'", self.subject.bodies[i].0);
        let other = match found.other {
            Other::Whole(_) => body(found.bodies[1]),
            Other::Tool(tool) => format!("tool '{}'", self.prepared.tools[tool].name),
            Other::Axis => "the axis".into(),
        };
        [body(found.bodies[0]), other]
    }

    fn describe(&self, part: f64, found: &Found) -> Interpenetration {
        Interpenetration {
            relative: part,
            depth: found.depth,
            place: found.place.0,
            pair: self.names(found),
            increment: 0,
        }
    }

    pub(super) fn refusal(&self, found: &Found) -> Failure {
        Failure::new(self.words(found)).of(FailureKind::Passage)
    }

    fn words(&self, found: &Found) -> String {
        let ([own, other], Vec3([x, y, z])) = (self.names(found), found.place + self.subject.mesh.origin);
        let place = if self.subject.dofs.per_node() == 2 {
            format!("({x:.6}, {y:.6})")
        } else {
            format!("({x:.6}, {y:.6}, {z:.6})")
        };
        let part = found.depth / found.size;
        match (found.other, found.manner) {
            (_, Manner::Through) => format!("{own} passes through {other} at {place}, {part:.2} cells thick"),
            (Other::Axis, _) => format!("{own} reaches {part:.2} cells beyond the axis at {place}"),
            (Other::Whole(other), _) if other == found.own => {
                format!("{own} lies {part:.2} cells deep in itself at {place}")
            }
            _ => format!("{own} lies {part:.2} cells deep in {other} at {place}"),
        }
    }
}

/// A place on a way that is straight between its points.
pub(super) fn along(path: &[Vec3], part: f64) -> Vec3 {
    let scaled = part * (path.len() - 1) as f64;
    let low = (scaled as usize).min(path.len() - 2);
    path[low] + (path[low + 1] - path[low]) * (scaled - low as f64)
}

/// Keeps the larger; of equals the first.
pub(super) fn keep(worst: &mut Worst, new: (f64, Found)) {
    if new.0.is_finite() && worst.is_none_or(|(old, _)| new.0 > old) {
        *worst = Some(new);
    }
}
