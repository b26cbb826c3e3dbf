//! The rules, each of which looks for one cause. To add one: a function here, its line in [`ALL`], a deck in the table of
//! seeded failures.

mod held;
mod procedure;
mod strength;
mod touch;

use super::Finding;
use super::course::{End, RunCourse};
use super::facts::{ContactFacts, Facts, ToolFacts};
use super::plausible::oddities;
use asperity_core::FailureKind;

type Rule = fn(&Facts, &RunCourse) -> Option<Finding>;

/// All rules.
pub static ALL: &[Rule] = &[
    units,
    touch::wrong_side,
    seams,
    touch::initial_overlap,
    touch::unseen_overlap,
    held::not_touching,
    held::thrown,
    held::free_body,
    held::slides,
    held::slips_everywhere,
    held::slides_freely,
    held::hourglass,
    held::lost_contact,
    touch::no_contact,
    strength::limit_load,
    strength::no_strength,
    touch::missing_contact,
    touch::passage,
    strength::crushed,
    strength::inverted,
    touch::penalty,
    touch::cycle,
    strength::locking,
    strength::law,
    procedure::tolerance,
    procedure::few_iterations,
    procedure::switched_off,
    procedure::smallest,
    procedure::too_many,
    touch::turn,
    touch::multipliers,
    accuracy,
];

fn finding(cause: &str, weight: f64, what: impl Into<String>) -> Finding {
    let (evidence, advice) = (Vec::new(), Vec::new());
    Finding { cause: cause.into(), what: what.into(), evidence, advice, weight }
}

impl Finding {
    fn shown(mut self, evidence: impl Into<String>) -> Self {
        let text = evidence.into();
        if !text.is_empty() {
            self.evidence.push(text);
        }
        self
    }
    fn try_to(mut self, advice: &[&str]) -> Self {
        self.advice.extend(advice.iter().map(|text| (*text).to_owned()));
        self
    }
}

/// When no rule speaks.
pub fn unknown(course: &RunCourse) -> Finding {
    finding("unknown", 0.1, "no single cause stands out")
        .shown(&course.reason)
        .try_to(&[
            "look at the last frame and at the reasons of the cut increments in `increments.csv`",
            "smaller increments (`increments.first`, `increments.largest`); then one thing less at a time: without friction, \
             with an elastic material, with fewer contacts",
        ])
}

/// Weight from which on an oddity outweighs what it leads to.
const CERTAIN: f64 = 0.6;

fn units(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let found = oddities(facts);
    let worst = found.iter().map(|oddity| oddity.weight).fold(0.0, f64::max);
    if found.is_empty() || (course.ended == End::Well && worst < CERTAIN) {
        return None;
    }
    // It is the cause of whatever else is seen.
    let weight = if worst > CERTAIN { worst.max(0.92) } else { worst };
    let mut told = finding("units", weight, "numbers of the deck hardly belong together: look at units first");
    for oddity in &found {
        told = told.shown(&oddity.what);
    }
    let mut helps: Vec<&str> = found.iter().map(|oddity| oddity.help.as_str()).collect();
    helps.dedup();
    Some(told.try_to(&helps))
}

/// Faces and nodes that lie on one another and are not joined: what they part is free, or runs into itself.
fn seams(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let kinds = [FailureKind::Free, FailureKind::Singular, FailureKind::Hourglass];
    let parted = course.kind().is_some_and(|kind| kinds.contains(&kind)) || course.share(&kinds) > 0.3;
    let itself = course.fault(&[FailureKind::Passage]).is_some_and(|fault| fault.reason.contains("in itself"));
    // Bodies that only touch are meant to where a contact is between them.
    let meant = |seam: &&String| !facts.contacts.is_empty() && seam.starts_with("separate bodies");
    let seam = facts.seams.iter().find(|seam| !meant(seam)).filter(|_| parted || itself)?;
    Some(
        finding("seam", 0.93, "parts of the mesh lie on one another and are not joined")
            .shown(seam)
            .shown(&course.reason)
            .try_to(&[
                "merge the nodes where the parts are to be one; in one body, refine without nodes that hang between two others",
                "or a `[[tie]]` between the two surfaces, or a `[contact]` where they are to part",
            ]),
    )
}

/// Part of the nodes of a body that lie in a tool where it stands on the wrong side.
const INSIDE: f64 = 0.6;

/// Size of a tool over that of the mesh below which it has no sides to speak of.
const TINY: f64 = 0.05;

fn is_wrong(facts: &Facts, contact: &ContactFacts) -> bool {
    let Some(tool) = &contact.tool else { return false };
    let sized = |other: &&ToolFacts| other.name == *tool && other.size > TINY * facts.size;
    contact.inside > INSIDE && facts.tools.iter().any(|tool| sized(&tool))
}

/// Gap over the length of an edge that is one.
const OPEN: f64 = 1e-6;

/// Whatever figure is beyond its limit and no other rule explains.
fn accuracy(_: &Facts, course: &RunCourse) -> Option<Finding> {
    let figures = course.doubts.iter().filter(|doubt| doubt.figure != "closed_points");
    let worst = figures.max_by(|a, b| (a.value / a.limit).total_cmp(&(b.value / b.limit)))?;
    let cause = match worst.figure.as_str() {
        "energy_balance" => "large-increments",
        "pressure_oscillation" => "locking",
        "imbalance" | "moment_imbalance" | "reaction_balance" | "friction_deviation" | "facet_ratio" | "coarseness" => {
            "coarse-contact"
        }
        _ => "penetration",
    };
    let what = format!("a figure of the certificate is beyond its limit: {}", worst.words.trim());
    Some(
        // A run that stopped did so of something else.
        finding(cause, if course.kind().is_some() { 0.4 } else { 0.6 }, what)
            .shown(format!("{:.2e}{}, with a limit of {}", worst.value, worst.place, worst.limit))
            .try_to(&[&worst.remedy]),
    )
}
