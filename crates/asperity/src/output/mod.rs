//! Results: one store of quantities a frame, and the files, tables and pictures made from it. Layer 6; it reads the
//! model and its state and never changes them, so that asking for an output cannot change a solution.

mod certificate;
pub mod checkpoint;
pub mod figure;
pub mod file;
mod history;
mod quantity;
mod summary;
mod table;
pub mod vtk;

pub use certificate::Certificate;
pub use history::{HistoryTable, global_columns};
pub use quantity::{Frame, Number, Place, Quantity, Unit, Width};
pub use summary::{Status, Summary};
pub use table::{Columns, Field, Table};
