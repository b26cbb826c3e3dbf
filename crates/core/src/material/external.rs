//! Laws of others: what computes stress, states and `D = dsigma/de` of an increment from outside the library, by the conventions
//! that are customary for UMAT.
//!
//! The law sees the increment in its frame: the old stress and the old strain turned by the rotation `Q` of the increment
//! (Jaumann's by Hughes and Winget, or as the rate says), the strain increment `de` turned to the end, and `Q` itself for the
//! tensors among its states. Of its answer the derivative along the deformation follows from `D` alone where the law does not
//! know directions in space (objectivity): with `w = dQ Q^T` and `[w, a] = w a - a w`,
//!
//! `dsigma = D : (d(de) - [w, de]) + [w, sigma]`.
//!
//! What the law must know of the past besides its states is history: strain, deformation, energies, time, and where it is.

use super::law::{Differentiate, seeded};
use super::rate::{INSIDE_OUT, stress_of};
use super::small::NO_RATE;
use super::turned::Turn;
use super::{
    Directions, Flow, Gradient, Lapse, Material, Spin, Variable, VariableKind, green_naghdi, hughes_winget,
    laws::Elastic, logarithmic,
};
use crate::integrate::Update;
use crate::tensor::{Dual, Scalar, Tensor2, Vec3};
use crate::{Failure, FailureKind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

/// What a deck asks of a shared library.
#[derive(Debug, Clone, PartialEq)]
pub struct Library {
    /// Its file.
    pub path: PathBuf,
    /// What the law is called.
    pub name: String,
    /// Numbers of the law.
    pub properties: Vec<f64>,
    /// Whether it may be called from several threads at once.
    pub thread_safe: bool,
}

/// What loads a law.
pub type Loader = fn(&Library) -> Result<Arc<dyn UserLaw>, String>;

static LOADER: OnceLock<Loader> = OnceLock::new();

/// Lets decks name laws of shared libraries; the first loader stays.
pub fn provide(loader: Loader) {
    LOADER.get_or_init(|| loader);
}

/// The law of a library.
///
/// # Errors
/// In words, where nothing loads libraries or the loader refuses.
pub fn load(library: &Library) -> Result<Arc<dyn UserLaw>, String> {
    let loader = LOADER.get().ok_or("this program loads no laws of shared libraries; the command `asperity` does")?;
    loader(library)
}

/// A law from outside the library.
pub trait UserLaw: Send + Sync {
    /// What messages call it.
    fn name(&self) -> &str;
    /// Stress, states, tangent and energies at the end of an increment.
    ///
    /// # Errors
    /// A [`Failure`] where the law gives up or wants a smaller increment.
    fn call(&self, call: &mut Call) -> Result<(), Failure>;
}

/// One increment as a law from outside sees it. Components stand in the order 11, 22, 33, 12, 13, 23, in the plane without the
/// last two; shears of strains are those of engineers.
#[derive(Debug)]
pub struct Call<'a> {
    /// Number of components, 4 or 6.
    pub components: usize,
    /// Turned stress of the beginning; that of the end.
    pub stress: [f64; 6],
    /// States of the beginning; those of the end.
    pub states: &'a mut [f64],
    /// Derivative of the stress `i` along the strain `j`, at `i + components j`.
    pub tangent: [f64; 36],
    /// Elastic energy per volume, and what plasticity and creep took: those of the beginning; those of the end.
    pub energies: [f64; 3],
    /// Turned strain of the beginning, and what it grows by.
    pub strain: [[f64; 6]; 2],
    /// Time at the beginning, and the length of the increment.
    pub time: [f64; 2],
    /// Temperatures at the beginning and at the end, zero where the body has none.
    pub temperature: [f64; 2],
    /// Deformation gradients at the beginning and at the end.
    pub deformation: [Tensor2; 2],
    /// Rotation of the increment.
    pub rotation: Tensor2,
    /// Whether strain is small.
    pub small: bool,
    /// Number of the increment, from one.
    pub number: usize,
    /// Where.
    pub at: Placement,
}

/// Where a point lies in the undeformed body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Number of the cell.
    pub cell: u64,
    /// Number of the point in its cell, from one.
    pub point: usize,
    /// Its place.
    pub place: Vec3,
    /// Length of the cell.
    pub length: f64,
}

/// The frame of the increments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Frame {
    Still,
    Jaumann,
    Turned(Spin),
}

/// A [`UserLaw`] as a [`Material`].
#[derive(Clone)]
pub struct External {
    law: Arc<dyn UserLaw>,
    /// Four in the plane.
    components: usize,
    frame: Frame,
    /// Its states before the first increment.
    states: Vec<f64>,
    variables: Vec<Variable>,
    /// Moduli of the undeformed solid.
    elastic: Option<Elastic>,
    /// Whether the law tells its energies.
    tells_energy: bool,
    comparisons: Arc<Comparisons>,
}

/// Tangents beside differences.
#[derive(Default)]
struct Comparisons {
    /// Calls whose tangent is still to be compared.
    left: AtomicUsize,
    /// The worst entry of the first tangent that was wrong.
    wrong: OnceLock<String>,
}

/// What is known of a point besides stress and states, in the order in which it is kept.
const KEPT: [(&str, VariableKind); 12] = [
    ("strain_so_far", VariableKind::Symmetric),
    ("deformation_of_x", VariableKind::Vector),
    ("deformation_of_y", VariableKind::Vector),
    ("deformation_of_z", VariableKind::Vector),
    ("elastic_energy", VariableKind::Scalar),
    ("plastic_energy", VariableKind::Scalar),
    ("creep_energy", VariableKind::Scalar),
    ("time_of_law", VariableKind::Scalar),
    ("increments_of_law", VariableKind::Scalar),
    ("place_in_cell", VariableKind::Vector),
    ("place", VariableKind::Vector),
    ("frame_memory", VariableKind::Symmetric),
];
/// Where they begin behind the states.
const DEFORMATION: usize = 6;
const ENERGIES: usize = 15;
const TIME: usize = 18;
const NUMBER: usize = 19;
const CELL: usize = 20;
const PLACE: usize = 23;
const MEMORY: usize = 26;

/// Places of the customary order among XX YY ZZ XY YZ XZ.
const ORDER: [usize; 6] = [0, 1, 2, 3, 5, 4];

/// Strain of the call that asks for the moduli.
const PROBE: f64 = 1e-9;
/// Strain of differences as a part of that of the increment, and its least.
const STEP: f64 = 1e-4;
const LEAST_STEP: f64 = 1e-9;
/// By what a tangent may differ from differences, and those of the two sides at a corner, as parts of its largest entry.
const EXACT: f64 = 1e-4;
const CORNER: f64 = 1e-2;

/// A stress, or a strain with shears of engineers for `shear = 2`, in the customary order.
fn customary(t: &Tensor2, shear: f64) -> [f64; 6] {
    let v = t.to_voigt();
    std::array::from_fn(|i| v[ORDER[i]] * if i < 3 { 1.0 } else { shear })
}

fn from_customary(v: &[f64; 6]) -> Tensor2 {
    Tensor2::from_voigt(std::array::from_fn(|i| v[ORDER[i]]))
}

/// `w a - a w`.
fn commutator(w: &Tensor2, a: &Tensor2) -> Tensor2 {
    *w * *a - *a * *w
}

/// The name of a state by its number, made once.
fn state_name(i: usize) -> &'static str {
    static NAMES: Mutex<Vec<&'static str>> = Mutex::new(Vec::new());
    let mut names = NAMES.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    while names.len() <= i {
        let name = format!("state_{}", names.len() + 1);
        names.push(name.leak());
    }
    names[i]
}

impl External {
    /// The law with its states before the first increment, for a body in the plane or in space; the tangents of as many calls
    /// as said are compared with differences.
    ///
    /// # Errors
    /// In words, where the law does not answer a strain near zero.
    pub fn new(law: Arc<dyn UserLaw>, states: Vec<f64>, plane: bool, comparisons: usize) -> Result<Self, String> {
        let components = if plane { 4 } else { 6 };
        let scalar = |i| Variable { name: state_name(i), kind: VariableKind::Scalar };
        let kept = KEPT.iter().map(|&(name, kind)| Variable { name, kind });
        let mut external = Self {
            law,
            components,
            frame: Frame::Jaumann,
            variables: (0..states.len()).map(scalar).chain(kept.take(KEPT.len() - 1)).collect(),
            states,
            elastic: None,
            tells_energy: true,
            comparisons: Arc::default(),
        };
        external.probe().map_err(|failure| format!("{}: {failure}", external.law.name()))?;
        external.comparisons = Arc::new(Comparisons { left: comparisons.into(), ..Comparisons::default() });
        Ok(external)
    }

    /// Asks for the moduli, and whether the law tells its elastic energy.
    fn probe(&mut self) -> Result<(), Failure> {
        let mut old = vec![0.0; self.state_len()];
        self.initialise(&mut old);
        let mut new = old.clone();
        let mut f = Tensor2::identity();
        f[(0, 0)] += PROBE;
        let turn = self.turn(&f, &old)?;
        let tangent = self.end(&turn, &f, 1.0.into(), &old, &mut new)?;
        let [confined, shear] = [tangent[0], tangent[3 + 3 * self.components]];
        self.elastic =
            (shear > 0.0 && confined > 4.0 / 3.0 * shear).then_some(Elastic { lambda: confined - 2.0 * shear, shear });
        self.tells_energy = new[self.kept() + ENERGIES] != old[self.kept() + ENERGIES];
        Ok(())
    }

    /// Where what is kept behind the states begins.
    fn kept(&self) -> usize {
        6 + self.states.len()
    }

    /// The frame of a deformation.
    fn turn<T: Scalar>(&self, f: &Tensor2<T>, old: &[f64]) -> Result<Turn<T>, Failure> {
        let at = self.kept() + MEMORY;
        let spin = match self.frame {
            Frame::Still => {
                let de = (*f - Tensor2::identity()).sym();
                return Ok(Turn { de, q: Tensor2::identity(), memory: Tensor2::zero() });
            }
            _ if f.det().re() <= 0.0 => return Err(Failure::new(INSIDE_OUT).of(FailureKind::Inverted)),
            Frame::Jaumann => {
                let (de, q) = hughes_winget(f);
                return Ok(Turn { de, q, memory: Tensor2::zero() });
            }
            Frame::Turned(spin) => spin,
        };
        let memory = Tensor2::from_voigt(std::array::from_fn(|i| old[at + i]));
        match spin {
            Spin::Polar => green_naghdi::turn(f, &memory),
            Spin::Logarithmic => logarithmic::turn(f, &memory),
        }
    }

    /// The state at the end of an increment, and the tangent of the law.
    fn end(
        &self,
        turn: &Turn<f64>,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<[f64; 36], Failure> {
        self.admissible()?;
        let (first, states) = (self.kept(), 6..self.kept());
        new[states.clone()].copy_from_slice(&old[states.clone()]);
        let (head, kept) = new.split_at_mut(first);
        let mut call = self.call(turn, f, lapse, (old, &mut head[6..]));
        let (start, strain, end) = (call.stress, call.strain, call.deformation[1]);
        self.law.call(&mut call).map_err(|failure| self.blamed(failure))?;
        let (stress, tangent, energies) = (call.stress, call.tangent, call.energies);
        let finite = stress.iter().chain(&tangent).chain(&energies).chain(call.states.iter()).all(|x| x.is_finite());
        if !finite {
            return Err(self.blamed(Failure::new("stress, states, tangent or energies are not finite")));
        }
        let n = self.components;
        head[..6].copy_from_slice(&from_customary(&stress).to_voigt());
        let total: [f64; 6] = std::array::from_fn(|i| (strain[0][i] + strain[1][i]) * if i < 3 { 1.0 } else { 0.5 });
        kept[..6].copy_from_slice(&from_customary(&total).to_voigt());
        kept[DEFORMATION..ENERGIES].copy_from_slice(end.0.as_flattened());
        kept[ENERGIES..TIME].copy_from_slice(&energies);
        if !self.tells_energy {
            let work: f64 = (0..n).map(|i| 0.5 * (start[i] + stress[i]) * strain[1][i]).sum();
            let stored = self.elastic.map_or(0.0, |elastic| elastic.energy(&from_customary(&stress)));
            kept[ENERGIES] = stored;
            kept[ENERGIES + 1] += work - (stored - old[first + ENERGIES]);
        }
        kept[TIME] = old[first + TIME] + lapse.dt;
        kept[NUMBER] = old[first + NUMBER] + 1.0;
        kept[CELL..MEMORY].copy_from_slice(&old[first + CELL..first + MEMORY]);
        if matches!(self.frame, Frame::Turned(_)) {
            kept[MEMORY..MEMORY + 6].copy_from_slice(&turn.memory.to_voigt());
        }
        Ok(tangent)
    }

    /// What the law is told of an increment.
    fn call<'a>(
        &self,
        turn: &Turn<f64>,
        f: &Tensor2,
        lapse: Lapse,
        (old, states): (&[f64], &'a mut [f64]),
    ) -> Call<'a> {
        let (kept, q) = (&old[self.kept()..], turn.q);
        let turned = |t: Tensor2| (q * t * q.transpose()).sym();
        let begun = Tensor2::from_fn(|i, j| kept[DEFORMATION + 3 * i + j]);
        let small = self.frame == Frame::Still;
        Call {
            components: self.components,
            stress: customary(&turned(stress_of(old)), 1.0),
            states,
            tangent: [0.0; 36],
            energies: std::array::from_fn(|i| kept[ENERGIES + i]),
            strain: [customary(&turned(stress_of(kept)), 2.0), customary(&turn.de, 2.0)],
            time: [kept[TIME], lapse.dt],
            temperature: lapse.temperature.unwrap_or_default(),
            deformation: [begun, if small { begun + *f - Tensor2::identity() } else { *f * begun }],
            rotation: q,
            small,
            number: kept[NUMBER] as usize + 1,
            at: Placement {
                cell: kept[CELL] as u64,
                point: kept[CELL + 1] as usize,
                length: kept[CELL + 2],
                place: Vec3(std::array::from_fn(|i| kept[PLACE + i])),
            },
        }
    }

    fn blamed(&self, failure: Failure) -> Failure {
        failure.at(self.law.name()).of(FailureKind::Material)
    }

    /// The stress that a tensor makes by the tangent.
    fn answer(&self, tangent: &[f64; 36], strain: &Tensor2) -> Tensor2 {
        let (n, e) = (self.components, customary(strain, 2.0));
        let row = |i: usize| if i < n { (0..n).map(|j| tangent[i + n * j] * e[j]).sum() } else { 0.0 };
        from_customary(&std::array::from_fn(row))
    }

    /// Compares the tangent with differences, each strain to both sides; a corner of the law is left out. What is wrong is told
    /// from then on, since a step that fails is shortened until it does not.
    fn compare(
        &self,
        turn: &Turn<f64>,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        tangent: &[f64; 36],
    ) -> Result<(), Failure> {
        let n = self.components;
        let most = customary(&turn.de, 2.0).iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let fewer = |left: usize| if most > 0.0 { left.checked_sub(1) } else { None };
        if self.comparisons.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, fewer).is_err() {
            return Ok(());
        }
        let (step, mut states) = ((STEP * most).max(LEAST_STEP), vec![0.0; self.states.len()]);
        let mut stress = |j: usize, step: f64| {
            states.copy_from_slice(&old[6..self.kept()]);
            let mut call = self.call(turn, f, lapse, (old, &mut states));
            call.strain[1][j] += step;
            self.law.call(&mut call).map(|()| call.stress).map_err(|failure| self.blamed(failure))
        };
        let size = tangent.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut worst = (0.0, String::new());
        for j in 0..n {
            let (back, here, ahead) = (stress(j, -step)?, stress(j, 0.0)?, stress(j, step)?);
            let bend = (0..n).map(|i| ((ahead[i] - 2.0 * here[i] + back[i]) / step).abs()).fold(0.0, f64::max);
            for i in (0..n).filter(|_| bend <= CORNER * size) {
                let (said, found) = (tangent[i + n * j], (ahead[i] - back[i]) / (2.0 * step));
                if (said - found).abs() > EXACT * size && (said - found).abs() > worst.0 {
                    let place = format!("DDSDDE({},{})", i + 1, j + 1);
                    worst = ((said - found).abs(), format!("{place} is {said:.6e}, and differences give {found:.6e}"));
                }
            }
        }
        if worst.0 > 0.0 {
            self.comparisons.wrong.get_or_init(|| worst.1);
        }
        self.admissible()
    }

    /// No tangent was found wrong so far.
    fn admissible(&self) -> Result<(), Failure> {
        self.comparisons.wrong.get().map_or(Ok(()), |wrong| Err(self.blamed(Failure::new(wrong.clone()))))
    }
}

impl Differentiate for External {
    fn advance_dual<const N: usize>(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        let dual = self.turn(&seeded::<N>(f, directions.components()), old)?;
        let turn = Turn { de: dual.de.re(), q: dual.q.re(), memory: dual.memory };
        let tangent = self.end(&turn, f, lapse, old, new)?;
        self.compare(&turn, f, lapse, old, &tangent)?;
        let stress = stress_of(new);
        for d in 0..directions.components().len() {
            let slope = |t: &Tensor2<Dual<N>>| Tensor2::from_fn(|i, j| t[(i, j)].du[d]);
            let spin = slope(&dual.q) * turn.q.transpose();
            let strain = slope(&dual.de) - commutator(&spin, &turn.de);
            let along = self.answer(&tangent, &strain) + commutator(&spin, &stress);
            gradient.iter_mut().zip(along.to_voigt()).for_each(|(row, slope)| row[d] = slope);
        }
        Ok(())
    }
}

impl Material for External {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn initialise(&self, state: &mut [f64]) {
        let at = Placement { cell: 1, point: 1, place: Vec3::zero(), length: 1.0 };
        self.initialise_at(state, &at);
    }

    fn initialise_at(&self, state: &mut [f64], at: &Placement) {
        state.fill(0.0);
        state[6..self.kept()].copy_from_slice(&self.states);
        let kept = &mut state[self.kept()..];
        kept[DEFORMATION..ENERGIES].copy_from_slice(Tensor2::<f64>::identity().0.as_flattened());
        kept[CELL..PLACE].copy_from_slice(&[at.cell as f64, at.point as f64, at.length]);
        kept[PLACE..MEMORY].copy_from_slice(&at.place.0);
        if self.frame == Frame::Turned(Spin::Polar) {
            kept[MEMORY..MEMORY + 3].fill(1.0);
        }
    }

    /// Only the law knows; it is left to the first increment.
    fn bears(&self, _: &[f64]) -> Result<(), String> {
        Ok(())
    }

    fn flow(&self) -> Flow {
        Flow::Unknown
    }

    fn with_update(&self, _: Update) -> Result<Box<dyn Material>, String> {
        Err("the law of a library takes each increment as a whole; leave `update` out".into())
    }

    fn with_spin(&self, spin: Spin) -> Result<Box<dyn Material>, String> {
        if self.frame == Frame::Still {
            return Err(NO_RATE.into());
        }
        let (name, kind) = KEPT[KEPT.len() - 1];
        let kept = self.variables[..self.states.len() + KEPT.len() - 1].iter().copied();
        let variables = kept.chain([Variable { name, kind }]).collect();
        Ok(Box::new(Self { frame: Frame::Turned(spin), variables, ..self.clone() }))
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        if matches!(self.frame, Frame::Turned(_)) {
            return Err(NO_RATE.into());
        }
        Ok(Box::new(Self { frame: Frame::Still, ..self.clone() }))
    }

    fn update(&self, f: &Tensor2, lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        self.end(&self.turn(f, old)?, f, lapse, old, new).map(|_| ())
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

    fn moduli(&self) -> [f64; 2] {
        self.elastic.map_or([0.0; 2], |elastic| [elastic.lambda + 2.0 * elastic.shear, elastic.shear])
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        state[self.kept() + ENERGIES]
    }

    fn dissipation(&self, old: &[f64], new: &[f64]) -> f64 {
        let taken = |state: &[f64]| state[self.kept() + ENERGIES + 1] + state[self.kept() + ENERGIES + 2];
        taken(new) - taken(old)
    }
}
