//! Times faer's sparse LU on a Matrix Market file, one thread: prints the same line as frontal's `market` example.

#[path = "../../../frontal/benches/measure/mod.rs"]
mod measure;

use measure::{peak, timed};
use std::error::Error;
use std::fs::File;
use std::io::BufReader;

fn main() -> Result<(), Box<dyn Error>> {
    faer::set_global_parallelism(faer::Par::Seq);
    let path = std::env::args().nth(1).ok_or("usage: faer_lu matrix.mtx")?;
    let (pattern, values) = frontal::market::read(BufReader::new(File::open(path)?))?;
    let matrix = oracles::matrix(&pattern, &values);
    let (symbolic, analysis) = timed(|| oracles::analyse(&matrix));
    let (factor, first) = timed(|| oracles::factorise(&symbolic, &matrix));
    let factor = factor.map_err(|error| format!("{error:?}"))?;
    let mut x = vec![1.0; pattern.len()];
    let (_, solve) = timed(|| oracles::solve(&factor, &mut x));
    let [analysis, first, solve] = [analysis, first, solve].map(|time| time.processor);
    println!("faer {} {analysis:.4} {first:.4} {first:.4} {solve:.5} {} -", pattern.len(), peak());
    Ok(())
}
