//! What rubber remembers, and the water in the pores of a soil.

use crate::form::{Form, list, number, table};
use asperity_core::declare::{Range, unit};
use asperity_core::material::{Material, Memory, Mullins, Undrained};
use std::sync::Arc;

table! {
    /// Softening of rubber by the largest deformation so far (Ogden and Roxburgh).
    pub struct MullinsKeys {
        /// Largest loss of stress is its inverse.
        r: f64 = number(unit::NONE, Range { least: Some((1.0, false)), most: None }).required(),
        /// Energy of the shape by which unloading softens, per volume.
        m: f64 = number(unit::STRESS, Range::POSITIVE).required(),
        /// Part of the largest energy that is added to `m`.
        beta: f64 = number(unit::NONE, Range::NOT_NEGATIVE).or("0.0"),
    }
}

/// A Prony series: pairs of share and relaxation time.
pub fn prony() -> impl Form<Value = Vec<Vec<f64>>> {
    list(list(number(unit::NONE, Range::POSITIVE), 2..=2), 0..=asperity_core::material::MOST_TERMS)
}

/// A law with the memory and the pore water that are said; nothing where neither is.
///
/// # Errors
/// In words, where the law takes none.
pub fn completed(
    law: Arc<dyn Material>,
    prony: &[Vec<f64>],
    mullins: Option<&MullinsKeys>,
    pore_stiffness: Option<f64>,
) -> Result<Arc<dyn Material>, String> {
    let prony: Vec<[f64; 2]> = prony.iter().filter_map(|pair| pair.as_slice().try_into().ok()).collect();
    let mullins = mullins.map(|keys| Mullins { r: keys.r, m: keys.m, beta: keys.beta });
    let law = match prony.is_empty() && mullins.is_none() {
        true => law,
        false => Arc::from(law.with_memory(&Memory { prony, mullins })?),
    };
    match pore_stiffness {
        Some(bulk) => Ok(Arc::new(Undrained::new(law, bulk)?)),
        None => Ok(law),
    }
}
