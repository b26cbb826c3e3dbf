//! Rigid tools, with what their check finds shown at the segments concerned.

use super::Builder;
use crate::deck::diagnose::Diagnostic;
use crate::deck::keys::ToolKeys;
use crate::deck::reader::Name;
use crate::deck::source::Place;
use crate::mesh::Space;
use crate::tensor::Vec3;
use crate::tool::{Finding, Severity, Tool};
use std::sync::Arc;

impl Builder<'_> {
    /// The tools.
    pub(super) fn tools(&mut self) -> Option<Vec<Arc<Tool>>> {
        let tools: Vec<_> = self.deck.tool.iter().map(|(name, keys)| self.tool(name, keys)).collect();
        tools.into_iter().collect()
    }

    fn tool(&mut self, name: &Name, keys: &ToolKeys) -> Option<Arc<Tool>> {
        if !self.plane() {
            let what = format!("the tool `{name}` is drawn in the plane, but space = \"solid\"");
            let help = "tools are for the plane spaces and the axisymmetric one";
            self.found.push(Diagnostic::error(what).at(name.place).help(help));
            return None;
        }
        let mut segments = Vec::new();
        for segment in &keys.profile.value {
            let built = segment.kind.build(&segment.nodes).map_err(crate::Error::input);
            segments.push(self.keep(built, segment.place));
        }
        let reference = Vec3::new(keys.reference[0], keys.reference[1], 0.0);
        let tool = Tool::new(&name.text, vec![segments.into_iter().collect::<Option<_>>()?], reference);
        self.judge(&tool, keys).then(|| Arc::new(tool))
    }

    /// Whether a tool can be used; what is found is shown at its segments.
    fn judge(&mut self, tool: &Tool, keys: &ToolKeys) -> bool {
        let mut sound = true;
        for finding in tool.check(self.site.space == Space::Axisymmetric) {
            let segments = &keys.profile.value;
            let first = finding.segments().first().and_then(|&i| segments.get(i)).map(|segment| segment.place);
            let place: Place = first.unwrap_or(keys.profile.place);
            let what = format!("tool `{}`: {finding}", tool.name());
            let grave = finding.severity() == Severity::Error;
            sound &= !grave;
            let diagnostic = if grave { Diagnostic::error(what) } else { Diagnostic::note(what) }.at(place);
            self.found.push(match remedy(&finding) {
                "" => diagnostic,
                help => diagnostic.help(help),
            });
        }
        sound
    }
}

/// What to do about a finding whose sentence does not say it.
fn remedy(finding: &Finding) -> &'static str {
    match finding {
        Finding::Gap(..) => "begin each segment in the very point in which the one before ends",
        Finding::NoLength(_) => "remove the segment, or move one of its ends",
        Finding::NegativeRadius(..) => "x is the radius, y the axis: draw the tool where x is positive",
        Finding::Crossing(..) => "a profile goes around the tool's material once and never meets itself",
        Finding::Kink(..) if finding.severity() == Severity::Error => "the profile may not run back along itself",
        _ => "",
    }
}
