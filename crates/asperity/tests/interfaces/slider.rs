//! The spring slider with rate-and-state friction, whose spring is the tangential penalty: pressure 10 MPa, a = 0.010,
//! b = 0.015, D_c = 1e-5 m, V_0 = 1e-6 m/s, critical stiffness p (b - a) / D_c = 5e9 Pa/m.
//!
//! Linearised about steady slip (Ruina 1983) the critical spring oscillates with the period
//! `2 pi (D_c / V) sqrt(a / (b - a))`, for both laws of the state; a softer one grows, a stiffer one decays.

use asperity::deck::read_interface;

/// Times at which the shear stress passes its steady value upwards after a small velocity step, and its largest
/// deviation after each.
fn oscillation(law: &str, stiffness: f64, increments: usize) -> (Vec<f64>, Vec<f64>) {
    let gouge = "friction = 0.6, direct = 0.010, evolution = 0.015, distance = 1e-5, velocity = 1e-6";
    // The spring first takes up the steady stress of a slip at V_0 in one short step, so that the state stays.
    let text = format!(
        "version = 1\npenalty = 1e12\ntangential_penalty = {stiffness}\ninterface.fault.{law} = {{ {gouge} }}\n\
         [[step]]\nduration = 1e-6\nincrements = 1\npressure = 1e7\nslip = [{up}, 0.0]\n\
         [[step]]\nduration = 400.0\nincrements = {increments}\nslip = [{end}, 0.0]\n",
        up = 6e6 / stiffness + 1e-12,
        end = 6.001e6 / stiffness + 4e-4,
    );
    let loaded = read_interface(&text, "slider.toml", &[]).unwrap_or_else(|d| panic!("{}", d.render(false)));
    let records = loaded.run().unwrap();
    let [time, shear] = ["time", "shear"].map(|name| records[0].column(name).unwrap());
    let steady = 1e7 * (0.6 + (0.010 - 0.015) * ((6.001e6 - 6e6) / stiffness / 4e-4 + 1.0_f64).ln());
    let (mut crossings, mut peaks) = (Vec::new(), Vec::new());
    for i in 2..time.len() {
        let (a, b) = (shear[i - 1] - steady, shear[i] - steady);
        if a < 0.0 && b >= 0.0 {
            crossings.push(time[i - 1] - a * (time[i] - time[i - 1]) / (b - a));
            peaks.push(0.0_f64);
        }
        if let Some(peak) = peaks.last_mut() {
            *peak = peak.max(b.abs());
        }
    }
    (crossings, peaks)
}

#[test]
fn the_critical_spring_oscillates_with_its_period() {
    let period = std::f64::consts::TAU * 10.0 * (0.010_f64 / 0.005).sqrt();
    for law in ["rate_and_state", "rate_and_state_slip"] {
        let measured = |increments| {
            let (times, peaks) = oscillation(law, 5e9, increments);
            assert!(times.len() >= 4, "{times:?}");
            ((times[3] - times[1]) / 2.0, peaks[2] / peaks[1])
        };
        let [coarse, fine] = [measured(16_000), measured(32_000)];
        // Backward Euler damps with the first order of the increment: extrapolated to none.
        let growth = 2.0 * fine.1 - coarse.1;
        eprintln!("{law}: period {} of {period}, {growth} from swing to swing", fine.0);
        assert!((fine.0 / period - 1.0).abs() < 1e-3, "{law}: {} of {period}", fine.0);
        assert!((growth - 1.0).abs() < 1e-3, "{law}: {growth}");
    }
}

#[test]
fn softer_springs_swing_up_and_stiffer_ones_down() {
    let growth = |stiffness| {
        let (_, peaks) = oscillation("rate_and_state", stiffness, 8_000);
        peaks[2] / peaks[1]
    };
    assert!(growth(4.8e9) > 1.05, "{}", growth(4.8e9));
    assert!(growth(5.2e9) < 0.95, "{}", growth(5.2e9));
}
