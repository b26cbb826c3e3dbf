//! Messages about a deck: what is wrong, the line with its caret, the nearest valid name and what to do.

use super::source::{Place, SourceText};
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use asperity_core::error::visible;

/// How much a message weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The deck cannot be run.
    Error,
    /// It can, but look here first.
    Warning,
    /// Worth knowing.
    Note,
}

/// One message.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// How much it weighs.
    pub severity: Severity,
    /// What is the matter, in one line.
    pub what: String,
    /// Where, if it has a place.
    pub place: Option<Place>,
    /// What stands beside the caret.
    pub label: String,
    /// What to do, a line each.
    pub help: Vec<String>,
    /// Whether a run tells it too, though it is a note.
    pub changes: bool,
}

impl Diagnostic {
    /// An error.
    pub fn error(what: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            what: what.into(),
            place: None,
            label: String::new(),
            help: Vec::new(),
            changes: false,
        }
    }
    /// A warning.
    pub fn warning(what: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(what) }
    }
    /// A note.
    pub fn note(what: impl Into<String>) -> Self {
        Self { severity: Severity::Note, ..Self::error(what) }
    }
    /// A note on what was made otherwise than the deck has it, which a run tells too.
    pub fn change(what: impl Into<String>) -> Self {
        Self { changes: true, ..Self::note(what) }
    }
    /// Points at a place.
    pub fn at(self, place: Place) -> Self {
        Self { place: Some(place), ..self }
    }
    /// Puts words beside the caret.
    pub fn label(self, label: impl Into<String>) -> Self {
        Self { label: label.into(), ..self }
    }
    /// Adds a line that says what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }
    /// Offers the nearest valid name, or, where nothing is near, all of them.
    pub fn suggest<'a>(self, name: &str, valid: impl IntoIterator<Item = &'a str>) -> Self {
        let valid: Vec<&str> = valid.into_iter().collect();
        match asperity_core::declare::nearest(name, valid.iter().copied()) {
            Some(near) => self.label(format!("did you mean `{near}`?")),
            None if valid.is_empty() => self,
            None => self.help(format!("valid here: {}", enumerate(&valid))),
        }
    }
}

/// The first names of a list, then how many more there are.
fn enumerate(names: &[&str]) -> String {
    const SHOWN: usize = 24;
    let mut text = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN {
        text += &format!(" and {} more", names.len() - SHOWN);
    }
    text
}

/// All messages about one deck, with the texts they point into.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Diagnostics {
    /// The texts: first the deck's file, then each `--set`, then what else was read.
    pub sources: Vec<SourceText>,
    /// The messages.
    pub list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Whether anything forbids a run.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }

    /// Only what must be put right or looked at: beside errors, notes are noise.
    pub fn without_notes(mut self) -> Self {
        self.list.retain(|d| d.severity != Severity::Note);
        self
    }

    /// Orders the messages as a reader of the deck meets them; those without a place come last.
    pub fn sort(&mut self) {
        self.list.sort_by_key(|d| d.place.map_or((usize::MAX, 0), |p| (p.source, p.start)));
    }

    /// The messages as text, in colour if asked for.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let renderer = renderer.decor_style(DecorStyle::Ascii);
        let shown = self.shown();
        let one = |diagnostic: &Diagnostic| renderer.render(&[shown.group(diagnostic)]);
        shown.list.iter().map(one).collect::<Vec<_>>().join("\n\n")
    }

    /// The same without what would steer a terminal, of the same lengths, so that places still point where they did.
    fn shown(&self) -> Self {
        let text = |text: &str| visible(text).into_owned();
        let source = |s: &SourceText| SourceText { name: text(&s.name), text: text(&s.text), first_line: s.first_line };
        let message = |d: &Diagnostic| Diagnostic {
            what: text(&d.what),
            label: text(&d.label),
            help: d.help.iter().map(|help| text(help)).collect(),
            ..d.clone()
        };
        Self { sources: self.sources.iter().map(source).collect(), list: self.list.iter().map(message).collect() }
    }

    fn group<'a>(&'a self, diagnostic: &'a Diagnostic) -> Group<'a> {
        let level = match diagnostic.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let title = level.primary_title(diagnostic.what.as_str());
        let helps = diagnostic.help.iter().map(|help| Level::HELP.message(help.as_str()));
        match diagnostic.place.and_then(|place| self.snippet(place, &diagnostic.label)) {
            Some(snippet) => title.element(snippet).elements(helps),
            None => title.elements(helps),
        }
    }

    fn snippet<'a>(&'a self, place: Place, label: &'a str) -> Option<Snippet<'a, annotate_snippets::Annotation<'a>>> {
        let source = self.sources.get(place.source)?;
        let end = source.text.len();
        let mark = AnnotationKind::Primary.span(place.start.min(end)..place.end.clamp(place.start, end));
        let mark = if label.is_empty() { mark } else { mark.label(label) };
        Some(
            Snippet::source(source.text.as_str())
                .path(source.name.as_str())
                .line_start(source.first_line)
                .annotation(mark),
        )
    }
}
