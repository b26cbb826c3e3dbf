//! Force per undeformed volume, of fixed direction: `F_L = b integral of N_L dV_0`.

use super::Site;
use super::dead::{DeadLoad, On, Part};
use crate::amplitude::Timeline;
use crate::mesh::cells::MAX_NODES;

/// A body force on cells, given by its components along the axes (forces per volume).
pub fn body_force(name: &str, site: &Site, cells: &[usize], components: Vec<Timeline>) -> DeadLoad {
    let part = |&cell: &usize| {
        let nodes = site.mesh.cell(cell).nodes.iter().copied();
        Part { on: On::Cell(cell), dofs: site.unknowns(nodes), shares: along_axes(&volumes(site, cell), site) }
    };
    DeadLoad::new(name, components, cells.iter().map(part).collect())
}

/// `integral of N_L dV_0` over a cell.
fn volumes(site: &Site, cell: usize) -> Vec<f64> {
    let view = site.mesh.cell(cell);
    // Plane cells have finer rules than their stiffness needs; N_L r of the axisymmetric case asks for them.
    let rule = view.kind.gauss[view.kind.degree.min(2)].unwrap_or(view.kind.full);
    let mut shares = vec![0.0; view.nodes.len()];
    for (&xi, weight) in rule.points.iter().zip(rule.weights) {
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        (view.kind.shape)(xi, &mut n, &mut dn);
        let x = view.map(&site.mesh.points, xi).0;
        let volume = view.jacobian(&site.mesh.points, xi) * site.depth(x) * weight;
        shares.iter_mut().zip(n).for_each(|(share, n)| *share += n * volume);
    }
    shares
}

/// The share of each node, for each of its unknowns in the value along that axis.
pub(super) fn along_axes(shares: &[f64], site: &Site) -> Vec<(usize, f64)> {
    let dim = site.space.dimension();
    shares.iter().flat_map(|&share| (0..dim).map(move |axis| (axis, share))).collect()
}
