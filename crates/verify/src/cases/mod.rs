//! The cases, in the order of the report.

mod arch;
mod billet;
mod branch;
mod capstan;
mod claw;
mod contact_default;
mod contact_field;
mod contact_patch;
mod crushed_ring;
mod cup;
mod dragged_ball;
mod energy_balance;
mod euler_columns;
mod flat_punch;
mod hertz_ball;
mod hertz_cylinder;
mod hertz_sphere;
mod hertz_spheres;
mod inclined_block;
mod interface;
mod interference_fit;
mod ironing_3d;
mod laminate;
mod laws;
mod locking;
mod o_ring;
mod orders;
mod partial_slip;
mod partial_slip_3d;
mod pile;
mod pull_out;
mod rigid_hub;
mod ring_compression;
mod rolling;
mod rotated_pair;
mod seal;
mod shallow_ironing;
mod springback;
mod square_cup;
mod strip_footing;
mod strip_punch;
mod thick_shells;
mod tie_patch;
mod tube;
mod two_body_patch;
mod umat;
mod upsetting;
mod wedge;

use crate::Case;

/// All cases.
pub const ALL: &[&Case] = &[
    &tube::CASE,
    &contact_patch::CASE,
    &contact_field::CASE,
    &contact_default::CASE,
    &two_body_patch::CASE,
    &interference_fit::CASE,
    &partial_slip::CASE,
    &partial_slip_3d::CASE,
    &crushed_ring::CASE,
    &shallow_ironing::CASE,
    &ironing_3d::CASE,
    &rotated_pair::CASE,
    &inclined_block::CASE,
    &hertz_cylinder::CASE,
    &hertz_sphere::CASE,
    &hertz_spheres::CASE,
    &hertz_ball::CASE,
    &dragged_ball::CASE,
    &energy_balance::CASE,
    &euler_columns::CASE,
    &arch::CASE,
    &flat_punch::CASE,
    &capstan::CASE,
    &o_ring::CASE,
    &locking::CASE,
    &laws::CASE,
    &orders::CASE,
    &umat::CASE,
    &upsetting::CASE,
    &cup::CASE,
    &square_cup::CASE,
    &wedge::CASE,
    &claw::CASE,
    &interface::CASE,
    &pull_out::CASE,
    &thick_shells::CASE,
    &strip_punch::CASE,
    &strip_footing::CASE,
    &strip_footing::DILATANCY,
    &strip_footing::BANDS,
    &billet::CASE,
    &ring_compression::CASE,
    &rolling::CASE,
    &pile::CASE,
    &tie_patch::CASE,
    &laminate::CASE,
    &rigid_hub::CASE,
    &springback::CASE,
    &seal::CASE,
    &branch::CASE,
];
