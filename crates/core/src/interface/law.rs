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

/// What a law answers to three numbers, penetration and the two slips: `t(y + dy) = stress + slopes dy` to first order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linearised {
    /// Pressure, positive in compression, and the shear stresses along the two tangents.
    pub stress: [f64; 3],
    /// Their derivatives, `slopes[i][k]` that of stress `i` along number `k`: a stress per length.
    pub slopes: [[f64; 3]; 3],
    /// As [`Response::status`].
    pub status: Status,
    /// As [`Response::slipped`].
    pub slipped: f64,
    /// As [`Response::closure`].
    pub closure: f64,
    /// As [`Response::dissipated`].
    pub dissipated: f64,
    /// As [`Response::violation`].
    pub violation: f64,
}

impl Linearised {
    fn of(response: &Response<Dual<3>>) -> Self {
        let [s, t] = response.shear;
        let rows = [response.pressure, s, t];
        let &Response { status, slipped, closure, dissipated, violation, .. } = response;
        let (stress, slopes) = (rows.map(|row| row.re), rows.map(|row| row.du));
        Self { stress, slopes, status, slipped, closure, dissipated, violation }
    }

    /// Adds irreversible slip under the shear stress that there is.
    pub fn slide(&mut self, slip: f64) {
        self.slipped += slip;
        self.dissipated += self.stress[1].hypot(self.stress[2]) * slip;
    }

    /// Pressure.
    pub fn pressure(&self) -> f64 {
        self.stress[0]
    }

    /// Shear stresses along the two tangents.
    pub fn shear(&self) -> [f64; 2] {
        [self.stress[1], self.stress[2]]
    }

    /// The stresses with the derivatives that the three numbers carry, by the chain rule.
    pub fn chained<T: Scalar>(&self, motion: [T; 3]) -> [T; 3] {
        std::array::from_fn(|i| {
            let [a, b, c] = self.slopes[i];
            motion[0].chain(self.stress[i], a) + motion[1].chain(0.0, b) + motion[2].chain(0.0, c)
        })
    }
}

/// A law of an interface, written once over any scalar.
pub trait InterfaceLaw: Clone + Send + Sync + 'static {
    /// Its history variables besides the shear stress, at most [`MOST_VARIABLES`] scalars.
    const VARIABLES: &'static [Variable];

    /// The response to a motion; `vars` holds the old variables and takes the new ones. With no motion and no time
    /// (`dt` zero) the nearest admissible stress: a scheme has come to a state that only has to be put right.
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
    /// The penetration down to which a bond has all of its shear strength, if any under tension; by default that without pressure.
    fn keeps(&self, past: &Past) -> f64 {
        self.touch(&Past { penalty: f64::INFINITY, tangential_penalty: f64::INFINITY, ..*past })
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
    ///
    /// # Errors
    /// In words, where the law cannot serve the scheme or has nothing to integrate.
    fn updated(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        Ok(Box::new(Law(Integrated { law: self.clone(), update })))
    }
}

/// Most variables that a law has.
pub const MOST_VARIABLES: usize = 4;

/// A law as the object that contacts hold: a function of three numbers, whatever they depend on.
pub trait Interface: Send + Sync {
    /// History variables besides the shear stress.
    fn variables(&self) -> &'static [Variable];
    /// As [`InterfaceLaw::initial`].
    fn initial(&self, vars: &mut [f64]);
    /// As [`InterfaceLaw::release`].
    fn release(&self, old: &[f64], new: &mut [f64]);
    /// As [`InterfaceLaw::touch`].
    fn touch(&self, past: &Past) -> f64;
    /// The penetration that these variables leave without any stress, a length: what has closed, less what has dilated.
    fn stays(&self, vars: &[f64]) -> f64 {
        let rigid = f64::INFINITY;
        let (penetration, pressure, shear, dt) = (0.0, 0.0, [0.0; 2], 0.0);
        self.touch(&Past { penalty: rigid, tangential_penalty: rigid, penetration, pressure, shear, vars, dt })
    }
    /// As [`InterfaceLaw::keeps`].
    fn keeps(&self, past: &Past) -> f64;
    /// The tensile strength of the bond that holds; zero without one.
    fn tensile_strength(&self, past: &Past) -> f64 {
        past.penalty * (self.stays(past.vars) - self.touch(past))
    }
    /// As [`InterfaceLaw::opens`] of a point that was in contact; as [`InterfaceLaw::touch`] of another.
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64;
    /// The response to a penetration and the slips along the two tangents, lengths as in [`Motion`], with its
    /// derivatives; `vars` holds the old variables and takes the new ones.
    ///
    /// # Errors
    /// As [`InterfaceLaw::respond`].
    fn respond(&self, motion: [f64; 3], past: &Past, vars: &mut [f64]) -> Result<Linearised, Failure>;
    /// Energy that an undeformed area stores under a pressure on it.
    fn stored(&self, pressure: f64, penalty: f64) -> f64 {
        0.5 * pressure * pressure / penalty
    }
    /// Whether its penetration is meant: the compliance of rough surfaces, and no penalty.
    fn is_compliant(&self) -> bool {
        false
    }
    /// Depth by which the surface recedes for a unit of pressure times sliding.
    fn recession(&self) -> f64 {
        0.0
    }
    /// As [`InterfaceLaw::radius`].
    fn radius(&self) -> f64;
    /// As [`InterfaceLaw::sliding_stress`].
    fn sliding_stress(&self, pressure: f64) -> Option<f64>;
    /// The same law, its increments integrated in another way.
    ///
    /// # Errors
    /// As [`InterfaceLaw::updated`].
    fn with_update(&self, update: Update) -> Result<Box<dyn Interface>, String>;
}

/// An [`InterfaceLaw`] as an [`Interface`]: increments are one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<L>(pub L);

/// The response of a law whose history is plain numbers, differentiated along the three numbers of the motion.
fn linearised<L: InterfaceLaw>(law: &L, y: [f64; 3], past: &Past, vars: &mut [f64]) -> Result<Linearised, Failure> {
    type T = Dual<3>;
    let motion = Motion { penetration: T::variable(y[0], 0), slip: [T::variable(y[1], 1), T::variable(y[2], 2)] };
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
    let response = law.respond(&motion, &past, &mut new[..n])?;
    vars.iter_mut().zip(new).for_each(|(var, new)| *var = new.re());
    Ok(Linearised::of(&response))
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
    fn keeps(&self, past: &Past) -> f64 {
        self.0.keeps(past)
    }
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64 {
        let touch = self.0.touch(past);
        if past.penetration < touch { touch } else { self.0.opens(past, slip) }
    }
    fn respond(&self, motion: [f64; 3], past: &Past, vars: &mut [f64]) -> Result<Linearised, Failure> {
        linearised(&self.0, motion, past, vars)
    }
    fn radius(&self) -> f64 {
        self.0.radius()
    }
    fn sliding_stress(&self, pressure: f64) -> Option<f64> {
        self.0.sliding_stress(pressure)
    }
    fn with_update(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        self.0.updated(update)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A law that remembers a penetration and is not symmetric.
    #[derive(Clone)]
    struct Odd;

    impl InterfaceLaw for Odd {
        const VARIABLES: &'static [Variable] = &[];
        fn respond<T: Scalar>(&self, m: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
            let pressure = (m.penetration - past.penetration) * m.penetration * past.penalty;
            let shear = [pressure * m.slip[0].tanh(), m.slip[1] * m.slip[0] + m.penetration];
            let (status, slipped, closure, dissipated, violation) = (Status::Slip, 1.0, 2.0, 3.0, 4.0);
            Ok(Response { pressure, shear, status, slipped, closure, dissipated, violation })
        }
    }

    /// Through the three numbers and straight on, a law has the same stresses and derivatives, along as many directions
    /// as one likes.
    #[test]
    fn the_chain_rule_gives_what_the_law_itself_would() {
        let past = Past {
            penalty: 7.0,
            tangential_penalty: 5.0,
            penetration: 0.1,
            pressure: 0.0,
            shear: [0.0; 2],
            vars: &[],
            dt: 1.0,
        };
        let y = [0, 1, 2]
            .map(|i| Dual { re: 0.3 + 0.2 * f64::from(i), du: [1.0_f64, -2.0, 0.5, 3.0, 0.1].map(|d| d.powi(i)) });
        let lifted = Past::<Dual<5>> {
            penetration: past.penetration.into(),
            pressure: 0.0.into(),
            shear: [0.0.into(); 2],
            vars: &[],
            penalty: past.penalty,
            tangential_penalty: past.tangential_penalty,
            dt: past.dt,
        };
        let direct = Odd.respond(&Motion { penetration: y[0], slip: [y[1], y[2]] }, &lifted, &mut []).unwrap();
        let law: &dyn Interface = &Law(Odd);
        let response = law.respond(y.map(|y| y.re), &past, &mut []).unwrap();
        let chained = response.chained(y);
        for (a, b) in chained.iter().zip([direct.pressure, direct.shear[0], direct.shear[1]]) {
            assert_eq!(a.re, b.re);
            assert!(a.du.iter().zip(b.du).all(|(a, b)| (a - b).abs() < 1e-14 * b.abs().max(1.0)), "{a:?} {b:?}");
        }
        assert_eq!((response.slipped, response.closure, response.dissipated, response.violation), (1.0, 2.0, 3.0, 4.0));
    }
}
