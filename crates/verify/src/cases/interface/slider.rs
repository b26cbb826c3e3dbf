//! The spring slider with rate-and-state friction, whose spring is the tangential penalty: pressure 10 MPa, a = 0.010,
//! b = 0.015, D_c = 1e-5 m, V_0 = 1e-6 m/s, critical stiffness p (b - a) / D_c = 5e9 Pa/m.
//!
//! Linearised about steady slip (Ruina 1983) the critical spring oscillates with the period
//! `2 pi (D_c / V) sqrt(a / (b - a))`, for both laws of the state; a softer one grows, a stiffer one decays. Two runs are
//! extrapolated to increments of no length. With half of the critical spring and radiation damping the slider sticks and
//! slips: the period of its jumps, by 20 000 increments and the default scheme, against the [equation](super::cycle).

use super::cycle::Slider;
use super::{column, run};
use crate::Measured;
use asperity::Error;

/// Stiffness of the critical spring.
const CRITICAL: f64 = 5e9;

pub fn measure() -> Result<Measured, Error> {
    let mut measured = Vec::new();
    for (law, name) in [("rate_and_state", "ageing"), ("rate_and_state_slip", "slip")] {
        let [period, growth] = extrapolated(|increments| swing(law, CRITICAL, increments), 16_000)?;
        measured.push((format!("period_{name}"), period));
        measured.push((format!("growth_{name}"), growth));
        for times in [2.0, 10.0, 100.0] {
            let [peak] = extrapolated(|increments| Ok([peak(law, times * CRITICAL, increments)?]), 10_000)?;
            measured.push((format!("peak_{name}_{times}"), peak));
        }
    }
    for (law, name) in [("rate_and_state", "ageing"), ("rate_and_state_slip", "slip")] {
        measured.push((format!("cycle_{name}"), cycle(law)?));
    }
    for (name, stiffness) in [("softer", 4.8e9), ("stiffer", 5.2e9)] {
        let [_, growth] = swing("rate_and_state", stiffness, 8_000)?;
        measured.push((name.into(), growth));
    }
    Ok(measured)
}

/// What two runs with so many and twice as many increments lead to.
fn extrapolated<const N: usize>(
    measure: impl Fn(usize) -> Result<[f64; N], Error>,
    increments: usize,
) -> Result<[f64; N], Error> {
    let (coarse, fine) = (measure(increments)?, measure(2 * increments)?);
    Ok(std::array::from_fn(|i| 2.0 * fine[i] - coarse[i]))
}

/// Time and shear of a slider whose spring first takes up the steady stress of a slip at V_0, in one short step, so that
/// the state stays, and whose other end then moves by `reach` beyond in the time given.
fn slide(law: &str, stiffness: f64, (time, reach): (f64, f64), increments: usize) -> Result<[Vec<f64>; 2], Error> {
    let gouge = "friction = 0.6, direct = 0.010, evolution = 0.015, distance = 1e-5, velocity = 1e-6";
    let up = 6e6 / stiffness + 1e-12;
    let text = format!(
        "version = 1\npenalty = 1e12\ntangential_penalty = {stiffness}\ninterface.fault.{law} = {{ {gouge} }}\n\
         [[step]]\nduration = 1e-6\nincrements = 1\npressure = 1e7\nslip = [{up}, 0.0]\n\
         [[step]]\nduration = {time}\nincrements = {increments}\nslip = [{end}, 0.0]\n",
        end = up + reach,
    );
    let records = run(&text, "slider.toml", &[])?;
    Ok([column(&records, "fault", "time")?, column(&records, "fault", "shear")?])
}

/// The period of the oscillation about steady slip over that of theory, and the growth from one swing to the next, after
/// a little more than V_0 for a start.
fn swing(law: &str, stiffness: f64, increments: usize) -> Result<[f64; 2], Error> {
    let reach = 1e3 / stiffness + 4e-4;
    let [time, shear] = slide(law, stiffness, (400.0, reach), increments)?;
    let steady = 1e7 * (0.6 + (0.010 - 0.015) * (reach / 4e-4).ln());
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
    let (&[_, from, _, to, ..], &[_, before, after, ..]) = (&crossings[..], &peaks[..]) else {
        return Ok([f64::NAN; 2]);
    };
    let period = std::f64::consts::TAU * 10.0 * (0.010_f64 / 0.005).sqrt();
    Ok([(to - from) / (2.0 * period), after / before])
}

/// The period of stick-slip in 20 000 increments over that of the differential equation.
fn cycle(law: &str) -> Result<f64, Error> {
    let (stiffness, damping, time) = (0.5 * CRITICAL, 5e6, 2000.0);
    let gouge = format!(
        "friction = 0.6, direct = 0.010, evolution = 0.015, distance = 1e-5, velocity = 1e-6, damping = {damping}"
    );
    let up = 6e6 / stiffness + 1e-9;
    let text = format!(
        "version = 1\npenalty = 1e12\ntangential_penalty = {stiffness}\ninterface.fault.{law} = {{ {gouge} }}\n\
         [[step]]\nduration = 1e-6\nincrements = 1\npressure = 1e7\nslip = [{up}, 0.0]\n\
         [[step]]\nduration = {time}\nincrements = 20000\nslip = [{end}, 0.0]\n",
        end = up + 1e-6 * time,
    );
    let records = run(&text, "slider.toml", &[])?;
    let [time, shear] = [column(&records, "fault", "time")?, column(&records, "fault", "shear")?];
    // What every jump falls through.
    let level = 5.9e6;
    let falls = (2..time.len()).filter(|&i| shear[i - 1] > level && shear[i] <= level);
    let at = |i: usize| time[i - 1] + (time[i] - time[i - 1]) * (shear[i - 1] - level) / (shear[i - 1] - shear[i]);
    let jumps: Vec<f64> = falls.map(at).collect();
    let [.., before, last] = jumps[..] else { return Ok(f64::NAN) };
    let equation = Slider {
        pressure: 1e7,
        friction: 0.6,
        direct: 0.010,
        evolution: 0.015,
        distance: 1e-5,
        velocity: 1e-6,
        stiffness,
        damping,
        ageing: law == "rate_and_state",
    };
    Ok((last - before) / equation.period(2000.0))
}

/// Peak of the friction when the other end goes on ten times as fast; softer springs would slip at once thereafter.
fn peak(law: &str, stiffness: f64, increments: usize) -> Result<f64, Error> {
    let [_, shear] = slide(law, stiffness, (2.2, 2.2e-5), increments)?;
    Ok(shear.iter().fold(0.0_f64, |most, &tau| most.max(tau)) / 1e7)
}
