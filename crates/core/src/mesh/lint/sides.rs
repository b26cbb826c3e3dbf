//! Neighbours: cracks and touching bodies, nodes that coincide, faces that do not fit or are shared too often.

use super::coincident::representatives;
use super::{LintFinding, LintKind, LintSeverity, hanging, words};
use crate::mesh::{Faces, Mesh, Side};
use crate::tensor::DisjointSets;

pub(super) fn check(mesh: &Mesh) -> Vec<LintFinding> {
    let first = representatives(mesh);
    let faces = Faces::of(mesh, 0..mesh.cell_count());
    let pairs = open_pairs(mesh, &faces, &first);
    let bodies = Bodies::of(mesh);
    let (cracks, touching): (Vec<_>, Vec<_>) = pairs.iter().partition(|[one, other]| bodies.same(one.cell, other.cell));
    let mut findings: Vec<LintFinding> = [crack(mesh, cracks), touch(mesh, touching)].into_iter().flatten().collect();
    findings.extend(duplicates(mesh, &first, &pairs, &bodies));
    findings.extend(misfits(mesh, &faces));
    findings
}

/// Nodes that hang, of a mesh whose cells are sound.
pub(super) fn hanging(mesh: &Mesh) -> Option<LintFinding> {
    let bodies = Bodies::of(mesh);
    hanging::check(mesh, &Faces::of(mesh, 0..mesh.cell_count()), |one, other| bodies.joined(one, other))
}

/// Outer faces that would be one if coincident nodes were joined.
fn open_pairs(mesh: &Mesh, faces: &Faces, first: &[usize]) -> Vec<[Side; 2]> {
    let coincide = |&side: &Side| mesh.side(side).1.any(|node| first[node] != node);
    if first.iter().enumerate().all(|(node, &head)| node == head) {
        return vec![];
    }
    let outer: std::collections::HashSet<Side> = faces.outer().into_iter().collect();
    let joined = Faces::renamed(mesh, 0..mesh.cell_count(), |node| first[node]);
    let open = |run: &[(_, Side)]| match run {
        [(_, one), (_, other)] if outer.contains(one) && outer.contains(other) => Some([*one, *other]),
        _ => None,
    };
    let mut pairs: Vec<[Side; 2]> = joined.runs().filter_map(open).collect();
    pairs.retain(|pair| pair.iter().any(coincide));
    pairs.sort_unstable();
    pairs
}

/// The nodes of pairs of faces, and their cells; both sorted, without repeats.
fn members(mesh: &Mesh, pairs: &[&[Side; 2]]) -> (Vec<usize>, Vec<usize>) {
    let sides = || pairs.iter().copied().flatten().copied();
    let mut cells: Vec<usize> = sides().map(|side| side.cell).collect();
    let mut nodes: Vec<usize> = sides().flat_map(|side| mesh.side(side).1).collect();
    [&mut cells, &mut nodes].into_iter().for_each(|list| {
        list.sort_unstable();
        list.dedup();
    });
    (cells, nodes)
}

fn crack(mesh: &Mesh, pairs: Vec<&[Side; 2]>) -> Option<LintFinding> {
    let (cells, nodes) = members(mesh, &pairs);
    let text = format!(
        "a crack runs through a body: {} lie on one another but are not joined, at {}; merge the nodes unless the \
         crack is meant",
        words::count(pairs.len(), "pair") + " of faces",
        words::nodes(mesh, &nodes)
    );
    let finding = LintFinding { kind: LintKind::Crack, severity: LintSeverity::Warning, cells, nodes, text };
    (!pairs.is_empty()).then_some(finding)
}

fn touch(mesh: &Mesh, pairs: Vec<&[Side; 2]>) -> Option<LintFinding> {
    let (cells, nodes) = members(mesh, &pairs);
    let text = format!(
        "separate bodies touch with {} on one another, at {}; only contact can hold them apart",
        words::count(pairs.len(), "pair") + " of faces",
        words::nodes(mesh, &nodes)
    );
    let finding = LintFinding { kind: LintKind::Touching, severity: LintSeverity::Note, cells, nodes, text };
    (!pairs.is_empty()).then_some(finding)
}

/// Coincident nodes that no pair of faces explains.
fn duplicates(mesh: &Mesh, first: &[usize], pairs: &[[Side; 2]], bodies: &Bodies) -> Vec<LintFinding> {
    let explained = members(mesh, &pairs.iter().collect::<Vec<_>>()).1;
    let free = |node: &usize| first[*node] != *node && explained.binary_search(node).is_err();
    let adjacency = mesh.adjacency();
    let cell = |node: usize| adjacency.cells(node)[0];
    let (inside, between): (Vec<usize>, Vec<usize>) =
        (0..first.len()).filter(free).partition(|&node| bodies.same(cell(node), cell(first[node])));
    let finding = |nodes: Vec<usize>, severity, says: &str| {
        let pair = |&node: &usize| format!("{} = {}", mesh.node_number(first[node]), mesh.node_number(node));
        let text = format!("{} at the same place {says}", words::listed("node", nodes.iter().map(pair)));
        let nodes: Vec<usize> = nodes.iter().flat_map(|&node| [first[node], node]).collect();
        (!nodes.is_empty()).then_some(LintFinding { kind: LintKind::Duplicate, severity, cells: vec![], nodes, text })
    };
    let merge = "in one body; merge them unless they are meant to part";
    let apart = "in separate bodies; only contact can hold them apart";
    [finding(inside, LintSeverity::Warning, merge), finding(between, LintSeverity::Note, apart)]
        .into_iter()
        .flatten()
        .collect()
}

/// Faces that share corners and yet do not join: other mid-side nodes, the same cell twice, more than two cells.
fn misfits(mesh: &Mesh, faces: &Faces) -> Vec<LintFinding> {
    let (mut mismatched, mut overlap, mut repeated) = (vec![], vec![], vec![]);
    for run in faces.runs().filter(|run| run.len() > 1) {
        let cells = || run.iter().map(|entry| entry.1.cell);
        let twice = |&cell: &usize| cells().filter(|&other| corners(mesh, other) == corners(mesh, cell)).count() > 1;
        match run.len() {
            _ if cells().any(|cell| twice(&cell)) => repeated.extend(cells().filter(twice)),
            2 if nodes(mesh, run[0].1) != nodes(mesh, run[1].1) => mismatched.extend(cells()),
            2 => {}
            _ => overlap.extend(cells()),
        }
    }
    [&mut mismatched, &mut overlap, &mut repeated].into_iter().for_each(|cells| {
        cells.sort_unstable();
        cells.dedup();
    });
    let finding = |kind, cells, says: &str| LintFinding::of_cells(kind, LintSeverity::Error, mesh, cells, says);
    let gap =
        "sharing the corners of a face but not its mid-side nodes: the face would gape; mesh both with one degree";
    let twice = "with the same corners as another cell: the mesh is there twice; remove one";
    [
        finding(LintKind::Mismatched, mismatched, gap),
        finding(LintKind::RepeatedCell, repeated, twice),
        finding(LintKind::Overlap, overlap, "sharing one face with more than one other cell: the mesh overlaps itself"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn nodes(mesh: &Mesh, side: Side) -> Vec<usize> {
    let mut nodes: Vec<usize> = mesh.side(side).1.collect();
    nodes.sort_unstable();
    nodes
}

/// The sorted corners of a cell; unused places hold `usize::MAX`.
fn corners(mesh: &Mesh, cell: usize) -> [usize; 8] {
    let view = mesh.cell(cell);
    let mut corners = [usize::MAX; 8];
    corners.iter_mut().zip(&view.nodes[..view.kind.linear.nodes.len()]).for_each(|(place, &node)| *place = node);
    corners.sort_unstable();
    corners
}

/// Which cells belong to one body: joined by nodes, or members of exactly the same groups, so that no body of the deck
/// can hold one without the other.
struct Bodies<'a> {
    mesh: &'a Mesh,
    sets: DisjointSets,
}

impl<'a> Bodies<'a> {
    fn of(mesh: &'a Mesh) -> Self {
        let mut sets = DisjointSets::new(mesh.cell_count());
        let adjacency = mesh.adjacency();
        for node in 0..mesh.points.len() {
            adjacency.cells(node).windows(2).for_each(|pair| sets.join(pair[0], pair[1]));
        }
        Self { mesh, sets }
    }

    /// Whether nodes join them, over whatever cells.
    fn joined(&self, one: usize, other: usize) -> bool {
        self.sets.root(one) == self.sets.root(other)
    }

    fn same(&self, one: usize, other: usize) -> bool {
        let groups = || self.mesh.groups.values().map(|group| &group.cells);
        let holds = |cells: &Vec<usize>, cell: usize| cells.binary_search(&cell).is_ok();
        self.joined(one, other)
            || groups().all(|cells| holds(cells, one) == holds(cells, other)) && groups().any(|cells| holds(cells, one))
    }
}
