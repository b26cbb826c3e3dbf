//! The penalty that needs no guess: 50 times what the surface can follow, the least over the faces of both sides. A face follows
//! by squeezing the cell behind it, `M / h`, with `M` the lesser of `lambda + 2 G` and `4 G` of the undeformed law and `h` the
//! size of the cell (its volume over the area of the face); that of a thin body by bending, which is softer, and softer still where the
//! law flows.

use super::options::RaisedPenalty;
use super::thin::{Plate, area, curvature, stiffness};
use crate::mesh::{Mesh, Side, Space};

/// Ratio of the penalty to the stiffness behind a face.
const RATIO: f64 = 50.0;

/// Part of it that serves with two passes: each side answers the other with a penalty of its own, and what a stiffer pair
/// disagrees about from point to point, friction least of all, leaves Newton's method without an end.
pub const TWO_PASSES: f64 = 0.2;

/// What stands behind a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Backing {
    /// Stiffness of the material against pressure,
    pub modulus: f64,
    /// and where it is confined.
    pub confined: f64,
    /// What flow leaves of it where a plate is bent: a secant modulus over it.
    pub secant: f64,
    /// The body where it is thin.
    pub plate: Option<Plate>,
}

/// Part of half of the boundary of a thin body that a surface must be to be a face of the plate and not its rim.
const FACE: f64 = 0.5;

/// Share of its thickness that a thin body may be penetrated whatever the energy: that of a sheet that a holder presses is small, and few
/// of its nodes follow a stiffer penalty.
const SLIGHT: f64 = 1e-4;

/// A penalty that no user gave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefaultPenalty {
    /// A stress per length.
    pub value: f64,
    /// How it may be raised.
    pub raised: RaisedPenalty,
    /// The modulus of both sides against each other.
    pub modulus: f64,
}

/// Largest penalty over the stiffness of the cells in compression: no more than rounding allows beside that.
const HIGHEST: f64 = 256.0;

/// Default penalty between the `surfaces`, with what stands behind the faces of a cell.
pub fn default_penalty(
    (mesh, space): (&Mesh, Space),
    surfaces: &[&[Side]],
    behind: impl Fn(usize) -> Backing,
) -> DefaultPenalty {
    let least = |a: DefaultPenalty, b: DefaultPenalty| if b.value < a.value { b } else { a };
    let stiffest = DefaultPenalty {
        value: f64::INFINITY,
        raised: RaisedPenalty { from: 0.0, most: f64::INFINITY },
        modulus: f64::INFINITY,
    };
    let of = |sides: &&[Side]| {
        let (curvature, area) = (curvature(mesh, sides, space), area(mesh, sides));
        let followed = |side: &Side| {
            let Backing { modulus, confined, secant, plate } = behind(side.cell);
            let squeezed = 1.0 / mesh.depth(*side);
            let plate = plate.filter(|plate| area > FACE * plate.area);
            let bent = plate.map(|plate| (secant * stiffness(plate.thickness, curvature), SLIGHT * plate.thickness));
            let (followed, from) = bent.filter(|bent| bent.0 < squeezed).unwrap_or((squeezed, 0.0));
            let most = HIGHEST * RATIO * confined.max(modulus) * followed;
            DefaultPenalty { value: RATIO * modulus * followed, raised: RaisedPenalty { from, most }, modulus }
        };
        sides.iter().map(followed).fold(stiffest, least)
    };
    let softest = |sides: &&[Side]| sides.iter().map(|side| behind(side.cell).modulus).fold(f64::INFINITY, f64::min);
    let compliance: f64 = surfaces.iter().map(softest).map(f64::recip).sum();
    DefaultPenalty { modulus: compliance.recip(), ..surfaces.iter().map(of).fold(stiffest, least) }
}
