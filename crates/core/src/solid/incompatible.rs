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
//! The change of volume of a brick's displacements has terms `xi_i xi_j` that these modes do not reach: where the law keeps its volume a bar
//! that bends ever more along its length could not curve across it. There a fourth, `M = xi_1 xi_2 xi_3`, adds its gradient to the volume
//! alone, `F0 (G . a) I` (the dilatational modes of Simo, Armero and Taylor 1993).
//!
//! The amplitudes `a_k`, vectors over the undeformed body, belong to the cell: they are found from its own equilibrium by
//! Newton's method for any displacements of its nodes, and condensed out of its tangent. They are kept behind the states of the
//! cell's points, a few with each.

use super::attempt::OpenBody;
use super::gradient::{self, Rows, padded};
use super::lanes::{add_multiple, dot};
use super::operator::{Nodal, Tangent, add_forces_by, deformation};
use super::point::PointStress;
use super::{Body, Choice, Formulation, Strain};
use crate::mesh::Space;
use crate::mesh::cells::Cell;
use crate::system::Local;
use crate::tensor::{Tensor2, Vec3, invert};
use crate::{Failure, FailureKind};
use pulp::{Arch, Simd, WithSimd};

/// Most modes of a cell.
const MOST: usize = 4;
/// The mode of a brick that changes its volume alone.
const VOLUME: usize = 3;
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

/// Whether cells of a kind may have modes.
pub(super) fn has_modes(kind: &Cell) -> bool {
    matches!((kind.degree, kind.dimension, kind.nodes.len()), (1, 2, 4) | (1, 3, 8))
}

/// How many the cells of a choice have.
pub(super) fn modes(choice: &Choice) -> usize {
    match (choice.formulation, choice.kind.dimension) {
        (Formulation::Incompatible, 3) => VOLUME + usize::from(choice.keeps_volume),
        (Formulation::Incompatible, axes) => axes,
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

/// `sum_k G_k (x) a_k + (G . a) I` from the gradients of the modes at a point.
fn enhancement(gradients: &Amplitudes, amplitudes: &Amplitudes) -> Tensor2 {
    let entry = |i: usize, j: usize| gradients.iter().zip(amplitudes).take(VOLUME).map(|(g, a)| g[i] * a[j]).sum();
    Tensor2::from_fn(entry) + Tensor2::identity() * gradients[VOLUME].dot(amplitudes[VOLUME])
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

    /// What the modes of a cell, where it has any, add to the displacement gradients at its points, on the undeformed places.
    pub(super) fn enhancements(&self, slot: usize, states: &[f64], given: &[Tensor2]) -> Vec<Tensor2> {
        let view = self.mesh.cell(self.cells[slot]);
        let (nodes, shapes) = (view.nodes.len(), self.shapes(view.kind));
        if shapes.modes == 0 {
            return Vec::new();
        }
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
    /// The latter times the mean deformation gradient.
    carried: Amplitudes,
    /// Inverse of the deformation gradient at the accepted state, the mean times it, and the volume there.
    inverse: Tensor2,
    whole: Tensor2,
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

impl<const DIM: usize, const N: usize> ModeCell<DIM, N> {
    /// Rows and deformation of all points at trial amplitudes.
    fn move_to(&mut self, amplitudes: &Amplitudes) {
        for point in &mut self.points[..self.count] {
            let by = enhancement(&point.modes, amplitudes);
            if self.strain == Strain::Small {
                let begun = enhancement(&point.modes, &self.begun);
                point.f = deformation(&point.rows, &self.du) + by + begun * -1.0;
                continue;
            }
            let rows = carried_rows(&point.undeformed, &self.mean, &by);
            // The places of the undeformed nodes with these rows make I + H.
            point.f = (deformation(&rows, &self.u) + by) * point.inverse;
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
            carried: [Vec3::zero(); MOST],
            inverse: Tensor2::identity(),
            whole: Tensor2::identity(),
            volume: 0.0,
            rows: [[0.0; N]; 3],
            f: Tensor2::identity(),
        };
        let (du, mut trial) = (self.increment::<DIM, N>(index, u), [[0.0; N]; DIM]);
        for (k, u) in u.as_chunks::<DIM>().0.iter().enumerate().take(nodes) {
            (0..DIM).for_each(|i| trial[i][k] = u[i]);
        }
        let begun = self.body.amplitudes(self.history.slot(index), modes);
        let mut cell = ModeCell { points: [none; POINTS], count: 0, mean: [[0.0; N]; 3], strain, u: trial, du, begun };
        for (point, out) in self.points(index).zip(&mut cell.points) {
            let rows = point.rows::<N>();
            out.modes = of_modes(rows.as_flattened(), (nodes, modes));
            out.carried = out.modes;
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
        let mean = deformation(&cell.mean, &cell.u);
        let accepted: Nodal<DIM, N> = std::array::from_fn(|i| std::array::from_fn(|k| cell.u[i][k] - cell.du[i][k]));
        for point in points {
            point.carried = point.modes.map(|g| mean * g);
            let by = enhancement(&point.modes, &cell.begun);
            let f = deformation(&carried_rows(&point.undeformed, &cell.mean, &by), &accepted) + by;
            let det = f.det();
            if det.is_nan() || det <= 0.0 {
                return Err(Failure::new("a cell is turned inside out").of(FailureKind::Inverted));
            }
            point.inverse = f.inverse();
            point.whole = mean * point.inverse;
            point.volume *= det;
        }
        Ok(cell)
    }

    /// Forces of stresses before the first increment on the amplitudes, by which these are not moved.
    fn borne_by_modes<const DIM: usize, const N: usize>(
        &self,
        index: usize,
        cell: &ModeCell<DIM, N>,
    ) -> [f64; AMPLITUDES] {
        let mut out = [0.0; AMPLITUDES];
        let Some(field) = &self.body.initial_stress else { return out };
        let (nodes, shapes) = (self.nodes(index), self.body.shapes(self.body.kind(index)));
        for ((point, open), shapes) in cell.points.iter().zip(self.points(index)).zip(&shapes.points) {
            let at =
                nodes.iter().zip(shapes.n).fold(Vec3::zero(), |sum, (&node, n)| sum + self.body.mesh.points[node] * n);
            let stress = Tensor2::from_voigt(field.at(at));
            let thickness = self.body.nominal_thickness();
            for (k, out) in out.iter_mut().enumerate().take(DIM * MOST) {
                let (gradient, axis) = (point.modes[k / DIM], k % DIM);
                let by = if k / DIM == VOLUME { gradient[axis] * stress.trace() } else { (stress * gradient)[axis] };
                *out += open.volume * thickness * by;
            }
        }
        out
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
        let borne = self.borne_by_modes::<DIM, N>(index, &cell);
        let mut stresses = [Stress { p: [0.0; D], tangent: [[0.0; D]; D], volume: 0.0 }; POINTS];
        let mut own = Own::new(DIM * modes);
        for _ in 0..LIMIT {
            local.reset(length);
            cell.move_to(&amplitudes);
            let points = cell.points[..cell.count].iter().map(|point| (&point.rows, point.volume, point.f));
            let keep = |number: usize, s: &PointStress<D>, volume: f64| {
                stresses[number] = Stress { p: s.p, tangent: s.tangent, volume };
            };
            let (force, _) = self.add_points::<DIM, D, N>((index, points), new, local, (None, None), Some(keep))?;
            Arch::new().dispatch(OwnSums { cell: &cell, stresses: &stresses, own: &mut own });
            own.force.iter_mut().zip(&borne).for_each(|(force, borne)| *force -= borne);
            if !own.solve() {
                break;
            }
            let step = own.step();
            let largest = step.iter().fold(0.0, |most: f64, step| most.max(step.abs()));
            if largest * steepest <= SMALL {
                let places = self.body.amplitude_places(modes);
                places.for_each(|(place, (mode, axis))| new[place] = amplitudes[mode][axis]);
                Arch::new().dispatch(Condense { cell: &cell, stresses: &stresses, own: &own, force, symmetric, local });
                return Ok(());
            }
            (0..DIM * modes).for_each(|n| amplitudes[n / DIM][n % DIM] -= step[n]);
        }
        Err(Failure::new(
            "the incompatible modes find no equilibrium: the law has no stiffness there, or not that of its stress",
        )
        .of(FailureKind::Material))
    }
}

/// Stress of a point with its derivatives, and the volume it acts on.
#[derive(Clone, Copy)]
struct Stress<const D: usize> {
    p: [f64; D],
    tangent: [[f64; D]; D],
    volume: f64,
}

/// A value of each component of the deformation along each amplitude.
type AlongAmplitudes<const D: usize> = [[f64; AMPLITUDES]; D];

impl<const D: usize> Stress<D> {
    /// Adds the changes of the stress along such changes of the deformation,
    #[inline(always)]
    fn along<S: Simd>(&self, simd: S, f: &AlongAmplitudes<D>, out: &mut AlongAmplitudes<D>) {
        for (out, row) in out.iter_mut().zip(&self.tangent) {
            for (entry, f) in row.iter().zip(f) {
                add_multiple(simd, *entry, f, out);
            }
        }
    }

    /// and what makes the work of such changes on any deformation.
    #[inline(always)]
    fn across<S: Simd>(&self, simd: S, f: &AlongAmplitudes<D>, out: &mut AlongAmplitudes<D>) {
        for (row, f) in self.tangent.iter().zip(f) {
            for (out, entry) in out.iter_mut().zip(row) {
                add_multiple(simd, *entry, f, out);
            }
        }
    }
}

impl<const DIM: usize, const N: usize> ModeCell<DIM, N> {
    /// Derivatives of the deformation of a point along so many amplitudes.
    #[inline(always)]
    fn along<const D: usize>(&self, point: &ModePoint<N>, count: usize, out: &mut AlongAmplitudes<D>) {
        for n in 0..count {
            let (mode, axis) = (n / DIM, n % DIM);
            for (i, out) in out.chunks_exact_mut(DIM).enumerate() {
                let (by, of, row) = match mode {
                    VOLUME => (point.modes[mode][axis], &point.whole, i),
                    _ => (point.carried[mode][i], &point.inverse, axis),
                };
                out.iter_mut().enumerate().for_each(|(j, out)| out[n] = by * of[(row, j)]);
            }
        }
    }

    /// The stress on the second derivatives of the deformation, `dF0 sum_k G_k (x) da_k`, along each amplitude: a gradient over the
    /// undeformed cell for each axis of forces. None in small strain.
    fn second<const D: usize>(&self, stresses: &[Stress<D>; POINTS], count: usize) -> [[Vec3; DIM]; AMPLITUDES] {
        let mut out = [[Vec3::zero(); DIM]; AMPLITUDES];
        for (point, s) in self.points[..self.count].iter().zip(stresses).filter(|_| self.strain == Strain::Finite) {
            for (i, s_i) in s.p.chunks_exact(DIM).enumerate() {
                let pulled: Vec3 = Vec3(std::array::from_fn(|axis| {
                    s_i.iter().enumerate().map(|(j, p)| p * point.inverse[(axis, j)]).sum::<f64>() * s.volume
                }));
                for (n, out) in out.iter_mut().enumerate().take(count) {
                    let (g, axis) = (point.modes[n / DIM], n % DIM);
                    out[i] += if n / DIM == VOLUME { pulled * g[axis] } else { g * pulled[axis] };
                }
            }
        }
        out
    }

    /// Derivative of the forces on the nodes along a motion of the amplitudes over which the stresses of the points change so, with its
    /// `second` derivatives, or of the forces on those along the nodes.
    #[inline(always)]
    fn coupling<S: Simd, const D: usize>(
        &self,
        simd: S,
        stresses: &[Stress<D>; POINTS],
        changes: &[[f64; D]; POINTS],
        second: &[Vec3; DIM],
    ) -> Nodal<DIM, N> {
        let mut out = [[0.0; N]; DIM];
        for ((point, s), change) in self.points[..self.count].iter().zip(stresses).zip(changes) {
            add_forces_by(simd, &point.rows, (change, s.volume), &mut out);
        }
        for (out, second) in out.iter_mut().zip(second) {
            for (mean, by) in self.mean.iter().zip(second.0) {
                add_multiple(simd, by, mean, out);
            }
        }
        out
    }

    /// The same along amplitude `n`, unknown by unknown.
    #[inline(always)]
    fn coupled<S: Simd, const D: usize>(
        &self,
        simd: S,
        stresses: &[Stress<D>; POINTS],
        (changes, n): (&[AlongAmplitudes<D>; POINTS], usize),
        second: &[Vec3; DIM],
    ) -> [f64; UNKNOWNS] {
        let changes = changes.each_ref().map(|changes| changes.map(|change| change[n]));
        let (nodal, mut out) = (self.coupling(simd, stresses, &changes, second), [0.0; UNKNOWNS]);
        for (i, nodal) in nodal.iter().enumerate() {
            out[i..].iter_mut().step_by(DIM).zip(nodal).for_each(|(out, nodal)| *out = *nodal);
        }
        out
    }
}

/// Writes the forces on the nodes with the amplitudes in equilibrium, and the tangent without them where it is wanted.
struct Condense<'a, const DIM: usize, const D: usize, const N: usize> {
    cell: &'a ModeCell<DIM, N>,
    stresses: &'a [Stress<D>; POINTS],
    own: &'a Own<D>,
    force: Nodal<DIM, N>,
    symmetric: bool,
    local: &'a mut Local,
}

impl<const DIM: usize, const D: usize, const N: usize> WithSimd for Condense<'_, DIM, D, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { cell, stresses, own, force, symmetric, local } = self;
        let (count, length, step) = (own.count, local.u.len(), own.step());
        let second = cell.second(stresses, count);
        let mut along = [[0.0; D]; POINTS];
        for ((change, s), along) in along.iter_mut().zip(stresses).zip(&own.along) {
            let mut f = [0.0; D];
            for (f, along) in f.iter_mut().zip(along) {
                *f = dot(simd, along, &step);
            }
            *change = s.tangent.map(|row| row.iter().zip(&f).map(|(entry, f)| entry * f).sum());
        }
        let bent = std::array::from_fn(|i| {
            second.iter().zip(&step).fold(Vec3::zero(), |sum, (second, step)| sum + second[i] * *step)
        });
        let last = cell.coupling(simd, stresses, &along, &bent);
        for (r, out) in local.force.iter_mut().enumerate() {
            *out = force[r % DIM][r / DIM] - last[r % DIM][r / DIM];
        }
        if !local.wants_tangent {
            return;
        }
        let mut tangent = Tangent::<DIM, N>::zero(length / DIM, symmetric);
        for (point, s) in cell.points[..cell.count].iter().zip(stresses) {
            tangent.add(&point.rows, &s.tangent, s.volume);
        }
        tangent.write(length, &mut local.tangent);
        let (mut columns, mut rows) = ([[0.0; UNKNOWNS]; AMPLITUDES], [[0.0; UNKNOWNS]; AMPLITUDES]);
        let mut changes = None;
        if !symmetric {
            let changes = changes.insert([[[0.0; AMPLITUDES]; D]; POINTS]);
            for ((changes, s), along) in changes.iter_mut().zip(stresses).zip(&own.along) {
                s.along(simd, along, changes);
            }
        }
        for n in 0..count {
            rows[n] = cell.coupled(simd, stresses, (&own.across, n), &second[n]);
            columns[n] = match &changes {
                Some(changes) => cell.coupled(simd, stresses, (changes, n), &second[n]),
                None => rows[n],
            };
        }
        let mut follows = [[0.0; UNKNOWNS]; AMPLITUDES];
        for (follows, inverse) in follows.iter_mut().zip(&own.inverse).take(count) {
            for (by, row) in inverse.iter().zip(&rows).take(count) {
                add_multiple(simd, *by, row, follows);
            }
        }
        for (r, out) in local.tangent.chunks_exact_mut(length).enumerate() {
            let mut all = [0.0; UNKNOWNS];
            for (column, follows) in columns.iter().zip(&follows).take(count) {
                add_multiple(simd, column[r], follows, &mut all);
            }
            out.iter_mut().zip(all).for_each(|(out, all)| *out -= all);
        }
        if symmetric {
            (0..length).for_each(|r| {
                (0..r).for_each(|c| local.tangent[r * length + c] = local.tangent[c * length + r]);
            });
        }
    }
}

/// The equations of the amplitudes of a cell at given displacements of its nodes.
struct Own<const D: usize> {
    /// Derivatives of the deformation of each point along each of them, and what makes the work on any deformation of the change of
    /// stress over such a one.
    along: [AlongAmplitudes<D>; POINTS],
    across: [AlongAmplitudes<D>; POINTS],
    /// Derivatives of the forces on them, and the inverse.
    stiffness: [[f64; AMPLITUDES]; AMPLITUDES],
    inverse: [[f64; AMPLITUDES]; AMPLITUDES],
    force: [f64; AMPLITUDES],
    count: usize,
}

/// Sums these equations over the points.
struct OwnSums<'a, const DIM: usize, const D: usize, const N: usize> {
    cell: &'a ModeCell<DIM, N>,
    stresses: &'a [Stress<D>; POINTS],
    own: &'a mut Own<D>,
}

impl<const DIM: usize, const D: usize, const N: usize> WithSimd for OwnSums<'_, DIM, D, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { cell, stresses, own } = self;
        (own.stiffness, own.force) = ([[0.0; AMPLITUDES]; AMPLITUDES], [0.0; AMPLITUDES]);
        for (number, (point, s)) in cell.points[..cell.count].iter().zip(stresses).enumerate() {
            let (along, across) = (&mut own.along[number], &mut own.across[number]);
            *across = [[0.0; AMPLITUDES]; D];
            cell.along(point, own.count, along);
            s.across(simd, along, across);
            for ((along, across), p) in along.iter().zip(&*across).zip(&s.p) {
                add_multiple(simd, s.volume * p, along, &mut own.force);
                for (stiffness, across) in own.stiffness.iter_mut().zip(across).take(own.count) {
                    add_multiple(simd, s.volume * across, along, stiffness);
                }
            }
        }
    }
}

impl<const D: usize> Own<D> {
    /// Of so many amplitudes.
    fn new(count: usize) -> Self {
        let (none, no_change) = ([[0.0; AMPLITUDES]; AMPLITUDES], [[[0.0; AMPLITUDES]; D]; POINTS]);
        Self { along: no_change, across: no_change, stiffness: none, inverse: none, force: [0.0; AMPLITUDES], count }
    }

    /// Inverts the stiffness; says no where there is none.
    fn solve(&mut self) -> bool {
        invert(&mut self.stiffness[..self.count], &mut self.inverse[..self.count], 0.0)
            && self.step().iter().all(|step| step.is_finite())
    }

    /// The inverse times the forces.
    fn step(&self) -> [f64; AMPLITUDES] {
        std::array::from_fn(|n| self.inverse[n].iter().zip(&self.force).map(|(by, force)| by * force).sum())
    }
}
