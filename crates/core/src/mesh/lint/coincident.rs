//! Nodes that lie at one place: closer to each other than a small share of the edges around them.
//!
//! Nodes are sorted along one axis and cut into runs wherever a gap is wider than the tolerance, each run again along
//! the next axis, until no axis cuts any more; the pairs of what is left are compared one by one.

use crate::mesh::Mesh;

/// Nodes closer than this share of the edges around them are at one place.
const CLOSE: f64 = 1e-9;

/// For each node the first node at the same place, itself where it is alone or not used by any cell.
pub(super) fn representatives(mesh: &Mesh) -> Vec<usize> {
    let edges = local_edges(mesh);
    let used = |&node: &usize| edges[node] > 0.0 && mesh.points[node].is_finite();
    let nodes: Vec<usize> = (0..mesh.points.len()).filter(used).collect();
    let widest = CLOSE * edges.iter().copied().filter(|edge| edge.is_finite()).fold(0.0, f64::max);
    let mut first: Vec<usize> = (0..mesh.points.len()).collect();
    for run in runs(mesh, nodes, widest) {
        join(mesh, run, &edges, &mut first);
    }
    first
}

/// The shortest of the longest edges of the cells around each node; zero for unused nodes.
fn local_edges(mesh: &Mesh) -> Vec<f64> {
    let mut edges = vec![0.0; mesh.points.len()];
    for cell in 0..mesh.cell_count() {
        let edge = mesh.longest_edge(cell);
        for &node in mesh.cell(cell).nodes {
            edges[node] = if edges[node] == 0.0 { edge } else { edge.min(edges[node]) };
        }
    }
    edges
}

/// Sets of nodes with no gap along any axis, each of at least two.
fn runs(mesh: &Mesh, nodes: Vec<usize>, gap: f64) -> Vec<Vec<usize>> {
    let (mut open, mut done) = (vec![(nodes, 0, 0)], Vec::new());
    while let Some((mut run, axis, uncut)) = open.pop() {
        if run.len() < 2 {
            continue;
        }
        if uncut == 3 {
            done.push(run);
            continue;
        }
        let place = |&node: &usize| mesh.points[node][axis];
        run.sort_unstable_by(|a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
        let parts: Vec<Vec<usize>> = run.chunk_by(|a, b| place(b) - place(a) <= gap).map(<[_]>::to_vec).collect();
        let uncut = if parts.len() == 1 { uncut + 1 } else { 1 };
        open.extend(parts.into_iter().map(|part| (part, (axis + 1) % 3, uncut)));
    }
    done
}

/// Compares the nodes of a run with the representatives found so far in it.
fn join(mesh: &Mesh, mut run: Vec<usize>, edges: &[f64], first: &mut [usize]) {
    run.sort_unstable();
    let mut heads: Vec<usize> = Vec::new();
    for node in run {
        let close = |&&head: &&usize| {
            let distance = (mesh.points[node] - mesh.points[head]).norm();
            distance <= CLOSE * edges[node].min(edges[head])
        };
        match heads.iter().find(close) {
            Some(&head) => first[node] = head,
            None => heads.push(node),
        }
    }
}
