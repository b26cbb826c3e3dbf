//! Steps that follow a path.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{ControlWord, StepKeys};
use asperity_core::solve::{ArcLength, Until};

impl Builder<'_> {
    /// How a step follows a path, if it does.
    pub(super) fn path(&mut self, step: &StepKeys) -> Option<ArcLength> {
        if step.control.value == ControlWord::Time {
            return None;
        }
        let until = step.until.as_ref().and_then(|until| {
            let (axis, value) = until.along()?;
            if let Some(z) = until.z.filter(|_| self.plane()) {
                let what = "`until` has a displacement along z, but the model is plane";
                self.found.push(Diagnostic::error(what).at(z.place).help("say `x` or `y`"));
                return None;
            }
            let dofs = self.nodes(&until.group.text).iter().map(|&node| self.site.dofs.node(node) + axis).collect();
            Some(Until { dofs, value })
        });
        let grows = step.increments.count.is_none() && step.increments.largest.is_none();
        Some(ArcLength { until, grows })
    }
}
