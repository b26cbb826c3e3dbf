//! A contact during one attempt: its points as stencils, evaluated on the segments that the search found.

use super::landmarks::Landmarks;
use super::pair::Contact;
use super::point::{self, Constants, Place, triad};
use super::record::entry;
use super::surface::MAX_EDGE_NODES;
use crate::Failure;
use crate::interface::Past;
use crate::mesh::Space;
use crate::system::{Attempt, Branch, History, Local, Stencil, Stencils, Term};
use crate::tensor::{Dual, Scalar, Vec3};
use crate::tool::{Hit, Pose, Ray, Rejected};
use std::cell::RefCell;

/// Unknowns of a tool in the plane.
const TOOL_DOFS: usize = 3;
/// Most unknowns of a stencil.
const MAX_DOFS: usize = 2 * MAX_EDGE_NODES + TOOL_DOFS;

type D = Dual<8>;

/// A contact during one attempt.
pub struct OpenContact<'a> {
    /// The contact.
    pub contact: &'a Contact,
    /// Its history in the accepted state.
    pub history: &'a History,
    /// Largest admissible penetration at each point.
    pub depths: Vec<f64>,
    /// Pattern of the accepted state.
    pub landmarks: Landmarks,
    /// Pressure up to which the tangent is exact.
    pub ordinary: f64,
    /// Length of the increment.
    pub dt: f64,
}

/// Begins the new history of a point with what the search found.
pub fn write_hit(hit: Option<Hit>, values: &mut [f64]) {
    values.fill(0.0);
    match hit {
        Some(hit) => {
            values[entry::PENETRATION] = hit.u;
            values[entry::SEGMENT] = hit.segment as f64;
            values[entry::S] = hit.s;
        }
        None => values[entry::SEGMENT] = -1.0,
    }
}

thread_local! {
    /// Memory of the search, so that casting a ray allocates nothing.
    static HITS: RefCell<Vec<Hit>> = const { RefCell::new(Vec::new()) };
}

impl Attempt for OpenContact<'_> {
    fn is_fixed(&self) -> bool {
        false
    }

    fn scratch(&self, index: usize) -> Vec<f64> {
        vec![0.0; self.history.slot(index).len()]
    }

    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let contact = self.contact;
        let (pose, mut rejected) = (contact.pose(u), Rejected::default());
        let tool = contact.dofs.tool(contact.tool_number);
        HITS.with_borrow_mut(|hits| {
            for (point, &depth) in contact.surface.points.iter().zip(&self.depths) {
                let (a, tangent) = contact.locate(point, u);
                let (_, inward, _) = triad(tangent);
                let hit = contact.cast(&pose, Ray { origin: a, direction: inward }, depth, (hits, &mut rejected));
                let nodes = contact.surface.nodes(point).iter().flat_map(|&n| [0, 1].map(|c| contact.dofs.node(n) + c));
                let tool = if hit.is_some() { tool..tool + TOOL_DOFS } else { tool..tool };
                let (choice, near) = hit.map_or((0, 0.0), |hit| (hit.segment as u32 + 1, hit.s));
                out.push_near(nodes.chain(tool), choice, near);
            }
        });
        Ok(())
    }

    fn evaluate(&self, index: usize, stencil: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else {
            write_hit(None, new);
            return Ok(0);
        };
        let geometry = self.geometry(index, &local.u, segment, stencil.near)?;
        if local.wants_tangent {
            self.evaluate_over::<D>(index, &geometry, new, local, |place, constants, past, vars| {
                point::evaluate(place, constants, |m| self.contact.law.respond_plane(m, past, vars))
            })
        } else {
            self.evaluate_over::<f64>(index, &geometry, new, local, |place, constants, past, vars| {
                point::evaluate(place, constants, |m| self.contact.law.respond(m, past, vars))
            })
        }
    }
}

/// Where everything is at one point, in plain numbers.
struct Geometry {
    place: Place<f64>,
    pose: Pose,
    hit: Hit,
}

/// Numbers that can be seeded as independent variables: [`D`] and, trivially, `f64`.
trait Seed: Scalar {
    fn seed(value: f64, direction: usize) -> Self;
    fn slopes(&self) -> [f64; 8];
}

impl Seed for f64 {
    fn seed(value: f64, _: usize) -> f64 {
        value
    }
    fn slopes(&self) -> [f64; 8] {
        [0.0; 8]
    }
}

impl Seed for D {
    fn seed(value: f64, direction: usize) -> D {
        D::variable(value, direction)
    }
    fn slopes(&self) -> [f64; 8] {
        self.du
    }
}

fn seed<T: Seed>(v: Vec3, direction: usize) -> Vec3<T> {
    Vec3([T::seed(v[0], direction), T::seed(v[1], direction + 1), T::zero()])
}

type Evaluated<T> = Result<(T, Option<point::Closed<T>>), Failure>;

impl OpenContact<'_> {
    fn geometry(&self, index: usize, u: &[f64], segment: usize, near: f64) -> Result<Geometry, Failure> {
        let contact = self.contact;
        let point = &contact.surface.points[index];
        let nodes = contact.surface.nodes(point);
        let mut x = [Vec3::zero(); MAX_EDGE_NODES];
        for ((x, u), &node) in x.iter_mut().zip(u.chunks_exact(2)).zip(nodes) {
            *x = contact.mesh.points[node] + Vec3::new(u[0], u[1], 0.0);
        }
        let (a, tangent) = point.place(&x[..nodes.len()]);
        let (_, inward, _) = triad(tangent);
        let motion = &u[2 * nodes.len()..];
        let pose = Pose::new(motion[0], motion[1], motion[2]);
        let lost = || Failure::new(format!("{}: its ray runs along the target", contact.name_of(index)));
        let ray = Ray { origin: a, direction: inward };
        let hit = contact.tool.cast_segment(&pose, segment, &ray, near).ok_or_else(lost)?;
        let old = self.history.slot(index);
        let touched = (old[entry::SEGMENT] >= 0.0)
            .then(|| contact.tool.point(&pose, old[entry::SEGMENT] as usize, old[entry::S]));
        Ok(Geometry { place: Place { a, tangent, b: a + inward * hit.u, touched }, pose, hit })
    }

    fn evaluate_over<T: Seed>(
        &self,
        index: usize,
        geometry: &Geometry,
        new: &mut [f64],
        local: &mut Local,
        evaluate: impl FnOnce(&Place<T>, &Constants, &Past, &mut [f64]) -> Evaluated<T>,
    ) -> Result<Branch, Failure> {
        let (contact, old, g) = (self.contact, self.history.slot(index), geometry);
        let point = &contact.surface.points[index];
        let place = Place {
            a: seed(g.place.a, 0),
            tangent: seed(g.place.tangent, 2),
            b: seed(g.place.b, 4),
            touched: g.place.touched.map(|x| seed(x, 6)),
        };
        let constants = Constants {
            normal: g.hit.normal,
            before: old[entry::PENETRATION],
            least: contact.least,
            expected: if local.aid.expects { self.expected(index, &g.hit) } else { None },
            weight: point.weight * contact.thickness(),
            turning: self.turning(g.hit.u, local),
            axisymmetric: contact.space == Space::Axisymmetric,
        };
        let options = &contact.options;
        let past = Past {
            penalty: options.penalty * local.aid.stiffness,
            tangential_penalty: options.tangential_penalty * local.aid.stiffness,
            pressure: old[entry::PRESSURE],
            shear: [old[entry::SHEAR], 0.0],
            vars: &old[entry::COUNT..],
            dt: self.dt,
        };
        write_hit(Some(g.hit), new);
        let (_, closed) = evaluate(&place, &constants, &past, &mut new[entry::COUNT..])?;
        let Some(closed) = closed else {
            // What has been is kept while the point is open; the law's own state starts afresh.
            for kept in [entry::SLIP, entry::SLIPPED, entry::DISSIPATED] {
                new[kept] = old[kept];
            }
            self.account(index, g, [0.0; 2], local);
            return Ok(0);
        };
        self.refuse_jump(index, g)?;
        new[entry::PENETRATION] -= constants.least;
        self.write(&closed, old, new);
        self.add(index, g, &closed, local);
        let response = &closed.response;
        self.account(index, g, [response.pressure.re(), response.shear[0].re()], local);
        Ok(response.status as Branch)
    }

    /// Energy stored by a pressure and a friction stress, and dissipated over the increment: the work of the mean
    /// friction stress on the whole slip, less what of it is stored. A point that closes or opens takes part with half
    /// its stress, so that one which passes a peak of pressure within an increment does not lose its work.
    fn account(&self, index: usize, g: &Geometry, [pressure, shear]: [f64; 2], local: &mut Local) {
        let (contact, before) = (self.contact, self.history.slot(index)[entry::SHEAR]);
        let elastic = |stress: f64, penalty: f64| 0.5 * stress * stress / penalty;
        let stored = |shear: f64| elastic(shear, contact.options.tangential_penalty);
        let (along, _, _) = triad(g.place.tangent);
        let slip = g.place.touched.map_or(0.0, |touched| along.dot(touched - g.place.a));
        let area = contact.area(&contact.surface.points[index], g.place.a, g.place.tangent);
        local.stored = area * (elastic(pressure, contact.options.penalty) + stored(shear));
        local.dissipated = area * (0.5 * (before + shear) * slip - (stored(shear) - stored(before)));
    }

    /// What the pattern of the accepted state says of a point that has moved to `hit`.
    fn expected(&self, index: usize, hit: &Hit) -> Option<bool> {
        self.landmarks.expected(index, self.contact.tool().point(&Pose::default(), hit.segment, hit.s))
    }

    /// Part of the triad's derivatives that the tangent keeps at a penetration.
    fn turning(&self, penetration: f64, local: &Local) -> f64 {
        let pressure = self.contact.options.penalty * local.aid.stiffness * penetration.abs();
        if pressure > self.ordinary { self.ordinary / pressure } else { 1.0 }.min(local.aid.turning)
    }

    /// A point that had nothing before it and now lies deep has jumped over the target's face.
    fn refuse_jump(&self, index: usize, g: &Geometry) -> Result<(), Failure> {
        let depth = 0.25 * self.depths[index];
        if g.place.touched.is_none() && g.hit.u > depth {
            let name = self.contact.name_of(index);
            return Err(Failure::new(format!("{name} came to lie {:.3e} deep in one increment", g.hit.u)));
        }
        Ok(())
    }

    fn write<T: Seed>(&self, closed: &point::Closed<T>, old: &[f64], new: &mut [f64]) {
        let response = &closed.response;
        new[entry::PRESSURE] = response.pressure.re();
        new[entry::SHEAR] = response.shear[0].re();
        new[entry::SLIP] = old[entry::SLIP] + closed.slip.re();
        new[entry::SLIPPED] = old[entry::SLIPPED] + response.slipped;
        new[entry::DISSIPATED] = old[entry::DISSIPATED] + response.dissipated;
        new[entry::STATUS] = f64::from(response.status as u8);
        new[entry::VIOLATION] = response.violation;
        new[entry::LAST_DISSIPATED] = response.dissipated;
    }

    /// Forces on the nodes (`-N_L f`) and on the tool (`+f` and its moment about the reference point), and their
    /// derivatives by the chain rule through the eight directions.
    fn add<T: Seed>(&self, index: usize, g: &Geometry, closed: &point::Closed<T>, local: &mut Local) {
        let contact = self.contact;
        let point = &contact.surface.points[index];
        let nodes = contact.surface.nodes(point).len();
        let (n, force) = (local.force.len(), closed.force);
        let reference = contact.tool.reference() + g.pose.translation;
        let arm = closed.hit - reference.lift();
        let moment = arm[0] * force[1] - arm[1] * force[0];
        let rows = |k: usize| match k.checked_sub(2 * nodes) {
            None => (force[k % 2], -point.n[k / 2]),
            Some(2) => (moment, 1.0),
            Some(axis) => (force[axis], 1.0),
        };
        for k in 0..n {
            let (value, factor) = rows(k);
            local.force[k] += factor * value.re();
        }
        if !local.wants_tangent {
            return;
        }
        let columns = self.columns(index, g, nodes);
        for k in 0..n {
            let (value, factor) = rows(k);
            let slopes = value.slopes();
            for (j, column) in columns[..n].iter().enumerate() {
                let along: f64 = slopes.iter().zip(column).map(|(s, c)| s * c).sum();
                local.tangent[k * n + j] += factor * along;
            }
        }
        // The arm also shortens as the reference point itself moves.
        let last = (n - 1) * n + 2 * nodes;
        local.tangent[last] -= force[1].re();
        local.tangent[last + 1] += force[0].re();
    }

    /// Derivatives of the eight directions along each unknown of the stencil.
    fn columns(&self, index: usize, g: &Geometry, nodes: usize) -> [[f64; 8]; MAX_DOFS] {
        let (contact, point) = (self.contact, &self.contact.surface.points[index]);
        let mut columns = [[0.0; 8]; MAX_DOFS];
        for (k, column) in columns[..2 * nodes].iter_mut().enumerate() {
            column[k % 2] = point.n[k / 2];
            column[2 + k % 2] = point.dn[k / 2];
        }
        let reference = contact.tool.reference();
        let at_hit = g.pose.rates(reference, g.place.b);
        let at_touched = g.place.touched.map(|x| g.pose.rates(reference, x));
        for k in 0..TOOL_DOFS {
            let column = &mut columns[2 * nodes + k];
            (column[4], column[5]) = (at_hit[k][0], at_hit[k][1]);
            if let Some(rates) = &at_touched {
                (column[6], column[7]) = (rates[k][0], rates[k][1]);
            }
        }
        columns
    }
}
