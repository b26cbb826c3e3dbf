//! Entities, nodes and elements of version 4.1.

use super::{Listed, Reader, element_type};
use crate::error::Error;
use crate::tensor::Vec3;

impl Reader<'_> {
    /// Geometric entities, of which only the physical groups are kept.
    pub(super) fn entities_v4(&mut self) -> Result<(), Error> {
        let mut counts = [0; 4];
        for (count, what) in counts.iter_mut().zip(["points", "curves", "surfaces", "volumes"]) {
            let announced = self.cursor.size(&format!("the number of {what}"))?;
            *count = self.cursor.fits(announced, 4, what)?;
        }
        for (dimension, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                self.entity(dimension as i64)?;
            }
        }
        Ok(())
    }

    fn entity(&mut self, dimension: i64) -> Result<(), Error> {
        let tag = self.cursor.int("the number of an entity")?;
        for _ in 0..if dimension == 0 { 3 } else { 6 } {
            self.cursor.real("a bound of an entity")?;
        }
        let physical = self.tags("physical groups")?;
        if dimension > 0 {
            self.tags("bounding entities")?;
        }
        self.entities.insert((dimension, tag), physical);
        Ok(())
    }

    /// A list of numbers; their signs tell an orientation and are dropped.
    fn tags(&mut self, what: &str) -> Result<Vec<i64>, Error> {
        let count = self.cursor.size(&format!("the number of {what}"))?;
        let count = self.cursor.fits(count, 1, what)?;
        (0..count).map(|_| Ok(self.cursor.int(what)?.saturating_abs())).collect()
    }

    pub(super) fn nodes_v4(&mut self) -> Result<(), Error> {
        let (blocks, count) = self.announced("nodes", 4)?;
        for _ in 0..blocks {
            self.node_block()?;
        }
        match self.draft.node_count() {
            found if found == count => Ok(()),
            found => {
                Err(self.cursor.error(format!("{count} nodes are announced but {found} are there; mend the count")))
            }
        }
    }

    /// The head of a section: number of blocks, of things, least and largest number.
    fn announced(&mut self, what: &str, numbers: usize) -> Result<(usize, usize), Error> {
        let blocks = self.cursor.size("the number of blocks")?;
        let count = self.cursor.size(&format!("the number of {what}"))?;
        let head = [self.cursor.size("the least number")?, self.cursor.size("the largest number")?];
        if head[0] > head[1] {
            return Err(self.cursor.error("the least number exceeds the largest; the section is damaged"));
        }
        Ok((self.cursor.fits(blocks, 3, "blocks")?, self.cursor.fits(count, numbers, what)?))
    }

    fn node_block(&mut self) -> Result<(), Error> {
        let dimension = self.cursor.int("the dimension of an entity")?;
        self.cursor.int("the number of an entity")?;
        let parametric = self.cursor.int("the flag of parametric nodes")?;
        let count = self.cursor.size("the number of nodes")?;
        let count = self.cursor.fits(count, 4, "nodes")?;
        let extra = if parametric == 0 { 0 } else { dimension.clamp(0, 3) };
        let numbers = (0..count).map(|_| self.cursor.size("the number of a node")).collect::<Result<Vec<_>, _>>()?;
        for number in numbers {
            let mut point = Vec3::zero();
            for a in 0..3 {
                point[a] = self.cursor.real("a coordinate")?;
            }
            for _ in 0..extra {
                self.cursor.real("a parameter")?;
            }
            self.draft.add_node(number, point).map_err(|what| self.cursor.error(what))?;
        }
        Ok(())
    }

    pub(super) fn elements_v4(&mut self) -> Result<(), Error> {
        let (blocks, count) = self.announced("elements", 2)?;
        let mut found = 0;
        for _ in 0..blocks {
            found += self.element_block()?;
        }
        match found == count {
            true => Ok(()),
            false => {
                let what = format!("{count} elements are announced but {found} are there; mend the count");
                Err(self.cursor.error(what))
            }
        }
    }

    fn element_block(&mut self) -> Result<usize, Error> {
        let dimension = self.cursor.int("the dimension of an entity")?;
        let entity = self.cursor.int("the number of an entity")?;
        let kind = self.cursor.int("the type of elements")?;
        let (found, size) = element_type(&self.cursor, kind)?;
        let count = self.cursor.size("the number of elements")?;
        let count = self.cursor.fits(count, 1 + size, "elements")?;
        let physical = self.entities.get(&(dimension, entity)).cloned().unwrap_or_default();
        let mut nodes = vec![0; size];
        for _ in 0..count {
            let number = self.cursor.size("the number of an element")?;
            for node in &mut nodes {
                *node = self.cursor.size("a node of an element")?;
            }
            self.add(Listed { number, found, nodes: &nodes }, &physical)?;
        }
        Ok(count)
    }
}
