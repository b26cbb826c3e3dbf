//! Surfaces that are glued: found before anything else, since their nodes may move.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{self, TieGap};
use crate::source::Place;
use asperity_core::contact::field::{Apart, TieParts, TiedSurfaces};
use asperity_core::mesh::{Mesh, flat_normal};
use asperity_core::tensor::Vec3;
use std::sync::Arc;

/// Motions below this part of the size of the mesh are rounding.
const ROUNDING: f64 = 1e-12;
/// A note says where more than this part of the function of a node has nothing opposite: about a twentieth of a face.
const BARE: f64 = 0.1;
/// A warning says where the faces of what follows are longer by so much.
const COARSE: f64 = 2.0;

/// Components of a normal below which it has none.
const PARALLEL: f64 = 1e-9;

/// A flat group that a step holds or moves.
pub(super) struct HeldPlane {
    /// Its nodes, ascending.
    pub nodes: Vec<usize>,
    /// Its normal.
    pub normal: Vec3,
    /// Whether the motion along that is prescribed.
    pub stays: bool,
}

/// A tie and where the deck says it.
pub(super) struct Glued {
    /// What was found.
    pub tie: TiedSurfaces,
    /// Its number in the deck.
    pub number: usize,
    /// The groups of surface and target.
    pub names: [String; 2],
    /// Where.
    pub place: Place,
}

impl Builder<'_> {
    /// Finds the ties of the deck and closes their gaps.
    pub(super) fn glue(&mut self) {
        let deck = self.deck;
        self.ties = deck.tie.iter().enumerate().filter_map(|(number, keys)| self.tie(number, keys)).collect();
    }

    fn tie(&mut self, number: usize, keys: &keys::TieKeys) -> Option<Glued> {
        let mesh = self.site.mesh.clone();
        let sides = |group: &str| mesh.groups.get(group).map(|group| group.sides.as_slice());
        let (surface, target) = (sides(&keys.surface.text)?, sides(&keys.target.text)?);
        if surface.iter().any(|side| target.contains(side)) {
            let what = format!("`{}` and `{}` share some of their sides", keys.surface, keys.target);
            self.found.push(Diagnostic::error(what).at(keys.target.place).help("a tie is between two surfaces"));
            return None;
        }
        let tolerance = keys.tolerance.map(|tolerance| tolerance.value);
        let parts = TieParts { mesh: &mesh, space: self.site.space, surface, target, tolerance };
        let (tie, swapped) = match TiedSurfaces::finer_follows(&parts, BARE) {
            Ok(glued) => glued,
            Err(apart) => {
                self.apart(keys, &apart);
                return None;
            }
        };
        self.roles(keys, &tie, swapped);
        self.bare(keys, &tie);
        if keys.gap == TieGap::Close {
            self.close(&tie);
        }
        let names = [keys.surface.text.clone(), keys.target.text.clone()];
        Some(Glued { tie, number, names, place: keys.place })
    }

    /// Says that the target follows, or how coarse what follows is.
    fn roles(&mut self, keys: &keys::TieKeys, tie: &TiedSurfaces, swapped: bool) {
        let keys::TieKeys { surface, target, .. } = keys;
        let what = match swapped {
            true => format!(
                "the faces of `{surface}` are {:.1} times as long as those of `{target}`, whose nodes follow in their stead",
                tie.coarser.recip()
            ),
            false if tie.coarser >= COARSE => format!(
                "the faces of `{surface}`, whose nodes follow, are {:.1} times as long as those of `{target}`: what lies between is free, \
                 and too soft",
                tie.coarser
            ),
            false => return,
        };
        let found = if swapped {
            Diagnostic::note(what)
        } else {
            Diagnostic::warning(what).help("swap them, and glue what reaches beyond to nothing by [group.NAME]")
        };
        self.found.push(found.at(surface.place));
    }

    /// Says what of the surface reaches beyond the target.
    fn bare(&mut self, keys: &keys::TieKeys, tie: &TiedSurfaces) {
        let (keys::TieKeys { surface, target, .. }, (node, part)) = (keys, tie.barest);
        if part < BARE {
            return;
        }
        let (area, at) = (tie.bare, self.words(&self.site.mesh.points[node]));
        let all = tie.nodes[0].len();
        let free = all - tie.conditions.iter().filter(|condition| condition.follows).count();
        let mut what = format!(
            "{area:.3} of the area of `{surface}` has no face of `{target}` opposite and is not glued, most of it around {at}"
        );
        if free > 0 {
            what += &format!("; {free} of the {all} nodes follow nothing");
        }
        let label = format!("this surface reaches beyond `{target}`");
        self.found.push(Diagnostic::warning(what).at(keys.surface.place).label(label));
    }

    /// A place of the mesh.
    fn words(&self, x: &Vec3) -> String {
        let x = *x + self.site.mesh.origin;
        match self.plane() {
            true => format!("({:.4}, {:.4})", x[0], x[1]),
            false => format!("({:.4}, {:.4}, {:.4})", x[0], x[1], x[2]),
        }
    }

    fn apart(&mut self, keys: &keys::TieKeys, apart: &Apart) {
        let (keys::TieKeys { surface, target, .. }, at) = (keys, |x: &Vec3| self.words(x));
        let (what, help) = match apart {
            Apart::Far(distance, x, tolerance) => (
                format!(
                    "`{surface}` lies {distance:.3e} from `{target}` at {}, which is more than the tolerance, {tolerance:.3e}",
                    at(x)
                ),
                format!(
                    "name the part that is to be glued by [group.NAME], move it, or say tolerance = {:.2e}",
                    1.01 * distance
                ),
            ),
            Apart::Nothing(distance, x, tolerance) => (
                format!(
                    "no face of `{surface}` has `{target}` opposite within {tolerance:.3e}; the nearest nodes are {distance:.3e} \
                     apart, at {}",
                    at(x)
                ),
                "is it the right side of the right body? Raise `tolerance` where the gap is meant".into(),
            ),
        };
        self.found.push(Diagnostic::error(what).at(keys.place).help(help));
    }

    /// Moves the nodes of a tie together, within the planes that hold them.
    fn close(&mut self, tie: &TiedSurfaces) {
        let (mut mesh, least) = ((*self.site.mesh).clone(), ROUNDING * self.site.mesh.size());
        let planes = self.planes(&mesh);
        for (node, to) in tie.fitted(&mesh.points) {
            let mut by = to - mesh.points[node];
            for HeldPlane { normal, .. } in planes.iter().filter(|plane| plane.nodes.binary_search(&node).is_ok()) {
                by = by - *normal * normal.dot(by);
            }
            if by.norm() > least {
                mesh.points[node] += by;
            }
        }
        self.site.mesh = Arc::new(mesh);
    }

    /// The flat groups that a step holds or moves, and the axis of revolution.
    pub(super) fn planes(&self, mesh: &Mesh) -> Vec<HeldPlane> {
        let moved = self.deck.step.iter().flat_map(|step| &step.displacement);
        let mirrors = self.deck.step.iter().flat_map(|step| &step.symmetry);
        let names = moved.map(|(name, by)| (name, Some(by))).chain(mirrors.map(|name| (name, None)));
        let plane = |(name, by): (&crate::reader::Name, Option<&keys::Displacement>)| {
            let group = mesh.groups.get(&name.text).filter(|group| !group.sides.is_empty())?;
            let normal = Vec3(flat_normal(mesh, &group.sides)?);
            let given = |by: &keys::Displacement| match &by.along {
                Some(along) => {
                    let way = Vec3(std::array::from_fn(|axis| along.value.get(axis).copied().unwrap_or_default()));
                    way.unit().cross(normal).norm() < PARALLEL
                }
                None => {
                    let given = [by.x.is_some(), by.y.is_some(), by.z.is_some()];
                    (0..3).all(|axis| given[axis] || normal[axis].abs() < PARALLEL)
                }
            };
            Some(HeldPlane { nodes: group.nodes.clone(), normal, stays: by.is_none_or(given) })
        };
        let nodes = super::supports::on_axis(mesh, self.site.space);
        let axis = HeldPlane { nodes, normal: Vec3::axis(0), stays: false };
        names.filter_map(plane).chain([axis]).collect()
    }
}
