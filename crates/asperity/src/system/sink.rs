//! Adding stencils up: forces, matrix, and the places of their entries in it.

use super::chunk::Chunk;
use super::{Constraints, Csr, Evaluation, Role, Row, Stencil, Stencils, Tangent, Trial};

/// A pair of unknowns that is not in the matrix because one is prescribed.
const NOWHERE: u32 = u32::MAX;
/// Marks a stencil that touches combined unknowns and is scattered the long way.
const LONG_WAY: u32 = u32::MAX - 1;

/// The pattern lacks an entry that a stencil needs.
pub struct Miss;

/// Where the chunks of one term are added up.
pub struct Sink<'a> {
    out: &'a mut Evaluation,
    term: usize,
    constraints: &'a Constraints,
    pattern: &'a Csr,
    trial: &'a Trial<'a>,
    role: Role,
    places: Option<&'a [u32]>,
}

impl<'a> Sink<'a> {
    /// A sink for term number `term`; `places` are those of the stencils to come, where they are known.
    pub fn new(
        (out, term): (&'a mut Evaluation, usize),
        (constraints, pattern): (&'a Constraints, &'a Csr),
        (trial, role): (&'a Trial<'a>, Role),
        places: Option<&'a [u32]>,
    ) -> Self {
        Self { out, term, constraints, pattern, trial, role, places }
    }

    /// Adds the results of a chunk of stencils; the sink's order is that of the calls.
    pub fn scatter(&mut self, chunk: &Chunk, list: &[Stencil], stencils: &Stencils) -> Result<(), Miss> {
        let (mut force, mut entry, mut result) = (0, 0, Ok(()));
        for stencil in list {
            let (n, dofs) = (stencil.len, stencils.dofs(stencil));
            self.add_forces(dofs, &chunk.forces[force..force + n]);
            force += n;
            if self.trial.tangent != Tangent::None {
                result = self.add_matrix(dofs, &chunk.tangents[entry..entry + n * n]).and(result);
                entry += n * n;
            }
        }
        self.out.branches[self.term].extend_from_slice(&chunk.branches);
        let energies = &mut self.out.energies[self.term];
        energies.stored += chunk.energies.stored;
        energies.dissipated += chunk.energies.dissipated;
        energies.supplied += chunk.energies.supplied;
        energies.residue += chunk.energies.residue;
        result
    }

    fn add_matrix(&mut self, dofs: &[usize], matrix: &[f64]) -> Result<(), Miss> {
        let sign = if self.role == Role::Load { -1.0 } else { 1.0 };
        if let Some(missing) = self.trial.missing {
            self.carry(dofs, matrix, missing, sign);
        }
        let Some(places) = self.places else { return self.add_long_way(dofs, matrix, sign) };
        let (here, rest) = places.split_at(matrix.len());
        self.places = Some(rest);
        if here.first() == Some(&LONG_WAY) {
            return self.add_long_way(dofs, matrix, sign);
        }
        let values = self.out.values.as_mut_slice();
        for (&place, &value) in here.iter().zip(matrix) {
            if place != NOWHERE {
                values[place as usize] += sign * value;
            }
        }
        Ok(())
    }

    fn add_forces(&mut self, dofs: &[usize], forces: &[f64]) {
        let Evaluation { load, internal, magnitude, .. } = &mut *self.out;
        let sum = if self.role == Role::Load { load } else { internal }.as_mut_slice();
        for (&dof, &force) in dofs.iter().zip(forces) {
            sum[dof] += force;
            magnitude[dof] += force.abs();
        }
    }

    fn carry(&mut self, dofs: &[usize], matrix: &[f64], missing: &[f64], sign: f64) {
        for (row, &dof) in matrix.chunks_exact(dofs.len()).zip(dofs) {
            let force: f64 = row.iter().zip(dofs).map(|(k, &other)| k * missing[other]).sum();
            self.out.carried[dof] += sign * force;
        }
    }

    fn add_long_way(&mut self, dofs: &[usize], matrix: &[f64], sign: f64) -> Result<(), Miss> {
        for (row, &dof) in matrix.chunks_exact(dofs.len().max(1)).zip(dofs) {
            for (&value, &other) in row.iter().zip(dofs) {
                if value == 0.0 {
                    continue;
                }
                for &(i, ci) in terms(self.constraints.row(dof)).as_slice() {
                    for &(j, cj) in terms(self.constraints.row(other)).as_slice() {
                        let place = self.pattern.position(i, j).ok_or(Miss)?;
                        self.out.values[place] += sign * ci * cj * value;
                    }
                }
            }
        }
        Ok(())
    }
}

/// The free unknowns a row depends on, without allocation for the usual ones.
enum RowTerms<'a> {
    One([(usize, f64); 1]),
    Many(&'a [(usize, f64)]),
}

impl RowTerms<'_> {
    fn as_slice(&self) -> &[(usize, f64)] {
        match self {
            Self::One(one) => one,
            Self::Many(many) => many,
        }
    }
}

fn terms(row: &Row) -> RowTerms<'_> {
    match row {
        Row::Free(i) => RowTerms::One([(*i, 1.0)]),
        Row::Fixed => RowTerms::Many(&[]),
        Row::Combined(terms) => RowTerms::Many(terms),
    }
}

/// Place in the matrix of every entry of every stencil.
pub fn places(pattern: &Csr, constraints: &Constraints, stencils: &Stencils) -> Vec<u32> {
    let mut places = Vec::with_capacity(stencils.list.iter().map(|s| s.len * s.len).sum());
    for stencil in &stencils.list {
        let dofs = stencils.dofs(stencil);
        if dofs.iter().any(|&dof| matches!(constraints.row(dof), Row::Combined(_))) {
            places.resize(places.len() + dofs.len() * dofs.len(), LONG_WAY);
            continue;
        }
        // The unknowns of a node have like rows and stand next to each other in all of them.
        for &row in dofs {
            let mut next = 0;
            places.extend(dofs.iter().map(|&column| match (constraints.row(row), constraints.row(column)) {
                (Row::Free(i), Row::Free(j)) => {
                    let place = pattern.position_near(*i, *j, next);
                    next = place.map_or(0, |place| place + 1 - pattern.starts[*i]);
                    place.map_or(NOWHERE, |place| place as u32)
                }
                _ => NOWHERE,
            }));
        }
    }
    places
}
