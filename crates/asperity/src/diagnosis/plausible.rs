//! Numbers of a model that hardly belong together, as where units are mixed: said before a run, and remembered when it fails.

use super::facts::{BodyFacts, Facts, StepFacts};

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
const TOOL_SIZE: [f64; 2] = [2e-3, 3e3];
const DISTANCE: f64 = 20.0;
const MOTION: f64 = 50.0;

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
    Some(Oddity {
        what: format!(
            "material `{}` yields at {limit:.3e} with a modulus of {:.3e}: a ratio of {ratio:.1e}, where metals have 100 to 2000",
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
