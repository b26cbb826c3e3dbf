//! Elimination of constrained unknowns: `u_i = sum_j c_ij q_j + g_i`, with `q` the free ones.
//!
//! A prescribed displacement is a row without terms; an inclined support `n . u = g` makes the component along the
//! largest entry of `n` depend on the others. Rows depend on free unknowns only.

/// How one unknown follows from the free ones.
#[derive(Debug, Clone, PartialEq)]
pub enum Row {
    /// It is free, with this number among the free ones.
    Free(usize),
    /// It is prescribed.
    Fixed,
    /// It is a combination of free unknowns (number among the free ones, coefficient) plus a prescribed part.
    Combined(Vec<(usize, f64)>),
}

/// The rows of all unknowns during one step.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraints {
    rows: Vec<Row>,
    free: Vec<usize>,
    /// Unknowns that follow others by equations, with what they follow, prescribed ones included.
    tied: Vec<Tied>,
}

/// An unknown and those that it follows, each with its coefficient.
pub type Tied = (usize, Vec<(usize, f64)>);

impl Constraints {
    /// From what is prescribed: `fixed` unknowns, and combinations `(unknown, [(other unknown, coefficient)])`. A
    /// combination's fixed partners belong to its prescribed part.
    pub fn new(count: usize, fixed: &[usize], combined: &[(usize, Vec<(usize, f64)>)]) -> Self {
        let mut rows = vec![Row::Free(0); count];
        for &dof in fixed {
            rows[dof] = Row::Fixed;
        }
        for (dof, _) in combined {
            rows[*dof] = Row::Combined(Vec::new());
        }
        let mut free = Vec::new();
        for (dof, row) in rows.iter_mut().enumerate() {
            if let Row::Free(number) = row {
                *number = free.len();
                free.push(dof);
            }
        }
        for (dof, terms) in combined {
            let number = |other: &usize| if let Row::Free(number) = rows[*other] { Some(number) } else { None };
            let terms = terms.iter().filter_map(|(other, c)| Some((number(other)?, *c))).collect();
            rows[*dof] = Row::Combined(terms);
        }
        Self { rows, free, tied: Vec::new() }
    }

    /// The same, some of whose combinations are equations: what holds their unknowns is borne by those that they follow.
    pub fn tied(self, tied: Vec<Tied>) -> Self {
        Self { tied, ..self }
    }

    /// Whether an unknown follows others by an equation.
    pub fn is_tied(&self, dof: usize) -> bool {
        self.tied.iter().any(|(tied, _)| *tied == dof)
    }

    /// Moves forces on unknowns that follow others by equations to those that they follow.
    pub fn carry(&self, forces: &mut [f64]) {
        for (dof, others) in &self.tied {
            let force = std::mem::take(&mut forces[*dof]);
            others.iter().for_each(|&(other, c)| forces[other] += c * force);
        }
    }

    /// Number of all unknowns.
    pub fn count(&self) -> usize {
        self.rows.len()
    }
    /// Number of free unknowns.
    pub fn free_count(&self) -> usize {
        self.free.len()
    }
    /// The free unknowns, in order.
    pub fn free(&self) -> &[usize] {
        &self.free
    }
    /// The row of an unknown.
    pub fn row(&self, dof: usize) -> &Row {
        &self.rows[dof]
    }
    /// The free unknowns that an unknown follows, with their coefficients.
    pub fn followed(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (free, combined): (Option<usize>, &[_]) = match &self.rows[dof] {
            Row::Free(i) => (Some(*i), &[]),
            Row::Fixed => (None, &[]),
            Row::Combined(terms) => (None, terms),
        };
        free.map(|i| (i, 1.0)).into_iter().chain(combined.iter().copied())
    }
    /// Adds the homogeneous part of a change `dq` of the free unknowns to `du`.
    pub fn expand(&self, dq: &[f64], du: &mut [f64]) {
        for (row, du) in self.rows.iter().zip(du) {
            match row {
                Row::Free(i) => *du += dq[*i],
                Row::Fixed => {}
                Row::Combined(terms) => *du += terms.iter().map(|&(i, c)| c * dq[i]).sum::<f64>(),
            }
        }
    }
    /// Gathers forces on all unknowns into forces on the free ones (the transpose of [`expand`](Self::expand)).
    pub fn gather(&self, full: &[f64], reduced: &mut [f64]) {
        reduced.fill(0.0);
        for (row, &force) in self.rows.iter().zip(full) {
            match row {
                Row::Free(i) => reduced[*i] += force,
                Row::Fixed => {}
                Row::Combined(terms) => terms.iter().for_each(|&(i, c)| reduced[i] += c * force),
            }
        }
    }
}
