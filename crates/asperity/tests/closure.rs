//! Pressure over penetration by a table: what presses, what slides and what is stored follow from it.

mod support;

use support::{columns, model, run};

/// A block of width 2 and height 1, without contraction, pressed onto a plate by 0.02 and drawn along it by 0.01.
fn deck(form: &str) -> String {
    format!(
        "version = 1
        space = \"plane-strain\"
        mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [2.0, 1.0], cells = [4, 2], cell = \"quad4\" }}
        material.m.elastic = {{ young = 1e3, poisson = 0.0 }}
        body.block = {{ material = \"m\", strain = \"small\", formulation = \"standard\" }}
        tool.plate.profile = [{{ line = [[9.0, 0.0], [-9.0, 0.0]] }}]
        [contact.base]
        surface = \"block.bottom\"
        target = \"plate\"
        form = \"{form}\"
        law.coulomb = {{ friction = 0.1 }}
        closure = [[0.0, 0.0], [1e-3, 5.0], [2e-3, 25.0]]
        [[step]]
        increments.count = 40
        displacement.\"block.top\" = {{ x = 0.0, y = -0.02 }}
        [[step]]
        increments.count = 40
        displacement.\"block.top\" = {{ x = 0.05, y = -0.02 }}"
    )
}

/// `p/1000 + 1e-3 + (p - 5)/2e4 = 0.02`, friction a tenth of it; energy is missing nowhere.
#[test]
fn a_block_is_borne_by_the_table() {
    for form in ["field", "paper"] {
        let model = model(&deck(form), &[]);
        let keep = run(&model);
        let columns = columns(&model, &keep);
        let (p, last) = (0.01925 / 1.05e-3, keep.states.len() - 1);
        let force = |name: &str, at: usize| columns[name][at].abs();
        let [normal, shear] = [force("contact.base.force.y", 39), force("contact.base.force.x", last)];
        assert!((normal / (2.0 * p) - 1.0).abs() < 1e-5, "{form}: {normal}");
        assert!((shear / (0.2 * p) - 1.0).abs() < 0.01, "{form}: {shear}");
        let (missing, external) = (force("energy.missing", 39), force("energy.external", 39));
        assert!((missing / external).abs() < 2e-3, "{form}: {missing} of {external}");
        // What a table takes up is meant, and is no penalty.
        let certificate = support::certificate(&model, &keep);
        assert!(certificate.figure("penalty_energy").is_none() && certificate.figure("max_penetration").is_some());
    }
}
