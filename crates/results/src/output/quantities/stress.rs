//! Stress and the variables of the laws: raw at the integration points, means over cells, and means at nodes, which are
//! named as such.

use super::Source;
use crate::output::average::NodalMean;
use crate::output::quantity::REFERENCE_POSITION;
use crate::output::{Frame, Quantity, QuantityPlace, Unit, Width};
use asperity_core::Error;
use asperity_core::material::{Variable, VariableKind};
use asperity_core::solid::{Body, PointRecord};

/// One integration point with the numbers of its body and material.
struct Point<'a> {
    record: PointRecord<'a>,
    body: usize,
}

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let count = |(term, solid): &(usize, &Body)| Ok(source.history(*term)?.data.len() / solid.point_len());
    let mut points = Vec::with_capacity(source.parts.bodies.iter().map(count).sum::<Result<_, Error>>()?);
    for (body, (term, solid)) in source.parts.bodies.iter().enumerate() {
        let records = solid.records(&source.state.u, source.history(*term)?);
        points.extend(records.map(|record| Point { record, body }));
    }
    report_points(source, &points, frame)?;
    report_cells(source, &points, frame)?;
    report_nodes(source, frame)
}

fn report_points(source: &Source, points: &[Point], frame: &mut Frame) -> Result<(), Error> {
    let gauss = |name: &str, unit, width, values| Quantity::new(name, unit, QuantityPlace::Gauss, width, values);
    let vector = |of: fn(&PointRecord) -> [f64; 3]| gathered(points, |p| of(&p.record));
    let number = |of: &dyn Fn(&Point) -> usize| points.iter().map(|p| of(p) as f64).collect::<Vec<_>>();
    frame.push(gauss(REFERENCE_POSITION, Unit::Length, Width::Vector, vector(|r| r.reference.0)))?;
    frame.push(gauss("displacement", Unit::Length, Width::Vector, vector(|r| (r.position - r.reference).0)))?;
    frame.push(gauss("volume", Unit::Volume, Width::Scalar, points.iter().map(|p| p.record.volume).collect()))?;
    frame.push(Quantity::integer("cell", QuantityPlace::Gauss, number(&|p| p.record.cell)))?;
    frame.push(Quantity::integer("body", QuantityPlace::Gauss, number(&|p| p.body)))?;
    let stress = gathered(points, |p| std::array::from_fn::<_, 6, _>(|i| p.record.state[i]));
    let equivalent = equivalents(&stress);
    push_stress(frame, QuantityPlace::Gauss, "", (stress, equivalent))?;
    variables(source).into_iter().try_for_each(|variable| frame.push(values_of(variable, source, points)))
}

/// So many numbers of each point, one after another.
fn gathered<const N: usize>(points: &[Point], of: impl Fn(&Point) -> [f64; N]) -> Vec<f64> {
    let mut values = vec![0.0; N * points.len()];
    values.as_chunks_mut::<N>().0.iter_mut().zip(points).for_each(|(values, point)| *values = of(point));
    values
}

/// The variables of all laws, each name once.
fn variables(source: &Source) -> Vec<Variable> {
    let mut all: Vec<Variable> = Vec::new();
    for variable in source.parts.bodies.iter().flat_map(|(_, body)| body.material().variables()) {
        if all.iter().all(|known| known.name != variable.name) {
            all.push(*variable);
        }
    }
    all
}

/// A variable at all points; not a number where the law has none of that name.
fn values_of(variable: Variable, source: &Source, points: &[Point]) -> Quantity {
    let width = match variable.kind {
        VariableKind::Scalar => Width::Scalar,
        VariableKind::Vector => Width::Vector,
        VariableKind::Symmetric => Width::Symmetric,
    };
    let mut values = Vec::with_capacity(points.len() * width.size());
    for point in points {
        let own = source.parts.bodies[point.body].1.material().variables();
        let place = own.iter().position(|known| *known == variable);
        match place.map(|place| 6 + own[..place].iter().map(Variable::len).sum::<usize>()) {
            Some(start) => values.extend_from_slice(&point.record.state[start..start + width.size()]),
            None => values.extend(std::iter::repeat_n(f64::NAN, width.size())),
        }
    }
    Quantity::new(variable.name, Unit::One, QuantityPlace::Gauss, width, values)
}

/// Means over the volume of each cell; cells of no body have none.
fn report_cells(source: &Source, points: &[Point], frame: &mut Frame) -> Result<(), Error> {
    let cells = source.parts.mesh.cell_count();
    let (mut sums, mut volumes) = (vec![[0.0; 6]; cells], vec![0.0; cells]);
    let (mut body, mut material) = (vec![-1.0; cells], vec![-1.0; cells]);
    for Point { record, body: number } in points {
        let cell = record.cell;
        volumes[cell] += record.volume;
        sums[cell].iter_mut().zip(record.state).for_each(|(sum, stress)| *sum += record.volume * stress);
        (body[cell], material[cell]) = (*number as f64, source.parts.materials[*number] as f64);
    }
    let means: Vec<f64> = sums.iter().zip(&volumes).flat_map(|(sum, volume)| sum.map(|s| s / volume)).collect();
    let equivalent = equivalents(&means);
    frame.push(Quantity::integer("body", QuantityPlace::Cell, body))?;
    frame.push(Quantity::integer("material", QuantityPlace::Cell, material))?;
    push_stress(frame, QuantityPlace::Cell, "", (means, equivalent))
}

fn report_nodes(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let mesh = source.parts.mesh;
    let (mut mean, mut stress) = (NodalMean::new(mesh, 6), Vec::new());
    let mut equivalent = NodalMean::new(mesh, 1).bounded();
    let counts = source.counting();
    for (term, body) in &source.parts.bodies {
        let (history, len) = (source.history(*term)?, body.point_len());
        let takes = |node: usize| counts(*term, node);
        for (slot, &cell) in body.cells().iter().enumerate() {
            let states = history.slot(slot).chunks_exact(len);
            stress.clear();
            states.for_each(|state| stress.extend_from_slice(&state[..6]));
            let rule = body.rule(mesh.cell(cell).kind);
            mean.add(cell, rule, &stress, takes)?;
            equivalent.add(cell, rule, &equivalents(&stress), takes)?;
        }
    }
    // Not that of the mean stress: extrapolated components would leave the yield surface.
    push_stress(frame, QuantityPlace::Node, "_averaged", (mean.finish(), equivalent.finish()))
}

fn equivalents(stress: &[f64]) -> Vec<f64> {
    stress.as_chunks().0.iter().map(von_mises).collect()
}

fn push_stress(
    frame: &mut Frame,
    place: QuantityPlace,
    suffix: &str,
    (stress, equivalent): (Vec<f64>, Vec<f64>),
) -> Result<(), Error> {
    let push = |name: &str, width, values| Quantity::new(format!("{name}{suffix}"), Unit::Stress, place, width, values);
    frame.push(push("cauchy_stress", Width::Symmetric, stress))?;
    frame.push(push("von_mises", Width::Scalar, equivalent))
}

/// `sqrt(3/2 s:s)` of the deviator s of a stress XX YY ZZ XY YZ XZ.
fn von_mises(&[xx, yy, zz, xy, yz, xz]: &[f64; 6]) -> f64 {
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::von_mises;

    #[test]
    fn von_mises_measures_shape_and_not_pressure() {
        assert_eq!(von_mises(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
        assert_eq!(von_mises(&[-7.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 7.0);
        assert!((von_mises(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]) - 12f64.sqrt()).abs() < 1e-15);
    }
}
