//! The program has no units: the tube in other ones is the same tube, to the bit where the factors are powers of two
//! and only arithmetic and roots act.

mod support;

use asperity::output::{Frame, Parts, Quantity, QuantityPlace, Source, Unit};
use support::{Keep, model, run};

/// The tube with lengths and forces multiplied.
fn deck(length: f64, force: f64) -> String {
    let stress = force / (length * length);
    let point = |x: f64, y: f64| format!("[{:?}, {:?}]", x * length, y * length);
    let arc = |a, b, c| format!("{{ arc = [{a}, {b}, {c}] }}");
    let line = |a, b| format!("{{ line = [{a}, {b}] }}");
    let ends = [point(50.5, -4.58541418), point(50.34807753, -2.848932404), point(50.15192247, -1.736481777)];
    let profile = [
        line(point(50.5, -150.0), ends[0].clone()),
        arc(ends[0].clone(), point(50.461946981, -3.713856753), ends[1].clone()),
        line(ends[1].clone(), ends[2].clone()),
        arc(ends[2].clone(), point(50.038053019, -0.871557427), point(50.0, 0.0)),
        line(point(50.0, 0.0), point(50.0, 200.0)),
    ];
    format!(
        "version = 1
        space = 'axisymmetric'
        mesh.part.tube.rectangle = {{ from = {}, to = {}, cells = [2, 30], cell = 'quad8' }}
        material.steel.elastic = {{ young = {:?}, poisson = 0.3 }}
        solver.tolerance = 1e-8 # far above rounding, which is another in each system of units
        body.tube = {{ material = 'steel', integration = 'reduced' }}
        tool.mandrel.profile = [{}]
        contact.bore = {{ surface = 'tube.left', target = 'mandrel', form = 'paper', law.coulomb.friction = 0.2 }}
        step = [{{ increments.count = 20, displacement.'tube.top' = {{ y = {:?} }} }}]",
        point(50.0, 0.0),
        point(55.0, 90.0),
        210e3 * stress,
        profile.join(", "),
        -30.0 * length
    )
}

/// A run in other units.
struct Scaled {
    length: f64,
    force: f64,
    frames: Vec<Frame>,
    keep: Keep,
}

impl Scaled {
    fn run(length: f64, force: f64) -> Self {
        let model = model(&deck(length, force), &[]);
        let (keep, parts) = (run(&model), Parts::of(&model));
        let frames = keep.states.iter().map(|state| Source { parts: &parts, state, step: 0 }.gather().unwrap());
        Self { length, force, frames: frames.collect(), keep }
    }

    /// What one unit of a quantity of the first tube is here.
    fn factor(&self, unit: Unit) -> f64 {
        let Self { length, force, .. } = *self;
        match unit {
            Unit::One | Unit::Angle | Unit::Time => 1.0,
            Unit::Length => length,
            Unit::Area => length * length,
            Unit::Volume => length * length * length,
            Unit::Force => force,
            Unit::Moment | Unit::Energy => force * length,
            Unit::Stress => force / (length * length),
            Unit::EnergyDensity => force / length,
        }
    }

    /// All values of all quantities of a frame, next to those of another run in its own units.
    fn beside<'a>(
        &'a self,
        other: &'a Self,
        frame: usize,
    ) -> impl Iterator<Item = (&'a Quantity, Vec<f64>, &'a [f64])> {
        let places = [
            QuantityPlace::Node,
            QuantityPlace::Cell,
            QuantityPlace::Gauss,
            QuantityPlace::Contact,
            QuantityPlace::Face,
            QuantityPlace::Global,
        ];
        let quantities =
            places.into_iter().flat_map(move |place| self.frames[frame].at(place).zip(other.frames[frame].at(place)));
        quantities.map(|(mine, theirs)| {
            assert_eq!(mine.name, theirs.name);
            let factor = self.factor(mine.unit);
            (mine, mine.values.iter().map(|value| value / factor).collect(), &theirs.values[..])
        })
    }

    fn same_course(&self, other: &Self) {
        let course = |run: &Self| -> Vec<(usize, f64, bool)> {
            let of = |a: &asperity::solve::AttemptRecord| (a.increment, a.dt, a.failure.is_some());
            run.keep.attempts.iter().map(of).collect()
        };
        assert_eq!(course(self), course(other));
        // Rounding may ask for one more where an iteration ends near the tolerance.
        let solutions = |run: &Self| run.keep.attempts.iter().map(|a| a.solutions()).collect::<Vec<_>>();
        let pairs = solutions(self).into_iter().zip(solutions(other));
        pairs.for_each(|(a, b)| assert!(a.abs_diff(b) <= 1, "{a} and {b} iterations"));
    }
}

/// Largest difference of the values and their largest size; what is nowhere in both runs is equal.
fn spread(a: &[f64], b: &[f64]) -> (f64, f64) {
    let pairs = || a.iter().zip(b).filter(|(a, b)| !(a.is_nan() && b.is_nan()));
    assert!(pairs().all(|(a, b)| a.is_finite() && b.is_finite()));
    let most = |of: fn((&f64, &f64)) -> f64| pairs().map(of).fold(0.0, f64::max);
    (most(|(a, b)| (a - b).abs()), most(|(_, b)| b.abs()))
}

/// Largest difference of the values over their largest size.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let (apart, largest) = spread(a, b);
    if apart == 0.0 { 0.0 } else { apart / largest }
}

#[test]
fn powers_of_two_change_no_bit() {
    let (plain, scaled) = (Scaled::run(1.0, 1.0), Scaled::run(4096.0, 1.0 / 262_144.0));
    scaled.same_course(&plain);
    let mut equal = 0;
    for frame in 0..plain.frames.len() {
        for (quantity, mine, theirs) in scaled.beside(&plain, frame) {
            let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&mine), bits(theirs), "{} in frame {frame}", quantity.name);
            equal += mine.len();
        }
    }
    assert!(equal > 100_000);
}

#[test]
fn common_systems_of_units_agree() {
    let plain = Scaled::run(1.0, 1.0);
    for (length, force) in [(1e-3, 1.0), (0.1, 1e-3)] {
        let scaled = Scaled::run(length, force);
        scaled.same_course(&plain);
        columns_agree(&scaled, &plain);
    }
}

/// Columns of the history agree to 1e-8 of the largest value of each.
fn columns_agree(scaled: &Scaled, plain: &Scaled) {
    let names: Vec<String> = plain.frames[0].at(QuantityPlace::Global).map(|quantity| quantity.name.clone()).collect();
    for name in names {
        let (mut mine, mut theirs) = (Vec::new(), Vec::new());
        for frame in 0..plain.frames.len() {
            for (_, a, b) in scaled.beside(plain, frame).filter(|(quantity, ..)| quantity.name == name) {
                mine.extend(a);
                theirs.extend(b);
            }
        }
        // What is left of the balance of forces is rounding; it is a ratio itself.
        let apart = if name == "equilibrium.error" { spread(&mine, &theirs).0 } else { difference(&mine, &theirs) };
        assert!(apart < 1e-8, "{name}: {apart}");
    }
}
