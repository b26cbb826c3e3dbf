//! Pressure of a fluid that enters an opening: it acts on the faces of a surface from where it stands up to where contact
//! bears more than its pressure.
//!
//! What is wet is found anew at each accepted state, and holds over the increment that follows. It begins at the nodes where
//! the fluid stands. A face is entered from a wet node on it when at each of its other nodes contact bears less than the
//! fluid. Where the fluid acts already, it has taken its part of the load from the contact: at a node whose faces are wet by
//! the part `w` of their area, contact and fluid bear `p_c + w p` together, and the fluid stays while that is no more than
//! `p`, but for a small part by which a front would come and go.

use super::face::{Face, area};
use super::follower::{OpenFace, present};
use super::{Site, now};
use crate::amplitude::Timeline;
use crate::mesh::Side;
use crate::system::{Attempt, Branch, History, Instant, Local, Role, State, Stencil, Stencils, Term};
use crate::tensor::Vec3;
use crate::{Error, Failure};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

/// Part of the fluid's pressure by which contact must bear more before the fluid leaves a face that it has entered.
const STAYS: f64 = 0.02;

/// Where contacts bear in an accepted state, and by which pressure.
type Borne = dyn Fn(&State) -> Vec<(Vec3, f64)> + Send + Sync;

/// What contacts bear, which the model tells when it has been put together.
#[derive(Clone, Default)]
pub struct Bearing(Arc<OnceLock<Box<Borne>>>);

impl Bearing {
    /// Tells it, once.
    pub fn tell(&self, borne: impl Fn(&State) -> Vec<(Vec3, f64)> + Send + Sync + 'static) {
        let _ = self.0.set(Box::new(borne));
    }
    fn in_state(&self, state: &State) -> Vec<(Vec3, f64)> {
        self.0.get().map_or_else(Vec::new, |borne| borne(state))
    }
}

/// A pressure of a fluid, a stress, along the present normal over the present area of the faces that it wets.
pub struct PenetratingPressure {
    name: String,
    site: Site,
    value: Timeline,
    faces: Vec<Face>,
    /// Nodes at which the fluid stands.
    source: BTreeSet<usize>,
    bearing: Bearing,
}

impl PenetratingPressure {
    /// A pressure that may enter `sides` from the nodes of `source`, or from their rim.
    ///
    /// # Errors
    /// An input error if a side cannot carry a load, or none of the nodes lies on them.
    pub fn new(
        name: &str,
        site: Site,
        (sides, source): (&[Side], Option<&[usize]>),
        value: Timeline,
        bearing: Bearing,
    ) -> Result<Self, Error> {
        let faces: Vec<Face> = sides.iter().map(|&side| Face::new(name, &site.mesh, side)).collect::<Result<_, _>>()?;
        let nodes: BTreeSet<usize> = faces.iter().flat_map(|face| face.nodes.iter().copied()).collect();
        let source: BTreeSet<usize> = match source {
            Some(source) => source.iter().copied().filter(|node| nodes.contains(node)).collect(),
            None => rim(&faces, site.space.dimension()),
        };
        if source.is_empty() {
            return Err(Error::input(format!(
                "'{name}': no node of `from` lies on the sides that the fluid may enter"
            )));
        }
        Ok(Self { name: name.into(), site, value, faces, source, bearing })
    }

    /// The present area that is wet, and the whole, with thickness and circumference.
    pub fn wetted(&self, state: &State, history: &History) -> [f64; 2] {
        let areas = self.areas(&state.u);
        let wet = (0..self.faces.len()).filter(|&i| is_wet(history, i)).fold(0.0, |sum, i| sum + areas[i]);
        [wet, areas.iter().sum()]
    }

    fn areas(&self, u: &[f64]) -> Vec<f64> {
        let size = |face: &Face| {
            let local: Vec<f64> = self.site.unknowns(face.nodes.iter().copied()).iter().map(|&dof| u[dof]).collect();
            let at = |point: &super::face::FacePoint| {
                point.weight * area(&self.site, point.place(present(face, &self.site, &local), self.site.space)).norm()
            };
            face.points.iter().map(at).sum()
        };
        self.faces.iter().map(size).collect()
    }

    /// The faces that a fluid of pressure `p` wets after an accepted state.
    fn enter(&self, state: &State, history: &History, p: f64) -> Vec<bool> {
        let before: Vec<bool> = (0..self.faces.len()).map(|i| is_wet(history, i)).collect();
        let mut now = vec![false; self.faces.len()];
        if p <= 0.0 {
            return now;
        }
        let borne = self.borne(state);
        let parts = self.parts(&before, &self.areas(&state.u));
        let admits = |node: &usize| {
            let (contact, part) = (borne.get(node).copied().unwrap_or(0.0), parts.get(node).copied().unwrap_or(0.0));
            let stays = if part > 0.0 { STAYS * p } else { 0.0 };
            contact + part * p <= p + stays
        };
        let mut nodes = self.source.clone();
        loop {
            let enters = |i: &usize| {
                let face = &self.faces[*i].nodes;
                !now[*i]
                    && face.iter().any(|node| nodes.contains(node))
                    && face.iter().all(|node| nodes.contains(node) || admits(node))
                    && face.iter().any(admits)
            };
            let entered: Vec<usize> = (0..now.len()).filter(enters).collect();
            if entered.is_empty() {
                return now;
            }
            for i in entered {
                now[i] = true;
                nodes.extend(&self.faces[i].nodes);
            }
        }
    }

    /// The part of the area around each node that is wet.
    fn parts(&self, wet: &[bool], areas: &[f64]) -> BTreeMap<usize, f64> {
        let mut sums = BTreeMap::<usize, [f64; 2]>::new();
        for ((face, area), wet) in self.faces.iter().zip(areas).zip(wet) {
            for &node in &face.nodes {
                let [of, all] = sums.entry(node).or_default();
                *of += if *wet { *area } else { 0.0 };
                *all += area;
            }
        }
        sums.into_iter().map(|(node, [of, all])| (node, if all > 0.0 { of / all } else { 0.0 })).collect()
    }

    /// What contact bears at each node: the mean over what lies nearer than half of the longest way to a neighbour.
    fn borne(&self, state: &State) -> BTreeMap<usize, f64> {
        let places = self.bearing.in_state(state);
        let at = |node: usize| {
            let mut x = self.site.mesh.points[node];
            let first = self.site.dofs.node(node);
            (0..self.site.dofs.per_node()).for_each(|axis| x[axis] += state.u[first + axis]);
            x
        };
        let mut reach = BTreeMap::<usize, f64>::new();
        for face in &self.faces {
            for (k, &node) in face.nodes.iter().enumerate() {
                let others = face.nodes.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, &other)| other);
                let nearest = others.map(|other| (at(other) - at(node)).norm()).fold(f64::INFINITY, f64::min);
                let reach = reach.entry(node).or_insert(0.0);
                *reach = reach.max(0.5 * nearest);
            }
        }
        let mean = |(&node, &reach): (&usize, &f64)| {
            let (x, mut sums) = (at(node), [0.0; 2]);
            for (place, pressure) in &places {
                if (*place - x).norm() <= reach {
                    sums[0] += pressure;
                    sums[1] += 1.0;
                }
            }
            (node, if sums[1] > 0.0 { sums[0] / sums[1] } else { 0.0 })
        };
        reach.iter().map(mean).collect()
    }
}

/// Nodes at the border of faces: the ends of a line of edges, the edges that only one face has.
fn rim(faces: &[Face], dimension: usize) -> BTreeSet<usize> {
    let mut met = BTreeMap::<Vec<usize>, usize>::new();
    for face in faces {
        let corners = match (dimension, face.nodes.len()) {
            (2, _) => 2,
            (_, 3 | 6) => 3,
            _ => 4,
        };
        for k in 0..corners {
            let next = if dimension == 2 { k } else { (k + 1) % corners };
            let mut border = vec![face.nodes[k], face.nodes[next]];
            border.sort_unstable();
            *met.entry(border).or_default() += 1;
        }
    }
    met.into_iter().filter(|(_, count)| *count == 1).flat_map(|(border, _)| border).collect()
}

fn is_wet(history: &History, face: usize) -> bool {
    history.slot(face)[0] > 0.0
}

impl Term for PenetratingPressure {
    fn name(&self) -> &str {
        &self.name
    }
    fn role(&self) -> Role {
        Role::Load
    }
    fn initial(&self) -> History {
        History::new(self.faces.iter().map(|_| 1))
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let value = now(&self.value, accepted, at);
        Ok(Box::new(Open { load: self, value, wet: self.enter(accepted, history, value) }))
    }
    fn name_of(&self, stencil: usize) -> String {
        self.faces[stencil].under(&self.name)
    }
}

/// The fluid during one attempt.
struct Open<'a> {
    load: &'a PenetratingPressure,
    value: f64,
    wet: Vec<bool>,
}

impl Attempt for Open<'_> {
    fn scratch(&self, _: usize) -> Vec<f64> {
        vec![0.0]
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let unknowns = |face: &Face| self.load.site.unknowns(face.nodes.iter().copied());
        self.load.faces.iter().for_each(|face| out.push(unknowns(face), 0));
        Ok(())
    }
    fn evaluate(&self, index: usize, _: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        new[0] = f64::from(u8::from(self.wet[index]));
        if self.wet[index] {
            OpenFace { site: &self.load.site, face: &self.load.faces[index], pressure: self.value }.press(local);
        }
        Ok(0)
    }
}
