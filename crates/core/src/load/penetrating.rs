//! Pressure of a fluid that enters an opening: it acts on the faces of a surface from where it stands up to where contact
//! bears more than its pressure.
//!
//! What is wet is found anew at each accepted state, and holds over the increment that follows. A closed node of a contact that bears
//! more than the fluid keeps it from what the node sees of the faces around it, weighted by its function: up to the edge of a tool that
//! ends within a face. The rest of a face is open. The fluid begins at the nodes where it stands and comes over faces that are open as
//! a whole; it presses on these and on those beside them, there with the open part of its pressure, so that fluid and contact share
//! the face in which the front lies. A node of such a face that lies behind the front holds nothing of it: beside an edge one node may
//! bear all and the next nothing. Where the fluid acts it has taken its part from a node: it stays while contact and fluid
//! bear no more than its pressure together, but for a small part by which a front would come and go.

use super::face::{Face, area};
use super::follower::{OpenFace, present};
use super::{Site, now};
use crate::amplitude::Timeline;
use crate::mesh::Side;
use crate::system::{Attempt, Branch, History, Instant, Local, Role, State, Stencil, Stencils, Term};
use crate::{Error, Failure};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

/// Part of the fluid's pressure by which contact must bear more before the fluid leaves where it acts.
const STAYS: f64 = 0.02;
/// Part of a face that counts as none: between two bodies nodes that stood opposite each other have moved apart by so much.
const LEAST: f64 = 0.01;

/// A pressure that contact bears, and the undeformed areas over which it stands around corners of sides.
type Borne = (f64, Vec<(Side, usize, f64)>);

/// What contacts bear, which the model tells when it has been put together.
#[derive(Clone, Default)]
pub struct Bearing(Arc<OnceLock<Box<Tells>>>);

/// What tells it in an accepted state.
type Tells = dyn Fn(&State) -> Vec<Borne> + Send + Sync;

impl Bearing {
    /// Tells it, once.
    pub fn tell(&self, borne: impl Fn(&State) -> Vec<Borne> + Send + Sync + 'static) {
        let _ = self.0.set(Box::new(borne));
    }
    fn in_state(&self, state: &State) -> Vec<Borne> {
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
        let wet = areas.iter().enumerate().fold(0.0, |sum, (i, area)| sum + history.slot(i)[0] * area);
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

    /// The part of each face that a fluid of pressure `p` wets after an accepted state.
    fn enter(&self, state: &State, history: &History, p: f64) -> Vec<f64> {
        let mut wet = vec![0.0; self.faces.len()];
        if p <= 0.0 {
            return wet;
        }
        let (mut open, whole) = (vec![1.0; self.faces.len()], self.areas(&vec![0.0; state.u.len()]));
        let numbers: BTreeMap<Side, usize> = self.faces.iter().zip(0..).map(|(face, i)| (face.side, i)).collect();
        let (mut seen, mut excess, mut admitted) = (vec![0.0; wet.len()], BTreeMap::<usize, f64>::new(), Vec::new());
        for (pressure, areas) in self.bearing.in_state(state) {
            let mut here = BTreeMap::<usize, BTreeMap<usize, f64>>::new();
            for (side, node, area) in areas {
                let Some(&i) = numbers.get(&side) else { continue };
                *here.entry(i).or_default().entry(node).or_default() += area;
            }
            let areas = || here.iter().map(|(&i, around)| (i, around.values().sum::<f64>()));
            let sum =
                |[fluid, all]: [f64; 2], (i, area): (usize, f64)| [fluid + taken(history, i, p) * area, all + area];
            let [fluid, all] = areas().fold([0.0; 2], sum);
            let more = pressure * all + fluid - p * all - STAYS * fluid;
            for (i, area) in areas() {
                seen[i] += area / whole[i];
                if more > 0.0 {
                    open[i] -= area / whole[i];
                } else {
                    let nearest = here[&i].iter().max_by(|a, b| a.1.total_cmp(b.1)).map(|(node, _)| *node);
                    admitted.push((i, nearest, area));
                }
            }
            here.values().flatten().for_each(|(&node, area)| *excess.entry(node).or_default() += more * area / all);
        }
        let mut nodes = self.source.clone();
        let hangs_over =
            |node: &usize| (0..wet.len()).any(|i| seen[i] < 1.0 - LEAST && self.faces[i].nodes.contains(node));
        nodes.retain(|node| excess.get(node).is_none_or(|more| *more <= 0.0) || hangs_over(node));
        loop {
            let face = |i: usize| &self.faces[i].nodes;
            let enters = |&i: &usize| wet[i] == 0.0 && open[i] > LEAST && face(i).iter().any(|n| nodes.contains(n));
            let entered: Vec<usize> = (0..wet.len()).filter(enters).collect();
            if entered.is_empty() {
                break;
            }
            for i in entered {
                wet[i] = open[i];
                if open[i] > 1.0 - LEAST {
                    nodes.extend(face(i));
                }
            }
        }
        let behind = admitted.into_iter().filter(|(_, nearest, _)| nearest.is_some_and(|node| !nodes.contains(&node)));
        behind.for_each(|(i, _, area)| wet[i] = (wet[i] - area / whole[i]).max(0.0));
        wet
    }
}

/// What a fluid whose pressure is now `p` takes of what presses on a face: no more than it took, and than it can.
fn taken(history: &History, face: usize, p: f64) -> f64 {
    let [wet, pressure] = [0, 1].map(|k| history.slot(face)[k]);
    wet * pressure.min(p)
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

impl Term for PenetratingPressure {
    fn name(&self) -> &str {
        &self.name
    }
    fn role(&self) -> Role {
        Role::Load
    }
    fn initial(&self) -> History {
        History::new(self.faces.iter().map(|_| 2))
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
    wet: Vec<f64>,
}

impl Attempt for Open<'_> {
    fn scratch(&self, _: usize) -> Vec<f64> {
        vec![0.0; 2]
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let unknowns = |face: &Face| self.load.site.unknowns(face.nodes.iter().copied());
        self.load.faces.iter().for_each(|face| out.push(unknowns(face), 0));
        Ok(())
    }
    fn evaluate(&self, index: usize, _: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        new.copy_from_slice(&[self.wet[index], self.value]);
        if new[0] > 0.0 {
            let pressure = self.value * new[0];
            OpenFace { site: &self.load.site, face: &self.load.faces[index], pressure }.press(local);
        }
        Ok(0)
    }
}
