//! Where nodes, cells and groups come from.

use crate::deck::diagnose::Diagnostic;
use crate::deck::form::{
    Form, Words, defines, flag, list, map, number, one_of, refers, table, table_of, text, whole, word,
};
use crate::deck::reader::{Name, Reader};
use crate::deck::schema::{Names, Schema};
use crate::deck::source::Spot;
use crate::deck::tree::Node;
use crate::declare::{Range, unit};
use crate::mesh::{Cell, cells};

table! {
    /// Where the nodes and cells come from: a file, generated parts, or both.
    pub struct MeshKeys check given {
        /// A mesh file, its path relative to the deck's. Its named groups keep their names.
        file: Option<Spot<String>> = text("the path of a mesh file").spot().unless_given("no file"),
        /// Generated parts. A part NAME brings the group NAME of its cells, NAME.left and so on of its sides, and
        /// NAME.bottom_left and so on of its corners.
        part: Vec<(Name, Generator)> = map(defines(Names::Part), Generator::form()).or("{}"),
    }
}

one_of! {
    /// A generated part of the mesh.
    pub enum Generator {
        /// A rectangle along the axes: sides left, right, bottom, top.
        Rectangle(Rectangle) = "rectangle" => table_of::<Rectangle>(),
        /// A sector of an annulus, or with 360 degrees the whole ring: sides inner, outer, start, end.
        Annulus(Annulus) = "annulus" => table_of::<Annulus>(),
        /// A box along the axes: sides left, right (x), bottom, top (y), back, front (z).
        Block(Block) = "box" => table_of::<Block>(),
    }
}

table! {
    /// A rectangle.
    pub struct Rectangle check rectangle {
        /// Its corner with the least coordinates `[x, y]`.
        from: Vec<f64> = point(2).required(),
        /// The opposite corner.
        to: Option<Vec<f64>> = point(2).unless_given("the ends of along_x and along_y"),
        /// Number of cells along `[x, y]`.
        cells: Option<Vec<usize>> = counts(2).unless_given("those of along_x and along_y"),
        /// Size of the last cell over the size of the first along `[x, y]`.
        ratio: Vec<f64> = ratios(2).or("[1.0, 1.0]"),
        /// Runs of cells along x, in place of `to` and `cells`.
        along_x: Vec<Run> = runs().or("[]"),
        /// Runs of cells along y.
        along_y: Vec<Run> = runs().or("[]"),
        /// Kind of its cells.
        cell: Spot<&'static Cell> = PlaneCell.spot().required(),
    }
}

table! {
    /// A sector of an annulus.
    pub struct Annulus check annulus {
        /// Centre of its circles.
        centre: Vec<f64> = point(2).or("[0.0, 0.0]"),
        /// `[inner radius, first angle]`, angles in degrees counter-clockwise from the x axis.
        from: Vec<f64> = point(2).required(),
        /// `[outer radius, last angle]`.
        to: Option<Vec<f64>> = point(2).unless_given("the ends of along_radius and along_angle"),
        /// Number of cells along `[radius, angle]`.
        cells: Option<Vec<usize>> = counts(2).unless_given("those of along_radius and along_angle"),
        /// Size of the last cell over the size of the first along `[radius, angle]`.
        ratio: Vec<f64> = ratios(2).or("[1.0, 1.0]"),
        /// Runs of cells along the radius, in place of `to` and `cells`.
        along_radius: Vec<Run> = runs().or("[]"),
        /// Runs of cells along the angle.
        along_angle: Vec<Run> = runs().or("[]"),
        /// Kind of its cells.
        cell: Spot<&'static Cell> = PlaneCell.spot().required(),
    }
}

table! {
    /// A box.
    pub struct Block check block {
        /// Its corner with the least coordinates `[x, y, z]`.
        from: Vec<f64> = point(3).required(),
        /// The opposite corner.
        to: Option<Vec<f64>> = point(3).unless_given("the ends of along_x, along_y and along_z"),
        /// Number of cells along `[x, y, z]`.
        cells: Option<Vec<usize>> = counts(3).unless_given("those of along_x, along_y and along_z"),
        /// Size of the last cell over the size of the first along `[x, y, z]`.
        ratio: Vec<f64> = ratios(3).or("[1.0, 1.0, 1.0]"),
        /// Runs of cells along x, in place of `to` and `cells`.
        along_x: Vec<Run> = runs().or("[]"),
        /// Runs of cells along y.
        along_y: Vec<Run> = runs().or("[]"),
        /// Runs of cells along z.
        along_z: Vec<Run> = runs().or("[]"),
        /// Kind of its cells.
        cell: Spot<&'static Cell> = SolidCell.spot().required(),
    }
}

table! {
    /// Cells in a row, up to a breakpoint.
    pub struct Run {
        /// The breakpoint.
        to: f64 = number(unit::LENGTH, Range::ANY).required(),
        /// Number of cells.
        cells: usize = whole(1..=10_000_000).required(),
        /// Size of the last cell over the size of the first.
        ratio: f64 = number(unit::NONE, Range::POSITIVE).or("1.0"),
        /// Whether sizes continue those of the run before, without a jump; `ratio` then has no say.
        smooth: bool = flag().or("false"),
    }
}

table! {
    /// A part of a group: its nodes within the ranges, and its cells and sides whose nodes all are. Bounds are
    /// included; a direction without a range is not looked at.
    pub struct Selection {
        /// The group to choose from.
        of: Name = refers(Names::Group).required(),
        /// Least and largest x.
        x: Option<Vec<f64>> = point(2).unless_given("any"),
        /// Least and largest y.
        y: Option<Vec<f64>> = point(2).unless_given("any"),
        /// Least and largest z.
        z: Option<Vec<f64>> = point(2).unless_given("any"),
    }
}

fn point(length: usize) -> impl Form<Value = Vec<f64>> {
    list(number(unit::LENGTH, Range::ANY), length..=length)
}

fn counts(length: usize) -> impl Form<Value = Vec<usize>> {
    list(whole(1..=10_000_000), length..=length)
}

fn ratios(length: usize) -> impl Form<Value = Vec<f64>> {
    list(number(unit::NONE, Range::POSITIVE), length..=length)
}

fn runs() -> impl Form<Value = Vec<Run>> {
    list(table_of::<Run>(), 0..=usize::MAX)
}

fn given(mesh: &MeshKeys, reader: &mut Reader) {
    if mesh.file.is_none() && mesh.part.is_empty() {
        let nothing = Diagnostic::error("`mesh` has neither a file nor a part").at(mesh.place);
        reader.report(nothing.help("say file = \"NAME.msh\", or part.NAME.rectangle = { ... }"));
    }
}

/// `to` and `cells` for all directions, or runs for all: never a mixture that one has to guess.
fn one_way(table: (&str, crate::deck::source::Place), simple: [bool; 2], along: &[(&str, bool)], reader: &mut Reader) {
    let runs = along.iter().filter(|(_, given)| *given).count();
    if (simple == [true; 2] && runs == 0) || (simple == [false; 2] && runs == along.len()) {
        return;
    }
    let names = along.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(" and ");
    let what = format!("`{}` must say either `to` and `cells`, or {names}", reader.path());
    reader.report(Diagnostic::error(what).at(table.1).label(format!("size of this {}", table.0)));
}

fn rectangle(part: &Rectangle, reader: &mut Reader) {
    let along = [("along_x", !part.along_x.is_empty()), ("along_y", !part.along_y.is_empty())];
    one_way(("rectangle", part.place), [part.to.is_some(), part.cells.is_some()], &along, reader);
}

fn annulus(part: &Annulus, reader: &mut Reader) {
    let along = [("along_radius", !part.along_radius.is_empty()), ("along_angle", !part.along_angle.is_empty())];
    one_way(("annulus", part.place), [part.to.is_some(), part.cells.is_some()], &along, reader);
}

fn block(part: &Block, reader: &mut Reader) {
    let given = [&part.along_x, &part.along_y, &part.along_z].map(|runs| !runs.is_empty());
    let along = [("along_x", given[0]), ("along_y", given[1]), ("along_z", given[2])];
    one_way(("box", part.place), [part.to.is_some(), part.cells.is_some()], &along, reader);
}

/// A cell of two dimensions, by its registered name.
#[derive(Clone, Copy)]
struct PlaneKind(&'static Cell);
/// A cell of three dimensions, by its registered name.
#[derive(Clone, Copy)]
struct SolidKind(&'static Cell);

fn kinds<T>(dimension: usize, wrap: fn(&'static Cell) -> T) -> Vec<(T, &'static str, &'static str)> {
    let fit = cells::ALL.iter().copied().filter(move |cell| cell.dimension == dimension);
    fit.map(|cell| (wrap(cell), cell.name, if cell.degree == 1 { "first degree" } else { "second degree" })).collect()
}

impl Words for PlaneKind {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        kinds(2, PlaneKind)
    }
}

impl Words for SolidKind {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        kinds(3, SolidKind)
    }
}

struct PlaneCell;
struct SolidCell;

impl Form for PlaneCell {
    type Value = &'static Cell;
    fn schema(&self) -> Schema {
        word::<PlaneKind>().schema()
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<&'static Cell> {
        word::<PlaneKind>().read(node, reader).map(|kind| kind.0)
    }
}

impl Form for SolidCell {
    type Value = &'static Cell;
    fn schema(&self) -> Schema {
        word::<SolidKind>().schema()
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<&'static Cell> {
        word::<SolidKind>().read(node, reader).map(|kind| kind.0)
    }
}
