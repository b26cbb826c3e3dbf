//! A law without a mesh: steel is stretched, and its stress follows the flow curve.
//! `cargo run --release -p asperity --example law`

use asperity::deck::read_driven;

const DECK: &str = r#"
version = 1
material.steel.von_mises_swift = { young = 210e3, poisson = 0.3, strength = 550.0, offset = 0.005, exponent = 0.22 }

[[step]]
increments = 50
strain.xx = 0.1
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let driven = read_driven(DECK, "law.toml", ".".as_ref(), &[]).map_err(|found| found.render(false))?;
    let (records, stopped) = driven.follow();
    if let Some(error) = stopped {
        return Err(error.into());
    }
    // A table of each law: strains, stresses, energies, and the variables of the law.
    let steel = &records[0];
    let column = |name: &str| steel.columns.iter().position(|column| column == name).expect("a column of every law");
    let (strain, stress) = (column("strain_xx"), column("stress_xx"));
    for row in steel.rows.iter().step_by(10) {
        println!("strain {:.3}: stress {:.1}", row[strain], row[stress]);
    }

    // The plastic strain is what the elastic one leaves.
    let last = steel.rows.last().expect("rows");
    let curve = 550.0 * (0.005 + last[strain] - last[stress] / 210e3_f64).powf(0.22);
    println!("flow curve at the end: {curve:.1}");
    assert!((last[stress] / curve - 1.0).abs() < 1e-4, "{} beside {curve}", last[stress]);
    Ok(())
}

#[test]
fn flow_curve() {
    main().unwrap();
}
