//! Matrices for the tests, and a dense LU as the oracle.
#![allow(dead_code)]

use frontal::{FrontalError, Pattern};

/// A matrix with its pattern.
pub struct Matrix {
    pub pattern: Pattern,
    pub values: Vec<f64>,
}

/// A small generator of numbers in (-1, 1) (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn next(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next_u64() % n as u64) as usize
    }

    pub fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// The structurally symmetric matrix with these pairs of places and the diagonal; `value` is asked for every entry.
pub fn matrix(n: usize, pairs: &[(usize, usize)], mut value: impl FnMut(usize, usize) -> f64) -> Matrix {
    let mut rows = (0..n).map(|k| vec![k]).collect::<Vec<_>>();
    for &(i, j) in pairs {
        rows[i].push(j);
        rows[j].push(i);
    }
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (i, row) in rows.iter_mut().enumerate() {
        row.sort_unstable();
        row.dedup();
        values.extend(row.iter().map(|&j| value(i, j)));
        columns.extend_from_slice(row);
        starts.push(columns.len());
    }
    Matrix { pattern: Pattern::new(starts, columns).expect("a symmetric pattern"), values }
}

/// A grid of `cells` quadrilaterals or hexahedra with `k` unknowns a node: every node couples to those of its cells.
/// Values are random with a dominant diagonal.
pub fn grid(cells: [usize; 3], k: usize, seed: u64) -> Matrix {
    let nodes = cells.map(|c| c + 1);
    let index = |x: usize, y: usize, z: usize| x + nodes[0] * (y + nodes[1] * z);
    let near = |c: usize, n: usize| c.saturating_sub(1)..(c + 2).min(n);
    let mut pairs = Vec::new();
    for z in 0..nodes[2] {
        for y in 0..nodes[1] {
            for x in 0..nodes[0] {
                for (w, v, u) in near(z, nodes[2])
                    .flat_map(|w| near(y, nodes[1]).map(move |v| (w, v)))
                    .flat_map(|(w, v)| near(x, nodes[0]).map(move |u| (w, v, u)))
                {
                    pairs.push((index(x, y, z), index(u, v, w)));
                }
            }
        }
    }
    let spread = pairs.iter().flat_map(|&(i, j)| (0..k * k).map(move |a| (k * i + a / k, k * j + a % k)));
    let pairs = spread.filter(|(i, j)| i <= j).collect::<Vec<_>>();
    let mut random = Random(seed);
    let n = k * nodes.iter().product::<usize>();
    let diagonal = (9 * k * if cells[2] > 0 { 3 } else { 1 }) as f64;
    let mut matrix = matrix(n, &pairs, |i, j| random.next() + if i == j { 0.5 * diagonal } else { 0.0 });
    matrix.pattern = matrix.pattern.with_block(k).expect("k unknowns a node");
    matrix
}

impl Matrix {
    pub fn len(&self) -> usize {
        self.pattern.len()
    }

    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let starts = self.pattern.starts();
        (0..self.len())
            .flat_map(move |i| (starts[i]..starts[i + 1]).map(move |at| (i, at)))
            .map(|(i, at)| (i, self.pattern.columns()[at], self.values[at]))
    }

    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.len()];
        self.entries().for_each(|(i, j, a)| y[i] += a * x[j]);
        y
    }

    pub fn transposed_times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.len()];
        self.entries().for_each(|(i, j, a)| y[j] += a * x[i]);
        y
    }

    /// Largest componentwise backward error of `A x = b`.
    pub fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        let residual = self.times(x);
        let mut bound = b.iter().map(|b| b.abs()).collect::<Vec<_>>();
        self.entries().for_each(|(i, j, a)| bound[i] += (a * x[j]).abs());
        let errors = residual.iter().zip(b).zip(&bound).map(|((ax, b), bound)| (ax - b).abs() / bound.max(1e-300));
        errors.fold(0.0, f64::max)
    }

    /// Solution by dense LU with partial pivoting, and the smallest pivot over the largest.
    pub fn dense_solve(&self, b: &[f64]) -> (Vec<f64>, f64) {
        let n = self.len();
        let mut a = vec![vec![0.0; n]; n];
        self.entries().for_each(|(i, j, value)| a[i][j] += value);
        let mut x = b.to_vec();
        let mut pivots = Vec::new();
        for k in 0..n {
            let row = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).expect("rows are left");
            a.swap(k, row);
            x.swap(k, row);
            pivots.push(a[k][k].abs());
            for i in k + 1..n {
                let factor = a[i][k] / a[k][k];
                let (done, rest) = a.split_at_mut(i);
                rest[0].iter_mut().zip(&done[k]).skip(k).for_each(|(lower, upper)| *lower -= factor * upper);
                x[i] -= factor * x[k];
            }
        }
        for k in (0..n).rev() {
            let sum = (k + 1..n).map(|j| a[k][j] * x[j]).sum::<f64>();
            x[k] = (x[k] - sum) / a[k][k];
        }
        let largest = pivots.iter().copied().fold(0.0, f64::max);
        (x, pivots.iter().copied().fold(f64::INFINITY, f64::min) / largest)
    }
}

/// Factorises and solves.
pub fn solve(matrix: &Matrix, options: &frontal::Options, b: &[f64]) -> Result<Vec<f64>, FrontalError> {
    let symbolic = frontal::Symbolic::analyse(&matrix.pattern, options)?;
    let mut factor = symbolic.new_factor();
    symbolic.factorise(&matrix.values, &mut factor)?;
    let mut x = b.to_vec();
    factor.solve(&mut x)?;
    Ok(x)
}
