//! Incompatible modes of quadrilaterals and bricks of first degree: full integration, and no stiffness in bending that their
//! displacements alone cannot avoid.
//!
//! To the displacements of a cell come modes `M_k = 1 - xi_k^2` that need not agree with those of its neighbours (Wilson, Taylor,
//! Doherty and Ghaboussi 1973). Their gradients `G_k = dM_k/dX` over the undeformed cell lose their mean, so that constant stress
//! does no work on them and the patch test holds for any shape of cell (Taylor, Beresford and Wilson 1976; Wilson and
//! Ibrahimbegovic 1990). In finite strain they enhance the deformation gradient (Simo and Armero 1992), transposed and carried by
//! its mean `F0` over the cell, `F = F(u) + F0 sum_k G_k (x) a_k` (Glaser and Armero 1997): the shear that a bent cell cannot
//! avoid is so taken away, where `a_k (x) G_k` would turn it into a rotation, in which compressed cells buckle one by one.
//!
//! The amplitudes `a_k`, vectors over the undeformed body, belong to the cell: they are found from its own equilibrium by
//! Newton's method for any displacements of its nodes, and condensed out of its tangent. They are kept behind the states of the
//! cell's points, a few with each.

use super::attempt::OpenBody;
use super::gradient::{self, Rows, padded};
use super::operator::{Nodal, Tangent, add_forces, deformation};
use super::piola::place;
use super::point::PointStress;
use super::{Body, Strain};
use crate::mesh::Space;
use crate::mesh::cells::Cell;
use crate::system::Local;
use crate::tensor::{Tensor2, Vec3};
use crate::{Failure, Kind};

/// Most modes of a cell.
const MOST: usize = 3;
/// Most points of a cell.
const POINTS: usize = 8;
/// Most amplitudes.
const AMPLITUDES: usize = 3 * MOST;
/// Most unknowns of a cell's nodes.
const UNKNOWNS: usize = 3 * 8;
/// Change of the deformation gradient below which a Newton step for the amplitudes is the last: what is left of the cell's forces
/// is of second order in it, what is left of its tangent of first.
const SMALL: f64 = 1e-9;
/// Newton steps for the amplitudes.
const LIMIT: usize = 25;

/// How many modes cells of a kind may have.
pub(super) fn modes(kind: &Cell) -> usize {
    match (kind.degree, kind.dimension, kind.nodes.len()) {
        (1, 2, 4) => 2,
        (1, 3, 8) => 3,
        _ => 0,
    }
}

/// Amplitudes of a cell's modes.
type Amplitudes = [Vec3; MOST];

/// Takes from the modes' gradients, `columns` of the rows at the points of a cell, their means over its volume.
pub(super) fn take_mean(rows: &mut [f64], volumes: &[f64], (length, columns): (usize, std::ops::Range<usize>)) {
    let volume: f64 = volumes.iter().sum();
    for place in (0..3).flat_map(|j| columns.clone().map(move |k| j * length + k)) {
        let values = rows.chunks_exact(3 * length).zip(volumes);
        let mean = values.map(|(rows, volume)| rows[place] * volume).sum::<f64>() / volume;
        rows.chunks_exact_mut(3 * length).for_each(|rows| rows[place] -= mean);
    }
}

/// `sum_k G_k (x) a_k` from the gradients of the modes at a point.
fn enhancement(gradients: &Amplitudes, amplitudes: &Amplitudes) -> Tensor2 {
    let entry = |i: usize, j: usize| gradients.iter().zip(amplitudes).map(|(g, a)| g[i] * a[j]).sum();
    Tensor2::from_fn(entry)
}

/// Gradients of the modes at a point, `length` apart behind those of the nodes.
fn of_modes(rows: &[f64], (nodes, modes): (usize, usize)) -> Amplitudes {
    let (mut out, length) = ([Vec3::zero(); MOST], rows.len() / 3);
    for (k, out) in out.iter_mut().enumerate().take(modes) {
        *out = Vec3(std::array::from_fn(|j| rows[j * length + nodes + k]));
    }
    out
}

impl Body {
    /// How many amplitudes are kept with each point.
    pub(super) fn amplitudes_by_point(&self) -> usize {
        let axes = self.dofs.per_node();
        self.shapes.iter().map(|kind| (axes * kind.modes).div_ceil(kind.points.len())).max().unwrap_or(0)
    }

    /// Place of each amplitude in a cell's history, its mode and axis.
    fn amplitude_places(&self, modes: usize) -> impl Iterator<Item = (usize, (usize, usize))> + use<> {
        let (axes, share, len) = (self.dofs.per_node(), self.amplitudes_by_point(), self.point_len());
        let first = self.material.state_len() + usize::from(self.space == Space::PlaneStress);
        (0..axes * modes).map(move |n| (n / share * len + first + n % share, (n / axes, n % axes)))
    }

    fn amplitudes(&self, states: &[f64], modes: usize) -> Amplitudes {
        let mut out = [Vec3::zero(); MOST];
        self.amplitude_places(modes).for_each(|(place, (mode, axis))| out[mode][axis] = states[place]);
        out
    }

    /// What the modes of a cell add to the displacement gradient at its points, on the undeformed places.
    pub(super) fn enhancements(&self, slot: usize, states: &[f64], given: &[Tensor2]) -> Vec<Tensor2> {
        let view = self.mesh.cell(self.cells[slot]);
        let (nodes, shapes) = (view.nodes.len(), self.shapes(view.kind));
        let (x, length) = (self.undeformed(view.nodes), padded(nodes + shapes.modes));
        let (mut rows, mut volumes) = (Vec::new(), Vec::new());
        volumes.extend(shapes.points.iter().filter_map(|s| gradient::at(s, &x[..nodes], self.space, &mut rows)));
        take_mean(&mut rows, &volumes, (length, nodes..nodes + shapes.modes));
        let amplitudes = self.amplitudes(states, shapes.modes);
        let mean = match self.options.strain {
            Strain::Small => Tensor2::identity(),
            Strain::Finite => Tensor2::identity() + mean(given.iter().copied().zip(volumes)),
        };
        let at = |rows: &[f64]| mean * enhancement(&of_modes(rows, (nodes, shapes.modes)), &amplitudes);
        rows.chunks_exact(3 * length).map(at).collect()
    }
}

/// Mean of tensors over volumes.
fn mean(values: impl Iterator<Item = (Tensor2, f64)>) -> Tensor2 {
    let (mut sum, mut all) = (Tensor2::zero(), 0.0);
    for (value, volume) in values {
        sum = sum + value * volume;
        all += volume;
    }
    sum * all.recip()
}

/// A point of a cell with modes over an increment.
#[derive(Clone, Copy)]
struct ModePoint<const N: usize> {
    /// Gradients of the nodes, and of the modes, over the undeformed cell.
    undeformed: Rows<N>,
    modes: Amplitudes,
    /// Inverse of the deformation gradient at the accepted state, and the volume there.
    inverse: Tensor2,
    volume: f64,
    /// Gradients of the nodes' displacements over that, at the trial amplitudes.
    rows: Rows<N>,
    /// Deformation of the increment.
    f: Tensor2,
}

/// A cell with modes over an increment.
struct ModeCell<const DIM: usize, const N: usize> {
    points: [ModePoint<N>; POINTS],
    count: usize,
    /// Means of the nodes' gradients over the undeformed cell.
    mean: Rows<N>,
    /// Mean of the trial deformation gradient; one in small strain.
    carried: Tensor2,
    strain: Strain,
    /// Trial displacements, and those of the increment.
    u: Nodal<DIM, N>,
    du: Nodal<DIM, N>,
    /// Amplitudes of the accepted state.
    begun: Amplitudes,
}

/// Rows at some amplitudes: `dN + H^T dN0`.
fn carried_rows<const N: usize>(rows: &Rows<N>, mean: &Rows<N>, enhancement: &Tensor2) -> Rows<N> {
    let mut out = *rows;
    for (j, out) in out.iter_mut().enumerate() {
        for (k, mean) in mean.iter().enumerate() {
            let by = enhancement[(k, j)];
            out.iter_mut().zip(mean).for_each(|(out, mean)| *out += by * mean);
        }
    }
    out
}

/// `I + sum_L u_L (x) row_L` and the enhancement of the undeformed places, which is `H` itself.
fn total<const DIM: usize, const N: usize>(rows: &Rows<N>, u: &Nodal<DIM, N>, enhancement: &Tensor2) -> Tensor2 {
    deformation(rows, u) + *enhancement
}

impl<const DIM: usize, const N: usize> ModeCell<DIM, N> {
    /// Rows and deformation of all points at trial amplitudes.
    fn move_to(&mut self, amplitudes: &Amplitudes) {
        for point in &mut self.points[..self.count] {
            let by = enhancement(&point.modes, amplitudes);
            if self.strain == Strain::Small {
                let begun = enhancement(&point.modes, &self.begun);
                point.f = total(&point.rows, &self.du, &by) + begun * -1.0;
                continue;
            }
            let rows = carried_rows(&point.undeformed, &self.mean, &by);
            point.f = total(&rows, &self.u, &by) * point.inverse;
            for (j, out) in point.rows.iter_mut().enumerate() {
                out.fill(0.0);
                for (k, row) in rows.iter().enumerate() {
                    let by = point.inverse[(k, j)];
                    out.iter_mut().zip(row).for_each(|(out, row)| *out += by * row);
                }
            }
        }
    }
}

impl OpenBody<'_> {
    fn mode_cell<const DIM: usize, const N: usize>(
        &self,
        index: usize,
        (nodes, modes): (usize, usize),
        u: &[f64],
    ) -> Result<ModeCell<DIM, N>, Failure> {
        let strain = self.body.options.strain;
        let none = ModePoint {
            undeformed: [[0.0; N]; 3],
            modes: [Vec3::zero(); MOST],
            inverse: Tensor2::identity(),
            volume: 0.0,
            rows: [[0.0; N]; 3],
            f: Tensor2::identity(),
        };
        let (du, mut trial) = (self.increment::<DIM, N>(index, u), [[0.0; N]; DIM]);
        for (k, u) in u.as_chunks::<DIM>().0.iter().enumerate().take(nodes) {
            (0..DIM).for_each(|i| trial[i][k] = u[i]);
        }
        let begun = self.body.amplitudes(self.history.slot(index), modes);
        let mut cell = ModeCell {
            points: [none; POINTS],
            count: 0,
            mean: [[0.0; N]; 3],
            carried: Tensor2::identity(),
            strain,
            u: trial,
            du,
            begun,
        };
        for (point, out) in self.points(index).zip(&mut cell.points) {
            let rows = point.rows::<N>();
            out.modes = of_modes(rows.as_flattened(), (nodes, modes));
            out.undeformed = *rows;
            out.undeformed.iter_mut().for_each(|row| row[nodes..].fill(0.0));
            (out.rows, out.volume) = (out.undeformed, point.volume);
            cell.count += 1;
        }
        if strain == Strain::Small {
            return Ok(cell);
        }
        let points = &mut cell.points[..cell.count];
        let whole: f64 = points.iter().map(|point| point.volume).sum();
        for point in points.iter() {
            for (mean, row) in cell.mean.iter_mut().zip(&point.undeformed).take(DIM) {
                mean.iter_mut().zip(row).for_each(|(mean, row)| *mean += point.volume / whole * row);
            }
        }
        cell.carried = deformation(&cell.mean, &cell.u);
        let accepted: Nodal<DIM, N> = std::array::from_fn(|i| std::array::from_fn(|k| cell.u[i][k] - cell.du[i][k]));
        for point in points {
            let by = enhancement(&point.modes, &cell.begun);
            let f = total(&carried_rows(&point.undeformed, &cell.mean, &by), &accepted, &by);
            let det = f.det();
            if !(det > 0.0) {
                return Err(Failure::new("a cell is turned inside out").of(Kind::Inverted));
            }
            point.inverse = f.inverse();
            point.volume *= det;
        }
        Ok(cell)
    }

    /// Forces of a cell with modes, these in equilibrium, and its tangent with them condensed.
    pub(super) fn evaluate_with_modes<const DIM: usize, const D: usize, const N: usize>(
        &self,
        index: usize,
        new: &mut [f64],
        local: &mut Local,
        modes: usize,
    ) -> Result<(), Failure> {
        let (nodes, symmetric) = (self.nodes(index).len(), self.body.material.is_conservative());
        let mut cell = self.mode_cell::<DIM, N>(index, (nodes, modes), &local.u)?;
        let (mut amplitudes, length) = (cell.begun, local.u.len());
        let gradients = cell.points[..cell.count].iter().flat_map(|point| point.modes);
        let steepest = gradients.fold(0.0, |most: f64, g| most.max(g.norm()));
        for _ in 0..LIMIT {
            local.reset(length);
            cell.move_to(&amplitudes);
            let mut tangent = Tangent::<DIM, N>::zero(nodes, symmetric);
            let mut own = Condensed::<DIM>::new(modes, nodes, symmetric);
            let points = cell.points[..cell.count].iter().map(|point| (&point.rows, point.volume, point.f));
            let each = |number: usize, s: &PointStress<D>, volume: f64| own.add(&cell, number, s, volume);
            let (force, _) =
                self.add_points::<DIM, D, N>((index, points), new, local, (None, Some(&mut tangent)), each)?;
            if !own.solve() {
                break;
            }
            let step = own.column(0);
            let largest = step.iter().fold(0.0, |most: f64, step| most.max(step.abs()));
            if largest * steepest <= SMALL {
                let places = self.body.amplitude_places(modes);
                places.for_each(|(place, (mode, axis))| new[place] = amplitudes[mode][axis]);
                tangent.write(length, &mut local.tangent);
                own.write(&force, local);
                return Ok(());
            }
            (0..DIM * modes).for_each(|n| amplitudes[n / DIM][n % DIM] -= step[n]);
        }
        Err(Failure::new("the incompatible modes find no equilibrium").of(Kind::Material))
    }
}

/// The equations of the amplitudes of a cell, and what they do to those of its nodes.
struct Condensed<const DIM: usize> {
    /// By amplitude: derivatives along the amplitudes, the residual, derivatives along the unknowns of the nodes.
    rows: [[f64; AMPLITUDES + 1 + UNKNOWNS]; AMPLITUDES],
    /// By amplitude: derivatives along it of the forces on the nodes.
    columns: [[f64; UNKNOWNS]; AMPLITUDES],
    amplitudes: usize,
    unknowns: usize,
    symmetric: bool,
}

impl<const DIM: usize> Condensed<DIM> {
    fn new(modes: usize, nodes: usize, symmetric: bool) -> Self {
        Self {
            rows: [[0.0; AMPLITUDES + 1 + UNKNOWNS]; AMPLITUDES],
            columns: [[0.0; UNKNOWNS]; AMPLITUDES],
            amplitudes: DIM * modes,
            unknowns: DIM * nodes,
            symmetric,
        }
    }

    /// Adds a point with its stress.
    fn add<const D: usize, const N: usize>(
        &mut self,
        cell: &ModeCell<DIM, N>,
        number: usize,
        s: &PointStress<D>,
        volume: f64,
    ) {
        let (point, count) = (&cell.points[number], self.amplitudes);
        // Derivative of f along each amplitude, and its product with the derivative of P.
        let carried = point.modes.map(|g| cell.carried * g);
        let along = |n: usize| -> [f64; D] {
            let (vector, axis) = (carried[n / DIM], n % DIM);
            std::array::from_fn(|d| match place::<D>(d) {
                (i, j) if i < DIM && j < DIM => vector[i] * point.inverse[(axis, j)],
                _ => 0.0,
            })
        };
        let mut all = [[0.0; D]; AMPLITUDES];
        (0..count).for_each(|n| all[n] = along(n));
        let work = |a: &[f64; D], b: &[f64; D]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        for n in 0..count {
            let stress: [f64; D] = std::array::from_fn(|d| work(&s.tangent[d], &all[n]));
            for m in 0..count {
                self.rows[m][n] += volume * work(&all[m], &stress);
            }
            self.rows[n][count] += volume * work(&all[n], &s.p);
            let mut force = [[0.0; N]; DIM];
            add_forces(&point.rows, &stress, volume, &mut force);
            self.add_geometric(cell, (number, n), s, (volume, &mut force));
            spread(&force, &mut self.columns[n][..self.unknowns]);
            if !self.symmetric {
                let stress: [f64; D] = std::array::from_fn(|d| (0..D).map(|e| s.tangent[e][d] * all[n][e]).sum());
                force = [[0.0; N]; DIM];
                add_forces(&point.rows, &stress, volume, &mut force);
                self.add_geometric(cell, (number, n), s, (volume, &mut force));
            }
            spread(&force, &mut self.rows[n][count + 1..][..self.unknowns]);
        }
    }

    /// The stress on the second derivative of f along an amplitude and the nodes: `dF0 G_k (x) da_k`.
    fn add_geometric<const D: usize, const N: usize>(
        &self,
        cell: &ModeCell<DIM, N>,
        (number, n): (usize, usize),
        s: &PointStress<D>,
        (volume, force): (f64, &mut Nodal<DIM, N>),
    ) {
        let (point, axis) = (&cell.points[number], n % DIM);
        let gradient = point.modes[n / DIM];
        for (i, force) in force.iter_mut().enumerate() {
            let pulled: f64 = (0..DIM).map(|j| s.p[DIM * i + j] * point.inverse[(axis, j)]).sum();
            for (mean, g) in cell.mean.iter().zip(gradient.0) {
                force.iter_mut().zip(mean).for_each(|(force, mean)| *force += volume * pulled * g * mean);
            }
        }
    }

    /// Gauss and Jordan's elimination with row exchanges: all other columns become those of the inverse times them. Says no
    /// where the amplitudes have no stiffness.
    fn solve(&mut self) -> bool {
        let (count, width) = (self.amplitudes, self.amplitudes + 1 + self.unknowns);
        let rows = &mut self.rows[..count];
        for k in 0..count {
            let pivot = (k..count).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs())).unwrap_or(k);
            rows.swap(k, pivot);
            let by = rows[k][k].recip();
            if !by.is_finite() {
                return false;
            }
            rows[k][k..width].iter_mut().for_each(|entry| *entry *= by);
            let row = rows[k];
            for (_, other) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
                let factor = other[k];
                other[k..width].iter_mut().zip(&row[k..width]).for_each(|(other, entry)| *other -= factor * entry);
            }
        }
        true
    }

    /// One of the solved columns behind the amplitudes' own.
    fn column(&self, number: usize) -> [f64; AMPLITUDES] {
        std::array::from_fn(|n| if n < self.amplitudes { self.rows[n][self.amplitudes + number] } else { 0.0 })
    }

    /// Writes the forces on the cell's nodes, and takes the amplitudes out of its tangent where it is wanted.
    fn write<const N: usize>(&self, force: &Nodal<DIM, N>, local: &mut Local) {
        let (count, unknowns) = (self.amplitudes, self.unknowns);
        for r in 0..unknowns {
            let follows =
                |column: usize| -> f64 { (0..count).map(|n| self.columns[n][r] * self.rows[n][count + column]).sum() };
            local.force[r] = force[r % DIM][r / DIM] - follows(0);
            if local.wants_tangent {
                for c in 0..unknowns {
                    local.tangent[r * unknowns + c] = if self.symmetric && c < r {
                        local.tangent[c * unknowns + r]
                    } else {
                        local.tangent[r * unknowns + c] - follows(1 + c)
                    };
                }
            }
        }
    }
}

/// Adds what is nodal to a list over nodes and axes.
fn spread<const DIM: usize, const N: usize>(nodal: &Nodal<DIM, N>, out: &mut [f64]) {
    out.iter_mut().enumerate().for_each(|(r, out)| *out += nodal[r % DIM][r / DIM]);
}
