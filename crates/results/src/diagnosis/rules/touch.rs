//! Contacts: wrong sides, none at all, missing ones, ones that something passes through, penalties and cycles.

use super::super::Finding;
use super::super::course::{End, RunCourse};
use super::super::facts::{BodyFacts, ContactFacts, Facts};
use super::{OPEN, finding, is_wrong};
use asperity_core::FailureKind;

pub(super) fn wrong_side(facts: &Facts, _: &RunCourse) -> Option<Finding> {
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

/// Two bodies that are to touch lie in each other where no contact point looks, though they were not moved by as much as their
/// surfaces are apart.
pub(super) fn unseen_overlap(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    if course.kind() != Some(FailureKind::Passage) || !course.never_closed() {
        return None;
    }
    let lies = |reason: &str| reason.contains(" deep in ");
    let fault = course.faults.iter().rev().find(|fault| fault.kind == FailureKind::Passage && lies(&fault.reason))?;
    let bodies: Vec<&str> = facts.bodies_in(&fault.reason).map(|body| body.name.as_str()).collect();
    let steps = facts.steps.iter().take(course.step + 1).enumerate();
    let part = |i: usize| if i == course.step { course.part } else { 1.0 };
    let moved: f64 = steps.map(|(i, step)| part(i) * (step.moved + step.driven)).sum();
    let contact = facts.contacts.iter().find(|contact| {
        let theirs = |name: &&str| contact.bodies.iter().any(|own| own == name);
        bodies.len() > 1 && bodies.iter().all(theirs) && contact.distance > moved
    })?;
    Some(
        finding(
            "initial-overlap",
            0.92,
            format!("the two sides of contact '{}' lie in each other before anything moves", contact.name),
        )
        .shown(&fault.reason)
        .shown(format!(
            "{moved:.3e} was moved, and the surfaces of the contact, which face away from each other, are {:.3e} apart",
            contact.distance
        ))
        .try_to(&["move the parts apart in the mesh"]),
    )
}

pub(super) fn initial_overlap(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let deep = |contact: &&ContactFacts| {
        contact.gap.is_some_and(|gap| -gap > DEEP * contact.edge) && !is_wrong(facts, contact)
    };
    let contact = facts.contacts.iter().find(deep)?;
    let early = course.increments <= 2 && course.step == 0;
    let gap = -contact.gap?;
    Some(
        finding(
            "initial-overlap",
            if early { 0.85 } else if course.ended == End::Well { 0.7 } else { 0.4 },
            format!("the two sides of contact '{}' lie in each other before anything moves", contact.name),
        )
        .shown(format!("by {gap:.3e}, {:.2} lengths of an edge", gap / contact.edge))
        .try_to(&[
            "move the parts apart in the mesh or the profile",
            "`overlap = \"adjust\"` moves the nodes out without strain; for an interference fit more and smaller increments in the first step",
        ]),
    )
}

pub(super) fn no_contact(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    if facts.contacts.is_empty()
        || !course.never_closed()
        // Before the first accepted increment nothing is known of what touches from the start.
        || course.increments == 0 && facts.contacts.iter().any(|contact| contact.gap.is_some_and(|gap| gap <= OPEN * contact.edge))
        || facts.contacts.iter().any(|contact| is_wrong(facts, contact))
    {
        return None;
    }
    let unseen: Vec<&str> = facts.contacts.iter().filter(|c| c.seeing == 0).map(|c| c.name.as_str()).collect();
    let missed = course.share(&[FailureKind::Passage]) > 0.3;
    let weight = match course.ended {
        End::Well => 0.9,
        End::Failed(_) if unseen.len() == facts.contacts.len() => 0.91,
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

pub(super) fn missing_contact(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let fault = course.fault(&[FailureKind::Passage]);
    let doubt = course.doubt(&["interpenetration"]);
    let (text, weight) = match (fault, doubt) {
        (Some(fault), _) if course.share(&[FailureKind::Passage]) > 0.3 => (fault.reason.as_str(), 0.88),
        (_, Some(doubt)) => (doubt.place.as_str(), 0.85),
        // The last attempt, which was relaxed, found an equilibrium, and that one is refused.
        _ => match course.faults.last().filter(|fault| fault.kind == FailureKind::Passage) {
            Some(fault) => (fault.reason.as_str(), 0.82),
            None => return None,
        },
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

pub(super) fn passage(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let share = course.share(&[FailureKind::Passage]);
    let fault = course.fault(&[FailureKind::Passage])?;
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

/// A given penalty over the computed one that is a cause.
const STIFF: f64 = 300.0;
const SOFT: f64 = 0.02;

pub(super) fn penalty(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let ratio = |contact: &ContactFacts| contact.penalty.filter(|ratio| *ratio > STIFF || *ratio < SOFT);
    let contact = facts.contacts.iter().find(|contact| ratio(contact).is_some())?;
    let ratio = ratio(contact)?;
    let deep = course.doubt(&["max_penetration_relative", "sampled_penetration", "interpenetration"]);
    let kinds = [
        FailureKind::Iterations,
        FailureKind::Cycle,
        FailureKind::Singular,
        FailureKind::NotFinite,
        FailureKind::Other,
    ];
    let passes = course.share(&[FailureKind::Passage]) > 0.3;
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

pub(super) fn cycle(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let share = course.share(&[FailureKind::Cycle]);
    let changing =
        course.faults.iter().filter(|fault| fault.kind == FailureKind::Iterations && fault.changes > 0).count() as f64
            / course.faults.len().max(1) as f64;
    let fault = course.fault(&[FailureKind::Cycle]).or_else(|| course.faults.iter().find(|fault| fault.changes > 0))?;
    (share > 0.2 || changing > 0.5).then(|| {
        let friction = facts.contacts.iter().filter_map(|contact| contact.friction).fold(0.0, f64::max);
        finding("contact-cycle", (0.55 + 0.3 * share).max(0.5 * changing), "contact points change their state to and fro")
            .shown(&fault.reason)
            .shown(if friction > 0.8 { format!("a coefficient of friction of {friction}") } else { String::new() })
            .try_to(&[
                "`piecewise = true` and `line_search = true` under `[solver]` if they are off",
                "smaller increments; more points (`gauss`) where contact is narrower than an edge",
                "a softer `penalty` or `tangential_penalty`, a finer surface; less friction, to see whether it is the cause",
            ])
    })
}

pub(super) fn turn(_: &Facts, course: &RunCourse) -> Option<Finding> {
    let fault = course.fault(&[FailureKind::Turn])?;
    (course.share(&[FailureKind::Turn]) > 0.3).then(|| {
        finding("large-rotation", 0.85, "a tool turns too far in one increment")
            .shown(&fault.reason)
            .try_to(&["more increments: `increments.count`, or a smaller `increments.largest`"])
    })
}

pub(super) fn multipliers(_: &Facts, course: &RunCourse) -> Option<Finding> {
    let fault = course.fault(&[FailureKind::Multipliers])?;
    (course.share(&[FailureKind::Multipliers]) > 0.3).then(|| {
        finding("augmentation", 0.85, "multipliers do not take out the penetration that `augmentation` asks for")
            .shown(&fault.reason)
            .try_to(&[
                "a wider tolerance of `augmentation`, or more passes",
                "a stiffer `penalty`, or none of `augmentation`",
            ])
    })
}
