//! What every cell must satisfy: the registry is walked and no cell is named.

use super::*;
use crate::tensor::{Vec3, legendre};

type Shape = (Vec<f64>, Vec<[f64; 3]>);

fn shape(cell: &Cell, xi: [f64; 3]) -> Shape {
    let (mut n, mut dn) = (vec![f64::NAN; cell.nodes.len()], vec![[f64::NAN; 3]; cell.nodes.len()]);
    (cell.shape)(xi, &mut n, &mut dn);
    (n, dn)
}

/// Reference directions in which the cell is an interval `[-1, 1]`; in the others it is a simplex.
fn interval(cell: &Cell, axis: usize) -> bool {
    cell.nodes.iter().any(|node| node[axis] == -1.0)
}

/// A rule of high degree on any reference cell: the unit cube, stretched along intervals and collapsed to simplices.
fn oracle(cell: &Cell) -> Vec<([f64; 3], f64)> {
    let one: Vec<[f64; 2]> = legendre(7).iter().map(|(x, weight)| [0.5 * (1.0 + x), 0.5 * weight]).collect();
    let mut points = vec![([0.0; 3], 1.0)];
    for axis in 0..cell.dimension {
        let extend = |&(xi, weight): &([f64; 3], f64)| {
            let earlier: f64 = (0..axis).filter(|&a| !interval(cell, a)).map(|a| xi[a]).sum();
            let (start, length) = if interval(cell, axis) { (-1.0, 2.0) } else { (0.0, 1.0 - earlier) };
            let place = move |&[x, w]: &[f64; 2]| {
                let mut point: [f64; 3] = xi;
                point[axis] = start + length * x;
                (point, weight * length * w)
            };
            one.iter().map(place).collect::<Vec<_>>()
        };
        points = points.iter().flat_map(extend).collect();
    }
    points
}

/// Scattered points inside the cell, the same in every run.
fn inside(cell: &Cell) -> impl Iterator<Item = [f64; 3]> {
    oracle(cell).into_iter().step_by(5).map(|(xi, _)| xi)
}

fn rules(cell: &Cell) -> impl Iterator<Item = &'static Quadrature> {
    [Some(cell.full), cell.reduced].into_iter().chain(cell.gauss).flatten()
}

fn position(cell: &Cell, nodes: &[usize], n: &[f64]) -> [f64; 3] {
    std::array::from_fn(|a| nodes.iter().zip(n).map(|(&node, n)| n * cell.nodes[node][a]).sum())
}

fn assert_close(a: f64, b: f64, tolerance: f64, what: &str, cell: &Cell) {
    assert!((a - b).abs() <= tolerance, "{cell:?}, {what}: {a} is not {b}");
}

#[test]
fn the_shape_functions_sum_to_one_and_are_one_at_their_own_node() {
    for cell in ALL {
        for xi in inside(cell) {
            let (n, dn) = shape(cell, xi);
            assert_close(n.iter().sum(), 1.0, 1e-14, "sum", cell);
            (0..3).for_each(|a| assert_close(dn.iter().map(|d| d[a]).sum(), 0.0, 1e-13, "sum of gradients", cell));
        }
        for (i, &node) in cell.nodes.iter().enumerate() {
            for (j, n) in shape(cell, node).0.into_iter().enumerate() {
                assert_eq!(n, f64::from(u8::from(i == j)), "{cell:?}, function {j} at node {i}");
            }
        }
    }
}

#[test]
fn the_gradients_are_those_of_the_values() {
    let h = 1e-4;
    for cell in ALL {
        for xi in inside(cell) {
            let dn = shape(cell, xi).1;
            for a in 0..3 {
                let at = |step: f64| {
                    let mut moved = xi;
                    moved[a] += step;
                    shape(cell, moved).0
                };
                for (i, (plus, minus)) in at(h).into_iter().zip(at(-h)).enumerate() {
                    assert_close(dn[i][a], (plus - minus) / (2.0 * h), 5e-8, "gradient", cell);
                }
            }
        }
    }
}

#[test]
fn the_functions_hold_all_polynomials_of_their_degree() {
    for cell in ALL {
        for powers in monomials(cell, cell.degree) {
            let value = |xi: &[f64; 3]| monomial(*xi, powers);
            for xi in inside(cell) {
                let interpolated: f64 = shape(cell, xi).0.iter().zip(cell.nodes).map(|(n, node)| n * value(node)).sum();
                assert_close(interpolated, value(&xi), 1e-14, "interpolation", cell);
            }
        }
    }
}

fn monomials(cell: &Cell, degree: usize) -> Vec<[usize; 3]> {
    let most = |axis: usize| if axis < cell.dimension { degree } else { 0 };
    let all = (0..=most(0)).flat_map(|i| (0..=most(1)).flat_map(move |j| (0..=most(2)).map(move |k| [i, j, k])));
    all.filter(|powers| powers.iter().sum::<usize>() <= degree).collect()
}

fn monomial(xi: [f64; 3], powers: [usize; 3]) -> f64 {
    (0..3).map(|a| xi[a].powi(powers[a] as i32)).product()
}

/// The integral of a monomial over the reference cell in closed form.
fn exact(cell: &Cell, powers: [usize; 3]) -> f64 {
    let factorial = |n: usize| (1..=n).product::<usize>() as f64;
    let (mut product, mut simplex, mut sum) = (1.0, 0, 0);
    for (axis, &power) in powers.iter().enumerate().take(cell.dimension) {
        if interval(cell, axis) {
            product *= if power % 2 == 0 { 2.0 / (power + 1) as f64 } else { 0.0 };
        } else {
            product *= factorial(power);
            (simplex, sum) = (simplex + 1, sum + power);
        }
    }
    product / factorial(simplex + sum)
}

#[test]
fn the_quadratures_are_exact_to_their_degree_and_no_further() {
    for cell in ALL {
        for rule in rules(cell) {
            assert_eq!(rule.points.len(), rule.weights.len());
            let error = |powers: [usize; 3]| {
                let sum: f64 = rule.points.iter().zip(rule.weights).map(|(&xi, w)| w * monomial(xi, powers)).sum();
                (sum - exact(cell, powers)).abs()
            };
            let worst = |degree| monomials(cell, degree).into_iter().map(error).fold(0.0, f64::max);
            assert!(worst(rule.degree) < 4e-15, "{cell:?}, degree {}: {}", rule.degree, worst(rule.degree));
            assert!(worst(rule.degree + 1) > 1e-4, "{cell:?}, degree {} is understated", rule.degree);
            assert_close(rule.weights.iter().sum(), exact(cell, [0; 3]), 4e-15, "sum of weights", cell);
        }
        let numbers = cell.gauss.map(|rule| rule.map(|rule| rule.points.len()));
        assert!(numbers.is_sorted(), "{cell:?}");
    }
}

/// Rules of any order on sides: of order `n` polynomials of degree `2 n - 1` in each direction are exact, one less on folded squares.
#[test]
fn surfaces_have_rules_of_any_order() {
    for cell in ALL.iter().filter(|cell| cell.gauss[0].is_some()) {
        for order in 4..=10 {
            let rule = cell.surface_rule(order);
            let degree =
                if cell.dimension == 1 || cell.linear.nodes.len() == 4 { 2 * order - 1 } else { 2 * order - 2 };
            for powers in monomials(cell, degree) {
                let sum: f64 = rule.iter().map(|(xi, w)| w * monomial(*xi, powers)).sum();
                assert_close(sum, exact(cell, powers), 1e-14, "a monomial", cell);
            }
        }
        assert_eq!(cell.surface_rule(2).len(), cell.gauss[1].unwrap().points.len());
    }
}

#[test]
fn the_points_of_quadrature_lie_inside() {
    for cell in ALL {
        for xi in rules(cell).flat_map(|rule| rule.points) {
            let weights = shape(cell.linear, *xi).0;
            assert!(weights.iter().all(|&n| n > 0.0), "{cell:?}: {xi:?}");
        }
    }
}

/// The integral of `dN_i/dx_a dN_j/dx_b`, of which every stiffness of an undistorted cell is made.
fn products(cell: &Cell, points: impl Iterator<Item = ([f64; 3], f64)>) -> Vec<f64> {
    let size = 3 * cell.nodes.len();
    let mut sums = vec![0.0; size * size];
    for (xi, weight) in points {
        let dn = shape(cell, xi).1.concat();
        for (place, sum) in sums.iter_mut().enumerate() {
            *sum += weight * dn[place / size] * dn[place % size];
        }
    }
    sums
}

#[test]
fn full_quadrature_gives_the_exact_stiffness() {
    for cell in ALL {
        let full = cell.full.points.iter().copied().zip(cell.full.weights.iter().copied());
        for (sum, exact) in products(cell, full).into_iter().zip(products(cell, oracle(cell).into_iter())) {
            assert_close(sum, exact, 1e-13, "stiffness", cell);
        }
    }
}

#[test]
fn the_functions_of_a_face_are_those_of_its_cell() {
    for cell in ALL {
        for face in cell.faces {
            assert_eq!((face.cell.dimension + 1, face.cell.degree), (cell.dimension, cell.degree));
            assert_eq!(face.cell.nodes.len(), face.nodes.len());
            assert!(face.cell.gauss.iter().all(Option::is_some), "{cell:?}: {:?} has no surface rule", face.cell);
            for eta in inside(face.cell) {
                let of_face = shape(face.cell, eta).0;
                let of_cell = shape(cell, position(cell, face.nodes, &of_face)).0;
                for (node, n) in of_cell.into_iter().enumerate() {
                    let expected = face.nodes.iter().position(|&other| other == node).map_or(0.0, |i| of_face[i]);
                    assert_close(n, expected, 1e-14, "restriction to a face", cell);
                }
            }
        }
    }
}

/// Outward normal of a face, its length the ratio of measures: to the right of an edge, by the right hand of a face.
fn normal(cell: &Cell, face: &Face, eta: [f64; 3]) -> (Vec3, Vec3) {
    let (n, dn) = shape(face.cell, eta);
    let tangent = |a: usize| Vec3(position(cell, face.nodes, &dn.iter().map(|d| d[a]).collect::<Vec<_>>()));
    let normal = if cell.dimension == 2 { -tangent(0).left() } else { tangent(0).cross(tangent(1)) };
    (Vec3(position(cell, face.nodes, &n)), normal)
}

#[test]
fn the_faces_close_the_cell_and_look_outward() {
    for cell in ALL.iter().filter(|cell| cell.dimension > 1) {
        let centre = Vec3(cell.center());
        let (mut flux, mut area) = (0.0, Vec3::zero());
        for face in cell.faces {
            for (eta, weight) in oracle(face.cell) {
                let (x, n) = normal(cell, face, eta);
                assert!(n.dot(x - centre) > 0.0, "{cell:?}: a face looks inward");
                flux += weight * n.dot(x);
                area += n * weight;
            }
        }
        assert!(area.norm() < 1e-14, "{cell:?}: the faces leave a gap");
        assert_close(flux / cell.dimension as f64, exact(cell, [0; 3]), 1e-13, "volume by its surface", cell);
    }
}

#[test]
fn the_mirror_turns_a_cell_inside_out() {
    for cell in ALL {
        let mirror = cell.mirror();
        let jacobian = |order: &[usize]| {
            let nodes: Vec<usize> = order.to_vec();
            let points: Vec<Vec3> = cell.nodes.iter().copied().map(Vec3).collect();
            let view = crate::mesh::CellView { kind: cell, nodes: &nodes };
            let (_, [u, v, w]) = view.map(&points, cell.center());
            [u[0], u.cross(v)[2], u.cross(v).dot(w)][cell.dimension - 1]
        };
        let straight: Vec<usize> = (0..cell.nodes.len()).collect();
        assert_close(jacobian(&straight), 1.0, 1e-14, "Jacobian", cell);
        assert_close(jacobian(&mirror), -1.0, 1e-14, "Jacobian of the mirror", cell);
        assert!(straight.iter().all(|&i| mirror[mirror[i]] == i));
    }
}

#[test]
fn the_registry_is_in_order() {
    for (i, cell) in ALL.iter().enumerate() {
        assert_eq!(Cell::named(cell.name).unwrap(), *cell);
        assert!(ALL[..i].iter().all(|other| other.name != cell.name && other.vtk != cell.vtk));
        assert!(cell.nodes.len() <= MAX_NODES);
        assert!(cell.nodes.starts_with(cell.linear.nodes) && cell.linear.degree == 1);
        assert!(cell.degree > 1 || cell.linear == *cell);
    }
    assert!(Cell::named("quad5").is_none());
}
