use super::*;
use asperity_core::FailureKind;

/// A steel block on a plate that it touches, pressed by a displacement.
fn block() -> Facts {
    Facts {
        size: 4.0,
        bodies: vec![BodyFacts {
            name: "block".into(),
            material: "steel".into(),
            size: 4.0,
            cell: 0.5,
            young: 210e3,
            bulk_ratio: 2.2,
            left: 1.0,
            held: true,
            ..BodyFacts::default()
        }],
        contacts: vec![ContactFacts {
            name: "sole".into(),
            bodies: vec!["block".into()],
            tool: Some("plate".into()),
            points: 9,
            seeing: 9,
            gap: Some(0.0),
            edge: 0.5,
            friction: Some(0.2),
            ..ContactFacts::default()
        }],
        tools: vec![ToolFacts { name: "plate".into(), size: 40.0, driven: true }],
        steps: vec![StepFacts {
            name: "press".into(),
            moved: 0.1,
            first: 0.1,
            largest: 0.1,
            smallest: 1e-6,
            ..StepFacts::default()
        }],
        tolerance: 1e-6,
        iterations: 25,
        ..Facts::default()
    }
}

fn failed(kind: FailureKind, reason: &str) -> RunCourse {
    let fault = Fault { kind, reason: reason.into(), size: 0.1, residual: 0.1, allowed: 1e-6, changes: 0 };
    RunCourse {
        ended: End::Failed(kind),
        reason: reason.into(),
        faults: vec![fault; 6],
        closed: vec![("sole".into(), true)],
        acceleration: 1.0,
        ..RunCourse::default()
    }
}

fn first(facts: &Facts, course: &RunCourse) -> String {
    let found = diagnose(facts, course);
    assert!(found.iter().all(|finding| (0.0..=1.0).contains(&finding.weight) && !finding.what.is_empty()));
    assert!(found.iter().all(|finding| !finding.evidence.is_empty() && !finding.advice.is_empty()), "{found:?}");
    found.first().map_or_else(String::new, |finding| finding.cause.clone())
}

#[test]
fn nothing_is_found_where_nothing_is_wrong() {
    assert_eq!(diagnose(&block(), &RunCourse { closed: vec![("sole".into(), true)], ..RunCourse::default() }), []);
    assert_eq!(oddities(&block()), []);
}

#[test]
fn there_is_always_a_finding_for_a_run_that_failed() {
    assert_eq!(first(&block(), &failed(FailureKind::Other, "something else")), "unknown");
}

#[test]
fn a_free_body_waits_for_its_contact_or_is_held_by_nothing() {
    let free = failed(FailureKind::Free, "body 'block' is free along y: nothing holds it");
    assert_eq!(first(&block(), &free), "free-body");
    let mut facts = block();
    facts.contacts[0].gap = Some(0.2);
    assert_eq!(first(&facts, &free), "not-touching");
    let lost = RunCourse { increments: 5, ..free };
    assert_eq!(first(&facts, &lost), "lost-contact");
}

#[test]
fn a_tool_on_the_wrong_side_comes_before_all_that_it_leads_to() {
    let mut facts = block();
    (facts.contacts[0].inside, facts.contacts[0].seeing, facts.contacts[0].gap) = (1.0, 0, None);
    for course in [
        failed(FailureKind::Passage, "body 'block' lies 3 cells deep in tool 'plate'"),
        failed(FailureKind::Free, "body 'block' is free"),
    ] {
        assert_eq!(first(&facts, &course), "wrong-side");
    }
}

#[test]
fn passages_are_told_by_whether_a_contact_knows_of_them() {
    let course = failed(FailureKind::Passage, "body 'block' lies 0.30 cells deep in tool 'plate' at (0, 0)");
    assert_eq!(first(&block(), &course), "passage");
    let facts = Facts { contacts: Vec::new(), ..block() };
    assert_eq!(first(&facts, &course), "missing-contact");
}

#[test]
fn loads_are_measured_by_what_bears_them() {
    let mut facts = block();
    (facts.bodies[0].yield_stress, facts.bodies[0].strength) = (Some(250.0), Some(250.0));
    let load = |stress| Load { name: "pressure.block.top".into(), bodies: vec!["block".into()], stress };
    let course = failed(FailureKind::Iterations, "the largest unbalanced force");
    facts.steps[0].loads = vec![load(1000.0)];
    assert_eq!(first(&facts, &course), "limit-load");
    facts.steps[0].loads = vec![load(1e8)];
    assert_eq!(first(&facts, &course), "units");
}

#[test]
fn what_held_at_first_and_lets_go_later_is_named() {
    let mut facts = block();
    facts.steps[0].loads = vec![Load { name: "force.block.left".into(), bodies: vec!["block".into()], stress: 1.0 }];
    let course =
        RunCourse { increments: 9, part: 0.4, ..failed(FailureKind::Iterations, "the largest unbalanced force") };
    let adrift = Some(("body 'block' is free along x".to_owned(), 0.4));
    let slipping = RunCourse { touching: 7, ..course.clone() };
    assert_eq!(first(&facts, &slipping), "slides");
    assert_ne!(first(&facts, &RunCourse { sticking: 1, ..slipping.clone() }), "slides");
    let found = diagnose(&facts, &RunCourse { adrift: adrift.clone(), ..slipping.clone() });
    assert!(found[0].evidence.iter().any(|line| line.contains("free along x from time 0.4")), "{found:?}");
    assert_eq!(first(&facts, &RunCourse { adrift, ..course }), "lost-contact");
    facts.contacts[0].friction = None;
    assert_ne!(first(&facts, &slipping), "slides");
}

/// Where the iterations fail, a block under its weight slides off a slope and not off a table.
#[test]
fn what_friction_holds_does_not_slide() {
    let mut facts = block();
    (facts.bodies[0].held, facts.bodies[0].unheld) = (false, vec!["x", "y", "z"]);
    let course = RunCourse { closed: vec![], ..failed(FailureKind::Iterations, "the largest unbalanced force") };
    let causes = |slope: Option<f64>| {
        let mut facts = facts.clone();
        facts.contacts[0].slope = slope;
        diagnose(&facts, &course).into_iter().map(|found| found.cause).collect::<Vec<_>>()
    };
    for slope in [None, Some(0.5)] {
        assert!(causes(slope).contains(&"slides".to_owned()), "{slope:?}");
    }
    let found = causes(Some(0.1));
    assert!(!found.iter().any(|cause| ["slides", "free-body"].contains(&cause.as_str())), "{found:?}");
}

#[test]
fn numbers_that_hardly_belong_together_are_odd() {
    let odd = |change: &dyn Fn(&mut Facts)| {
        let mut facts = block();
        change(&mut facts);
        oddities(&facts).len()
    };
    assert_eq!(odd(&|facts| facts.bodies[0].yield_stress = Some(250.0)), 0);
    assert_eq!(odd(&|facts| facts.bodies[0].yield_stress = Some(250e6)), 1);
    assert_eq!(odd(&|facts| facts.bodies[0].yield_stress = Some(250e-6)), 1);
    assert_eq!(odd(&|facts| facts.tools[0].size = 0.004), 1);
    assert_eq!(odd(&|facts| facts.contacts[0].distance = 4000.0), 1);
    assert_eq!(odd(&|facts| facts.steps[0].driven = 1e4), 1);
}

#[test]
fn of_each_cause_there_is_one_finding_and_the_strongest_comes_first() {
    let mut facts = block();
    facts.bodies[0].locks = true;
    facts.bodies[0].bulk_ratio = 1e4;
    let doubt = Doubted { figure: "pressure_oscillation".into(), value: 40.0, limit: 3.0, ..Doubted::default() };
    let course = RunCourse { doubts: vec![doubt], closed: vec![("sole".into(), true)], ..RunCourse::default() };
    let found = diagnose(&facts, &course);
    assert_eq!(found.iter().map(|finding| finding.cause.as_str()).collect::<Vec<_>>(), ["locking"]);
    assert!(found.is_sorted_by(|a, b| a.weight >= b.weight));
}

/// Numbers that are hardly meant, each by its own words.
#[test]
fn odd_numbers_are_told_by_their_keys() {
    let mut facts = block();
    assert!(oddities(&facts).is_empty(), "{:?}", oddities(&facts));
    facts.contacts[0].friction = Some(30.0);
    facts.bodies[0].law = ("mohr_coulomb", vec![("friction", 0.52), ("hardening", 5e8)]);
    facts.bodies[0].driven_whole = Some("press".into());
    facts.length_unit = Some("mm".into());
    facts.steps[0].gravity = Some(9.81);
    let again = StepFacts { name: "again".into(), repeats: true, ..facts.steps[0].clone() };
    facts.steps.push(again);
    let told = oddities(&facts).into_iter().map(|oddity| oddity.what).collect::<Vec<_>>().join("\n");
    for words in ["friction of 30", "0.52 degrees", "`hardening`", "every node", "gravity of 9.81", "holds already"] {
        assert!(told.contains(words), "{words}: {told}");
    }
}
