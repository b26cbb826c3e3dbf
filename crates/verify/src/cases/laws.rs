//! Laws of solids in structures: ears of a drawn ring, ratchetting, a jump of the rate, relaxation, loops of rubber.

use crate::bench::{Bench, reaction};
use crate::{Case, Measured};
use asperity::Error;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "laws", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for (name, r45) in [("ears_45", 2.0), ("ears_0", 0.5), ("round", 1.0)] {
        let [ears, valleys] = rim(bench, r45)?;
        match name {
            "ears_45" => {
                measured.push((name.into(), ears[1]));
                measured.push(("height_45".into(), ears[0] / valleys[0] - 1.0));
            }
            "ears_0" => measured.push((name.into(), valleys[1])),
            _ => measured.push((name.into(), ears[0] / valleys[0] - 1.0)),
        }
    }
    measured.extend(ratchetting(bench)?);
    measured.extend(published_curve(bench)?);
    let aluminium = ("ratchetting_three.toml", Metal::aluminium(), [520.0, -480.0]);
    let steel = ("ratchetting_steel.toml", Metal::steel(), [34.86, -21.82]);
    measured.extend(three_back_stresses(bench, "", aluminium)?);
    measured.extend(three_back_stresses(bench, "steel_", steel)?);
    for name in ["", "warm_", "heated_"] {
        let [slow, fast] = rate_jump(bench, name)?;
        measured.extend([(format!("{name}slow"), slow), (format!("{name}fast"), fast)]);
    }
    measured.push(("relaxed".into(), relaxation(bench)?));
    let [softened, beyond] = loops(bench)?;
    measured.extend([("softened".into(), softened), ("beyond".into(), beyond)]);
    Ok(measured)
}

/// Largest and least radius of the rim of a drawn ring, each with its angle in degrees at the beginning.
fn rim(bench: &Bench, r45: f64) -> Result<[[f64; 2]; 2], Error> {
    let cells = bench.pick([6, 18], [12, 36]);
    let sets = [format!("material.sheet.hill_swift.r45={r45:?}"), format!("mesh.part.ring.annulus.cells={cells:?}")];
    let ring = bench.solve("earing.toml", &sets)?;
    let mut places: Vec<[f64; 2]> = Vec::new();
    for &node in &ring.model.mesh.groups["ring.outer"].nodes {
        let ([x, y, _], dof) = (ring.model.mesh.points[node].0, ring.model.problem.dofs.node(node));
        let radius = (x + ring.state.u[dof]).hypot(y + ring.state.u[dof + 1]);
        places.push([radius, y.atan2(x).to_degrees()]);
    }
    places.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok([places[places.len() - 1], places[0]])
}

/// Strains that the last cycle leaves at an amplitude of 320 and several mean stresses: what they differ by from those of the closed
/// form `1/gamma ln(((C/gamma)^2 - X_1^2)/((C/gamma)^2 - X_2^2))` with the back stresses `X` at the turns, the most over the largest,
/// and the ratio of both at the mean stress 30.
fn ratchetting(bench: &Bench) -> Result<Measured, Error> {
    let count = bench.pick(60, 240);
    let (mut rates, mut apart, mut ratio) = ([0.0; 2], 0.0_f64, f64::NAN);
    for mean in [0.0, 10.0, 20.0, 30.0, 40.0] {
        let stresses = [mean + 320.0, mean - 320.0];
        let set = |i: usize| {
            let value = -stresses[i % 2];
            [
                format!("step.{}.increments.count={count}", i + 1),
                format!("step.{}.pressure.\"bar.top\".value={value:?}", i + 1),
            ]
        };
        let sets: Vec<String> = (0..6).flat_map(set).collect();
        let mut ends = Vec::new();
        bench.follow("ratchetting.toml", &sets, |model, state| {
            let top = model.problem.dofs.node(model.mesh.groups["bar.top"].nodes[0]) + 1;
            if (state.time - state.time.round()).abs() < 1e-9 {
                ends.push(state.u[top].ln_1p());
            }
        })?;
        let left = |stress: f64| 200.0_f64.powi(2) - (stress.abs() - 200.0).powi(2);
        rates = [ends[4] - ends[2], 0.01 * (left(stresses[1]) / left(stresses[0])).ln()];
        apart = apart.max((rates[0] - rates[1]).abs());
        if mean == 30.0 {
            ratio = rates[0] / rates[1];
        }
    }
    Ok(vec![("ratchetting".into(), ratio), ("ratchetting_rates".into(), apart / rates[1])])
}

/// Four cycles between the stresses 220 and -110: what the strain differs by at any increment from the integral of the law, over the
/// most strain, and the strain that the last cycle left. While `dX = (C - gamma X) dp` the plastic strain is
/// `1/gamma ln((C/gamma - X_0)/(C/gamma - X))` with `X = stress - yield stress`, and the same with the signs turned.
fn published_curve(bench: &Bench) -> Result<Measured, Error> {
    let each = bench.pick(40, 160);
    let sets = [format!("step.1.increments.count={}", 8 * each)];
    let mut strains = Vec::new();
    bench.follow("ratchetting_curve.toml", &sets, |model, state| {
        let top = model.problem.dofs.node(model.mesh.groups["bar.top"].nodes[0]) + 1;
        if state.increment > 0 {
            strains.push(state.u[top].ln_1p());
        }
    })?;
    let (mut back, mut plastic, mut apart, mut most) = (0.0_f64, 0.0, 0.0_f64, 0.0_f64);
    for (leg, strains) in strains.chunks(each).enumerate() {
        let (from, to, sign) = match leg {
            0 => (0.0, 220.0, 1.0),
            leg if leg % 2 == 0 => (-110.0, 220.0, 1.0),
            _ => (220.0, -110.0, -1.0),
        };
        let flow = |stress: f64| {
            let now = (stress - sign * 100.0) * sign;
            ((150.0 - sign * back) / (150.0 - now.max(sign * back))).ln() / 200.0
        };
        for (i, strain) in strains.iter().enumerate() {
            let stress: f64 = from + (to - from) * (i + 1) as f64 / each as f64;
            let exact = stress / 200e3 + plastic + sign * flow(stress);
            (apart, most) = (apart.max((strain - exact).abs()), most.max(exact));
        }
        plastic += sign * flow(to);
        back = to - sign * 100.0;
    }
    let last = |cycles: usize| strains.len().checked_sub(1 + 2 * cycles * each).map_or(f64::NAN, |i| strains[i]);
    Ok(vec![("published_curve".into(), apart / most), ("published_cycle".into(), last(0) - last(1))])
}

/// A metal with three back stresses in uniaxial stress. Between two turns each back stress is an exponential of the plastic strain,
/// so that a path of stresses takes the root of one equation for each of its ends.
struct Metal {
    young: f64,
    yield_stress: f64,
    /// Saturation of the isotropic hardening and its rate.
    isotropic: [f64; 2],
    /// `C` and `gamma` of each back stress.
    kinematic: [[f64; 2]; 3],
    back: [f64; 3],
    /// Plastic strain, and its sum without sign.
    plastic: f64,
    spent: f64,
}

impl Metal {
    /// That of `ratchetting_three.toml`.
    fn aluminium() -> Self {
        let kinematic = [[4735.0, 299.0], [1511.0, 291.0], [1554.0, 22.0]];
        Self::new([71e3, 410.0], [150.0, 11.0], kinematic)
    }

    /// That of `ratchetting_steel.toml`.
    fn steel() -> Self {
        let kinematic = [[60_000.0, 20_000.0], [3228.0, 400.0], [455.0, 11.0]];
        Self::new([26_300.0, 18.8], [0.0, 0.0], kinematic)
    }

    fn new([young, yield_stress]: [f64; 2], isotropic: [f64; 2], kinematic: [[f64; 2]; 3]) -> Self {
        Self { young, yield_stress, isotropic, kinematic, back: [0.0; 3], plastic: 0.0, spent: 0.0 }
    }

    fn back_after(&self, flow: f64, sign: f64) -> [f64; 3] {
        std::array::from_fn(|i| {
            let [c, gamma] = self.kinematic[i];
            let end = sign * c / gamma;
            end + (self.back[i] - end) * (-gamma * flow).exp()
        })
    }

    /// Loads to a stress beyond which it turns; the strain there.
    fn load(&mut self, stress: f64) -> f64 {
        let (sign, [saturation, rate]) = (stress.signum(), self.isotropic);
        let over = |flow: f64| {
            let back: f64 = self.back_after(flow, sign).iter().sum();
            sign * (stress - back) - self.yield_stress - saturation * (1.0 - (-rate * (self.spent + flow)).exp())
        };
        let (mut low, mut high) = (0.0, if over(0.0) > 0.0 { 0.5 } else { 0.0 });
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if over(middle) > 0.0 { low = middle } else { high = middle }
        }
        self.back = self.back_after(high, sign);
        (self.plastic, self.spent) = (self.plastic + sign * high, self.spent + high);
        self.plastic + stress / self.young
    }
}

/// Ten cycles between two stresses: what the strains at the turns differ by from those of the independent integration, the most of
/// them over the most strain, and the strain that is left at the last two turns.
fn three_back_stresses(
    bench: &Bench,
    name: &str,
    (deck, mut metal, stresses): (&str, Metal, [f64; 2]),
) -> Result<Measured, Error> {
    let each = bench.pick(40, 120);
    let sets = [format!("step.1.increments.count={}", 20 * each)];
    let mut turns = Vec::new();
    bench.follow(deck, &sets, |model, state| {
        let top = model.problem.dofs.node(model.mesh.groups["bar.top"].nodes[0]) + 1;
        if state.increment > 0 && state.increment % each == 0 {
            turns.push(state.u[top].ln_1p());
        }
    })?;
    let (mut apart, mut most) = (0.0_f64, 0.0_f64);
    for (i, turn) in turns.iter().enumerate() {
        let exact = metal.load(stresses[i % 2]);
        (apart, most) = (apart.max((turn - exact).abs()), most.max(exact));
    }
    let last = |before: usize| turns.len().checked_sub(before).map_or(f64::NAN, |i| turns[i]);
    let found = [("three_back_stresses", apart / most), ("three_peak", last(2)), ("three_valley", last(1))];
    Ok(found.map(|(key, value)| (format!("{name}{key}"), value)).into())
}

/// Force of the bar at the end of both steps over that of the flow stress on its present area, at the temperature of the room, at a
/// homologous one, or with one that rises in both steps.
fn rate_jump(bench: &Bench, how: &str) -> Result<[f64; 2], Error> {
    let steel = "material.steel.von_mises_johnson_cook";
    let warm = format!("{steel}.homologous_temperature=0.4");
    let heated = [
        format!("{steel}.melting_temperature=1500.0"),
        "body.bar.expansion=0.0".into(),
        "step.slow.temperature.bar.value=300.0".into(),
        "step.fast.temperature.bar.value=900.0".into(),
    ];
    let (said, homologous) = match how {
        "warm_" => (vec![warm], [0.4; 2]),
        "heated_" => (heated.to_vec(), [0.2, 0.6]),
        _ => (vec![], [0.0_f64; 2]),
    };
    let (mut found, mut sets) = ([f64::NAN; 2], vec![format!("{steel}.softening_exponent=1.2")]);
    sets.extend(said);
    let mut before = [0.0; 2];
    bench.follow("rate_jump.toml", &sets, |model, state| {
        let force = reaction(model, state, "bar.top")[1];
        let step = usize::from(state.time > 0.050_000_1);
        let (strain, speed) = [(0.1_f64, 0.105_170_918 / 0.05), (0.12, 0.022_325_933_5 / 1e-4)][step];
        let stress = force * strain.exp() / PI;
        let now = [state.time, force];
        // What the bar loses of its elastic strain as it softens flows too.
        let lost = (before[1] - force) * strain.exp() / PI / 200e3 / (now[0] - before[0]);
        let rate = speed / strain.exp() * (1.0 - stress / 200e3) + lost;
        let flow = 350.0 + 275.0 * (strain - stress / 200e3).powf(0.36);
        found[step] = stress / (flow * (1.0 - homologous[step].powf(1.2)) * (1.0 + 0.05 * rate.ln()));
        before = now;
    })?;
    Ok(found)
}

/// Force of the block after all time over that of the first moment, over what the series leaves.
fn relaxation(bench: &Bench) -> Result<f64, Error> {
    let cells = bench.pick([8, 8], [16, 16]);
    let sets = [format!("mesh.part.block.rectangle.cells={cells:?}")];
    let (mut first, mut last) = (f64::NAN, f64::NAN);
    bench.follow("relaxation.toml", &sets, |model, state| {
        let force = reaction(model, state, "block.top")[1];
        *(if state.time < 2e-6 { &mut first } else { &mut last }) = force;
    })?;
    Ok(last / first / (0.5 + 0.3 * (-10.0_f64).exp() + 0.2 * (-1.0_f64).exp()))
}

/// Force of the block half of the way back, and pressed again beyond, over those of closed forms.
fn loops(bench: &Bench) -> Result<[f64; 2], Error> {
    let (energy, force) = (|l: f64| 0.5 * (l * l + 1.0 / (l * l) - 2.0), |l: f64| 10.0 * (l - 1.0 / (l * l * l)));
    let mut found = [f64::NAN; 2];
    bench.follow("loops.toml", &[], |model, state| {
        let top = model.problem.dofs.node(model.mesh.groups["block.top"].nodes[0]) + 1;
        let (l, borne) = (1.0 + 0.1 * state.u[top], reaction(model, state, "block.top")[1]);
        if (state.time - 1.5).abs() < 1e-9 {
            let most = energy(0.6);
            let left = 1.0 - erf((most - energy(l)) / (0.05 + 0.15 * most)) / 1.6;
            found[0] = borne / (force(l) * left);
        }
        found[1] = borne / force(l);
    })?;
    Ok(found)
}

/// The error function by Simpson's rule.
fn erf(x: f64) -> f64 {
    let n = 2000;
    let h = x / f64::from(n);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    let sum: f64 = (0..=n).map(|i| (-(f64::from(i) * h).powi(2)).exp() * weight(i)).sum();
    2.0 / PI.sqrt() * h / 3.0 * sum
}
