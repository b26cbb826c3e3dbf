//! Rigid tools in space, with what their check finds shown at the tool concerned.

use super::{Builder, vector};
use crate::diagnose::Diagnostic;
use crate::keys::{FacetKeys, SegmentKeys, StlKeys, ToolKeys};
use crate::reader::Name;
use crate::source::{Place, Spot};
use asperity_core::mesh::formats::stl;
use asperity_core::tensor::Vec3;
use asperity_core::tool::space::solids::{Facets, cone, extruded, plane, polygons, revolved, sphere, torus};
use asperity_core::tool::space::{FacetFinding, ProfileFrame, SpaceTool, SweepPath, is_thin, swept};
use asperity_core::tool::{self, FindingSeverity};
use std::sync::Arc;

impl Builder<'_> {
    /// The tools of a model in space.
    pub(super) fn solid_tools(&mut self) -> Option<Vec<Arc<SpaceTool>>> {
        let tools: Vec<_> = self.deck.tool.iter().map(|(name, keys)| self.solid_tool(name, keys)).collect();
        tools.into_iter().collect()
    }

    fn solid_tool(&mut self, name: &Name, keys: &ToolKeys) -> Option<Arc<SpaceTool>> {
        let (facets, reference) = (self.facets(name, keys), self.reference(name, keys, 3)?);
        let tool = SpaceTool::new(&name.text, facets?, reference);
        self.judge_facets(&tool, keys).then(|| Arc::new(tool))
    }

    fn facets(&mut self, name: &Name, keys: &ToolKeys) -> Option<Facets> {
        if let Some(profile) = &keys.profile {
            return self.swept(name, keys, profile);
        }
        if let Some(stl) = &keys.stl {
            return self.triangles(stl);
        }
        let made = if let Some(facets) = &keys.facets {
            self.of_nodes(facets)
        } else if let Some(it) = &keys.plane {
            plane(self.point(&it.at), vector(&it.normal), it.side)
        } else if let Some(it) = &keys.sphere {
            sphere(self.point(&it.center), it.radius)
        } else if let Some(it) = &keys.cylinder {
            cone(self.point(&it.from), self.point(&it.to), [it.radius; 2], it.fillet)
        } else if let Some(it) = &keys.cone {
            cone(self.point(&it.from), self.point(&it.to), [it.radii[0], it.radii[1]], it.fillet)
        } else {
            let it = keys.torus.as_ref()?;
            torus(self.point(&it.center), vector(&it.axis), it.radius, it.tube)
        };
        let told = made.map_err(|why| asperity_core::Error::input(format!("tool `{name}`: {why}")));
        self.keep(told, keys.place)
    }

    /// A profile that is revolved, extruded or swept, judged as a profile first.
    fn swept(&mut self, name: &Name, keys: &ToolKeys, profile: &Spot<Vec<SegmentKeys>>) -> Option<Facets> {
        let (segments, _) = self.segments(profile, keys, Vec3::zero())?;
        let (again, places) = self.segments(profile, keys, Vec3::zero())?;
        let flat = tool::ProfileTool::new(&name.text, vec![again], Vec3::zero());
        if !self.judge(&flat, (&places, profile.place), keys.revolve.is_some()) {
            return None;
        }
        let told = |why| asperity_core::Error::input(format!("tool `{name}`: {why}"));
        if let Some(it) = &keys.revolve {
            let frame = ProfileFrame::about(self.point(&it.origin), vector(&it.axis)).map_err(told);
            return self.keep(frame, it.place).map(|frame| revolved(segments, frame));
        }
        if let Some(it) = &keys.sweep {
            let drafts = self.drafts(profile, keys, Vec3::zero())?;
            let frame = ProfileFrame::across(self.point(&it.origin), vector(&it.axis), vector(&it.x));
            let corners = it.path.iter().map(|corner| vector(corner)).collect();
            let path = |frame| SweepPath { frame, corners, radius: it.radius, closed: it.closed };
            let facets = frame.and_then(|frame| swept(&drafts, &path(frame)));
            return self.keep(facets.map_err(told), it.place);
        }
        let Some(it) = &keys.extrude else {
            let what = format!("the profile of tool `{name}` is plane, but space = \"solid\"");
            let help = "say `revolve`, `extrude` or `sweep` as well";
            self.found.push(Diagnostic::error(what).at(profile.place).help(help));
            return None;
        };
        let along = vector(&it.along);
        let frame = ProfileFrame::across(self.point(&it.origin), along, vector(&it.x)).map_err(told);
        self.keep(frame, it.place).map(|frame| extruded(segments, frame, along.norm()))
    }

    fn triangles(&mut self, keys: &StlKeys) -> Option<Facets> {
        let path = self.folder.join(&keys.file.value);
        let told = |why: String| asperity_core::Error::input(format!("{}: {why}", path.display()));
        let bytes = asperity_core::files::read(&path);
        let bytes = self.keep(bytes, keys.file.place)?;
        let read = stl::read(&bytes).map_err(told);
        self.files.push(bytes);
        let (thin, triangles): (Vec<_>, Vec<_>) =
            self.keep(read, keys.file.place)?.into_iter().partition(|corners| is_thin(corners));
        if !thin.is_empty() {
            let what = format!("`{}`: {} triangles of no area are left out", keys.file.value, thin.len());
            self.found.push(Diagnostic::note(what).at(keys.file.place));
        }
        let origin = self.point(&keys.origin);
        let corners = |corners: [Vec3; 3]| corners.map(|x| x * keys.scale + origin).to_vec();
        let facets = polygons(triangles.into_iter().map(corners)).map_err(asperity_core::Error::input);
        self.keep(facets, keys.file.place)
    }

    fn of_nodes(&self, keys: &FacetKeys) -> Result<Facets, String> {
        let node = |&number: &usize| keys.nodes.get(number - 1).map(|x| self.point(x));
        let face = |face: &Spot<Vec<usize>>| face.value.iter().filter_map(node).collect();
        polygons(keys.faces.value.iter().map(face))
    }

    /// Whether a tool can be used.
    fn judge_facets(&mut self, tool: &SpaceTool, keys: &ToolKeys) -> bool {
        let mut sound = true;
        for finding in tool.check() {
            let facets = keys.facets.as_ref().map(|facets| facets.faces.value.as_slice());
            let place: Option<Place> = facets.zip(finding.facet()).and_then(|(all, i)| Some(all.get(i)?.place));
            let (what, grave) =
                (format!("tool `{}`: {finding}", tool.name()), finding.severity() == FindingSeverity::Error);
            sound &= !grave;
            let diagnostic = if grave { Diagnostic::error(what) } else { Diagnostic::note(what) };
            let diagnostic = diagnostic.at(place.unwrap_or(keys.place));
            self.found.push(match remedy(&finding) {
                "" => diagnostic,
                help => diagnostic.help(help),
            });
        }
        sound
    }
}

/// What to do about a finding whose sentence does not say it.
fn remedy(finding: &FacetFinding) -> &'static str {
    match finding {
        FacetFinding::Degenerate(_) => "remove the facet, or move one of its corners",
        FacetFinding::Opposed(..) => "list the corners of each facet counter-clockwise as seen from outside",
        FacetFinding::InsideOut => "reverse the order of the corners of every facet",
        _ => "",
    }
}
