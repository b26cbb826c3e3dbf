//! A torque on a tool in space, about axes that do not turn with it.
//!
//! The unknowns of the tool's rotation are a vector `w`, and a torque `m` does the work `m . T(w) dw`: the forces on the
//! unknowns are `T^t m`. While the tool turns about one axis only they are the torque itself.

use super::now;
use crate::Failure;
use crate::amplitude::Timeline;
use crate::system::{Attempt, Branch, Dofs, History, Instant, Local, Role, State, Stencil, Stencils, Term};
use crate::tensor::{Dual, Vec3};
use crate::tool::Pose;

/// Components of a torque along the axes of space, each with its course.
#[derive(Debug)]
pub struct TorqueOnTool {
    name: String,
    first: usize,
    components: Vec<Timeline>,
}

impl TorqueOnTool {
    /// A torque on tool number `tool`.
    pub fn new(name: &str, dofs: &Dofs, tool: usize, components: Vec<Timeline>) -> Self {
        Self { name: name.into(), first: dofs.tool(tool) + 3, components }
    }
}

impl Term for TorqueOnTool {
    fn name(&self) -> &str {
        &self.name
    }
    fn role(&self) -> Role {
        Role::Load
    }
    fn initial(&self) -> History {
        History::new([0])
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        _: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let value = |i: usize| self.components.get(i).map_or(0.0, |value| now(value, accepted, at));
        Ok(Box::new(OpenTorque { first: self.first, moment: Vec3([value(0), value(1), value(2)]) }))
    }
    fn name_of(&self, _: usize) -> String {
        format!("the tool under load '{}'", self.name)
    }
}

/// A torque at one instant.
struct OpenTorque {
    first: usize,
    moment: Vec3,
}

impl Attempt for OpenTorque {
    fn scratch(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        out.push(self.first..self.first + 3, 0);
        Ok(())
    }
    fn evaluate(&self, _: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let rotation = Vec3(std::array::from_fn(|i| Dual::<3>::variable(local.u[i], i)));
        let force = Pose::turned(rotation).conjugate(self.moment.lift());
        for i in 0..3 {
            local.force[i] = force[i].re;
            if local.wants_tangent {
                local.tangent[3 * i..3 * i + 3].copy_from_slice(&force[i].du);
            }
        }
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::amplitude::{Amplitude, Change};
    use crate::system::check_tangent;

    /// A constant torque does the work of its moment along any motion, and its tangent is that of differences.
    #[test]
    fn the_tangent_is_exact_at_any_rotation() {
        let constant = |value: f64| Timeline::new([(1.0, Change::To(value, Amplitude::at_once()))]);
        let components = vec![constant(2.0), constant(-1.0), constant(0.5)];
        let torque = TorqueOnTool::new("t", &Dofs::new(3, 0, 1), 0, components);
        let (state, history) = (State::default(), torque.initial());
        let at = Instant { step_time: 1.0, time: 1.0, dt: 1.0, ..Instant::default() };
        let attempt = torque.attempt(&state, &history, at).unwrap();
        let mut stencils = Stencils::default();
        attempt.stencils(&[0.0; 6], &mut stencils).unwrap();
        assert_eq!(stencils.dofs, [3, 4, 5]);
        for w in [[0.0; 3], [0.4, -0.3, 0.8], [3.0, 0.0, 1.0], [0.0, 9.0, 0.0]] {
            let check = check_tangent(attempt.as_ref(), 0, &stencils.list[0], &w, &[1.0; 3]).unwrap();
            assert!(check.error < 1e-9, "{w:?} {}", check.error);
        }
        let mut local = Local { u: vec![0.0, 9.0, 0.0], ..Local::default() };
        local.reset(3);
        attempt.evaluate(0, &stencils.list[0], &mut [], &mut local).unwrap();
        assert!((local.force[1] + 1.0).abs() < 1e-14, "about the axis of the rotation the torque is itself");
    }
}
