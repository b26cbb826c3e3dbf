//! A file and those it includes, cut into blocks: a keyword line with its parameters, and the data lines below it.

use crate::keywords;
use crate::message::{InputPlace, Messages};
use std::cell::Cell;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// More included files than this are taken for files that include one another without end.
const MOST_FILES: usize = 1000;

/// A line of data.
#[derive(Debug, Clone)]
pub struct DataLine {
    /// Where it stands.
    pub place: InputPlace,
    text: Rc<str>,
    range: Range<usize>,
    /// How many of its fields were read.
    read: Cell<usize>,
}

impl DataLine {
    /// A field, trimmed, without quotes; empty where the line ends before it.
    pub fn field(&self, at: usize) -> &str {
        self.read.set(self.read.get().max(at + 1));
        self.split().nth(at).unwrap_or("")
    }

    /// The first field that is not empty and was not read, where others of the line were.
    pub fn unread(&self) -> Option<(usize, &str)> {
        let read = self.read.get();
        self.split().enumerate().skip(read).find(|(_, field)| read > 0 && !field.is_empty())
    }

    /// Whether any of its fields was read.
    pub fn is_read(&self) -> bool {
        self.read.get() > 0
    }

    /// The fields between its commas, trimmed, without quotes; a comma at its end adds none.
    pub fn fields(&self) -> Vec<&str> {
        self.read.set(usize::MAX);
        self.split().collect()
    }

    fn split(&self) -> impl Iterator<Item = &str> {
        let text = self.text();
        text.strip_suffix(',').unwrap_or(text).split(',').map(|field| field.trim().trim_matches('"'))
    }

    /// The whole line.
    pub fn text(&self) -> &str {
        self.text[self.range.clone()].trim()
    }
}

/// A keyword, its parameters and its data.
#[derive(Debug, Clone)]
pub struct KeywordBlock {
    /// In capitals without the star, words with one blank between them.
    pub name: String,
    /// Names in capitals with their values; a flag has an empty one.
    pub parameters: Vec<(String, String)>,
    /// Where the keyword stands.
    pub place: InputPlace,
    /// The lines of data.
    pub lines: Vec<DataLine>,
}

impl KeywordBlock {
    /// The value of a parameter, if it is there and not empty.
    pub fn value(&self, name: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|parameter| parameter.0 == name);
        found.map(|parameter| parameter.1.as_str()).filter(|value| !value.is_empty())
    }

    /// The value of a parameter in capitals without blanks.
    pub fn word(&self, name: &str) -> Option<String> {
        self.value(name).map(|value| value.split_whitespace().collect::<String>().to_ascii_uppercase())
    }

    /// Whether a parameter is there, with or without a value.
    pub fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|parameter| parameter.0 == name)
    }
}

/// The blocks of a file and of those it includes, in order; what cannot be read is told.
pub fn blocks(path: &Path, messages: &mut Messages) -> Vec<KeywordBlock> {
    let mut cutter = Cutter { blocks: vec![], open: vec![], messages };
    cutter.file(path, None);
    cutter.blocks
}

/// The blocks of a text as if it stood in the file at `path`.
pub fn blocks_of(path: &Path, text: &str, messages: &mut Messages) -> Vec<KeywordBlock> {
    let mut cutter = Cutter { blocks: vec![], open: vec![], messages };
    cutter.text(path, text);
    cutter.blocks
}

struct Cutter<'m> {
    blocks: Vec<KeywordBlock>,
    /// Files that are open, the innermost last.
    open: Vec<PathBuf>,
    messages: &'m mut Messages,
}

impl Cutter<'_> {
    /// Cuts one file, which `from` includes.
    fn file(&mut self, path: &Path, from: Option<InputPlace>) {
        let here = from.unwrap_or_default();
        if self.messages.files() >= MOST_FILES {
            return self.messages.error(here, format!("more than {MOST_FILES} files are included; join some of them"));
        }
        let same = |open: &PathBuf| match (open.canonicalize(), path.canonicalize()) {
            (Ok(open), Ok(path)) => open == path,
            _ => open == path,
        };
        if self.open.iter().any(same) {
            let what = format!("'{}' includes itself; take the *INCLUDE out of the circle", path.display());
            return self.messages.error(here, what);
        }
        // Pipes and devices may never end.
        let read = || match path.metadata()?.is_file() {
            true => std::fs::read(path),
            false => Err(std::io::Error::other("it is no regular file")),
        };
        let bytes = match read() {
            Ok(bytes) => bytes,
            Err(error) => {
                let at = from
                    .unwrap_or_else(|| InputPlace { file: self.messages.open(path.display().to_string()), line: 1 });
                let hint = if from.is_some() {
                    "; paths count from the folder of the including file, or of the first"
                } else {
                    ""
                };
                let what = format!("'{}' cannot be read ({error}){hint}", path.display());
                return self.messages.error(at, what);
            }
        };
        self.text(path, &decoded(&bytes));
    }

    fn text(&mut self, path: &Path, text: &str) {
        let file = self.messages.open(path.display().to_string());
        self.open.push(path.to_path_buf());
        self.cut(file, &Rc::from(text));
        self.open.pop();
    }

    fn cut(&mut self, file: usize, text: &Rc<str>) {
        let mut lines = lines(text).enumerate().peekable();
        while let Some((number, range)) = lines.next() {
            let (line, place) = (&text[range.clone()], InputPlace { file, line: number + 1 });
            if is_skipped(line) {
                continue;
            }
            let Some(keyword) = line.trim_start().trim_start_matches('\u{feff}').strip_prefix('*') else {
                self.data(DataLine { place, text: text.clone(), range, read: Cell::new(0) });
                continue;
            };
            let mut keyword = keyword.trim().to_string();
            while keyword.ends_with(',') {
                let Some((_, more)) = lines.next_if(|(_, range)| continues(&text[range.clone()])) else { break };
                if !is_skipped(&text[more.clone()]) {
                    keyword.push_str(text[more].trim());
                }
            }
            self.keyword(&keyword, place);
        }
    }

    fn data(&mut self, line: DataLine) {
        match self.blocks.last_mut() {
            Some(block) => block.lines.push(line),
            None => {
                let what = "data without a keyword before it; an input deck begins with a *KEYWORD";
                self.messages.error(line.place, what);
            }
        }
    }

    fn keyword(&mut self, text: &str, place: InputPlace) {
        let mut parts = text.split(',');
        let name = words(parts.next().unwrap_or(""));
        let parameter = |part: &str| {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            (words(name), value.trim().trim_matches('"').to_string())
        };
        let mut parameters: Vec<(String, String)> = parts.map(parameter).filter(|(name, _)| !name.is_empty()).collect();
        // Blanks do not count: the names are those of the declarations.
        let keyword = keywords::named(&name);
        let name = keyword.map_or(name, |keyword| keyword.name.to_string());
        for (name, _) in &mut parameters {
            let declared = keyword.and_then(|keyword| keyword.parameters.iter().find(|p| keywords::same(p.name, name)));
            *name = declared.map_or_else(|| name.clone(), |declared| declared.name.to_string());
        }
        let block = KeywordBlock { name, parameters, place, lines: vec![] };
        let input = block.value("INPUT").map(str::to_string);
        let is_include = block.name == "INCLUDE";
        if !is_include {
            self.blocks.push(block);
        }
        match input {
            Some(input) => {
                // From the folder of the including file, or that of the first.
                let folders = [self.open.last(), self.open.first()].map(|path| path.and_then(|path| path.parent()));
                let paths = folders.map(|folder| folder.unwrap_or(Path::new("")).join(&input));
                let path = paths.iter().find(|path| path.exists()).unwrap_or(&paths[0]);
                self.file(path, Some(place));
            }
            None if is_include => self.messages.error(place, "*INCLUDE names no file; write *INCLUDE, INPUT=file"),
            None => {}
        }
    }
}

/// The text of a file: UTF-8, or UTF-16 where it begins with the mark of that; lines may end as on any machine.
fn decoded(bytes: &[u8]) -> String {
    let wide = |of: fn([u8; 2]) -> u16| {
        let words = bytes[2..].chunks_exact(2).map(|two| of([two[0], two[1]]));
        char::decode_utf16(words).map(|found| found.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    let text: String = match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => String::from_utf8_lossy(bytes).into_owned(),
    };
    if text.contains('\n') { text } else { text.replace('\r', "\n") }
}

/// Capitals, one blank between words.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase()
}

/// The ranges of the lines of a text.
fn lines(text: &str) -> impl Iterator<Item = Range<usize>> {
    let mut start = 0;
    text.split_inclusive('\n').map(move |line| {
        let range = start..start + line.len();
        start = range.end;
        range
    })
}

fn is_skipped(line: &str) -> bool {
    line.trim().is_empty() || line.trim_start().starts_with("**")
}

/// Whether a line can belong to the parameters of the keyword before it: data never holds an equals sign.
fn continues(line: &str) -> bool {
    let flag = words(line.trim().trim_end_matches(','));
    let parameter =
        !line.trim_start().starts_with('*') && (line.contains('=') || keywords::FLAGS.contains(&flag.as_str()));
    parameter || is_skipped(line)
}
