//! A place in the bytes of a Gmsh file, from which numbers are read in either form: as words, or as binary integers
//! of 4 and 8 bytes and doubles in the byte order that the header tells.

use crate::error::Error;

/// A cursor into a file.
pub(super) struct Cursor<'a> {
    file: String,
    bytes: &'a [u8],
    at: usize,
    line: usize,
    /// The line where the section begins.
    head: usize,
    /// Whether numbers are binary.
    pub binary: bool,
    /// Whether binary numbers begin with their most significant byte.
    pub big_endian: bool,
    /// Name of the section that is being read, for messages.
    pub section: String,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(file: String, bytes: &'a [u8]) -> Self {
        Self { file, bytes, at: 0, line: 1, head: 1, binary: false, big_endian: false, section: String::new() }
    }

    /// An error here: `file:line: what; what to do`, or with the byte in a binary file.
    pub(super) fn error(&self, what: impl std::fmt::Display) -> Error {
        match self.binary {
            true => Error::input(format!("{}: byte {} ({}): {what}", self.file, self.at, self.section)),
            false => Error::input(format!("{}:{}: {what}", self.file, self.line)),
        }
    }

    /// An error at the head of the section.
    pub(super) fn section_error(&self, what: impl std::fmt::Display) -> Error {
        match self.binary {
            true => self.error(what),
            false => Error::input(format!("{}:{}: {what}", self.file, self.head)),
        }
    }

    /// The line for notes; none in a binary file.
    pub(super) fn line_number(&self) -> Option<usize> {
        (!self.binary).then_some(self.line)
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn advance(&mut self, count: usize) {
        self.line += self.rest()[..count].iter().filter(|&&byte| byte == b'\n').count();
        self.at += count;
    }

    fn skip_space(&mut self) {
        let space = self.rest().iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        self.advance(space);
    }

    fn truncated(&self) -> Error {
        let place = if self.section.is_empty() { "its header".into() } else { format!("'${}'", self.section) };
        self.error(format!("the file ends inside {place}; write it again, it is cut off"))
    }

    /// The next word, between white space.
    pub(super) fn word(&mut self) -> Result<&'a str, Error> {
        self.skip_space();
        let length = self.rest().iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
        if length == 0 {
            return Err(self.truncated());
        }
        let word = std::str::from_utf8(&self.rest()[..length]);
        let word = word.map_err(|_| self.error("this is not text; the file is damaged"))?;
        self.advance(length);
        Ok(word)
    }

    /// The rest of the line, without the line's end, and on to the next line.
    pub(super) fn rest_of_line(&mut self) -> Result<&'a str, Error> {
        let length = self.rest().iter().take_while(|&&byte| byte != b'\n').count();
        let text = std::str::from_utf8(&self.rest()[..length]);
        let text = text.map_err(|_| self.error("this line is not text; the file is damaged"))?;
        self.advance((length + 1).min(self.rest().len()));
        Ok(text.trim())
    }

    /// The next section's name, without the dollar sign; none at the end of the file.
    pub(super) fn next_section(&mut self) -> Result<Option<String>, Error> {
        self.skip_space();
        if self.rest().is_empty() {
            return Ok(None);
        }
        let word = self.word()?;
        let Some(name) = word.strip_prefix('$') else {
            let word = shorten(word);
            return Err(self.error(format!(
                "a section such as '$Nodes' is expected here, not '{word}'; a count above it is wrong"
            )));
        };
        self.section = name.to_string();
        self.head = self.line;
        self.rest_of_line()?;
        Ok(Some(name.to_string()))
    }

    /// The end of the section that is being read.
    pub(super) fn end_section(&mut self) -> Result<(), Error> {
        let wanted = format!("$End{}", self.section);
        match self.word()? {
            word if word == wanted => Ok(()),
            word => {
                let word = shorten(word);
                Err(self.error(format!("'{wanted}' is expected here, not '{word}'; a count above it is wrong")))
            }
        }
    }

    /// On behind the end of a section that is not read.
    pub(super) fn skip_section(&mut self) -> Result<(), Error> {
        let wanted = format!("$End{}", self.section).into_bytes();
        let found = self.rest().windows(wanted.len()).position(|window| window == wanted);
        let found = found.ok_or_else(|| self.truncated())?;
        self.advance(found + wanted.len());
        Ok(())
    }

    fn parse<T: std::str::FromStr>(&mut self, what: &str, noun: &str) -> Result<T, Error> {
        let word = self.word()?;
        word.parse().map_err(|_| {
            let word = shorten(word);
            self.error(format!("{what} should be {noun} but is '{word}'; the file is damaged or cut off above"))
        })
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let Some(bytes) = self.rest().first_chunk::<N>() else { return Err(self.truncated()) };
        let mut bytes = *bytes;
        if self.big_endian {
            bytes.reverse();
        }
        self.at += N;
        Ok(bytes)
    }

    /// A small integer: 4 bytes.
    pub(super) fn int(&mut self, what: &str) -> Result<i64, Error> {
        match self.binary {
            true => Ok(i64::from(i32::from_le_bytes(self.take()?))),
            false => self.parse(what, "a whole number"),
        }
    }

    /// A count or a number of a node or element in files of version 4: 8 bytes.
    pub(super) fn size(&mut self, what: &str) -> Result<u64, Error> {
        match self.binary {
            true => Ok(u64::from_le_bytes(self.take()?)),
            false => self.parse(what, "a whole number"),
        }
    }

    /// A real number: 8 bytes.
    pub(super) fn real(&mut self, what: &str) -> Result<f64, Error> {
        match self.binary {
            true => Ok(f64::from_le_bytes(self.take()?)),
            false => self.parse(what, "a number"),
        }
    }

    /// Accepts a count of things of which each takes at least so many numbers, if the rest of the file can hold them.
    pub(super) fn fits(&self, count: u64, numbers: usize, what: &str) -> Result<usize, Error> {
        let each = numbers.max(1) as u64 * if self.binary { 4 } else { 2 };
        let left = self.rest().len() as u64 + 2;
        match count.checked_mul(each) {
            Some(bytes) if bytes <= left => Ok(count as usize),
            _ => Err(self.error(format!(
                "the file announces {count} {what}, more than the rest of it can hold; the count is wrong or the file \
                 cut off"
            ))),
        }
    }

    /// A count written as an integer: not negative and not more than the file can hold.
    pub(super) fn count(&mut self, numbers: usize, what: &str) -> Result<usize, Error> {
        let count = self.int(&format!("the number of {what}"))?;
        let count =
            u64::try_from(count).map_err(|_| self.error(format!("the number of {what} is negative; it is damaged")))?;
        self.fits(count, numbers, what)
    }
}

/// A word short enough for a message.
fn shorten(word: &str) -> String {
    match word.char_indices().nth(24) {
        Some((end, _)) => format!("{}...", &word[..end]),
        None => word.to_string(),
    }
}
