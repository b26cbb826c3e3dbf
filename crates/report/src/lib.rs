//! One page of HTML from the results of a run: what was asked, what came, how far it can be trusted, how it went, and the
//! body to be turned about. The page needs nothing besides itself: no server, no network, no other file. It reads the files
//! of a result directory and nothing else, and computes nothing of mechanics.
//!
//! | file | what |
//! | --- | --- |
//! | `folder` | the result directory, read |
//! | `body` | bodies, contact points and tools as packed arrays, a value for each frame |
//! | `pack` | numbers as text: quantised, predicted, deflated, base64 |
//! | `sections` | what is text: it is there without scripts too |
//! | `page` | everything put together |
//! | `assets` | style and scripts of the page |
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod body;
mod folder;
mod html;
mod pack;
mod page;
mod sections;
mod tables;

pub use page::{Live, body, conclude, page, rows, status, write};
