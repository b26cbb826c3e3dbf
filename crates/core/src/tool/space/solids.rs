//! Tools in space from a few numbers, and from profiles. Each is a list of facets that look outward.

use super::nearest::RigidFacet;
use super::polygons::{Quad, Triangle};
use super::swept::{Extruded, ProfileFrame, Revolved};
use crate::tensor::Vec3;
use crate::tool::fillet::{Draft, rounded};
use crate::tool::shapes::{ProfileShape, find};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Facets of a tool.
pub type Facets = Vec<Box<dyn RigidFacet>>;

/// Segments of a profile, its material on the left.
pub type Profile = Vec<Box<dyn ProfileShape>>;

/// A profile revolved once about the y axis of its frame; its x is the distance from the axis. Segments on the axis
/// make no facet.
pub fn revolved(profile: Profile, frame: ProfileFrame) -> Facets {
    let size = profile.iter().map(|shape| shape.bounds().size()).fold(0.0, f64::max);
    sector(profile, frame, TAU, 1e-12 * size).collect()
}

/// A profile revolved by an angle; segments within `least` of the axis make no facet.
pub(super) fn sector(
    profile: Profile,
    frame: ProfileFrame,
    turn: f64,
    least: f64,
) -> impl Iterator<Item = Box<dyn RigidFacet>> {
    let off_axis = profile.into_iter().filter(move |shape| shape.bounds().max[0] > least);
    off_axis.map(move |shape| Box::new(Revolved::new(Arc::from(shape), frame, turn)) as _)
}

/// A profile carried along the z axis of its frame; the ends stay open.
pub fn extruded(profile: Profile, frame: ProfileFrame, length: f64) -> Facets {
    let facet = |shape: Box<dyn ProfileShape>| Box::new(Extruded { shape: Arc::from(shape), frame, length }) as _;
    profile.into_iter().map(facet).collect()
}

/// Polygons of three or four corners.
///
/// # Errors
/// In words, for a polygon with another number of corners.
pub fn polygons(all: impl IntoIterator<Item = Vec<Vec3>>) -> Result<Facets, String> {
    let polygon = |corners: Vec<Vec3>| -> Result<Box<dyn RigidFacet>, String> {
        match corners[..] {
            [a, b, c] => Ok(Box::new(Triangle([a, b, c]))),
            [a, b, c, d] => Ok(Box::new(Quad([a, b, c, d]))),
            _ => Err(format!("a facet has three or four corners, not {}", corners.len())),
        }
    };
    all.into_iter().map(polygon).collect()
}

/// The quarter of a circle or more about `(x, y)` from angle `from` to `to`, in degrees.
fn arc([x, y]: [f64; 2], radius: f64, [from, to]: [f64; 2]) -> Result<Box<dyn ProfileShape>, String> {
    let at = |angle: f64| {
        // Exact at whole quarters, so that profiles end on the axis.
        let (sin, cos) = match angle.rem_euclid(360.0) {
            0.0 => (0.0, 1.0),
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            270.0 => (-1.0, 0.0),
            _ => angle.to_radians().sin_cos(),
        };
        Vec3::new(x + radius * cos, y + radius * sin, 0.0)
    };
    find("arc")?.build(&[at(from), at(0.5 * (from + to)), at(to)])
}

/// A square plate around `at` whose face looks along `normal`.
///
/// # Errors
/// In words, if `normal` has no direction.
pub fn plane(at: Vec3, normal: Vec3, side: f64) -> Result<Facets, String> {
    let frame = ProfileFrame::about(at, normal).map_err(|_| "the normal has no direction".to_owned())?;
    let corner = |x: f64, z: f64| at + frame.x * (x * side * 0.5) + frame.z * (z * side * 0.5);
    // y looks out: x turns to -z seen from there.
    Ok(vec![Box::new(Quad([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)]))])
}

/// A ball.
///
/// # Errors
/// None that numbers within their ranges could cause.
pub fn sphere(center: Vec3, radius: f64) -> Result<Facets, String> {
    let frame = ProfileFrame::about(center, Vec3::new(0.0, 0.0, 1.0))?;
    let halves = [arc([0.0; 2], radius, [-90.0, 0.0])?, arc([0.0; 2], radius, [0.0, 90.0])?];
    Ok(revolved(halves.into(), frame))
}

/// A ring whose tube of radius `tube` runs around `center` at the distance `radius`.
///
/// # Errors
/// In words, if `axis` has no direction.
pub fn torus(center: Vec3, axis: Vec3, radius: f64, tube: f64) -> Result<Facets, String> {
    if tube > radius {
        return Err("the tube of a torus is thinner than its radius".into());
    }
    let frame = ProfileFrame::about(center, axis)?;
    let quarters = [-90.0, 0.0, 90.0, 180.0].map(|from| arc([radius, 0.0], tube, [from, from + 90.0]));
    Ok(revolved(quarters.into_iter().collect::<Result<_, _>>()?, frame))
}

/// A frustum with flat ends of the given radii at `from` and `to`, one of which may be zero; with `round` its rims are
/// rounded by a fillet of that radius.
///
/// # Errors
/// In words, if the ends coincide, both radii are zero, or the fillet does not fit.
pub fn cone(from: Vec3, to: Vec3, radii: [f64; 2], round: f64) -> Result<Facets, String> {
    let height = (to - from).norm();
    let frame = ProfileFrame::about(from, to - from).map_err(|_| "its two ends are the same point".to_owned())?;
    if radii == [0.0; 2] {
        return Err("one of its radii must be above zero".into());
    }
    let corners = [[0.0, 0.0], [radii[0], 0.0], [radii[1], height], [0.0, height]];
    let mut corners = corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
    corners.dedup();
    let line = find("line")?;
    let mut sides: Vec<Draft> = corners.windows(2).enumerate().map(|(i, ends)| (i, line, ends.to_vec())).collect();
    if round > 0.0 {
        sides = rounded(sides, round).map_err(|_| "the fillet is too large for the segments that it joins")?;
    }
    Ok(revolved(sides.iter().map(|(_, kind, nodes)| kind.build(nodes)).collect::<Result<_, _>>()?, frame))
}
