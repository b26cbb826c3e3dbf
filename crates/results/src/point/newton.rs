//! The strains that belong to prescribed stresses.

use super::probe::deformation;
use asperity_core::Failure;
use asperity_core::material::{Directions, Gradient, Lapse, Material};
use asperity_core::tensor::Tensor2;
use frontal::Full;

/// Largest difference from a prescribed stress, as a ratio to the largest stress.
const TOLERANCE: f64 = 1e-11;
/// Rounding of a stress, as a ratio to the stiffness of the undeformed solid.
const ROUNDING: f64 = 1e-15;
/// A stiffness that is none, as a ratio to that of the undeformed solid.
const NOTHING: f64 = 1e-13;
/// Difference of two stresses or strains that are the same, as a ratio to the largest.
const ALIKE: f64 = 1e-9;
const LIMIT: usize = 50;

/// One increment: where it begins, and what is prescribed at its end.
pub(super) struct Increment<'a> {
    pub material: &'a dyn Material,
    /// State of the law at the beginning.
    pub old: &'a [f64],
    /// Strains at the beginning.
    pub strain: [f64; 6],
    /// Prescribed stresses; where there is none the strain is prescribed.
    pub stress: [Option<f64>; 6],
    /// Its time and temperature.
    pub lapse: Lapse,
    /// Stiffness of the undeformed solid, which says what is rounding.
    pub modulus: f64,
}

/// A trial end of an increment.
struct Trial {
    strain: [f64; 6],
    new: Vec<f64>,
    gradient: Gradient,
    error: f64,
}

impl Increment<'_> {
    /// Strains and state at the end, from a first guess of the strains that has the prescribed ones.
    pub fn solve(&self, guess: [f64; 6]) -> Result<([f64; 6], Vec<f64>), Failure> {
        let mut trial = self.trial(guess)?;
        for _ in 0..LIMIT {
            if trial.error <= 1.0 {
                return Ok((trial.strain, trial.new));
            }
            let change = self.change(&trial).ok_or_else(|| Failure::new("the stress has no stiffness left"))?;
            trial = self.shorten(&trial, &change)?;
        }
        Err(Failure::new("the prescribed stress is not reached"))
    }

    /// The first of the shortened changes that lowers the error, or the shortest.
    fn shorten(&self, trial: &Trial, change: &[f64; 6]) -> Result<Trial, Failure> {
        let mut last = Err(Failure::new("the prescribed stress is not reached"));
        for halvings in 0..8 {
            let part = 0.5_f64.powi(halvings);
            last = self.trial(std::array::from_fn(|i| trial.strain[i] + part * change[i]));
            if last.as_ref().is_ok_and(|next| next.error < trial.error) {
                break;
            }
        }
        last
    }

    fn trial(&self, strain: [f64; 6]) -> Result<Trial, Failure> {
        let mut new = vec![0.0; self.old.len()];
        let f = deformation(&strain) * deformation(&self.strain).inverse();
        let gradient = self.material.update_with_gradient(&f, self.lapse, self.old, &mut new, Directions::Space)?;
        if !new.iter().chain(gradient.iter().flatten()).all(|x| x.is_finite()) {
            return Err(Failure::new("the stress is not finite"));
        }
        let miss = (0..6).filter_map(|i| self.stress[i].map(|wanted| (new[i] - wanted).abs())).fold(0.0, f64::max);
        let largest = new[..6].iter().chain(self.stress.iter().flatten()).fold(0.0, |m: f64, s| m.max(s.abs()));
        let scale = (TOLERANCE * largest).max(ROUNDING * self.modulus);
        Ok(Trial { strain, new, gradient, error: miss / scale })
    }

    /// Change of the strains that removes the difference to first order. Axes that bear alike, strained alike, go on alike: where
    /// principal stresses are equal a yield surface has an edge, and the tangent of one of its sides leads away from there.
    fn change(&self, trial: &Trial) -> Option<[f64; 6]> {
        let miss = |i: usize| self.stress[i].unwrap_or(0.0) - trial.new[i];
        let free = (0..6).filter(|&i| self.stress[i].is_some()).map(|j| (j, self.along(trial, j)));
        // What has no stiffness and bears what it should stays where it is, as a shear between equal principal stresses.
        let soft = |i: usize, column: &[f64; 6]| {
            miss(i).abs() <= ROUNDING * self.modulus && column.iter().all(|c| c.abs() <= NOTHING * self.modulus)
        };
        let mut groups: Vec<(Vec<usize>, [f64; 6])> = Vec::new();
        for (i, column) in free.filter(|(i, column)| !soft(*i, column)) {
            match groups.iter_mut().find(|(axes, _)| self.alike(trial, axes[0], i)) {
                Some((axes, sum)) => {
                    axes.push(i);
                    sum.iter_mut().zip(column).for_each(|(sum, c)| *sum += c);
                }
                None => groups.push((vec![i], column)),
            }
        }
        let mean = |axes: &[usize], of: &dyn Fn(usize) -> f64| -> f64 {
            axes.iter().map(|&i| of(i)).sum::<f64>() / axes.len() as f64
        };
        let row = |(axes, _): &(Vec<usize>, _)| -> Vec<f64> {
            groups.iter().map(|(_, column)| mean(axes, &|i| column[i])).collect()
        };
        let rows = groups.iter().flat_map(row).collect();
        let mut solved: Vec<f64> = groups.iter().map(|(axes, _)| mean(axes, &miss)).collect();
        Full::factorise(groups.len(), rows)?.solve(&mut solved);
        let mut change = [0.0; 6];
        for ((axes, _), x) in groups.iter().zip(solved) {
            axes.iter().for_each(|&i| change[i] = x.clamp(-0.5, 0.5));
        }
        Some(change)
    }

    /// Whether two axes should bear the same stress, and bear and are strained alike.
    fn alike(&self, trial: &Trial, i: usize, j: usize) -> bool {
        let near = |a: f64, b: f64, size: f64| (a - b).abs() <= ALIKE * size;
        let stress = trial.new[..6].iter().fold(ROUNDING * self.modulus, |m: f64, s| m.max(s.abs()));
        let strain = trial.strain.iter().fold(f64::MIN_POSITIVE, |m: f64, e| m.max(e.abs()));
        i.max(j) < 3
            && self.stress[i] == self.stress[j]
            && near(trial.new[i], trial.new[j], stress)
            && near(trial.strain[i], trial.strain[j], strain)
            && near(self.strain[i], self.strain[j], strain)
    }

    /// Derivative of the stress along one strain.
    fn along(&self, trial: &Trial, strain: usize) -> [f64; 6] {
        const PLACE: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
        let (i, j) = PLACE[strain];
        let mut slope = Tensor2::zero();
        slope[(i, j)] = if i == j { trial.strain[i].exp() } else { 1.0 };
        let f = slope * deformation(&self.strain).inverse();
        let places = Directions::Space.components();
        std::array::from_fn(|row| trial.gradient[row].iter().zip(places).map(|(c, &place)| c * f[place]).sum())
    }
}
