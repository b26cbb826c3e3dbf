//! The result directory of a run: every file in it is written from here, all from the same frames.
//!
//! | file | what |
//! | --- | --- |
//! | `bodies.pvd`, `points.pvd`, `contacts.pvd`, `tools.pvd` | frames: meshes, integration points, contact points, outlines |
//! | `surfaces.pvd` | frames: the faces of the surfaces of contacts with their contact stress |
//! | `deformed.pvd` | frames: the bodies at their present places, where asked for |
//! | `modes.pvd` | frames with the mode where stability was lost or found again |
//! | `history.csv` | global quantities, a row an increment |
//! | `probe.NAME.csv` | what a probe reads |
//! | `results.frd`, `results.xdmf`, `results.dat` | the same for other programs, where asked for |
//! | `certificate.csv` | readings for the certificate |
//! | `summary.json` | how the run ended and its certificate |
//! | `run.checkpoint` | the last checkpoint |
//! | `checkpoints` | those that are kept |
//! | `status.json` | where the run stands, while it goes |

use super::account::Account;
use super::asked::ASKED;
use super::checkpoint::{self, Head, Stamp};
use super::export::{DAT, Export, Exports, FRD, XDMF};
use super::figure::{FigureOptions, draw_standard};
use super::file::{Durability, make_directory, remove, sweep, write_atomic};
use super::grids::{BodyGrid, cloud, deformed, surfaces, tools};
use super::history::{HISTORY, HistoryTable};
use super::input::Origin;
use super::kept::{self, KEPT, Keep};
use super::options::ResultOptions;
use super::probe::{Probe, ProbeTable};
use super::progress::{PROGRESS, Request};
use super::quantities::{Parts, Source};
use super::quantity::{Frame, QuantityPlace};
use super::readings::{READINGS, ReadingTable};
use super::units::Units;
use super::vtk::{DataArray, Grid, PvdSeries, Values};
use asperity_core::Error;
use asperity_core::system::State;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Writes the results of a run.
pub struct Results {
    directory: PathBuf,
    options: ResultOptions,
    origin: Origin,
    grid: BodyGrid,
    frames: Mutex<Frames>,
    /// Frames where stability was lost or found again, from the first such on.
    modes: Option<PvdSeries>,
    history: HistoryTable,
    readings: ReadingTable,
    probes: Vec<ProbeTable>,
    exports: Exports,
    /// What is known of the run; the caller fills into its summary what the results do not know.
    pub account: Account,
    /// Time that the results took.
    pub(super) spent: Duration,
    /// When the summary was last written.
    told: Instant,
}

/// The series of frames. A thread of its own writes each frame while the run goes on.
#[derive(Default)]
struct Frames {
    fields: Vec<Fields>,
    series: Vec<PvdSeries>,
    pending: Option<JoinHandle<Written>>,
}

/// The series with a frame more, and whether that was written.
type Written = (Vec<PvdSeries>, Result<(), Error>);

impl Frames {
    fn new(series: Vec<(Fields, PvdSeries)>) -> Mutex<Self> {
        let (fields, series) = series.into_iter().unzip();
        Mutex::new(Self { fields, series, pending: None })
    }
    /// Writes a frame, one grid for each series, once the one before is there.
    fn push(&mut self, grids: Vec<Grid>) -> Result<(), Error> {
        self.wait()?;
        let mut series = std::mem::take(&mut self.series);
        let write = move || {
            let written = series.iter_mut().zip(&grids).try_for_each(|(series, grid)| series.push(grid));
            (series, written)
        };
        let spawned = std::thread::Builder::new().name("frames".into()).spawn(write);
        self.pending = Some(spawned.map_err(|error| Error::Internal(format!("no thread to write frames: {error}")))?);
        Ok(())
    }
    /// Waits for the last frame.
    fn wait(&mut self) -> Result<(), Error> {
        let Some(pending) = self.pending.take() else { return Ok(()) };
        let panicked = |_| Error::Internal("the thread that writes frames has panicked".into());
        let (series, written) = pending.join().map_err(panicked)?;
        self.series = series;
        written
    }
}

impl Drop for Frames {
    fn drop(&mut self) {
        // What could not be written is told where the run ends.
        let _ = self.wait();
    }
}

/// The kinds of frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fields {
    Bodies,
    Points,
    Contacts,
    Surfaces,
    Tools,
    Deformed,
}

/// Name of the checkpoint in the result directory.
pub const CHECKPOINT: &str = "run.checkpoint";
/// Name of the summary in the result directory.
pub const SUMMARY: &str = "summary.json";

/// Name of the series of modes, and of its list.
const MODES: &str = "modes";
const MODES_LIST: &str = "modes.pvd";

/// The series of frames that a result directory may have.
pub(super) fn series() -> impl Iterator<Item = &'static str> {
    Fields::ALL.into_iter().map(Fields::name).chain([MODES])
}

/// Name of the report in the result directory, which the command writes.
pub const REPORT: &str = "report.html";
/// Between two writings of the summary while a run goes, but for the ends of steps.
const BETWEEN: Duration = Duration::from_millis(200);

/// Room on the disk that is given back at the end of a run, so that its summary can be written where the disk is full. It
/// goes by the name of a temporary file, which the next run removes.
const RESERVE: &str = ".writing-reserve";
/// Bytes of that room.
const RESERVED: usize = 1 << 16;

fn reserve(directory: &Path) -> Result<(), Error> {
    write_atomic(&directory.join(RESERVE), &vec![0; RESERVED], Durability::Machine)
}

impl Fields {
    const ALL: [Self; 6] = [Self::Bodies, Self::Points, Self::Contacts, Self::Surfaces, Self::Tools, Self::Deformed];
    fn name(self) -> &'static str {
        match self {
            Self::Bodies => "bodies",
            Self::Points => "points",
            Self::Contacts => "contacts",
            Self::Surfaces => "surfaces",
            Self::Tools => "tools",
            Self::Deformed => "deformed",
        }
    }
}

impl Results {
    /// Begins the results of a run: makes the directory, says `running` in the summary, writes the frame of the start.
    ///
    /// # Errors
    /// [`Error::File`] when something cannot be written.
    pub fn create(directory: &Path, start: &Source, options: ResultOptions, origin: Origin) -> Result<Self, Error> {
        Self::clear(directory)?;
        let series = |fields: Fields| Ok((fields, PvdSeries::create(directory, fields.name(), options.encoding)?));
        let series = fields_of(start.parts, &options).map(series).collect::<Result<_, Error>>()?;
        let plane = start.parts.is_plane();
        let history = HistoryTable::create(directory, plane, options.units.clone());
        let readings = ReadingTable::create(directory)?;
        let (frame, units) = (start.gather()?, options.units.as_ref());
        let probe = |probe: &Probe| ProbeTable::create(directory, probe, (&frame, plane), units);
        let probes = options.probes.iter().map(probe).collect::<Result<_, _>>()?;
        let exports = Exports::create(directory, start, (&options.export, &options.printed))?;
        let tables = (history, readings, probes, exports);
        let mut results = Self::new((directory, options, origin), start.parts, (series, tables))?;
        results.write_grids(start, frame)?;
        reserve(directory)?;
        results.write_summary()?;
        Ok(results)
    }
    /// Makes the directory and removes what an earlier run left there that this one writes only later: a restart would go on
    /// from it.
    ///
    /// # Errors
    /// [`Error::File`] when the directory cannot be made or a file not removed.
    pub fn clear(directory: &Path) -> Result<(), Error> {
        make_directory(directory)?;
        sweep(directory)?;
        Request::clear(directory)?;
        kept::drop_after(directory, None)?;
        let late = [CHECKPOINT, HISTORY, READINGS, PROGRESS, REPORT, MODES_LIST, FRD, XDMF, DAT, "deformed.pvd"];
        remove(directory, late.map(String::from).into_iter().chain(pictures()).chain(probe_tables(directory)))
    }
    /// Continues the results of a run from a checkpoint: what came after it is dropped.
    ///
    /// # Errors
    /// [`Error::File`] when an old file cannot be read or a new one not written.
    pub fn resume(directory: &Path, at: &Source, options: ResultOptions, origin: Origin) -> Result<Self, Error> {
        let (parts, state) = (at.parts, at.state);
        make_directory(directory)?;
        sweep(directory)?;
        Request::clear(directory)?;
        // Before anything of what came later is dropped.
        write_checkpoint(&directory.join(CHECKPOINT), &origin, state)?;
        kept::drop_after(directory, Some(state.increment))?;
        let series = |fields: Fields| {
            let series = PvdSeries::resume(directory, fields.name(), options.encoding, state.time)?;
            Ok((fields, series))
        };
        let series = fields_of(parts, &options).map(series).collect::<Result<_, Error>>()?;
        let plane = parts.is_plane();
        let history = HistoryTable::resume(directory, plane, state.increment, options.units.clone())?;
        let (readings, certificate) = ReadingTable::resume(directory, state.increment)?;
        let (frame, units) = (at.gather()?, options.units.as_ref());
        let probe = |probe: &Probe| ProbeTable::resume(directory, probe, (&frame, plane), units);
        let probes = options.probes.iter().map(probe).collect::<Result<_, _>>()?;
        let exports = Exports::resume(directory, at, (&options.export, &options.printed))?;
        let tables = (history, readings, probes, exports);
        let mut results = Self::new((directory, options, origin), parts, (series, tables))?;
        if directory.join(MODES_LIST).exists() {
            results.modes = Some(PvdSeries::resume(directory, MODES, results.options.encoding, state.time)?);
        }
        results.account.resume(certificate, at)?;
        reserve(directory)?;
        results.write_summary()?;
        Ok(results)
    }
    fn new(
        (directory, options, origin): (&Path, ResultOptions, Origin),
        parts: &Parts,
        (series, (history, readings, probes, exports)): (Vec<(Fields, PvdSeries)>, Tables),
    ) -> Result<Self, Error> {
        let mut account = Account::new(parts);
        account.summary.input_hash = Some(origin.input.to_string());
        account.summary.units = options.units.as_ref().map(Units::to_string);
        let grid = BodyGrid::new(parts.mesh)?;
        let directory = directory.to_path_buf();
        let (spent, told) = (Duration::ZERO, Instant::now());
        Ok(Self {
            directory,
            options,
            origin,
            grid,
            frames: Frames::new(series),
            modes: None,
            history,
            readings,
            probes,
            exports,
            account,
            spent,
            told,
        })
    }

    /// Writes what is due after an accepted increment, whose frame it is. `last` says that it ended its step.
    ///
    /// # Errors
    /// [`Error::File`] when something cannot be written.
    pub fn accepted(&mut self, source: &Source, frame: Frame, last: bool) -> Result<(), Error> {
        let start = Instant::now();
        let increment = source.state.increment;
        self.history.push(&frame)?;
        self.readings.push(&frame)?;
        self.probes.iter_mut().try_for_each(|probe| probe.push(&frame))?;
        self.account.accepted(source, &frame);
        if last || increment.is_multiple_of(self.options.every) {
            self.write_grids(source, frame)?;
        }
        if last || increment.is_multiple_of(self.options.checkpoint_every) {
            self.checkpoint(source.state)?;
            if self.options.keep == Keep::All || (last && self.options.keep == Keep::Steps) {
                make_directory(&self.directory.join(KEPT))?;
                write_checkpoint(&kept::path_of(&self.directory, increment), &self.origin, source.state)?;
            }
        }
        if self.told.elapsed() > BETWEEN || last {
            self.told = Instant::now();
            self.write_summary_as(Durability::Process)?;
        }
        self.spent += start.elapsed();
        Ok(())
    }
    /// Writes a frame of the bodies with a mode on all unknowns.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written.
    pub fn mode(&mut self, source: &Source, mode: &[f64]) -> Result<(), Error> {
        if self.modes.is_none() {
            self.modes = Some(PvdSeries::create(&self.directory, MODES, self.options.encoding)?);
        }
        let mut grid = self.grid.at(&mut source.gather()?);
        grid.point_data.push(DataArray::new("mode", 3, Values::Real(source.nodal_field(mode))));
        self.modes.as_mut().map_or(Ok(()), |series| series.push(&grid))
    }
    /// Writes a checkpoint of an accepted state.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written; the one before then still stands.
    pub fn checkpoint(&self, state: &State) -> Result<(), Error> {
        // A run that goes on from it has all frames before it.
        self.frames.lock().unwrap_or_else(PoisonError::into_inner).wait()?;
        write_checkpoint(&self.directory.join(CHECKPOINT), &self.origin, state)
    }
    /// Waits for what is still being written.
    ///
    /// # Errors
    /// [`Error::File`] when that could not be written.
    pub fn settle(&mut self) -> Result<(), Error> {
        let begun = Instant::now();
        let written = self.frames.get_mut().unwrap_or_else(PoisonError::into_inner).wait();
        self.spent += begun.elapsed();
        written
    }
    /// Says in the summary how the run ended, and draws the standard pictures where they are wanted. A picture that cannot be drawn is a note
    /// in the summary and no failure of the run.
    ///
    /// # Errors
    /// [`Error::File`] when the summary cannot be written.
    pub fn finish(&mut self, outcome: &Result<(), Error>) -> Result<(), Error> {
        self.account.end(outcome);
        self.account.summary.timings.insert("output".into(), self.spent.as_secs_f64());
        remove(&self.directory, [RESERVE.to_owned()])?;
        self.write_summary()?;
        if !self.options.pictures {
            return Ok(());
        }
        let start = Instant::now();
        if let Err(error) = draw_standard(&self.directory, &FigureOptions::default()) {
            self.account.summary.notes.push(format!("a picture is missing: {error}"));
        }
        self.account.summary.timings.insert("pictures".into(), start.elapsed().as_secs_f64());
        self.write_summary()
    }
    /// The result directory.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    fn write_grids(&mut self, source: &Source, mut frame: Frame) -> Result<(), Error> {
        self.exports.push(source, &frame)?;
        let mut moved = None;
        let frames = self.frames.get_mut().unwrap_or_else(PoisonError::into_inner);
        let grids = frames.fields.iter().map(|fields| {
            Ok(match fields {
                Fields::Bodies => {
                    let grid = self.grid.at(&mut frame);
                    moved = self.options.export.contains(&Export::Deformed).then(|| deformed(&grid));
                    grid
                }
                Fields::Points => cloud(&mut frame, QuantityPlace::Gauss),
                Fields::Contacts => cloud(&mut frame, QuantityPlace::Contact),
                Fields::Surfaces => surfaces(source, &mut frame)?,
                Fields::Tools => tools(source, &frame),
                Fields::Deformed => moved.take().unwrap_or_default(),
            })
        });
        let grids = grids.collect::<Result<_, Error>>()?;
        frames.push(grids)
    }
    pub(super) fn write_summary(&mut self) -> Result<(), Error> {
        self.write_summary_as(Durability::Machine)
    }
    fn write_summary_as(&mut self, durability: Durability) -> Result<(), Error> {
        self.account.summary.files = self.present_files();
        self.account.certify();
        self.account.summary.write_as(&self.directory.join(SUMMARY), durability)
    }
    /// The result files that are there, without the frames that a `.pvd` lists.
    fn present_files(&self) -> Vec<String> {
        let frames = self.frames.lock().unwrap_or_else(PoisonError::into_inner);
        let frames = frames.fields.iter().map(|fields| format!("{}.pvd", fields.name())).collect::<Vec<_>>();
        let frames = frames.into_iter();
        let tables =
            [MODES_LIST, HISTORY, READINGS, "increments.csv", "iterations.csv", CHECKPOINT, SUMMARY, PROGRESS, ASKED]
                .map(String::from);
        let probes = self.options.probes.iter().map(|probe| ProbeTable::file(&probe.name));
        let others = probes.chain([FRD, XDMF, DAT].map(String::from));
        let all = frames.chain(tables).chain(others).chain(pictures());
        all.filter(|name| self.directory.join(name).exists()).collect()
    }
}

fn write_checkpoint(path: &Path, Origin { input, parts, terms }: &Origin, state: &State) -> Result<(), Error> {
    let stamp = Stamp { step: state.step as u64, increment: state.increment as u64, time: state.time };
    // As the fields of `Kept`.
    checkpoint::save(path, &Head { input: *input, stamp }, &(parts, terms, state))
}

/// The tables that grow by rows, and the files for other programs.
type Tables = (HistoryTable, ReadingTable, Vec<ProbeTable>, Exports);

/// The tables that probes of an earlier run left.
/// The tables of probes in a result directory.
pub(super) fn probe_tables(directory: &Path) -> Vec<String> {
    let names = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.starts_with("probe.") && name.ends_with(".csv")).collect()
}

/// The files of the standard pictures.
fn pictures() -> impl Iterator<Item = String> {
    let names = ["contact_stress", "von_mises", "forces", "convergence"].into_iter();
    names.flat_map(|name| [format!("{name}.svg"), format!("{name}.png")])
}

/// The kinds of frames that a model has.
fn fields_of(parts: &Parts, options: &ResultOptions) -> impl Iterator<Item = Fields> + use<> {
    let (contacts, tools) = (!parts.contacts.is_empty(), !parts.tool_names().is_empty());
    let deformed = options.export.contains(&Export::Deformed);
    Fields::ALL.into_iter().filter(move |fields| match fields {
        Fields::Bodies | Fields::Points => true,
        Fields::Contacts | Fields::Surfaces => contacts,
        Fields::Tools => tools,
        Fields::Deformed => deformed,
    })
}

#[cfg(test)]
mod tests {
    use super::super::checkpoint::InputHash;
    use super::super::export::{Printed, Totals, Whose};
    use super::super::fixture::Fixture;
    use super::super::input::Kept;
    use super::super::probe::{At, Share, Take};
    use super::super::summary::{RunStatus, Summary};
    use super::super::vtk::{read_grid, read_series};
    use super::*;
    use asperity_core::mesh::Space;
    use asperity_core::solid::{Formulation, Integration};

    fn options() -> ResultOptions {
        let export = vec![Export::Frd, Export::Xdmf, Export::Deformed];
        let nodes = Whose::Nodes("block.left".into());
        let printed = Printed { whose: nodes, quantities: vec!["displacement".into()], totals: Totals::Yes };
        let whole = Take::ALL.map(|(take, _)| take).to_vec();
        let at = At::Nodes(vec![Share { node: 0, part: 1.0 }, Share { node: 1, part: 2.0 }], whole);
        let probe = Probe { name: "corner".into(), at, quantities: vec!["reaction".into()] };
        let units = Units::parse("N, mm, s").ok();
        let default = ResultOptions::default();
        ResultOptions {
            every: 2,
            checkpoint_every: 3,
            export,
            probes: vec![probe],
            printed: vec![printed],
            units,
            ..default
        }
    }

    fn states(fixture: &Fixture) -> Vec<State> {
        let step = |before: &State, i: i32| Some(fixture.after(before, 0.2 * f64::from(i)));
        (1..=5).scan(fixture.start(), |state, i| step(state, i).inspect(|next| *state = next.clone())).collect()
    }

    fn fixture() -> Fixture {
        Fixture::new(Space::Axisymmetric, Formulation::Standard, Integration::Reduced)
    }

    fn origin() -> Origin {
        Origin { input: InputHash::of(&[b"deck"]), ..Origin::default() }
    }

    /// Writes the increments after the first `done`.
    fn write(results: &mut Results, fixture: &Fixture, done: usize, until: usize) {
        let parts = fixture.parts();
        for state in &states(fixture)[done..until] {
            let source = Source { parts: &parts, state, step: 0 };
            results.accepted(&source, source.gather().unwrap(), state.increment == 5).unwrap();
        }
    }

    fn begin(directory: &Path, fixture: &Fixture) -> Results {
        let (parts, state) = (fixture.parts(), fixture.start());
        Results::create(directory, &Source { parts: &parts, state: &state, step: 0 }, options(), origin()).unwrap()
    }

    #[test]
    fn what_an_earlier_run_wrote_at_its_end_is_gone_from_the_start() {
        let directory = tempfile::tempdir().unwrap();
        let late = [CHECKPOINT, HISTORY, "forces.svg", "von_mises.png"].map(|name| directory.path().join(name));
        late.iter().for_each(|path| std::fs::write(path, "of another run").unwrap());
        begin(directory.path(), &fixture());
        assert!(late.iter().all(|path| !path.exists()));
    }

    #[test]
    fn frames_come_as_often_as_asked_and_the_last_always() {
        let directory = tempfile::tempdir().unwrap();
        let fixture = fixture();
        let mut results = begin(directory.path(), &fixture);
        write(&mut results, &fixture, 0, 5);
        results.finish(&Ok(())).unwrap();
        let frames = read_series(&directory.path().join("bodies.pvd")).unwrap();
        assert_eq!(frames.iter().map(|(time, _)| *time).collect::<Vec<_>>(), [0.0, 2.0, 4.0, 5.0]);
        let summary = Summary::read(&directory.path().join(SUMMARY)).unwrap();
        assert_eq!((summary.status, summary.increments), (RunStatus::Converged, 5));
        assert_eq!(summary.bodies, ["block"]);
        assert_eq!(summary.files[..4], ["bodies.pvd", "points.pvd", "deformed.pvd", "history.csv"]);
        assert_eq!(summary.files[4..7], [READINGS, CHECKPOINT, SUMMARY]);
        assert!(summary.files.contains(&"von_mises.png".into()) && summary.notes.is_empty(), "{summary:?}");
        assert!(summary.files.iter().all(|file| directory.path().join(file).exists()));
    }

    /// What the store holds is what the file says, to the bit.
    #[test]
    fn a_frame_is_in_the_file_as_in_the_store() {
        let directory = tempfile::tempdir().unwrap();
        let fixture = fixture();
        write(&mut begin(directory.path(), &fixture), &fixture, 0, 5);
        let (parts, states) = (fixture.parts(), states(&fixture));
        let frame = Source { parts: &parts, state: &states[4], step: 0 }.gather().unwrap();
        let last = |name: &str| {
            let frames = read_series(&directory.path().join(format!("{name}.pvd"))).unwrap();
            read_grid(&directory.path().join(&frames.last().unwrap().1)).unwrap()
        };
        let (bodies, points) = (last("bodies"), last("points"));
        let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let mut compared = 0;
        for (place, arrays) in [
            (QuantityPlace::Node, &bodies.point_data),
            (QuantityPlace::Cell, &bodies.cell_data),
            (QuantityPlace::Gauss, &points.point_data),
        ] {
            for quantity in frame.at(place).filter(|q| q.name != "reference_position") {
                let array = arrays.iter().find(|array| array.name == quantity.name).unwrap();
                assert_eq!(bits(&array.values.to_real()), bits(&quantity.values), "{}", quantity.name);
                compared += 1;
            }
        }
        assert!(compared > 10);
    }

    #[test]
    fn a_resumed_run_writes_the_same_files() {
        let (whole, cut) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let fixture = fixture();
        write(&mut begin(whole.path(), &fixture), &fixture, 0, 5);
        write(&mut begin(cut.path(), &fixture), &fixture, 0, 4);
        let (head, kept) = checkpoint::read::<Kept>(&cut.path().join(CHECKPOINT)).unwrap();
        let state = kept.state;
        assert_eq!((head.stamp.increment, &state), (3, &states(&fixture)[2]));
        let parts = fixture.parts();
        let source = Source { parts: &parts, state: &state, step: 0 };
        let mut results = Results::resume(cut.path(), &source, options(), origin()).unwrap();
        let balance = results.account.certificate.figure("energy_balance");
        assert!(balance.is_some(), "the certificate covers the rows before the restart");
        write(&mut results, &fixture, 3, 5);
        let others = [FRD, XDMF, DAT, "probe.corner.csv", "deformed/deformed_000003.vtu"];
        let names = ["history.csv", READINGS, "bodies.pvd", "bodies/bodies_000003.vtu", "points/points_000002.vtu"];
        for name in names.into_iter().chain(others) {
            let read = |directory: &tempfile::TempDir| std::fs::read(directory.path().join(name)).unwrap();
            assert_eq!(read(&whole), read(&cut), "{name}");
        }
    }
}
