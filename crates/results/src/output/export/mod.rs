//! Files for other programs, which grow frame by frame beside the VTU of every run.

mod frd;
mod growing;
mod print;
mod xdmf;

pub use frd::FRD;
pub use print::{DAT, Printed, Totals, Whose};
pub use xdmf::XDMF;

use super::quantities::Source;
use super::quantity::Frame;
use asperity_core::Error;
use frd::Frd;
use print::Dat;
use std::path::Path;
use xdmf::Xdmf;

/// A kind of file beside the VTU of every run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Export {
    /// `results.frd`, for CalculiX GraphiX, PrePoMax and FreeCAD.
    Frd,
    /// `results.xdmf`, all frames in one file.
    Xdmf,
    /// `deformed.pvd`, the bodies with their points at the present places.
    Deformed,
}

/// The files of a run.
#[derive(Debug, Default)]
pub struct Exports {
    frd: Option<Frd>,
    xdmf: Option<Xdmf>,
    dat: Option<Dat>,
}

impl Exports {
    /// Begins the files.
    ///
    /// # Errors
    /// [`Error::File`] when one cannot be written.
    pub fn create(
        directory: &Path,
        source: &Source,
        (wanted, printed): (&[Export], &[Printed]),
    ) -> Result<Self, Error> {
        let (mesh, has) = (source.parts.mesh, |export| wanted.contains(&export));
        let frd = has(Export::Frd).then(|| Frd::create(directory, mesh, &bodies(source)));
        let xdmf = has(Export::Xdmf).then(|| Xdmf::create(directory, mesh));
        let dat = (!printed.is_empty()).then(|| Dat::create(directory, printed));
        Ok(Self { frd: frd.transpose()?, xdmf: xdmf.transpose()?, dat: dat.transpose()? })
    }
    /// Continues the files of a run at its accepted state.
    ///
    /// # Errors
    /// [`Error::File`] when one cannot be read or written.
    pub fn resume(
        directory: &Path,
        source: &Source,
        (wanted, printed): (&[Export], &[Printed]),
    ) -> Result<Self, Error> {
        let (mesh, has) = (source.parts.mesh, |export| wanted.contains(&export));
        let at = source.state.increment;
        let frd = has(Export::Frd).then(|| Frd::resume(directory, mesh, &bodies(source), at));
        let xdmf = has(Export::Xdmf).then(|| Xdmf::resume(directory, mesh, at));
        let dat = (!printed.is_empty()).then(|| Dat::resume(directory, printed, at));
        Ok(Self { frd: frd.transpose()?, xdmf: xdmf.transpose()?, dat: dat.transpose()? })
    }
    /// Adds a frame.
    ///
    /// # Errors
    /// [`Error::Write`] when a file cannot be written.
    pub fn push(&mut self, source: &Source, frame: &Frame) -> Result<(), Error> {
        self.xdmf.as_mut().map_or(Ok(()), |xdmf| xdmf.push(frame))?;
        // CalculiX writes nothing before the first increment.
        let frd = self.frd.as_mut().filter(|_| frame.increment > 0);
        frd.map_or(Ok(()), |frd| frd.push(frame))?;
        let dat = self.dat.as_mut().filter(|_| frame.increment > 0);
        dat.map_or(Ok(()), |dat| dat.push(source, frame))
    }
}

/// For each cell the number of its body, counted from 1; 0 for a cell of none.
fn bodies(source: &Source) -> Vec<usize> {
    let mut bodies = vec![0; source.parts.mesh.cell_count()];
    for (number, (_, body)) in source.parts.bodies.iter().enumerate() {
        body.cells().iter().for_each(|&cell| bodies[cell] = number + 1);
    }
    bodies
}
