//! How fast this machine factorises.

use crate::error::FrontalError;
use crate::options::{Options, Ordering};
use crate::pattern::Pattern;
use crate::symbolic::Symbolic;
use std::time::Instant;

/// Order of the full matrix that is timed.
const ORDER: usize = 1024;
/// Times it is factorised; the fastest counts.
const TIMES: usize = 4;

/// Multiplications and additions a second in a large front, with the threads of the current rayon pool: a full matrix is
/// factorised a few times, in some tenths of a second. Divides [`Prediction::factorisation_work`](crate::Prediction).
///
/// # Errors
/// None that is known; those of the factorisation.
pub fn speed() -> Result<f64, FrontalError> {
    let starts = (0..=ORDER).map(|row| row * ORDER).collect();
    let pattern = Pattern::new(starts, (0..ORDER * ORDER).map(|at| at % ORDER).collect())?;
    let options = Options { ordering: Ordering::Given((0..ORDER).collect()), equilibrate: false, ..Options::default() };
    let symbolic = Symbolic::analyse(&pattern, &options)?;
    let value = |at: usize| if at / ORDER == at % ORDER { ORDER as f64 } else { (at as f64).sin() };
    let values: Vec<f64> = (0..ORDER * ORDER).map(value).collect();
    let mut factor = symbolic.new_factor();
    let mut fastest = f64::INFINITY;
    for _ in 0..TIMES {
        let begun = Instant::now();
        symbolic.factorise(&values, &mut factor)?;
        fastest = fastest.min(begun.elapsed().as_secs_f64());
    }
    Ok(symbolic.prediction().flops / fastest.max(f64::MIN_POSITIVE))
}
