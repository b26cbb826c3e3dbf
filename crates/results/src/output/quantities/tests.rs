//! What is reported is what the body computed: the virtual work of the reported stress and volumes on every affine
//! motion equals that of the reported nodal forces.

use super::Source;
use crate::output::fixture::Fixture;
use crate::output::{Frame, QuantityPlace};
use asperity_core::mesh::{Mesh, Space};
use asperity_core::solid::{BodyOptions, Formulation, Integration, Strain};

fn frame(space: Space, options: BodyOptions) -> (Frame, Mesh) {
    let fixture = Fixture::with(space, options);
    let state = fixture.after(&fixture.start(), 1.0);
    let frame = Source { parts: &fixture.parts(), state: &state, step: 0 }.gather().unwrap();
    (frame, (*fixture.mesh).clone())
}

/// Work of the reported forces and of the reported stress on the motion `v = gradient x`, in the configuration of the
/// stress: the present one, in small strain the undeformed one.
fn works(frame: &Frame, mesh: &Mesh, (space, strain): (Space, Strain), gradient: [[f64; 3]; 3]) -> [f64; 2] {
    let v = |x: [f64; 3]| gradient.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
    let part = if strain == Strain::Finite { 1.0 } else { 0.0 };
    let moved = |x: [f64; 3], u: [f64; 3]| std::array::from_fn(|a| x[a] + part * u[a]);
    let get = |place, name: &str| frame.get(place, name).unwrap();
    let (u, force) = (get(QuantityPlace::Node, "displacement"), get(QuantityPlace::Node, "reaction"));
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let outer = (0..mesh.points.len()).map(|n| dot(force.vector(n), v(moved(mesh.points[n].0, u.vector(n))))).sum();
    let (x, u) = (get(QuantityPlace::Gauss, "reference_position"), get(QuantityPlace::Gauss, "displacement"));
    let (stress, volume) = (get(QuantityPlace::Gauss, "cauchy_stress"), get(QuantityPlace::Gauss, "volume"));
    let inner = |p: usize| {
        let x = moved(x.vector(p), u.vector(p));
        let mut g = gradient;
        if space == Space::Axisymmetric {
            g[2][2] = v(x)[0] / x[0];
        }
        let [xx, yy, zz, xy, yz, xz] = stress.at(p)[..] else { return f64::NAN };
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        volume.values[p] * (0..3).map(|i| dot(rows[i], g[i])).sum::<f64>()
    };
    [outer, (0..volume.count()).map(inner).sum()]
}

#[test]
fn reported_stress_does_the_work_of_reported_forces() {
    use {Formulation::*, Integration::*};
    for space in Space::ALL {
        let options = if space == Space::Solid {
            [(Standard, Full), (FBar, Full)]
        } else {
            [(Standard, Full), (Standard, Reduced)]
        };
        for ((formulation, integration), strain) in
            options.into_iter().flat_map(|o| [(o, Strain::Finite), (o, Strain::Small)])
        {
            let options = BodyOptions { formulation, integration, strain, ..BodyOptions::default() };
            let (frame, mesh) = frame(space, options);
            let dimension = space.dimension();
            for (i, j) in (0..dimension).flat_map(|i| (0..dimension).map(move |j| (i, j))) {
                let mut gradient = [[0.0; 3]; 3];
                gradient[i][j] = 1.0;
                let [outer, inner] = works(&frame, &mesh, (space, strain), gradient);
                let size = outer.abs().max(1.0);
                assert!((outer - inner).abs() < 1e-11 * size, "{space:?} {options:?} {i}{j}: {outer} {inner}");
            }
        }
    }
}

#[test]
fn the_frame_is_whole() {
    let (frame, mesh) =
        frame(Space::PlaneStress, BodyOptions { integration: Integration::Reduced, ..BodyOptions::default() });
    assert_eq!((frame.step, frame.increment, frame.time), (1, 1, 1.0));
    assert_eq!(frame.count(QuantityPlace::Node), Some(mesh.points.len()));
    assert_eq!(frame.count(QuantityPlace::Gauss), Some(4 * mesh.cell_count()));
    let stress = frame.get(QuantityPlace::Node, "cauchy_stress_averaged").unwrap();
    assert!(stress.values.iter().all(|x| x.is_finite()));
    assert!(stress.values.iter().skip(2).step_by(6).all(|zz| zz.abs() < 1e-9), "no stress across the plane");
    let reaction = frame.get(QuantityPlace::Global, "reaction.all").unwrap();
    assert!(reaction.values.iter().all(|f| f.abs() < 1e-10), "stress alone moves nothing as a whole");
    let strain = frame.get(QuantityPlace::Global, "energy.strain").unwrap().values[0];
    let missing = frame.get(QuantityPlace::Global, "energy.missing").unwrap().values[0];
    assert!(strain > 0.0 && missing == -strain, "no work was said to come from outside");
}
