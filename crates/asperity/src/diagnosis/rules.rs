//! The rules, each of which looks for one cause. To add one: a function here, its line in [`ALL`], a case in the table of
//! seeded failures.

use super::Finding;
use super::course::{Course, End};
use super::facts::{BodyFacts, ContactFacts, Facts, ToolFacts};
use super::plausible::oddities;
use crate::Kind;

type Rule = fn(&Facts, &Course) -> Option<Finding>;

/// All rules.
pub static ALL: &[Rule] = &[
    units,
    wrong_side,
    initial_overlap,
    not_touching,
    thrown,
    free_body,
    slides_freely,
    hourglass,
    lost_contact,
    no_contact,
    limit_load,
    missing_contact,
    passage,
    crushed,
    inverted,
    penalty,
    cycle,
    locking,
    law,
    tolerance,
    few_iterations,
    switched_off,
    smallest,
    too_many,
    turn,
    multipliers,
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
pub fn unknown(course: &Course) -> Finding {
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

fn units(facts: &Facts, course: &Course) -> Option<Finding> {
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

/// Part of the nodes of a body that lie in a tool where it stands on the wrong side.
const INSIDE: f64 = 0.6;

/// Size of a tool over that of the mesh below which it has no sides to speak of.
const TINY: f64 = 0.05;

fn is_wrong(facts: &Facts, contact: &ContactFacts) -> bool {
    let Some(tool) = &contact.tool else { return false };
    let sized = |other: &&ToolFacts| other.name == *tool && other.size > TINY * facts.size;
    contact.inside > INSIDE && facts.tools.iter().any(|tool| sized(&tool))
}

fn wrong_side(facts: &Facts, _: &Course) -> Option<Finding> {
    let contact = facts.contacts.iter().find(|contact| is_wrong(facts, contact))?;
    let tool = contact.tool.as_deref().unwrap_or_default();
    Some(
        finding("wrong-side", 0.97, format!("the material of tool '{tool}' lies on the side of the body"))
            .shown(format!(
                "{:.0} % of the nodes behind contact '{}' lie inside the tool before anything moves",
                100.0 * contact.inside,
                contact.name
            ))
            .shown(if contact.seeing == 0 { "no contact point sees the tool" } else { "" })
            .try_to(&[
                "turn the profile round: its material lies on the left of the direction in which it is written; in space the \
                 facets look outward",
                "or move body or tool to where they should be",
            ]),
    )
}

/// Penetration over the length of an edge before anything moves that is no accident.
const DEEP: f64 = 0.3;

fn initial_overlap(facts: &Facts, course: &Course) -> Option<Finding> {
    let deep = |contact: &&ContactFacts| {
        contact.gap.is_some_and(|gap| -gap > DEEP * contact.edge) && !is_wrong(facts, contact)
    };
    let contact = facts.contacts.iter().find(deep)?;
    let early = course.increments <= 2 && course.step == 0;
    let gap = -contact.gap?;
    Some(
        finding(
            "initial-overlap",
            if early { 0.85 } else { 0.4 },
            format!("the two sides of contact '{}' lie in each other before anything moves", contact.name),
        )
        .shown(format!("by {gap:.3e}, {:.2} lengths of an edge", gap / contact.edge))
        .try_to(&[
            "move the parts apart in the mesh or the profile",
            "`overlap = \"adjust\"` moves the nodes out without strain; for an interference fit more and smaller increments in the first step",
        ]),
    )
}

/// Gap over the length of an edge that is one.
const OPEN: f64 = 1e-6;

fn at_start(course: &Course) -> bool {
    course.increments == 0 && course.step == 0
}

/// A body that only contacts are to hold, and those are open.
fn not_touching(facts: &Facts, course: &Course) -> Option<Finding> {
    if !at_start(course) || course.kind() != Some(Kind::Free) {
        return None;
    }
    let (body, contact) = waiting(facts, course)?;
    let gap = contact.gap.unwrap_or(contact.distance);
    Some(
        finding(
            "not-touching",
            0.9,
            format!("body '{}' is to be held by contact '{}', which does not touch yet", body.name, contact.name),
        )
        .shown(&course.reason)
        .shown(format!("a gap of {gap:.3e} before anything moves"))
        .try_to(&[
            "move the parts together, so that they touch from the start",
            "bring them together by a prescribed motion in a first step, and let loads act in the second",
            "or hold the body by weak springs (`spring`) until contact closes",
        ]),
    )
}

/// What began apart from what is to hold it, and was thrown onto it by its load.
fn thrown(facts: &Facts, course: &Course) -> Option<Finding> {
    let loaded = facts.steps.iter().any(|step| !step.loads.is_empty());
    let open = facts.contacts.iter().find(|contact| contact.gap.is_none_or(|gap| gap > OPEN * contact.edge))?;
    let missing = course.doubt(&["energy_balance"]).is_some();
    ((course.jumps > 0 || missing) && loaded && !is_wrong(facts, open)).then(|| {
        let gap = open.gap.unwrap_or(open.distance);
        finding(
            "not-touching",
            0.8,
            format!("a load acts before contact '{}' touches: nothing holds it until then", open.name),
        )
        .shown(format!("a gap of {gap:.3e} before anything moves, over which the load finds nothing to work against"))
        .try_to(&[
            "move the parts together, so that they touch from the start",
            "bring them together by a prescribed motion in a first step, and let loads act in the second",
        ])
    })
}

/// A free body and the open contact that is to hold it.
fn waiting<'a>(facts: &'a Facts, course: &'a Course) -> Option<(&'a BodyFacts, &'a ContactFacts)> {
    facts.bodies_in(&course.reason).find_map(|body| {
        let mut own = facts.contacts.iter().filter(|contact| contact.bodies.contains(&body.name)).peekable();
        own.peek()?;
        let open = own.find(|contact| contact.gap.is_none_or(|gap| gap > OPEN * contact.edge));
        open.filter(|contact| !is_wrong(facts, contact)).map(|contact| (body, contact))
    })
}

fn free_body(facts: &Facts, course: &Course) -> Option<Finding> {
    if course.kind() != Some(Kind::Free) || course.increments > 0 && course.closed.iter().any(|(_, closed)| *closed) {
        return None;
    }
    let names: Vec<&str> = facts.bodies_in(&course.reason).map(|body| body.name.as_str()).collect();
    let what = match names.first() {
        Some(name) => format!("nothing holds body '{name}'"),
        None => "nothing holds a part of the model".into(),
    };
    let weight = if at_start(course) && waiting(facts, course).is_some() { 0.6 } else { 0.9 };
    let unheld = facts.bodies_in(&course.reason).any(|body| !body.held);
    Some(
        finding("free-body", weight, what)
            .shown(&course.reason)
            .shown(if unheld { "no step supports any of its nodes" } else { "" })
            .try_to(&[
                "a support (`displacement`, `symmetry`) against the motion that is named; in the plane a body needs three, in space six",
                "or contact with friction that holds it, or weak springs (`spring`)",
            ]),
    )
}

/// A body that slides without resistance on what touches it: the matrix is singular but for rounding.
fn slides_freely(facts: &Facts, course: &Course) -> Option<Finding> {
    let fault = course.fault(&[Kind::Singular])?;
    let body = facts.bodies.iter().find(|body| !body.unheld.is_empty())?;
    (course.share(&[Kind::Singular]) > 0.3 && course.kind().is_some()).then(|| {
        let slides =
            facts.contacts.iter().any(|c| c.bodies.contains(&body.name) && c.friction.is_none_or(|f| f == 0.0));
        let axes = body.unheld.join(" and ");
        let gap = |contact: &&ContactFacts| contact.gap.is_none_or(|gap| gap > OPEN * contact.edge);
        let apart = facts.contacts.iter().filter(|contact| contact.bodies.contains(&body.name)).find(gap);
        let cause = if apart.is_some() && course.never_closed() { "not-touching" } else { "free-body" };
        finding(cause, 0.82, format!("nothing holds body '{}' along {axes}", body.name))
            .shown(&fault.reason)
            .shown(format!("no support acts on it along {axes}"))
            .shown(
                apart.map_or(String::new(), |c| format!("contact '{}' does not touch before anything moves", c.name)),
            )
            .shown(if slides { "the contact that it rests on has no friction" } else { "" })
            .try_to(&["a support along that axis, or weak springs (`spring`)", "friction, where there is some"])
    })
}

fn hourglass(facts: &Facts, course: &Course) -> Option<Finding> {
    let soft = facts.bodies.iter().filter(|body| body.hourglass).map(|body| body.name.as_str()).collect::<Vec<_>>();
    let of_kind = course.kind() == Some(Kind::Hourglass);
    let doubted = course.doubt(&["hourglass"]).is_some();
    if !of_kind && !doubted && (soft.is_empty() || course.share(&[Kind::Hourglass, Kind::Singular]) < 0.3) {
        return None;
    }
    Some(
        finding(
            "hourglass",
            if of_kind { 0.93 } else { 0.7 },
            "cells with reduced integration move without resistance",
        )
        .shown(if of_kind { course.reason.as_str() } else { "" })
        .shown(format!("reduced integration of cells of first degree in: {}", soft.join(", ")))
        .try_to(&[
            "`integration = \"full\"`, with `formulation = \"f-bar\"` where the volume is kept",
            "or supports and contacts on more nodes than one or two",
        ]),
    )
}

fn lost_contact(facts: &Facts, course: &Course) -> Option<Finding> {
    let closed = course.closed.iter().any(|(_, closed)| *closed);
    let free = course.kind() == Some(Kind::Free) && course.increments > 0;
    let adrift = facts.bodies.iter().find(|body| !body.held && !body.unheld.is_empty());
    let adrift = adrift.filter(|_| course.ended == End::Well && course.touching == 0);
    (closed && (free || adrift.is_some())).then(|| {
        finding("lost-contact", 0.9, "a body lost the contact that held it")
            .shown(&course.reason)
            .shown(adrift.map_or(String::new(), |body| {
                format!("at the end no contact is closed, and no support holds body '{}'", body.name)
            }))
            .try_to(&[
                "support it, or keep it in contact: a smaller motion, a spring, friction",
                "`solver.if_free = \"hold\"` leaves it where it is until something touches it",
            ])
    })
}

fn no_contact(facts: &Facts, course: &Course) -> Option<Finding> {
    if !course.never_closed() || facts.contacts.iter().any(|contact| is_wrong(facts, contact)) {
        return None;
    }
    let unseen: Vec<&str> = facts.contacts.iter().filter(|c| c.seeing == 0).map(|c| c.name.as_str()).collect();
    let missed = course.share(&[Kind::Passage]) > 0.3;
    let weight = match course.ended {
        End::Well => 0.9,
        End::Failed(_) if missed && !unseen.is_empty() => 0.8,
        End::Failed(_) => 0.45,
    };
    let nearest = facts.contacts.iter().map(|c| c.gap.unwrap_or(c.distance)).fold(f64::INFINITY, f64::min);
    let reach: f64 = facts.steps.iter().map(|step| step.moved + step.driven).sum();
    Some(
        finding("no-contact", weight, "no contact ever closed in the whole run")
            .shown(if unseen.is_empty() {
                String::new()
            } else {
                format!("no point of {} sees its target before anything moves", unseen.join(", "))
            })
            .shown(format!("the nearest two sides lie {nearest:.3e} apart; all that is moved goes {reach:.3e}"))
            .try_to(&[
                "is the surface the right side of the body, and the target the one that it meets?",
                "do the motions bring them together, with the right sign and far enough?",
                "`asperity check` says what each contact sees",
            ]),
    )
}

/// Motion per time over that at the beginning that tells of a load that meets its limit.
const RUNS_AWAY: f64 = 4.0;
/// Stress of a load over the stress that a body bears.
const BEYOND: f64 = 1.0;

fn limit_load(facts: &Facts, course: &Course) -> Option<Finding> {
    let step = facts.steps.get(course.step)?;
    let kinds = [Kind::Iterations, Kind::NotFinite, Kind::Inverted, Kind::Material, Kind::Singular, Kind::Passage];
    let failed = course.kind().is_some_and(|kind| kinds.contains(&kind) || kind == Kind::Other || kind == Kind::Cycle);
    let leapt = course.ended == End::Well && (course.leap > 0.0 || course.jumps > 0) && !course.doubts.is_empty();
    if step.loads.is_empty() || !(failed || leapt) {
        return None;
    }
    let over = step.loads.iter().filter_map(|load| {
        let bodies = || load.bodies.iter().filter_map(|name| facts.body(name));
        let borne = bodies().filter_map(|body| body.strength).fold(f64::INFINITY, f64::min);
        let young = bodies().map(|body| body.young).fold(f64::INFINITY, f64::min);
        let part = (load.stress / borne).max(load.stress / (0.3 * young));
        (part > 0.5 * BEYOND).then_some((load, part))
    });
    let over = over.max_by(|a, b| a.1.total_cmp(&b.1));
    let runs_away = course.acceleration > RUNS_AWAY;
    let mut weight: f64 = if runs_away { 0.8 } else { 0.45 };
    if let Some((_, part)) = over {
        weight = weight.max(if part > BEYOND { 0.86 } else { 0.7 });
    }
    if leapt {
        weight = weight.max(0.6);
    }
    let reached = 100.0 * course.part;
    let mut told =
        finding("limit-load", weight, "the loads are more than the model can bear: collapse, buckling or snap-through")
            .shown(format!("step `{}` is driven by loads and ends at {reached:.1} % of it", step.name));
    if let Some((load, part)) = over {
        told = told.shown(format!(
            "`{}` amounts to a stress of {:.2e} at its end, about {part:.1} times what the body bears",
            load.name, load.stress
        ));
    }
    if runs_away {
        told =
            told.shown(format!("before the end everything moved {:.1} times as fast as at first", course.acceleration));
    }
    Some(told.try_to(&[
        "is the load right, in size, sign and unit? A force acts on each node of its group",
        "prescribe the displacement of what is loaded in place of the force: its reaction then shows the limit",
        "more hardening, more support, or a smaller load",
    ]))
}

fn missing_contact(facts: &Facts, course: &Course) -> Option<Finding> {
    let fault = course.fault(&[Kind::Passage]);
    let doubt = course.doubt(&["interpenetration"]);
    let (text, weight) = match (fault, doubt) {
        (Some(fault), _) if course.share(&[Kind::Passage]) > 0.3 => (fault.reason.as_str(), 0.88),
        (_, Some(doubt)) => (doubt.place.as_str(), 0.85),
        _ => return None,
    };
    let bodies: Vec<&BodyFacts> = facts.bodies_in(text).collect();
    let tool = facts.tools.iter().find(|tool| text.contains(&format!("tool '{}'", tool.name)));
    let itself = text.contains("in itself");
    if bodies.is_empty() || (bodies.len() < 2 && tool.is_none() && !itself) {
        return None;
    }
    let knows = |contact: &ContactFacts| {
        let named = bodies.iter().all(|body| contact.bodies.contains(&body.name));
        named
            && contact.tool.as_deref() == tool.map(|tool| tool.name.as_str())
            && (!itself || contact.bodies.len() == 1)
    };
    if facts.contacts.iter().any(knows) {
        return None;
    }
    Some(
        finding("missing-contact", weight, "two parts run into each other where no contact is declared")
            .shown(text)
            .try_to(&[
                "a `[contact]` between these two, or of the surface with itself",
                "or a motion that keeps them apart",
            ]),
    )
}

fn passage(facts: &Facts, course: &Course) -> Option<Finding> {
    let share = course.share(&[Kind::Passage]);
    let fault = course.fault(&[Kind::Passage])?;
    let step = facts.steps.get(course.step)?;
    (share > 0.3).then(|| {
        finding("passage", 0.5 + 0.2 * share, "one part goes through another, or lies too deep in it")
            .shown(&fault.reason)
            .shown(format!("increments of up to {:.1e} of the step", step.largest))
            .try_to(&[
                "smaller increments: `increments.largest`, or more of `count`",
                "a surface that covers the whole zone of contact, and a finer one where the target is sharper than its edges",
                "a larger `penalty` where it is pressed through slowly",
            ])
    })
}

/// Part of the distance of two ends of a body that prescribed motions leave, at the least, where it can bear them.
const CRUSHED: f64 = 0.2;

fn crushed(facts: &Facts, course: &Course) -> Option<Finding> {
    let body = facts.bodies.iter().find(|body| body.left < CRUSHED)?;
    course.kind()?;
    Some(
        finding(
            "inverted-cells",
            0.9,
            format!("what is prescribed crushes body '{}' or turns it inside out", body.name),
        )
        .shown(if body.left <= 0.0 {
            "its two ends are moved past each other".to_owned()
        } else {
            format!("its two ends are moved together to {:.2} of their distance", body.left)
        })
        .shown(&course.reason)
        .try_to(&[
            "is the prescribed displacement right, in size and sign? It counts from the undeformed place",
            "a smaller motion; a mesh of cells that are long where they will be compressed",
        ]),
    )
}

fn inverted(facts: &Facts, course: &Course) -> Option<Finding> {
    let share = course.share(&[Kind::Inverted]);
    let fault = course.fault(&[Kind::Inverted])?;
    let step = facts.steps.get(course.step)?;
    (share > 0.25 && course.kind().is_some()).then(|| {
        let cell = facts.bodies.iter().map(|body| body.cell).fold(f64::INFINITY, f64::min);
        let moved = step.moved.max(step.driven) * fault.size;
        finding("inverted-cells", 0.5 + 0.3 * share, "cells are crushed or turned inside out")
            .shown(&fault.reason)
            .shown(if moved > cell {
                format!("an increment moves {:.1} cells' lengths", moved / cell)
            } else {
                String::new()
            })
            .try_to(&[
                "is what is prescribed possible at all: does anything move into or beyond what is held?",
                "smaller increments, and a mesh made for the final shape: cells long where they will be compressed",
                "smaller loads where they crush the body",
            ])
    })
}

/// A given penalty over the computed one that is a cause.
const STIFF: f64 = 300.0;
const SOFT: f64 = 0.02;

fn penalty(facts: &Facts, course: &Course) -> Option<Finding> {
    let ratio = |contact: &ContactFacts| contact.penalty.filter(|ratio| *ratio > STIFF || *ratio < SOFT);
    let contact = facts.contacts.iter().find(|contact| ratio(contact).is_some())?;
    let ratio = ratio(contact)?;
    let deep = course.doubt(&["max_penetration_relative", "sampled_penetration", "interpenetration"]);
    let kinds = [Kind::Iterations, Kind::Cycle, Kind::Singular, Kind::NotFinite, Kind::Other];
    let passes = course.share(&[Kind::Passage]) > 0.3;
    let weight = match (ratio > STIFF, course.kind()) {
        (true, Some(kind)) if kinds.contains(&kind) => 0.9,
        (true, _) => 0.5,
        (false, _) if deep.is_some() || passes => 0.9,
        (false, _) => 0.5,
    };
    let word = if ratio > STIFF { "stiff" } else { "soft" };
    Some(
        finding("penalty", weight, format!("the penalty of contact '{}' is far too {word}", contact.name))
            .shown(format!("it is {ratio:.1e} times the one that follows from the cells behind the surface"))
            .shown(deep.map_or(String::new(), |doubt| format!("{}: {:.2}{}", doubt.words, doubt.value, doubt.place)))
            .try_to(&[
                "leave `penalty` out: the computed one serves",
                "`augmentation` where penetration must be smaller still",
            ]),
    )
}

fn cycle(facts: &Facts, course: &Course) -> Option<Finding> {
    let share = course.share(&[Kind::Cycle]);
    let changing = course.faults.iter().filter(|fault| fault.kind == Kind::Iterations && fault.changes > 0).count()
        as f64
        / course.faults.len().max(1) as f64;
    let fault = course.fault(&[Kind::Cycle]).or_else(|| course.faults.iter().find(|fault| fault.changes > 0))?;
    (share > 0.2 || changing > 0.5).then(|| {
        let friction = facts.contacts.iter().filter_map(|contact| contact.friction).fold(0.0, f64::max);
        finding("contact-cycle", (0.55 + 0.3 * share).max(0.5 * changing), "contact points change their state to and fro")
            .shown(&fault.reason)
            .shown(if friction > 0.8 { format!("a coefficient of friction of {friction}") } else { String::new() })
            .try_to(&[
                "`piecewise = true` and `line_search = true` under `[solver]` if they are off",
                "smaller increments; more points (`gauss`, `parts` of an edge) where contact is narrower than an edge",
                "a softer `penalty` or `tangential_penalty`, a finer surface; less friction, to see whether it is the cause",
            ])
    })
}

fn locking(facts: &Facts, course: &Course) -> Option<Finding> {
    let doubt = course.doubt(&["pressure_oscillation"]);
    let stiff = |body: &&BodyFacts| body.locks && (body.bulk_ratio > 20.0 || body.strength.is_some());
    let body = facts.bodies.iter().find(stiff)?;
    let weight = match doubt {
        Some(_) if course.ended == End::Well => 0.9,
        Some(_) => 0.8,
        None if body.bulk_ratio > 50.0 => 0.55,
        None => 0.3,
    };
    Some(
        finding(
            "locking",
            weight,
            format!("body '{}' locks: its cells cannot keep their volume and deform", body.name),
        )
        .shown(format!(
            "cells of first degree in full integration with a bulk modulus of {:.0} shear moduli",
            body.bulk_ratio
        ))
        .shown(doubt.map_or(String::new(), |doubt| format!("{}: {:.2}{}", doubt.words, doubt.value, doubt.place)))
        .try_to(&["`formulation = \"f-bar\"` of the body", "cells of second degree with `integration = \"reduced\"`"]),
    )
}

fn law(_: &Facts, course: &Course) -> Option<Finding> {
    let share = course.share(&[Kind::Material]);
    let fault = course.fault(&[Kind::Material])?;
    (share > 0.3 && course.kind().is_some()).then(|| {
        finding("material-law", 0.55 + 0.25 * share, "the law of a material finds no stress")
            .shown(&fault.reason)
            .try_to(&[
                "smaller increments, or sub-steps of the law (`update`)",
                "an admissible state at the beginning: soils need a pressure (`initial_stress`)",
                "`asperity point` drives the law alone along the strain that it fails at",
            ])
    })
}

/// A tolerance that rounding does not allow.
const TIGHT: f64 = 1e-10;

fn tolerance(facts: &Facts, course: &Course) -> Option<Finding> {
    let loose = course.doubt(&["equilibrium_error"]);
    if let Some(doubt) = loose.filter(|_| facts.tolerance > 1e-4) {
        return Some(
            finding("tolerance", 0.88, "the tolerance of the iterations is too loose")
                .shown(format!("`solver.tolerance` is {:.0e}; {}: {:.1e}", facts.tolerance, doubt.words, doubt.value))
                .try_to(&["leave `solver.tolerance` out: 1e-6"]),
        );
    }
    let near = course.faults.iter().find(|fault| fault.kind == Kind::Iterations && fault.residual < 1e-7);
    let near = near.filter(|_| course.kind() == Some(Kind::Iterations) && facts.tolerance < TIGHT)?;
    Some(
        finding("tolerance", 0.9, "the tolerance of the iterations is tighter than rounding allows")
            .shown(format!(
                "`solver.tolerance` is {:.0e}, and the iterations come to {:.1e}",
                facts.tolerance, near.residual
            ))
            .try_to(&["leave `solver.tolerance` out: 1e-6"]),
    )
}

fn few_iterations(facts: &Facts, course: &Course) -> Option<Finding> {
    let stopped = course.share(&[Kind::Iterations, Kind::Cycle]) > 0.5 && course.kind().is_some();
    (stopped && facts.iterations < 8).then(|| {
        finding("few-iterations", 0.9, "the iterations are given up before they can converge")
            .shown(format!("`solver.iterations` allows {}", facts.iterations))
            .try_to(&["leave `solver.iterations` out: 25"])
    })
}

fn switched_off(facts: &Facts, course: &Course) -> Option<Finding> {
    let kinds = [Kind::Iterations, Kind::Cycle, Kind::NotFinite];
    (!facts.switched_off.is_empty() && course.kind().is_some_and(|kind| kinds.contains(&kind))).then(|| {
        finding("procedure", 0.65, "parts of the procedure that help here are switched off")
            .shown(facts.switched_off.join(", "))
            .try_to(&["leave these keys out"])
    })
}

fn smallest(facts: &Facts, course: &Course) -> Option<Finding> {
    let step = facts.steps.get(course.step)?;
    let few = course.faults.len() <= 3 && !course.faults.is_empty();
    let cuts = matches!(course.kind(), Some(kind) if ![Kind::Free, Kind::Hourglass, Kind::TooMany].contains(&kind));
    (cuts && few && step.smallest > 0.002).then(|| {
        finding("smallest-increment", 0.75, "increments may not become small enough")
            .shown(format!(
                "`increments.smallest` is {}, and the run gave up after {} attempts at one increment",
                step.smallest,
                course.faults.len()
            ))
            .try_to(&["leave `increments.smallest` out: 1e-6", "or begin with a smaller `increments.first`"])
    })
}

fn too_many(_: &Facts, course: &Course) -> Option<Finding> {
    (course.kind() == Some(Kind::TooMany)).then(|| {
        finding("increments-used-up", 0.9, "the step has used up the increments that it may take")
            .shown(&course.reason)
            .shown(format!("{} attempts were cut before", course.cuts))
            .try_to(&[
                "raise `increments.most`; `asperity restart` goes on from the last accepted increment",
                "if many were cut: what cuts them is the cause, see `increments.csv`",
            ])
    })
}

fn turn(_: &Facts, course: &Course) -> Option<Finding> {
    let fault = course.fault(&[Kind::Turn])?;
    (course.share(&[Kind::Turn]) > 0.3).then(|| {
        finding("large-rotation", 0.85, "a tool turns too far in one increment")
            .shown(&fault.reason)
            .try_to(&["more increments: `increments.count`, or a smaller `increments.largest`"])
    })
}

fn multipliers(_: &Facts, course: &Course) -> Option<Finding> {
    let fault = course.fault(&[Kind::Multipliers])?;
    (course.share(&[Kind::Multipliers]) > 0.3).then(|| {
        finding("augmentation", 0.85, "multipliers do not take out the penetration that `augmentation` asks for")
            .shown(&fault.reason)
            .try_to(&[
                "a wider tolerance of `augmentation`, or more passes",
                "a stiffer `penalty`, or none of `augmentation`",
            ])
    })
}

/// Whatever figure is beyond its limit and no other rule explains.
fn accuracy(_: &Facts, course: &Course) -> Option<Finding> {
    let figures = course.doubts.iter().filter(|doubt| doubt.figure != "closed_points");
    let worst = figures.max_by(|a, b| (a.value / a.limit).total_cmp(&(b.value / b.limit)))?;
    let cause = match worst.figure.as_str() {
        "energy_balance" => "large-increments",
        "pressure_oscillation" => "locking",
        "imbalance" | "moment_imbalance" | "reaction_balance" | "friction_deviation" | "facet_ratio" => {
            "coarse-contact"
        }
        _ => "penetration",
    };
    let what = format!("{} is beyond what can be trusted", worst.words.trim());
    Some(
        finding(cause, 0.6, what)
            .shown(format!("{:.2e}{}, with a limit of {}", worst.value, worst.place, worst.limit))
            .try_to(&[&worst.remedy]),
    )
}
