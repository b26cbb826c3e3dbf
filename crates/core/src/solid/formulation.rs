//! How the deformation of a cell's points is formed, and the choice of it by cell, law and space where a body does not say.
//!
//! Cells whose points each demand their own change of volume lock where the law hardly gives one: they are too stiff, and
//! limit loads are never reached. Where the ratio `K / G` of bulk to shear modulus is as small as that of metals the error
//! is that of the mesh; from [`NEARLY`] on F-bar takes over, and always where a solid flows with no change of volume or with one that
//! follows from its shear. Quadrilaterals and bricks of first degree whose law does neither have incompatible modes, without
//! which they are too stiff in bending; so they have where F-bar would make one or two of them through a body too soft. One to
//! three tetrahedra of second degree through a body share a linear change of volume with others there.

use super::slenderness::{ONE, PLASTIC, STIFF, Slenderness, TWO_POINTS};
use super::{Strain, incompatible};
use crate::material::{Flow, Material};
use crate::mesh::Space;
use crate::mesh::cells::Cell;

/// How the deformation of a point is formed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Formulation {
    /// One of the others, by cell, law and space.
    Auto,
    /// The point's own deformation.
    Standard,
    /// One change of volume for all points of a cell, or of a patch of simplices (F-bar): no volumetric locking.
    FBar,
    /// With incompatible modes of the cell's own: no stiffness in bending that its displacements cannot avoid.
    Incompatible,
}

/// Which quadrature is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integration {
    /// One of the others, by cell and body.
    Auto,
    /// Exact for the stiffness of an undistorted cell.
    Full,
    /// One order lower.
    Reduced,
}

/// How a body is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyOptions {
    /// Formulation.
    pub formulation: Formulation,
    /// Quadrature.
    pub integration: Integration,
    /// Kinematics.
    pub strain: Strain,
    /// Thickness in the plane cases; ignored otherwise.
    pub thickness: f64,
    /// Axes along which the sides that face them are held, so that it does not bend across them however thin it is.
    pub held: [bool; 3],
    /// Where half of its surface or more is bonded, held, glued or stuck, so that it cannot give way along it: cells through it from there.
    pub bonded: Option<f64>,
}

impl Default for BodyOptions {
    fn default() -> Self {
        let (formulation, integration) = (Formulation::Auto, Integration::Auto);
        Self { formulation, integration, strain: Strain::Finite, thickness: 1.0, held: [false; 3], bonded: None }
    }
}

/// Ratio of bulk to shear modulus from which on cells would lock: just below that of Poisson's ratio 0.4, where `quad4` with 16
/// edges a side are 5.0 % too stiff in Cook's membrane and 1.7 % with F-bar (3.7 and 1.8 % at 0.3, 21 and 1.7 % at 0.49).
pub const NEARLY: f64 = 4.6;

/// Cells of first degree through a bonded layer from which on they are near the parabola with which what keeps its volume flows out; of
/// second one fewer.
const FEW: f64 = 4.0;

/// What the cells of one kind in a body became, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The kind.
    pub kind: &'static Cell,
    /// Which of them.
    pub formulation: Formulation,
    /// Their quadrature.
    pub integration: Integration,
    /// Why, in words.
    pub reason: String,
    /// Whether the cells remain too stiff all the same.
    pub locks: bool,
    /// By what part they are too stiff in bending, or with a minus too soft, where that is much.
    pub stiff: Option<f64>,
    /// By what part they are too stiff in bending where their solid flows all through, or with a minus too weak, where that is much.
    plastic: Option<f64>,
    /// Whether one of them lies through a body that flows.
    pub thin: bool,
    /// Whether they are too soft in bending.
    pub soft: bool,
    /// Whether, as tetrahedra of second degree, a few of them share a linear change of volume.
    pub(super) joined: bool,
    /// How many of them lie through a bonded layer that keeps its volume, where they are too few.
    pub layers: Option<f64>,
    /// Whether the law flows,
    flows: bool,
    /// and whether its solid hardly changes its volume.
    pub(super) keeps_volume: bool,
}

impl Choice {
    /// The formulation of the cells of a kind.
    pub(super) fn of(kind: &'static Cell, space: Space, material: &dyn Material, options: &BodyOptions) -> Self {
        let flow = material.flow();
        let [confined, shear] = material.moduli();
        let ratio = confined / shear.max(f64::MIN_POSITIVE) - 4.0 / 3.0;
        let stiff = ratio >= NEARLY;
        let reduced = options.integration == Integration::Reduced && kind.reduced.is_some();
        let standard = |reason: &str, locks: bool| (Formulation::Standard, reason.to_string(), locks);
        let stiff = stiff && flow != Flow::Unknown;
        let layers = options.bonded.filter(|_| stiff || flow == Flow::Isochoric);
        let bends = matches!(flow, Flow::None | Flow::Unknown) && incompatible::has_modes(kind) && !reduced;
        let modes = |reason: &str| (Formulation::Incompatible, reason.to_string(), false);
        let (formulation, reason, locks) = match options.formulation {
            Formulation::Auto if space == Space::PlaneStress && bends => modes("bending, in plane stress"),
            Formulation::Auto | Formulation::Standard if space == Space::PlaneStress => {
                standard("no change of volume locks in plane stress", false)
            }
            Formulation::FBar => (Formulation::FBar, "as said".into(), false),
            Formulation::Incompatible => (Formulation::Incompatible, "as said".into(), false),
            Formulation::Standard => standard("as said", !reduced && (stiff || flow != Flow::None)),
            Formulation::Auto if reduced => standard("reduced integration does not lock", false),
            Formulation::Auto if flow == Flow::Isochoric => {
                (Formulation::FBar, "the law flows with hardly a change of volume".into(), false)
            }
            Formulation::Auto if flow == Flow::Dilatant => {
                (Formulation::FBar, "where the law flows its change of volume follows from the shear".into(), false)
            }
            Formulation::Auto if flow == Flow::Unknown && bends => modes("the law does not say how it flows"),
            Formulation::Auto if flow == Flow::Unknown => standard("the law does not say how it flows", false),
            Formulation::Auto if stiff => {
                (Formulation::FBar, format!("bulk over shear modulus is {}", rounded(ratio)), false)
            }
            Formulation::Auto if bends => {
                modes(&format!("bending; bulk over shear modulus is only {}", rounded(ratio)))
            }
            Formulation::Auto => standard(&format!("bulk over shear modulus is only {}", rounded(ratio)), false),
        };
        let integration = if reduced { Integration::Reduced } else { Integration::Full };
        let flows = matches!(flow, Flow::Isochoric | Flow::Dilatant);
        Self {
            kind,
            formulation,
            integration,
            reason,
            locks,
            stiff: None,
            plastic: None,
            thin: false,
            soft: false,
            joined: false,
            layers,
            flows,
            keeps_volume: stiff,
        }
    }

    /// One line: cells, formulation, reason.
    pub fn line(&self) -> String {
        let word = match self.formulation {
            Formulation::FBar => "f-bar",
            Formulation::Incompatible => "incompatible",
            Formulation::Auto | Formulation::Standard => "standard",
        };
        format!("{} {word}: {}", self.kind.name, self.reason)
    }

    /// The same with what follows from the body's thickness, which is asked for where it matters.
    pub(super) fn in_body(mut self, body: impl FnOnce() -> Slenderness, options: &BodyOptions) -> Self {
        if self.integration == Integration::Reduced && !self.flows {
            self.layers = None;
            return self;
        }
        let (body, bonded) = (body(), self.layers.is_some());
        if self.integration == Integration::Reduced {
            self.layers = None;
        } else {
            self = self.with_formulation(&body, bonded, options);
        }
        let plastic = body.plastic(self.kind, self.formulation, self.integration);
        self.thin = self.flows && !bonded && body.through < ONE;
        let told = bonded || self.soft || self.stiff.is_some();
        self.plastic = Some(plastic).filter(|part| self.flows && !told && part.abs() > PLASTIC);
        self
    }

    fn with_formulation(mut self, body: &Slenderness, bonded: bool, options: &BodyOptions) -> Self {
        self.layers = self.layers.map(f64::round).filter(|layers| *layers < FEW - (self.kind.degree - 1) as f64);
        let (auto, stiff) = (options.formulation == Formulation::Auto, body.stiff(self.kind, self.formulation));
        let free = auto || options.formulation == Formulation::Standard;
        // What is bonded does not bend.
        if !bonded && options.integration == Integration::Auto && free && body.reduces(self.kind, stiff, self.flows) {
            let how = if stiff > 0.0 { "full would be too stiff" } else { "F-bar wrong" };
            let part = (100.0 * stiff.abs()).ceil();
            self.reason =
                format!("reduced integration, since its cells are curved: {how} by up to {part} % where it bends");
            if self.flows && body.through < ONE {
                self.reason +=
                    &format!("; with one through it the plastic moment is {:.0} % too large", 100.0 * TWO_POINTS);
            }
            (self.formulation, self.integration) = (Formulation::Standard, Integration::Reduced);
            (self.locks, self.layers) = (false, None);
            return self;
        }
        self.soft = !bonded && body.soft(self.kind, self.formulation);
        self.stiff = Some(stiff);
        let modes = incompatible::has_modes(self.kind);
        let bends = body.stiff(self.kind, Formulation::Incompatible);
        let shears = modes && self.formulation == Formulation::FBar && !bonded && stiff > STIFF;
        if auto && modes && (self.soft || shears) {
            self.reason = match self.soft {
                true => "bending, with one or two cells through it".into(),
                false => format!("bending, with cells {} times as long as it is thick", rounded(body.along)),
            };
            (self.formulation, self.soft, self.stiff) = (Formulation::Incompatible, false, Some(bends));
        } else if self.soft && !modes {
            (self.joined, self.soft) = (true, false);
            self.stiff = Some(body.stiff(self.kind, Formulation::Standard));
        }
        self.stiff = self.stiff.map(|part| part + body.stretched(self.kind)).filter(|part| part.abs() > STIFF);
        self
    }

    /// What is to be known of a body that bends, and flows all through.
    pub fn plastic_bending(&self) -> Option<String> {
        let (name, part) = (self.kind.name, 100.0 * self.plastic?.abs());
        let why = match (self.kind.degree, self.integration) {
            (1, _) => format!(
                "up to {part:.0} % too stiff: cells as long as that bend with shear there; shorter ones, and two of second degree through \
                 it, do not"
            ),
            (_, Integration::Reduced) => format!(
                "up to {part:.0} % too stiff: one {name} lies through it, with two integration points; two cells are right"
            ),
            _ => format!(
                "up to {part:.0} % too weak: one {name} lies through it, with three integration points; two cells are right"
            ),
        };
        Some(format!("where it bends, and flows all through, its {name} cells are {why}"))
    }

    /// What is to be known where it begins to flow at its surface, between which and the outermost points little does.
    pub fn late_yield(&self) -> String {
        let name = self.kind.name;
        format!(
            "one {name} lies through it, and where it bends its surface reaches yield before the integration points do: until it flows all \
             through it may be wrong by a quarter; two cells of second degree through it, or four of first, are right"
        )
    }

    /// What is to be known where the cells lock.
    pub fn advice(&self) -> impl Iterator<Item = String> {
        let name = self.kind.name;
        let locks = self.locks.then(|| {
            format!(
                "{name} cells with this law may be too stiff where it flows or keeps volume: formulation = \"auto\" chooses one that is not"
            )
        });
        let soft = self.soft.then(|| {
            format!(
                "one or two {name} cells with F-bar lie through it: where it bends it is too soft, by a quarter with two and several \
                 times with one; three or more, cells of second degree or formulation = \"incompatible\" are not"
            )
        });
        let why = match (self.kind.degree, self.formulation) {
            (1, Formulation::Incompatible) => {
                "are trapezoids along it, which bend no better with incompatible modes, or flat where it is curved, and stretch as they bend \
                 unless they all bend alike (membrane locking); rectangles, cells half as long, and cells of second degree with \
                 integration = \"reduced\" do not"
            }
            (1, _) => "are too long, or too few through it, for first degree; those of second are right",
            (_, Formulation::FBar) if !self.joined => {
                "are curved, and F-bar does not see all of their bending: a sixteenth of that is left with cells half as long, nothing \
                 with quad8, or two hex20 beside one another, and integration = \"reduced\""
            }
            _ => {
                "are curved, and stretch as they bend (membrane locking): a sixteenth of that is left with cells half as long, nothing with \
                 quad8, or two hex20 beside one another, and integration = \"reduced\""
            }
        };
        let stiff = self.stiff.filter(|_| !self.soft);
        let stiff = stiff.map(|part| {
            format!(
                "as far as bending carries it, and not stretch along it, it is too {} {:.0} %: its {name} cells {why}",
                if part < 0.0 { "soft, or with more cells through it too stiff, by up to" } else { "stiff, by some" },
                100.0 * part.abs()
            )
        });
        let layers = self.layers.map(|layers| {
            let (count, part) = match (layers, self.kind.degree) {
                (2.0, 1) => ("two", "a third"),
                (3.0, 1) => ("three", "a tenth"),
                (_, 1) => ("one", "several times"),
                (2.0, _) => ("two", "up to a tenth, and a third where it is pressed together by that"),
                _ => ("one", "up to a fifth, and half where it is pressed together by a third"),
            };
            format!(
                "{count} {name} through a layer that keeps its volume between bonded faces: too stiff across it, by {part}; \
                 more cells of second degree are right"
            )
        });
        locks.into_iter().chain(soft).chain(stiff).chain(layers)
    }
}

/// Three digits of a ratio.
fn rounded(ratio: f64) -> String {
    let digits = (2 - ratio.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
    format!("{ratio:.digits$}")
}
