//! From blocks to the model: structure first, then nodes and elements, then everything else in its order.

mod assembly;
mod contacts;
mod couplings;
mod equations;
mod materials;
mod mesh;
mod names;
mod outputs;
mod rigid;
mod steps;
mod systems;

use crate::elements::Dialect;
use crate::keywords::{self, ParameterUse, Treated, Where};
use crate::message::{InputPlace, Messages, suggestion};
use crate::model::{Model, Step};
use crate::source::{DataLine, KeywordBlock};

pub use outputs::PLASTIC;
pub use systems::along;

/// What reads the blocks.
pub struct Reader {
    model: Model,
    messages: Messages,
    /// The instance whose blocks are read, 0 for the assembly.
    scope: usize,
    /// What the blocks below `*MATERIAL`, `*SURFACE INTERACTION` and `*STEP` belong to.
    material: Option<usize>,
    interaction: Option<usize>,
    /// The interaction of the `*CHANGE FRICTION` whose `*FRICTION` is still to come, and where that stands.
    changing: Option<(usize, InputPlace)>,
    step: Option<usize>,
    /// Where the `*COUPLING` stands whose kind is still to be said.
    coupling: Option<InputPlace>,
    /// Whether that has axes of its own.
    oriented: bool,
}

/// The model that blocks say.
pub fn model(blocks: &[KeywordBlock], messages: &mut Messages) -> Model {
    let mut reader = Reader {
        model: Model::default(),
        messages: std::mem::take(messages),
        scope: 0,
        material: None,
        interaction: None,
        changing: None,
        step: None,
        coupling: None,
        oriented: false,
    };
    reader.model.dialect = dialect(blocks);
    let laid_out = reader.lay_out(blocks);
    for (scope, block) in &laid_out {
        reader.scope = *scope;
        if let Some(Treated::Mesh(read)) = reader.known(block) {
            read(&mut reader, block);
        }
    }
    for (scope, block) in &laid_out {
        reader.scope = *scope;
        if let Some(Treated::Read(read)) = keywords::named(&block.name).map(|keyword| &keyword.treated) {
            read(&mut reader, block);
        }
    }
    for (scope, block) in &laid_out {
        reader.scope = *scope;
        if let Some(Treated::Late(read)) = keywords::named(&block.name).map(|keyword| &keyword.treated) {
            read(&mut reader, block);
        }
    }
    reader.end_coupling();
    reader.end_couplings();
    reader.end_change();
    reader.finish(blocks);
    blocks.iter().for_each(|block| reader.all_read(block));
    *messages = reader.messages;
    reader.model
}

/// Whose deck it is: Abaqus' where it has what CalculiX has not, parts, analytical surfaces, rigid elements.
fn dialect(blocks: &[KeywordBlock]) -> Dialect {
    let foreign = |block: &KeywordBlock| match block.name.as_str() {
        "PART" | "ASSEMBLY" | "INSTANCE" | "PREPRINT" => true,
        "SURFACE" => matches!(block.word("TYPE").as_deref(), Some("SEGMENTS" | "CYLINDER" | "REVOLUTION")),
        "ELEMENT" => block.word("TYPE").is_some_and(|name| name.starts_with('R')),
        _ => false,
    };
    if blocks.iter().any(foreign) { Dialect::Abaqus } else { Dialect::CalculiX }
}

impl Reader {
    fn error(&mut self, place: InputPlace, text: impl Into<String>) {
        self.messages.error(place, text);
    }

    fn note(&mut self, place: InputPlace, text: impl Into<String>) {
        self.messages.note(place, text);
    }

    /// What is done with a block; its keyword and parameters are checked against their declarations.
    fn known(&mut self, block: &KeywordBlock) -> Option<&'static Treated> {
        let Some(keyword) = keywords::named(&block.name) else {
            let near = suggestion(&block.name, keywords::all().map(|keyword| keyword.name));
            self.error(block.place, format!("there is no keyword *{}{near}", block.name));
            return None;
        };
        match keyword.treated {
            Treated::Refused(instead) => {
                self.error(block.place, format!("*{} cannot be translated; {instead}", block.name));
            }
            Treated::Left(why) => self.note(block.place, format!("*{} left out: {why}", block.name)),
            _ => self.check_parameters(block, keyword),
        }
        Some(&keyword.treated)
    }

    fn check_parameters(&mut self, block: &KeywordBlock, keyword: &keywords::Keyword) {
        for (name, value) in &block.parameters {
            let Some(parameter) = keyword.parameters.iter().find(|parameter| parameter.name == name) else {
                let near = suggestion(name, keyword.parameters.iter().map(|parameter| parameter.name));
                self.error(block.place, format!("*{} has no parameter {name} here{near}", block.name));
                continue;
            };
            match parameter.treated {
                ParameterUse::OneOf(words) => {
                    let word = block.word(name).unwrap_or_default();
                    if !words.iter().any(|known| keywords::same(known, &word)) {
                        let words: Vec<&str> = words.iter().copied().filter(|word| !word.is_empty()).collect();
                        let what = format!(
                            "*{}: {name}={value} cannot be translated; {name} may be {}",
                            block.name,
                            words.join(", ")
                        );
                        self.error(block.place, what);
                    }
                }
                ParameterUse::Noted(what) => {
                    self.note(block.place, format!("*{}, {name} left out: {what}", block.name))
                }
                ParameterUse::Refused(instead) => {
                    self.error(block.place, format!("*{}, {name} cannot be translated; {instead}", block.name));
                }
                ParameterUse::Used | ParameterUse::Left => {}
            }
        }
    }

    /// Whether the blocks stand where they may, and whether the deck is whole.
    fn finish(&mut self, blocks: &[KeywordBlock]) {
        let (mut within, mut changes) = (false, false);
        for block in blocks {
            // What stands below a keyword of change is refused with it.
            let changed = std::mem::replace(&mut changes, block.name.starts_with("CHANGE "));
            match block.name.as_str() {
                "STEP" if within => {
                    self.error(block.place, "a step begins within a step; end the one before with *END STEP");
                }
                "STEP" => within = true,
                "END STEP" => within = false,
                name => {
                    let place = keywords::named(name).map(|keyword| keyword.place);
                    if place == Some(Where::Model) && within && !changed {
                        self.error(block.place, format!("*{name} stands within a step; put it before the first *STEP"));
                    } else if place == Some(Where::Step) && !within {
                        self.error(block.place, format!("*{name} stands outside a step; put it after *STEP"));
                    }
                }
            }
        }
        let last = blocks.last().map_or(InputPlace { file: 0, line: 1 }, |block| block.place);
        if within {
            self.error(last, "the deck ends within a step; end it with *END STEP");
        } else if self.model.steps.is_empty() && !(blocks.is_empty() && self.messages.has_errors()) {
            self.error(last, "the deck has no *STEP, so that there is nothing to solve");
        }
        let idle: Vec<(InputPlace, String)> = self
            .model
            .steps
            .iter()
            .filter(|step| !step.procedure)
            .map(|step: &Step| (step.place, step.name.clone()))
            .collect();
        for (place, name) in idle {
            self.error(place, format!("step '{name}' has no procedure; write *STATIC below its *STEP"));
        }
    }

    /// Whether all that stands below a keyword was read.
    fn all_read(&mut self, block: &KeywordBlock) {
        // What names elements of an unknown type is not read to its end.
        let unknown = self.model.scopes.iter().any(|scope| !scope.unknown.is_empty());
        if unknown || self.messages.has_error_at(block.place) {
            return;
        }
        // What an error hides was not read either.
        let whole = block.lines.iter().any(DataLine::is_read) && !self.messages.has_errors();
        for line in &block.lines {
            if let Some((at, field)) = line.unread().filter(|_| !self.messages.has_error_at(line.place)) {
                let what = format!("*{} does not read field {}, '{}'; take it out", block.name, at + 1, shorten(field));
                self.error(line.place, what);
            } else if whole && !line.is_read() {
                self.error(line.place, format!("*{} does not read this line; take it out", block.name));
            }
        }
    }

    /// A field as a number; none is an error.
    fn real(&mut self, line: &DataLine, at: usize, what: &str) -> Option<f64> {
        match line.field(at) {
            "" => {
                self.error(line.place, format!("{what} is missing; it is field {} of the line", at + 1));
                None
            }
            field => self.number(line.place, field, what),
        }
    }

    /// A field as a number, with a value for an empty one.
    fn real_or(&mut self, line: &DataLine, at: usize, what: &str, otherwise: f64) -> Option<f64> {
        match line.field(at) {
            "" => Some(otherwise),
            field => self.number(line.place, field, what),
        }
    }

    fn number(&mut self, place: InputPlace, field: &str, what: &str) -> Option<f64> {
        let number: Result<f64, _> = field.parse().or_else(|_| field.replace(['d', 'D'], "e").parse());
        match number {
            Ok(number) if number.is_finite() => Some(number),
            Ok(_) => {
                self.error(place, format!("{what} is '{}', which is not finite", shorten(field)));
                None
            }
            Err(_) => {
                self.error(place, format!("{what} is '{}', which is not a number", shorten(field)));
                None
            }
        }
    }

    /// A positive number.
    fn positive(&mut self, line: &DataLine, at: usize, what: &str) -> Option<f64> {
        let number = self.real(line, at, what)?;
        if number > 0.0 {
            return Some(number);
        }
        self.error(line.place, format!("{what} is {number}; it must be positive"));
        None
    }

    /// The first line of a block; none is an error.
    fn first_line<'b>(&mut self, block: &'b KeywordBlock, what: &str) -> Option<&'b DataLine> {
        if block.lines.is_empty() {
            self.error(block.place, format!("*{} has no data; give {what} on the line below", block.name));
        }
        block.lines.first()
    }

    /// The value of a parameter that must be there.
    fn required<'b>(&mut self, block: &'b KeywordBlock, name: &str) -> Option<&'b str> {
        if block.value(name).is_none() {
            self.error(block.place, format!("*{} names no {name}; write *{0}, {name}=...", block.name));
        }
        block.value(name)
    }

    /// `*HEADING`.
    pub(crate) fn heading(&mut self, block: &KeywordBlock) {
        let clean = |line: &DataLine| line.text().chars().filter(|c| !c.is_control()).collect::<String>();
        self.model.title = block.lines.first().map(clean).unwrap_or_default();
    }
}

/// A field short enough for a message.
fn shorten(field: &str) -> String {
    match field.char_indices().nth(24) {
        Some((end, _)) => format!("{}...", &field[..end]),
        None => field.to_string(),
    }
}
