//! Whole tools of all registered shapes: the search against trying everything, normals, rays at nodes, outlines.

use super::conformance::{at, cast, nodes};
use super::shapes::{ALL, ProfileRay, RayCrossing, find};
use super::{Hit, Pose, ProfileTool};
use crate::tensor::Vec3;
use proptest::prelude::*;

/// A closed tool around the origin with `n` segments of all kinds in turn, its corners at uneven radii.
fn star(n: usize, bulge: f64, radius: impl Fn(usize) -> f64) -> ProfileTool {
    let corner = |i: usize| {
        let angle = std::f64::consts::TAU * (i % n) as f64 / n as f64;
        at(angle.cos(), angle.sin()) * radius(i % n)
    };
    let segment = |i: usize| {
        let kind = ALL[i % ALL.len()];
        kind.build(&nodes(kind, corner(i), corner(i + 1), bulge)).unwrap()
    };
    ProfileTool::new("star", vec![(0..n).map(segment).collect()], at(0.2, 0.1))
}

/// What [`ProfileTool::cast`] must give, without tree and without a moved ray: the segments' nodes are moved instead.
fn cast_all_moved(tool: &ProfileTool, pose: &Pose, ray: &ProfileRay) -> Vec<(usize, RayCrossing)> {
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
        let pose = Pose::new(&motion);
        let ray = ProfileRay { origin: at(origin[0], origin[1]), direction: at(f64::cos(angle), f64::sin(angle)) };
        let expected = cast_all_moved(&tool, &pose, &ray);
        let mut hits = Vec::new();
        tool.cast(&pose, &ray, [f64::NEG_INFINITY, f64::INFINITY], &mut hits);
        prop_assert_eq!(hits.len(), expected.len());
        for (hit, (segment, place)) in hits.iter().zip(&expected) {
            prop_assert_eq!(hit.segment, *segment);
            prop_assert!((hit.u - place.u).abs() < 1e-9 && (hit.s[0] - place.s).abs() < 1e-9);
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
        let pose = Pose::new(&[5.0, -1.0, angle]);
        let centre = pose.place(tool.reference(), at(0.0, 0.0));
        for (i, s) in (0..n).flat_map(|i| [(i, 0.25), (i, 0.5), (i, 0.8)]) {
            let (normal, outwards) = (tool.normal(&pose, i, [s, 0.0]), tool.point(&pose, i, [s, 0.0]) - centre);
            prop_assert!((normal.norm() - 1.0).abs() < 1e-14);
            prop_assert!(normal.dot(outwards) > 0.0);
            prop_assert!(normal.dot(pose.rotate(tool.segments()[i].tangent(s))).abs() < 1e-14);
        }
    }

    #[test]
    fn one_given_segment_is_hit_where_all_are_and_a_little_beyond(n in 3usize..12, part in 0.02..0.98, s in -0.05..1.05) {
        let tool = star(n, -0.3, |_| 1.0);
        let (pose, segment) = (Pose::new(&[0.5, 0.5, 1.0]), (part * n as f64) as usize);
        let (target, inwards) = (tool.point(&pose, segment, [s, 0.0]), -tool.normal(&pose, segment, [s, 0.0]));
        let ray = ProfileRay { origin: target - inwards * 0.3, direction: inwards };
        let hit = tool.meet(&pose, segment, &ray, [s, 0.0]).unwrap();
        prop_assert!((hit.u - 0.3).abs() < 1e-12 && (hit.s[0] - s).abs() < 1e-11);
        let mut hits: Vec<Hit> = Vec::new();
        tool.cast(&pose, &ray, [0.0, 1.0], &mut hits);
        let among = hits.iter().any(|h| h.segment == segment && (h.u - hit.u).abs() < 1e-12);
        prop_assert_eq!(among, (0.0..=1.0).contains(&s));
    }
}

/// Far beyond its ends a segment is its tangent; along the tangent there is nothing to hit.
#[test]
fn a_ray_that_misses_the_curve_meets_its_tangent() {
    let arc = find("arc").unwrap().build(&[at(1.0, 0.0), at(0.0, 1.0), at(-1.0, 0.0)]).unwrap();
    let tool = ProfileTool::new("half disc", vec![vec![arc]], at(0.0, 0.0));
    let ray = ProfileRay { origin: at(3.0, 5.0), direction: at(0.0, -1.0) };
    let hit = tool.meet(&Pose::default(), 0, &ray, [0.5, 0.0]).unwrap();
    assert!((hit.u - 4.0).abs() < 1e-15 && (hit.normal - at(0.0, 1.0)).norm() < 1e-15, "{hit:?}");
    assert!(tool.meet(&Pose::default(), 0, &ProfileRay { direction: at(1.0, 0.0), ..ray }, [0.5, 0.0]).is_none());
}

/// A ray through a common node of two segments hits at least one of them, however far it comes and the tool turns.
#[test]
fn no_ray_slips_between_neighbours() {
    let tool = star(24, 0.1, |_| 1.0);
    let mut hits = Vec::new();
    for i in 0..24 {
        for j in 0..50 {
            let pose = Pose::new(&[0.1 * f64::from(j), 0.0, 0.37 * f64::from(j)]);
            let (corner, normal) = (tool.point(&pose, i, [0.0; 2]), tool.normal(&pose, i, [0.5, 0.0]));
            let ray = ProfileRay { origin: corner + normal * f64::from(1 + j), direction: -normal };
            tool.cast(&pose, &ray, [f64::from(j), f64::from(j) + 1.5], &mut hits);
            assert!(hits.iter().any(|hit| (hit.u - f64::from(1 + j)).abs() < 1e-12), "node {i}, pose {j}");
        }
    }
}

#[test]
fn misspelt_shapes_and_wrong_numbers_of_nodes_are_told_in_words() {
    let unknown = find("parabla").unwrap_err();
    assert_eq!(unknown, "there is no segment `parabla`; did you mean `parabola`?");
    let short = ALL[2].build(&[at(0.0, 0.0)]).unwrap_err();
    assert_eq!(short, "a segment `arc` has 3 nodes, not 1");
}

#[test]
fn an_outline_follows_the_pose() {
    let (tool, pose) = (star(9, 0.3, |_| 1.0), Pose::new(&[1.0, 2.0, 0.5]));
    let outline = tool.outline(&pose, 1e-3);
    assert_eq!(outline.len(), 1);
    assert!(outline[0].len() > 9);
    assert!((outline[0][0] - tool.point(&pose, 0, [0.0; 2])).norm() < 1e-15);
    assert_eq!(outline[0][0], *outline[0].last().unwrap());
}
