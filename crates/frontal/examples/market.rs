//! Times the solver on a Matrix Market file, or writes one of the test models:
//!
//! ```text
//! cargo run --release -p frontal --example market -- solve matrix.mtx 3      (3 unknowns a node)
//! cargo run --release -p frontal --example market -- write hex8 32 matrix.mtx
//! ```
//! `solve` prints one line: solver, unknowns, analysis, first and second factorisation and a bare solve in seconds of
//! processor time, peak memory in kB, backward error.

#[path = "../benches/measure/mod.rs"]
mod measure;
#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{Options, Symbolic, market};
use measure::{peak, timed};
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = std::env::args().skip(1).collect::<Vec<_>>();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["solve", path] => solve(path, 1),
        ["solve", path, block] => solve(path, block.parse()?),
        ["write", kind, size, path] => write(kind, size.parse()?, path),
        _ => Err("usage: market solve FILE [BLOCK] | market write hex8|quad8|bordered SIZE FILE".into()),
    }
}

fn write(kind: &str, size: usize, path: &str) -> Result<(), Box<dyn Error>> {
    let model = models::named(kind, size);
    Ok(market::write(BufWriter::new(File::create(path)?), &model.pattern, &model.values)?)
}

fn solve(path: &str, block: usize) -> Result<(), Box<dyn Error>> {
    let (pattern, values) = market::read(BufReader::new(File::open(path)?))?;
    let pattern = if block > 1 { pattern.with_block(block)? } else { pattern };
    let n = pattern.len();
    let (symbolic, analysis) = timed(|| Symbolic::analyse(&pattern, &Options::default()));
    let symbolic = symbolic?;
    let (factor, first) = timed(|| {
        let mut factor = symbolic.new_factor();
        symbolic.factorise(&values, &mut factor).map(|_| factor)
    });
    let mut factor = factor?;
    let (report, second) = timed(|| symbolic.factorise(&values, &mut factor));
    report?;
    let mut x = vec![1.0; 10 * n];
    let (accuracy, solves) = timed(|| factor.solve(&mut x));
    let (error, solve) = (accuracy?.backward_error, 0.1 * solves.processor);
    let [analysis, first, second] = [analysis, first, second].map(|time| time.processor);
    println!("frontal {n} {analysis:.4} {first:.4} {second:.4} {solve:.5} {} {error:.1e}", peak());
    Ok(())
}
