//! What an input deck says, with instances laid out and names resolved.

use crate::elements::{Dialect, Type};
use crate::message::InputPlace;
use std::collections::{BTreeMap, BTreeSet};

/// A node.
#[derive(Debug, Clone)]
pub struct Node {
    /// Its number in its part.
    pub label: u64,
    /// The instance, or 0 for what belongs to none.
    pub scope: usize,
    /// Coordinates in the assembly.
    pub x: [f64; 3],
}

/// An element.
#[derive(Debug, Clone)]
pub struct Element {
    /// Its number in its part.
    pub label: u64,
    /// The instance, or 0.
    pub scope: usize,
    /// Its type.
    pub kind: &'static Type,
    /// The letters behind the name of its type.
    pub variant: String,
    /// Its nodes.
    pub nodes: Vec<usize>,
    /// Where it stands.
    pub place: InputPlace,
}

/// A set of nodes or elements.
#[derive(Debug, Clone, Default)]
pub struct Set {
    /// Its name as first written, with that of its instance before it.
    pub name: String,
    /// Members, sorted.
    pub members: Vec<usize>,
    /// Made by a preprocessor for its own use.
    pub internal: bool,
}

/// A surface.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Where it stands.
    pub place: InputPlace,
    /// What it consists of.
    pub kind: SurfaceKind,
}

/// What a surface consists of.
#[derive(Debug, Clone)]
pub enum SurfaceKind {
    /// Faces of elements, numbered from 1; without a number all exposed faces of the element; the flag tells that the
    /// negative side of a rigid element is meant.
    Faces(Vec<(usize, Option<usize>, bool)>),
    /// Nodes.
    Nodes(Vec<usize>),
    /// A rigid profile.
    Analytical(Profile),
}

/// A rigid profile of the plane, and how it becomes a surface.
#[derive(Debug, Clone)]
pub struct Profile {
    /// Segments in the order in which they are drawn, the outward normal on the left.
    pub segments: Vec<Segment>,
    /// Radius that rounds its corners.
    pub fillet: Option<f64>,
    /// How it is swept.
    pub sweep: Sweep,
}

/// A segment with its end points; coordinates of the profile.
#[derive(Debug, Clone, PartialEq)]
pub enum Segment {
    /// Straight.
    DataLine([[f64; 2]; 2]),
    /// Beginning, a point between, end.
    Arc([[f64; 2]; 3]),
    /// Beginning, middle, end.
    Parabola([[f64; 2]; 3]),
}

/// What becomes of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sweep {
    /// It stays in the plane.
    Plane,
    /// Drawn along a direction: origin, x axis and direction of the generator.
    Extruded([[f64; 3]; 3]),
    /// Turned about an axis: origin and direction.
    Revolved([[f64; 3]; 2]),
}

/// What belongs to one instance, or to the assembly itself.
#[derive(Debug, Clone, Default)]
pub struct Scope {
    /// Name of the instance, empty for the assembly.
    pub name: String,
    /// Nodes by their numbers.
    pub nodes: BTreeMap<u64, usize>,
    /// Elements by their numbers.
    pub elements: BTreeMap<u64, usize>,
    /// Numbers of elements whose type is not known.
    pub unknown: BTreeSet<u64>,
    /// Sets of nodes by their names in capitals.
    pub node_sets: BTreeMap<String, Set>,
    /// Sets of elements.
    pub element_sets: BTreeMap<String, Set>,
    /// Surfaces.
    pub surfaces: BTreeMap<String, Surface>,
    /// First a turn about an axis (point, direction, angle), then a shift.
    pub rotation: Option<([f64; 3], [f64; 3], f64)>,
    /// The shift, before the turn.
    pub translation: [f64; 3],
}

/// The law of a material, in the terms of the deck.
#[derive(Debug, Clone, Default)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Where it stands.
    pub place: InputPlace,
    /// Modulus and Poisson's ratio.
    pub elastic: Option<[f64; 2]>,
    /// Elasticity along axes.
    pub stiffness: Option<Stiffness>,
    /// A law of the user's own.
    pub user: Option<UserLaw>,
    /// How many values that keeps.
    pub states: usize,
    /// The flow curve: stress and plastic strain.
    pub plastic: Vec<[f64; 2]>,
    /// Whether its hardening is kinematic.
    pub kinematic: bool,
    /// Yield stresses along the material's axes over that of the flow curve: 11, 22, 33, 12, 13, 23 (Hill).
    pub potential: Option<[f64; 6]>,
    /// Rubber.
    pub hyperelastic: Option<Rubber>,
    /// Mass of a unit of volume.
    pub density: Option<f64>,
    /// Thermal expansion.
    pub expansion: Option<f64>,
}

/// Elasticity that is not alike in all directions.
#[derive(Debug, Clone)]
pub enum Stiffness {
    /// Three moduli, three ratios 12, 13, 23, three shear moduli 12, 13, 23.
    Constants(Vec<f64>),
    /// The upper triangle of the stiffness, column by column, in the order 11, 22, 33, 12, 13, 23.
    Coefficients(Vec<f64>),
}

/// A law that the user wrote.
#[derive(Debug, Clone)]
pub struct UserLaw {
    /// Its numbers.
    pub properties: Vec<f64>,
    /// Where it stands.
    pub place: InputPlace,
}

/// A hyperelastic law and its constants: those of shape in their order, and that of volume, D1.
#[derive(Debug, Clone)]
pub struct Rubber {
    /// Which.
    pub form: Form,
    /// Constants of shape.
    pub constants: Vec<f64>,
    /// D1; zero where the deck leaves it to the program.
    pub d1: f64,
    /// Where it stands.
    pub place: InputPlace,
}

/// Hyperelastic laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// C10.
    NeoHooke,
    /// C10, C01.
    MooneyRivlin,
    /// C10, C20, C30.
    Yeoh,
    /// Pairs mu, alpha.
    Ogden,
    /// mu, locking stretch.
    ArrudaBoyce,
}

/// Elements and their material.
#[derive(Debug, Clone)]
pub struct Section {
    /// Name of the set of elements.
    pub set: String,
    /// Its elements.
    pub elements: Vec<usize>,
    /// The material's number.
    pub material: usize,
    /// Thickness of plane elements.
    pub thickness: Option<f64>,
    /// The name of the material's axes.
    pub orientation: Option<String>,
    /// Where it stands.
    pub place: InputPlace,
}

/// A course in time.
#[derive(Debug, Clone)]
pub struct Amplitude {
    /// Times and factors.
    pub points: Vec<[f64; 2]>,
    /// Whether time counts from the beginning of the analysis.
    pub total: bool,
}

/// What happens where surfaces touch.
#[derive(Debug, Clone, Default)]
pub struct Interaction {
    /// Its name.
    pub name: String,
    /// Coefficient of friction; none without friction.
    pub friction: Option<f64>,
    /// No slip at all.
    pub rough: bool,
    /// Largest shear stress.
    pub shear_limit: Option<f64>,
    /// Kinetic friction and the decay per velocity.
    pub decay: Option<[f64; 2]>,
    /// Shear stress for one unit of elastic slip.
    pub stick_slope: Option<f64>,
    /// Pressure for one unit of penetration; none for hard contact.
    pub slope: Option<f64>,
    /// Rows of penetration and pressure, where no slope says it all.
    pub closure: Vec<[f64; 2]>,
    /// The surfaces stay together as they are.
    pub tied: bool,
}

/// Nodes that are moved onto a surface before the first step.
#[derive(Debug, Clone)]
pub struct Adjust {
    /// Those that stand off by no more than this.
    pub distance: f64,
    /// Of these only.
    pub nodes: Option<Vec<usize>>,
    /// How far they stand off afterwards, those too that lie inside; onto the surface where nothing is said.
    pub clearance: Option<f64>,
}

/// Two surfaces that may touch.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Where it stands.
    pub place: InputPlace,
    /// The dependent surface: scope and name in capitals.
    pub slave: (usize, String),
    /// What it touches.
    pub master: (usize, String),
    /// The interaction's number.
    pub interaction: usize,
    /// Which nodes are moved onto the surface at the beginning, if any.
    pub adjust: Option<Adjust>,
    /// Whether contact stress is a field on the surface (mortar), and not at points of it.
    pub field: bool,
}

/// Two surfaces that are glued.
#[derive(Debug, Clone)]
pub struct Tie {
    /// Where it stands.
    pub place: InputPlace,
    /// The surface whose nodes follow: scope and name in capitals.
    pub slave: (usize, String),
    /// What they follow.
    pub master: (usize, String),
    /// The largest gap, if it is given.
    pub tolerance: Option<f64>,
    /// Whether nodes are moved onto the master.
    pub adjust: bool,
}

/// A rigid body: what follows a reference node.
#[derive(Debug, Clone)]
pub struct Rigid {
    /// Where it stands.
    pub place: InputPlace,
    /// The reference node.
    pub node: usize,
    /// Node whose translations are the rotation of the body (CalculiX).
    pub rotation_node: Option<usize>,
    /// What is rigid.
    pub what: RigidPart,
    /// Whether its nodes only carry what loads the reference node.
    pub distributing: bool,
    /// Along which axes its nodes go with the reference node; all of them is rigid.
    pub axes: [bool; 3],
}

impl Rigid {
    /// What follows a node by translation and rotation.
    pub fn new(place: InputPlace, node: usize, what: RigidPart) -> Self {
        Self { place, node, rotation_node: None, what, distributing: false, axes: [true; 3] }
    }

    /// Whether it goes with its node along some axes only.
    pub fn is_partial(&self) -> bool {
        self.axes != [true; 3]
    }
}

/// What is rigid.
#[derive(Debug, Clone)]
pub enum RigidPart {
    /// An analytical surface.
    Surface(usize, String),
    /// Rigid elements.
    Elements(Vec<usize>),
    /// Nodes of bodies.
    Nodes(Vec<usize>, String),
    /// The nodes of a surface of bodies.
    Sides(usize, String),
}

/// Three axes of a node: unit vectors.
pub type Frame = [[f64; 3]; 3];

/// Axes of materials.
#[derive(Debug, Clone, PartialEq)]
pub enum Orientation {
    /// The same everywhere.
    Straight(Frame),
    /// Those of a cylinder: a point of its axis and where that goes; turned about one of them, from 0 to 2, by an angle in degrees.
    Cylinder {
        /// A point of the axis.
        origin: [f64; 3],
        /// A unit vector along it.
        along: [f64; 3],
        /// The axis of the turn, and the angle.
        turn: (usize, f64),
    },
}

/// A sum of displacements with factors that is zero.
#[derive(Debug, Clone)]
pub struct Equation {
    /// Where it stands.
    pub place: InputPlace,
    /// Node, axis and factor.
    pub terms: Vec<(usize, usize, f64)>,
}

/// How a value is laid on: the course, or the ramp of the step.
pub type Course = Option<usize>;

/// Nodes and the name that the deck gives them.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The name of a set or a number.
    pub name: String,
    /// Nodes or elements, sorted.
    pub members: Vec<usize>,
}

/// What a step says.
#[derive(Debug, Clone)]
pub struct Action {
    /// Where.
    pub place: InputPlace,
    /// Its course.
    pub course: Course,
    /// What.
    pub kind: ActionKind,
}

/// Kinds of what a step says.
#[derive(Debug, Clone)]
pub enum ActionKind {
    /// All conditions of this kind end (OP=NEW).
    Fresh(Condition),
    /// Nodes are led along an axis, 0 to 2 translations and 3 to 5 rotations; none holds them where they are.
    Lead(Target, usize, f64),
    /// A force or moment on nodes.
    Force(Target, usize, f64),
    /// A pressure on faces of elements: the elements and the face, or the faces of a surface.
    Pressure(Target, Vec<(usize, Option<usize>)>, f64),
    /// A force per volume along a vector; with the density of the material where it is gravity.
    Volume(Target, [f64; 3], bool),
    /// A temperature of nodes.
    Temperature(Target, f64),
    /// An interaction has another coefficient of friction.
    Friction(usize, f64),
    /// Elements are taken away, or are there again where this is true.
    Elements(Target, bool),
    /// The contact of two surfaces ends, or is there again where this is true.
    Contact((usize, String), (usize, String), bool),
}

/// Kinds of conditions that a step can begin anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Condition {
    /// BOUNDARY.
    Boundary,
    /// CLOAD.
    Force,
    /// DLOAD and DSLOAD.
    Distributed,
    /// TEMPERATURE.
    Temperature,
}

/// A path of equilibria that a step follows by its length.
#[derive(Debug, Clone)]
pub struct Path {
    /// The node, the axis and the displacement at which it ends.
    pub until: Option<(Target, usize, f64)>,
}

/// A step.
#[derive(Debug, Clone, Default)]
pub struct Step {
    /// Where it stands.
    pub place: InputPlace,
    /// Its name.
    pub name: String,
    /// Whether strains and rotations are large.
    pub large: bool,
    /// Whether loads without an amplitude are there from its beginning.
    pub at_once: bool,
    /// Whether a procedure was given.
    pub procedure: bool,
    /// How long it lasts.
    pub duration: f64,
    /// First, least and largest increment, as times.
    pub increments: [Option<f64>; 3],
    /// Increments of one size.
    pub direct: bool,
    /// The most increments.
    pub most: Option<u64>,
    /// How it follows a path, if it does.
    pub path: Option<Path>,
    /// What it says, in order.
    pub actions: Vec<Action>,
}

/// A file or a table that is to be written.
#[derive(Debug)]
pub struct Output {
    /// Where it stands.
    pub place: InputPlace,
    /// Every so many increments.
    pub every: u64,
    /// What.
    pub kind: OutputKind,
}

/// What is to be written.
#[derive(Debug, PartialEq)]
pub enum OutputKind {
    /// All fields, for viewers.
    File,
    /// A table of quantities, by the names that they have in results.
    Print {
        /// Whose.
        whose: Printed,
        /// The names.
        quantities: Vec<&'static str>,
        /// Whether values, their sum or both.
        totals: Totals,
    },
}

/// Whose values are printed; of all where nothing is named.
#[derive(Debug, PartialEq)]
pub enum Printed {
    /// Of nodes.
    Nodes(Option<Target>),
    /// Of the integration points of elements.
    Elements(Option<Target>),
    /// Of contact pairs: their surfaces by scope and name in capitals.
    Contacts([Option<(usize, String)>; 2]),
}

/// Values or sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Totals {
    /// Values.
    No,
    /// Both.
    Yes,
    /// Sums.
    Only,
}

/// All that a deck says.
#[derive(Debug, Default)]
pub struct Model {
    /// Whose deck it is.
    pub dialect: Dialect,
    /// The heading.
    pub title: String,
    /// Nodes.
    pub nodes: Vec<Node>,
    /// Elements.
    pub elements: Vec<Element>,
    /// The assembly, then its instances.
    pub scopes: Vec<Scope>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Sections.
    pub sections: Vec<Section>,
    /// Amplitudes by their names in capitals.
    pub amplitudes: Vec<(String, Amplitude)>,
    /// Interactions.
    pub interactions: Vec<Interaction>,
    /// Contact pairs.
    pub pairs: Vec<Pair>,
    /// Ties.
    pub ties: Vec<Tie>,
    /// Rigid bodies.
    pub rigid: Vec<Rigid>,
    /// Linear equations.
    pub equations: Vec<Equation>,
    /// Axes of materials by their names.
    pub orientations: BTreeMap<String, Orientation>,
    /// Axes of nodes that have their own.
    pub frames: BTreeMap<usize, Frame>,
    /// Temperatures at the beginning, by nodes.
    pub initial_temperature: BTreeMap<usize, f64>,
    /// What holds before the first step.
    pub initial: Vec<Action>,
    /// Steps.
    pub steps: Vec<Step>,
    /// What is to be written.
    pub outputs: Vec<Output>,
}

impl Model {
    /// What holds from a step on: what it says, in the first after what holds before it.
    pub fn actions(&self, step: usize) -> impl Iterator<Item = &Action> {
        let initial = self.initial.iter().filter(move |_| step == 0);
        initial.chain(self.steps.get(step).into_iter().flat_map(|step| &step.actions))
    }

    /// Whether the surfaces of a pair stay together as they are.
    pub fn is_tied(&self, pair: &Pair) -> bool {
        self.interactions.get(pair.interaction).is_some_and(|interaction| interaction.tied)
    }

    /// A surface by its scope and name.
    pub fn surface(&self, (scope, name): &(usize, String)) -> Option<&Surface> {
        self.scopes.get(*scope)?.surfaces.get(name)
    }
}
