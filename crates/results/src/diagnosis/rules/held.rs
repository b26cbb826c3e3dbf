//! What holds nothing: bodies that are free, not held yet, or held no more.

use super::super::Finding;
use super::super::course::{End, RunCourse};
use super::super::facts::{BodyFacts, ContactFacts, Facts};
use super::{OPEN, finding, is_wrong};
use asperity_core::FailureKind;

fn at_start(course: &RunCourse) -> bool {
    course.increments == 0 && course.step == 0
}

/// A body that only contacts are to hold, and those are open.
pub(super) fn not_touching(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    if !at_start(course) || course.kind() != Some(FailureKind::Free) {
        return None;
    }
    let (body, contact) = waiting(facts, course)?;
    let gap = contact.gap.unwrap_or(contact.distance);
    Some(
        finding(
            "not-touching",
            // The run names the body that is free: more than that no contact closed.
            0.92,
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
pub(super) fn thrown(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let loaded = facts.steps.iter().position(|step| !step.loads.is_empty())? + 1;
    let open = facts.contacts.iter().find(|contact| contact.gap.is_none_or(|gap| gap > OPEN * contact.edge))?;
    let missing = course.doubt(&["energy_balance"]).is_some_and(|doubt| doubt.step <= loaded);
    ((course.jumps > 0 || missing) && !is_wrong(facts, open)).then(|| {
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
fn waiting<'a>(facts: &'a Facts, course: &'a RunCourse) -> Option<(&'a BodyFacts, &'a ContactFacts)> {
    facts.bodies_in(&course.reason).find_map(|body| {
        let mut own = facts.contacts.iter().filter(|contact| contact.bodies.contains(&body.name)).peekable();
        own.peek()?;
        let open = own.find(|contact| contact.gap.is_none_or(|gap| gap > OPEN * contact.edge));
        open.filter(|contact| !is_wrong(facts, contact)).map(|contact| (body, contact))
    })
}

pub(super) fn free_body(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    if course.kind() != Some(FailureKind::Free)
        || course.increments > 0 && course.closed.iter().any(|(_, closed)| *closed)
    {
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

/// One in so many closed points may stick where everything slips.
const FEW: usize = 8;

/// Everything that touches slips, under loads that are far from what the bodies bear.
pub(super) fn slips_everywhere(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let step = facts.steps.get(course.step).filter(|step| !step.loads.is_empty())?;
    let kinds = [
        FailureKind::Free,
        FailureKind::Pushed,
        FailureKind::Iterations,
        FailureKind::Singular,
        FailureKind::Cycle,
        FailureKind::Passage,
        FailureKind::Other,
    ];
    if !course.kind().is_some_and(|kind| kinds.contains(&kind))
        || course.increments == 0
        || course.touching == 0
        || FEW * course.sticking > course.touching
    {
        return None;
    }
    // Without friction all points slip, and that says nothing of a body that is held.
    let tells =
        |contact: &&ContactFacts| course.adrift.is_some() || contact.friction.is_some_and(|friction| friction > 0.0);
    let mut closed = facts.contacts.iter().filter(|contact| course.closed(&contact.name) && !is_wrong(facts, contact));
    let contact = closed.find(tells)?;
    let friction = contact.friction.unwrap_or(0.0);
    let body = facts.bodies.iter().find(|body| contact.bodies.contains(&body.name))?;
    Some(
        finding("slides", if course.adrift.is_some() { 0.88 } else { 0.83 }, "what touches slips everywhere: friction is at its limit")
            .shown(format!(
                "in the last increment {} of {} closed points slip; contact '{}' of body '{}' has a coefficient of friction of {friction}",
                course.touching - course.sticking,
                course.touching,
                contact.name,
                body.name
            ))
            .shown(held_still(course))
            .shown(format!("step `{}` is driven by loads", step.name))
            .try_to(&[
                "a support against the motion along the surface, or weak springs (`spring`)",
                "more friction, more of the load that presses, or less of the one that makes it slide",
                "prescribe the displacement in place of the load: its reaction then shows what friction bears",
            ]),
    )
}

/// What was held still, in words.
fn held_still(course: &RunCourse) -> String {
    course.adrift.as_ref().map_or(String::new(), |(what, time)| format!("{what} from time {time:.4} on"))
}

/// A body that only friction is to hold along some axes, which does not.
pub(super) fn slides(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let free = [FailureKind::Free, FailureKind::Pushed, FailureKind::Singular, FailureKind::Hourglass];
    let free = course.kind().is_some_and(|kind| free.contains(&kind)) || course.share(&free) > 0.3;
    let adrift = |body: &BodyFacts| !body.held && course.never_closed();
    // What nothing but a smooth surface touches slides from the beginning, however that shows, or as soon as a load makes it.
    let loaded = facts.steps.get(course.step).is_some_and(|step| !step.loads.is_empty());
    let smooth = |body: &BodyFacts| {
        let of_body = |contact: &&ContactFacts| contact.bodies.contains(&body.name);
        (course.increments == 0 || loaded)
            && facts.contacts.iter().filter(of_body).all(|c| c.friction.is_none_or(|f| f == 0.0))
    };
    let body = facts.bodies.iter().find(|body| !body.unheld.is_empty() && (free || adrift(body) || smooth(body)))?;
    course.kind()?;
    let touches = |contact: &&ContactFacts| {
        let bears = contact.gap.is_some_and(|gap| gap <= OPEN * contact.edge) || course.closed(&contact.name);
        contact.bodies.contains(&body.name) && bears && !holds(contact) && !is_wrong(facts, contact)
    };
    let contact = facts.contacts.iter().find(touches)?;
    let axes = body.unheld.join(" and ");
    let held = match contact.friction.filter(|friction| *friction > 0.0) {
        Some(friction) => format!(
            "a coefficient of friction of {friction}: the load along the surface is more than that of the one across it"
        ),
        None => "no friction".into(),
    };
    // It may be held by what it leans on all around.
    let sure = free || adrift(body) || course.increments == 0;
    Some(
        finding(
            "slides",
            if sure { 0.84 } else { 0.6 },
            format!("body '{}' slides on what it touches: friction is all that could hold it", body.name),
        )
        .shown(&course.reason)
        .shown(format!("along {axes} no support acts on it; contact '{}' has {held}", contact.name))
        .try_to(&[
            "a support against the motion along the surface, or weak springs (`spring`)",
            "more friction, or less of the load that makes it slide",
        ]),
    )
}

/// Whether a contact that touches holds by friction what rests on it under its weight.
fn holds(contact: &ContactFacts) -> bool {
    let touches = contact.gap.is_some_and(|gap| gap <= OPEN * contact.edge);
    touches && contact.friction.zip(contact.slope).is_some_and(|(friction, slope)| slope < friction)
}

/// A body that slides without resistance on what touches it: the matrix is singular but for rounding.
pub(super) fn slides_freely(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let body = facts.bodies.iter().find(|body| !body.unheld.is_empty())?;
    let singular = course.kind() == Some(FailureKind::Singular) || course.share(&[FailureKind::Singular]) > 0.3;
    let rests = |contact: &ContactFacts| contact.bodies.contains(&body.name) && holds(contact);
    let told = facts.contacts.iter().any(|contact| is_wrong(facts, contact) || rests(contact));
    let adrift = !body.held && course.never_closed() && !told;
    (course.kind().is_some() && (singular || adrift)).then(|| {
        let slides =
            facts.contacts.iter().any(|c| c.bodies.contains(&body.name) && c.friction.is_none_or(|f| f == 0.0));
        let axes = body.unheld.join(" and ");
        let gap = |contact: &&ContactFacts| contact.gap.is_none_or(|gap| gap > OPEN * contact.edge);
        let apart = facts.contacts.iter().filter(|contact| contact.bodies.contains(&body.name)).find(gap);
        let cause = if apart.is_some() && course.never_closed() { "not-touching" } else { "free-body" };
        finding(cause, 0.82, format!("nothing holds body '{}' along {axes}", body.name))
            .shown(&course.reason)
            .shown(format!("no support acts on it along {axes}"))
            .shown(
                apart.map_or(String::new(), |c| format!("contact '{}' does not touch before anything moves", c.name)),
            )
            .shown(if slides { "the contact that it rests on has no friction" } else { "" })
            .try_to(&["a support along that axis, or weak springs (`spring`)", "friction, where there is some"])
    })
}

pub(super) fn hourglass(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let soft = facts.bodies.iter().filter(|body| body.hourglass).map(|body| body.name.as_str()).collect::<Vec<_>>();
    let of_kind = course.kind() == Some(FailureKind::Hourglass);
    let doubted = course.doubt(&["hourglass"]).is_some();
    // Where they give way from the start, the iterations may only wander.
    let wandered = course.increments == 0 && course.kind() == Some(FailureKind::Iterations);
    let singular = course.share(&[FailureKind::Hourglass, FailureKind::Singular]) >= 0.3;
    if soft.is_empty() || !(of_kind || doubted || singular || wandered) {
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

pub(super) fn lost_contact(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let closed = course.closed.iter().any(|(_, closed)| *closed);
    let free = course.kind() == Some(FailureKind::Free) && course.increments > 0;
    let adrift = facts.bodies.iter().find(|body| !body.held && !body.unheld.is_empty());
    let adrift = adrift.filter(|_| course.ended == End::Well && course.touching == 0);
    // Something was held still, and nothing touches any more.
    let let_go = course.kind().is_some() && course.touching == 0 && course.adrift.is_some();
    (closed && (free || adrift.is_some() || let_go)).then(|| {
        finding("lost-contact", 0.9, "a body lost the contact that held it")
            .shown(&course.reason)
            .shown(held_still(course))
            .shown(adrift.map_or(String::new(), |body| {
                format!("at the end no contact is closed, and no support holds body '{}'", body.name)
            }))
            .try_to(&[
                "support it, or keep it in contact: a smaller motion, a spring, friction",
                "`solver.if_free = \"hold\"` leaves it where it is until something touches it",
            ])
    })
}
