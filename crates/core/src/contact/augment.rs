//! Augmentation after Uzawa: multipliers take out what the penalties leave of penetration and elastic slip (Hestenes 1969; Simo & Laursen,
//! Comput. Struct. 42, 1992).

use crate::{Failure, FailureKind};

/// How far a contact is augmented. Lengths are parts of the size of the surface's element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Augmentation {
    /// Largest penetration at a node that is left.
    pub penetration: f64,
    /// Largest slip of an increment that is left at a node where nothing slides.
    pub slip: f64,
    /// Most augmentations of an attempt.
    pub loops: usize,
}

/// What is left at the nodes, as parts of their sizes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Left {
    /// Largest change of a closure.
    pub penetration: f64,
    /// Largest change of a slip at a node where nothing slides.
    pub slip: f64,
}

impl Augmentation {
    /// Whether what is left after `done` augmentations asks for another.
    ///
    /// # Errors
    /// A [`Failure`] when there may be no other.
    pub fn goes_on(&self, left: &Left, done: usize, name: &str) -> Result<bool, Failure> {
        if left.penetration <= self.penetration && left.slip <= self.slip {
            return Ok(false);
        }
        if done < self.loops {
            return Ok(true);
        }
        Err(Failure::new(format!(
            "contact '{name}': {done} augmentations leave a penetration of {:.1e} and a slip of {:.1e} of an element's size \
             at its nodes",
            left.penetration, left.slip
        ))
        .of(FailureKind::Multipliers))
    }
}
