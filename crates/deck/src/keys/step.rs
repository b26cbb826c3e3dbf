//! Steps: increments, supports, loads and the motion of tools.
//!
//! A condition holds from the step that says it until a later step says it anew or releases it. Within a step it goes
//! from where it was to the value it says, along its amplitude.

use super::condition::{
    BodyForce, Displacement, Force, Friction, Gravity, MotionKeys, Pressure, Spring, TemperatureKeys, ToolCondition,
    ToolLoad, Traction,
};
use super::path::{ControlWord, UntilKeys, follows};
use crate::diagnose::Diagnostic;
use crate::form::{Form, list, map, number, refers, table, table_of, text, whole, word};
use crate::reader::{Name, Reader};
use crate::schema::{Names, Schema};
use crate::source::Spot;
use crate::tree::Node;
use asperity_core::declare::{Range, unit};
use asperity_core::solve::SMALLEST;
use std::collections::BTreeSet;

table! {
    /// A step.
    pub struct StepKeys check conflicts {
        /// What messages and results call it.
        name: Option<Spot<String>> = text("the name of a step").spot().computed("step and its number"),
        /// How long it lasts.
        duration: f64 = number(unit::TIME, Range::POSITIVE).or("1.0"),
        /// How its time is cut into increments.
        increments: IncrementKeys = table_of().or("{}"),
        /// What the increments are parts of: `"arc-length"` follows loads past limit points, as in snap-through.
        control: Spot<ControlWord> = word().spot().or("\"time\""),
        /// Where a step of `control = "arc-length"` ends, whatever the load is there.
        until: Option<UntilKeys> = table_of().unless_given("where the whole load is reached"),
        /// Prescribed displacements of groups, from their undeformed place.
        displacement: Vec<(Name, Displacement)> = map(refers(Names::Group), table_of()).or("{}"),
        /// Flat groups of sides that may not move along their normal.
        symmetry: Vec<Name> = list(refers(Names::Sides), 0..=usize::MAX).or("[]"),
        /// Forces on each node of groups; not on those with which cells were raised to second degree.
        force: Vec<(Name, Force)> = map(refers(Names::Group), table_of()).or("{}"),
        /// Pressures on groups of sides, positive into the body.
        pressure: Vec<(Name, Pressure)> = map(refers(Names::Sides), table_of()).or("{}"),
        /// Forces per undeformed area on groups of sides, of fixed direction.
        traction: Vec<(Name, Traction)> = map(refers(Names::Sides), table_of()).or("{}"),
        /// Forces per undeformed volume on groups of cells.
        body_force: Vec<(Name, BodyForce)> = map(refers(Names::Cells), table_of()).or("{}"),
        /// Gravity, which acts on all bodies with a `density`, from the beginning of the step unless an amplitude says
        /// otherwise, until a later step says another; zero ends it.
        gravity: Option<Gravity> = table_of().unless_given("none, or that of the step before"),
        /// Temperatures of bodies with an `expansion`, and of nodes of such; of those that name a node the last of a step holds.
        temperature: Vec<(Name, TemperatureKeys)> = map(refers(Names::Group), table_of()).or("{}"),
        /// Springs to the ground at each node of groups; not at those with which cells were raised to second degree.
        spring: Vec<(Name, Spring)> = map(refers(Names::Group), table_of()).or("{}"),
        /// Motions of tools, from their first place.
        motion: Vec<(Name, MotionKeys)> = map(refers(Names::Tool), table_of()).or("{}"),
        /// Forces and torques on tools that are free to follow them, and on points whose loads a group carries.
        load: Vec<(Name, ToolLoad)> = map(refers(Names::Loadable), table_of()).or("{}"),
        /// Tools, rigid groups and groups of nodes that stay where they are: whatever led or loaded them ends.
        hold: Vec<Name> = list(refers(Names::Movable), 0..=usize::MAX).or("[]"),
        /// Coefficients of friction of contacts from here on, of laws that have a `friction`.
        friction: Vec<(Name, Friction)> = map(refers(Names::Contact), table_of()).or("{}"),
        /// Contacts that end here, or tools with all of their contacts, or bodies with contacts and loads on them; their forces fade over
        /// the step. Of the names of a contact, a tool and a body the first is meant.
        remove: Vec<Name> = list(refers(Names::Removable), 0..=usize::MAX).or("[]"),
        /// Contacts that were removed and are there again, or tools with all of theirs; bodies begin anew, without stress in the shape that
        /// their nodes have.
        add: Vec<Name> = list(refers(Names::Removable), 0..=usize::MAX).or("[]"),
        /// Conditions of earlier steps that end here; what they held is let go over the step: `["pressure.bore", "displacement.far_end"]`.
        release: Vec<Name> = list(refers(Names::Condition), 0..=usize::MAX).or("[]"),
    }
}

table! {
    /// Increments of a step, as fractions of its duration.
    pub struct IncrementKeys check increments {
        /// A fixed number of equal increments; one that does not converge is still cut, and where an amplitude bends one ends.
        count: Option<Spot<usize>> = whole(1..=10_000_000).spot().unless_given("sizes chosen as the run goes"),
        /// The first.
        first: Option<Spot<f64>> = fraction().spot().computed("0.05"),
        /// The largest.
        largest: Option<Spot<f64>> = fraction().spot()
            .computed("0.1; along a path longer while no node moves by more than a 400th of the model's size in one"),
        /// The smallest; a step that needs a smaller one fails.
        smallest: Spot<f64> = number(unit::NONE, Range::from_to(SMALLEST, 1.0)).spot().or("1e-6"),
        /// The most increments of the step.
        most: usize = whole(1..=100_000_000).or("100000"),
    }
}

fn fraction() -> impl Form<Value = f64> {
    number(unit::NONE, Range::above_to(0.0, 1.0))
}

fn increments(increments: &IncrementKeys, reader: &mut Reader) {
    match increments.count {
        Some(count) => equal_increments(increments, count, reader),
        None => chosen_increments(increments, reader),
    }
}

/// A count leaves no other size to say, and must itself be allowed.
fn equal_increments(keys: &IncrementKeys, count: Spot<usize>, reader: &mut Reader) {
    for (key, given) in [("first", keys.first), ("largest", keys.largest)] {
        if let Some(given) = given {
            let what = format!("`{}` says both `count` and `{key}`", reader.path());
            reader.report(Diagnostic::error(what).at(given.place).help("equal increments have no other size"));
        }
    }
    if count.value > keys.most {
        let what = format!("`{}.count` exceeds `most`, {}", reader.path(), keys.most);
        reader.report(Diagnostic::error(what).at(count.place).help("raise `most`, or ask for fewer increments"));
    }
    let size = 1.0 / count.value as f64;
    if size < *keys.smallest {
        let what = format!("`{}.count`: increments of {size} lie below `smallest`, {}", reader.path(), *keys.smallest);
        reader.report(Diagnostic::error(what).at(count.place).help("lower `smallest`, or ask for fewer increments"));
    }
}

/// smallest <= first <= largest, wherever they are given.
fn chosen_increments(keys: &IncrementKeys, reader: &mut Reader) {
    let smallest = *keys.smallest;
    for (key, given) in [("first", keys.first), ("largest", keys.largest)] {
        if let Some(given) = given.filter(|given| **given < smallest) {
            let what = format!("`{}.{key}` lies below `smallest`, {smallest}", reader.path());
            reader.report(Diagnostic::error(what).at(given.place).help(format!("raise `{key}`, or lower `smallest`")));
        }
    }
    if let (Some(first), Some(largest)) = (keys.first, keys.largest)
        && *first > *largest
    {
        let what = format!("`{}.first` lies above `largest`, {}", reader.path(), *largest);
        reader.report(Diagnostic::error(what).at(first.place).help("lower `first`, or raise `largest`"));
    }
}

impl IncrementKeys {
    /// First and largest increment as fractions of the step.
    pub fn sizes(&self) -> (f64, f64) {
        if let Some(count) = self.count {
            return (1.0 / count.value as f64, 1.0 / count.value as f64);
        }
        let first = self.first.map(|first| first.value);
        let largest = self.largest.map_or(first.unwrap_or(0.0).max(0.1), |largest| largest.value);
        (first.unwrap_or(0.05).min(largest), largest)
    }
}

impl StepKeys {
    /// Whether it says a load besides gravity.
    pub fn is_loaded(&self) -> bool {
        !(self.force.is_empty()
            && self.pressure.is_empty()
            && self.traction.is_empty()
            && self.body_force.is_empty()
            && self.load.is_empty())
    }

    /// All conditions of the step by the names under which a later step may release them.
    pub fn conditions(&self) -> Vec<(String, &Name)> {
        fn of<'a, T>(kind: &str, list: &'a [(Name, T)]) -> Vec<(String, &'a Name)> {
            list.iter().map(|(name, _)| (format!("{kind}.{name}"), name)).collect()
        }
        let holds = self.hold.iter().map(|name| (format!("hold.{name}"), name)).collect();
        let symmetries = self.symmetry.iter().map(|name| (format!("symmetry.{name}"), name)).collect();
        [
            of("displacement", &self.displacement),
            symmetries,
            holds,
            of("motion", &self.motion),
            of("force", &self.force),
            of("pressure", &self.pressure),
            of("traction", &self.traction),
            of("body_force", &self.body_force),
            of("temperature", &self.temperature),
            of("spring", &self.spring),
            of("load", &self.load),
        ]
        .concat()
    }

    /// Whether the step ends a condition: the kind and the name that an earlier step gave.
    pub fn releases(&self, kind: &str, name: &str) -> bool {
        self.releases_path(&format!("{kind}.{name}"))
    }

    /// Whether the step holds a tool or group where it is.
    pub fn holds(&self, name: &str) -> bool {
        self.hold.iter().any(|held| held.text == name)
    }

    /// Whether a load on a tool or group ends with the step: it is released, held, or the tool is removed.
    pub fn ends_load(&self, name: &str) -> bool {
        let removes = self.remove.iter().any(|removed| removed.text == name);
        removes || self.holds(name) || self.releases("load", name)
    }

    /// Whether the step releases `kind.name`.
    pub fn releases_path(&self, path: &str) -> bool {
        self.release.iter().any(|released| released.text == path)
    }
}

/// Words on a release of nothing: the kind may be missing.
fn unknown_release(released: &Name, standing: &BTreeSet<String>, what: String) -> Diagnostic {
    let diagnostic = Diagnostic::error(what).at(released.place);
    if let Some(tool) = released.text.strip_prefix("motion.") {
        return diagnostic
            .help(format!("a tool that no step has moved stands still: load `{tool}` along what it is to follow"));
    }
    let meant = standing.iter().find(|c| c.split_once('.').is_some_and(|(_, name)| name == released.text));
    match meant {
        Some(meant) => diagnostic.label(format!("did you mean `{meant}`?")),
        None if standing.is_empty() => diagnostic.help("no step before this one says anything that lasts"),
        None => diagnostic.suggest(&released.text, standing.iter().map(String::as_str)),
    }
}

/// A tool cannot be moved and loaded along the same direction.
fn conflicts(step: &StepKeys, reader: &mut Reader) {
    follows(step, reader);
    let led = step.motion.iter().map(|(name, _)| name).chain(step.load.iter().map(|(name, _)| name));
    for name in led.filter(|name| step.holds(&name.text)) {
        let what = format!("`{}` both holds `{name}` and moves or loads it", reader.path());
        reader.report(Diagnostic::error(what).at(name.place).help("keep one of the two"));
    }
    for name in step.add.iter().filter(|name| step.remove.iter().any(|removed| removed.text == name.text)) {
        let what = format!("`{}` both removes and adds `{name}`", reader.path());
        reader
            .report(Diagnostic::error(what).at(name.place).help("keep one of the two, or give each a step of its own"));
    }
    for released in &step.release {
        let motion = ["hold.", "displacement.", "motion."].iter().find_map(|kind| released.text.strip_prefix(kind));
        if let Some(name) = motion.filter(|name| step.holds(name)) {
            let what = format!("`{}` both holds `{name}` and releases it", reader.path());
            let help = "keep one of the two: `hold` alone ends a motion where it is";
            reader.report(Diagnostic::error(what).at(released.place).help(help));
        }
    }
    for (tool, load) in &step.load {
        let Some((_, motion)) = step.motion.iter().find(|(name, _)| name.text == tool.text) else { continue };
        let keys = ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z", "x", "y", "rotation"];
        let both = |moved: &[Option<f64>], loaded: &[Option<f64>]| -> Vec<bool> {
            moved.iter().zip(loaded).map(|(moved, loaded)| moved.is_some() && loaded.is_some()).collect()
        };
        // x and y are in both lists; what they say is reported from the second.
        let space = both(&motion.space()[2..], &load.space()[2..]);
        let plane = both(&motion.plane(), &load.plane());
        for (key, conflict) in keys[2..].iter().zip(space.into_iter().chain(plane)) {
            if conflict {
                let what = format!("tool `{tool}` is both moved and loaded along `{key}` in `{}`", reader.path());
                reader.report(Diagnostic::error(what).at(tool.place).help("keep one of the two"));
            }
        }
    }
}

/// The list of all steps.
pub(super) fn steps() -> Steps {
    Steps
}

/// See [`steps`].
pub(super) struct Steps;

impl Form for Steps {
    type Value = Vec<StepKeys>;
    fn schema(&self) -> Schema {
        list(table_of::<StepKeys>(), 1..=usize::MAX).schema()
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Vec<StepKeys>> {
        let steps = list(table_of::<StepKeys>(), 1..=usize::MAX).read(node, reader)?;
        let before = reader.errors();
        persistence(&steps, reader);
        (reader.errors() == before).then_some(steps)
    }
}

/// Step names differ, and only what an earlier step said is released.
fn persistence(steps: &[StepKeys], reader: &mut Reader) {
    let mut names = BTreeSet::new();
    let mut standing: BTreeSet<String> = BTreeSet::new();
    for step in steps {
        if let Some(name) = step.name.as_ref().filter(|name| name.value.is_empty()) {
            let what = "a step needs a name that is not empty, or none";
            reader
                .report(Diagnostic::error(what).at(name.place).help("remove `name`; the step then goes by its number"));
        }
        if let Some(name) = step.name.as_ref().filter(|name| !names.insert(name.value.clone())) {
            let what = format!("two steps are called `{}`", name.value);
            reader.report(Diagnostic::error(what).at(name.place).help("give each its own name"));
        }
        for released in step.release.iter().filter(|released| !standing.contains(&released.text)) {
            let what = format!("no earlier step has a condition `{released}` to release");
            reader.report(unknown_release(released, &standing, what));
        }
        for released in &step.release {
            standing.remove(&released.text);
        }
        for (condition, name) in step.conditions() {
            if step.releases_path(&condition) {
                let what = format!("a step both says and releases `{condition}`");
                reader.report(Diagnostic::error(what).at(name.place).help("what is said anew need not be released"));
            }
            standing.insert(condition);
        }
    }
}
