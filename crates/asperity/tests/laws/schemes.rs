//! Orders of the schemes, measured on a path whose direction turns from the stress.

use super::samples::samples;
use asperity::integrate::{Scheme, Update};
use asperity::material::Material;
use asperity::tensor::Tensor2;

/// Stress after a stretch to yield and then a large shear in one increment.
fn stress(material: &dyn Material, scheme: Scheme, substeps: usize) -> Tensor2 {
    let law = material.with_update(Update { scheme, substeps, tolerance: None }).unwrap();
    let mut state = vec![0.0; law.state_len()];
    law.initialise(&mut state);
    let mut stretch = Tensor2::identity() * 0.995;
    stretch[(0, 0)] = 1.01;
    let mut new = state.clone();
    material.update(&stretch, 1e-3, &state, &mut new).unwrap();
    let mut shear = Tensor2::identity();
    (shear[(0, 1)], shear[(1, 0)], shear[(1, 1)]) = (0.01, 0.01, 1.002);
    let mut end = new.clone();
    law.update(&shear, 1e-3, &new, &mut end).unwrap();
    super::samples::stress(&end)
}

/// Errors fall with the order of the scheme: the mean order over six halvings.
#[test]
fn errors_fall_with_the_order_of_the_scheme() {
    let smooth = ["von_mises", "von_mises_swift", "perzyna", "norton_hoff", "drucker_prager"];
    for sample in samples().iter().filter(|sample| smooth.contains(&sample.law)) {
        let material = sample.material.as_ref();
        let exact = stress(material, Scheme::TwoStep, 8192);
        for (scheme, order) in [(Scheme::BackwardEuler, 1.0), (Scheme::TwoStep, 2.0), (Scheme::Midpoint(0.5), 2.0)] {
            let error = |substeps| {
                let e = stress(material, scheme, substeps) - exact;
                e.contract(e).sqrt()
            };
            let measured = (error(16) / error(1024)).log2() / 6.0;
            eprintln!("{}: {scheme:?} order {measured:.2}, error {:.1e}", sample.name, error(1024));
            assert!(measured > order - 0.15, "{}: {scheme:?} has the order {measured}", sample.name);
        }
    }
}
