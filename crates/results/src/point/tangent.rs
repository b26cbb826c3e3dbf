//! The tangent of a law against differences along a driven path.

use asperity_core::material::{Directions, Gradient, Lapse, Material};
use asperity_core::tensor::Tensor2;

/// Sizes of the differences of a component of the deformation, the smallest last.
const SIZES: [f64; 6] = [1e-4, 2e-5, 4e-6, 8e-7, 1.6e-7, 3e-8];
/// Difference of both sides, as a ratio to the tangent, beyond which a corner of the law lies between them.
const CORNER: f64 = 1e-4;
/// Difference above which a corner is looked for.
const CLOSE: f64 = 1e-7;

/// What differences say of the tangents of a path.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PointTangentCheck {
    /// Largest difference of an entry, as a ratio to the largest entry: from central differences of fourth order, of the
    /// best of several sizes.
    pub worst: f64,
    /// Time of the end of its increment.
    pub time: f64,
    /// Columns that were compared, nine an increment.
    pub columns: usize,
    /// Columns with a corner of the law between the differences, where there is no tangent.
    pub corners: usize,
}

impl PointTangentCheck {
    /// Compares the tangent of an increment by the deformation `f` from the state `old`, whose end has a time.
    pub(super) fn compare(&mut self, material: &dyn Material, (old, f, lapse): (&[f64], &Tensor2, Lapse), time: f64) {
        let mut new = old.to_vec();
        let Ok(gradient) = material.update_with_gradient(f, lapse, old, &mut new, Directions::Space) else {
            return;
        };
        let largest = gradient.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        let scale = largest.max(1e-3 * material.moduli()[0]);
        for d in 0..9 {
            let moved = |h: f64| {
                let (mut f, mut new) = (*f, old.to_vec());
                f[Directions::Space.components()[d]] += h;
                material.update(&f, lapse, old, &mut new).ok().map(|()| -> [f64; 6] { std::array::from_fn(|i| new[i]) })
            };
            let Some((error, corner)) = column(moved, &gradient, d, scale) else { continue };
            if corner && error > CLOSE {
                self.corners += 1;
                continue;
            }
            self.columns += 1;
            if error > self.worst {
                (self.worst, self.time) = (error, time);
            }
        }
    }
}

/// Error of a column, and whether a corner lies within the smallest differences; nothing where the law fails near by.
fn column(moved: impl Fn(f64) -> Option<[f64; 6]>, gradient: &Gradient, d: usize, scale: f64) -> Option<(f64, bool)> {
    let (mut best, mut corner) = (f64::INFINITY, false);
    for h in SIZES {
        let [a, b, o, c, e] = [moved(-2.0 * h)?, moved(-h)?, moved(0.0)?, moved(h)?, moved(2.0 * h)?];
        let error = |i: usize| (8.0 * (c[i] - b[i]) - (e[i] - a[i])) / (12.0 * h) - gradient[i][d];
        best = (0..6).fold(0.0, |m: f64, i| m.max(error(i).abs())).min(best);
        let sides = |i: usize| (4.0 * (c[i] + b[i]) - e[i] - a[i] - 6.0 * o[i]) / (2.0 * h);
        corner = (0..6).any(|i| sides(i).abs() > CORNER * scale);
    }
    Some((best / scale, corner))
}
