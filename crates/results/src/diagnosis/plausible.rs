//! Numbers of a model that hardly belong together, as where units are mixed: said before a run, and remembered when it fails.

use super::facts::{BodyFacts, ContactFacts, Facts, StepFacts};

/// Something odd.
#[derive(Debug, Clone, PartialEq)]
pub struct Oddity {
    /// What is odd, in words with its numbers.
    pub what: String,
    /// What to look at.
    pub help: String,
    /// How strongly it speaks of a mistake, from zero to one.
    pub weight: f64,
}

/// Young's modulus over the stress at first yield: of metals 100 to 2 000, of polymers and soils from 10 on.
const MODULUS_OVER_YIELD: [f64; 2] = [5.0, 1e5];
/// Strain of a body under its own weight, of the order of `density gravity size / modulus`.
const WEIGHT_STRAIN: [f64; 2] = [1e-14, 2.0];
/// Stress that a load amounts to, over the modulus and over the strength.
const LOAD_OVER_MODULUS: f64 = 2.0;
const LOAD_OVER_YIELD: f64 = 20.0;
const FAINT_LOAD: f64 = 1e-13;
/// Size of a tool, its distance, and what is moved over the size of the mesh.
const TOOL_SIZE: [f64; 2] = [2e-3, 300.0];
const DISTANCE: f64 = 20.0;
const MOTION: f64 = 50.0;
/// Coefficient of friction: that of rubber on rough ground is some 1.5.
const FRICTION: f64 = 2.0;
/// Angle of friction of a soil in degrees, those of clays from some 5 on.
const ANGLE: f64 = 1.6;
/// Slope of a flow curve over Young's modulus.
const HARDENING: f64 = 1.0;
/// Gravity on earth in metres.
const METRES: [f64; 2] = [9.7, 9.9];

/// How strongly a ratio beyond a limit speaks of a mistake: by ten the more, by a thousand for certain.
fn weight(beyond: f64) -> f64 {
    (0.5 + 0.15 * beyond.abs().max(1.0).log10()).min(0.95)
}

/// Everything odd about a model.
pub fn oddities(facts: &Facts) -> Vec<Oddity> {
    let mut found: Vec<Oddity> = facts.bodies.iter().filter_map(stiffness).collect();
    found.extend(facts.steps.iter().flat_map(|step| loads(facts, step)));
    found.extend(facts.steps.iter().filter_map(|step| motion(facts, step)));
    found.extend(tools(facts));
    found.extend(distances(facts));
    found.extend(facts.bodies.iter().flat_map(numbers));
    found.extend(facts.contacts.iter().filter_map(friction));
    found.extend(facts.steps.iter().filter_map(|step| gravity(facts, step)));
    found.extend(facts.steps.iter().skip(1).filter_map(repeated));
    found.extend(facts.bodies.iter().filter_map(driven_whole));
    found
}

fn stiffness(body: &BodyFacts) -> Option<Oddity> {
    let limit = body.yield_stress.filter(|limit| *limit > 0.0)?;
    let ratio = body.young / limit;
    let [least, most] = MODULUS_OVER_YIELD;
    if !(ratio < least || ratio > most) {
        return None;
    }
    let beyond = if ratio < least { least / ratio.max(1e-12) } else { ratio / most };
    let said = body.number("yield_stress").map_or(String::new(), |said| format!(" (`yield_stress` {said})"));
    Some(Oddity {
        what: format!(
            "material `{}` yields at {limit:.3e}{said} with a modulus of {:.3e}: a ratio of {ratio:.1e}, where metals have 100 to 2000",
            body.material, body.young
        ),
        help: "are both in the same unit of stress?".into(),
        weight: weight(10.0 * beyond),
    })
}

fn loads<'a>(facts: &'a Facts, step: &'a StepFacts) -> impl Iterator<Item = Oddity> + 'a {
    step.loads.iter().filter_map(|load| {
        let bodies = || load.bodies.iter().filter_map(|name| facts.body(name));
        let young = bodies().map(|body| body.young).fold(f64::INFINITY, f64::min);
        let limit = bodies().filter_map(|body| body.yield_stress).fold(f64::INFINITY, f64::min);
        let (of_young, of_yield, stress) = (load.stress / young, load.stress / limit, load.stress);
        let weighs = load.name == "gravity";
        let most = if weighs { WEIGHT_STRAIN[1] } else { LOAD_OVER_MODULUS };
        let least = if weighs { WEIGHT_STRAIN[0] } else { FAINT_LOAD };
        let name = &load.name;
        let (against, beyond) = if of_young > most {
            (format!("{of_young:.1e} of the modulus"), of_young / most)
        } else if of_yield > LOAD_OVER_YIELD {
            (format!("{of_yield:.1e} of the stress at yield"), of_yield / LOAD_OVER_YIELD)
        } else if of_young < least && stress > 0.0 {
            (format!("{of_young:.1e} of the modulus, which moves nothing"), least / of_young)
        } else {
            return None;
        };
        let help = if weighs {
            "do density, gravity, lengths and modulus belong to one system of units (t, mm, N, MPa; or kg, m, N, Pa)?"
        } else {
            "are load, lengths and modulus in one system of units?"
        };
        let what = format!("`{name}` amounts to a stress of {stress:.1e}, {against}");
        Some(Oddity { what, help: help.into(), weight: weight(beyond) })
    })
}

fn motion(facts: &Facts, step: &StepFacts) -> Option<Oddity> {
    let far = step.moved.max(step.driven) / facts.size;
    (far > MOTION).then(|| Oddity {
        what: format!("step `{}` moves something by {far:.1e} times the size of the mesh", step.name),
        help: "are mesh and motion in the same unit of length?".into(),
        weight: weight(far / MOTION),
    })
}

fn tools(facts: &Facts) -> impl Iterator<Item = Oddity> + '_ {
    let [least, most] = TOOL_SIZE;
    facts.tools.iter().filter_map(move |tool| {
        let ratio = tool.size / facts.size;
        (ratio < least || ratio > most).then(|| Oddity {
            what: format!("tool `{}` has {ratio:.1e} times the size of the mesh", tool.name),
            help: "are mesh and tool in the same unit of length?".into(),
            weight: weight(10.0 * (least / ratio.max(1e-12)).max(ratio / most)),
        })
    })
}

fn distances(facts: &Facts) -> impl Iterator<Item = Oddity> + '_ {
    facts.contacts.iter().filter_map(|contact| {
        let far = contact.distance / facts.size;
        (far > DISTANCE).then(|| Oddity {
            what: format!("the two sides of contact `{}` lie {far:.1e} sizes of the mesh apart", contact.name),
            help: "are both where they should be, and in the same unit of length?".into(),
            weight: weight(far / DISTANCE),
        })
    })
}

/// Numbers of a law that are out of their range: slopes steeper than the modulus, angles that are no degrees.
fn numbers(body: &BodyFacts) -> impl Iterator<Item = Oddity> + '_ {
    body.law.1.iter().filter_map(|&(key, value)| {
        let steep = ["hardening", "kinematic"].contains(&key) && value > HARDENING * body.young;
        let radians = ["friction", "friction_angle"].contains(&key) && value > 0.0 && value < ANGLE;
        let (what, help, beyond) = if steep {
            let what = format!("{value:.3e}, {:.1e} of its modulus", value / body.young);
            (what, "are both in the same unit of stress?", 10.0 * value / body.young)
        } else if radians {
            (format!("{value} degrees"), "is it in radians? Angles are in degrees", 10.0)
        } else {
            return None;
        };
        let what = format!("`{key}` of material `{}` is {what}", body.material);
        Some(Oddity { what, help: help.into(), weight: weight(beyond) })
    })
}

fn friction(contact: &ContactFacts) -> Option<Oddity> {
    let friction = contact.friction.filter(|friction| *friction > FRICTION)?;
    Some(Oddity {
        what: format!("contact `{}` has a coefficient of friction of {friction}", contact.name),
        help: "is it in per cent? It is shear over pressure, and rarely above 1".into(),
        weight: weight(10.0 * friction / FRICTION),
    })
}

fn gravity(facts: &Facts, step: &StepFacts) -> Option<Oddity> {
    let unit = facts.length_unit.as_ref().filter(|unit| *unit != "m")?;
    let gravity = step.gravity.filter(|gravity| (METRES[0]..METRES[1]).contains(gravity))?;
    Some(Oddity {
        what: format!("step `{}` has a gravity of {gravity}, and the unit of length is {unit}", step.name),
        help: "9.81 is in metres; in millimetres it is 9810".into(),
        weight: 0.9,
    })
}

fn repeated(step: &StepFacts) -> Option<Oddity> {
    step.repeats.then(|| Oddity {
        what: format!("step `{}` prescribes what holds already and moves nothing", step.name),
        help: "displacements and motions count from where the mesh was drawn, and not from the end of the step before"
            .into(),
        weight: 0.55,
    })
}

fn driven_whole(body: &BodyFacts) -> Option<Oddity> {
    let step = body.driven_whole.as_ref()?;
    Some(Oddity {
        what: format!("step `{step}` moves every node of body `{}`, which so cannot deform", body.name),
        help: "name one of its sides, as `NAME.top`".into(),
        weight: 0.7,
    })
}
