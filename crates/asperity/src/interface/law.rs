//! What a contact point asks of a law.

use super::integrated::Integrated;
use crate::Failure;
use crate::declare::Variable;
use crate::integrate::Update;
use crate::tensor::{Dual, Scalar};

/// How a contact point is moved over an increment, in its local triad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion<T> {
    /// Penetration at the end of the increment, a length; beyond [`InterfaceLaw::touch`], since an open point asks no
    /// law.
    pub penetration: T,
    /// Slip of the increment along the two tangents, a length; in the plane the second is zero.
    pub slip: [T; 2],
}

/// What does not vary within an increment. Sub-steps begin where another ended, so that the state carries derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Past<'a, T = f64> {
    /// Normal penalty, a stress per length.
    pub penalty: f64,
    /// Tangential penalty, a stress per length.
    pub tangential_penalty: f64,
    /// Penetration at the beginning of the increment; that at which it touched, of a point that was open.
    pub penetration: T,
    /// Pressure at the beginning of the increment; zero at a point that was open.
    pub pressure: T,
    /// Shear stress at the beginning of the increment.
    pub shear: [T; 2],
    /// The law's own variables at the beginning of the increment.
    pub vars: &'a [T],
    /// Length of the increment.
    pub dt: f64,
}

/// Whether a point in contact sticks or slips; open points have no response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Inside the yield surface.
    Stick = 1,
    /// On it.
    Slip = 2,
}

/// The answer of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response<T> {
    /// Pressure, positive in compression.
    pub pressure: T,
    /// Shear stress along the two tangents.
    pub shear: [T; 2],
    /// Stick or slip.
    pub status: Status,
    /// Length of irreversible slip in the increment.
    pub slipped: f64,
    /// Irreversible closure in the increment, a length; negative for dilation.
    pub closure: f64,
    /// Energy dissipated per area in the increment.
    pub dissipated: f64,
    /// By how much the stress exceeds the yield surface, as a ratio to it; zero up to rounding.
    pub violation: f64,
}

/// A law of an interface, written once over any scalar.
pub trait InterfaceLaw: Clone + Send + Sync + 'static {
    /// Its history variables besides the shear stress, at most [`MOST_VARIABLES`] scalars.
    const VARIABLES: &'static [Variable];

    /// The response to a motion; `vars` holds the old variables and takes the new ones.
    ///
    /// # Errors
    /// A [`Failure`] when a local iteration does not converge.
    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure>;

    /// Writes the variables of an interface that nothing has happened to; they are zero before.
    fn initial(&self, _vars: &mut [f64]) {}

    /// What is left of the variables `old` when a point opens: by default nothing.
    fn release(&self, _old: &[f64], new: &mut [f64]) {
        new.fill(0.0);
        self.initial(new);
    }

    /// The penetration from which a point is closed: what dilation or a bond leaves of a gap, or closure of a surface.
    fn touch(&self, _past: &Past) -> f64 {
        0.0
    }

    /// The penetration down to which a point that was in contact stays closed while it slips by `slip`: dilation pushes
    /// it apart as it goes.
    fn opens(&self, past: &Past, _slip: [f64; 2]) -> f64 {
        self.touch(past)
    }
    /// The radius on the undeformed surface over which friction takes the mean of the pressure; zero for that of the point.
    fn radius(&self) -> f64 {
        0.0
    }
    /// The friction stress at which a point under this pressure slides, where pressure alone decides it.
    fn sliding_stress(&self, _pressure: f64) -> Option<f64> {
        None
    }
    /// The same law, its increments integrated as said.
    fn updated(&self, update: Update) -> Box<dyn Interface> {
        Box::new(Law(Integrated { law: self.clone(), update }))
    }
}

/// Most variables that a law has.
pub const MOST_VARIABLES: usize = 4;

/// A law as the object that contacts hold: one method for each number of directions in use.
pub trait Interface: Send + Sync {
    /// History variables besides the shear stress.
    fn variables(&self) -> &'static [Variable];
    /// As [`InterfaceLaw::initial`].
    fn initial(&self, vars: &mut [f64]);
    /// As [`InterfaceLaw::release`].
    fn release(&self, old: &[f64], new: &mut [f64]);
    /// As [`InterfaceLaw::touch`].
    fn touch(&self, past: &Past) -> f64;
    /// As [`InterfaceLaw::opens`] of a point that was in contact; as [`InterfaceLaw::touch`] of another.
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64;
    /// Plain numbers; `vars` holds the old variables and takes the new ones.
    ///
    /// # Errors
    /// As [`InterfaceLaw::respond`].
    fn respond(&self, motion: &Motion<f64>, past: &Past, vars: &mut [f64]) -> Result<Response<f64>, Failure>;
    /// With the derivatives of a contact point in the plane.
    ///
    /// # Errors
    /// As [`InterfaceLaw::respond`].
    fn respond_plane(
        &self,
        motion: &Motion<Dual<8>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<8>>, Failure>;
    /// With the derivatives of a contact point in space.
    ///
    /// # Errors
    /// As [`InterfaceLaw::respond`].
    fn respond_space(
        &self,
        motion: &Motion<Dual<15>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<15>>, Failure>;
    /// As [`InterfaceLaw::radius`].
    fn radius(&self) -> f64;
    /// As [`InterfaceLaw::sliding_stress`].
    fn sliding_stress(&self, pressure: f64) -> Option<f64>;
    /// The same law, its increments integrated in another way.
    fn with_update(&self, update: Update) -> Box<dyn Interface>;
}

/// An [`InterfaceLaw`] as an [`Interface`]: increments are one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<L>(pub L);

/// The response of a law whose history is plain numbers.
fn lifted<L: InterfaceLaw, T: Scalar>(
    law: &L,
    motion: &Motion<T>,
    past: &Past,
    vars: &mut [f64],
) -> Result<Response<T>, Failure> {
    let old: [T; MOST_VARIABLES] = std::array::from_fn(|i| past.vars.get(i).map_or(T::zero(), |&v| T::from(v)));
    let (mut new, n) = (old, past.vars.len());
    let past = Past {
        penalty: past.penalty,
        tangential_penalty: past.tangential_penalty,
        penetration: T::from(past.penetration),
        pressure: T::from(past.pressure),
        shear: past.shear.map(T::from),
        vars: &old[..n],
        dt: past.dt,
    };
    let response = law.respond(motion, &past, &mut new[..n])?;
    vars.iter_mut().zip(new).for_each(|(var, new)| *var = new.re());
    Ok(response)
}

impl<L: InterfaceLaw> Interface for Law<L> {
    fn variables(&self) -> &'static [Variable] {
        L::VARIABLES
    }
    fn initial(&self, vars: &mut [f64]) {
        self.0.initial(vars);
    }
    fn release(&self, old: &[f64], new: &mut [f64]) {
        self.0.release(old, new);
    }
    fn touch(&self, past: &Past) -> f64 {
        self.0.touch(past)
    }
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64 {
        let touch = self.0.touch(past);
        if past.penetration < touch { touch } else { self.0.opens(past, slip) }
    }
    fn respond(&self, motion: &Motion<f64>, past: &Past, vars: &mut [f64]) -> Result<Response<f64>, Failure> {
        lifted(&self.0, motion, past, vars)
    }
    fn respond_plane(
        &self,
        motion: &Motion<Dual<8>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<8>>, Failure> {
        lifted(&self.0, motion, past, vars)
    }
    fn radius(&self) -> f64 {
        self.0.radius()
    }
    fn sliding_stress(&self, pressure: f64) -> Option<f64> {
        self.0.sliding_stress(pressure)
    }
    fn with_update(&self, update: Update) -> Box<dyn Interface> {
        self.0.updated(update)
    }
    fn respond_space(
        &self,
        motion: &Motion<Dual<15>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<15>>, Failure> {
        lifted(&self.0, motion, past, vars)
    }
}
