//! Orderings in pure Rust, by the crates `feral-metis` and `feral-amd`.

use crate::error::FrontalError;
use crate::graph::Graph;
use feral_amd::{CscPattern, OrderingError};

/// Approximate minimum degree (Amestoy, Davis & Duff, SIAM J. Matrix Anal. Appl. 17, 1996).
///
/// # Errors
/// [`FrontalError::TooLarge`] past 32-bit indices, [`FrontalError::OrderingFailed`] if the crate says so.
pub(crate) fn minimum_degree(graph: &Graph) -> Result<Vec<u32>, FrontalError> {
    order(graph, feral_amd::amd_order)
}

/// Nested dissection.
///
/// # Errors
/// Those of [`minimum_degree`].
#[cfg(not(feature = "metis"))]
pub(crate) fn nested_dissection(graph: &Graph) -> Result<Vec<u32>, FrontalError> {
    order(graph, feral_metis::metis_order)
}

fn order(
    graph: &Graph,
    by: impl Fn(&CscPattern<'_>) -> Result<Vec<i32>, OrderingError>,
) -> Result<Vec<u32>, FrontalError> {
    let n = graph.len();
    if graph.neighbours.is_empty() {
        return Ok((0..n as u32).collect());
    }
    let index = |k: usize| i32::try_from(k).map_err(|_| FrontalError::TooLarge);
    let starts = graph.starts.iter().map(|&start| index(start)).collect::<Result<Vec<_>, _>>()?;
    let mut neighbours = graph.neighbours.iter().map(|&v| index(v as usize)).collect::<Result<Vec<_>, _>>()?;
    for range in graph.starts.windows(2) {
        neighbours[range[0]..range[1]].sort_unstable();
    }
    let pattern = CscPattern::new(n, &starts, &neighbours).ok_or(FrontalError::OrderingFailed)?;
    let order = by(&pattern).map_err(|_| FrontalError::OrderingFailed)?;
    Ok(order.into_iter().map(|v| v as u32).collect())
}
