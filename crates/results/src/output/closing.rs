//! What is said of a run at its end besides its figures: what its certificate means in words, what it cost, which promises it
//! bends.

use super::account::Account;
use super::average::extrapolation;
use super::certificate::{Certificate, Limits};
use super::quantities::{Parts, Touching};
use super::summary::Summary;
use asperity_core::mesh::Space;
use asperity_core::model::Model;
use asperity_core::solid::{Body, Choice};
use asperity_core::solve::{Run, Snap, Turn, engine};
use asperity_core::system::{State, Term};

/// Puts notes and costs of a run of `seconds` into its summary.
pub fn close(account: &mut Account, model: &Model, run: &Run, seconds: f64) {
    let Account { certificate, limits, summary, .. } = account;
    cost(summary, run, seconds);
    summary.notes.extend(rough(model, &run.state));
    summary.notes.extend(memory_of_tips(model, &run.state));
    let bodies = Parts::of(model).bodies;
    summary.notes.extend(bodies.iter().flat_map(|(term, body)| locking(body, &run.state, *term)));
    summary.notes.extend(imbalance(certificate, limits));
    summary.notes.extend(large_strain(certificate));
    summary.notes.extend(rests(certificate, model.space));
}

/// Which cells of a body, a term, stay too stiff, and what helps; of one that stretches or shears evenly none. What dissipated less than
/// it stores has not flowed all through.
fn locking(body: &Body, state: &State, term: usize) -> Vec<String> {
    if !body.bends(&state.u) {
        return Vec::new();
    }
    let (energies, choices) = (state.energies[term], body.choices().iter());
    let flowed = energies.dissipated > energies.stored;
    let all_through = choices.clone().filter(|_| flowed).filter_map(Choice::plastic_bending);
    let thin = choices.clone().find(|choice| choice.thin && !flowed);
    let late = thin.filter(|choice| yields_late(body, choice, state, term)).map(Choice::late_yield);
    let far = body.too_far_bent(&state.u).map(|part| {
        format!(
            "cells with incompatible modes bend so far in it that its force is too large by some {:.0} %, and more where they are long: strain \
             is not linear through such cells; more of them through it, or cells of second degree, follow it",
            100.0 * part
        )
    });
    let advice = choices.flat_map(Choice::advice).chain(all_through).chain(late).chain(far);
    advice.map(|advice| format!("body '{}': {advice}", body.name())).collect()
}

/// Part of its cells at whose surface a body may pass yield without a word.
const LATE: f64 = 0.05;

/// Whether the stress at the corners of more than a few cells of a kind, by least squares from their points, is more than the law bears.
fn yields_late(body: &Body, choice: &Choice, state: &State, term: usize) -> bool {
    let (kind, material) = (choice.kind, body.material());
    let weights = extrapolation(kind, body.rule(kind));
    let records: Vec<_> = body.records(&state.u, &state.histories[term]).collect();
    let (mut late, mut cells, mut at_corner) = (0, 0, vec![0.0; material.state_len()]);
    for points in records.chunk_by(|one, next| one.cell == next.cell).filter(|points| points.len() == weights[0].len())
    {
        cells += 1;
        let mut beyond = |weights: &Vec<f64>| {
            at_corner.copy_from_slice(points[0].state);
            for (component, value) in at_corner[..6].iter_mut().enumerate() {
                *value = points.iter().zip(weights).map(|(point, weight)| weight * point.state[component]).sum();
            }
            material.bears(&at_corner).is_err()
        };
        late += usize::from(weights[..kind.linear.nodes.len()].iter().any(&mut beyond));
    }
    late as f64 > LATE * cells as f64
}

/// Part of their force by which two sides of a contact may differ without a word.
const BALANCED: f64 = 0.02;

/// What it means that two sides of a contact press with different forces, where that is no doubt yet.
fn imbalance(certificate: &Certificate, limits: &Limits) -> Option<String> {
    let worst = certificate.worst("imbalance", limits)?;
    let noted = worst.value > BALANCED && worst.limit.is_some_and(|limit| worst.value <= limit);
    noted.then(|| {
        format!(
            "the forces on the two sides differ by {:.1} %{}: with two passes each side answers for itself, and action equals \
             reaction only as far as the meshes agree; finer meshes bring them together, passes = \"one\" makes them equal",
            100.0 * worst.value,
            worst.place()
        )
    })
}

/// Displacement gradient up to which small strain is taken at its word.
const SMALL: f64 = 0.1;

/// What it means that a body in small strain moves by more than that.
fn large_strain(certificate: &Certificate) -> Vec<String> {
    let beyond = certificate.each("small_strain").filter(|(_, gradient)| *gradient > SMALL);
    let said = |(body, gradient): (&str, f64)| {
        format!(
            "{body} is computed in small strain, but the gradient of its displacements reaches {gradient:.2}: strains \
             and rotations beyond {SMALL} are not small, and results are wrong by a part of that order; \
             strain = \"finite\" has no such limit"
        )
    };
    beyond.map(said).collect()
}

/// Closed points along one direction below which the force of a contact is not smooth.
const FEW: usize = 3;

/// What it means that contacts never closed, or at so few points that their force changes with each of them.
fn rests(certificate: &Certificate, space: Space) -> Vec<String> {
    let few = (if space == Space::Solid { FEW * FEW } else { FEW }) as f64;
    let of = |is: &dyn Fn(f64) -> bool| certificate.each("closed_points").filter(|(_, most)| is(*most)).collect();
    let (never, on_few): (Vec<_>, Vec<_>) = (of(&|most| most == 0.0), of(&|most| most > 0.0 && most < few));
    let never = together(&never).map(|contacts| {
        format!(
            "{contacts} never closed in the whole run; `asperity check` says what points see: the surface or the target \
             may be another than is meant, a tool may have its material on the wrong side, or nothing moves them together"
        )
    });
    let on_few = together(&on_few).map(|contacts| {
        let most = on_few.iter().fold(0.0, |most: f64, (_, points)| most.max(*points));
        format!(
            "{contacts} rested on {most} points at most beside one another, fewer than the {few} of a force that changes smoothly as it moves: \
             under a round body it may be wrong by half, and by far where bodies fit into each other; a finer surface gives it more"
        )
    });
    never.into_iter().chain(on_few).collect()
}

/// Names of contacts, of many the first and how many more; none of none.
fn together(contacts: &[(&str, f64)]) -> Option<String> {
    let told = contacts.iter().take(TOLD).map(|(contact, _)| *contact).collect::<Vec<_>>().join(", ");
    let more = contacts.len().saturating_sub(TOLD);
    (!contacts.is_empty()).then(|| if more > 0 { format!("{told} and {more} more contacts") } else { told })
}

/// Changes of stability, and contacts, that are told one by one.
const TOLD: usize = 5;

/// Where stability was lost or found again.
fn turns(turns: &[Turn]) -> impl Iterator<Item = String> {
    let more = turns.len().saturating_sub(TOLD);
    let more = (more > 0).then(|| format!("{more} more changes of stability; the modes of all are in modes.pvd"));
    let told = turns.iter().take(TOLD).map(|turn| {
        let lost = turn.negative[1] > turn.negative[0];
        let help =
            "; a perfect shape stays on its path beyond it, a small imperfection along the mode (modes.pvd) leaves it";
        format!("{turn}{}", if lost { help } else { "" })
    });
    told.chain(more)
}

/// Increments that jumped: the first, and how many.
fn snaps(snaps: &[Snap]) -> Option<String> {
    let first = snaps.first()?;
    let more = if snaps.len() > 1 { format!(" (the first of {})", snaps.len()) } else { String::new() };
    Some(format!(
        "the increment to time {:.5}{more} jumped: its forces fell on the way, and an energy of {:.4e} at the least was set free; \
         most moved {}. `control = \"arc-length\"` follows loads without a jump",
        first.time, first.energy, first.largest
    ))
}

/// What the run knows of its cost, and of promises that it bends.
fn cost(summary: &mut Summary, run: &Run, seconds: f64) {
    (summary.attempts, summary.iterations) = (run.state.attempts, run.state.iterations);
    summary.timings.insert("run".into(), seconds);
    let counts = run.solver_counts();
    (summary.factorisations, summary.symmetric_factorisations) = (counts.factorisations, counts.symmetric);
    let spent = run.memory.spent;
    let phases = [
        ("opening", spent.opening),
        ("evaluation", spent.evaluating),
        ("factorisation", counts.factorising),
        ("solution", counts.solving),
        ("compliance", counts.complying),
        ("contact", spent.contact),
    ];
    summary.timings.extend(phases.map(|(phase, time)| (phase.to_owned(), time.as_secs_f64())));
    summary.timings.insert("stability".into(), run.stability.spent.as_secs_f64());
    summary.notes.extend(turns(&run.stability.turns));
    summary.notes.extend(snaps(&run.stability.snaps));
    if engine::provided() && run.state.increment > 0 && counts.factorisations > 0 && run.state.signs.is_none() {
        summary.notes.push(
            "stability was not watched: the linear solver tells nothing of the signs of pivots; a direct one, without \
             `solver.petsc`, does"
                .into(),
        );
    }
    summary.timings.insert("audit".into(), run.audited.as_secs_f64());
    let cut = summary.attempts.saturating_sub(summary.increments);
    if cut > summary.increments / 2 {
        summary.notes.push(format!(
            "{cut} of {} attempts at an increment were cut; the page \"When a run does not converge\" of the manual says what helps",
            summary.attempts
        ));
    }
    if run.state.held > 0 {
        let first =
            run.first_held.as_ref().map_or(String::new(), |(what, time)| format!(" ({what} from time {time:.4} on)"));
        summary.notes.push(format!(
            "in {} increments something was held still that nothing holds any more{first}: it stays where it is until something \
             touches it; with `solver.if_free = \"stop\"` the run ends there",
            run.state.held
        ));
    }
    if let Some((most, body, time)) = &run.uneven {
        let part = if *most < 1.0 { format!("{:.0} %", 100.0 * most) } else { "as much as it is".into() };
        summary.notes.push(format!(
            "body '{body}' creeps unevenly over increments: its stress, or the strain that loads make, may be wrong by {part} at time \
             {time:.4}; smaller increments from the beginning of that step on make it right, those that a run chooses without `count`"
        ));
    }
    summary.notes.extend(broken(&run.state));
    if run.state.jumps > 0 {
        summary.notes.push(format!(
            "increments relaxed to an equilibrium beyond an instability: {}; energy set free: {:.4e}",
            run.state.jumps, run.state.released
        ));
    }
}

/// What breaking bonds set free beyond their own energy, over that, from which on it is told,
const BEYOND_BONDS: f64 = 0.1;
/// and from which on more breaks at once than a crack does.
const AS_A_WHOLE: f64 = 2.0;

/// What broke, and how much more energy that set free.
fn broken(state: &State) -> Option<String> {
    let bonds: f64 = state.energies.iter().map(|energies| energies.bonds).sum();
    let beyond = state.released / bonds;
    let why = match beyond {
        _ if bonds == 0.0 || beyond <= BEYOND_BONDS => return None,
        _ if beyond > AS_A_WHOLE => "as where much breaks at once".into(),
        _ => format!(
            "where a crack grows from node to node it takes {:.0} % more energy than the bonds have, since the mesh is too coarse at its \
             end; finer faces make that less",
            100.0 * beyond
        ),
    };
    Some(format!("bonds broke that took an energy of {bonds:.4e}, and {:.4e} more was set free: {why}", state.released))
}

/// Change of the pressure from node to node, over the pressure, from which on it is told.
const ROUGH: f64 = 0.2;

/// Which contacts have a pressure that changes from node to node as none does that is resolved.
fn rough(model: &Model, state: &State) -> Vec<String> {
    let told = |(term, name, contact): &(usize, String, Touching)| {
        let (rough, node) = contact.roughness(&state.histories[*term])?;
        (rough > ROUGH).then(|| {
            format!(
                "contact '{}': its pressure differs by {:.0} % from that of the nodes around, most at {}: the meshes do not resolve it, and \
                 while its force is that of all nodes, its peaks are not to be trusted; finer meshes, and where bodies fit into each other \
                 such as match",
                name,
                100.0 * rough,
                (model.problem.node_name)(node)
            )
        })
    };
    Parts::of(model).contacts.iter().filter_map(told).collect()
}

/// Which contacts have a law with a memory, most of which tips of a tool bear.
fn memory_of_tips(model: &Model, state: &State) -> Vec<String> {
    let told = |(term, name, contact): &(usize, String, Touching)| {
        let remembers = !contact.variables().is_empty() && contact.borne_by_tips(&state.histories[*term]) > 0.5;
        remembers.then(|| {
            format!(
                "contact '{name}': its law remembers what a point of the surface has slipped, but it is narrower than a face, so that a vertex or \
                 rounding of the tool bears it, which takes that along over the surface; faces smaller than the contact is wide do not"
            )
        })
    };
    Parts::of(model).contacts.iter().filter_map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Frame, Reading};
    use super::*;

    #[test]
    fn a_body_that_leaves_small_strain_is_named() {
        let mut frame = Frame::new(1, 1, 1.0);
        for (body, gradient) in [("body 'soft'", 0.137), ("body 'stiff'", 0.099)] {
            frame.certify(Reading::new("small_strain", body, gradient));
        }
        let mut certificate = Certificate::default();
        certificate.observe(&frame);
        let [said] = &large_strain(&certificate)[..] else { panic!("one note") };
        assert!(said.contains("'soft'") && said.contains("0.14") && said.contains("beyond 0.1"), "{said}");
    }
}
