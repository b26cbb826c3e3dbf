//! Elastic bodies as test matrices: unit cells, one clamped face, and a skew part in every element as friction and
//! follower forces give one.
#![allow(dead_code)]

use frontal::Pattern;
use std::collections::HashMap;

/// A matrix with its pattern, by nodes.
pub struct Model {
    pub name: String,
    pub pattern: Pattern,
    pub values: Vec<f64>,
}

impl Model {
    /// Lets the clamped unknowns of a block go; together with [`Model::symmetrise`] this leaves a free elastic body.
    pub fn release(&mut self, clamped_nodes: usize) {
        let (starts, columns) = (self.pattern.starts(), self.pattern.columns());
        for unknown in 0..3 * clamped_nodes {
            let at = columns[starts[unknown]..starts[unknown + 1]].partition_point(|&column| column < unknown);
            self.values[starts[unknown] + at] -= YOUNG;
        }
    }

    /// Takes the skew part away.
    pub fn symmetrise(&mut self) {
        let (starts, columns) = (self.pattern.starts(), self.pattern.columns());
        let mut next = starts.to_vec();
        for row in 0..self.pattern.len() {
            for at in starts[row]..starts[row + 1] {
                let mirror = next[columns[at]];
                next[columns[at]] += 1;
                let mean = 0.5 * (self.values[at] + self.values[mirror]);
                (self.values[at], self.values[mirror]) = (mean, mean);
            }
        }
    }
}

const YOUNG: f64 = 1.0;
const POISSON: f64 = 0.3;
/// Size of the skew part against the stiffness.
const SKEW: f64 = 0.05;

/// A model by the name of its cells; `size` counts them along an edge.
pub fn named(kind: &str, size: usize) -> Model {
    match kind {
        "quad4" => quad4([size; 2]),
        "quad8" => quad8([size; 2]),
        "bordered" => bordered([size; 3], 6),
        _ => hex8([size; 3]),
    }
}

/// A block of `cells` eight-node hexahedra.
pub fn hex8(cells: [usize; 3]) -> Model {
    let corners = (0..8).map(|c| [c & 1, c >> 1 & 1, c >> 2]).collect::<Vec<_>>();
    let element = stiffness(3, &gauss(3, 2), |point| hex8_gradients(&corners, point));
    let nodes = cells.map(|c| c + 1);
    let number = |at: [usize; 3]| at[0] + nodes[0] * (at[1] + nodes[1] * at[2]);
    let mut elements = Vec::new();
    for (x, y, z) in positions(cells) {
        elements.push(corners.iter().map(|c| number([x + c[0], y + c[1], z + c[2]])).collect::<Vec<_>>());
    }
    let clamped = (0..nodes[0] * nodes[1]).collect::<Vec<_>>();
    assemble(&format!("hex8 {cells:?}"), 3, nodes.iter().product(), &elements, &element, &clamped)
}

/// A sheet of `cells` four-node quadrilaterals in plane strain.
pub fn quad4(cells: [usize; 2]) -> Model {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    sheet("quad4", cells, &corners, |[x, y], [a, b]| [0.5 * a * (1.0 + b * y), 0.5 * b * (1.0 + a * x)])
}

/// A sheet of `cells` eight-node serendipity quadrilaterals in plane strain.
pub fn quad8(cells: [usize; 2]) -> Model {
    let (i, o) = (1.0, 0.0);
    let nodes = [[-i, -i], [i, -i], [i, i], [-i, i], [o, -i], [i, o], [o, i], [-i, o]];
    sheet("quad8", cells, &nodes, quad8_gradient)
}

/// Dense front of all unknowns on a clamped block's top face: a rigid tool's reference node that couples to it.
pub fn bordered(cells: [usize; 3], extra: usize) -> Model {
    let body = hex8(cells);
    let n = body.pattern.len();
    let top = n - 3 * (cells[0] + 1) * (cells[1] + 1)..n;
    let mut entries = entries_of(&body);
    for (k, row) in (n..n + extra).enumerate() {
        entries.extend(
            top.clone()
                .filter(|j| j % 3 == k % 3)
                .flat_map(|j| [(row, j, 0.3 + 0.1 * (j % 7) as f64), (j, row, 0.2 + 0.1 * (j % 5) as f64)]),
        );
        entries.extend((n..n + extra).map(|column| (row, column, if row == column { 50.0 } else { 0.5 })));
    }
    let mut nodes = (0..n).map(|unknown| unknown / 3).collect::<Vec<_>>();
    nodes.extend((0..extra).map(|_| n / 3));
    from_entries(format!("bordered {cells:?}"), n + extra, entries, nodes)
}

fn positions(cells: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
    let [a, b, c] = cells;
    (0..c).flat_map(move |z| (0..b).flat_map(move |y| (0..a).map(move |x| (x, y, z))))
}

/// A sheet whose cells have nodes at half-cell positions; the left edge is clamped.
fn sheet<const N: usize>(
    name: &str,
    cells: [usize; 2],
    places: &[[f64; 2]; N],
    gradient: impl Fn([f64; 2], [f64; 2]) -> [f64; 2],
) -> Model {
    let gradients = |at: &[f64]| {
        let node = |&place: &[f64; 2]| {
            let g = gradient([at[0], at[1]], place);
            [g[0], g[1], 0.0]
        };
        places.iter().map(node).collect()
    };
    let element = stiffness(2, &gauss(2, if N > 4 { 3 } else { 2 }), gradients);
    let mut numbers = HashMap::new();
    let (mut elements, mut clamped) = (Vec::new(), Vec::new());
    for (x, y, _) in positions([cells[0], cells[1], 1]) {
        let half = |place: &[f64; 2]| ((2 * x + 1) as i64 + place[0] as i64, (2 * y + 1) as i64 + place[1] as i64);
        let mut element = Vec::new();
        for place in places {
            let next = numbers.len();
            let number = *numbers.entry(half(place)).or_insert(next);
            if number == next && half(place).0 == 0 {
                clamped.push(number);
            }
            element.push(number);
        }
        elements.push(element);
    }
    assemble(&format!("{name} {cells:?}"), 2, numbers.len(), &elements, &element, &clamped)
}

fn hex8_gradients(corners: &[[usize; 3]], point: &[f64]) -> Vec<[f64; 3]> {
    let side = |c: usize| if c == 0 { -1.0 } else { 1.0 };
    let of = |corner: &[usize; 3]| {
        let s = corner.map(side);
        let f = |k: usize| 0.5 * (1.0 + s[k] * point[k]);
        [s[0] * f(1) * f(2), s[1] * f(0) * f(2), s[2] * f(0) * f(1)]
    };
    corners.iter().map(of).collect()
}

fn quad8_gradient([x, y]: [f64; 2], [a, b]: [f64; 2]) -> [f64; 2] {
    // Derivatives on the square of side two, doubled for the unit cell.
    let on_square = if a == 0.0 {
        [-x * (1.0 + b * y), 0.5 * b * (1.0 - x * x)]
    } else if b == 0.0 {
        [0.5 * a * (1.0 - y * y), -y * (1.0 + a * x)]
    } else {
        [0.25 * a * (1.0 + b * y) * (2.0 * a * x + b * y), 0.25 * b * (1.0 + a * x) * (a * x + 2.0 * b * y)]
    };
    on_square.map(|g| 2.0 * g)
}

/// Gauss points of a unit cell in the coordinates of the square or cube of side two, with weights.
fn gauss(dimension: usize, order: usize) -> Vec<(Vec<f64>, f64)> {
    let line: &[(f64, f64)] = match order {
        2 => &[(-0.577_350_269_189_625_8, 0.5), (0.577_350_269_189_625_8, 0.5)],
        _ => &[(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)],
    };
    let mut points = vec![(Vec::new(), 1.0)];
    for _ in 0..dimension {
        let extend = |(point, weight): &(Vec<f64>, f64)| {
            let (point, weight) = (point.clone(), *weight);
            line.iter().map(move |&(x, w)| ([&point[..], &[x]].concat(), weight * w)).collect::<Vec<_>>()
        };
        points = points.iter().flat_map(extend).collect();
    }
    points
}

/// Element matrix of isotropic elasticity plus a skew part, row by row.
fn stiffness(d: usize, points: &[(Vec<f64>, f64)], gradients: impl Fn(&[f64]) -> Vec<[f64; 3]>) -> Vec<Vec<f64>> {
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let lame = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    let nodes = gradients(&points[0].0).len();
    let mut k = vec![vec![0.0; d * nodes]; d * nodes];
    for (point, weight) in points {
        let g = gradients(point);
        for (a, i, b, j) in
            (0..nodes * nodes * d * d).map(|t| (t / (nodes * d * d), t / d % d, t / (d * d) % nodes, t % d))
        {
            let dot = (0..d).map(|c| g[a][c] * g[b][c]).sum::<f64>();
            let same = if i == j { shear * dot } else { 0.0 };
            k[d * a + i][d * b + j] += weight * (lame * g[a][i] * g[b][j] + shear * g[a][j] * g[b][i] + same);
        }
    }
    let diagonal = (0..d * nodes).map(|r| k[r][r]).collect::<Vec<_>>();
    for (r, s) in (0..d * nodes).flat_map(|r| (0..r).map(move |s| (r, s))) {
        let skew = SKEW * ((r * 7 + s * 3) % 11) as f64 / 11.0 * diagonal[r];
        k[r][s] += skew;
        k[s][r] -= skew;
    }
    k
}

fn assemble(name: &str, d: usize, nodes: usize, elements: &[Vec<usize>], k: &[Vec<f64>], clamped: &[usize]) -> Model {
    let mut neighbours = vec![Vec::new(); nodes];
    for element in elements {
        for &node in element {
            neighbours[node].extend_from_slice(element);
        }
    }
    let (mut starts, mut columns) = (vec![0], Vec::new());
    for own in &mut neighbours {
        own.sort_unstable();
        own.dedup();
        for _ in 0..d {
            columns.extend(own.iter().flat_map(|&node| (0..d).map(move |j| d * node + j)));
            starts.push(columns.len());
        }
    }
    let mut values = vec![0.0; columns.len()];
    let mut add = |row: usize, node: usize, j: usize, value: f64| {
        if let Ok(at) = neighbours[row / d].binary_search(&node) {
            values[starts[row] + d * at + j] += value;
        }
    };
    for element in elements {
        for (a, &node) in element.iter().enumerate() {
            for (b, &other) in element.iter().enumerate() {
                for (i, j) in (0..d * d).map(|t| (t / d, t % d)) {
                    add(d * node + i, other, j, k[d * a + i][d * b + j]);
                }
            }
        }
    }
    for &node in clamped {
        (0..d).for_each(|i| add(d * node + i, node, i, YOUNG));
    }
    let pattern = Pattern::new(starts, columns).and_then(|pattern| pattern.with_block(d)).expect("symmetric");
    Model { name: name.to_string(), pattern, values }
}

fn entries_of(model: &Model) -> Vec<(usize, usize, f64)> {
    let (starts, columns) = (model.pattern.starts(), model.pattern.columns());
    let rows = (0..model.pattern.len()).flat_map(|row| (starts[row]..starts[row + 1]).map(move |at| (row, at)));
    rows.map(|(row, at)| (row, columns[at], model.values[at])).collect()
}

fn from_entries(name: String, n: usize, mut entries: Vec<(usize, usize, f64)>, nodes: Vec<usize>) -> Model {
    entries.sort_by_key(|&(row, column, _)| (row, column));
    let mut starts = vec![0; n + 1];
    entries.iter().for_each(|&(row, ..)| starts[row + 1] += 1);
    (0..n).for_each(|row| starts[row + 1] += starts[row]);
    let columns = entries.iter().map(|&(_, column, _)| column).collect();
    let pattern = Pattern::new(starts, columns).and_then(|pattern| pattern.with_nodes(nodes)).expect("symmetric");
    Model { name, pattern, values: entries.into_iter().map(|(.., value)| value).collect() }
}
