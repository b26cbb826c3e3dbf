//! Results: one store of quantities a frame, and the files, tables and pictures made from it. Layer 6; it reads the
//! model and its state and never changes them, so that asking for an output cannot change a solution.

mod account;
mod asked;
mod average;
mod certificate;
pub mod checkpoint;
mod claim;
mod closing;
mod export;
pub mod figure;
mod figures;
pub mod file;
#[cfg(test)]
mod fixture;
mod grids;
mod history;
mod input;
mod kept;
mod log;
mod options;
pub mod probe;
mod progress;
mod quantities;
mod quantity;
mod readings;
mod recorder;
mod results;
mod simulate;
pub mod study;
mod summary;
mod table;
mod units;
pub mod vtk;
mod witness;

pub use account::Account;
pub use asked::{ASKED, Asked};
pub use certificate::{Certificate, Doubt, Limits, Occasion, Reading};
pub use claim::{Others, ResultsClaim, is_claimed};
pub use export::{DAT, Export, FRD, Printed, Totals, Whose, XDMF};
pub use figures::{FIGURES, Figure, Fold, Limit};
pub use grids::{BodyGrid, cloud, tools as tool_outlines};
pub use history::{HistoryTable, global_columns};
pub use input::{Kept, Origin, Part, resumed};
pub use kept::{Keep, Resume, branch};
pub use log::RunLog;
pub use options::ResultOptions;
pub use probe::{Probe, ProbeTable};
pub use progress::{PROGRESS, Progress, Request};
pub use quantities::{Parts, Source};
pub use quantity::{Frame, Number, Quantity, QuantityPlace, Unit, Width};
pub use results::{CHECKPOINT, REPORT, Results, SUMMARY};
pub use simulate::{Begun, Ended, Job, Simulation, Start, simulate};
pub use summary::{RunStatus, Summary};
pub use table::{Columns, Field, Table};
pub use units::Units;
