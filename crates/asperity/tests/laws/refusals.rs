//! Sets of numbers that make no solid are refused by name, at their line.

use asperity::deck::read_point;
use std::path::Path;

/// What is said against a material.
fn refused(material: &str) -> String {
    let text = format!("version = 1\nmaterial.m = {{ {material} }}\n[[step]]\nstrain.xx = 0.1\n");
    match read_point(&text, "deck.toml", Path::new(""), &[]) {
        Ok(_) => panic!("accepted: {material}"),
        Err(diagnostics) => diagnostics.render(false),
    }
}

#[test]
fn impossible_sets_are_refused_by_name() {
    let steel = "young = 1.0, poisson = 0.3, yield_stress = 1.0";
    let sand = "young = 1.0, poisson = 0.3, cohesion = 1.0";
    let end = "end_cohesion = 1.0, end_friction = 25.0, change_strain = 0.1";
    let sheet = |more: &str| format!("hill = {{ {steel}, r0 = 1.0, r45 = 1.0, r90 = 1.0, {more} }}");
    let wood = |more: &str| {
        let moduli = "young_1 = 10.0, young_2 = 1.0, young_3 = 1.0, shear_12 = 1.0, shear_13 = 1.0, shear_23 = 1.0";
        let ratios = if more.contains("poisson_12") { "" } else { "poisson_12 = 0.3, " };
        format!("orthotropic = {{ {moduli}, {ratios}poisson_13 = 0.3, poisson_23 = 0.3, {more} }}")
    };
    let clay = |more: &str| {
        let common = "critical_slope = 1.0, specific_volume = 2.0, initial_pressure = 1.0";
        format!("modified_cam_clay = {{ {common}, {more} }}")
    };
    let rock = |more: &str| {
        let joint = "joint_cohesion = 1.0, joint_friction = 30.0";
        format!("ubiquitous_joint = {{ {sand}, friction = 40.0, {joint}, {more} }}")
    };
    for (material, said) in [
        ("elastic = { young = 1.0, poisson = 0.5 }".to_string(), "poisson"),
        (format!("von_mises = {{ {steel}, saturation = -0.9, saturation_rate = 2.0 }}"), "slope -1.8, steeper"),
        (format!("von_mises = {{ {steel}, saturation = -1.0, saturation_rate = 0.1 }}"), "must be positive"),
        (format!("von_mises = {{ {steel}, saturation = 1.0 }}"), "`saturation_rate`"),
        (format!("von_mises = {{ {steel}, recovery = 1.0 }}"), "`recovery` has nothing to recover"),
        ("von_mises_table = { young = 1.0, poisson = 0.3, curve = [[0.1, 1.0]] }".into(), "plastic strain 0"),
        (
            "von_mises_table = { young = 1.0, poisson = 0.3, curve = [[0.0, 1.0], [0.1, nan]] }".into(),
            "finite number, not NaN",
        ),
        ("von_mises_table = { young = 1.0, poisson = 0.3, curve = [[0.0, 1.0], [0.0, 2.0]] }".into(), "must rise"),
        ("von_mises_table = { young = 1.0, poisson = 0.3, curve = [[0.0, 0.0]] }".into(), "positive, not 0"),
        ("von_mises_table = { young = 1.0, poisson = 0.3, curve = [[0.0, 9.0], [0.1, 1.0]] }".into(), "steeper"),
        (
            format!("chaboche = {{ {steel}, kinematic_1 = 1.0, recovery_3 = 1.0 }}"),
            "`recovery_3` has nothing to recover",
        ),
        (sheet("normal_z = 0.0"), "`normal_z` are zero"),
        (sheet("rolling_x = 0.0, rolling_z = 2.0"), "say no direction across"),
        (wood("poisson_12 = 4.0"), "are too large for these moduli"),
        (wood("first_x = 0.0, first_z = 1.0"), "say no direction across"),
        ("anisotropic = { c1111 = 1.0, c2222 = 1.0, c3333 = 1.0, c1212 = 1.0, c1313 = 1.0 }".into(), "no stiffness"),
        (format!("hill_coefficients = {{ {steel}, f = -0.5, g = 1.0, h = 0.5 }}"), "no closed surface"),
        (
            format!("mohr_coulomb_hardening = {{ {sand}, friction = 30.0, {end}, end_dilatancy = 26.0 }}"),
            "`end_dilatancy`, 26",
        ),
        (format!("drucker_prager_hardening = {{ {sand}, friction = 0.0, {end} }}"), "must both be zero or neither"),
        ("mooney_rivlin = { c10 = 0.0, c01 = 0.0, bulk = 1.0 }".into(), "both zero"),
        ("yeoh = { c10 = 1.0, c20 = -2.0, c30 = 1.0, bulk = 1.0 }".into(), "stiffness falls to nothing"),
        ("arruda_boyce = { modulus = 1.0, locking_stretch = 1.0, bulk = 1.0 }".into(), "locking_stretch"),
        ("ogden = { bulk = 1.0, terms = [[1.0, -2.0]] }".into(), "positive product"),
        (
            format!("drucker_prager = {{ {sand}, friction = 20.0, dilatancy = 21.0 }}"),
            "`dilatancy`, 21, must not exceed",
        ),
        (format!("mohr_coulomb = {{ {sand}, friction = 20.0, dilatancy = 21.0 }}"), "must not exceed"),
        (rock("normal_x = 0.0, normal_y = 0.0"), "the joints have no direction"),
        (rock("normal_x = 1.0, normal_y = 0.0, joint_dilatancy = 31.0"), "`joint_dilatancy`, 31, must not exceed"),
        (rock("normal_x = 1.0, normal_y = 0.0, joint_tension = 2.0"), "`joint_tension`, 2, lies beyond the tip"),
        (clay("lambda = 0.04, kappa = 0.2, poisson = 0.3, preconsolidation = 2.0"), "`kappa`, 0.2, must be smaller"),
        (clay("lambda = 0.2, kappa = 0.04, poisson = 0.3, preconsolidation = 0.5"), "is below `initial_pressure`, 1"),
        (clay("lambda = 0.2, kappa = 0.04, poisson = -0.3, preconsolidation = 2.0"), "must not be negative"),
        (
            format!("gurson = {{ {steel}, porosity = 0.1, critical_porosity = 0.05 }}"),
            "`porosity`, 0.1, must be smaller",
        ),
        (format!("gurson = {{ {steel}, porosity = 0.01, failure_porosity = 0.1 }}"), "`critical_porosity`, 0.15"),
        (format!("gurson = {{ {steel}, porosity = 0.01, q3 = 3.0 }}"), "`q3` at most"),
        ("norton_hoff = { young = 1.0, poisson = 0.3, consistency = 1.0, sensitivity = 2.0 }".into(), "sensitivity"),
        (format!("perzyna = {{ {steel}, fluidity = 1.0, power = 0.5 }}"), "power"),
    ] {
        let text = refused(&material);
        assert!(text.contains(said), "{material}: {text}");
        assert!(text.contains("deck.toml:2"), "{material}: {text}");
    }
}

#[test]
fn a_path_says_each_component_once_and_curves_name_columns() {
    let deck = |more: &str| {
        let text = format!(
            "version = 1\nmaterial.m.elastic = {{ young = 1.0, poisson = 0.3 }}\n[[step]]\nstrain.xx = 0.1\n{more}"
        );
        read_point(&text, "deck.toml", Path::new(""), &[]).err().map(|d| d.render(false)).unwrap_or_default()
    };
    assert_eq!(deck(""), "");
    assert!(deck("stress.xx = 1.0").contains("both strain and stress of `xx`"));
    assert!(deck("[[curve]]\nx = \"strain_xx\"\ny = [\"stres_xx\"]").contains("did you mean `stress_xx`?"));
    assert!(deck("[update]\ntheta = 0.5").contains("midpoint scheme"));
}

#[test]
fn hyperelastic_laws_have_nothing_to_sub_step() {
    let text = "version = 1\nupdate.substeps = 2\nmaterial.m.neo_hookean = { shear = 1.0, bulk = 1.0 }\n[[step]]\n";
    let Err(found) = read_point(text, "deck.toml", Path::new(""), &[]) else { panic!("accepted") };
    assert!(found.render(false).contains("nothing to sub-step"));
}

#[test]
fn hyperelastic_laws_have_no_rate() {
    let text = "version = 1\nrate = \"green-naghdi\"\nmaterial.m.neo_hookean = { shear = 1.0, bulk = 1.0 }\n[[step]]\n";
    let Err(found) = read_point(text, "deck.toml", Path::new(""), &[]) else { panic!("accepted") };
    assert!(found.render(false).contains("no objective rate enters it"));
}

#[test]
fn a_back_stress_in_the_frame_of_jaumann_has_a_note() {
    let notes = |more: &str, rate: &str| {
        let steel = format!("young = 200e3, poisson = 0.3, yield_stress = 200.0{more}");
        let text = format!("version = 1\n{rate}material.m.von_mises = {{ {steel} }}\n[[step]]\nstrain.xx = 0.1\n");
        read_point(&text, "deck.toml", Path::new(""), &[])
            .unwrap_or_else(|e| panic!("{}", e.render(false)))
            .diagnostics
            .render(false)
    };
    let jaumann = "rate = \"jaumann\"\n";
    assert!(notes(", kinematic = 20e3", jaumann).contains("a back stress turns with the spin"));
    let sub_steps = format!("{jaumann}update.substeps = 2\n");
    assert!(notes(", kinematic = 20e3", &sub_steps).contains("a back stress turns with the spin"));
    assert_eq!(notes(", kinematic = 20e3", ""), "");
    assert_eq!(notes("", jaumann), "");
}

#[test]
fn what_rubber_and_soils_take_is_refused_of_others() {
    let refused = |keys: &str, material: &str| {
        let text = format!("version = 1\n{keys}\nmaterial.m = {{ {material} }}\n[[step]]\nstrain.xx = 0.1\n");
        read_point(&text, "deck.toml", Path::new(""), &[]).err().map(|d| d.render(false)).unwrap_or_default()
    };
    let (steel, rubber) = ("elastic = { young = 1.0, poisson = 0.3 }", "neo_hookean = { shear = 1.0, bulk = 1.0 }");
    let plain = "saint_venant_kirchhoff = { young = 1.0, poisson = 0.3 }";
    assert!(refused("prony = [[0.5, 1.0]]", steel).contains("only hyperelastic laws"));
    assert!(refused("mullins = { r = 2.0, m = 1.0 }", plain).contains("does not keep volume and shape apart"));
    assert!(refused("prony = [[0.5, 1.0], [0.5, 2.0]]", rubber).contains("less than 1 in all, not 1"));
    assert!(refused("pore_stiffness = 1.0", rubber).contains("no pore water"));
    assert_eq!(refused("prony = [[0.5, 1.0], [0.4, 2.0]]\nmullins = { r = 2.0, m = 1.0 }", rubber), "");
    let fast = "von_mises_johnson_cook = { young = 9.0, poisson = 0.3, yield_stress = 1.0, strength = 1.0, exponent = 0.5, \
                rate_sensitivity = 0.1 }";
    assert!(refused("update.scheme = \"midpoint\"", fast).contains("does not serve a flow stress"));
}
