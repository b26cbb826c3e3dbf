//! `summary.json`: how a run ended and its figures, for scripts. It is written when the run begins, with status
//! `running`, while it goes, and again when it ends, however it ends: a killed run is told from a converged one.

use super::certificate::{Certificate, Limits, Occasion};
use super::figures::FIGURES;
use super::file::{self, Durability, write_atomic};
use super::quantity::{Frame, Quantity, QuantityPlace};
use crate::diagnosis::{Finding, Setting};
use asperity_core::{Error, machine};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;

/// Raised when a field changes its meaning or goes; new fields may come without it.
pub const SCHEMA: u32 = 2;

/// How a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunStatus {
    /// It has begun and not ended; found in the file of a finished process, it was killed.
    Running,
    /// All steps were completed.
    Converged,
    /// All steps were completed, and a figure of the certificate is beyond its limit.
    Doubtful,
    /// The increments shrank to nothing.
    NotConverged,
    /// It stopped on request and wrote a checkpoint.
    Stopped,
    /// The input is wrong.
    InputError,
    /// A file could not be read, or a result not be written.
    FileError,
    /// A fault of the program.
    InternalError,
}

/// The content of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of this schema.
    pub schema: u32,
    /// Version of the program.
    pub version: String,
    /// The deck's title.
    pub title: String,
    /// The space of the model.
    pub space: String,
    /// Names of the units of force, length and maybe time, where the deck gives them.
    #[serde(default)]
    pub units: Option<String>,
    /// How the run stands.
    pub status: RunStatus,
    /// Why it ended so, in words; null when all steps were completed.
    pub reason: Option<String>,
    /// Hash of deck and mesh, the one that checkpoints carry.
    pub input_hash: Option<String>,
    /// Threads that were used.
    pub threads: usize,
    /// Unknowns, constrained ones included.
    pub unknowns: usize,
    /// Steps that were completed.
    pub steps: usize,
    /// Accepted increments.
    pub increments: usize,
    /// Attempts, rejected ones included.
    pub attempts: usize,
    /// Newton iterations, those of rejected attempts included.
    pub iterations: usize,
    /// Factorisations of the matrix since the run began or went on.
    #[serde(default)]
    pub factorisations: usize,
    /// Those of them of symmetric matrices, as L D L^T instead of L U.
    #[serde(default)]
    pub symmetric_factorisations: usize,
    /// Total time reached.
    pub time: f64,
    /// Seconds by what they were spent on.
    pub timings: BTreeMap<String, f64>,
    /// Largest memory the process held, in bytes; null where the system does not tell.
    pub peak_memory: Option<u64>,
    /// Names of the bodies, by the number in the result files.
    pub bodies: Vec<String>,
    /// For each body what its cells became, and why.
    #[serde(default)]
    pub formulations: BTreeMap<String, Vec<String>>,
    /// Names of the materials, by the number in the result files.
    pub materials: Vec<String>,
    /// Names of the tools, by the number in the result files.
    pub tools: Vec<String>,
    /// For each contact the quantities of the last accepted increment.
    pub contacts: BTreeMap<String, Map<String, Value>>,
    /// Names of the contacts, by the number in the result files.
    pub contact_order: Vec<String>,
    /// For each group the reaction of the last accepted increment.
    pub reactions: BTreeMap<String, Value>,
    /// The worst figures over all accepted increments; null where nothing was to be read.
    pub certificate: BTreeMap<String, Option<f64>>,
    /// Of each figure that was read: where and when it was worst, and its limit.
    pub worst: BTreeMap<String, Occasion>,
    /// What a run that failed or is doubtful most likely suffers from, the likeliest first.
    #[serde(default)]
    pub diagnosis: Vec<Finding>,
    /// Settings with which a run that failed may go on from its last accepted increment.
    #[serde(default)]
    pub settings: Vec<Setting>,
    /// Notes that the user must see: options that bend a promise, warnings.
    pub notes: Vec<String>,
    /// Result files, relative to the directory of this one.
    pub files: Vec<String>,
}

impl Summary {
    /// A summary of a run that begins.
    pub fn begin(title: &str, space: &str) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").into(),
            title: title.into(),
            space: space.into(),
            units: None,
            status: RunStatus::Running,
            reason: None,
            input_hash: None,
            threads: 1,
            unknowns: 0,
            steps: 0,
            increments: 0,
            attempts: 0,
            iterations: 0,
            factorisations: 0,
            symmetric_factorisations: 0,
            time: 0.0,
            timings: BTreeMap::new(),
            peak_memory: None,
            bodies: Vec::new(),
            formulations: BTreeMap::new(),
            materials: Vec::new(),
            tools: Vec::new(),
            contacts: BTreeMap::new(),
            contact_order: Vec::new(),
            reactions: BTreeMap::new(),
            certificate: FIGURES.iter().map(|figure| (figure.name.into(), None)).collect(),
            worst: BTreeMap::new(),
            diagnosis: Vec::new(),
            settings: Vec::new(),
            notes: Vec::new(),
            files: Vec::new(),
        }
    }
    /// Takes the contacts and reactions of an accepted frame.
    pub fn observe(&mut self, frame: &Frame, plane: bool) {
        (self.increments, self.time) = (frame.increment, frame.time);
        for quantity in frame.at(QuantityPlace::Global) {
            let value = value(quantity, plane);
            if let Some(group) = quantity.name.strip_prefix("reaction.") {
                self.reactions.insert(group.into(), value);
            } else if let Some((contact, what)) = contact_part(&quantity.name) {
                self.contacts.entry(contact.into()).or_default().insert(what.into(), value);
            }
        }
    }
    /// Takes the figures of the certificate.
    pub fn certify(&mut self, certificate: &Certificate, limits: &Limits) {
        for figure in FIGURES {
            // What is no finite number is null, as JSON has it.
            let value = certificate.figure(figure.name).filter(|value| value.is_finite());
            self.certificate.insert(figure.name.into(), value);
            if let Some(worst) = certificate.worst(figure.name, limits) {
                self.worst.insert(figure.name.into(), worst);
            }
        }
    }
    /// Notes how the run ended, and whether its certificate is to be doubted.
    pub fn end(&mut self, outcome: &Result<(), Error>, doubtful: bool) {
        self.status = match outcome {
            Ok(()) if doubtful => RunStatus::Doubtful,
            Ok(()) => RunStatus::Converged,
            Err(Error::NotConverged(_)) => RunStatus::NotConverged,
            Err(Error::Stopped) => RunStatus::Stopped,
            Err(Error::Input(_)) => RunStatus::InputError,
            Err(Error::File { .. } | Error::Write { .. }) => RunStatus::FileError,
            Err(Error::Internal(_)) => RunStatus::InternalError,
        };
        self.reason = outcome.as_ref().err().map(Error::to_string);
        self.peak_memory = machine::usage().map(|usage| usage.peak);
    }
    /// Writes the file.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        self.write_as(path, Durability::Machine)
    }
    pub(super) fn write_as(&self, path: &Path, durability: Durability) -> Result<(), Error> {
        let mut bytes = serde_json::to_vec_pretty(self).map_err(|error| Error::file(path, error))?;
        bytes.push(b'\n');
        write_atomic(path, &bytes, durability)
    }
    /// Reads a summary.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read, or is none of this schema.
    pub fn read(path: &Path) -> Result<Self, Error> {
        serde_json::from_slice(&file::read(path)?).map_err(|error| Error::file(path, error))
    }
}

/// Name and quantity of `contact.NAME.QUANTITY`; a name may hold dots.
fn contact_part(name: &str) -> Option<(&str, &str)> {
    name.strip_prefix("contact.")?.rsplit_once('.')
}

/// A number, or an object by component. What is no finite number is null, as JSON has it.
fn value(quantity: &Quantity, plane: bool) -> Value {
    let columns = quantity.width.columns(plane);
    match columns {
        [(0, "")] => Value::from(quantity.values[0]),
        _ => columns.iter().map(|&(c, suffix)| (suffix[1..].to_string(), Value::from(quantity.values[c]))).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Reading, Unit, Width};
    use super::*;
    use asperity_core::tensor::Vec3;

    fn frame() -> Frame {
        let mut frame = Frame::new(1, 3, 0.5);
        let vector =
            |name: &str, values| Quantity::new(name, Unit::Force, QuantityPlace::Global, Width::Vector, values);
        frame.push(vector("reaction.far.end", vec![1.0, 2.0, 3.0])).unwrap();
        frame.push(vector("contact.the.bore.force", vec![4.0, 5.0, 6.0])).unwrap();
        frame.push(Quantity::scalar("contact.the.bore.area", Unit::Area, f64::NAN)).unwrap();
        frame
    }

    #[test]
    fn it_is_written_and_read_back() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("summary.json");
        let mut summary = Summary::begin("A \"title\"", "axisymmetric");
        summary.observe(&frame(), true);
        let mut frame = frame();
        frame.certify(Reading::new("max_penetration", "contact 'bore'", 1e-3).at(Vec3::new(0.1, 0.2, 0.0)));
        let mut certificate = Certificate::default();
        certificate.observe(&frame);
        summary.certify(&certificate, &Limits::default());
        assert_eq!(summary.certificate["max_penetration"], Some(1e-3));
        summary.end(&Err(Error::NotConverged("the increment is too small".into())), false);
        summary.write(&path).unwrap();
        assert_eq!(Summary::read(&path).unwrap(), summary);
    }

    #[test]
    fn contacts_and_reactions_come_from_the_frame_by_component() {
        let mut summary = Summary::begin("", "plane-strain");
        summary.observe(&frame(), true);
        let json = serde_json::to_value(&summary).unwrap();
        assert_eq!(json["reactions"]["far.end"], serde_json::json!({"x": 1.0, "y": 2.0}));
        assert_eq!(json["contacts"]["the.bore"]["force"]["y"], 5.0);
        assert_eq!(json["contacts"]["the.bore"]["area"], Value::Null);
        assert_eq!((json["increments"].as_u64(), json["status"].as_str()), (Some(3), Some("running")));
    }

    #[test]
    fn the_end_says_why() {
        let mut summary = Summary::begin("", "solid");
        summary.end(&Ok(()), false);
        assert_eq!((summary.status, summary.reason.as_deref()), (RunStatus::Converged, None));
        assert!(summary.peak_memory.is_none_or(|bytes| bytes > 1 << 16));
        summary.end(&Ok(()), true);
        assert_eq!((summary.status, summary.reason.as_deref()), (RunStatus::Doubtful, None));
        summary.end(&Err(Error::Stopped), true);
        assert_eq!(summary.status, RunStatus::Stopped);
        assert!(summary.reason.is_some());
    }

    /// The names that scripts rely on; a change here is a change of schema.
    #[test]
    fn the_fields_that_scripts_read_are_there() {
        let json = serde_json::to_value(Summary::begin("", "solid")).unwrap();
        let fields = [
            "status",
            "reason",
            "increments",
            "attempts",
            "iterations",
            "unknowns",
            "timings",
            "peak_memory",
            "contacts",
            "reactions",
            "certificate",
            "worst",
            "files",
        ];
        assert!(fields.iter().all(|field| json.get(field).is_some()));
        let figures = [
            "max_penetration",
            "max_penetration_relative",
            "equilibrium_error",
            "energy_balance",
            "hypoelastic_residue",
            "coulomb_violation",
            "least_dissipation",
            "rejected_false_contacts",
        ];
        assert!(figures.iter().all(|field| json["certificate"].get(field).is_some()));
    }
}
