//! What bodies bear: loads beyond it, cells that are crushed or lock, laws without an answer.

use super::super::Finding;
use super::super::course::{End, RunCourse};
use super::super::facts::{BodyFacts, Facts};
use super::finding;
use asperity_core::FailureKind;

/// Motion per time over that at the beginning that tells of a load that meets its limit.
const RUNS_AWAY: f64 = 4.0;
/// Stress of a load over the stress that a body bears.
const BEYOND: f64 = 1.0;

pub(super) fn limit_load(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let step = facts.steps.get(course.step)?;
    let kinds = [
        FailureKind::Iterations,
        FailureKind::NotFinite,
        FailureKind::Inverted,
        FailureKind::Material,
        FailureKind::Singular,
        // A body that flows all through deforms without resistance too; cells that do so by themselves have a rule of their own.
        FailureKind::Hourglass,
        FailureKind::Passage,
    ];
    let failed = course
        .kind()
        .is_some_and(|kind| kinds.contains(&kind) || kind == FailureKind::Other || kind == FailureKind::Cycle);
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
    // A load that runs away at a part of itself is beyond what is borne by the rest.
    let stopped =
        (course.kind().is_some() && course.part > 0.0 && course.acceleration > RUNS_AWAY).then(|| 1.0 / course.part);
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
            "`{}` amounts to a stress of {:.2e} at its end, about {:.1} times what the body bears",
            load.name,
            load.stress,
            stopped.unwrap_or(part)
        ));
    }
    if runs_away {
        told =
            told.shown(format!("before the end everything moved {:.1} times as fast as at first", course.acceleration));
    }
    told = told.try_to(&["is the load right, in size, sign and unit? A force acts on each node of its group"]);
    if !step.follows {
        told = told.try_to(&[
            "where it snaps through or back, follow the path past its limit points: `control = \"arc-length\"` in the step, with \
             `until` where it is to end",
        ]);
    }
    Some(told.try_to(&[
        "prescribe the displacement of what is loaded in place of the force: its reaction then shows the limit",
        "more hardening, more support, or a smaller load",
    ]))
}

/// A soil without cohesion bears nothing where nothing confines it.
pub(super) fn no_strength(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let weak = |body: &&BodyFacts| !body.prestressed && body.number("cohesion") == Some(0.0);
    let body = facts.bodies.iter().find(weak)?;
    let early = course.kind().is_some() && course.part < 0.05;
    early.then(|| {
        finding(
            "no-strength",
            0.88,
            format!("body '{}' has no cohesion and begins without stress: it bears nothing", body.name),
        )
        .shown(&course.reason)
        .shown(format!("`cohesion` of material `{}` is 0, and no `initial_stress` confines it", body.material))
        .try_to(&[
            "`initial_stress` of the body, in equilibrium with its weight and supports",
            "or a small `cohesion`, which holds its free surface together",
        ])
    })
}

/// Part of the distance of two ends of a body that prescribed motions leave, at the least, where it can bear them.
const CRUSHED: f64 = 0.2;

pub(super) fn crushed(facts: &Facts, course: &RunCourse) -> Option<Finding> {
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

pub(super) fn inverted(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let share = course.share(&[FailureKind::Inverted]);
    let fault = course.fault(&[FailureKind::Inverted])?;
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

pub(super) fn locking(facts: &Facts, course: &RunCourse) -> Option<Finding> {
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
        .try_to(&["`formulation = \"auto\"` of the body", "cells of second degree with `integration = \"reduced\"`"]),
    )
}

pub(super) fn law(_: &Facts, course: &RunCourse) -> Option<Finding> {
    let share = course.share(&[FailureKind::Material]);
    let fault = course.fault(&[FailureKind::Material])?;
    (share > 0.1 && course.kind().is_some()).then(|| {
        finding("material-law", 0.55 + 0.25 * share, "the law of a material finds no stress")
            .shown(&fault.reason)
            .try_to(&[
                "smaller increments, or sub-steps of the law (`update`)",
                "an admissible state at the beginning: soils need a pressure (`initial_stress`)",
                "`asperity point` drives the law alone along the strain that it fails at",
            ])
    })
}
