//! Motion of the rigid tools and what holds them.

use super::Source;
use crate::output::{Frame, Quantity, QuantityPlace, Unit, Width};
use asperity_core::Error;
use asperity_core::tensor::Vec3;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let dofs = source.parts.dofs;
    for (number, tool) in source.parts.tool_names().into_iter().enumerate() {
        let first = dofs.tool(number);
        let held = |dof: usize| source.reaction(dof);
        let moved = |dof: usize| source.state.u[dof];
        let translation = |of: &dyn Fn(usize) -> f64| padded((0..dofs.per_node()).map(|a| of(first + a)), 0);
        let rotations = dofs.per_tool() - dofs.per_node();
        let rotation =
            |of: &dyn Fn(usize) -> f64| padded((0..rotations).map(|a| of(first + dofs.per_node() + a)), 3 - rotations);
        let mut push = |what: &str, unit, width, values: [f64; 3]| {
            let name = format!("tool.{tool}.{what}");
            frame.push(Quantity::new(name, unit, QuantityPlace::Global, width, values.to_vec()))
        };
        push("translation", Unit::Length, Width::Vector, translation(&moved))?;
        push("rotation", Unit::Angle, Width::Axial, rotation(&|dof| moved(dof).to_degrees()))?;
        push("force", Unit::Force, Width::Vector, translation(&held))?;
        let conjugate = rotation(&held);
        let moment = source.pose(number).moment(Vec3(conjugate)).0;
        push("moment", Unit::Moment, Width::Axial, moment)?;
    }
    Ok(())
}

/// Up to three values, from place `first` on, among zeros.
fn padded(values: impl Iterator<Item = f64>, first: usize) -> [f64; 3] {
    let mut out = [0.0; 3];
    out[first..].iter_mut().zip(values).for_each(|(out, value)| *out = value);
    out
}

#[cfg(test)]
mod tests {
    use super::padded;

    #[test]
    fn a_plane_rotation_is_about_z() {
        assert_eq!(padded([7.0].into_iter(), 2), [0.0, 0.0, 7.0]);
        assert_eq!(padded([1.0, 2.0].into_iter(), 0), [1.0, 2.0, 0.0]);
    }
}
