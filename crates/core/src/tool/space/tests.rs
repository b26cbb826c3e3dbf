//! Tools in space: facets against independent and slower answers, the tree against trying everything.

use super::polygons::{Quad, Triangle};
use super::solids::{Facets, cone, extruded, plane, polygons, revolved, sphere, torus};
use super::{FacetFinding, Meeting, ProfileFrame, SpaceTool, SweepPath, ToolFacet, swept};
use crate::tensor::Vec3;
use crate::tool::shapes::{ALL, ProfileRay, find};
use crate::tool::{Draft, Hit, Pose, Rejected, Rules, rounded, select};
use proptest::prelude::*;

fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A wavy closed curve of all kinds of segments, a little away from the axis.
fn wave() -> super::solids::Profile {
    let p = |x: f64, y: f64| at(x, y, 0.0);
    let nodes: [&[Vec3]; 4] = [
        &[p(0.4, -1.0), p(1.0, -0.9)],
        &[p(1.0, -0.9), p(1.4, -0.2), p(1.0, 0.3)],
        &[p(1.0, 0.3), p(0.6, 0.45), p(0.5, 0.9)],
        &[p(0.5, 0.9), p(0.3, 0.0), p(0.4, -1.0)],
    ];
    let kinds = ["line", "arc", "parabola", "arc"];
    kinds.iter().zip(nodes).map(|(key, nodes)| find(key).unwrap().build(nodes).unwrap()).collect()
}

/// A flat end, a rounded edge and a wall.
fn rim() -> Vec<Draft> {
    let p = |x: f64, y: f64| at(x, y, 0.0);
    let nodes = [
        vec![p(-0.3, 0.0), p(-0.2, 0.0)],
        vec![p(-0.2, 0.0), p(-0.02, 0.12), p(0.0, 0.2)],
        vec![p(0.0, 0.2), p(0.0, 0.5)],
    ];
    ["line", "arc", "line"].iter().zip(nodes).map(|(key, nodes)| (0, find(key).unwrap(), nodes)).collect()
}

/// An open path that turns left and right.
fn around() -> SweepPath {
    let frame = ProfileFrame::across(at(0.1, 0.0, -0.1), at(0.1, -0.2, 1.0), at(1.0, 0.3, 0.0)).unwrap();
    let corners = vec![at(-1.0, 0.8, 0.0), at(-0.9, -0.3, 0.0), at(0.3, -0.2, 0.0), at(0.9, -1.0, 0.0)];
    SweepPath { frame, corners, radius: 0.3, closed: false }
}

/// One tool of every kind, each of about unit size.
fn scenes() -> Vec<(&'static str, Facets)> {
    let frame = ProfileFrame::about(at(0.1, 0.0, -0.1), at(0.3, 1.0, -0.5)).unwrap();
    let across = ProfileFrame::across(at(-0.5, 0.1, -0.6), at(0.1, 0.2, 1.0), at(1.0, 0.3, 0.0)).unwrap();
    let quad = [at(-1.0, -0.8, 0.1), at(0.9, -0.7, -0.2), at(1.0, 0.9, 0.4), at(-0.8, 1.1, -0.3)];
    vec![
        ("plane", plane(at(0.1, 0.2, 0.0), at(0.2, 0.1, 1.0), 2.0).unwrap()),
        ("sphere", sphere(at(0.1, -0.1, 0.2), 0.9).unwrap()),
        ("torus", torus(at(0.0, 0.1, 0.0), at(0.2, 0.1, 1.0), 0.8, 0.3).unwrap()),
        ("cylinder", cone(at(-0.7, 0.0, 0.1), at(0.8, 0.2, 0.0), [0.5, 0.5], 0.0).unwrap()),
        ("rounded", cone(at(-0.7, 0.0, 0.1), at(0.8, 0.2, 0.0), [0.5, 0.8], 0.2).unwrap()),
        ("tip", cone(at(-0.7, 0.0, 0.1), at(0.8, 0.2, 0.0), [0.0, 0.7], 0.0).unwrap()),
        ("wave", revolved(wave(), frame)),
        ("rail", extruded(wave(), across, 1.2)),
        ("rim", swept(&rim(), &around()).unwrap()),
        ("twisted", polygons([quad.to_vec()]).unwrap()),
        ("triangle", polygons([quad[..3].to_vec()]).unwrap()),
    ]
}

/// Rays around and through the unit ball, in all directions.
fn rays() -> Vec<ProfileRay> {
    let turn = |i: usize, k: f64| (i as f64 * k).fract();
    let ray = |i: usize| {
        let (z, angle) = (2.0 * turn(i, 0.754_877_666_246_693) - 1.0, 6.3 * turn(i, 0.569_840_290_998_053));
        let flat = (1.0 - z * z).sqrt();
        let origin = at(turn(i, 0.819_172_513_4), turn(i, 0.671_043_606_7), turn(i, 0.549_700_477_9)) * 3.0;
        ProfileRay { origin: origin - at(1.5, 1.5, 1.5), direction: at(flat * angle.cos(), flat * angle.sin(), z) }
    };
    (1..400).map(ray).collect()
}

/// Crossings of a facet by a fine net of triangles and Newton's method from each that the ray meets.
fn brute_force(facet: &dyn ToolFacet, ray: &ProfileRay) -> Vec<f64> {
    const N: usize = 60;
    let three = facet.corners().len() == 3;
    let at = |i: usize, j: usize| facet.point([i as f64 / N as f64, j as f64 / N as f64]);
    let mut found: Vec<f64> = Vec::new();
    for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
        let halves = [[(i, j), (i + 1, j), (i, j + 1)], [(i + 1, j + 1), (i, j + 1), (i + 1, j)]];
        for half in halves {
            if three && half.iter().map(|(i, j)| i + j).max() > Some(N) {
                continue;
            }
            let net = Triangle(half.map(|(i, j)| at(i, j)));
            net.meet(ray, &mut |place| {
                if net.holds(place.s, 0.3) {
                    let [a, b, c] = half.map(|(i, j)| [i as f64 / N as f64, j as f64 / N as f64]);
                    let s = [0, 1].map(|k| a[k] + place.s[0] * (b[k] - a[k]) + place.s[1] * (c[k] - a[k]));
                    if let Some(u) = newton(facet, ray, s)
                        && found.iter().all(|v| (u - v).abs() > 1e-9)
                    {
                        found.push(u);
                    }
                }
            });
        }
    }
    found.sort_by(f64::total_cmp);
    found
}

fn newton(facet: &dyn ToolFacet, ray: &ProfileRay, mut s: [f64; 2]) -> Option<f64> {
    for _ in 0..30 {
        let Meeting { u, s: next } = crate::tool::facet::flat(facet.point(s), facet.tangents(s), ray, s)?;
        let done = (s[0] - next[0]).abs() + (s[1] - next[1]).abs() < 1e-14;
        s = next;
        if done {
            let around = [s[0], if facet.holds([0.5, 7.0], 0.0) { s[1].rem_euclid(1.0) } else { s[1] }];
            return facet.holds(around, 0.0).then_some(u);
        }
    }
    None
}

/// Whether the ray runs near to a facet's edge or nearly along it: then it may be counted either way.
fn is_delicate(facet: &dyn ToolFacet, ray: &ProfileRay) -> bool {
    let mut delicate = false;
    facet.meet(ray, &mut |place| {
        let edge = |s: f64| s.abs() < 1e-3 || (s - 1.0).abs() < 1e-3;
        let three = facet.corners().len() == 3 && (place.s[0] + place.s[1] - 1.0).abs() < 1e-3;
        let round = facet.holds([0.5, 7.0], 0.0);
        let grazes = facet.normal(place.s.map(|s| s.clamp(-0.1, 1.1))).dot(ray.direction).abs() < 0.05;
        delicate |= edge(place.s[0]) || (!round && edge(place.s[1])) || three || grazes;
    });
    delicate
}

#[test]
fn casts_find_what_brute_force_finds() {
    for (name, facets) in scenes() {
        let (mut tried, mut crossings) = (0, 0);
        for (facet, ray) in facets.iter().flat_map(|facet| rays().into_iter().map(move |ray| (facet, ray))) {
            if is_delicate(facet.as_ref(), &ray) {
                continue;
            }
            let mut found = Vec::new();
            facet.cast(&ray, &mut |place| {
                assert!((facet.point(place.s) - ray.point(place.u)).norm() < 1e-9, "{name} {place:?}");
                found.push(place.u);
            });
            found.sort_by(f64::total_cmp);
            let expected = brute_force(facet.as_ref(), &ray);
            assert_eq!(found.len(), expected.len(), "{name} {facet:?} {ray:?}: {found:?} against {expected:?}");
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9), "{name}: {found:?} {expected:?}");
            (tried, crossings) = (tried + 1, crossings + found.len());
        }
        assert!(tried > 250 && crossings > 30, "{name}: {tried} rays, {crossings} crossings");
    }
}

#[test]
fn tangents_are_derivatives_and_normals_are_across_them() {
    for (name, facets) in scenes() {
        for (facet, s) in facets.iter().flat_map(|f| [[0.2, 0.3], [0.5, 0.4], [0.13, 0.81]].map(move |s| (f, s))) {
            let h = 1e-5;
            for k in 0..2 {
                let shifted = |d: f64| facet.point(std::array::from_fn(|i| s[i] + if i == k { d } else { 0.0 }));
                let error = ((shifted(h) - shifted(-h)) * (0.5 / h) - facet.tangents(s)[k]).norm();
                assert!(error < 1e-7, "{name} {s:?}: {error}");
            }
            let [a, b] = facet.tangents(s);
            assert!((a.cross(b).unit() - facet.normal(s)).norm() < 1e-12, "{name}");
        }
    }
}

/// A point a little before a face sees it, and nothing of a closed body looks inward.
#[test]
fn normals_point_out_of_closed_solids() {
    for (name, facets) in scenes().into_iter().skip(1).take(6) {
        let tool = SpaceTool::new(name, facets, at(0.0, 0.0, 0.0));
        let mut hits = Vec::new();
        for (facet, s) in (0..tool.facets().len()).flat_map(|f| [[0.3, 0.2], [0.6, 0.7]].map(move |s| (f, s))) {
            let (x, n) = (tool.point(&Pose::default(), facet, s), tool.normal(&Pose::default(), facet, s));
            // An odd number of faces lies between the inside and far away.
            for (side, parity) in [(1e-6, 0), (-1e-6, 1)] {
                let ray = ProfileRay { origin: x + n * side, direction: (n + at(0.011, 0.023, -0.017)).unit() };
                tool.cast(&Pose::default(), &ray, [0.0, f64::INFINITY], &mut hits);
                assert_eq!(hits.len() % 2, parity, "{name} {facet} {side}: {hits:?}");
            }
        }
    }
}

/// A ball of triangles with `n` rings.
fn ball(n: usize) -> Vec<Vec<Vec3>> {
    let point = |i: usize, j: usize| {
        let (a, b) = (std::f64::consts::PI * i as f64 / n as f64, std::f64::consts::TAU * (j % n) as f64 / n as f64);
        if i == 0 || i == n { at(0.0, 0.0, a.cos().round()) } else { at(a.sin() * b.cos(), a.sin() * b.sin(), a.cos()) }
    };
    let mut all = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
        if i > 0 {
            all.push(vec![a, b, d]);
        }
        if i + 1 < n {
            all.push(vec![d, b, c]);
        }
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    /// Random heaps of triangles, quadrilaterals, balls and cones, moved: the tree against every facet in its place.
    #[test]
    fn the_tree_finds_what_trying_all_finds(
        seeds in prop::collection::vec(prop::array::uniform12(-1.0..1.0), 1..80),
        motion in prop::array::uniform6(-3.0..3.0),
        origin in prop::array::uniform3(-2.0..2.0),
        towards in prop::array::uniform3(-1.0..1.0),
        range in (-3.0..0.0, 0.0..3.0),
    ) {
        let facet = |(i, x): (usize, &[f64; 12])| -> Facets {
            let p = |k: usize| at(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
            let near = |k: usize| p(0) + p(k) * 0.3;
            match i % 4 {
                0 => vec![Box::new(Triangle([p(0), near(1), near(2)]))],
                1 => vec![Box::new(Quad([p(0), near(1), near(2), near(3)]))],
                2 => sphere(p(0), 0.05 + 0.2 * x[5].abs()).unwrap(),
                _ => cone(p(0), near(1), [0.1, 0.3 * x[6].abs()], 0.0).unwrap(),
            }
        };
        let facets: Facets = seeds.iter().enumerate().flat_map(facet).collect();
        let tool = SpaceTool::new("heap", facets, at(0.3, 0.2, -0.1));
        let pose = Pose::new(&motion);
        let to = Vec3(towards);
        prop_assume!(to.norm() > 0.1);
        let origin = pose.place(tool.reference(), Vec3(origin));
        let ray = ProfileRay { origin, direction: pose.rotate(to.unit()) };
        let own = ProfileRay { origin: pose.withdraw(tool.reference(), origin), direction: pose.rotate_back(ray.direction) };
        let mut expected: Vec<Hit> = Vec::new();
        for (i, facet) in tool.facets().iter().enumerate() {
            facet.cast(&own, &mut |place| {
                let normal = tool.normal(&pose, i, place.s);
                expected.push(Hit { segment: i, s: place.s, u: place.u, normal });
            });
        }
        expected.retain(|hit| (range.0..=range.1).contains(&hit.u));
        expected.sort_by(|a, b| a.segment.cmp(&b.segment).then(a.u.total_cmp(&b.u)));
        let mut hits = Vec::new();
        tool.cast(&pose, &ray, [range.0, range.1], &mut hits);
        prop_assert_eq!(&hits, &expected);
        let choose = |hits: &[Hit]| {
            let mut rejected = Rejected::default();
            (select(ray.direction, hits, &Rules::new(1.0, tool.size()), &mut rejected), rejected)
        };
        prop_assert_eq!(choose(&hits), choose(&expected));
        for hit in &hits {
            prop_assert!((tool.point(&pose, hit.segment, hit.s) - ray.point(hit.u)).norm() < 1e-9);
            let again = tool.meet(&pose, hit.segment, &ray, hit.s).unwrap();
            prop_assert!((again.u - hit.u).abs() < 1e-9, "{:?} {:?}", hit, again);
        }
    }
}

/// A ray through a corner or an edge of a ball of triangles meets it, however the ball stands.
#[test]
fn no_ray_slips_between_neighbours() {
    let tool = SpaceTool::new("ball", polygons(ball(12)).unwrap(), at(0.1, 0.2, 0.3));
    let mut hits = Vec::new();
    for (i, part) in (0..tool.facets().len()).flat_map(|i| [0.0, 0.37, 0.5].map(|part| (i, part))) {
        let pose = Pose::new(&[0.1 * i as f64, -3.0, 0.0, 0.01 * i as f64, 0.7, -0.3]);
        let place = tool.point(&pose, i, [part, 0.0]);
        let inward = (tool.point(&pose, 0, [0.0, 0.0]) - pose.place(tool.reference(), at(0.0, 0.0, 0.0))).unit();
        let centre = pose.place(tool.reference(), at(0.0, 0.0, 0.0));
        let direction = (centre - place + inward * 0.1).unit();
        let ray = ProfileRay { origin: place - direction * 3.0, direction };
        tool.cast(&pose, &ray, [2.0, 4.0], &mut hits);
        assert!(hits.iter().any(|hit| (hit.u - 3.0).abs() < 1e-9), "facet {i} part {part}: {hits:?}");
    }
}

/// A profile that begins over the middles of the corners is closed between them; the tool is one smooth piece without a hole.
#[test]
fn a_swept_punch_is_closed_below() {
    let p = |x: f64, y: f64| at(x, y, 0.0);
    let rim: Vec<Draft> = [("line", vec![p(-2.0, 0.0), p(-1.0, 0.0)]), ("line", vec![p(-1.0, 0.0), p(0.0, 0.0)])]
        .into_iter()
        .map(|(key, nodes)| (0, find(key).unwrap(), nodes))
        .collect();
    let frame = ProfileFrame::across(at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0), at(1.0, 0.0, 0.0)).unwrap();
    let mut path = SweepPath {
        frame,
        corners: vec![at(-6.0, -5.0, 0.0), at(6.0, -5.0, 0.0), at(6.0, 5.0, 0.0), at(-6.0, 5.0, 0.0)],
        radius: 2.0,
        closed: true,
    };
    let tool = SpaceTool::new("punch", swept(&rim, &path).unwrap(), at(0.0, 0.0, 0.0));
    assert_eq!(tool.facets().len(), 4 * 2 + 4 * 2 + 2);
    let pieces = tool.smooth_pieces();
    assert_eq!(pieces.count(), 1);
    for (x, y, inside) in [(0.0, 0.0, true), (5.4, 4.4, true), (5.9, 4.9, false), (-4.0, 3.0, true), (3.0, -4.9, true)]
    {
        let found = tool.closest(&pieces, 0, at(x, y, -0.3));
        assert!((found.gap - 0.3).abs() < 1e-14 && found.normal == at(0.0, 0.0, -1.0), "{x} {y}: {found:?}");
        assert_eq!(found.beyond.is_some(), !inside, "{x} {y}");
    }
    // Drawn the other way the same looks up, and its disc is at the end.
    let back: Vec<Draft> =
        rim.iter().rev().map(|(i, kind, nodes)| (*i, *kind, nodes.iter().rev().copied().collect())).collect();
    let up = SpaceTool::new("up", swept(&back, &path).unwrap(), at(0.0, 0.0, 0.0));
    let found = up.closest(&up.smooth_pieces(), 0, at(0.5, 0.2, 0.3));
    assert!(
        up.smooth_pieces().count() == 1 && found.beyond.is_none() && found.normal == at(0.0, 0.0, 1.0),
        "{found:?}"
    );
    path.radius = 1.0;
    assert!(swept(&rim, &path).unwrap_err().contains("middle of an arc"));
    path.corners[3] = path.corners[2];
    assert!(swept(&rim, &path).unwrap_err().contains("begins and ends in the same place"));
    path.corners[3] = at(3.0, -7.0, 0.0);
    assert!(swept(&rim, &path).unwrap_err().contains("cross"));
    path.radius = 9.0;
    path.corners.pop();
    assert!(swept(&rim, &path).unwrap_err().contains("do not fit"));
}

#[test]
fn faults_of_triangles_are_found() {
    let check = |all: Vec<Vec<Vec3>>| SpaceTool::new("t", polygons(all).unwrap(), at(0.0, 0.0, 0.0)).check();
    assert_eq!(check(ball(8)), []);
    assert_eq!(check(vec![]), [FacetFinding::Empty]);
    let mut open = ball(8);
    open.pop();
    assert!(matches!(check(open)[..], [FacetFinding::OpenEdges(3, _, _)]));
    let mut opposed = ball(8);
    opposed[5].reverse();
    assert!(matches!(
        check(opposed)[..],
        [FacetFinding::Opposed(..), FacetFinding::Opposed(..), FacetFinding::Opposed(..)]
    ));
    let mut inward = ball(8);
    inward.iter_mut().for_each(|corners| corners.reverse());
    assert_eq!(check(inward), [FacetFinding::InsideOut]);
    let mut thin = ball(8);
    thin[3][1] = (thin[3][0] + thin[3][2]) * 0.5;
    assert_eq!(check(thin), [FacetFinding::Degenerate(3)]);
    let mut wild = ball(8);
    wild[2][0] = at(f64::NAN, 0.0, 0.0);
    assert_eq!(check(wild), [FacetFinding::NotFinite(2)]);
    let mut branching = ball(8);
    branching.push(vec![branching[0][0], branching[0][1], at(0.0, 0.0, 9.0)]);
    assert!(check(branching).iter().any(|finding| matches!(finding, FacetFinding::Branching(1, 0))));
}

#[test]
fn fillets_are_tangent_to_their_segments() {
    let corners = [at(0.0, 0.0, 0.0), at(3.0, 0.0, 0.0), at(3.0, 2.0, 0.0), at(0.0, 4.0, 0.0)];
    let line = find("line").unwrap();
    let sides: Vec<Draft> = corners.windows(2).enumerate().map(|(i, ends)| (i, line, ends.to_vec())).collect();
    let drafts = rounded(sides.clone(), 0.5).unwrap();
    let profile: Vec<_> = drafts.iter().map(|(_, kind, nodes)| kind.build(nodes).unwrap()).collect();
    assert_eq!(profile.iter().map(|s| s.kind().key).collect::<Vec<_>>(), ["line", "arc", "line", "arc", "line"]);
    for pair in profile.windows(2) {
        assert!((pair[0].point(1.0) - pair[1].point(0.0)).norm() < 1e-14);
        assert!((pair[0].tangent(1.0).unit() - pair[1].tangent(0.0).unit()).norm() < 1e-12);
    }
    let quarter = &profile[1];
    assert!((quarter.length() - 0.25 * std::f64::consts::PI).abs() < 1e-13);
    assert!(rounded(sides, 1.9).is_err());
}

/// Every registered segment can be swept.
#[test]
fn conics_vanish_on_their_segments() {
    for kind in ALL {
        let nodes = [at(0.5, 0.1, 0.0), at(0.9, 0.5, 0.0), at(1.0, 1.2, 0.0)];
        let shape = kind.build(if kind.nodes == 2 { &nodes[..2] } else { &nodes }).unwrap();
        let conic = shape.conic();
        for s in [-0.1, 0.0, 0.3, 0.8, 1.0] {
            let (value, gradient) = conic.at(shape.point(s));
            assert!(value.abs() < 1e-14 * (1.0 + gradient.norm()), "{} {s} {value}", kind.key);
            assert!(gradient.dot(shape.tangent(s)).abs() < 1e-13 * (1.0 + gradient.norm()), "{}", kind.key);
        }
    }
}

#[test]
fn the_surface_for_drawing_lies_on_the_tool() {
    for (name, facets) in scenes() {
        let tool = SpaceTool::new(name, facets, at(0.0, 0.0, 0.0));
        let tiles = tool.surface(&Pose::new(&[1.0, 2.0, 3.0, 0.1, 0.2, 0.3]), 1e-3);
        for (facet, corners) in &tiles.tiles {
            let [a, b, c] = [0, 1, corners.len() - 1].map(|k| tiles.points[corners[k]]);
            let pose = Pose::new(&[1.0, 2.0, 3.0, 0.1, 0.2, 0.3]);
            let middle =
                corners.iter().fold(Vec3::zero(), |sum, &k| sum + tiles.points[k]) * (1.0 / corners.len() as f64);
            let direction = (b - a).cross(c - a);
            if direction.norm() < 1e-9 {
                continue;
            }
            let ray = ProfileRay { origin: middle, direction: direction.unit() };
            let near = [0.5, 0.5];
            let mut off = f64::INFINITY;
            let mut hits = Vec::new();
            tool.cast(&pose, &ray, [-0.1, 0.1], &mut hits);
            hits.iter().filter(|hit| hit.segment == *facet).for_each(|hit| off = off.min(hit.u.abs()));
            assert!(off < 4e-3, "{name} {facet} {off} {near:?}");
        }
    }
}

/// Distance, normal and curvatures of every tool against brute force and differences.
#[test]
fn closest_points_are_the_closest() {
    let mut state = 5_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut bent =
        polygons([vec![at(-1.0, -1.0, 0.0), at(0.0, -1.0, 0.3), at(0.0, 1.0, 0.3), at(-1.0, 1.0, 0.0)]]).unwrap();
    bent.extend(
        polygons([vec![at(0.0, -1.0, 0.3), at(1.0, -1.0, 0.1), at(1.0, 1.0, 0.1), at(0.0, 1.0, 0.3)]]).unwrap(),
    );
    for (name, facets) in scenes().into_iter().chain([("roof", bent)]) {
        let tool = SpaceTool::new("t", facets, Vec3::zero());
        let pieces = tool.smooth_pieces();
        let expected = match name {
            "cylinder" => 3,
            "tip" | "wave" | "rail" => 2,
            _ => 1,
        };
        assert_eq!(pieces.count(), expected, "{name}");
        let mut seen = 0;
        for (piece, _) in (0..pieces.count()).flat_map(|piece| (0..150).map(move |k| (piece, k))) {
            let x = at(random(), random(), random()) * 1.3;
            let found = tool.closest(&pieces, piece, x);
            if found.beyond.is_some() {
                continue;
            }
            seen += 1;
            assert!((found.point + found.normal * found.gap - x).norm() < 1e-12, "{name} {x:?} {found:?}");
            let h = 1e-6;
            let off = found.bends.iter().map(|(_, k)| k.abs()).fold(0.0, f64::max);
            for axis in 0..3 {
                let step = Vec3(std::array::from_fn(|k| if k == axis { h } else { 0.0 }));
                let [up, down] = [x + step, x - step].map(|x| tool.closest(&pieces, piece, x));
                if (up.normal - down.normal).norm() > 1e-3 || up.beyond.or(down.beyond).is_some() || off > 100.0 {
                    continue;
                }
                assert!(((up.gap - down.gap) / (2.0 * h) - found.normal[axis]).abs() < 1e-6, "{name} {x:?} {found:?}");
                let slope = (up.normal - down.normal) * (0.5 / h);
                let exact = found.turned(Vec3::axis(axis));
                assert!(
                    (slope - exact).norm() < 1e-3 * (1.0 + off * off),
                    "{name} {x:?} {found:?} {slope:?} {exact:?}"
                );
            }
            if pieces.count() == 1 {
                let places = (0..=60).flat_map(|i| (0..=60).map(move |j| [f64::from(i) / 60.0, f64::from(j) / 60.0]));
                let places = places.flat_map(|s| tool.facets().iter().map(move |facet| (facet, s)));
                let inside = places.filter(|(facet, s)| facet.holds(*s, 0.0));
                let least = inside.map(|(facet, s)| (facet.point(s) - x).norm()).fold(f64::INFINITY, f64::min);
                assert!(
                    found.gap.abs() < least + 1e-12 && found.gap.abs() > least - 0.1,
                    "{name} {x:?} {found:?} {least}"
                );
            }
        }
        assert!(seen > 10, "{name}: {seen}");
    }
}
