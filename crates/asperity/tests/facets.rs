//! Tools of facets: distances beside vertices where several of them meet.

use asperity::tensor::Vec3;
use asperity::tool::space::SpaceTool;
use asperity::tool::space::solids::polygons;

fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Outside a pyramid, steep or flat, no piece of it has a negative distance; every piece sees a point right before its middle.
#[test]
fn nothing_lies_inside_a_pyramid_but_what_does() {
    for height in [0.1, 0.5, 1.5, 6.0] {
        let base = [at(1.0, 0.0, height), at(0.0, 1.0, height), at(-1.0, 0.0, height), at(0.0, -1.0, height)];
        let flank = |k: usize| vec![Vec3::zero(), base[(k + 1) % 4], base[k]];
        let facets = polygons((0..4).map(flank).chain([base.to_vec()])).unwrap();
        let tool = SpaceTool::new("pyramid", facets, Vec3::zero());
        let pieces = tool.smooth_pieces();
        for (i, j, k) in (0..21).flat_map(|i| (0..21).flat_map(move |j| (0..12).map(move |k| (i, j, k)))) {
            let x = at(0.1 * i as f64 - 1.03, 0.1 * j as f64 - 0.98, height * (0.1 * k as f64 - 1.01));
            if x[0].abs() + x[1].abs() <= x[2] / height {
                continue;
            }
            for piece in 0..pieces.count() {
                let found = tool.closest(&pieces, piece, x);
                // Seen from behind, through the pyramid, a facet is itself met; what goes on beyond its border is not.
                let [px, py, pz] = found.point.0;
                let met = ((px.abs() + py.abs()) * height - pz).abs() < 1e-9 || (pz - height).abs() < 1e-9;
                assert!(found.beyond.is_some() || met || found.gap > -1e-12, "{height} {piece} {x:?}: {found:?}");
            }
        }
        let before = (base[0] + base[1]) * 0.3 + (base[0] - base[2]).cross(base[1] - base[3]) * -0.01;
        assert!((0..pieces.count()).any(|piece| tool.closest(&pieces, piece, before).beyond.is_none()));
    }
}
