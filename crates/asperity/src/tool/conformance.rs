//! Every registered shape, and whole tools of them, against independent and slower answers.

use super::shapes::{ALL, Crossing, Kind, Ray, Shape, turn};
use super::{Finding, Hit, Pose, Severity, Tool};
use crate::tensor::Vec3;
use proptest::prelude::*;

fn at(x: f64, y: f64) -> Vec3 {
    Vec3::new(x, y, 0.0)
}

/// Well-shaped nodes for any shape: a bulged row from `from` to `to`.
fn nodes(kind: &Kind, from: Vec3, to: Vec3, bulge: f64) -> Vec<Vec3> {
    let place = |i: usize| {
        let s = i as f64 / (kind.nodes - 1) as f64;
        from + (to - from) * s + (to - from).left() * (bulge * s * (1.0 - s))
    };
    (0..kind.nodes).map(place).collect()
}

/// A unit-sized curve of each kind, turned, with bulges from none over hardly any to beyond half a turn.
fn shapes() -> Vec<(String, Box<dyn Shape>)> {
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

fn rays() -> Vec<Ray> {
    let mut all = Vec::new();
    for i in 0..14 {
        for j in 0..11 {
            let angle = 0.05 + f64::from(i) * std::f64::consts::TAU / 14.0;
            let origin = at(0.9, 0.4) + at(-angle.sin(), angle.cos()) * (f64::from(j) * 0.41 - 2.05);
            all.push(Ray { origin, direction: at(angle.cos(), angle.sin()) });
        }
    }
    all
}

fn cast(shape: &dyn Shape, ray: &Ray) -> Vec<Crossing> {
    let mut found = Vec::new();
    shape.cast(ray, &mut |crossing| found.push(crossing));
    found.sort_by(|a, b| a.s.total_cmp(&b.s));
    found
}

/// Crossings by dense sampling of the side on which a point of the curve lies, then bisection.
fn brute_force(shape: &dyn Shape, ray: &Ray) -> Vec<Crossing> {
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
        found.push(Crossing { u: (shape.point(a) - ray.origin).dot(ray.direction), s: a });
    }
    found
}

/// Rays that graze the curve or pass by its ends may be counted either way.
fn is_delicate(shape: &dyn Shape, ray: &Ray) -> bool {
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

fn shape_points(shape: &dyn Shape, n: usize) -> Vec<Vec3> {
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
        let ray = Ray { origin: nodes[nodes.len() / 2] - at(0.6, 0.8), direction: at(0.6, 0.8) };
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
                let far = Ray { origin: ray.origin * factor, ..ray };
                let expected = cast(shape.as_ref(), &ray).into_iter().map(|c| Crossing { u: c.u * factor, ..c });
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

/// A closed tool around the origin with `n` segments of all kinds in turn, its corners at uneven radii.
fn star(n: usize, bulge: f64, radius: impl Fn(usize) -> f64) -> Tool {
    let corner = |i: usize| {
        let angle = std::f64::consts::TAU * (i % n) as f64 / n as f64;
        at(angle.cos(), angle.sin()) * radius(i % n)
    };
    let segment = |i: usize| {
        let kind = ALL[i % ALL.len()];
        kind.build(&nodes(kind, corner(i), corner(i + 1), bulge)).unwrap()
    };
    Tool::new("star", vec![(0..n).map(segment).collect()], at(0.2, 0.1))
}

/// What [`Tool::cast`] must give, without tree and without a moved ray: the segments' nodes are moved instead.
fn cast_all_moved(tool: &Tool, pose: &Pose, ray: &Ray) -> Vec<(usize, Crossing)> {
    let mut all = Vec::new();
    for (i, segment) in tool.segments().iter().enumerate() {
        let moved: Vec<Vec3> = segment.nodes().iter().map(|&p| pose.place(tool.reference(), p)).collect();
        let mut found = cast(segment.kind().build(&moved).unwrap().as_ref(), ray);
        found.sort_by(|a, b| a.u.total_cmp(&b.u));
        all.extend(found.into_iter().map(|c| (i, c)));
    }
    all
}

proptest! {
    #[test]
    fn the_tree_finds_what_trying_all_moved_segments_finds(
        n in 3usize..60,
        bulge in -0.4..0.4,
        radii in prop::collection::vec(0.8..1.2, 60),
        motion in prop::array::uniform3(-3.0..3.0),
        origin in prop::array::uniform2(-3.0..3.0),
        angle in 0.0..6.3,
    ) {
        let tool = star(n, bulge, |i| radii[i]);
        let pose = Pose::new(motion[0], motion[1], motion[2]);
        let ray = Ray { origin: at(origin[0], origin[1]), direction: at(f64::cos(angle), f64::sin(angle)) };
        let expected = cast_all_moved(&tool, &pose, &ray);
        let mut hits = Vec::new();
        tool.cast(&pose, &ray, [f64::NEG_INFINITY, f64::INFINITY], &mut hits);
        prop_assert_eq!(hits.len(), expected.len());
        for (hit, (segment, place)) in hits.iter().zip(&expected) {
            prop_assert_eq!(hit.segment, *segment);
            prop_assert!((hit.u - place.u).abs() < 1e-9 && (hit.s - place.s).abs() < 1e-9);
            let on_tool = tool.point(&pose, hit.segment, hit.s);
            prop_assert!((on_tool - ray.point(hit.u)).norm() < 1e-9);
        }
        let range = [-1.0, 1.5];
        let mut near = Vec::new();
        tool.cast(&pose, &ray, range, &mut near);
        hits.retain(|hit| hit.u >= range[0] && hit.u <= range[1]);
        prop_assert_eq!(near, hits);
    }

    #[test]
    fn normals_point_out_of_a_closed_tool(n in 3usize..30, bulge in -0.2..0.2, angle in -3.0..3.0) {
        let tool = star(n, bulge, |_| 1.0);
        let pose = Pose::new(5.0, -1.0, angle);
        let centre = pose.place(tool.reference(), at(0.0, 0.0));
        for (i, s) in (0..n).flat_map(|i| [(i, 0.25), (i, 0.5), (i, 0.8)]) {
            let (normal, outwards) = (tool.normal(&pose, i, s), tool.point(&pose, i, s) - centre);
            prop_assert!((normal.norm() - 1.0).abs() < 1e-14);
            prop_assert!(normal.dot(outwards) > 0.0);
            prop_assert!(normal.dot(tool.tangent(&pose, i, s)).abs() < 1e-14);
        }
    }

    #[test]
    fn one_given_segment_is_hit_where_all_are_and_a_little_beyond(n in 3usize..12, part in 0.02..0.98, s in -0.05..1.05) {
        let tool = star(n, -0.3, |_| 1.0);
        let (pose, segment) = (Pose::new(0.5, 0.5, 1.0), (part * n as f64) as usize);
        let (target, inwards) = (tool.point(&pose, segment, s), -tool.normal(&pose, segment, s));
        let ray = Ray { origin: target - inwards * 0.3, direction: inwards };
        let hit = tool.cast_segment(&pose, segment, &ray, s).unwrap();
        prop_assert!((hit.u - 0.3).abs() < 1e-12 && (hit.s - s).abs() < 1e-11);
        let mut hits: Vec<Hit> = Vec::new();
        tool.cast(&pose, &ray, [0.0, 1.0], &mut hits);
        let among = hits.iter().any(|h| h.segment == segment && (h.u - hit.u).abs() < 1e-12);
        prop_assert_eq!(among, (0.0..=1.0).contains(&s));
    }
}

/// Far beyond its ends a segment is its tangent; along the tangent there is nothing to hit.
#[test]
fn a_ray_that_misses_the_curve_meets_its_tangent() {
    let arc = super::shapes::find("arc").unwrap().build(&[at(1.0, 0.0), at(0.0, 1.0), at(-1.0, 0.0)]).unwrap();
    let tool = Tool::new("half disc", vec![vec![arc]], at(0.0, 0.0));
    let ray = Ray { origin: at(3.0, 5.0), direction: at(0.0, -1.0) };
    let hit = tool.cast_segment(&Pose::default(), 0, &ray, 0.5).unwrap();
    assert!((hit.u - 4.0).abs() < 1e-15 && (hit.normal - at(0.0, 1.0)).norm() < 1e-15, "{hit:?}");
    assert!(tool.cast_segment(&Pose::default(), 0, &Ray { direction: at(1.0, 0.0), ..ray }, 0.5).is_none());
}

/// A ray through a common node of two segments hits at least one of them, however far it comes and the tool turns.
#[test]
fn no_ray_slips_between_neighbours() {
    let tool = star(24, 0.1, |_| 1.0);
    let mut hits = Vec::new();
    for i in 0..24 {
        for j in 0..50 {
            let pose = Pose::new(0.1 * f64::from(j), 0.0, 0.37 * f64::from(j));
            let (corner, normal) = (tool.point(&pose, i, 0.0), tool.normal(&pose, i, 0.5));
            let ray = Ray { origin: corner + normal * f64::from(1 + j), direction: -normal };
            tool.cast(&pose, &ray, [f64::from(j), f64::from(j) + 1.5], &mut hits);
            assert!(hits.iter().any(|hit| (hit.u - f64::from(1 + j)).abs() < 1e-12), "node {i}, pose {j}");
        }
    }
}

fn square(corners: [[f64; 2]; 4], sides: usize) -> Tool {
    let corner = |i: usize| at(corners[i % 4][0], corners[i % 4][1]);
    let side = |i: usize| ALL[0].build(&[corner(i), corner(i + 1)]).unwrap();
    Tool::new("square", vec![(0..sides).map(side).collect()], at(0.0, 0.0))
}

const UNIT: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

fn errors(tool: &Tool) -> Vec<Finding> {
    let grave = |finding: &Finding| finding.severity() == Severity::Error;
    tool.check(false).into_iter().filter(grave).collect()
}

#[test]
fn a_sound_square_has_four_convex_edges_and_no_error() {
    let found = square(UNIT, 4).check(true);
    assert_eq!(found.len(), 4);
    for finding in &found {
        assert!(matches!(finding, Finding::Kink(_, _, angle) if (angle - 90.0).abs() < 1e-12), "{finding}");
    }
    assert_eq!(found[3].segments(), [3, 0]);
    assert_eq!(found[0].to_string(), "segments 1 and 2 meet at a convex edge of 90.0 degrees");
}

#[test]
fn clockwise_open_gapped_and_crossing_profiles_are_found() {
    let clockwise = square([UNIT[0], UNIT[3], UNIT[2], UNIT[1]], 4);
    assert_eq!(errors(&clockwise), [Finding::Clockwise(0, 3)]);
    assert!(clockwise.check(false).iter().any(|f| matches!(f, Finding::Kink(_, _, angle) if *angle < 0.0)));

    let open = square(UNIT, 3).check(false);
    assert!(open.contains(&Finding::Open(0, 2, [at(0.0, 0.0), at(0.0, 1.0)])));

    let bow_tie = square([UNIT[0], UNIT[2], UNIT[1], UNIT[3]], 4);
    assert!(errors(&bow_tie).contains(&Finding::Crossing(0, 2, at(0.5, 0.5))), "{:?}", errors(&bow_tie));

    let piece = |a: [f64; 2], b: [f64; 2]| ALL[0].build(&[at(a[0], a[1]), at(b[0], b[1])]).unwrap();
    let gapped =
        Tool::new("gapped", vec![vec![piece([0.0, 0.0], [1.0, 0.0]), piece([1.0, 0.25], [1.0, 1.0])]], at(0.0, 0.0));
    assert_eq!(errors(&gapped), [Finding::Gap(0, 1, 0.25)]);
    assert_eq!(errors(&gapped)[0].to_string(), "segments 1 and 2 do not meet: 2.500e-1 lies between them");
}

#[test]
fn bad_segments_are_named() {
    let tool = |key: &str, nodes: &[Vec3]| {
        Tool::new("bad", vec![vec![super::shapes::find(key).unwrap().build(nodes).unwrap()]], at(0.0, 0.0))
    };
    assert_eq!(errors(&Tool::new("none", vec![], at(0.0, 0.0))), [Finding::Empty]);
    assert_eq!(errors(&tool("line", &[at(0.0, f64::NAN), at(1.0, 0.0)])), [Finding::NotFinite(0)]);
    assert_eq!(errors(&tool("arc", &[at(0.0, 0.0), at(f64::INFINITY, 0.0), at(1.0, 0.0)])), [Finding::NotFinite(0)]);
    assert_eq!(errors(&tool("line", &[at(1.0, 1.0), at(1.0, 1.0)])), [Finding::NoLength(0)]);
    assert_eq!(errors(&tool("arc", &[at(1.0, 1.0), at(2.0, 1.0), at(1.0, 1.0)])), [Finding::NoLength(0)]);
    for key in ["arc", "parabola"] {
        let beyond = errors(&tool(key, &[at(0.0, 0.0), at(3.0, 0.0), at(1.0, 0.0)]));
        assert!(matches!(beyond[..], [Finding::Flaw(0, _)]), "{key}: {beyond:?}");
    }
    let left = tool("arc", &[at(0.0, 0.0), at(-1.0, 1.0), at(0.0, 2.0)]).check(true);
    assert!(matches!(left[..], [Finding::NegativeRadius(0, r)] if (r + 1.0).abs() < 1e-15), "{left:?}");
}

#[test]
fn crossing_curves_are_found_and_smooth_joints_are_not_crossings() {
    let arc = |nodes: [[f64; 2]; 3]| ALL[2].build(&nodes.map(|[x, y]| at(x, y))).unwrap();
    let wave = vec![arc([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]), arc([[2.0, 0.0], [3.0, -1.0], [4.0, 0.0]])];
    assert!(errors(&Tool::new("wave", vec![wave], at(0.0, 0.0))).is_empty());
    let lens = vec![vec![arc([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]])], vec![arc([[0.0, 1.0], [1.0, 0.0], [2.0, 1.0]])]];
    let crossed = errors(&Tool::new("lens", lens, at(0.0, 0.0)));
    assert!(matches!(crossed[..], [Finding::Crossing(0, 1, p)] if (p[1] - 0.5).abs() < 1e-5), "{crossed:?}");
}

#[test]
fn misspelt_shapes_and_wrong_numbers_of_nodes_are_told_in_words() {
    let unknown = super::shapes::find("parabla").unwrap_err();
    assert_eq!(unknown, "there is no segment `parabla`; did you mean `parabola`?");
    let short = ALL[2].build(&[at(0.0, 0.0)]).unwrap_err();
    assert_eq!(short, "a segment `arc` has 3 nodes, not 1");
}

#[test]
fn an_outline_follows_the_pose() {
    let (tool, pose) = (star(9, 0.3, |_| 1.0), Pose::new(1.0, 2.0, 0.5));
    let outline = tool.outline(&pose, 1e-3);
    assert_eq!(outline.len(), 1);
    assert!(outline[0].len() > 9);
    assert!((outline[0][0] - tool.point(&pose, 0, 0.0)).norm() < 1e-15);
    assert_eq!(outline[0][0], *outline[0].last().unwrap());
}
