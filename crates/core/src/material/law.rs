//! What a body asks of a law.

use super::Placement;
use super::memory::Memory;
use super::turned::Spin;
use crate::Failure;
use crate::declare::Variable;
use crate::integrate::Update;
use crate::tensor::{Dual, Scalar, Tensor2};

/// What goes on over an increment at a point besides its deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lapse {
    /// The time that it takes.
    pub dt: f64,
    /// The temperature at its beginning and at its end, above that at which the undeformed body is free of stress; none where the
    /// body has no temperature.
    pub temperature: Option<[f64; 2]>,
}

impl From<f64> for Lapse {
    /// A time, without temperature.
    fn from(dt: f64) -> Self {
        Self { dt, temperature: None }
    }
}

impl Lapse {
    /// A part of it that ends at the fraction `end`. The temperature changes evenly.
    pub fn part(self, part: f64, end: f64) -> Self {
        let warm = |[from, to]: [f64; 2]| [end - part, end].map(|at| from + (to - from) * at);
        Self { dt: self.dt * part, temperature: self.temperature.map(warm) }
    }
}

/// The components of the deformation gradient along which a derivative is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Directions {
    /// The four in-plane ones (plane strain).
    Plane,
    /// The in-plane ones and 33 (axisymmetric, plane stress).
    PlaneAndNormal,
    /// All nine.
    Space,
}

impl Directions {
    /// Row and column of each component.
    pub fn components(self) -> &'static [(usize, usize)] {
        const PLANE: [(usize, usize); 5] = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)];
        const SPACE: [(usize, usize); 9] = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)];
        match self {
            Self::Plane => &PLANE[..4],
            Self::PlaneAndNormal => &PLANE,
            Self::Space => &SPACE,
        }
    }
}

/// Derivative of the six stress components (XX YY ZZ XY YZ XZ) along the components of [`Directions`].
pub type Gradient = [[f64; 9]; 6];

/// A deformation as the independent variables along the components `places`.
pub(super) fn seeded<const N: usize>(f: &Tensor2, places: &[(usize, usize)]) -> Tensor2<Dual<N>> {
    let mut dual = f.lift();
    places.iter().enumerate().for_each(|(d, &place)| dual[place] = Dual::variable(f[place], d));
    dual
}

/// Writes the derivatives that six stress components carry.
pub(super) fn write_slopes<const N: usize>(stress: &[Dual<N>; 6], gradient: &mut Gradient) {
    gradient.iter_mut().zip(stress).for_each(|(row, s)| row[..N].copy_from_slice(&s.du));
}

/// What finds the derivative of an update along any number of components with dual numbers.
pub(super) trait Differentiate {
    /// The state at the end of an increment, and the derivative of its stress along the `N` components, written to `out`.
    fn advance_dual<const N: usize>(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        out: (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure>;

    /// The same along as many components as there are.
    fn advance_along(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        out: (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        match directions {
            Directions::Plane => self.advance_dual::<4>(f, lapse, old, out, directions),
            Directions::PlaneAndNormal => self.advance_dual::<5>(f, lapse, old, out, directions),
            Directions::Space => self.advance_dual::<9>(f, lapse, old, out, directions),
        }
    }
}

/// What finds the end of an increment in numbers of any kind.
pub(super) trait Advance {
    /// The stress at the end of an increment, whose state is written to `new`.
    fn advance<T: Scalar>(
        &self,
        f: &Tensor2<T>,
        lapse: Lapse,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<Tensor2<T>, Failure>;
}

impl<L: Advance> Differentiate for L {
    fn advance_dual<const N: usize>(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        let stress = self.advance(&seeded::<N>(f, directions.components()), lapse, old, new)?;
        write_slopes(&stress.to_voigt(), gradient);
        Ok(())
    }
}

/// What a law asks of the change of volume where it flows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// It does not flow, or volume and shape flow freely.
    None,
    /// It flows without change of volume, or with hardly any.
    Isochoric,
    /// Only the law knows.
    Unknown,
    /// The change of volume follows from the shear, or comes to rest as it goes on.
    Dilatant,
}

/// How a state creeps: flow whose rate follows from the stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Creep {
    /// Equivalent stress.
    pub stress: f64,
    /// Rate of the equivalent strain,
    pub rate: f64,
    /// its derivative by the stress,
    pub slope: f64,
    /// and what a unit of equivalent strain that has crept lowers it by.
    pub hardening: f64,
    /// Stress that a unit of equivalent strain relaxes, `3 G`.
    pub stiffness: f64,
}

impl Creep {
    /// How wrong the stress at the end of an increment may be where creep went from `self` to `end` over `dt` while the strain of a body
    /// is taken to grow evenly: half of the change of the rate is a strain that came at another time (Zienkiewicz and Cormeau
    /// 1974), and makes a stress by the tangent of the law.
    pub fn unevenness(&self, end: &Self, dt: f64) -> f64 {
        0.5 * dt * (end.rate - self.rate).abs() / (1.0 / end.stiffness + dt * end.slope)
    }

    /// The change of the power of creep over an increment that ends in `end`, and the larger power at its ends. Where a solid hardens,
    /// what it crept too far lowers its rate.
    pub fn change_of_power(&self, end: &Self, dt: f64) -> [f64; 2] {
        let stress = self.stress.max(end.stress);
        let change = (end.rate - self.rate).abs() / (1.0 + dt * end.hardening);
        [change, self.rate.max(end.rate)].map(|rate| stress * rate)
    }
}

/// A law of a solid at one point, driven by the deformation `f` of the increment. Its state is the Cauchy stress (six
/// values) followed by its variables.
pub trait Material: Send + Sync {
    /// History variables after the six stress components.
    fn variables(&self) -> &[Variable];
    /// Number of values of the state.
    fn state_len(&self) -> usize {
        6 + self.variables().iter().map(Variable::len).sum::<usize>()
    }
    /// The state of the undeformed, unstressed solid.
    fn initialise(&self, state: &mut [f64]) {
        state.fill(0.0);
    }
    /// The same at a known place.
    fn initialise_at(&self, state: &mut [f64], _at: &Placement) {
        self.initialise(state);
    }
    /// Where the state has the first and the third axis of the solid, one after the other, if it is not alike in all directions.
    fn axes_at(&self) -> Option<usize> {
        None
    }
    /// Whether the stress of a state may stand at the beginning, given from outside.
    ///
    /// # Errors
    /// In words, why not.
    fn bears(&self, state: &[f64]) -> Result<(), String>;
    /// The same law with its increments integrated as said.
    ///
    /// # Errors
    /// In words, where the stress of a law follows from the deformation alone and nothing is integrated.
    fn with_update(&self, update: Update) -> Result<Box<dyn Material>, String>;
    /// The same law in a frame with this spin in place of Jaumann's.
    ///
    /// # Errors
    /// In words, where the stress of a law follows from the deformation alone and there is no frame to choose.
    fn with_spin(&self, spin: Spin) -> Result<Box<dyn Material>, String>;
    /// What it asks of the change of volume where it flows.
    fn flow(&self) -> Flow {
        Flow::None
    }
    /// The spin with which the law turns unless another is said; none for that of Jaumann's rate.
    fn own_spin(&self) -> Option<Spin> {
        None
    }
    /// How its increments are integrated unless it is said; none for one backward-Euler step.
    fn own_update(&self) -> Option<Update> {
        None
    }
    /// How a state creeps; none where flow does not follow from the stress alone.
    fn creep(&self, _state: &[f64]) -> Option<Creep> {
        None
    }
    /// The same law with a memory of the deformations before.
    ///
    /// # Errors
    /// In words, where the law takes none.
    fn with_memory(&self, _memory: &Memory) -> Result<Box<dyn Material>, String> {
        Err("only hyperelastic laws take `prony` and `mullins`".into())
    }
    /// The same law in small strain, where `f` is `I` and the displacement gradient of the increment.
    ///
    /// # Errors
    /// In words, where the stress of a law follows from the whole deformation.
    fn with_small_strain(&self) -> Result<Box<dyn Material>, String>;
    /// The state at the end of an increment with deformation `f` relative to its beginning.
    ///
    /// # Errors
    /// A [`Failure`] when the deformation is inadmissible or a local iteration does not converge.
    fn update(&self, f: &Tensor2, lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure>;
    /// The same, and the derivative of the stress along the components of `f`; what of the gradient belongs to no direction
    /// stays as it is.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    fn differentiate(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        out: (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure>;
    /// [`differentiate`](Self::differentiate) with a gradient of its own.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    fn update_with_gradient(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        new: &mut [f64],
        directions: Directions,
    ) -> Result<Gradient, Failure> {
        let mut gradient = Gradient::default();
        self.differentiate(f, lapse, old, (new, &mut gradient), directions)?;
        Ok(gradient)
    }
    /// Recoverable energy per current volume.
    fn stored_energy(&self, state: &[f64]) -> f64;
    /// Energy per current volume dissipated between two states.
    fn dissipation(&self, _old: &[f64], _new: &[f64]) -> f64 {
        0.0
    }
    /// Whether the stored energy follows from the deformation, so that a closed cycle of it costs nothing. The stress of
    /// a rate law belongs to no such energy.
    fn is_conservative(&self) -> bool {
        false
    }
    /// Whether the stored energy is that of an undeformed volume, so that its rate and the dissipation are the power of the
    /// stress whatever the change of volume.
    fn has_potential(&self) -> bool {
        self.is_conservative()
    }
    /// What a user should know of the law in its frame before it is used, in words; none where there is nothing to know.
    fn advice(&self) -> Option<&'static str> {
        None
    }
    /// Means of [`moduli`](Self::moduli) over all directions, where the solid is not alike in all.
    fn mean_moduli(&self) -> Option<[f64; 2]> {
        None
    }
    /// Confined modulus `lambda + 2 G` and shear modulus `G` of the undeformed solid.
    fn moduli(&self) -> [f64; 2] {
        if let Some(mean) = self.mean_moduli() {
            return mean;
        }
        let mut state = vec![0.0; self.state_len()];
        self.initialise(&mut state);
        let old = state.clone();
        let identity = Tensor2::identity();
        let gradient = self.update_with_gradient(&identity, 1.0.into(), &old, &mut state, Directions::Plane);
        gradient.map_or([0.0; 2], |c| [c[0][0], c[3][1]])
    }
}
