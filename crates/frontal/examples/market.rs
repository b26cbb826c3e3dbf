//! Times the solver on a Matrix Market file, or writes one of the test models:
//!
//! ```text
//! cargo run --release -p frontal --example market -- solve matrix.mtx 3      (3 unknowns a node)
//! cargo run --release -p frontal --example market -- write hex8 32 matrix.mtx
//! ```
//! With `symmetric` at the end the model is written without its skew part, and solved as L D L^T. `solve` prints one line: solver, unknowns, analysis, first and second factorisation and a bare solve in seconds of
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
        ["solve", path] => solve(path, 1, false),
        ["solve", path, block] => solve(path, block.parse()?, false),
        ["solve", path, block, "symmetric"] => solve(path, block.parse()?, true),
        ["write", kind, size, path] => write(kind, size.parse()?, path, false),
        ["write", kind, size, path, "symmetric"] => write(kind, size.parse()?, path, true),
        _ => {
            Err("usage: market solve FILE [BLOCK [symmetric]] | market write hex8|quad8|bordered SIZE FILE [symmetric]"
                .into())
        }
    }
}

fn write(kind: &str, size: usize, path: &str, symmetric: bool) -> Result<(), Box<dyn Error>> {
    let mut model = models::named(kind, size);
    if symmetric {
        model.symmetrise();
    }
    Ok(market::write(BufWriter::new(File::create(path)?), &model.pattern, &model.values)?)
}

fn solve(path: &str, block: usize, symmetric: bool) -> Result<(), Box<dyn Error>> {
    let (pattern, values) = market::read(BufReader::new(File::open(path)?))?;
    let pattern = if block > 1 { pattern.with_block(block)? } else { pattern };
    let n = pattern.len();
    let mut options = Options::default();
    options.symmetric = symmetric;
    let (symbolic, analysis) = timed(|| Symbolic::analyse(&pattern, &options));
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
    let name = if symmetric { "frontal-ldlt" } else { "frontal" };
    println!("{name} {n} {analysis:.4} {first:.4} {second:.4} {solve:.5} {} {error:.1e}", peak());
    Ok(())
}
