//! Rate laws in an objective frame: Jaumann's rate by Hughes and Winget (1980).
//!
//! With `f` the deformation of the increment, `G = 2 (f - I)(f + I)^-1` is the gradient of the displacement increment
//! about the midpoint configuration, exactly. Its skew part `W` gives the rotation `Q = (I - W/2)^-1 (I + W/2)` of the
//! old stress and of tensor variables: exact for a rigid rotation below 180 degrees. Its symmetric part is the strain
//! that drives the law; it belongs to the midpoint and is turned to the end by the second half of the rotation,
//! `H = sqrt(Q)`, without which the stress of a shear would be of first order only.

use super::frame::{Frame, InPlane, InSpace, Turning};
use super::integrated::Integrated;
use super::law::{self, Differentiate};
use super::{Creep, Directions, Flow, Gradient, Lapse, Material, SmallStrain, Spin, Turned, Variable, Vars};
use crate::integrate::Update;
use crate::tensor::{Dual, Scalar, Tensor2};
use crate::{Failure, FailureKind};

/// A law between the strain increment of an objective frame and the rotated stress.
pub trait RateLaw: Clone + Send + Sync + 'static {
    /// Its history variables.
    type Vars<T: Scalar>: Vars<T>;
    /// Their declaration, in the order in which they are stored.
    const VARIABLES: &'static [Variable];

    /// Where the state has the first and the third axis of the solid, one after the other, if it is not alike in all directions.
    const AXES: Option<usize> = None;

    /// Fills in what is not zero in the state before any strain: six stress components, then the variables.
    fn initial(&self, _state: &mut [f64]) {}

    /// Stress and variables after the strain increment `de` over `lapse`, by one implicit step. With no strain
    /// and no time the nearest admissible stress.
    ///
    /// # Errors
    /// A [`Failure`] when a local iteration does not converge or the strain is inadmissible.
    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        vars: &Self::Vars<T>,
        lapse: Lapse,
    ) -> Result<(Tensor2<T>, Self::Vars<T>), Failure>;

    /// Lame's constants of a step in which the stress grows by `lambda tr(de) I + 2 G de` and nothing else changes:
    /// its derivative then needs no duals through the law. None where the law does not know.
    fn elastic_step(
        &self,
        _de: &Tensor2,
        _stress: &Tensor2,
        _vars: &Self::Vars<f64>,
        _lapse: Lapse,
    ) -> Option<[f64; 2]> {
        None
    }

    /// Recoverable energy per volume at a stress.
    fn stored_energy(&self, stress: &Tensor2, vars: &Self::Vars<f64>) -> f64;
    /// Energy dissipated per volume between two states.
    fn dissipation(&self, _old: (&Tensor2, &Self::Vars<f64>), _new: (&Tensor2, &Self::Vars<f64>)) -> f64 {
        0.0
    }
    /// Whether the law can be integrated as said.
    ///
    /// # Errors
    /// In words, why not.
    fn serves(&self, _update: Update) -> Result<(), String> {
        Ok(())
    }
    /// As [`Material::mean_moduli`].
    fn mean_moduli(&self) -> Option<[f64; 2]> {
        None
    }
    /// As [`Material::flow`].
    fn flow(&self) -> Flow {
        Flow::None
    }
    /// As [`Material::own_update`].
    fn own_update(&self) -> Option<Update> {
        None
    }
    /// As [`Material::creep`].
    fn creep(&self, _stress: &Tensor2, _vars: &Self::Vars<f64>) -> Option<Creep> {
        None
    }
    /// As [`Material::own_spin`].
    fn own_spin(&self) -> Option<Spin> {
        None
    }
    /// The law as a material whose increments are integrated as said.
    fn updated(&self, update: Update) -> Box<dyn Material> {
        Box::new(Rate(Integrated { law: self.clone(), update }))
    }
}

/// A [`RateLaw`] as a [`Material`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate<L>(pub L);

/// Part of a stress given beforehand by which the law may correct it.
const BORNE: f64 = 1e-9;

/// What is said of a back stress in Jaumann's frame.
const SWINGS: &str = "a back stress turns with the spin of the solid in Jaumann's frame: in shear beyond about one half the \
                      stress swings; without `rate` it turns with the logarithmic rate and does not";

/// What is said of axes of a solid in Jaumann's frame.
const TURNS: &str = "the axes of the solid turn with its spin in Jaumann's frame: in shear they go round and round; without \
                     `rate` they turn with the polar rotation";

/// Why a deformation is refused.
pub(super) const INSIDE_OUT: &str = "a cell is turned inside out";

impl<L: RateLaw> Rate<L> {
    /// Stress and variables at the end of an increment seen in `frame`.
    fn end(&self, frame: &Frame<f64>, lapse: Lapse, old: &[f64]) -> Result<(Tensor2, L::Vars<f64>), Failure> {
        self.0.update(frame.de, frame.stress, &L::Vars::<f64>::read(&old[6..]).rotate(&frame.q), lapse)
    }

    /// New state at the end of an increment seen in `frame`.
    pub(super) fn update_in(
        &self,
        frame: &Frame<f64>,
        lapse: Lapse,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        let (stress, vars) = self.end(frame, lapse, old)?;
        new[..6].copy_from_slice(&stress.to_voigt());
        vars.write(&mut new[6..]);
        Ok(())
    }

    /// The end of an increment seen in `turning`, and its derivatives along `N` components of the deformation.
    pub(super) fn advance_in<const N: usize>(
        &self,
        turning: &impl Turning,
        lapse: Lapse,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        places: &[(usize, usize)],
    ) -> Result<(), Failure> {
        let frame = turning.values();
        let vars = L::Vars::<f64>::read(&old[6..]).rotate(&frame.q);
        if let Some(lame) = self.0.elastic_step(&frame.de, &frame.stress, &vars, lapse) {
            let (stress, vars) = self.0.update(frame.de, frame.stress, &vars, lapse)?;
            new[..6].copy_from_slice(&stress.to_voigt());
            vars.write(&mut new[6..]);
            turning.elastic_gradient(lame, places, gradient);
            return Ok(());
        }
        let frame = turning.duals::<N>(places);
        let vars = L::Vars::<Dual<N>>::read(&old[6..]).rotate(&frame.q);
        let (stress, vars) = self.0.update(frame.de, frame.stress, &vars, lapse)?;
        let stress = stress.to_voigt();
        new[..6].copy_from_slice(&stress.map(Scalar::re));
        vars.write(&mut new[6..]);
        law::write_slopes(&stress, gradient);
        Ok(())
    }
}

impl<L: RateLaw> Differentiate for Rate<L> {
    fn advance_dual<const N: usize>(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        out: (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        if f.det() <= 0.0 {
            return Err(Failure::new(INSIDE_OUT).of(FailureKind::Inverted));
        }
        let (stress, places) = (stress_of(old), directions.components());
        if N == 9 {
            self.advance_in::<N>(&InSpace::new(f, &stress), lapse, old, out, places)
        } else {
            self.advance_in::<N>(&InPlane::new(f, &stress), lapse, old, out, places)
        }
    }
}

impl<L: RateLaw> Material for Rate<L> {
    fn variables(&self) -> &[Variable] {
        L::VARIABLES
    }

    fn initialise(&self, state: &mut [f64]) {
        state.fill(0.0);
        self.0.initial(state);
    }

    /// A stress that an increment of nothing leaves as it is.
    fn bears(&self, state: &[f64]) -> Result<(), String> {
        let (borne, _) = self
            .end(&Frame::of(&Tensor2::identity(), &stress_of(state)), 0.0.into(), state)
            .map_err(|failure| failure.reason)?;
        let given = stress_of(state);
        let off = borne - given;
        // Not `>`, so that what is not a number is refused.
        let near = off.contract(off) <= (BORNE * BORNE) * given.contract(given);
        if near { Ok(()) } else { Err("the law does not bear it: it lies beyond yield".into()) }
    }

    fn with_update(&self, update: Update) -> Result<Box<dyn Material>, String> {
        self.0.serves(update)?;
        Ok(self.0.updated(update))
    }

    fn with_spin(&self, spin: Spin) -> Result<Box<dyn Material>, String> {
        Ok(Box::new(Turned::new(self.0.clone(), spin)))
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        Ok(Box::new(SmallStrain::new(self.0.clone())))
    }

    fn update(&self, f: &Tensor2, lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        if f.det() <= 0.0 {
            return Err(Failure::new(INSIDE_OUT).of(FailureKind::Inverted));
        }
        self.update_in(&Frame::of(f, &stress_of(old)), lapse, old, new)
    }

    fn differentiate(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        out: (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        self.advance_along(f, lapse, old, out, directions)
    }

    fn axes_at(&self) -> Option<usize> {
        L::AXES
    }

    fn mean_moduli(&self) -> Option<[f64; 2]> {
        self.0.mean_moduli()
    }

    fn flow(&self) -> Flow {
        self.0.flow()
    }

    fn own_spin(&self) -> Option<Spin> {
        self.0.own_spin()
    }

    fn own_update(&self) -> Option<Update> {
        self.0.own_update()
    }

    fn creep(&self, state: &[f64]) -> Option<Creep> {
        self.0.creep(&stress_of(state), &L::Vars::read(&state[6..]))
    }

    fn advice(&self) -> Option<&'static str> {
        self.0.own_spin().map(|spin| match spin {
            Spin::Logarithmic => SWINGS,
            Spin::Polar => TURNS,
        })
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        self.0.stored_energy(&stress_of(state), &L::Vars::read(&state[6..]))
    }

    fn dissipation(&self, old: &[f64], new: &[f64]) -> f64 {
        let vars = |state: &[f64]| L::Vars::<f64>::read(&state[6..]);
        self.0.dissipation((&stress_of(old), &vars(old)), (&stress_of(new), &vars(new)))
    }
}

#[inline]
pub(super) fn stress_of(state: &[f64]) -> Tensor2 {
    Tensor2::from_voigt([state[0], state[1], state[2], state[3], state[4], state[5]])
}
