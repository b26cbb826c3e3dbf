//! Laws of interfaces at one point, driven as `asperity point` drives them, against closed forms.

mod cycle;
mod slider;

use crate::bench::{Bench, read};
use crate::{Case, Measured};
use asperity::Error;
use asperity::deck::read_interface;
use asperity::point::Record;

/// The case.
pub const CASE: Case = Case { name: "interface", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let parts = [constant_stiffness(bench)?, shear_limits(bench)?, uniqueness(bench)?, velocity_step(bench)?];
    Ok(parts.into_iter().flatten().chain(slider::measure()?).collect())
}

/// The records of a deck of the case with some of its values set.
fn driven(bench: &Bench, deck: &str, sets: &[&str]) -> Result<Vec<Record>, Error> {
    run(&read(&bench.folder().join(deck))?, deck, sets)
}

fn run(text: &str, name: &str, sets: &[&str]) -> Result<Vec<Record>, Error> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    read_interface(text, name, &sets).map_err(|found| Error::input(found.render(false)))?.run()
}

/// A column of the record of an interface.
fn column(records: &[Record], interface: &str, name: &str) -> Result<Vec<f64>, Error> {
    let record = records.iter().find(|record| record.name == interface);
    let lacks = || Error::input(format!("there is no column '{name}' of an interface '{interface}'"));
    record.and_then(|record| record.column(name)).ok_or_else(lacks)
}

/// A value of `y` between those of its records, where `x` is `at`.
fn at(records: &[Record], interface: &str, (x, at): (&str, f64), y: &str) -> Result<f64, Error> {
    let (x, y) = (column(records, interface, x)?, column(records, interface, y)?);
    let behind = (1..x.len()).find(|&i| x[i - 1] < at && at <= x[i] * (1.0 + 1e-12));
    let i = behind.ok_or_else(|| Error::input(format!("'{interface}' does not come to {at}")))?;
    Ok(y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]))
}

/// Behind a wall of stiffness k: `p = p_0 + k_e psi_0 s_c (1 - exp(-s / s_c))`, `tau = phi p + c`, `1/k_e = 1/k + 1/K_p`.
fn constant_stiffness(bench: &Bench) -> Result<Measured, Error> {
    let records = driven(bench, "dilatant.toml", &[])?;
    let of = |name| column(&records, "joint", name);
    let (p, tau, s) = (of("pressure")?, of("shear")?, of("slip_path")?);
    let stiffness = 1.0 / (1.0 / 2e4 + 1.0 / 1e6);
    let worst = (2..p.len()).map(|i| {
        let exact = 100.0 + stiffness * 0.3 * 2e-3 * (1.0 - (-s[i] / 2e-3).exp());
        (p[i] / exact - 1.0).abs().max((tau[i] / (0.6 * exact + 10.0) - 1.0).abs())
    });
    let dilation = of("dilation")?.last().copied().unwrap_or(f64::NAN);
    Ok(vec![("cns".into(), worst.fold(0.0, f64::max)), ("dilation".into(), dilation / (0.3 * 2e-3))])
}

/// Shear stress at the pressures 200 and 500 with friction 0.3 and the strength 100.
fn shear_limits(bench: &Bench) -> Result<Measured, Error> {
    let records = driven(bench, "shear_limited.toml", &["step.2.increments=490"])?;
    let mut measured = Vec::new();
    for interface in ["orowan", "smooth", "shaw"] {
        for pressure in [200.0, 500.0] {
            measured
                .push((format!("{interface}_{pressure}"), at(&records, interface, ("pressure", pressure), "shear")?));
        }
    }
    Ok(measured)
}

/// Friction that falls with velocity, in long and in short increments: the largest departure from the friction of the
/// velocity, which it follows with its delay. Friction that falls with slip faster than the penalty follows is refused.
fn uniqueness(bench: &Bench) -> Result<Measured, Error> {
    let mut worst = 0.0_f64;
    for increments in [10, 100, 20_000] {
        let sets = [2, 3, 4].map(|step| format!("step.{step}.increments={increments}"));
        let records = driven(bench, "velocity.toml", &sets.each_ref().map(String::as_str))?;
        for (time, velocity) in [(2.0, 0.05_f64), (3.0, 0.1), (4.0, 0.4)] {
            let exact = 20.0 + 10.0 * (-velocity / 0.1).exp();
            worst = worst.max((at(&records, "brake", ("time", time), "shear")? / exact - 1.0).abs());
        }
    }
    let named = match driven(bench, "decay.toml", &["penalty=1.5e3"]) {
        Err(Error::NotConverged(why)) => f64::from(why.contains("stick-slip, the slip is not unique")),
        _ => f64::NAN,
    };
    Ok(vec![("falling".into(), worst), ("stick_slip".into(), named)])
}

/// To ten times the velocity, without a spring: the largest departure of friction from the closed forms over slips of
/// half to five times `D_c`, the direct effect and the steady end.
fn velocity_step(bench: &Bench) -> Result<Measured, Error> {
    let records = driven(bench, "rate_and_state.toml", &["step.3.increments=2000"])?;
    let friction = |law: &str, d: f64| Ok::<f64, Error>(at(&records, law, ("slip", 1e-4 + d * 1e-5), "shear")? / 1e7);
    let exact = |law: &str, d: f64| match law {
        "ageing" => 0.6 + 0.01 * 10_f64.ln() + 0.015 * (0.1 + 0.9 * (-d).exp()).ln(),
        _ => 0.6 - 0.005 * 10_f64.ln() + 0.015 * 10_f64.ln() * (-d).exp(),
    };
    let mut measured = Vec::new();
    for law in ["ageing", "slip"] {
        let mut worst = 0.0_f64;
        for d in [0.5, 1.0, 2.0, 5.0] {
            worst = worst.max((friction(law, d)? / exact(law, d) - 1.0).abs());
        }
        measured.push((format!("step_{law}"), worst));
        measured.push((format!("at_distance_{law}"), friction(law, 1.0)?));
        measured.push((format!("steady_{law}"), friction(law, 9.99)?));
    }
    let shear = column(&records, "ageing", "shear")?;
    measured.push(("direct".into(), shear.iter().fold(0.0_f64, |most, &tau| most.max(tau)) / 1e7));
    Ok(measured)
}
