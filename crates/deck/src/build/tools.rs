//! Rigid tools, with what their check finds shown at the segments concerned.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{SegmentKeys, ToolKeys};
use crate::reader::Name;
use crate::source::{Place, Spot};
use asperity_core::mesh::Space;
use asperity_core::tensor::Vec3;
use asperity_core::tool::{Draft, FindingSeverity, ProfileFinding, ProfileShape, ProfileTool, rounded};
use std::sync::Arc;

/// Segments, and where each is said.
pub(super) type Segments = (Vec<Box<dyn ProfileShape>>, Vec<Place>);

impl Builder<'_> {
    /// The tools.
    pub(super) fn tools(&mut self) -> Option<Vec<Arc<ProfileTool>>> {
        let tools: Vec<_> = self.deck.tool.iter().map(|(name, keys)| self.tool(name, keys)).collect();
        tools.into_iter().collect()
    }

    fn tool(&mut self, name: &Name, keys: &ToolKeys) -> Option<Arc<ProfileTool>> {
        let profile = keys.profile.as_ref().filter(|_| keys.swept().is_empty());
        let Some(profile) = profile else {
            let what = format!("the tool `{name}` is a body of space, but space = \"{}\"", self.site.space.name());
            let help = "in the plane a tool is a `profile`, neither revolved nor extruded nor swept";
            self.found.push(Diagnostic::error(what).at(keys.place).help(help));
            return None;
        };
        let (segments, places) = self.segments(profile, keys, self.site.mesh.origin)?;
        let reference = self.reference(name, keys, 2)?;
        let tool = ProfileTool::new(&name.text, vec![segments], reference);
        let axisymmetric = self.site.space == Space::Axisymmetric;
        self.judge(&tool, (&places, profile.place), axisymmetric).then(|| Arc::new(tool))
    }

    /// The segments of a profile, from an origin and with its fillets.
    pub(super) fn drafts(
        &mut self,
        profile: &Spot<Vec<SegmentKeys>>,
        keys: &ToolKeys,
        origin: Vec3,
    ) -> Option<Vec<Draft>> {
        let draft = |(i, segment): (usize, &SegmentKeys)| {
            (i, segment.kind, segment.nodes.iter().map(|&node| node - origin).collect())
        };
        let drafts: Vec<Draft> = profile.value.iter().enumerate().map(draft).collect();
        match keys.fillet {
            Some(fillet) => self.keep(rounded(drafts, fillet.value).map_err(asperity_core::Error::input), fillet.place),
            None => Some(drafts),
        }
    }

    /// The same, built, and where each is said.
    pub(super) fn segments(
        &mut self,
        profile: &Spot<Vec<SegmentKeys>>,
        keys: &ToolKeys,
        origin: Vec3,
    ) -> Option<Segments> {
        let (mut segments, mut places) = (Vec::new(), Vec::new());
        for (i, kind, nodes) in self.drafts(profile, keys, origin)? {
            let place = profile.value[i].place;
            segments.push(self.keep(kind.build(&nodes).map_err(asperity_core::Error::input), place));
            places.push(place);
        }
        Some((segments.into_iter().collect::<Option<_>>()?, places))
    }

    /// The reference point of a tool, which must have as many coordinates as the space.
    pub(super) fn reference(&mut self, name: &Name, keys: &ToolKeys, dimension: usize) -> Option<Vec3> {
        let Some(reference) = &keys.reference else { return Some(self.point(&[])) };
        if reference.len() != dimension {
            let has = reference.len();
            let what = format!("`tool.{name}.reference` must have {dimension} coordinates in this space; it has {has}");
            self.refuse(what, reference.place);
            return None;
        }
        Some(self.point(reference))
    }

    /// Whether a tool can be used; what is found is shown at its segments.
    pub(super) fn judge(&mut self, tool: &ProfileTool, (places, whole): (&[Place], Place), revolved: bool) -> bool {
        let mut sound = true;
        for finding in tool.check(revolved) {
            let first = finding.segments().first().and_then(|&i| places.get(i)).copied();
            let place = first.unwrap_or(whole);
            let what = format!("tool `{}`: {finding}", tool.name());
            let grave = finding.severity() == FindingSeverity::Error;
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
fn remedy(finding: &ProfileFinding) -> &'static str {
    match finding {
        ProfileFinding::Gap(..) => "begin each segment in the very point in which the one before ends",
        ProfileFinding::NoLength(_) => "remove the segment, or move one of its ends",
        ProfileFinding::NegativeRadius(..) => "x is the radius, y the axis: draw the tool where x is positive",
        ProfileFinding::Crossing(..) => "a profile goes around the tool's material once and never meets itself",
        ProfileFinding::Kink(..) if finding.severity() == FindingSeverity::Error => {
            "the profile may not run back along itself"
        }
        _ => "",
    }
}
