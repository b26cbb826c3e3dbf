//! Single returns and steady states against their closed forms, law by law without the driver.

use super::samples::initial;
use asperity::declare::find;
use asperity::integrate::{Scheme, Update};
use asperity::material::laws::ALL;
use asperity::material::{Lapse, Material};
use asperity::tensor::Tensor2;

fn law(name: &str, values: &[f64]) -> Box<dyn Material> {
    (find(ALL, name).unwrap().build)(values).unwrap()
}

/// The state after a stress from outside, held for a time.
fn after(material: &dyn Material, stress: [f64; 6], dt: f64) -> Vec<f64> {
    let mut old = vec![0.0; material.state_len()];
    material.initialise(&mut old);
    old[..6].copy_from_slice(&stress);
    let mut new = old.clone();
    material.update(&Tensor2::identity(), dt.into(), &old, &mut new).unwrap();
    new
}

/// Mean stress and `sqrt(J2)`.
fn invariants(state: &[f64]) -> [f64; 2] {
    let stress = Tensor2::from_voigt(std::array::from_fn(|i| state[i]));
    let s = stress.deviator();
    [stress.trace() / 3.0, (0.5 * s.contract(s)).sqrt()]
}

#[track_caller]
fn near(found: f64, wanted: f64, digit: f64) {
    assert!((found - wanted).abs() <= digit, "{found} instead of {wanted}");
}

/// One step from an equivalent stress of 1000 over a yield stress of 700: `dp = (1000 - 700)/(3 G + 700/(gamma dt))`.
#[test]
fn overstress_of_perzyna() {
    let steel = law("perzyna", &[200e3, 0.3, 700.0, 0.0, 1.0, 1.0]);
    let state = after(steel.as_ref(), [1000.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-3);
    near(state[6], 3.22314e-4, 5e-10);
    near(3.0_f64.sqrt() * invariants(&state)[1], 925.620, 5e-4);
}

/// At the rate 1 the equivalent stress over the consistency is `sqrt(3)^(m + 1)`.
#[test]
fn factors_of_norton_and_hoff() {
    for (m, factor) in [(0.1, 1.82986), (0.2, 1.93318), (1.0, 3.0)] {
        let metal = law("norton_hoff", &[1e6, 0.3, 100.0, m]);
        let mut old = vec![0.0; metal.state_len()];
        let (dt, mut f) = (1e-3_f64, Tensor2::identity());
        // The strain of the frame is 2 tanh(e/2).
        [dt, -0.5 * dt, -0.5 * dt].iter().enumerate().for_each(|(i, e)| f[(i, i)] = e.exp());
        for _ in 0..100 {
            let mut new = old.clone();
            metal.update(&f, dt.into(), &old, &mut new).unwrap();
            old = new;
        }
        near(3.0_f64.sqrt() * invariants(&old)[1] / 100.0, factor, 1e-5);
    }
}

/// Returns to the cone and to the apex, `G = 1000`, `K = 2000`, friction 30 degrees, cohesion 10: `dl = f/(G + K eta
/// eta_b)` takes `K eta_b dl` from the mean stress and `G dl` from the root of J2. With dilatancy 10 the matched cone has
/// `eta_b = 0.172782`, `eta = 0.488370`; with associated flow both are `sqrt(3/13)`.
#[test]
fn returns_of_drucker_and_prager() {
    let (young, poisson) = (9.0 * 2e6 / 7e3, 4.0 / 14.0);
    let soil = |dilatancy| law("drucker_prager_plane_strain", &[young, poisson, 10.0, 30.0, dilatancy]);
    let returned =
        |dilatancy, [p, root]: [f64; 2]| after(soil(dilatancy).as_ref(), [p + root, p - root, p, 0.0, 0.0, 0.0], 0.0);
    for (dilatancy, trial, [p, root]) in [
        (10.0, [-20.0, 60.0], [-32.35107, 24.25823]),
        (10.0, [5.0, 40.0], [-5.04763, 10.92398]),
        (30.0, [-20.0, 60.0], [-47.65667, 31.21403]),
    ] {
        let [mean, shear] = invariants(&returned(dilatancy, trial));
        near(mean, p, 6e-6);
        near(shear, root, 6e-6);
    }
    let apex = returned(10.0, [60.0, 5.0]);
    near(invariants(&apex)[0], 17.3205, 5e-5);
    near(invariants(&apex)[1], 0.0, 1e-12);
    near(apex[7], 0.0213397, 5e-8);
}

/// The hydrostatic strength of a porous metal, `p/sy = 2/(3 q2) acosh((1 + q3 f^2)/(2 q1 f))`, which is `-2/3 ln f` where all
/// `q` are one. So stiff that the porosity stays what it was.
#[test]
fn hydrostatic_strength_of_porous_metals() {
    let strength = |f: f64, [q1, q2, q3]: [f64; 3]| {
        let metal = law("gurson", &[3e9, 0.3, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, f, q1, q2, q3, 0.0, 0.3, 0.1, 0.15, 0.25]);
        let p = 1.2 * 2.0 / 3.0 * ((1.0 + q3 * f * f) / (2.0 * q1 * f)).acosh() / q2;
        invariants(&after(metal.as_ref(), [p, p, p, 0.0, 0.0, 0.0], 1.0))[0]
    };
    for (f, p) in [(0.001, 4.33486), (0.005, 3.26190), (0.01, 2.79980), (0.05, 1.72684), (0.1, 1.26475)] {
        near(strength(f, [1.5, 1.0, 2.25]), p, 6e-6);
        near(strength(f, [1.0; 3]), -2.0 / 3.0 * f.ln(), 1e-6);
    }
}

/// Of stresses that the matrix and the joints refuse together, the return bears both.
#[test]
fn matrix_and_joint_agree() {
    let rock = law("ubiquitous_joint", &[1e3, 0.25, 2.0, 40.0, 0.0, 1.0, 30.0, 0.0, 0.5, 0.6, 0.8, 0.0]);
    for k in 0..200 {
        let at = |i: usize| 30.0 * (1.3 + 7.9 * (6 * k + i) as f64).sin();
        let state = after(rock.as_ref(), std::array::from_fn(at), 0.0);
        let held = after(rock.as_ref(), std::array::from_fn(|i| state[i]), 0.0);
        (0..6).for_each(|i| near(held[i], state[i], 1e-10));
        let n = [0.6, 0.8];
        let t =
            [state[0] * n[0] + state[3] * n[1], state[3] * n[0] + state[1] * n[1], state[5] * n[0] + state[4] * n[1]];
        let normal = t[0] * n[0] + t[1] * n[1];
        let shear = (t.iter().map(|t| t * t).sum::<f64>() - normal * normal).max(0.0).sqrt();
        assert!(normal <= 0.5 + 1e-10 && shear + normal * 30f64.to_radians().tan() <= 1.0 + 1e-10, "{normal} {shear}");
    }
}

/// Stretched, and then sheared while it cools and hardens by it: sub-steps keep their order, and increments alike.
#[test]
fn a_temperature_that_changes_keeps_the_order() {
    let values = [200e3, 0.3, 350.0, 275.0, 0.36, 0.0, 1.0, 0.0, 1000.0, 1.2, 5e3, 20.0];
    let plain = law("von_mises_johnson_cook", &values);
    let mut stretch = Tensor2::identity() * 0.995;
    stretch[(0, 0)] = 1.0105;
    let mut begun = initial(plain.as_ref());
    plain.update(&stretch, Lapse { dt: 1.0, temperature: Some([600.0; 2]) }, &begun.clone(), &mut begun).unwrap();
    let end = |scheme: Scheme, substeps: usize, increments: usize| {
        let law = plain.with_update(Update { scheme, substeps, tolerance: None }).unwrap();
        let (mut state, part) = (begun.clone(), 0.01 / increments as f64);
        let mut shear = Tensor2::identity() * part.cosh();
        (shear[(0, 1)], shear[(1, 0)], shear[(2, 2)]) = (part.sinh(), part.sinh(), 1.0);
        for number in 0..increments {
            let at = |number: usize| 600.0 - 400.0 * number as f64 / increments as f64;
            let lapse = Lapse { dt: 1.0, temperature: Some([at(number), at(number + 1)]) };
            law.update(&shear, lapse, &state.clone(), &mut state).unwrap();
        }
        super::samples::stress(&state)
    };
    for (scheme, least) in [(Scheme::BackwardEuler, 0.9), (Scheme::TwoStep, 1.9), (Scheme::Midpoint(0.5), 1.9)] {
        let order = |of: &dyn Fn(usize) -> Tensor2| {
            let exact = of(8192);
            let error = |n: usize| (of(n) - exact).contract(of(n) - exact).sqrt();
            (error(32) / error(512)).log2() / 4.0
        };
        let (substeps, increments) = (order(&|n| end(scheme, n, 1)), order(&|n| end(scheme, 1, n)));
        assert!(substeps > least && increments > least, "{scheme:?}: {substeps} {increments}");
    }
    let melts = Lapse { dt: 1.0, temperature: Some([990.0, 1000.0]) };
    let reason = plain.update(&stretch, melts, &begun, &mut begun.clone()).unwrap_err().reason;
    assert!(reason.contains("melting"), "{reason}");
}
