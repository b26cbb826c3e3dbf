//! Where nodes, cells and groups come from.

use crate::diagnose::Diagnostic;
use crate::form::{Form, Words, defines, flag, list, map, number, one_of, refers, table, table_of, text, whole, word};
use crate::reader::{Name, Reader};
use crate::schema::{Names, Schema};
use crate::source::{Place, Spot};
use crate::tree::Node;
use asperity_core::declare::{Range, unit};
use asperity_core::mesh::{Cell, cells};

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
        ratio: Option<Spot<Vec<f64>>> = ratios(2).spot().unless_given("1 in each direction"),
        /// Runs of cells along x, in place of `to` and `cells`.
        along_x: Vec<RunKeys> = runs().or("[]"),
        /// Runs of cells along y.
        along_y: Vec<RunKeys> = runs().or("[]"),
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
        ratio: Option<Spot<Vec<f64>>> = ratios(2).spot().unless_given("1 in each direction"),
        /// Runs of cells along the radius, in place of `to` and `cells`.
        along_radius: Vec<RunKeys> = runs().or("[]"),
        /// Runs of cells along the angle.
        along_angle: Vec<RunKeys> = runs().or("[]"),
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
        ratio: Option<Spot<Vec<f64>>> = ratios(3).spot().unless_given("1 in each direction"),
        /// Runs of cells along x, in place of `to` and `cells`.
        along_x: Vec<RunKeys> = runs().or("[]"),
        /// Runs of cells along y.
        along_y: Vec<RunKeys> = runs().or("[]"),
        /// Runs of cells along z.
        along_z: Vec<RunKeys> = runs().or("[]"),
        /// Kind of its cells.
        cell: Spot<&'static Cell> = SolidCell.spot().required(),
    }
}

table! {
    /// Cells in a row, up to a breakpoint.
    pub struct RunKeys check run {
        /// The breakpoint.
        to: f64 = number(unit::LENGTH, Range::ANY).required(),
        /// Number of cells.
        cells: usize = whole(1..=10_000_000).required(),
        /// Size of the last cell over the size of the first.
        ratio: Option<Spot<f64>> = number(unit::NONE, Range::POSITIVE).spot().unless_given("1"),
        /// Whether sizes continue those of the run before without a jump, in place of `ratio`.
        smooth: bool = flag().or("false"),
    }
}

table! {
    /// A part of a group, or of several together: their nodes within the ranges, and their cells and sides whose nodes all
    /// are. Bounds are included; a direction without a range is not looked at.
    pub struct Selection check selection {
        /// The group to choose from.
        of: Name = refers(Names::Group).required(),
        /// Further groups that belong to it.
        with: Vec<Name> = list(refers(Names::Group), 0..=usize::MAX).or("[]"),
        /// Least and largest x.
        x: Option<Spot<Vec<f64>>> = point(2).spot().unless_given("any"),
        /// Least and largest y.
        y: Option<Spot<Vec<f64>>> = point(2).spot().unless_given("any"),
        /// Least and largest z.
        z: Option<Spot<Vec<f64>>> = point(2).spot().unless_given("any"),
    }
}

impl Selection {
    /// The groups to choose from.
    pub fn groups(&self) -> impl Iterator<Item = &Name> {
        std::iter::once(&self.of).chain(&self.with)
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

fn runs() -> impl Form<Value = Vec<RunKeys>> {
    list(table_of::<RunKeys>(), 0..=usize::MAX)
}

fn given(mesh: &MeshKeys, reader: &mut Reader) {
    if mesh.file.is_none() && mesh.part.is_empty() {
        let nothing = Diagnostic::error("`mesh` has neither a file nor a part").at(mesh.place);
        reader.report(nothing.help("say file = \"NAME.msh\", or part.NAME.rectangle = { ... }"));
    }
}

/// How a part says where its cells end: `to` and `cells` for all directions, or runs for all; never a mixture that one
/// has to guess.
struct Extent<'k> {
    /// What the part is called.
    what: &'static str,
    place: Place,
    /// Whether `to` and `cells` are given.
    simple: [bool; 2],
    ratio: Option<Place>,
    along: &'k [(&'static str, &'k [RunKeys])],
}

impl Extent<'_> {
    fn judge(&self, reader: &mut Reader) {
        let runs = self.along.iter().filter(|(_, runs)| !runs.is_empty()).count();
        let names = self.along.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(" and ");
        match (self.simple, runs) {
            ([true, true], 0) => {}
            ([false, false], runs) if runs == self.along.len() => self.judge_ratio(reader),
            _ => {
                let what = format!("`{}` must say either `to` and `cells`, or {names}", reader.path());
                let label = format!("size of this {}", self.what);
                reader.report(Diagnostic::error(what).at(self.place).label(label));
            }
        }
    }

    fn judge_ratio(&self, reader: &mut Reader) {
        if let Some(place) = self.ratio {
            let what = format!("`{}.ratio` has no meaning beside runs of cells", reader.path());
            reader.report(Diagnostic::error(what).at(place).help("each run has a `ratio` of its own"));
        }
    }
}

fn rectangle(part: &Rectangle, reader: &mut Reader) {
    let along = &[("along_x", &part.along_x[..]), ("along_y", &part.along_y)];
    let (simple, ratio) = ([part.to.is_some(), part.cells.is_some()], part.ratio.as_ref().map(|ratio| ratio.place));
    Extent { what: "rectangle", place: part.place, simple, ratio, along }.judge(reader);
}

fn annulus(part: &Annulus, reader: &mut Reader) {
    let along = &[("along_radius", &part.along_radius[..]), ("along_angle", &part.along_angle)];
    let (simple, ratio) = ([part.to.is_some(), part.cells.is_some()], part.ratio.as_ref().map(|ratio| ratio.place));
    Extent { what: "annulus", place: part.place, simple, ratio, along }.judge(reader);
}

fn block(part: &Block, reader: &mut Reader) {
    let along = &[("along_x", &part.along_x[..]), ("along_y", &part.along_y), ("along_z", &part.along_z)];
    let (simple, ratio) = ([part.to.is_some(), part.cells.is_some()], part.ratio.as_ref().map(|ratio| ratio.place));
    Extent { what: "box", place: part.place, simple, ratio, along }.judge(reader);
}

fn run(run: &RunKeys, reader: &mut Reader) {
    if let Some(ratio) = run.ratio.filter(|_| run.smooth) {
        let what = format!("`{}` says both `smooth` and `ratio`", reader.path());
        reader.report(Diagnostic::error(what).at(ratio.place).help("a smooth run finds its ratio itself; keep one"));
    }
}

fn selection(selection: &Selection, reader: &mut Reader) {
    for (axis, range) in [("x", &selection.x), ("y", &selection.y), ("z", &selection.z)] {
        if let Some(range) = range.as_ref().filter(|range| range[0] > range[1]) {
            let what =
                format!("`{}.{axis}`: the least, {}, lies above the largest, {}", reader.path(), range[0], range[1]);
            reader.report(Diagnostic::error(what).at(range.place).help("exchange the two"));
        }
    }
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
