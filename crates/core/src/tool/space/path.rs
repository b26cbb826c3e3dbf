//! A profile swept along a path of straight lines and arcs in a plane: extruded along lines, revolved about the centres of arcs.

use super::ProfileFrame;
use super::solids::{Facets, Profile, extruded, polygons, sector};
use crate::tensor::Vec3;
use crate::tool::fillet::{Draft, rounded};
use crate::tool::shapes::find;
use crate::tool::{FindingSeverity, ProfileFinding, ProfileTool};

/// Lengths below this part of the radius of the arcs are none.
const NOTHING: f64 = 1e-12;

/// A path in the plane of x and y of its frame through corners that are rounded by `radius`.
#[derive(Debug, Clone)]
pub struct SweepPath {
    /// Its frame; the profile's y axis is z of this.
    pub frame: ProfileFrame,
    /// Its corners in the order of travel.
    pub corners: Vec<Vec3>,
    /// Radius of the arcs.
    pub radius: f64,
    /// Whether it comes back to its first corner.
    pub closed: bool,
}

/// An arc of a path.
struct PathArc {
    center: Vec3,
    /// Whether the path turns left there.
    left: bool,
    /// From the centre to its ends.
    ends: [Vec3; 2],
}

/// A profile carried along a path, its x to the right of travel. One that begins or ends over the centres of the arcs, at `x = -radius`,
/// is joined there by a flat face if the path is closed and never turns right.
///
/// # Errors
/// In words, if the path has too few corners, meets itself or runs back, its arcs do not fit, or the profile reaches beyond their centres.
pub fn swept(profile: &[Draft], path: &SweepPath) -> Result<Facets, String> {
    let (mut facets, mut arcs) = (Facets::new(), Vec::new());
    for (_, _, nodes) in path.parts()? {
        match nodes[..] {
            [from, middle, to] => {
                let arc = path.arc([from, middle, to]);
                facets.extend(path.turn(profile, &arc)?);
                arcs.push(arc);
            }
            _ => facets.extend(path.straight(profile, [nodes[0], nodes[1]])?),
        }
    }
    if path.closed && arcs.len() > 2 && arcs.iter().all(|arc| arc.left) {
        facets.extend(path.flat_ends(profile, &arcs)?);
    }
    if facets.iter().map(|facet| facet.bounds()).any(|bounds| !(bounds.min.is_finite() && bounds.max.is_finite())) {
        return Err("the path leads too far away for numbers".into());
    }
    Ok(facets)
}

/// The segments of a profile with their nodes at other places, from its end to its beginning if it is turned round.
fn built(profile: &[Draft], place: impl Fn(Vec3) -> Vec3, turned: bool) -> Result<Profile, String> {
    let segment = |(_, kind, nodes): &Draft| {
        let mut placed: Vec<Vec3> = nodes.iter().map(|&x| place(x)).collect();
        if turned {
            placed.reverse();
        }
        kind.build(&placed)
    };
    profile.iter().map(segment).collect()
}

impl SweepPath {
    /// Its lines and arcs.
    fn parts(&self) -> Result<Vec<Draft>, String> {
        let n = self.corners.len();
        if n < if self.closed { 3 } else { 2 } {
            return Err("the path has too few corners".into());
        }
        let line = find("line")?;
        let side = |i: usize| (i, line, vec![self.corners[i], self.corners[(i + 1) % n]]);
        let sides: Vec<Draft> = (0..n - usize::from(!self.closed)).map(side).collect();
        let drawn = ProfileTool::new("path", vec![built(&sides, |x| x, false)?], Vec3::zero());
        let grave = |finding: &ProfileFinding| {
            finding.severity() == FindingSeverity::Error && !matches!(finding, ProfileFinding::Clockwise(..))
        };
        if let Some(finding) = drawn.check(false).into_iter().find(grave) {
            return Err(format!("the path between corners: {finding}"));
        }
        rounded(sides, self.radius).map_err(|_| "the arcs of the path do not fit between its corners".into())
    }

    fn arc(&self, [from, middle, to]: [Vec3; 3]) -> PathArc {
        let center = middle + ((from + to) * 0.5 - middle).unit() * self.radius;
        let left = (middle - from).cross(to - middle)[2] > 0.0;
        PathArc { center, left, ends: [from, to].map(|x| x - center) }
    }

    /// The profile along a line.
    fn straight(&self, profile: &[Draft], [from, to]: [Vec3; 2]) -> Result<Facets, String> {
        let along = self.frame.turn(to - from);
        let (x, y, z) = (along.cross(self.frame.z).unit(), self.frame.z, -along.unit());
        let across = ProfileFrame { origin: self.frame.place(to), x, y, z };
        Ok(extruded(built(profile, |x| x, false)?, across, along.norm()))
    }

    /// The profile around an arc, the centre of which is on its left or, where the path turns right, on its right.
    fn turn(&self, profile: &[Draft], arc: &PathArc) -> Result<Facets, String> {
        let (radius, sign) = (self.radius, if arc.left { 1.0 } else { -1.0 });
        let profile = built(profile, |x| Vec3::new(radius + sign * x[0], x[1], 0.0), !arc.left)?;
        if profile.iter().any(|shape| shape.bounds().min[0] < -NOTHING * radius) {
            return Err(format!(
                "the profile reaches over the middle of an arc of the path, by more than its radius {radius}"
            ));
        }
        // Clockwise as seen from the profile's y axis.
        let [a, b] = arc.ends;
        let (from, to) = if arc.left { (b, a) } else { (a, b) };
        let (x, y) = (self.frame.turn(from).unit(), self.frame.z);
        let about = ProfileFrame { origin: self.frame.place(arc.center), x, y, z: x.cross(y) };
        Ok(sector(profile, about, to.cross(from)[2].atan2(to.dot(from)), NOTHING * radius).collect())
    }

    /// Flat faces between the centres of the arcs where the profile begins or ends over them. The tool's material is on the left of the
    /// profile: above where it begins, below where it ends.
    fn flat_ends(&self, profile: &[Draft], arcs: &[PathArc]) -> Result<Facets, String> {
        let first = profile.first().and_then(|(.., nodes)| nodes.first());
        let last = profile.last().and_then(|(.., nodes)| nodes.last());
        let mut facets = Facets::new();
        for (end, looks_up) in [(first, false), (last, true)] {
            let Some(end) = end.filter(|x| (x[0] + self.radius).abs() <= NOTHING * self.radius) else { continue };
            let at = |k: usize| self.frame.place(arcs[k].center + Vec3::new(0.0, 0.0, end[1]));
            let fan = (1..arcs.len() - 1).map(|k| if looks_up { [0, k, k + 1] } else { [0, k + 1, k] });
            facets.extend(polygons(fan.map(|corners| corners.map(at).to_vec()))?);
        }
        Ok(facets)
    }
}
