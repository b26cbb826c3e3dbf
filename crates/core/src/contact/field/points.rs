//! The points of a patch with their derivatives, which the nodes at the corners of its face share.
//!
//! Each of these nodes sums the same points, weighted by its own function, and it sums them for its forces, for its tangent and for
//! the kinks of the iteration. A thread therefore keeps the points of the patches that it evaluated last, with the unknowns
//! at which they hold.

use super::column::PointColumn;
use super::cover::Patch;
use super::face::CORNERS;
use super::nodes::NodesInPlace;
use super::patch::PatchInPlace;
use super::point::{PatchPoint, PointRates, Touched};
use super::support::FoundPatch;
use crate::tensor::Vec3;
use std::cell::RefCell;
use std::rc::Rc;

/// What a place of the surface saw at the accepted state.
pub type Recall<'a> = &'a dyn Fn(&NodesInPlace, &Patch, [f64; 2]) -> Option<Touched>;

/// Patches that a thread keeps: more than a row of faces across a surface sees, in some ten megabytes.
const KEPT: usize = 256;

thread_local! {
    static POINTS: RefCell<Vec<Rc<PatchPoints>>> = RefCell::new(vec![Rc::default(); KEPT]);
}

/// The points of a patch at values of the unknowns of its nodes and of the tool.
#[derive(Debug, Default)]
pub struct PatchPoints {
    /// The search that found the patch, and its number there.
    found: Option<(usize, usize)>,
    u: Vec<f64>,
    /// Whether every ray met the target.
    meets: bool,
    differentiated: bool,
    /// The points.
    pub points: Vec<PatchPoint>,
    /// Derivatives of each point along each unknown, point after point; none where they were not asked for.
    rates: Vec<PointRates>,
}

impl PatchPoints {
    /// Derivatives of a point along each unknown.
    pub fn rates(&self, point: usize) -> &[PointRates] {
        &self.rates[point * self.u.len()..(point + 1) * self.u.len()]
    }

    /// The points of patch `number` of a search at unknowns `at`; None where a ray runs along the target.
    pub fn of(
        (search, number, patch): (usize, usize, &FoundPatch),
        at: &NodesInPlace,
        recall: Recall,
        derivatives: bool,
    ) -> Option<Rc<Self>> {
        let asked = Some((search, number));
        let mut points = POINTS.with_borrow_mut(|kept| std::mem::take(&mut kept[number % KEPT]));
        let known = points.found == asked && points.u == at.u;
        if !known || (derivatives && !points.differentiated) {
            if Rc::get_mut(&mut points).is_none() {
                points = Rc::default();
            }
            if let Some(points) = Rc::get_mut(&mut points) {
                if !known {
                    points.found = asked;
                    points.u.clear();
                    points.u.extend_from_slice(at.u);
                    points.evaluate(at, &patch.patch, recall);
                }
                if derivatives && points.meets {
                    points.differentiate(at, &patch.patch);
                }
            }
        }
        let found = points.clone();
        POINTS.with_borrow_mut(|kept| kept[number % KEPT] = points);
        found.meets.then_some(found)
    }

    fn evaluate(&mut self, at: &NodesInPlace, patch: &Patch, recall: Recall) {
        self.points.clear();
        self.rates.clear();
        self.differentiated = false;
        self.meets = match (patch.tip, patch.corner) {
            (Some(landing), _) => at.tip_point((patch, landing), recall, &mut self.points).is_some(),
            (_, Some(touch)) => at.corner_point((patch, touch), recall, &mut self.points).is_some(),
            (None, None) => self.look(&PatchInPlace::new(at, patch), at, recall).is_some(),
        };
    }

    fn look(&mut self, patch: &PatchInPlace, at: &NodesInPlace, recall: Recall) -> Option<()> {
        let (surface, face) = (&at.contact.parts.surface, patch.face.face);
        let rest = face.at_rest(&at.contact.parts.mesh);
        for (number, spot) in patch.spots(false).into_iter().enumerate() {
            let xi = spot.xi;
            let frame = patch.face.at(xi);
            let (sight, n, gap, y) = patch.look(&frame)?;
            let weight = spot.weight * surface.density_at(face, &rest, spot.xi) * patch.facing(xi, n)[0];
            let touched = recall(at, &patch.patch, xi);
            let v = touched.map_or(Vec3::zero(), |touched| touched.now - frame.x);
            let (shape, vertex) = (frame.shape, spot.vertex);
            let [functions, dual] = surface.functions(patch.patch.face, patch.patch.dual, &frame.corners);
            let bulge =
                if patch.straightens { (frame.x - frame.corners.value(patch.face.corners())).dot(n) } else { 0.0 };
            self.points.push(PatchPoint {
                number,
                vertex,
                xi,
                weight,
                functions,
                dual,
                shape,
                gap: gap - patch.rise(xi, &sight).0,
                bulge,
                n,
                v,
                y,
                sight,
                touched,
            });
        }
        Some(())
    }

    fn differentiate(&mut self, at: &NodesInPlace, patch: &Patch) {
        self.differentiated = true;
        let columns = at.columns(patch);
        if let Some(landing) = patch.tip {
            at.tip_rates((patch, landing), &self.points, &columns, &mut self.rates);
            return;
        }
        if let Some(touch) = patch.corner {
            at.corner_rates((patch, touch), &self.points, &columns, &mut self.rates);
            return;
        }
        let in_place = PatchInPlace::new(at, patch);
        let (surface, face) = (&at.contact.parts.surface, in_place.face.face);
        let rest = face.at_rest(&at.contact.parts.mesh);
        let turning = turning(at, patch);
        let along = |(column, turning): (&PointColumn, &[Vec3; CORNERS])| in_place.bound_rates(column, turning);
        let bounds: Vec<_> = columns.iter().zip(&turning).map(along).collect();
        let still = in_place.tool.is_some() && !surface.plane && patch.seen.is_none();
        let spots = in_place.spots(true);
        for point in &self.points {
            let (spot, frame) = (&spots[point.number], in_place.face.at(point.xi));
            let density = if still {
                (surface.density_at(face, &rest, spot.xi), [0.0; 2])
            } else {
                surface.density(face, &rest, spot.xi)
            };
            let facing = in_place.facing(point.xi, point.n);
            let (_, rises) = in_place.rise(point.xi, &point.sight);
            for (column, (bounds, turning)) in columns.iter().zip(bounds.iter().zip(&turning)) {
                self.rates.push(in_place.rates(
                    point,
                    column,
                    (spot, &frame, facing),
                    rises,
                    &density,
                    (bounds, turning),
                ));
            }
        }
    }
}

/// Derivatives of the sums of area vectors at the corners of a face along each unknown.
fn turning(at: &NodesInPlace, patch: &Patch) -> Vec<[Vec3; CORNERS]> {
    let (surface, axes) = (&at.contact.parts.surface, at.axes());
    let mut out = vec![[Vec3::zero(); CORNERS]; at.u.len()];
    if !at.contact.needs_normals() {
        return out;
    }
    let corners = surface.faces[patch.face].corners();
    for (c, &node) in surface.field[patch.face][..corners].iter().enumerate() {
        surface.normal_rates(
            node,
            |f| at.placed(&surface.faces[f]),
            |node, rates| {
                if let Some(place) = at.place(node) {
                    (0..axes).for_each(|axis| out[place * axes + axis][c] += rates[axis]);
                }
            },
        );
    }
    out
}
