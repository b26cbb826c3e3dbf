//! What a field tells of a state: gaps before any motion, records of its nodes, penetration and facets.

use super::configuration::{Configuration, TargetInPlace};
use super::contact::FieldContact;
use super::face::{FieldFace, moved};
use super::faces::{FaceProjection, FaceRay};
use super::surface::{FieldNode, FieldSurface};
use super::tool::ToolInPlace;
use crate::contact::record::{ContactRecord, area, entry, normal_force};
use crate::contact::{Borne, Move};
use crate::system::History;
use crate::tensor::{DisjointSets, Vec3};
use std::collections::{BTreeMap, BTreeSet};

impl FieldContact {
    /// Penetration at each node that sees the target before any motion, negative for a gap, and the same over the size of
    /// the faces there.
    pub fn initial_gaps(&self) -> Vec<(f64, f64)> {
        let (still, mut found) = (vec![0.0; self.parts.dofs.count()], Vec::new());
        self.each_seen(&still, (self.reach(&still), None), |slot, _, sums| {
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
        let still = vec![0.0; self.parts.dofs.count()];
        let (now, mut moves) = (Configuration::new(self, &still), BTreeMap::new());
        let found = self.supports(&still, self.reach(&still), None);
        for (number, _) in found.supports.iter().flat_map(|support| &support.patches) {
            let patch = &found.patches[*number].patch;
            let (face, own) = (now.face(patch.face), &self.parts.surface.faces[patch.face]);
            for (k, &node) in own.nodes.iter().enumerate() {
                let at = face.at(own.place(k));
                let by = match &now.target {
                    TargetInPlace::Tool(tool) => {
                        let foot = tool.closest(patch.target, at.x);
                        (foot.beyond.is_none() && foot.gap < -self.least).then(|| foot.normal * -foot.gap)
                    }
                    TargetInPlace::Faces(faces) => {
                        let ray = FaceRay { x: at.x, n: at.normal.unit() };
                        let hit = faces.project(patch.target, &ray);
                        let meets = |hit: &FaceProjection| faces.holds(patch.target, hit.s, 1e-6);
                        let gap = |hit: FaceProjection| hit.gap - now.seen_rise(patch.target, hit.s);
                        hit.filter(meets).map(gap).filter(|gap| *gap < -self.least).map(|gap| ray.n * gap)
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

    /// What its nodes bear that see something, nothing where they are open, and its closed tips. An idle node lets
    /// nothing in while it is penetrated.
    pub fn borne(&self, u: &[f64], history: &History) -> Vec<Borne> {
        let (idle, mut borne) = (self.idle(history), Vec::new());
        self.each_seen(u, (self.reach(&vec![0.0; u.len()]), Some(history)), |slot, stencil, sums| {
            let (values, is_tip) = (history.slot(slot), self.node_of(slot).is_none());
            let pressure = match values[entry::STATUS] > 0.0 {
                true => values[entry::PRESSURE],
                false if idle[slot] && sums.y[0] > 0.0 => f64::INFINITY,
                false => 0.0,
            };
            // The part that a tip has in its face is that of the increment.
            let part = if is_tip { values[entry::XI] / sums.area } else { 1.0 };
            if !is_tip || values[entry::STATUS] > 0.0 {
                borne.push((
                    pressure,
                    stencil.sides(sums).map(|(side, node, area)| (side, node, part * area)).collect(),
                ));
            }
        });
        borne
    }

    /// All nodes in an accepted state, with this term's lane of its history: one record for each slot.
    pub fn records(&self, u: &[f64], history: &History) -> Vec<ContactRecord> {
        let mut records: Vec<ContactRecord> =
            (0..self.slots()).map(|slot| self.unseen(slot, u, history.slot(slot))).collect();
        self.each_seen(u, (self.reach(&vec![0.0; u.len()]), Some(history)), |slot, stencil, sums| {
            let values = history.slot(slot);
            if values[entry::SEGMENT] < 0.0 {
                return;
            }
            let [thrust, e1, e2] = stencil.directions(sums);
            let record = &mut records[slot];
            let sheared = e1 * values[entry::SHEAR] + e2 * values[entry::SHEAR2];
            // What tips and corners take of nodes is that of the increment.
            record.area = area(values);
            let force = (thrust * values[entry::PRESSURE] + sheared) * record.area;
            record.resultant = Some([force, sums.place]);
            let facing = stencil.facing(sums, values[entry::NEARER] > 0.0);
            (record.thrust, record.inward, record.facing) = (thrust.unit(), thrust.unit(), facing);
            record.along = e1.unit();
            if self.node_of(slot).is_some() && record.pressure > 0.0 {
                let [mean, own] = stencil.means(sums, |slot| history.slot(slot)[entry::PRESSURE]);
                // The value at a node that itself sees nothing is that of a field carried on to where there is none.
                // Unless nodes around it pull, the mean is no less than what its own function has of it.
                let least = own * record.pressure;
                if own > 0.0 && own < SEEN[usize::from(!self.parts.surface.plane)] && mean < record.pressure {
                    record.spread(record.pressure / mean.max(least));
                }
            }
            if !self.parts.surface.plane && sheared.norm() > 0.0 {
                record.along = sheared.unit();
            }
        });
        // Ends of a plate that touch nothing are no points of the contact.
        let tips = records.split_off(self.nodal_slots()).into_iter().zip(self.nodal_slots()..);
        let seen = |slot: usize| history.slot(slot)[entry::SEGMENT] >= 0.0;
        records.extend(tips.filter(|(_, slot)| seen(*slot)).map(|(tip, _)| tip));
        if self.roles.swapped {
            records.iter_mut().for_each(ContactRecord::turn);
        }
        records
    }

    /// The line that tangents at a node of the field follow in space, before any motion.
    fn rest_line(&self, node: usize) -> Vec3 {
        let [from, to] = self.parts.surface.line(node).map(|node| self.parts.mesh.points[node]);
        (to - from).unit()
    }

    /// The record of a node that sees nothing.
    fn unseen(&self, slot: usize, u: &[f64], values: &[f64]) -> ContactRecord {
        let (position, outward, edge) = match (self.node_of(slot), self.corner_of(slot)) {
            (Some(node), _) => {
                let FieldNode { node: number, support, .. } = &self.parts.surface.nodes[node];
                let position = moved(self.parts.mesh.points[*number], &u[self.parts.dofs.displacements(*number)]);
                let normal = self
                    .parts
                    .surface
                    .normal(node, |f| self.parts.surface.faces[f].placed(&self.parts.mesh, &self.parts.dofs, u));
                (position, normal.unit, support.first().map_or(0, |(face, _)| *face))
            }
            (_, Some(corner)) => {
                let flank = corner.flanks[0];
                let place = |face: &FieldFace| {
                    let placed = face.placed(&self.parts.mesh, &self.parts.dofs, u);
                    face.shape(flank.xi).value(placed.nodes())
                };
                let position = self.face_of(corner.own, flank.face).map_or(Vec3::zero(), place);
                let [x, y, z] = std::array::from_fn(|axis| values[entry::POINTS + axis]);
                let along = Vec3::new(x, y, z).unit() * if corner.own { 1.0 } else { -1.0 };
                (position, along, values[entry::SEGMENT].max(0.0) as usize)
            }
            (None, None) => {
                let tip = &self.tips()[self.tip_of(slot)];
                let tool = self.parts.target.as_tool().map(|rigid| rigid.at(u));
                let place = |tool: ToolInPlace| (tool.place(tip.foremost()), -tool.rotate(tip.outward), 0);
                tool.map_or((tip.foremost(), -tip.outward, 0), place)
            }
        };
        ContactRecord {
            position,
            inward: -outward,
            thrust: -outward,
            facing: -outward,
            along: match self.node_of(slot) {
                Some(node) if !self.parts.surface.plane => self.rest_line(node),
                _ => outward.left(),
            },
            segment: (values[entry::SEGMENT] >= 0.0).then_some(slot % self.pieces),
            edge,
            area: if values[entry::STATUS] > 0.0 { area(values) } else { 0.0 },
            worn: values[entry::WORN],
            ..ContactRecord::of(values, self.parts.surface.plane)
        }
    }

    /// The largest penetration that augmentation leaves at a node, over the size of its faces, where there is any.
    pub fn nodal_penetration(&self, history: &History) -> Option<f64> {
        self.parts.options.augmentation?;
        let closed = (0..self.slots()).filter(|&slot| history.slot(slot)[entry::STATUS] > 0.0);
        Some(closed.map(|slot| history.slot(slot)[entry::PENETRATION] / self.size_at(slot)).fold(0.0, f64::max))
    }

    /// Area of the faces around its nodes over that which these see of a tool in space, as a mean over the force that they bear: by how
    /// much the surface is too coarse for what presses it; one where nothing does.
    pub fn coarseness(&self, history: &History) -> Option<f64> {
        let shares = self.shares(history)?;
        let (mut force, mut seen) = (0.0, 0.0);
        for (slot, share) in shares.into_iter().enumerate().filter(|(slot, _)| history.slot(*slot)[entry::STATUS] > 0.0)
        {
            let borne = normal_force(history.slot(slot));
            (force, seen) = (force + borne, seen + borne * share);
        }
        Some(if seen > 0.0 { force / seen } else { 1.0 })
    }

    /// The part of its faces on which a node lies over a piece of a tool in space, slot by slot; all of it for a tip.
    pub(super) fn shares(&self, history: &History) -> Option<Vec<f64>> {
        self.parts.target.as_tool().filter(|_| !self.parts.surface.plane)?;
        let share =
            |slot: usize| self.node_of(slot).map_or(1.0, |node| history.slot(slot)[entry::XI] / self.areas[node]);
        Some((0..self.slots()).map(share).collect())
    }

    /// The part of the force that tips of the tool bear; none where nothing does.
    pub fn borne_by_tips(&self, history: &History) -> f64 {
        let closed = (0..self.slots()).filter(|&slot| history.slot(slot)[entry::STATUS] > 0.0);
        let [tips, all] = closed.fold([0.0, f64::MIN_POSITIVE], |[tips, all], slot| {
            let force = normal_force(history.slot(slot));
            [tips + if self.node_of(slot).is_none() { force } else { 0.0 }, all + force]
        });
        tips / all
    }

    /// What is known of a node, for each piece of the target.
    pub(super) fn slots_of<'a>(&'a self, node: usize, history: &'a History) -> impl Iterator<Item = &'a [f64]> {
        (0..self.pieces).map(move |piece| history.slot(self.slot(node, piece)))
    }

    /// The most points that are closed beside one another; tips and edges lie beside any.
    pub fn largest_patch(&self, history: &History) -> usize {
        let (surface, is_closed) = (self.surface(), |values: &[f64]| values[entry::STATUS] > 0.0);
        let count = surface.nodes.len();
        let closed: Vec<bool> = (0..count).map(|node| self.slots_of(node, history).any(is_closed)).collect();
        let (mut sets, mut sizes) = (DisjointSets::new(count), vec![0; count]);
        for node in (0..count).filter(|&node| closed[node]) {
            surface.neighbours(node).filter(|&other| closed[other]).for_each(|other| sets.join(node, other));
        }
        (0..count).filter(|&node| closed[node]).for_each(|node| sizes[sets.root(node)] += 1);
        let apart = (self.nodal_slots()..self.slots()).filter(|&slot| is_closed(history.slot(slot))).count();
        sizes.into_iter().max().unwrap_or(0) + apart
    }

    /// By how much the pressure changes from node to node where all around presses, inside the surface: the differences from the mean of the
    /// neighbours over the pressures, as means, in which a single peak counts little; and the node at which it changes most. None of few nodes.
    pub fn roughness(&self, history: &History) -> Option<(f64, usize)> {
        let surface = self.surface();
        let records = |node: usize| self.slots_of(node, history);
        let pressure = |node: usize| {
            let closed = records(node).filter(|values| values[entry::STATUS] > 0.0);
            closed.map(|values| values[entry::PRESSURE]).reduce(f64::max)
        };
        let closed: Vec<Option<f64>> = (0..surface.nodes.len()).map(pressure).collect();
        // What was in the target before any motion and is open between closed nodes bears nothing.
        let hole = |node: usize| {
            let between: BTreeSet<usize> = surface.neighbours(node).filter(|&node| closed[node].is_some()).collect();
            (between.len() > 1 && records(node).any(|values| values[entry::OVERLAP] > 0.0)).then_some(0.0)
        };
        let pressures: Vec<Option<f64>> = (0..closed.len()).map(|node| closed[node].or_else(|| hole(node))).collect();
        let around = |node: usize| {
            let all = surface.neighbours(node).map(|neighbour| pressures[neighbour]).collect::<Option<Vec<f64>>>()?;
            Some(all.iter().sum::<f64>() / all.len() as f64)
        };
        let inside = (0..surface.nodes.len()).filter(|&node| !surface.ends_at(node));
        let differences = inside.filter_map(|node| Some((node, pressures[node]?, pressures[node]? - around(node)?)));
        let (mut sum, mut jumps, mut count, mut worst) = (0.0, 0.0, 0, (0.0, 0));
        for (node, pressure, difference) in differences {
            (sum, jumps, count) = (sum + pressure.abs(), jumps + difference.abs(), count + 1);
            if difference.abs() > worst.0 {
                worst = (difference.abs(), surface.nodes[node].node);
            }
        }
        (count >= MANY && sum > 0.0).then(|| (jumps / sum, worst.1))
    }

    /// How far the facets of both sides stand off a smooth surface at most, a length.
    pub(super) fn sagitta(&self) -> f64 {
        let most = |surface: &FieldSurface| surface.largest_sagitta(self.mesh());
        most(self.surface()) + self.target().as_faces().map_or(0.0, |faces| most(&faces.surface))
    }
}

/// Mean of a node's function over what it sees, in the plane and in space, below which it does not lie there itself: half of that over all of its faces.
const SEEN: [f64; 2] = [1.0 / 3.0, 2.0 / 9.0];

/// Nodes from which on their pressures can be told rough.
const MANY: usize = 5;
