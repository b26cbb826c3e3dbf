//! The law of a contact over a run: one law, or one whose numbers run in time.

use super::{Interface, InterfaceLaw, Law};
use crate::Failure;
use std::sync::Arc;

/// Makes the law that holds at a time of a step (counted from zero).
type Course = dyn Fn(usize, f64) -> Result<Arc<dyn Interface>, String> + Send + Sync;

/// The law of a contact.
#[derive(Clone)]
pub struct Rule {
    first: Arc<dyn Interface>,
    course: Option<Arc<Course>>,
}

impl From<Arc<dyn Interface>> for Rule {
    fn from(law: Arc<dyn Interface>) -> Self {
        Self { first: law, course: None }
    }
}

impl<L: InterfaceLaw> From<L> for Rule {
    fn from(law: L) -> Self {
        Self { first: Arc::new(Law(law)), course: None }
    }
}

impl Rule {
    /// A law whose numbers run in time: they change its answers, never what it remembers.
    pub fn running(
        first: Arc<dyn Interface>,
        course: impl Fn(usize, f64) -> Result<Arc<dyn Interface>, String> + Send + Sync + 'static,
    ) -> Self {
        Self { first, course: Some(Arc::new(course)) }
    }
    /// The law of the beginning, for what does not run.
    pub fn first(&self) -> &dyn Interface {
        &*self.first
    }
    /// The law of an increment that ends at a time of a step.
    ///
    /// # Errors
    /// A [`Failure`] where its numbers are none of the law.
    pub fn at(&self, step: usize, step_time: f64) -> Result<Arc<dyn Interface>, Failure> {
        let Some(course) = &self.course else { return Ok(self.first.clone()) };
        course(step, step_time).map_err(Failure::new)
    }
}
