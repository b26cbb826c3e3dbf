//! Every registered shape against independent and slower answers.

use super::facet::{Meeting, ToolFacet};
use super::shapes::{ALL, ProfileRay, ProfileShape, RayCrossing, ShapeKind, turn};
use crate::tensor::Vec3;

pub(super) fn at(x: f64, y: f64) -> Vec3 {
    Vec3::new(x, y, 0.0)
}

/// Well-shaped nodes for any shape: a bulged row from `from` to `to`.
pub(super) fn nodes(kind: &ShapeKind, from: Vec3, to: Vec3, bulge: f64) -> Vec<Vec3> {
    let place = |i: usize| {
        let s = i as f64 / (kind.nodes - 1) as f64;
        from + (to - from) * s + (to - from).left() * (bulge * s * (1.0 - s))
    };
    (0..kind.nodes).map(place).collect()
}

/// A unit-sized curve of each kind, turned, with bulges from none over hardly any to beyond half a turn.
fn shapes() -> Vec<(String, Box<dyn ProfileShape>)> {
    let mut all = Vec::new();
    for &kind in ALL {
        for bulge in [0.0, 1e-15, 1e-9, -1e-4, 0.3, -1.0, 3.0, -8.0] {
            for angle in [0.0, 0.7, 2.0, -1.1] {
                let to = at(f64::cos(angle), f64::sin(angle)) * 1.7;
                let curve = nodes(kind, at(0.3, -0.2), at(0.3, -0.2) + to, bulge);
                all.push((format!("{} bulge {bulge} angle {angle}", kind.key), kind.build(&curve).unwrap()));
            }
        }
    }
    all
}

fn rays() -> Vec<ProfileRay> {
    let mut all = Vec::new();
    for i in 0..14 {
        for j in 0..11 {
            let angle = 0.05 + f64::from(i) * std::f64::consts::TAU / 14.0;
            let origin = at(0.9, 0.4) + at(-angle.sin(), angle.cos()) * (f64::from(j) * 0.41 - 2.05);
            all.push(ProfileRay { origin, direction: at(angle.cos(), angle.sin()) });
        }
    }
    all
}

pub(super) fn cast(shape: &dyn ProfileShape, ray: &ProfileRay) -> Vec<RayCrossing> {
    let mut found = Vec::new();
    shape.cast(ray, &mut |Meeting { u, s: [s, _] }| found.push(RayCrossing { u, s }));
    found.sort_by(|a, b| a.s.total_cmp(&b.s));
    found
}

/// Crossings by dense sampling of the side on which a point of the curve lies, then bisection.
fn brute_force(shape: &dyn ProfileShape, ray: &ProfileRay) -> Vec<RayCrossing> {
    const SAMPLES: usize = 1500;
    let side = |s: f64| turn(ray.direction, shape.point(s) - ray.origin);
    let mut found = Vec::new();
    for i in 0..SAMPLES {
        let (mut a, mut b) = (i as f64 / SAMPLES as f64, (i + 1) as f64 / SAMPLES as f64);
        if side(a) == 0.0 || side(a).signum() == side(b).signum() {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if side(middle).signum() == side(a).signum() { a = middle } else { b = middle }
        }
        found.push(RayCrossing { u: (shape.point(a) - ray.origin).dot(ray.direction), s: a });
    }
    found
}

/// Rays that graze the curve or pass by its ends may be counted either way.
fn is_delicate(shape: &dyn ProfileShape, ray: &ProfileRay) -> bool {
    let grazing = |s: f64| turn(ray.direction, shape.tangent(s).unit()).abs() < 0.03;
    let near_line = |s: f64| turn(ray.direction, shape.point(s) - ray.origin).abs() < 2e-3;
    (0..=300).map(|i| f64::from(i) / 300.0).any(|s| near_line(s) && (grazing(s) || s == 0.0 || s == 1.0))
}

#[test]
fn casts_find_what_brute_force_finds() {
    let (mut tried, mut crossings) = (0, 0);
    for (name, shape) in shapes() {
        for ray in rays().iter().filter(|ray| !is_delicate(shape.as_ref(), ray)) {
            let (found, expected) = (cast(shape.as_ref(), ray), brute_force(shape.as_ref(), ray));
            assert_eq!(found.len(), expected.len(), "{name} {ray:?}: {found:?} against {expected:?}");
            for (a, b) in found.iter().zip(&expected) {
                assert!((a.s - b.s).abs() < 1e-12 && (a.u - b.u).abs() < 1e-12, "{name}: {a:?} against {b:?}");
                assert!((shape.point(a.s) - ray.point(a.u)).norm() < 1e-13, "{name}: {a:?}");
            }
            (tried, crossings) = (tried + 1, crossings + found.len());
        }
    }
    assert!(tried > 10_000 && crossings > 4_000, "{tried} rays, {crossings} crossings");
}

#[test]
fn tangents_are_derivatives_and_lengths_their_integrals() {
    for (name, shape) in shapes() {
        let h = 1e-5;
        for s in [0.0, 0.2, 0.5, 0.93, 1.0] {
            let difference = (shape.point(s + h) - shape.point(s - h)) * (0.5 / h);
            let error = (difference - shape.tangent(s)).norm() / shape.length();
            assert!(error < 1e-8, "{name} at {s}: {error}");
        }
        let n = 4000;
        let chords: f64 = shape_points(shape.as_ref(), n).windows(2).map(|p| (p[1] - p[0]).norm()).sum();
        assert!((chords - shape.length()).abs() < 1e-5 * shape.length(), "{name}: {chords} {}", shape.length());
    }
}

fn shape_points(shape: &dyn ProfileShape, n: usize) -> Vec<Vec3> {
    (0..=n).map(|i| shape.point(i as f64 / n as f64)).collect()
}

#[test]
fn nodes_lie_on_the_curve_and_its_ends_are_exact() {
    for (name, shape) in shapes() {
        let nodes = shape.nodes();
        assert_eq!((shape.point(0.0), shape.point(1.0)), (nodes[0], nodes[nodes.len() - 1]), "{name}");
        for end in [1e-9, 1.0 - 1e-9] {
            assert!((shape.point(end) - shape.point(end.round())).norm() < 2e-9 * shape.length(), "{name}");
        }
        let ray = ProfileRay { origin: nodes[nodes.len() / 2] - at(0.6, 0.8), direction: at(0.6, 0.8) };
        let on = cast(shape.as_ref(), &ray).iter().any(|c| (c.u - 1.0).abs() < 1e-13);
        assert!(on, "{name}: a ray through a node must hit");
    }
}

#[test]
fn a_reversed_segment_is_the_same_curve() {
    for (name, shape) in shapes() {
        let back: Vec<Vec3> = shape.nodes().iter().rev().copied().collect();
        let reversed = shape.kind().build(&back).unwrap();
        for s in [0.0, 0.13, 0.5, 0.8, 1.0] {
            assert!((shape.point(s) - reversed.point(1.0 - s)).norm() < 1e-14 * shape.length(), "{name}");
        }
        for ray in rays().iter().filter(|ray| !is_delicate(shape.as_ref(), ray)) {
            let (there, mut again) = (cast(shape.as_ref(), ray), cast(reversed.as_ref(), ray));
            again.reverse();
            assert_eq!(there.len(), again.len(), "{name}");
            for (a, b) in there.iter().zip(&again) {
                assert!((a.u - b.u).abs() < 1e-13 && (a.s + b.s - 1.0).abs() < 1e-13, "{name}: {a:?} {b:?}");
            }
        }
    }
}

/// Lengths in other units that are powers of two apart give the same bits.
#[test]
fn scaling_by_a_power_of_two_scales_every_bit() {
    for factor in [4096.0, 0.5_f64.powi(18)] {
        for (name, shape) in shapes() {
            let scaled: Vec<Vec3> = shape.nodes().iter().map(|&p| p * factor).collect();
            let larger = shape.kind().build(&scaled).unwrap();
            assert_eq!(larger.length(), shape.length() * factor, "{name}");
            assert_eq!(larger.bounds().max, shape.bounds().max * factor, "{name}");
            for ray in rays() {
                let far = ProfileRay { origin: ray.origin * factor, ..ray };
                let expected = cast(shape.as_ref(), &ray).into_iter().map(|c| RayCrossing { u: c.u * factor, ..c });
                assert_eq!(cast(larger.as_ref(), &far), expected.collect::<Vec<_>>(), "{name}");
            }
        }
    }
}

#[test]
fn bounds_hold_the_curve_tightly() {
    for (name, shape) in shapes() {
        let (bounds, points) = (shape.bounds(), shape_points(shape.as_ref(), 3000));
        for axis in 0..2 {
            let low = points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = points.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            assert!(low - bounds.min[axis] > -1e-14 && low - bounds.min[axis] < 1e-5, "{name}");
            assert!(bounds.max[axis] - high > -1e-14 && bounds.max[axis] - high < 1e-5, "{name}");
        }
    }
}

#[test]
fn chords_of_a_flattened_curve_stay_within_the_sagitta() {
    for (name, shape) in shapes() {
        let sagitta = 1e-3;
        let n = shape.flatten(sagitta).len() - 1;
        for i in 0..n {
            let [a, m, b] = [0.0, 0.5, 1.0].map(|part| shape.point((i as f64 + part) / n as f64));
            let off = turn((b - a).unit(), m - a).abs();
            assert!(off <= sagitta * (1.0 + 1e-9), "{name}: {off}");
        }
    }
}

/// Nodes of a straight row of any spacing must be cast as the straight line is.
#[test]
fn straight_nodes_make_a_straight_line() {
    let line = super::shapes::find("line").unwrap().build(&[at(0.0, 0.0), at(3.0, 1.0)]).unwrap();
    for &kind in ALL.iter().filter(|kind| kind.nodes == 3) {
        for shift in [0.0, 1e-16, -3e-13, 1e-10] {
            let curve = kind.build(&[at(0.0, 0.0), at(1.5, 0.5 + shift), at(3.0, 1.0)]).unwrap();
            for ray in rays() {
                let (a, b) = (cast(line.as_ref(), &ray), cast(curve.as_ref(), &ray));
                assert_eq!(a.len(), b.len(), "{}", kind.key);
                for (a, b) in a.iter().zip(&b) {
                    let near = 1e-12 + 30.0 * shift.abs();
                    assert!((a.u - b.u).abs() < near && (a.s - b.s).abs() < near, "{}: {a:?} {b:?}", kind.key);
                }
            }
        }
    }
}
