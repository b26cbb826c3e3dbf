//! The mesh of Abaqus and CalculiX input files.
//!
//! `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`, `*SURFACE` and `*INCLUDE` are read, as the Abaqus keywords reference and the
//! CalculiX manual describe them. Sets and surfaces become groups of the mesh; a set of nodes and a set of elements of
//! one name become one group. Keywords that would change the mesh if they were passed over are refused, all others
//! are listed in a note.

mod cells;
mod elements;
mod keywords;
mod lexer;
mod sets;
mod surfaces;

use super::Note;
use super::draft::Draft;
use crate::error::Error;
use crate::files;
use crate::mesh::Mesh;
use elements::Elements;
use lexer::{Keyword, Statement, Statements};
use sets::Sets;
use std::path::{Path, PathBuf};
use surfaces::Surface;

/// More included files than this are taken for files that include one another without end.
const MOST_FILES: usize = 1000;

/// A line of one of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    file: usize,
    line: usize,
}

/// A file that is being read, with those it includes.
struct Reader {
    draft: Draft,
    /// Names of the files for messages.
    files: Vec<String>,
    /// Files that are open, the innermost last.
    open: Vec<PathBuf>,
    block: Block,
    elements: Elements,
    node_sets: Sets,
    element_sets: Sets,
    surfaces: Vec<Surface>,
    /// Keywords that were passed over, with their first place.
    ignored: Vec<(String, Place)>,
}

/// The keyword that the data lines belong to.
enum Block {
    /// None yet.
    Nothing,
    /// One that is passed over.
    Ignored,
    Nodes {
        set: Option<String>,
    },
    Elements {
        found: &'static cells::Type,
        set: Option<String>,
    },
    Set {
        of: Of,
        name: String,
        generate: bool,
    },
    Surface,
}

/// What a set is of.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Of {
    Nodes,
    Elements,
}

/// Reads a file's content.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<(Mesh, Vec<Note>), Error> {
    let mut reader = Reader {
        draft: Draft::new(path.display().to_string()),
        files: vec![],
        open: vec![],
        block: Block::Nothing,
        elements: Elements::default(),
        node_sets: Sets::default(),
        element_sets: Sets::default(),
        surfaces: vec![],
        ignored: vec![],
    };
    reader.file(path, bytes)?;
    reader.end_block()?;
    reader.note_ignored();
    reader.fill_draft()?;
    reader.draft.finish()
}

impl Reader {
    fn error(&self, place: Place, what: impl std::fmt::Display) -> Error {
        Error::input(format!("{}:{}: {what}", self.files[place.file], place.line))
    }

    fn note(&mut self, place: Place, text: String) {
        let file = self.files[place.file].clone();
        self.draft.notes.push(Note { file, line: Some(place.line), text });
    }

    /// All statements of a file.
    fn file(&mut self, path: &Path, bytes: &[u8]) -> Result<(), Error> {
        let file = self.files.len();
        self.files.push(path.display().to_string());
        self.open.push(path.to_path_buf());
        let text = String::from_utf8_lossy(bytes);
        for (line, statement) in Statements::of(&text) {
            let place = Place { file, line };
            match statement {
                Statement::Keyword(keyword) => self.keyword(&keyword, place)?,
                Statement::Data(data) => self.data(data, place)?,
            }
        }
        self.open.pop();
        Ok(())
    }

    /// The file of an `INPUT` parameter, which stands beside the file that names it.
    fn include(&mut self, keyword: &Keyword, place: Place) -> Result<(), Error> {
        let Some(name) = keyword.value("INPUT") else {
            return Err(self.error(place, "*INCLUDE names no file; write *INCLUDE, INPUT=file"));
        };
        let folder = self.open.last().and_then(|path| path.parent()).unwrap_or(Path::new(""));
        let path = folder.join(name);
        let same = |open: &PathBuf| match (open.canonicalize(), path.canonicalize()) {
            (Ok(open), Ok(path)) => open == path,
            _ => *open == path,
        };
        if self.open.iter().any(same) {
            return Err(self.error(place, format!("'{name}' includes itself; take the *INCLUDE out of the circle")));
        }
        if self.files.len() >= MOST_FILES {
            return Err(self.error(place, format!("more than {MOST_FILES} files are included; join some of them")));
        }
        let bytes = files::read(&path).map_err(|error| {
            let reason = match error {
                Error::File { reason, .. } => reason,
                other => other.to_string(),
            };
            let path = path.display();
            self.error(place, format!("'{path}' cannot be read ({reason}); paths count from the including file"))
        })?;
        self.file(&path, &bytes)
    }

    fn keyword(&mut self, keyword: &Keyword, place: Place) -> Result<(), Error> {
        if keyword.name == "INCLUDE" {
            return self.include(keyword, place);
        }
        self.end_block()?;
        self.block = self.opened(keyword, place)?;
        if keyword.value("INPUT").is_some() && !matches!(self.block, Block::Ignored) {
            self.include(keyword, place)?;
        }
        Ok(())
    }

    fn opened(&mut self, keyword: &Keyword, place: Place) -> Result<Block, Error> {
        match keyword.name.as_str() {
            "NODE" => self.open_nodes(keyword, place),
            "ELEMENT" => self.open_elements(keyword, place),
            "NSET" => self.open_set(keyword, Of::Nodes, place),
            "ELSET" => self.open_set(keyword, Of::Elements, place),
            "SURFACE" => self.open_surface(keyword, place),
            name => {
                keywords::refuse(name).map_err(|what| self.error(place, what))?;
                if !keywords::SILENT.contains(&name) && !self.ignored.iter().any(|known| known.0 == name) {
                    self.ignored.push((name.to_string(), place));
                }
                Ok(Block::Ignored)
            }
        }
    }

    fn data(&mut self, data: &str, place: Place) -> Result<(), Error> {
        match std::mem::replace(&mut self.block, Block::Ignored) {
            Block::Nothing => {
                return Err(self.error(place, "data without a keyword before it; an input file begins with a *KEYWORD"));
            }
            Block::Ignored => {}
            Block::Nodes { set } => {
                self.node(data, set.as_deref(), place)?;
                self.block = Block::Nodes { set };
            }
            Block::Elements { found, set } => {
                self.element(data, found, set.as_deref(), place)?;
                self.block = Block::Elements { found, set };
            }
            Block::Set { of, name, generate } => {
                self.set_line(data, (of, &name, generate), place)?;
                self.block = Block::Set { of, name, generate };
            }
            Block::Surface => {
                self.surface_line(data, place)?;
                self.block = Block::Surface;
            }
        }
        Ok(())
    }

    /// Nothing may be left open when a block ends.
    fn end_block(&mut self) -> Result<(), Error> {
        match self.elements.unfinished() {
            Some((place, what)) => Err(self.error(place, what)),
            None => Ok(()),
        }
    }

    fn note_ignored(&mut self) {
        let ignored = std::mem::take(&mut self.ignored);
        let Some((_, place)) = ignored.first() else { return };
        let listed: Vec<String> = ignored.iter().map(|(name, place)| format!("*{name} ({})", place.line)).collect();
        let text = format!("keywords that are no part of the mesh are not used (with lines): {}", listed.join(", "));
        self.note(*place, text);
    }

    /// Parameters of a keyword that have no meaning here are named.
    fn note_parameters(&mut self, keyword: &Keyword, known: &[&str], place: Place) {
        let unknown = keyword.parameters.iter().map(|parameter| parameter.0.as_str());
        let unknown: Vec<&str> = unknown.filter(|name| !known.contains(name)).collect();
        if !unknown.is_empty() {
            self.note(place, format!("*{}: {} not used", keyword.name, unknown.join(", ")));
        }
    }
}
