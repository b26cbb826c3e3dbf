//! Total strain and the scalar variables of the laws, with pressure and triaxiality of the stress, for viewers and probes:
//! strain at the integration points, all of them as means at nodes, which are named as such.

use super::Source;
use crate::output::average::NodalMean;
use crate::output::{Frame, Quantity, QuantityPlace, Unit, Width};
use asperity_core::Error;
use asperity_core::material::{Variable, VariableKind};

/// Name of the total strain.
const STRAIN: &str = "logarithmic_strain";

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let mesh = source.parts.mesh;
    let (mut mean, mut all) = (NodalMean::new(mesh, 6), Vec::new());
    let mut variables: Vec<(&'static str, NodalMean)> = Vec::new();
    let counts = source.counting();
    for (term, body) in &source.parts.bodies {
        let (history, len) = (source.history(*term)?, body.point_len());
        let takes = |node: usize| counts(*term, node);
        let scalars = scalars(body.material().variables());
        for (name, _) in &scalars {
            if variables.iter().all(|(known, _)| known != name) {
                variables.push((name, NodalMean::new(mesh, 1).bounded()));
            }
        }
        for (slot, &cell) in body.cells().iter().enumerate() {
            let (states, first) = (history.slot(slot), all.len());
            all.extend(body.total_strains(slot, &source.state.u, states).flatten());
            let rule = body.rule(mesh.cell(cell).kind);
            mean.add(cell, rule, &all[first..], takes)?;
            for (name, place) in &scalars {
                let values: Vec<f64> = states.chunks_exact(len).map(|state| state[*place]).collect();
                let own = variables.iter_mut().find(|(known, _)| known == name);
                own.map_or(Ok(()), |(_, mean)| mean.add(cell, rule, &values, takes))?;
            }
        }
    }
    frame.push(Quantity::new(STRAIN, Unit::One, QuantityPlace::Gauss, Width::Symmetric, all))?;
    let nodal = |name: &str, unit, width, values| {
        Quantity::new(format!("{name}_averaged"), unit, QuantityPlace::Node, width, values)
    };
    frame.push(nodal(STRAIN, Unit::One, Width::Symmetric, mean.finish()))?;
    for (name, mean) in variables {
        frame.push(nodal(name, Unit::One, Width::Scalar, mean.finish()))?;
    }
    let values = |name: &str| frame.get(QuantityPlace::Node, name).map(|quantity| quantity.values.as_slice());
    let (Some(stress), Some(equivalent)) = (values("cauchy_stress_averaged"), values("von_mises_averaged")) else {
        return Err(Error::Internal("stress is reported after what follows from it".into()));
    };
    let pressure: Vec<f64> = stress.as_chunks::<6>().0.iter().map(|s| -(s[0] + s[1] + s[2]) / 3.0).collect();
    // Without a deviator the ratio has no value.
    let ratio =
        |(pressure, equivalent): (&f64, &f64)| if *equivalent > 0.0 { -pressure / equivalent } else { f64::NAN };
    let triaxiality = pressure.iter().zip(equivalent).map(ratio).collect();
    frame.push(nodal("pressure", Unit::Stress, Width::Scalar, pressure))?;
    frame.push(nodal("triaxiality", Unit::One, Width::Scalar, triaxiality))
}

/// Names of the scalar variables of a law, and their places in the state of a point.
fn scalars(variables: &[Variable]) -> Vec<(&'static str, usize)> {
    let mut place = 6;
    let mut found = Vec::new();
    for variable in variables {
        if variable.kind == VariableKind::Scalar {
            found.push((variable.name, place));
        }
        place += variable.len();
    }
    found
}
