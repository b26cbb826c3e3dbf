//! The keys of a deck: every table once, with its words, units, ranges and defaults. These declarations are the
//! reader, the schema and the manual; nothing about a key is written anywhere else.

mod axes;
mod condition;
mod contact;
mod distributing;
mod equation;
mod initial_stress;
mod limits;
mod memory;
mod mesh;
mod output;
mod path;
mod periodic;
mod point;
mod probe;
mod rigid;
mod slide;
mod solid_tool;
mod solver;
mod step;
mod tie;
mod tool;
mod umat;
mod update;

pub use axes::AxesKeys;
pub use condition::{
    BodyForce, Components, Displacement, Force, Friction, Gravity, MotionKeys, Pressure, PressureKind, Spring,
    TemperatureKeys, ToolCondition, ToolLoad, Traction,
};
pub use contact::{Contact, ContactForm, OverlapWord, Passes, Roles, WearKeys};
pub use distributing::{DistributingKeys, Weights};
pub use equation::{EquationKeys, EquationTerm};
pub use initial_stress::InitialStressKeys;
pub use limits::LimitKeys;
pub use memory::{MullinsKeys, completed};
pub use mesh::{Generator, MeshKeys, RunKeys, Selection};
pub use output::{OutputKeys, PrintKeys, PrintedOf};
pub use path::{ControlWord, UntilKeys};
pub use periodic::Periodic;
pub use point::{PointCurve, PointDeck, PointStep};
pub use probe::{PathKeys, ProbeAt, ProbeKeys};
pub use rigid::RigidKeys;
pub use slide::{InterfaceDeck, InterfaceStep};
pub use solid_tool::{Extrude, FacetKeys, Revolve, StlKeys};
pub use solver::{SolverKeys, TangentWord};
pub use step::{IncrementKeys, StepKeys};
pub use tie::{TieGap, TieKeys};
pub use tool::{SegmentKeys, ToolKeys};
pub use umat::{SolidLaw, UmatKeys, solid_law};
use update::OWN_UPDATE;
pub use update::{DEFAULT_RATE, ObjectiveRate, UpdateKeys, integrated};

use super::diagnose::Diagnostic;
use super::form::{Form, Words, defines, list, map, number, refers, table, table_of, text, whole, word};
use super::reader::{Name, Reader};
use super::schema::Names;
use super::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_core::mesh::Space;
use asperity_core::solid::{Formulation, Integration, Strain};
use asperity_results::output::Units;

table! {
    /// A model and what is to be done with it.
    pub struct Deck check deck {
        /// Version of the deck's language.
        version: usize = whole(1..=1).required(),
        /// What pictures and summaries call the run.
        title: String = text("a title").or("\"\""),
        /// What the coordinates mean. In `axisymmetric` x is the radius and y the axis, and forces are those of the
        /// full circumference.
        space: Spot<Space> = word().spot().required(),
        /// Names of the units of force and length, and maybe of time, that the numbers are in: `"N, mm"`. Nothing is converted; they
        /// are written on pictures and in headers of tables.
        units: Option<Spot<String>> = text(UNITS).spot().unless_given("no names of units"),
        /// Thickness of a plane model, undeformed: areas of contact and of pressures are of it in plane stress too.
        thickness: Option<Spot<f64>> =
            number(unit::LENGTH, Range::POSITIVE).spot().computed("1 in the plane spaces"),
        /// Where the nodes and cells come from.
        mesh: MeshKeys = table_of().required(),
        /// Parts of groups, chosen by where they lie.
        group: Vec<(Name, Selection)> = map(defines(Names::Group), table_of()).or("{}"),
        /// Materials: a name, then a law and its numbers.
        material: Vec<(Name, SolidLaw)> = map(defines(Names::Material), solid_law()).required(),
        /// Bodies: a group of cells and what it is made of.
        body: Vec<(Name, BodyKeys)> = map(refers(Names::Cells), table_of()).required(),
        /// Rigid tools.
        tool: Vec<(Name, ToolKeys)> = map(defines(Names::Tool), table_of()).or("{}"),
        /// Surfaces and what they may touch.
        contact: Vec<(Name, Contact)> = map(defines(Names::Contact), table_of()).or("{}"),
        /// Linear equations between displacements, in all steps.
        equation: Vec<EquationKeys> = list(table_of(), 0..=usize::MAX).or("[]"),
        /// Opposite sides of a periodic cell.
        periodic: Vec<Periodic> = list(table_of(), 0..=usize::MAX).or("[]"),
        /// Groups of nodes that are rigid, called as tools are.
        rigid: Vec<(Name, RigidKeys)> = map(defines(Names::Tool), table_of()).or("{}"),
        /// Points whose force and moment groups of nodes carry by weights.
        distributing: Vec<(Name, DistributingKeys)> = map(defines(Names::Distributing), table_of()).or("{}"),
        /// Surfaces that are glued.
        tie: Vec<TieKeys> = list(table_of(), 0..=usize::MAX).or("[]"),
        /// What is done, in order.
        step: Vec<StepKeys> = step::steps().required(),
        /// How the equations are solved.
        solver: SolverKeys = table_of().or("{}"),
        /// What the figures of the certificate may be; beyond one of them a run is doubtful.
        limits: LimitKeys = table_of().or("{}"),
        /// What is written, and how often.
        output: OutputKeys = table_of().or("{}"),
        /// Chosen quantities at chosen places, in tables of their own.
        probe: Vec<(Name, ProbeKeys)> = map(defines(Names::Probe), table_of()).or("{}"),
    }
}

table! {
    /// A body.
    pub struct BodyKeys {
        /// The material it is made of.
        material: Name = refers(Names::Material).required(),
        /// How the deformation of a cell enters the law.
        formulation: Spot<Formulation> = word().spot().or("\"auto\""),
        /// Degree of its cells. Cells of first degree are raised to second by a node in the middle of each edge, and with them those of
        /// bodies that share nodes with them.
        degree: Option<Spot<usize>> = whole(1..=2).spot().unless_given(
            "that of the mesh; second where simplices, of which neither formulation nor integration is said, are too few through the body to bend",
        ),
        /// How many integration points a cell has.
        integration: Spot<Integration> = word().spot().or("\"auto\""),
        /// How displacements make strain.
        strain: Spot<Strain> = word().spot().or("\"finite\""),
        /// How the law is integrated over an increment.
        update: Option<UpdateKeys> = table_of().unless_given(OWN_UPDATE),
        /// The objective rate of the stress, in whose frame the law is integrated.
        rate: Option<Spot<ObjectiveRate>> = word().spot().unless_given(DEFAULT_RATE),
        /// Relaxation of the shape of rubber: pairs of a share of the instantaneous stress and a relaxation time (Prony series).
        prony: Spot<Vec<Vec<f64>>> = memory::prony().spot().or("[]"),
        /// Softening of rubber by the largest deformation so far.
        mullins: Option<MullinsKeys> = table_of().unless_given("none"),
        /// Bulk modulus of the pore water over the porosity, of a soil that is not drained.
        pore_stiffness: Option<Spot<f64>> = number(unit::STRESS, Range::POSITIVE).spot().unless_given("drained"),
        /// Axes of a cylinder for a law that is not alike in all directions.
        axes: Option<AxesKeys> = table_of().unless_given("those that the law says"),
        /// Mass of an undeformed unit of volume, on which gravity acts.
        density: Option<Spot<f64>> = number(unit::DENSITY, Range::POSITIVE).spot().unless_given("no weight"),
        /// Linear thermal expansion.
        expansion: Option<Spot<f64>> = number(unit::EXPANSION, Range::ANY).spot().unless_given("none"),
        /// Stresses before the first increment; supports and loads that are in equilibrium with them move nothing.
        initial_stress: Option<InitialStressKeys> = InitialStressKeys::form().unless_given("none"),
    }
}

impl Words for Formulation {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        let f_bar = "the change of volume is one for a cell, or for a patch of simplices, against locking";
        let auto = "f-bar where the law hardly changes its volume and cells would lock, else incompatible modes in quad4 and hex8, \
                    else standard; the same where f-bar would make a body wrong in bending";
        let modes = "quad4 and hex8 with incompatible modes, which are not too stiff in bending";
        vec![
            (Self::Auto, "auto", auto),
            (Self::Standard, "standard", "as it is at each point"),
            (Self::FBar, "f-bar", f_bar),
            (Self::Incompatible, "incompatible", modes),
        ]
    }
}

impl Words for Integration {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        let full = "as many as integrate the stiffness of an undistorted cell exactly";
        let auto = "reduced where quad8 and hex20 are curved so much that full integration would make a thin body wrong in \
                    bending, else full";
        vec![(Self::Auto, "auto", auto), (Self::Full, "full", full), (Self::Reduced, "reduced", "one order fewer")]
    }
}

impl Words for Strain {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        let finite = "by the deformation of each increment, with its rotation";
        let small = "linearly, by the symmetric part of the displacement gradient over the undeformed body; contact and \
                     pressure go on acting at the present places";
        vec![(Self::Finite, "finite", finite), (Self::Small, "small", small)]
    }
}

impl Words for Space {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        let meaning = |space| match space {
            Space::PlaneStrain => "plane, no strain across the plane",
            Space::PlaneStress => "plane, no stress across the plane",
            Space::Axisymmetric => "turned about the y axis",
            Space::Solid => "three dimensions",
        };
        Space::ALL.map(|space| (space, space.name(), meaning(space))).into()
    }
}

/// What the schema calls the names of units.
const UNITS: &str = "names of units";

/// What several keys of a deck say together.
fn deck(deck: &Deck, reader: &mut Reader) {
    if let Some(units) = &deck.units
        && let Err(fault) = Units::parse(units)
    {
        reader.report(Diagnostic::error(fault).at(units.place));
    }
    if let Some(thickness) = deck.thickness.filter(|_| !matches!(*deck.space, Space::PlaneStrain | Space::PlaneStress))
    {
        let what = format!("`thickness` has no meaning where space = \"{}\"", deck.space.name());
        reader.report(Diagnostic::error(what).at(thickness.place).help("remove it, or choose a plane space"));
    }
}
