//! Orders of the schemes, measured for every law of the registry on a path whose direction turns from the stress.

use super::samples::samples;
use asperity::Failure;
use asperity::integrate::{Scheme, Update};
use asperity::material::Material;
use asperity::tensor::Tensor2;

/// Stress after a stretch to yield and then a large shear in one increment, with a mean stress in tension throughout: voids
/// nucleate from its first sign on.
fn stress(material: &dyn Material, update: Update) -> Result<Tensor2, Failure> {
    let law = material.with_update(update).unwrap();
    let mut state = vec![0.0; law.state_len()];
    law.initialise(&mut state);
    let mut stretch = Tensor2::identity() * 0.995;
    stretch[(0, 0)] = 1.0105;
    let mut new = state.clone();
    material.update(&stretch, 1e-3.into(), &state, &mut new).unwrap();
    let mut shear = Tensor2::identity();
    (shear[(0, 1)], shear[(1, 0)], shear[(1, 1)]) = (0.01, 0.01, 1.002);
    let mut end = new.clone();
    law.update(&shear, 1e-3.into(), &new, &mut end)?;
    Ok(super::samples::stress(&end))
}

/// The same in so many sub-steps.
fn by(material: &dyn Material, scheme: Scheme, substeps: usize) -> Tensor2 {
    stress(material, Update { scheme, substeps, tolerance: None }).unwrap()
}

/// What the guide says of the schemes of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Claim {
    /// Two-step and midpoint are of second order.
    Second,
    /// So they are until the stress comes to an edge of the surface, or to a corner of the curve.
    Kinks,
    /// Two-step is, once a sub-step is short beside the strain over which the stress follows a change of the rate; the
    /// midpoint rule is refused.
    Stiff,
    /// Nothing is integrated.
    Closed,
}

/// Every law of the registry has a line here, or the test fails.
fn claim(law: &str) -> Claim {
    match law {
        "neo_hookean_compressible"
        | "saint_venant_kirchhoff"
        | "neo_hookean"
        | "ogden"
        | "mooney_rivlin"
        | "yeoh"
        | "arruda_boyce" => Claim::Closed,
        "mohr_coulomb"
        | "drucker_prager_cap"
        | "mohr_coulomb_hardening"
        | "ubiquitous_joint"
        | "von_mises_table"
        | "gurson_table"
        | "hill_table" => Claim::Kinks,
        "von_mises_johnson_cook" | "gurson_johnson_cook" | "hill_johnson_cook" => Claim::Stiff,
        "elastic"
        | "orthotropic"
        | "anisotropic"
        | "von_mises"
        | "von_mises_swift"
        | "perzyna"
        | "norton_hoff"
        | "drucker_prager"
        | "drucker_prager_inner"
        | "drucker_prager_plane_strain"
        | "drucker_prager_hardening"
        | "modified_cam_clay"
        | "modified_cam_clay_constant_shear"
        | "gurson"
        | "gurson_swift"
        | "chaboche"
        | "hill"
        | "hill_swift"
        | "hill_coefficients" => Claim::Second,
        other => panic!("say in this test and in the guide what the schemes of `{other}` are worth"),
    }
}

const MIDPOINT: Update = Update { scheme: Scheme::Midpoint(0.5), substeps: 1, tolerance: None };

fn served(law: &str, scheme: Scheme) -> bool {
    claim(law) != Claim::Stiff || scheme != Scheme::Midpoint(0.5)
}

/// What a scheme of a law is worth.
pub struct Order {
    /// Name of the sample.
    pub name: String,
    pub law: &'static str,
    pub scheme: Scheme,
    /// The mean order over five halvings; none where the error is that of rounding.
    pub found: Option<f64>,
    /// What the guide claims, in so many halvings.
    pub least: f64,
}

/// Orders of the schemes of every law of the registry.
pub fn orders() -> Vec<Order> {
    let mut orders = Vec::new();
    for sample in samples().iter().filter(|sample| claim(sample.law) != Claim::Closed) {
        let material = sample.material.as_ref();
        let exact = by(material, Scheme::TwoStep, 8192);
        let second = if claim(sample.law) == Claim::Second { 1.9 } else { 0.85 };
        let schemes = [(Scheme::BackwardEuler, 0.85), (Scheme::TwoStep, second), (Scheme::Midpoint(0.5), second)];
        for (scheme, least) in schemes.into_iter().filter(|(scheme, _)| served(sample.law, *scheme)) {
            let error = |substeps| {
                let e = by(material, scheme, substeps) - exact;
                (e.contract(e) / exact.contract(exact)).sqrt()
            };
            let (first, last) = (error(32), error(1024));
            let found = (first >= 1e-11).then(|| (first / last).log2() / 5.0);
            orders.push(Order { name: sample.name.clone(), law: sample.law, scheme, found, least });
        }
    }
    orders
}

/// Errors fall with the order of the scheme, for every law of the registry.
#[test]
fn errors_fall_with_the_order_of_the_scheme() {
    for Order { name, law, scheme, found, least } in orders() {
        assert!(found.is_none_or(|order| order > least), "{law}, {name}: {scheme:?} has the order {found:?}");
    }
}

/// Stress after a path that begins where the law flows, compacted, and that is too short to meet an edge or a corner.
fn without_kinks(material: &dyn Material, compacted: f64, update: Update) -> Result<Tensor2, Failure> {
    let fine = Update { scheme: Scheme::TwoStep, substeps: 256, tolerance: None };
    let mut state = super::samples::initial(material);
    let shear = |xy: f64, yz: f64| {
        let mut f = Tensor2::identity();
        (f[(0, 1)], f[(1, 0)], f[(1, 1)], f[(1, 2)], f[(2, 1)]) = (xy, xy, 1.0 + 0.2 * xy, yz, yz);
        f
    };
    let mut stretch = Tensor2::identity() * (0.995 - compacted);
    stretch[(0, 0)] = 1.0105 - compacted;
    for (f, update) in [(stretch, fine), (shear(0.004, 0.0), fine), (shear(0.001, 0.001), update)] {
        let (law, old) = (material.with_update(update).unwrap(), state.clone());
        law.update(&f, 1e-3.into(), &old, &mut state)?;
    }
    Ok(super::samples::stress(&state))
}

/// Where no edge and no corner lies on the path, every law but the stiff ones has the order of the scheme; the returns of matrix and
/// joints alternate, which is of the first.
#[test]
fn without_kinks_the_order_is_the_second() {
    let mut short = Vec::new();
    let smooth = |law: &str| law != "ubiquitous_joint" && matches!(claim(law), Claim::Second | Claim::Kinks);
    for sample in samples().iter().filter(|sample| smooth(sample.law)) {
        for scheme in [Scheme::TwoStep, Scheme::Midpoint(0.5)] {
            let by = |substeps| {
                without_kinks(sample.material.as_ref(), 0.008, Update { scheme, substeps, tolerance: None }).unwrap()
            };
            let exact = by(4096);
            let error = |substeps| {
                let e = by(substeps) - exact;
                (e.contract(e) / exact.contract(exact)).sqrt()
            };
            let (first, last) = (error(4), error(64));
            let order = (first / last).log2() / 4.0;
            eprintln!("| {} | {scheme:?} | {first:.1e} | {order:.2} |", sample.name);
            if first >= 1e-11 && order < 1.9 {
                short.push(format!("{}: {scheme:?} has the order {order:.2}", sample.name));
            }
        }
    }
    assert!(short.is_empty(), "{short:#?}");
}

#[test]
fn the_midpoint_rule_is_refused_where_the_law_is_stiff() {
    for sample in samples().iter().filter(|sample| claim(sample.law) == Claim::Stiff) {
        let refused = sample.material.with_update(MIDPOINT).is_err_and(|why| why.contains("does not serve"));
        assert!(refused, "{}", sample.name);
    }
}

/// The error at the end of the increment is at most the tolerance, by every scheme.
#[test]
fn errors_are_within_the_tolerance() {
    for sample in samples().iter().filter(|sample| claim(sample.law) != Claim::Closed) {
        let material = sample.material.as_ref();
        let exact = by(material, Scheme::TwoStep, 8192);
        let schemes = [
            (Scheme::BackwardEuler, &[1e-1, 1e-2][..]),
            (Scheme::TwoStep, &[1e-2, 1e-3, 1e-4, 1e-5]),
            (Scheme::Midpoint(0.5), &[1e-2, 1e-3, 1e-4, 1e-5]),
        ];
        for (scheme, tolerances) in schemes.into_iter().filter(|(scheme, _)| served(sample.law, *scheme)) {
            for &tolerance in tolerances {
                let kept = stress(material, Update { scheme, substeps: 1, tolerance: Some(tolerance) });
                // Where the stress goes along an edge all sub-steps are of first order, and too many would be needed.
                if matches!(claim(sample.law), Claim::Kinks | Claim::Stiff)
                    && kept.as_ref().is_err_and(|e| e.reason.contains("keep"))
                {
                    continue;
                }
                let e = kept.unwrap() - exact;
                let error = (e.contract(e) / exact.contract(exact)).sqrt();
                eprintln!("| {} | {scheme:?} | {tolerance:.0e} | {error:.1e} |", sample.name);
                assert!(error <= tolerance, "{}: {scheme:?} leaves {error:.1e} of {tolerance:.0e}", sample.name);
            }
        }
    }
}

#[test]
fn what_has_nothing_to_integrate_is_refused() {
    for sample in samples().iter().filter(|sample| claim(sample.law) == Claim::Closed) {
        assert!(sample.material.with_update(Update::default()).is_err(), "{}", sample.name);
    }
}

/// What one step of each law is wrong by along a path in ten increments of an even rate, over the stress, against 64 sub-steps each:
/// where it is more than a hundredth the law takes sub-steps by itself, and keeps it.
#[test]
fn what_a_law_takes_by_itself_keeps_a_hundredth() {
    let mut worse = Vec::new();
    // Ten increments to a hundredth, and to a tenth.
    for strain in [1e-3, 1e-2] {
        for sample in samples().iter().filter(|sample| claim(sample.law) != Claim::Closed) {
            let material = sample.material.as_ref();
            let end = |update: Option<Update>| {
                let law = update.map(|update| material.with_update(update).unwrap());
                let law = law.as_deref().unwrap_or(material);
                let (mut old, mut f) = (super::samples::initial(law), Tensor2::identity() * (1.0 - 0.5 * strain));
                f[(0, 0)] = 1.0 + strain;
                for _ in 0..10 {
                    let mut new = old.clone();
                    law.update(&f, 1e-3.into(), &old, &mut new).ok()?;
                    old = new;
                }
                Some(super::samples::stress(&old))
            };
            let fine = Update { scheme: Scheme::TwoStep, substeps: 64, tolerance: None };
            let (Some(exact), Some(one), Some(own)) = (end(Some(fine)), end(None), end(material.own_update())) else {
                worse.push(format!("{}: no stress at {strain}", sample.name));
                continue;
            };
            let off = |stress: Tensor2| {
                let e = stress - exact;
                (e.contract(e) / exact.contract(exact)).sqrt()
            };
            if off(own) >= 1e-2 {
                worse.push(format!("{} at {strain}: {:.1e}, one step {:.1e}", sample.name, off(own), off(one)));
            }
        }
    }
    assert!(worse.is_empty(), "{worse:#?}");
}

/// The tangent of the adaptive scheme is that of its stress, wherever the sizes of its parts change.
#[test]
fn the_adaptive_tangent_is_exact() {
    use asperity::material::Directions;
    for sample in samples().iter().filter(|sample| sample.material.own_update().is_some()) {
        let law = sample.material.with_update(Update::ADAPTIVE).unwrap();
        let start = super::samples::initial(law.as_ref());
        let mut worst = 0.0_f64;
        for i in 0..200 {
            let stress = |shear: f64| {
                let (mut f, mut new) = (Tensor2::identity() * 0.9995, start.clone());
                (f[(0, 0)], f[(0, 1)]) = (1.001 + 2e-5 * f64::from(i), shear);
                let gradient = law.update_with_gradient(&f, 1e-3.into(), &start, &mut new, Directions::Space).unwrap();
                (super::samples::stress(&new), gradient)
            };
            let (h, (_, gradient)) = (1e-7, stress(2e-3));
            let difference = (stress(2e-3 + h).0 - stress(2e-3 - h).0).to_voigt().map(|s| s / (2.0 * h));
            let size = gradient.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
            (0..6).for_each(|k| worst = worst.max((difference[k] - gradient[k][1]).abs() / size));
        }
        eprintln!("| {} | {worst:.1e} |", sample.name);
        assert!(worst < 1e-4, "{}: {worst:.1e}", sample.name);
    }
}
