//! Supports, loads and motions: what stands behind the names of a step's tables.

use crate::diagnose::Diagnostic;
use crate::form::{Form, flag, list, number, refers, table, word, words};
use crate::reader::{Name, Reader};
use crate::schema::{Names, Schema};
use crate::source::{Place, Spot};
use crate::tree::Node;
use asperity_core::amplitude::Amplitude;
use asperity_core::declare::{Range, unit};

/// The default amplitude: in step with time. A condition goes from its old value (0) to its new one (1) along pairs of a
/// fraction of the step and a factor, linear between them.
const RAMP: &str = "[[0.0, 0.0], [1.0, 1.0]]";

struct AmplitudeForm;

fn pairs() -> impl Form<Value = Vec<Vec<f64>>> {
    list(list(number(unit::NONE, Range::ANY), 2..=2), 2..=usize::MAX)
}

fn amplitude() -> impl Form<Value = Amplitude> {
    AmplitudeForm
}

impl Form for AmplitudeForm {
    type Value = Amplitude;
    fn schema(&self) -> Schema {
        pairs().schema()
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Amplitude> {
        let pairs: Vec<[f64; 2]> = pairs().read(node, reader)?.iter().map(|pair| [pair[0], pair[1]]).collect();
        if pairs[0][0] != 0.0 || pairs[pairs.len() - 1][0] != 1.0 {
            let what = format!("`{}` must go from fraction 0 of the step to fraction 1", reader.path());
            let label = "pairs [fraction of the step, factor]";
            let help = "begin with [0.0, ...] and end with [1.0, ...]";
            reader.report(Diagnostic::error(what).at(node.place).label(label).help(help));
            return None;
        }
        let label = "pairs [fraction of the step, factor]";
        let refuse = |why| {
            let what = format!("`{}`: {why}", reader.path());
            reader.report(Diagnostic::error(what).at(node.place).label(label));
        };
        Amplitude::new(pairs).map_err(refuse).ok()
    }
}

table! {
    /// A prescribed displacement: components, or one value along a direction.
    pub struct Displacement check displacement {
        /// Along x (r).
        x: Option<f64> = number(unit::LENGTH, Range::ANY).unless_given("free"),
        /// Along y (z when axisymmetric).
        y: Option<f64> = number(unit::LENGTH, Range::ANY).unless_given("free"),
        /// Along z.
        z: Option<Spot<f64>> = number(unit::LENGTH, Range::ANY).spot().unless_given("free"),
        /// A direction of any length, for inclined supports; across it the group is free.
        along: Option<Spot<Vec<f64>>> =
            list(number(unit::NONE, Range::ANY), 2..=3).spot().unless_given("the axes"),
        /// Displacement along that direction.
        value: Option<f64> = number(unit::LENGTH, Range::ANY).unless_given("see along"),
        /// Course within the step.
        amplitude: Amplitude = amplitude().or(RAMP),
    }
}

/// For what is there from the beginning of its step.
const AT_ONCE: &str = "[[0.0, 1.0], [1.0, 1.0]]";

/// Declares a load with components of one unit.
macro_rules! vector_load {
    ($name:ident, $unit:expr, $course:expr, $about:literal) => {
        table! {
            #[doc = $about]
            pub struct $name check some_component {
                /// Along x (r).
                x: Option<f64> = number($unit, Range::ANY).unless_given("0"),
                /// Along y (z when axisymmetric).
                y: Option<f64> = number($unit, Range::ANY).unless_given("0"),
                /// Along z.
                z: Option<Spot<f64>> = number($unit, Range::ANY).spot().unless_given("0"),
                /// Course within the step.
                amplitude: Amplitude = amplitude().or($course),
            }
        }

        impl Components for $name {
            fn components(&self) -> [Option<f64>; 3] {
                [self.x, self.y, self.z.map(|z| z.value)]
            }
            fn z(&self) -> Option<Spot<f64>> {
                self.z
            }
            fn place(&self) -> Place {
                self.place
            }
        }
    };
}

vector_load!(Force, unit::FORCE, RAMP, " A force on each node.");
vector_load!(Traction, unit::STRESS, RAMP, " A force per undeformed area.");
vector_load!(BodyForce, unit::BODY_FORCE, RAMP, " A force per undeformed volume.");
vector_load!(Gravity, unit::ACCELERATION, AT_ONCE, " The acceleration of gravity.");

/// Something with components along the axes.
pub trait Components {
    /// The components that are given.
    fn components(&self) -> [Option<f64>; 3];
    /// All components, zero where none is given.
    fn vector(&self) -> [f64; 3] {
        self.components().map(Option::unwrap_or_default)
    }
    /// The component along z with its place.
    fn z(&self) -> Option<Spot<f64>>;
    /// Where it stands.
    fn place(&self) -> Place;
}

table! {
    /// A pressure.
    pub struct Pressure check pressure {
        /// The pressure, positive into the body.
        value: f64 = number(unit::STRESS, Range::ANY).required(),
        /// Whether it turns with the surface.
        kind: PressureKind = word().or("\"follower\""),
        /// Course within the step.
        amplitude: Amplitude = amplitude().or(RAMP),
        /// Whether it is that of a fluid that enters between surfaces: it acts from where it stands, see `from`, up to where
        /// contact bears more than it.
        penetrates: bool = flag().or("false"),
        /// Nodes at which a fluid stands that penetrates.
        from: Option<Name> = refers(Names::Group).computed("the rim of the sides, of a pressure that penetrates"),
    }
}

words! {
    /// Whether a pressure turns with its surface.
    pub enum PressureKind {
        /// Along the present normal, over the present area.
        Follower = "follower",
        /// Along the undeformed normal, over the undeformed area.
        Dead = "dead",
    }
}

table! {
    /// The temperature of a body or of nodes.
    pub struct TemperatureKeys check temperature {
        /// Temperature above that at which the undeformed body is free of stress.
        value: Option<f64> = number(unit::TEMPERATURE, Range::ANY).unless_given("see nodes"),
        /// That of some nodes, each with its own: pairs of the node's number in the mesh's file (in generated meshes counted from 1) and
        /// the temperature.
        nodes: Vec<Vec<f64>> = list(list(number(unit::NONE, Range::ANY), 2..=2), 0..=usize::MAX).or("[]"),
        /// Course within the step.
        amplitude: Amplitude = amplitude().or(RAMP),
    }
}

table! {
    /// A coefficient of friction: it goes from what it was to this value.
    pub struct Friction {
        /// The coefficient of friction.
        value: f64 = number(unit::NONE, Range::NOT_NEGATIVE).required(),
        /// Course within the step; `[[0.0, 1.0], [1.0, 1.0]]` changes it at once.
        amplitude: Amplitude = amplitude().or(RAMP),
    }
}

table! {
    /// Springs to the ground.
    pub struct Spring check spring {
        /// Stiffness along x (r).
        x: Option<f64> = number(unit::STIFFNESS, Range::NOT_NEGATIVE).unless_given("0"),
        /// Stiffness along y (z when axisymmetric).
        y: Option<f64> = number(unit::STIFFNESS, Range::NOT_NEGATIVE).unless_given("0"),
        /// Stiffness along z.
        z: Option<Spot<f64>> = number(unit::STIFFNESS, Range::NOT_NEGATIVE).spot().unless_given("0"),
    }
}

impl Components for Spring {
    fn components(&self) -> [Option<f64>; 3] {
        [self.x, self.y, self.z.map(|z| z.value)]
    }
    fn z(&self) -> Option<Spot<f64>> {
        self.z
    }
    fn place(&self) -> Place {
        self.place
    }
}

table! {
    /// Motion of a tool's reference point and its rotation. What no step says stays where it is.
    pub struct MotionKeys check motion {
        /// Translation along x (r).
        x: Option<f64> = number(unit::LENGTH, Range::ANY).unless_given("held"),
        /// Translation along y (z when axisymmetric).
        y: Option<f64> = number(unit::LENGTH, Range::ANY).unless_given("held"),
        /// Translation along z, in space.
        z: Option<Spot<f64>> = number(unit::LENGTH, Range::ANY).spot().unless_given("held"),
        /// Rotation about the reference point in the plane, counter-clockwise.
        rotation: Option<Spot<f64>> = number(unit::DEGREES, Range::ANY).spot().unless_given("held"),
        /// In space the tool is turned about a vector by its length; this is its component along x.
        rotation_x: Option<Spot<f64>> = number(unit::DEGREES, Range::ANY).spot().unless_given("held"),
        /// Its component along y.
        rotation_y: Option<Spot<f64>> = number(unit::DEGREES, Range::ANY).spot().unless_given("held"),
        /// Its component along z.
        rotation_z: Option<Spot<f64>> = number(unit::DEGREES, Range::ANY).spot().unless_given("held"),
        /// Course within the step.
        amplitude: Amplitude = amplitude().or(RAMP),
    }
}

table! {
    /// Force and torque on a tool's reference point; along what is loaded the tool is free to move.
    pub struct ToolLoad check load {
        /// Force along x (r).
        x: Option<f64> = number(unit::FORCE, Range::ANY).unless_given("held"),
        /// Force along y (z when axisymmetric).
        y: Option<f64> = number(unit::FORCE, Range::ANY).unless_given("held"),
        /// Force along z, in space.
        z: Option<Spot<f64>> = number(unit::FORCE, Range::ANY).spot().unless_given("held"),
        /// Torque about the reference point in the plane, counter-clockwise.
        torque: Option<Spot<f64>> = number(unit::TORQUE, Range::ANY).spot().unless_given("held"),
        /// Torque about the x axis through the reference point, in space.
        torque_x: Option<Spot<f64>> = number(unit::TORQUE, Range::ANY).spot().unless_given("held"),
        /// Torque about the y axis.
        torque_y: Option<Spot<f64>> = number(unit::TORQUE, Range::ANY).spot().unless_given("held"),
        /// Torque about the z axis.
        torque_z: Option<Spot<f64>> = number(unit::TORQUE, Range::ANY).spot().unless_given("held"),
        /// Course within the step.
        amplitude: Amplitude = amplitude().or(RAMP),
    }
}

/// Reports a condition that says nothing.
fn says_something(says: bool, place: Place, keys: &str, reader: &mut Reader) {
    if !says {
        let what = format!("`{}` says nothing", reader.path());
        reader.report(Diagnostic::error(what).at(place).label(format!("give at least one of {keys}")));
    }
}

fn some_component<T: Components>(load: &T, reader: &mut Reader) {
    says_something(load.components().iter().any(Option::is_some), load.place(), "`x`, `y`, `z`", reader);
}

fn spring(spring: &Spring, reader: &mut Reader) {
    some_component(spring, reader);
    let mut stiff = spring.components().into_iter().flatten().peekable();
    if stiff.peek().is_some() && stiff.all(|stiffness| stiffness == 0.0) {
        let what = format!("`{}` has no stiffness: it holds nothing", reader.path());
        reader.report(Diagnostic::error(what).at(spring.place).help("say a stiffness, or leave the spring out"));
    }
}

fn temperature(temperature: &TemperatureKeys, reader: &mut Reader) {
    if temperature.value.is_some() != temperature.nodes.is_empty() {
        let what = format!("`{}` needs either `value` or `nodes`", reader.path());
        reader.report(
            Diagnostic::error(what)
                .at(temperature.place)
                .help("say one temperature for all, or pairs of node and temperature"),
        );
    }
}

fn motion(motion: &MotionKeys, reader: &mut Reader) {
    let says = motion.plane().iter().chain(&motion.space()).any(Option::is_some);
    says_something(says, motion.place, "`x`, `y`, `z`, `rotation`", reader);
}

fn load(load: &ToolLoad, reader: &mut Reader) {
    let says = load.plane().iter().chain(&load.space()).any(Option::is_some);
    says_something(says, load.place, "`x`, `y`, `z`, `torque`", reader);
}

/// A key and what stands behind it.
pub type Said = (&'static str, Option<Spot<f64>>);

/// What is said of the unknowns of a tool, one value for each.
pub trait ToolCondition {
    /// Along x and y and about the axis across the plane.
    fn plane(&self) -> [Option<f64>; 3];
    /// Along and about the three axes of space.
    fn space(&self) -> [Option<f64>; 6];
    /// Keys of space alone, and the one of the plane alone.
    fn foreign(&self) -> ([Said; 4], Said);
}

fn value(spot: Option<Spot<f64>>) -> Option<f64> {
    spot.map(|spot| spot.value)
}

impl ToolCondition for MotionKeys {
    fn plane(&self) -> [Option<f64>; 3] {
        [self.x, self.y, value(self.rotation)]
    }
    fn space(&self) -> [Option<f64>; 6] {
        let [a, b, c] = [self.rotation_x, self.rotation_y, self.rotation_z].map(value);
        [self.x, self.y, value(self.z), a, b, c]
    }
    fn foreign(&self) -> ([Said; 4], Said) {
        let turns = [("rotation_x", self.rotation_x), ("rotation_y", self.rotation_y), ("rotation_z", self.rotation_z)];
        ([("z", self.z), turns[0], turns[1], turns[2]], ("rotation", self.rotation))
    }
}

impl ToolCondition for ToolLoad {
    fn plane(&self) -> [Option<f64>; 3] {
        [self.x, self.y, value(self.torque)]
    }
    fn space(&self) -> [Option<f64>; 6] {
        let [a, b, c] = [self.torque_x, self.torque_y, self.torque_z].map(value);
        [self.x, self.y, value(self.z), a, b, c]
    }
    fn foreign(&self) -> ([Said; 4], Said) {
        let turns = [("torque_x", self.torque_x), ("torque_y", self.torque_y), ("torque_z", self.torque_z)];
        ([("z", self.z), turns[0], turns[1], turns[2]], ("torque", self.torque))
    }
}

fn pressure(given: &Pressure, reader: &mut Reader) {
    let fault = match (&given.from, given.penetrates, given.kind) {
        (Some(_), false, _) => {
            Some(("says `from`, and does not penetrate", "say `penetrates = true`, or leave `from` out"))
        }
        (_, true, PressureKind::Dead) => {
            Some(("is dead, and penetrates", "a fluid presses along the present normal: leave `kind` out"))
        }
        (_, true, _) if given.value < 0.0 => Some((
            "is negative, and penetrates",
            "a fluid does not pull: give the pressure by which it exceeds that outside",
        )),
        _ => None,
    };
    if let Some((what, help)) = fault {
        let what = format!("`{}` {what}", reader.path());
        reader.report(Diagnostic::error(what).at(given.place).help(help));
    }
}

fn displacement(given: &Displacement, reader: &mut Reader) {
    let axes = given.x.is_some() || given.y.is_some() || given.z.is_some();
    says_something(axes || given.along.is_some() || given.value.is_some(), given.place, "`x`, `y`, `z`", reader);
    if given.along.is_some() != given.value.is_some() {
        let what = format!("`{}` must say both `along` and `value`, or neither", reader.path());
        reader.report(Diagnostic::error(what).at(given.place));
    }
    if let Some(along) = given.along.as_ref() {
        if axes {
            let what = format!("`{}` says both a direction and components", reader.path());
            reader.report(Diagnostic::error(what).at(along.place).help("keep one of the two"));
        }
        if along.iter().all(|&x| x == 0.0) {
            let what = format!("`{}.along` has no direction", reader.path());
            reader.report(Diagnostic::error(what).at(along.place).label("all its components are zero"));
        }
    }
}
