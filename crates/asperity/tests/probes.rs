//! Probes against closed forms: homogeneous stretches, a block pressed on a plate and drawn along it.

mod support;

use asperity::output::Columns;
use asperity::output::vtk::{read_grid, read_series};
use support::{made, write_results};
use tempfile::TempDir;

/// Runs a deck with all its files.
fn results(deck: &str, sets: &[&str]) -> TempDir {
    let (made, folder) = (made(deck, sets), tempfile::tempdir().unwrap());
    write_results(&made, folder.path());
    folder
}

/// The last entry of a column of a probe.
fn last(folder: &TempDir, probe: &str, column: &str) -> f64 {
    *numbers(folder, probe, column).last().unwrap()
}

fn numbers(folder: &TempDir, probe: &str, column: &str) -> Vec<f64> {
    let columns = Columns::read(&folder.path().join(format!("probe.{probe}.csv"))).unwrap();
    columns.numbers(column).unwrap_or_else(|| panic!("no column {column} in {:?}", columns.header))
}

/// A bar of graded cells, 2 by 4, stretched along y by a fifth with free sides.
const BAR: &str = r#"
version = 1
space = "plane-stress"
units = "N, mm, s"
thickness = 3.0
[mesh.part.bar.rectangle]
from = [0.0, 0.0]
to = [2.0, 4.0]
cells = [3, 4]
ratio = [2.0, 5.0]
cell = "quad8"
[material.steel.elastic]
young = 1000.0
poisson = 0.3
[body.bar]
material = "steel"
[[step]]
increments.count = 40
displacement."bar.bottom" = { y = 0.0 }
displacement."bar.left" = { x = 0.0 }
displacement."bar.top" = { y = 0.8 }
[probe.whole]
at.group = "bar"
quantities = ["displacement.y", "logarithmic_strain", "cauchy_stress.major", "cauchy_stress.mean", "pressure", "triaxiality"]
take = ["mean", "least", "greatest"]
[probe.end]
at.group = "bar.top"
quantities = ["reaction.y"]
take = ["sum"]
[probe.point]
at.point = [1.3, 1.7]
quantities = ["displacement", "displacement.length", "cauchy_stress.equivalent"]
[probe.line]
at.path = { from = [0.5, 0.0], to = [0.5, 4.0], points = 9 }
quantities = ["displacement.y", "cauchy_stress.yy"]
[probe.node]
at.node = 1
quantities = ["displacement.y", "logarithmic_strain.minor"]
"#;

#[test]
fn a_stretched_bar_is_what_it_is_everywhere() {
    let folder = results(BAR, &[]);
    let strain = 1.2_f64.ln();
    let near = |found: f64, wanted: f64, within: f64| {
        assert!((found - wanted).abs() <= within * wanted.abs().max(1e-3), "{found}, not {wanted}");
    };
    // The mean of a linear field over the area, however the cells are graded.
    near(last(&folder, "whole", "displacement.y.mean"), 0.4, 1e-10);
    near(last(&folder, "whole", "displacement.y.greatest"), 0.8, 1e-12);
    for take in ["mean", "least", "greatest"] {
        let of = |name: &str| last(&folder, "whole", &format!("{name}.{take}"));
        near(of("logarithmic_strain.yy"), strain, 1e-9);
        // The law is integrated in increments of the rate: across to the order of their square.
        near(of("logarithmic_strain.xx"), -0.3 * strain, 1e-4);
        near(of("logarithmic_strain.zz"), -0.3 * strain, 1e-4);
        near(of("cauchy_stress.major"), 1000.0 * strain, 1e-4);
        near(of("cauchy_stress.mean"), of("cauchy_stress.major") / 3.0, 1e-8);
        near(of("pressure"), -of("cauchy_stress.mean"), 1e-8);
        near(of("triaxiality"), 1.0 / 3.0, 1e-8);
    }
    let stress = last(&folder, "whole", "cauchy_stress.major.mean");
    let across = (2.0 * last(&folder, "whole", "logarithmic_strain.xx.mean")).exp();
    near(last(&folder, "end", "reaction.y.sum"), stress * 6.0 * across, 1e-8);
    near(last(&folder, "point", "displacement.y"), 0.2 * 1.7, 1e-9);
    near(last(&folder, "point", "y"), 1.2 * 1.7, 1e-9);
    let [ux, uy] = ["x", "y"].map(|axis| last(&folder, "point", &format!("displacement.{axis}")));
    near(last(&folder, "point", "displacement.length"), ux.hypot(uy), 1e-12);
    near(last(&folder, "point", "cauchy_stress.equivalent"), stress, 1e-8);
    near(last(&folder, "node", "logarithmic_strain.minor"), -0.3 * strain, 1e-4);
    let (distance, u) = (numbers(&folder, "line", "distance"), numbers(&folder, "line", "displacement.y"));
    assert_eq!((distance.len(), distance[8]), (9 * 40, 4.0));
    for (distance, u) in distance[9 * 39..].iter().zip(&u[9 * 39..]) {
        assert!((u - 0.2 * distance).abs() < 1e-10, "{u} at {distance}");
    }
    let header = std::fs::read_to_string(folder.path().join("probe.end.csv")).unwrap();
    assert!(header.starts_with("time [s],step,increment,reaction.y.sum [N]\n"), "{header}");
}

#[test]
fn plastic_strain_is_what_the_curve_leaves() {
    let law = "material.steel={von_mises={young=1000.0,poisson=0.3,yield_stress=50.0,hardening=100.0}}";
    let folder =
        results(BAR, &[law, "probe.point.quantities=[\"equivalent_plastic_strain\", \"cauchy_stress.major\"]"]);
    let (plastic, stress) =
        (last(&folder, "point", "equivalent_plastic_strain"), last(&folder, "point", "cauchy_stress.major"));
    // 50 + 100 p = 1000 (e - p)
    let wanted = (1000.0 * 1.2_f64.ln() - 50.0) / 1100.0;
    assert!((plastic - wanted).abs() < 2e-4 * wanted, "{plastic}, not {wanted}");
    assert!((stress - 50.0 - 100.0 * plastic).abs() < 1e-6, "{stress}");
}

#[test]
fn finite_rotation_is_no_strain() {
    let turned = r#"step=[{increments={count=10},motion={bar={rotation=90.0}}}]"#;
    let rigid = "rigid.bar={group=\"bar\",reference=[0.0,0.0]}";
    let folder = results(BAR, &[turned, rigid, "probe.end.quantities=[\"displacement\"]", "probe.end.take=[\"mean\"]"]);
    for axis in ["xx", "yy", "zz", "xy"] {
        let most = last(&folder, "whole", &format!("logarithmic_strain.{axis}.greatest"));
        assert!(most.abs() < 1e-12, "{axis}: {most}");
    }
}

/// A block of graded cells pressed on a plate and drawn along it: uniform pressure, friction a fifth of it.
const BLOCK: &str = r#"
version = 1
space = "plane-strain"
[mesh.part.block.rectangle]
from = [0.0, 0.0]
to = [4.0, 2.0]
cells = [5, 3]
cell = "quad4"
[material.soft.elastic]
young = 1000.0
poisson = 0.0
[body.block]
material = "soft"
[tool.plate]
profile = [{ line = [[9.0, 0.0], [-9.0, 0.0]] }]
[contact.base]
surface = "block.bottom"
target = "plate"
law.coulomb = { friction = 0.2 }
[[step]]
increments.count = 4
displacement."block" = { x = 0.0 }
displacement."block.top" = { y = -0.02 }
[[step]]
increments.count = 4
displacement."block" = { x = 0.5 }
displacement."block.top" = { y = -0.02 }
[probe.base]
at.group = "block.bottom"
quantities = ["contact_pressure", "contact_shear", "contact_gap", "contact_status", "cauchy_stress.yy"]
take = ["mean", "least", "greatest"]
[probe.held]
at.group = "block.top"
quantities = ["reaction"]
take = ["sum"]
"#;

#[test]
fn contact_stress_on_faces_is_that_of_the_block() {
    for form in ["field", "paper"] {
        let folder = results(BLOCK, &[&format!("contact.base.form=\"{form}\"")]);
        let force = -last(&folder, "held", "reaction.y.sum");
        for take in ["mean", "least", "greatest"] {
            let of = |name: &str| last(&folder, "base", &format!("{name}.{take}"));
            assert!((of("contact_pressure") - force / 4.0).abs() < 1e-6 * force, "{form}: {take}");
            assert!((of("contact_shear") - 0.2 * force / 4.0).abs() < 1e-6 * force, "{form}: {take}");
            assert!((of("contact_status") - 2.0).abs() < 1e-12, "{form}: {take}");
            assert!((of("contact_pressure") + of("cauchy_stress.yy")).abs() < 1e-2 * force, "{form}: {take}");
            assert!(of("contact_gap") <= 0.0 && of("contact_gap") > -0.01, "{form}: {}", of("contact_gap"));
        }
        let frames = read_series(&folder.path().join("surfaces.pvd")).unwrap();
        let faces = read_grid(&folder.path().join(&frames.last().unwrap().1)).unwrap();
        assert_eq!((faces.cells.len(), faces.points.len()), (5, 6));
        let cell = |name: &str| faces.cell_array(name).unwrap().values.to_real();
        assert!(cell("contact_pressure").iter().all(|p| (p - force / 4.0).abs() < 1e-6 * force));
        assert!(
            cell("contact_shear").chunks_exact(3).all(|s| (s[0] + 0.2 * force / 4.0).abs() < 1e-6 * force),
            "against the way"
        );
        assert_eq!(cell("contact_status"), [2.0; 5]);
    }
}

#[test]
fn mistakes_of_probes_are_told_where_they_stand() {
    let told = |set: &str| {
        let made = asperity::deck::read(BAR, "bar.toml", std::path::Path::new(""), &[set.to_owned()]);
        made.and_then(asperity::deck::build).err().unwrap_or_else(|| panic!("{set} is taken")).render(false)
    };
    for (set, said) in [
        ("probe.node.quantities=[\"displacment.y\"]", "did you mean `displacement`?"),
        ("probe.node.quantities=[\"cauchy_stress.majr\"]", "did you mean `major`?"),
        ("probe.node.at={node=1000}", "nodes have numbers from 1 to"),
        ("probe.node.at={point=[3.0,1.0]}", "there is no material at this point"),
        ("probe.node.at={point=[1.0,1.0,1.0]}", "a point has 2 coordinates"),
        ("probe.line.at={path={from=[0.0,0.0],to=[0.0,5.0]}}", "where there is no material"),
        ("probe.node.at={group=\"bar.topp\"}", "bar.top"),
        ("probe.point.take=[\"sum\"]", "has no meaning"),
        ("probe.end.quantities=[\"displacement.y\"]", "a sum of `displacement.y` over nodes has no meaning"),
        ("units=\"N, millimetre\"", "is no unit of length"),
        ("output.export=[\"frx\"]", "did you mean `frd`?"),
        ("output.print=[{of={cells=\"bar\"},quantities=[\"cauchy_stres\"]}]", "did you mean `cauchy_stress`?"),
    ] {
        let found = told(set);
        assert!(found.contains(said), "{set}: {found}");
    }
}

/// Where bodies overlap a point is read in the first of them, and the user is told.
#[test]
fn a_point_of_two_bodies_is_told() {
    const FIT: &str = r#"
version = 1
space = "axisymmetric"
mesh.part.shaft.rectangle = { from = [0.0, 0.0], to = [20.02, 10.0], cells = [4, 2], cell = "quad8" }
mesh.part.ring.rectangle = { from = [20.0, 0.0], to = [40.0, 10.0], cells = [4, 2], cell = "quad8" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.shaft.material = "steel"
body.ring.material = "steel"
contact.fit = { surface = "ring.left", target = "shaft.right", overlap = "ramp", law.frictionless = {} }
probe.bore = { at.point = [20.002, 4.0], quantities = ["cauchy_stress.zz"] }
probe.skin = { at.point = [20.018, 4.0], quantities = ["cauchy_stress.zz"] }
probe.inside = { at.point = [21.0, 5.0], quantities = ["cauchy_stress.zz"] }
probe.line = { at.path = { from = [19.0, 5.0], to = [21.0, 5.0], points = 201 }, quantities = ["cauchy_stress.zz"] }
[[step]]
displacement."shaft.bottom" = { y = 0.0 }
displacement."ring.bottom" = { y = 0.0 }
"#;
    let made = asperity::deck::read(FIT, "fit.toml", ".".as_ref(), &[]).and_then(asperity::deck::build);
    let made = made.unwrap_or_else(|found| panic!("{}", found.render(false)));
    let told: Vec<_> = made.diagnostics.list.iter().filter(|d| d.what.contains("the probe reads `")).collect();
    assert_eq!(told.len(), 3, "{}", made.diagnostics.render(false));
    assert!(told.iter().all(|d| d.what.contains("lies in `shaft` and `ring`")), "{}", told[0].what);
    // That body is read in which the point lies deeper: the stress is that of compression in the shaft, of tension in the ring.
    let reads =
        |at: &str| told.iter().find(|d| d.what.contains(at)).unwrap().what.rsplit(' ').next().unwrap().to_owned();
    assert_eq!([reads("20.002"), reads("20.018")], ["`shaft`", "`ring`"]);
    let folder = results(FIT, &[]);
    let [bore, skin] = ["bore", "skin"].map(|probe| last(&folder, probe, "cauchy_stress.zz"));
    assert!(bore < -10.0 && skin > 10.0, "{bore} in the shaft, {skin} in the ring");
}

/// Contact stresses lie on the side that carries them; a probe of the other one is refused, and the side is named.
#[test]
fn contact_stresses_are_read_where_they_are_carried() {
    let deck = |group: &str| {
        format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.i.rectangle = {{ from = [0.0, 0.0], to = [10.0, 3.0], cells = [8, 3], cell = "quad4" }}
mesh.part.o.rectangle = {{ from = [0.0, 3.0], to = [10.0, 6.0], cells = [11, 3], cell = "quad4" }}
material.m.elastic = {{ young = 1e3, poisson = 0.3 }}
body.i.material = "m"
body.o.material = "m"
contact.c = {{ surface = "i.top", target = "o.bottom", law.frictionless = {{}} }}
probe.p = {{ at.group = "{group}", quantities = ["contact_pressure"], take = ["mean", "least", "greatest"] }}
[[step]]
symmetry = ["i.left", "o.left", "i.bottom"]
pressure."o.top".value = 10.0
"#
        )
    };
    let made = |group: &str| {
        asperity::deck::read(&deck(group), "p.toml", ".".as_ref(), &[]).and_then(asperity::deck::build).map(|_| ())
    };
    let folder = results(&deck("o.bottom"), &[]);
    for take in ["mean", "least", "greatest"] {
        let found = last(&folder, "p", &format!("contact_pressure.{take}"));
        assert!((found - 10.0).abs() < 0.1, "{take}: {found}");
    }
    let said = made("i.top").unwrap_err().render(false);
    assert!(said.contains("`contact_pressure`") && said.contains("`o.bottom` carries contact `c`"), "{said}");
    assert!(made("i.right").unwrap_err().render(false).contains("no contact has its points here"));
}
