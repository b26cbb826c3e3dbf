//! Every keyword that is known: what it says, its parameters, and what is done with it. Reader, checks and the manual's
//! table come from these declarations.

mod constraints;
mod other;
mod read;

use crate::read::Reader;
use crate::source::KeywordBlock;
use std::fmt::Write;

/// What is done with a keyword.
pub enum Treated {
    /// Nodes and elements: read before all others.
    Mesh(fn(&mut Reader, &KeywordBlock)),
    /// Read.
    Read(fn(&mut Reader, &KeywordBlock)),
    /// Read after all others, since it names what may stand below it.
    Late(fn(&mut Reader, &KeywordBlock)),
    /// Part of the structure of the deck itself.
    Structure,
    /// Left out, since the answer does not depend on it; why.
    Left(&'static str),
    /// Refused: what to do instead.
    Refused(&'static str),
}

/// Where a keyword may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Where {
    /// Before the first step.
    Model,
    /// Within a step.
    Step,
    /// Anywhere.
    Anywhere,
}

/// A parameter of a keyword.
#[derive(Debug, Clone, Copy)]
pub struct KeywordParameter {
    /// In capitals.
    pub name: &'static str,
    /// What is done with it.
    pub treated: ParameterUse,
}

/// What is done with a parameter.
#[derive(Debug, Clone, Copy)]
pub enum ParameterUse {
    /// Used, whatever its value.
    Used,
    /// One of these words, or nothing.
    OneOf(&'static [&'static str]),
    /// Left out; the answer does not depend on it.
    Left,
    /// Left out, with a note that says what it changes.
    Noted(&'static str),
    /// Refused: what to do instead.
    Refused(&'static str),
}

/// A keyword.
pub struct Keyword {
    /// In capitals.
    pub name: &'static str,
    /// Where it may stand.
    pub place: Where,
    /// What is done with it.
    pub treated: Treated,
    /// Its parameters.
    pub parameters: &'static [KeywordParameter],
    /// What becomes of it, for the manual.
    pub becomes: &'static str,
}

const fn used(name: &'static str) -> KeywordParameter {
    KeywordParameter { name, treated: ParameterUse::Used }
}

const fn one_of(name: &'static str, words: &'static [&'static str]) -> KeywordParameter {
    KeywordParameter { name, treated: ParameterUse::OneOf(words) }
}

const fn left(name: &'static str) -> KeywordParameter {
    KeywordParameter { name, treated: ParameterUse::Left }
}

const fn noted(name: &'static str, what: &'static str) -> KeywordParameter {
    KeywordParameter { name, treated: ParameterUse::Noted(what) }
}

const fn refused(name: &'static str, instead: &'static str) -> KeywordParameter {
    KeywordParameter { name, treated: ParameterUse::Refused(instead) }
}

const fn of_model(
    name: &'static str,
    read: fn(&mut Reader, &KeywordBlock),
    parameters: &'static [KeywordParameter],
    becomes: &'static str,
) -> Keyword {
    Keyword { name, place: Where::Model, treated: Treated::Read(read), parameters, becomes }
}

const fn late(
    name: &'static str,
    read: fn(&mut Reader, &KeywordBlock),
    parameters: &'static [KeywordParameter],
    becomes: &'static str,
) -> Keyword {
    Keyword { name, place: Where::Model, treated: Treated::Late(read), parameters, becomes }
}

const fn of_step(
    name: &'static str,
    read: fn(&mut Reader, &KeywordBlock),
    parameters: &'static [KeywordParameter],
    becomes: &'static str,
) -> Keyword {
    Keyword { name, place: Where::Step, treated: Treated::Read(read), parameters, becomes }
}

const fn structure(name: &'static str, parameters: &'static [KeywordParameter], becomes: &'static str) -> Keyword {
    Keyword { name, place: Where::Model, treated: Treated::Structure, parameters, becomes }
}

const fn without_effect(name: &'static str, why: &'static str) -> Keyword {
    Keyword { name, place: Where::Anywhere, treated: Treated::Left(why), parameters: &[], becomes: "" }
}

const fn no(name: &'static str, instead: &'static str) -> Keyword {
    Keyword { name, place: Where::Anywhere, treated: Treated::Refused(instead), parameters: &[], becomes: "" }
}

/// Parameters without a value that may stand on a line of their own.
pub const FLAGS: [&str; 4] = ["GENERATE", "INTERNAL", "UNSORTED", "NLGEOM"];

/// All keywords, in the order of the manual.
pub fn all() -> impl Iterator<Item = &'static Keyword> {
    read::READ.iter().chain(constraints::CONSTRAINTS).chain(other::OTHER)
}

/// The keyword of a name in capitals; blanks do not count.
pub fn named(name: &str) -> Option<&'static Keyword> {
    all().find(|keyword| same(keyword.name, name))
}

/// Whether two names are the same but for blanks.
pub fn same(one: &str, other: &str) -> bool {
    let letters = |name: &'_ str| name.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    one == other || letters(one) == letters(other)
}

/// The manual's page, in Markdown.
pub fn manual() -> String {
    let mut text = String::from(
        "# Keywords of input decks\n\nPrinted by `asperity schema --keywords`. What is not in these tables is an error that names the \
         nearest keyword.\n\n## Read\n\n| keyword | becomes | parameters |\n|---|---|---|\n",
    );
    for keyword in all() {
        if matches!(keyword.treated, Treated::Mesh(_) | Treated::Read(_) | Treated::Late(_) | Treated::Structure) {
            let parameters: Vec<String> = keyword.parameters.iter().filter_map(described).collect();
            let _ = writeln!(text, "| `*{}` | {} | {} |", keyword.name, keyword.becomes, parameters.join(", "));
        }
    }
    text += "\n## Left out, with a note\n\n| keyword | why |\n|---|---|\n";
    for keyword in all() {
        if let Treated::Left(why) = keyword.treated {
            let _ = writeln!(text, "| `*{}` | {why} |", keyword.name);
        }
        for parameter in keyword.parameters {
            if let ParameterUse::Noted(what) = parameter.treated {
                let _ = writeln!(text, "| `*{}, {}` | {what} |", keyword.name, parameter.name);
            }
        }
    }
    text += "\n## Refused\n\n| keyword | what to do |\n|---|---|\n";
    for keyword in all() {
        if let Treated::Refused(instead) = keyword.treated {
            let _ = writeln!(text, "| `*{}` | {instead} |", keyword.name);
        }
        for parameter in keyword.parameters {
            if let ParameterUse::Refused(instead) = parameter.treated {
                let _ = writeln!(text, "| `*{}, {}` | {instead} |", keyword.name, parameter.name);
            }
        }
    }
    text
}

/// A parameter that is used, with the words that it may have.
fn described(parameter: &KeywordParameter) -> Option<String> {
    match parameter.treated {
        ParameterUse::Used => Some(parameter.name.to_string()),
        ParameterUse::OneOf(words) => {
            let words: Vec<&str> = words.iter().copied().filter(|word| !word.is_empty()).collect();
            Some(format!("{} ({})", parameter.name, words.join(", ")))
        }
        ParameterUse::Left | ParameterUse::Noted(_) | ParameterUse::Refused(_) => None,
    }
}
