//! Walks a tree by the declared forms and gathers what is wrong with it, all at once.

use super::diagnose::{Diagnostic, Severity};
use super::schema::Names;
use super::source::{Place, SourceText};
use super::tree::{Node, TreeEntry, Value};

/// What a reading leaves besides the values.
#[derive(Debug, Default)]
pub struct Reader {
    /// The texts that places point into: first the deck's file, then each `--set`, then what else was read.
    pub sources: Vec<SourceText>,
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
    /// What was not said, and what holds instead.
    pub unsaid: Vec<Unsaid>,
    /// Every name that was given or referred to.
    pub mentions: Vec<Mention>,
    path: Vec<String>,
}

/// A key that was not said.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unsaid {
    /// Its path: `contact.bore.gauss`.
    pub path: String,
    /// What holds instead.
    pub instead: String,
}

/// A name in the deck.
#[derive(Debug, Clone, PartialEq)]
pub struct Mention {
    /// What it names.
    pub names: Names,
    /// The name.
    pub name: Name,
    /// Whether it is given here, not referred to.
    pub defines: bool,
}

/// A name and where it was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Name {
    /// The name.
    pub text: String,
    /// Where.
    pub place: Place,
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

/// A key as a deck must write it.
fn quoted(key: String) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { key } else { format!("{key:?}") }
}

impl Reader {
    /// A reader of a deck's text.
    pub fn new(deck: SourceText) -> Self {
        Self { sources: vec![deck], ..Self::default() }
    }

    /// The path of what is being read: `step.1.displacement.far_end.y`.
    pub fn path(&self) -> String {
        self.path.join(".")
    }

    /// Reads something under one more key.
    pub fn under<T>(&mut self, key: impl Into<String>, read: impl FnOnce(&mut Self) -> T) -> T {
        self.path.push(quoted(key.into()));
        let value = read(self);
        self.path.pop();
        value
    }

    /// Adds a message.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Reports that the value being read `must` be something else.
    pub fn refuse<T>(&mut self, place: Place, must: &str, found: &str) -> Option<T> {
        let what = format!("`{}` must be {must}, not {found}", self.path());
        self.report(Diagnostic::error(what).at(place));
        None
    }

    /// How many errors there are so far.
    pub fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Error).count()
    }

    /// Notes that the key being read was not said, and what holds instead; of a table its keys say that themselves.
    pub fn leave_unsaid(&mut self, instead: &str) {
        if !matches!(instead, "{}" | "[]") {
            self.unsaid.push(Unsaid { path: self.path(), instead: instead.to_owned() });
        }
    }

    /// Notes a name.
    pub fn mention(&mut self, names: Names, name: Name, defines: bool) {
        self.mentions.push(Mention { names, name, defines });
    }

    /// The entries of a table, or a message that it is none.
    pub fn table<'n>(&mut self, node: &'n Node) -> Option<&'n [TreeEntry]> {
        match &node.value {
            Value::Table(entries) => Some(entries),
            Value::List(items) if items.iter().any(|item| matches!(item.value, Value::Table(_))) => {
                let what = format!("`{}` must be one table, not a list of tables", self.path());
                self.report(Diagnostic::error(what).at(node.place).help(format!("write [{}]", self.path())));
                None
            }
            other => self.refuse(node.place, "a table", other.kind()),
        }
    }
}
