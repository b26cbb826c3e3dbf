//! How long the search of contact takes beside the rest of an iteration: a slab with 10 000 contact points under a ball
//! of 100 000 triangles.
//!
//!     cargo run --release --example search

use asperity::deck::{build, read};
use asperity::solve::{RunOptions, Silent};
use asperity::system::{Instant as At, Stencils, Term};
use std::io::Write;
use std::path::Path;
use std::time::Instant;

const DECK: &str = r#"
version = 1
space = "solid"
mesh.part.slab.box = { from = [-5.0, -5.0, -1.0], to = [5.0, 5.0, 0.0], cells = [100, 100, 2], cell = "hex8" }
material.rubber.elastic = { young = 1.0, poisson = 0.3 }
body.slab.material = "rubber"
tool.ball.stl = { file = "ball.stl", scale = 10.0, origin = [0.0, 0.0, 10.0] }
contact.top = { surface = "slab.front", target = "ball", form = "paper", law.coulomb = { friction = 0.3 } }
[[step]]
displacement."slab.back" = { x = 0.0, y = 0.0, z = 0.0 }
motion.ball = { x = 0.02, z = -0.05 }
increments.count = 1
"#;

/// A unit ball of `2 n (m - 1)` triangles as a binary STL file.
fn ball(path: &Path, n: usize, m: usize) -> std::io::Result<()> {
    let point = |i: usize, j: usize| {
        let (a, b) = (std::f64::consts::PI * i as f64 / m as f64, std::f64::consts::TAU * (j % n) as f64 / n as f64);
        let flat = if i == 0 || i == m { 0.0 } else { a.sin() };
        [flat * b.cos(), flat * b.sin(), a.cos()].map(|x| x as f32)
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
        triangles.extend((i > 0).then_some([a, b, d]));
        triangles.extend((i + 1 < m).then_some([d, b, c]));
    }
    let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
    file.write_all(&[b' '; 80])?;
    file.write_all(&(triangles.len() as u32).to_le_bytes())?;
    for triangle in triangles {
        file.write_all(&[0; 12])?;
        triangle.iter().flatten().try_for_each(|x| file.write_all(&x.to_le_bytes()))?;
        file.write_all(&[0; 2])?;
    }
    file.flush()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    ball(&folder.path().join("ball.stl"), 250, 201)?;
    let begin = Instant::now();
    let made = read(DECK, "search", folder.path(), &[]).and_then(build).map_err(|d| d.render(false))?;
    println!("deck, mesh and tree   {:9.4} s", begin.elapsed().as_secs_f64());
    let (contact, tool) = (&made.model.contacts[0], &made.model.solid_tools[0]);
    println!("triangles             {:9}", tool.facets().len());
    println!("contact points        {:9}", contact.points().len());
    let state = made.model.problem.initial_state();
    let history = &state.histories[made.model.first_contact()];
    let begin = Instant::now();
    let attempt = contact.attempt(&state, history, At { dt: 1.0, ..At::default() }).map_err(|why| why.reason)?;
    println!("opening of an attempt {:9.4} s", begin.elapsed().as_secs_f64());
    let (mut stencils, searches) = (Stencils::default(), 20);
    let begin = Instant::now();
    for _ in 0..searches {
        stencils.clear();
        attempt.stencils(&state.u, &mut stencils).map_err(|why| why.reason)?;
    }
    let search = begin.elapsed().as_secs_f64() / f64::from(searches);
    drop(attempt);
    let mut run = made.model.run(made.model.problem.initial_state());
    let begin = Instant::now();
    run.run(&RunOptions::default(), &mut Silent)?;
    let iteration = begin.elapsed().as_secs_f64() / run.state.iterations as f64;
    println!("one search            {search:9.4} s");
    println!("one iteration         {iteration:9.4} s");
    println!("part of it            {:9.4}", search / iteration);
    Ok(())
}
