//! Laws of interfaces: to a surface what a material is to a body.
//!
//! A law maps the penetration and the slip increment of a contact point to pressure and shear in its local triad,
//! which turns with the surface, so that nothing has to be made objective here. Penalties play the role of elastic
//! stiffness. Laws know no surface, no target and no search.
//!
//! To add a law: its file in `laws/`, its `mod` line and its line in [`laws::ALL`]. A law of one's own needs neither:
//! any [`InterfaceLaw`] becomes an [`Interface`] by [`Law`], with its exact tangent. Here friction that rises with the
//! pressure to a power, `tau_y = c p^n`, as on paper or on skin:
//!
//! ```
//! use asperity_core::Failure;
//! use asperity_core::declare::Variable;
//! use asperity_core::interface::{Interface, InterfaceLaw, Law, Motion, Past, Response, Status};
//! use asperity_core::tensor::Scalar;
//!
//! #[derive(Clone)]
//! struct Skin {
//!     c: f64,
//!     n: f64,
//! }
//!
//! impl InterfaceLaw for Skin {
//!     const VARIABLES: &'static [Variable] = &[];
//!
//!     fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
//!         let pressure = motion.penetration * past.penalty;
//!         let limit = pressure.powf(self.n) * self.c;
//!         let stiffness = past.tangential_penalty;
//!         let trial = [0, 1].map(|i| past.shear[i] + motion.slip[i] * stiffness);
//!         let size = (trial[0] * trial[0] + trial[1] * trial[1]).sqrt();
//!         let slips = size.re() > limit.re();
//!         let slipped = if slips { (size.re() - limit.re()) / stiffness } else { 0.0 };
//!         Ok(Response {
//!             pressure,
//!             shear: if slips { trial.map(|t| t / size * limit) } else { trial },
//!             status: if slips { Status::Slip } else { Status::Stick },
//!             slipped,
//!             closure: 0.0,
//!             dissipated: limit.re() * slipped,
//!             violation: 0.0,
//!         })
//!     }
//! }
//!
//! let law: Box<dyn Interface> = Box::new(Law(Skin { c: 2.0, n: 0.5 }));
//! let (penalty, tangential_penalty) = (100.0, 100.0);
//! let past =
//!     Past { penalty, tangential_penalty, penetration: 0.0, pressure: 0.0, shear: [0.0; 2], vars: &[], dt: 1.0 };
//! let (penetration, slip) = (0.25, 1.0);
//! let response = law.respond([penetration, slip, 0.0], &past, &mut []).unwrap();
//! assert_eq!(response.stress[1], 2.0 * 25.0_f64.sqrt());
//! // The derivative of `c (K u)^n` along `u` is exact, and was not written down.
//! assert!((response.slopes[1][0] - 2.0 * 0.5 * 100.0 / 25.0_f64.sqrt()).abs() < 1e-12);
//! ```

mod closure;
mod integrated;
mod law;
pub mod laws;
mod rule;
mod wear;

pub use closure::{Closing, Closure};
pub use rule::Rule;
pub use wear::Wearing;

pub use law::{Interface, InterfaceLaw, Law, Linearised, MOST_VARIABLES, Motion, Past, Response, Status};
