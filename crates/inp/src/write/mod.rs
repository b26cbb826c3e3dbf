//! From the model to a deck of ours and its mesh.

mod adjust;
mod bodies;
mod conditions;
mod contacts;
mod courses;
mod equations;
mod groups;
mod loads;
mod outputs;
mod rubber;
mod steps;
mod supports;
mod temperatures;
mod tools;
mod turned;

use crate::elements::Family;
use crate::message::{InputPlace, Messages};
use crate::model::Model;
use groups::Groups;
use std::collections::{BTreeMap, BTreeSet};
use tools::Tool;

/// A deck and its mesh.
pub struct Written {
    /// In TOML.
    pub deck: String,
    /// In the format of CalculiX.
    pub mesh: String,
}

/// What writes the deck.
struct Writer<'m> {
    model: &'m Model,
    messages: &'m mut Messages,
    groups: Groups,
    family: Family,
    /// The section of each element, if it has one.
    section: Vec<Option<usize>>,
    /// Whether each node belongs to an element with a section or stands in an equation.
    used: Vec<bool>,
    tools: Vec<Tool>,
    /// Directions along which nodes with axes of their own are led.
    directions: Vec<[f64; 3]>,
    /// Groups of axisymmetric models that are rigid, which hold their radius.
    rings: Vec<(String, InputPlace)>,
    /// New places of nodes that are moved onto a surface.
    moved: BTreeMap<usize, [f64; 3]>,
    /// Nodes and axes, those of the node's `*TRANSFORM`, that are held or led in each step.
    held: Vec<BTreeSet<(usize, usize)>>,
    /// The path of a library with laws of users.
    library: &'m str,
    text: String,
}

/// The deck and the mesh of a model; `name` is that of the input deck, `library` the path of the laws of users.
pub fn deck<'m>(
    model: &'m Model,
    name: &str,
    (mesh_file, library): (&str, &'m str),
    messages: &'m mut Messages,
) -> Written {
    let mut writer = Writer {
        model,
        messages,
        groups: Groups::default(),
        family: Family::Solid,
        section: vec![],
        used: vec![],
        tools: vec![],
        directions: vec![],
        rings: vec![],
        moved: BTreeMap::new(),
        held: vec![],
        library,
        text: String::new(),
    };
    writer.sort_elements();
    writer.materials();
    writer.bodies();
    writer.tools();
    writer.contacts();
    writer.equations();
    writer.ties();
    writer.steps();
    writer.outputs();
    writer.named_sets();
    let mesh = writer.groups.mesh(model, &writer.section, (&writer.used, &writer.moved));
    let title = if model.title.is_empty() { name } else { &model.title };
    let mut deck = format!("# Translated from {name}, read as a deck of {:?}.\n", model.dialect);
    let notes = writer.messages.notes();
    if !notes.is_empty() {
        deck += "#\n# What was left out or became something else:\n";
        deck.extend(notes.iter().map(|note| format!("#   {}\n", visible(note))));
    }
    deck += &format!("\nversion = 1\ntitle = {}\nspace = {}\n", quoted(title), quoted(writer.family.space()));
    if let Some(thickness) = writer.thickness() {
        deck += &format!("thickness = {thickness:?}\n");
    }
    deck += &format!("mesh.file = {}\n", quoted(mesh_file));
    Written { deck: deck + &writer.text, mesh }
}

impl Writer<'_> {
    fn error(&mut self, place: InputPlace, text: impl Into<String>) {
        self.messages.error(place, text);
    }

    fn note(&mut self, place: InputPlace, text: impl Into<String>) {
        self.messages.note(place, text);
    }

    /// A comment that names the place of what is written.
    fn from(&self, place: InputPlace) -> String {
        format!("  # {}", visible(&self.messages.at(place)))
    }

    /// How many axes there are.
    fn dimension(&self) -> usize {
        if self.family == Family::Solid { 3 } else { 2 }
    }

    /// Sets that the user named keep their names in the mesh, needed or not.
    fn named_sets(&mut self) {
        let model = self.model;
        for scope in &model.scopes {
            for set in scope.node_sets.values().filter(|set| !set.internal) {
                self.groups.nodes(&set.name, set.members.clone());
            }
            for set in scope.element_sets.values().filter(|set| !set.internal) {
                self.groups.cells(&set.name, set.members.clone());
            }
        }
    }
}

/// A text in quotes, as TOML wants it.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars().filter(|c| !c.is_control()) {
        if matches!(c, '"' | '\\') {
            quoted.push('\\');
        }
        quoted.push(c);
    }
    quoted + "\""
}

/// A text without what would end a comment.
fn visible(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect()
}

/// Numbers with their commas: `[1.0, 2.0]`.
fn list(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
    format!("[{}]", numbers.join(", "))
}
