//! Cattaneo and Mindlin in space: two equal spheres pressed together and moved to and fro within what friction bears. With
//! `q = Q / (mu P)` and `d = 3 mu P (2 - nu) / (8 a G)` the contact gives way by `d (1 - (1 - q)^(2/3))`, sticks within
//! `r < a (1 - q)^(1/3)`, and a cycle between `-Q` and `Q` costs `24/5 d mu P (1 - (1 - q)^(5/3) - 5 q / 6 (1 + (1 - q)^(2/3)))`
//! (R. D. Mindlin and H. Deresiewicz 1953; K. L. Johnson, "Contact mechanics", sections 7.2 and 7.4).

use crate::bench::{Bench, Solved, both_forms, sides};
use crate::{Case, Measured, Size};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "partial-slip-3d", measure };

const FRICTION: f64 = 0.2;
const RADIUS: f64 = 32.0;
const YOUNG: f64 = 200.0;
const NU: f64 = 0.3;

/// Travel of the deck, and of the run without slip.
const TRAVEL: f64 = 0.0045;
const STUCK: f64 = 2.5e-5;

/// An accepted state.
#[derive(Clone, Copy)]
struct Moment {
    time: f64,
    /// Forces.
    normal: f64,
    tangential: f64,
    dissipated: f64,
    /// Difference of the tangential forces that the two sides bear, over what friction could bear.
    apart: f64,
    /// Of the contact, and of what sticks.
    radii: [f64; 2],
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    match bench.size {
        Size::Quick => pressed(bench, &[]),
        Size::Full => both_forms(&["contact.spot.form=paper"], |form| pressed(bench, form)),
    }
}

fn pressed(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let mesh = bench.pick(vec![], vec!["mesh.file=fine.msh".to_owned()]);
    let counts = bench.pick([4, 4], [10, 10]);
    let sets = [1, 2].map(|i| format!("step.{}.increments.count={}", i + 2, counts[i - 1]));
    let (moments, run) = follow(bench, &[&mesh[..], &sets[..], form].concat())?;
    let (to, back) = (end(&moments, 2.0)?, end(&moments, 4.0)?);
    // What sticks wholly moves in proportion.
    let stick = ["contact.spot.law.coulomb.friction=20.0", "step.2.displacement.\"upper.base\".x=2.5e-5"];
    let mut stick: Vec<String> = stick.map(str::to_owned).into();
    stick.extend([3, 4].map(|step| format!("step.{step}.increments.count=1")));
    let sticking = end(&follow(bench, &[&mesh[..], &stick[..], form].concat())?.0, 2.0)?;
    let contact = Contact::new(to.normal, to.tangential);
    // The blocks give way as well: what is more than the compliance of contact that sticks is that of slip.
    let slip = TRAVEL - STUCK * to.tangential / sticking.tangential;
    let stuck = contact.depth * 2.0 / 3.0 * contact.ratio;
    Ok(vec![
        ("load".into(), contact.ratio),
        ("a".into(), to.radii[0] / contact.radius),
        ("c".into(), to.radii[1] / to.radii[0] / (1.0 - contact.ratio).cbrt()),
        ("shift".into(), (slip + stuck) / contact.shift()),
        ("loop".into(), (back.dissipated - to.dissipated) / contact.cycle()),
        ("apart".into(), moments.iter().filter(|m| m.time > 1.5).fold(0.0, |most, m| m.apart.max(most))),
        ("iterations".into(), run.iterations()),
    ])
}

/// All accepted states.
fn follow(bench: &Bench, sets: &[String]) -> Result<(Vec<Moment>, Solved), Error> {
    let mut moments = Vec::new();
    let run = bench.follow("lenses.toml", sets, |model, state| moments.push(Moment::new(model, state)))?;
    Ok((moments, run))
}

/// The state at the end of a step.
fn end(moments: &[Moment], time: f64) -> Result<Moment, Error> {
    let found = moments.iter().find(|moment| (moment.time - time).abs() < 1e-9).copied();
    found.ok_or_else(|| Error::input(format!("the run has no state at time {time}")))
}

impl Moment {
    fn new(model: &Model, state: &State) -> Self {
        let sides = sides(model, state);
        let all = || sides.iter().flatten();
        // Each side is half of a sphere and bears half of what is asked for.
        let along = |axis: usize| [0, 1].map(|k| sides[k].iter().map(|p| p.force()[axis]).sum::<f64>());
        let both = |axis: usize| along(axis).iter().map(|force| force.abs()).sum::<f64>();
        let radius = |stress: &dyn Fn(f64, f64) -> f64| {
            let sum = |power: i32| -> f64 {
                all()
                    .map(|p| p.area * stress(p.pressure, p.shear) * p.position[0].hypot(p.position[1]).powi(power))
                    .sum()
            };
            (2.5 * sum(2) / sum(0)).sqrt()
        };
        // What friction could bear and does not is Hertz's pressure within the circle that sticks.
        let radii = [radius(&|p, _| p), radius(&|p, q| FRICTION * p - q)];
        let dissipated = 2.0 * 0.5 * all().map(|p| p.dissipated * p.area).sum::<f64>();
        let (normal, apart) = (both(2), along(0).iter().sum::<f64>().abs());
        let apart = 2.0 * apart / (FRICTION * normal);
        Self { time: state.time, normal, tangential: both(0), dissipated, apart, radii }
    }
}

/// Mindlin's contact.
struct Contact {
    radius: f64,
    /// Tangential over the largest tangential force.
    ratio: f64,
    /// The largest tangential force, and by how much the contact gives way before it slides.
    limit: f64,
    depth: f64,
}

impl Contact {
    fn new(normal: f64, tangential: f64) -> Self {
        let (modulus, shear) = (0.5 * YOUNG / (1.0 - NU * NU), 0.5 * YOUNG / (1.0 + NU));
        let radius = (0.75 * normal * 0.5 * RADIUS / modulus).cbrt();
        let limit = FRICTION * normal;
        let depth = 3.0 * limit * (2.0 - NU) / (8.0 * radius * shear);
        Self { radius, ratio: tangential / limit, limit, depth }
    }
    fn shift(&self) -> f64 {
        self.depth * (1.0 - (1.0 - self.ratio).powf(2.0 / 3.0))
    }
    fn cycle(&self) -> f64 {
        let (q, rest) = (self.ratio, 1.0 - self.ratio);
        let bracket = 1.0 - rest.powf(5.0 / 3.0) - 5.0 / 6.0 * q * (1.0 + rest.powf(2.0 / 3.0));
        4.8 * self.depth * self.limit * bracket
    }
}
