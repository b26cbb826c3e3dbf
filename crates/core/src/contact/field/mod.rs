//! Contact stress as a field of nodal values: the mortar method with penalty regularisation.
//!
//! The surface carries pressure and shear at the corner nodes of its faces, with the functions `M_i` of first degree (of second
//! degree an edge counts as two, a curved face as four or five). Gaps and slips are weighted means over the undeformed surface, a law
//! is asked once a node, and the field is then integrated back to forces on both sides:
//! ```text
//! A_i = int M_i dA    g_i = int M_i g dA / A_i    s_i = int M_i T(x)^t ds dA / A_i
//! (p_i, tau_i) = law(-g_i, s_i; history of the node)
//! t(x) = sum M_i(x) (p_i n(x) + T(x) tau_i)       F_L = int N_L t dA,  F_K = -int N_K(B) t dA
//! ```
//! so that action is reaction to rounding. A stress at each quadrature point would constrain the interface at more places
//! than the two traces can follow; one value a node is what they can (Puso & Laursen, CMAME 193, 2004; Yang, Laursen &
//! Meng, IJNME 62, 2005; Popp, Gee & Wall, IJNME 79, 2009). Nothing is shared across a crease of the surface or between two
//! smooth pieces of the target (Farah, Wall & Popp, IJNME 114, 2018).
//!
//! The way of a contact: [`surface`](FieldSurface) and `faces` or `tool` are who may touch whom, `arc` the smooth surface that
//! straight edges stand for, and [`contact`](FieldContact) the two with their law; `cover`, `part` and `configuration` find which part of a face sees which part of the target, `seen` what a node does;
//! `support` is what such a search finds; `patch` is such a part in place, `point` a quadrature point of it with the derivatives of all
//! that follows from it along a `column` of the tangent, `points` all of a patch, which the `nodes` of its face share, `stencil` their
//! sums for one node, with the share of a vertex of the body, `tip` the vertex of a wedge or a rounding within a face, `corner` one of the `corners` of a body, `nearer` what
//! contacts narrower than a face are in space and between bodies, `twist` the slip
//! over a tool beside which the surface turns; `attempt` and `term` are the ones that equilibrium knows, `stiffen` raises the penalty, `report` what outputs ask. The plane is space with the second tangent `e_z`; what
//! differs is the cover of a face, which is in `space`, and the pose of a tool.

mod arc;
mod attempt;
mod column;
pub(super) mod configuration;
mod contact;
mod corner;
mod corners;
mod cover;
mod dual;
mod edge;
pub(super) mod face;
pub(super) mod faces;
mod linear;
mod nearer;
mod nodes;
mod part;
mod patch;
mod point;
mod points;
mod report;
mod seen;
mod space;
mod spot;
mod stencil;
mod stiffen;
mod support;
pub(super) mod surface;
mod term;
mod tie;
mod tip;
pub(super) mod tool;
mod triad;
mod twist;

pub use contact::{FieldContact, FieldRoles, FieldTarget};
pub use surface::{FieldSurface, HeldNodes};
pub use tie::{Apart, MeanCondition, TieParts, TiedSurfaces};

#[cfg(test)]
mod tests;
