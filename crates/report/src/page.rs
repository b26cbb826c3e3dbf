//! The page, put together.

use crate::body::Body;
use crate::folder::Folder;
use crate::html::{escape, script_json};
use crate::sections;
use crate::tables::Table;
use asperity_core::Error;
use asperity_results::output::figure::field_color;
use asperity_results::output::file::{Durability, write_atomic};
use asperity_results::output::{Columns, FIGURES, REPORT, SUMMARY, Summary};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::Instant;

const STYLE: &str = include_str!("../assets/page.css");
const SCRIPT: &str = concat!(
    "(() => {\n'use strict';\n",
    include_str!("../assets/base.js"),
    include_str!("../assets/pack.js"),
    include_str!("../assets/chart.js"),
    include_str!("../assets/scene.js"),
    include_str!("../assets/view.js"),
    include_str!("../assets/tables.js"),
    include_str!("../assets/live.js"),
    include_str!("../assets/main.js"),
    "})();\n"
);

/// Attempts whose iterations are on the page, the last ones.
const ATTEMPTS: usize = 60;
/// Colours of the scale of fields.
const COLORS: usize = 33;

/// What a page needs that follows a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Live {
    /// What the server asks for with each request.
    pub token: String,
}

/// Writes `report.html` into a result directory and returns its path.
///
/// # Errors
/// [`Error::File`] when a result cannot be read, [`Error::Write`] when the page cannot be written.
pub fn write(directory: &Path) -> Result<PathBuf, Error> {
    let path = directory.join(REPORT);
    write_atomic(&path, page(directory, None)?.as_bytes(), Durability::Process)?;
    Ok(path)
}

/// Writes `report.html` at the end of a run and adds it to the summary there; that it cannot be written is a note and no
/// failure of the run.
pub fn conclude(summary: &mut Summary, directory: &Path) {
    let begun = Instant::now();
    if let Err(error) = write(directory) {
        summary.notes.push(format!("the report is missing: {error}"));
    } else if !summary.files.iter().any(|file| file == REPORT) {
        summary.files.push(REPORT.into());
    }
    summary.timings.insert("report".into(), begun.elapsed().as_secs_f64());
    if let Err(error) = summary.write(&directory.join(SUMMARY)) {
        summary.notes.push(error.to_string());
    }
}

/// The page of a result directory; with `live` one that follows the run.
///
/// # Errors
/// [`Error::File`] when a result cannot be read.
pub fn page(directory: &Path, live: Option<&Live>) -> Result<String, Error> {
    let folder = Folder::read(directory)?;
    let (body, blobs) = Body::of(&folder)?.map_or((None, Vec::new()), |(body, blobs)| (Some(body), blobs.0));
    let data = script_json(&Data::of(&folder, body, live)?)?;
    let blobs: String = blobs
        .iter()
        .enumerate()
        .map(|(i, text)| format!("<script type=\"text/plain\" id=\"blob-{i}\">{text}</script>\n"))
        .collect();
    let title = sections::title(&folder);
    let print = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    let connect = if live.is_some() { "'self'" } else { "'none'" };
    let policy = format!(
        "default-src 'none'; script-src {}; style-src {}; img-src data: blob:; connect-src {connect}; base-uri 'none'; form-action 'none'",
        print(SCRIPT),
        print(STYLE)
    );
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n\
         <link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{}\
         <script type=\"application/json\" id=\"data\">{data}</script>\n{blobs}<script>{SCRIPT}</script>\n</body>\n</html>\n",
        escape(&title),
        sections::all(&folder, live.is_some()),
    ))
}

/// The frames that are there now, as JSON: `body` and the texts of its arrays, `blobs`.
///
/// # Errors
/// [`Error::File`] when a result cannot be read.
pub fn body(directory: &Path) -> Result<String, Error> {
    let found = Body::of(&Folder::read(directory)?)?;
    let (body, blobs) = found.map_or((None, Vec::new()), |(body, blobs)| (Some(body), blobs.0));
    Ok(json!({ "body": body, "blobs": blobs }).to_string())
}

/// How a run stands, as JSON: `progress` is what `status.json` says, `runs` whether a process is at work, `frames` how many
/// were written.
///
/// # Errors
/// [`Error::File`] when a result cannot be read.
pub fn status(directory: &Path) -> Result<String, Error> {
    let folder = Folder::read(directory)?;
    let frames = folder.frames("bodies")?.0.len();
    Ok(json!({ "progress": folder.progress, "runs": folder.runs, "frames": frames }).to_string())
}

/// The rows that `history.csv`, `increments.csv` or `iterations.csv` got from a byte on, as JSON: `table`, `from` where they
/// begin, 0 where the file is not the one that was read before, and `next` where they end.
///
/// # Errors
/// [`Error::Input`] for another table, [`Error::File`] when it cannot be read.
pub fn rows(directory: &Path, table: &str, from: u64) -> Result<String, Error> {
    if !["history", "increments", "iterations"].contains(&table) {
        return Err(Error::input(format!("there is no table '{table}'")));
    }
    let path = directory.join(format!("{table}.csv"));
    let (columns, from, next) = if path.exists() { grown(&path, from)? } else { (Columns::default(), 0, 0) };
    Ok(json!({ "table": shown(table, &columns), "from": from, "next": next }).to_string())
}

/// The whole rows of a table from a byte on.
fn grown(path: &Path, from: u64) -> Result<(Columns, u64, u64), Error> {
    let failed = |error: std::io::Error| Error::file(path, error);
    let mut file = BufReader::new(File::open(path).map_err(failed)?);
    let mut bytes = Vec::new();
    let header = file.read_until(b'\n', &mut bytes).map_err(failed)? as u64;
    let length = file.get_ref().metadata().map_err(failed)?.len();
    let from = if from < header || from > length { 0 } else { from };
    file.seek(SeekFrom::Start(from.max(header))).map_err(failed)?;
    file.take(length.saturating_sub(from.max(header))).read_to_end(&mut bytes).map_err(failed)?;
    let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    bytes.truncate(whole);
    let next = from.max(header) + (whole as u64).saturating_sub(header);
    Ok((Columns::parse(path, &bytes)?, from, next))
}

/// What the scripts of the page read.
#[derive(Debug, Serialize)]
struct Data {
    title: String,
    space: String,
    reason: Option<String>,
    body: Option<Body>,
    colors: Vec<String>,
    worst: Vec<Value>,
    history: Table,
    increments: Table,
    iterations: Table,
    live: Option<Value>,
}

impl Data {
    fn of(folder: &Folder, body: Option<Body>, live: Option<&Live>) -> Result<Self, Error> {
        let summary = &folder.summary;
        let color = |i: usize| {
            let [r, g, b] = field_color(i as f64 / (COLORS - 1) as f64).0;
            format!("#{r:02x}{g:02x}{b:02x}")
        };
        let table = |name: &str| Ok::<_, Error>(shown(name, &folder.table(&format!("{name}.csv"))?));
        Ok(Self {
            title: summary.title.clone(),
            space: summary.space.clone(),
            reason: summary.reason.clone(),
            body,
            colors: (0..COLORS).map(color).collect(),
            worst: worst(summary),
            history: table("history")?,
            increments: table("increments")?,
            iterations: table("iterations")?,
            live: live.map(|live| json!({ "token": live.token })),
        })
    }
}

/// What the page shows of a table: of the iterations those of the last attempts, and a few columns.
fn shown(name: &str, all: &Columns) -> Table {
    if name != "iterations" {
        return Table::of(all, |_| true, |_| true);
    }
    let (first, told) = (last_attempts(all), ["increment", "attempt", "iteration", "residual", "tolerance", "worst"]);
    Table::of(all, |column| told.contains(&column), |row| row >= first)
}

/// The row with which the last attempts begin.
fn last_attempts(iterations: &Columns) -> usize {
    let Some(iteration) = iterations.numbers("iteration") else { return 0 };
    let starts: Vec<usize> = (0..iteration.len()).filter(|&row| iteration[row] == 0.0).collect();
    starts.len().checked_sub(ATTEMPTS).map_or(0, |at| starts[at])
}

/// The places where figures were worst.
fn worst(summary: &Summary) -> Vec<Value> {
    let place = |figure: &asperity_results::output::Figure| {
        let worst = summary.worst.get(figure.name)?;
        let position = worst.position?;
        Some(json!({ "name": figure.name, "words": figure.words.trim(), "position": position, "time": worst.time }))
    };
    FIGURES.iter().filter_map(place).collect()
}
