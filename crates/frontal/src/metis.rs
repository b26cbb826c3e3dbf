//! Nested dissection by METIS (Karypis & Kumar, SIAM J. Sci. Comput. 20, 1998): the one place with foreign code.
#![allow(unsafe_code)]

use crate::error::FrontalError;
use crate::graph::Graph;
use metis_sys as sys;
use std::sync::{Mutex, PoisonError};

/// METIS draws from the C library's `rand`, whose state the whole process shares: one ordering at a time, or the seed
/// would not fix the result.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Elimination order of the vertices; a pure function of the graph.
///
/// # Errors
/// [`FrontalError::TooLarge`] past 32-bit indices, [`FrontalError::OrderingFailed`] if METIS says so.
pub(crate) fn nested_dissection(graph: &Graph) -> Result<Vec<u32>, FrontalError> {
    let n = graph.len();
    if graph.neighbours.is_empty() {
        return Ok((0..n as u32).collect());
    }
    let index = |k: usize| sys::idx_t::try_from(k).map_err(|_| FrontalError::TooLarge);
    let mut vertices = index(n)?;
    let mut starts = graph.starts.iter().map(|&start| index(start)).collect::<Result<Vec<_>, _>>()?;
    let mut neighbours = graph.neighbours.iter().map(|&v| index(v as usize)).collect::<Result<Vec<_>, _>>()?;
    let mut weights = graph.weights.iter().map(|&w| w as sys::idx_t).collect::<Vec<_>>();
    let mut options = options();
    let (mut order, mut position) = (vec![0; n], vec![0; n]);

    let guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    // SAFETY: `starts` has n + 1 entries, the last of which is the length of `neighbours`; all neighbours are below n
    // and other than the vertex itself (`Graph`); `options` has METIS_NOPTIONS entries; the results have n. METIS
    // keeps no pointer.
    let status = unsafe {
        sys::METIS_NodeND(
            &mut vertices,
            starts.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            weights.as_mut_ptr(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            position.as_mut_ptr(),
        )
    };
    drop(guard);
    if status != sys::rstatus_et_METIS_OK {
        return Err(FrontalError::OrderingFailed);
    }
    Ok(order.into_iter().map(|v| v as u32).collect())
}

/// Defaults (-1) but for the seed and the numbering from zero.
fn options() -> [sys::idx_t; sys::METIS_NOPTIONS as usize] {
    let mut options = [-1; sys::METIS_NOPTIONS as usize];
    options[sys::moptions_et_METIS_OPTION_SEED as usize] = 1;
    options[sys::moptions_et_METIS_OPTION_NUMBERING as usize] = 0;
    options
}
