//! Rigid tools, with what their check finds shown at the segments concerned.

use super::Builder;
use crate::deck::diagnose::Diagnostic;
use crate::deck::keys::{Segment, ToolKeys};
use crate::deck::reader::Name;
use crate::deck::source::{Place, Spot};
use crate::mesh::Space;
use crate::tensor::Vec3;
use crate::tool::{Finding, Severity, Shape, Tool};
use std::sync::Arc;

impl Builder<'_> {
    /// The tools.
    pub(super) fn tools(&mut self) -> Option<Vec<Arc<Tool>>> {
        let tools: Vec<_> = self.deck.tool.iter().map(|(name, keys)| self.tool(name, keys)).collect();
        tools.into_iter().collect()
    }

    fn tool(&mut self, name: &Name, keys: &ToolKeys) -> Option<Arc<Tool>> {
        let profile = keys.profile.as_ref().filter(|_| keys.revolve.is_none() && keys.extrude.is_none());
        let Some(profile) = profile else {
            let what = format!("the tool `{name}` is a body of space, but space = \"{}\"", self.site.space.name());
            let help = "in the plane a tool is a `profile`, neither revolved nor extruded";
            self.found.push(Diagnostic::error(what).at(keys.place).help(help));
            return None;
        };
        let (segments, reference) = (self.segments(profile)?, self.reference(name, keys, 2)?);
        let tool = Tool::new(&name.text, vec![segments], reference);
        self.judge(&tool, profile, self.site.space == Space::Axisymmetric).then(|| Arc::new(tool))
    }

    /// The segments of a profile.
    pub(super) fn segments(&mut self, profile: &Spot<Vec<Segment>>) -> Option<Vec<Box<dyn Shape>>> {
        let mut segments = Vec::new();
        for segment in &profile.value {
            let built = segment.kind.build(&segment.nodes).map_err(crate::Error::input);
            segments.push(self.keep(built, segment.place));
        }
        segments.into_iter().collect()
    }

    /// The reference point of a tool, which must have as many coordinates as the space.
    pub(super) fn reference(&mut self, name: &Name, keys: &ToolKeys, dimension: usize) -> Option<Vec3> {
        let Some(reference) = &keys.reference else { return Some(Vec3::zero()) };
        if reference.len() != dimension {
            let has = reference.len();
            let what = format!("`tool.{name}.reference` must have {dimension} coordinates in this space; it has {has}");
            self.refuse(what, reference.place);
            return None;
        }
        Some(Vec3(std::array::from_fn(|i| reference.get(i).copied().unwrap_or(0.0))))
    }

    /// Whether a tool can be used; what is found is shown at its segments.
    pub(super) fn judge(&mut self, tool: &Tool, profile: &Spot<Vec<Segment>>, revolved: bool) -> bool {
        let mut sound = true;
        for finding in tool.check(revolved) {
            let segments = &profile.value;
            let first = finding.segments().first().and_then(|&i| segments.get(i)).map(|segment| segment.place);
            let place: Place = first.unwrap_or(profile.place);
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
