//! Nodes and elements of version 2.2.
//!
//! An element in several physical groups is there once for each of them; the repeats are joined.

use super::{Listed, Reader, element_type};
use crate::error::Error;
use crate::tensor::Vec3;
use std::collections::HashMap;

/// The index of an element by its type and nodes.
type Known = HashMap<(i64, Vec<u64>), Option<usize>>;

impl Reader<'_> {
    pub(super) fn nodes_v2(&mut self) -> Result<(), Error> {
        let count = self.text_count(4, "nodes")?;
        for _ in 0..count {
            let number = self.number("the number of a node")?;
            let mut point = Vec3::zero();
            for a in 0..3 {
                point[a] = self.cursor.real("a coordinate")?;
            }
            self.draft.add_node(number, point).map_err(|what| self.cursor.error(what))?;
        }
        Ok(())
    }

    pub(super) fn elements_v2(&mut self) -> Result<(), Error> {
        let count = self.text_count(4, "elements")?;
        let mut known = Known::new();
        let mut done = 0;
        while done < count {
            done += match self.cursor.binary {
                true => self.block(count - done, &mut known)?,
                false => self.line(&mut known)?,
            };
        }
        Ok(())
    }

    /// One element of a text file: number, type, tags, nodes.
    fn line(&mut self, known: &mut Known) -> Result<usize, Error> {
        let number = self.number("the number of an element")?;
        let kind = self.cursor.int("the type of an element")?;
        let tags = self.cursor.count(1, "tags")?;
        self.element(number, kind, tags, known)?;
        Ok(1)
    }

    /// Elements of one type in a binary file: type, how many, number of tags; then number, tags, nodes of each.
    fn block(&mut self, left: usize, known: &mut Known) -> Result<usize, Error> {
        let kind = self.cursor.int("the type of elements")?;
        let count = self.cursor.count(2, "elements")?;
        let tags = self.cursor.count(1, "tags")?;
        if count == 0 || count > left {
            let what = format!("a block of {count} elements stands where {left} are left; the file is damaged");
            return Err(self.cursor.error(what));
        }
        for _ in 0..count {
            let number = self.number("the number of an element")?;
            self.element(number, kind, tags, known)?;
        }
        Ok(count)
    }

    fn element(&mut self, number: u64, kind: i64, tags: usize, known: &mut Known) -> Result<(), Error> {
        let (found, size) = element_type(&self.cursor, kind)?;
        let mut physical = 0;
        for place in 0..tags {
            let tag = self.cursor.int("a tag")?;
            physical = if place == 0 { tag.saturating_abs() } else { physical };
        }
        let nodes = (0..size).map(|_| self.number("a node of an element")).collect::<Result<Vec<u64>, Error>>()?;
        let groups = if physical == 0 { vec![] } else { vec![physical] };
        if let Some(&Some(index)) = known.get(&(kind, nodes.clone())) {
            let dimension = self.draft.kind(index).dimension as i64;
            for physical in groups {
                let name = self.group_name(dimension, physical);
                self.draft.group(&name).elements.push(index);
            }
            return Ok(());
        }
        let index = self.add(Listed { number, found, nodes: &nodes }, &groups)?;
        known.insert((kind, nodes), index);
        Ok(())
    }

    /// A count on a line of its own, which is text in binary files too.
    fn text_count(&mut self, numbers: usize, what: &str) -> Result<usize, Error> {
        let binary = std::mem::replace(&mut self.cursor.binary, false);
        let count = self.cursor.count(0, what);
        self.cursor.binary = binary;
        let count = count?;
        if binary {
            self.cursor.rest_of_line()?;
        }
        self.cursor.fits(count as u64, numbers, what)
    }

    /// A number of a node or an element: positive.
    fn number(&mut self, what: &str) -> Result<u64, Error> {
        let number = self.cursor.int(what)?;
        u64::try_from(number)
            .map_err(|_| self.cursor.error(format!("{what} is {number}; it must be positive; mend it")))
    }
}
