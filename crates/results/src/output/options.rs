//! What a run writes, and how often.

use super::export::{Export, Printed};
use super::kept::Keep;
use super::probe::Probe;
use super::units::Units;
use super::vtk::Encoding;

/// What is written, and how often.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultOptions {
    /// A frame of fields every so many increments; the last of a step always.
    pub every: usize,
    /// A checkpoint every so many increments, and at the end of each step.
    pub checkpoint_every: usize,
    /// Which checkpoints are kept.
    pub keep: Keep,
    /// Whether pictures are drawn at the end.
    pub pictures: bool,
    /// How the arrays of frames are laid down.
    pub encoding: Encoding,
    /// Files for other programs.
    pub export: Vec<Export>,
    /// What is read at chosen places.
    pub probes: Vec<Probe>,
    /// Tables that are printed as CalculiX does.
    pub printed: Vec<Printed>,
    /// Names of the units.
    pub units: Option<Units>,
}

impl Default for ResultOptions {
    fn default() -> Self {
        Self {
            every: 1,
            checkpoint_every: 10,
            keep: Keep::Last,
            pictures: true,
            encoding: Encoding::default(),
            export: Vec::new(),
            probes: Vec::new(),
            printed: Vec::new(),
            units: None,
        }
    }
}
