//! Ranks that evaluate a model together come to the bits of one that is alone: the rows of the matrix that they own, forces, histories,
//! energies, branches, and what fails.

use asperity::deck::{self, Made};
use asperity::system::{Assembly, Communicator, Evaluation, Instant, Tangent, Trial, Workspace};
use asperity::{Failure, FailureKind};
use std::sync::{Barrier, Mutex};

/// What threads that stand for ranks tell each other.
struct Board {
    barrier: Barrier,
    pieces: Mutex<Vec<Vec<f64>>>,
}

/// One of them.
struct Rank {
    number: usize,
    board: &'static Board,
}

impl Rank {
    fn all(size: usize) -> Vec<&'static Self> {
        let board = Board { barrier: Barrier::new(size), pieces: Mutex::new(vec![Vec::new(); size]) };
        let board: &Board = Box::leak(Box::new(board));
        (0..size).map(|number| &*Box::leak(Box::new(Self { number, board }))).collect()
    }
    fn told(&self, piece: &[f64]) -> Vec<Vec<f64>> {
        self.board.pieces.lock().unwrap()[self.number] = piece.to_vec();
        self.board.barrier.wait();
        let pieces = self.board.pieces.lock().unwrap().clone();
        self.board.barrier.wait();
        pieces
    }
}

impl Communicator for Rank {
    fn rank(&self) -> usize {
        self.number
    }
    fn size(&self) -> usize {
        self.board.pieces.lock().unwrap().len()
    }
    fn agree(&self, numbers: &[f64]) -> Result<(), String> {
        let same = self.told(numbers).iter().all(|others| others == numbers);
        if same { Ok(()) } else { Err("apart".into()) }
    }
    fn gather(&self, piece: &[f64]) -> Result<(Vec<f64>, Vec<usize>), String> {
        let pieces = self.told(piece);
        let ends = pieces.iter().scan(0, |end, piece| {
            *end += piece.len();
            Some(*end)
        });
        Ok((pieces.concat(), std::iter::once(0).chain(ends).collect()))
    }
    fn collect(&self, piece: &[f64]) -> Result<Vec<f64>, String> {
        let whole = self.told(piece).concat();
        Ok(if self.number == 0 { whole } else { Vec::new() })
    }
}

/// Two blocks with friction between them and a punch that a load presses, so that its unknowns are free.
const BLOCKS: &str = r#"
version = 1
space = "solid"
mesh.part.below.box = { from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [6, 6, 6], cell = "hex8" }
mesh.part.above.box = { from = [0.1, 0.1, 1.0], to = [0.9, 0.9, 1.5], cells = [5, 5, 3], cell = "hex8" }
material.soft.elastic = { young = 100.0, poisson = 0.3 }
material.metal.von_mises = { young = 200.0, poisson = 0.3, yield_stress = 0.5, hardening = 10.0 }
body.below.material = "soft"
body.above.material = "metal"
tool.ball.sphere = { center = [0.5, 0.5, 2.5], radius = 1.0 }
contact.between = { surface = "above.back", target = "below.front", law.coulomb = { friction = 0.3 } }
contact.ball = { surface = "above.front", target = "ball", law.coulomb = { friction = 0.3 } }
[[step]]
displacement."below.back" = { x = 0.0, y = 0.0, z = 0.0 }
motion.ball = { x = 0.01 }
load.ball = { z = -0.5 }
increments.count = 2
"#;

/// A motion that closes contacts and makes cells flow; `depth` is how far the upper block sinks in.
fn moved(made: &Made, depth: f64) -> Vec<f64> {
    let problem = &made.model.problem;
    let mut u = vec![0.0; problem.dofs.count()];
    for (node, x) in problem.wholes.iter().flat_map(|whole| whole.places()) {
        let first = problem.dofs.node(*node);
        let wave = |k: f64| 1e-3 * (k + 7.0 * x[0] + 5.0 * x[1] + 3.0 * x[2]).sin();
        (0..3).for_each(|axis| u[first + axis] = wave(axis as f64));
        if x[2] >= 1.0 && x[0] > 0.05 {
            u[first + 2] -= depth * x[2];
        }
    }
    u
}

/// What a rank finds.
struct Found {
    own: std::ops::Range<usize>,
    rows: Vec<(Vec<usize>, Vec<u64>)>,
    evaluation: Evaluation,
}

fn evaluate(made: &Made, u: &[f64], tangent: Tangent, rank: Option<&'static Rank>) -> Result<Found, Failure> {
    let problem = &made.model.problem;
    let state = problem.initial_state();
    let at = Instant { step: 0, step_time: 0.5, time: 0.5, dt: 0.5, factor: None };
    let open = problem.terms.iter().zip(&state.histories).map(|(term, history)| term.attempt(&state, history, at));
    let attempts = open.collect::<Result<Vec<_>, _>>()?;
    let (terms, dofs, constraints) = (&problem.terms, &problem.dofs, &problem.steps[0].constraints);
    let assembly = Assembly { terms, attempts, dofs, constraints, apart: 0..terms.len() };
    let mut workspace = Workspace::of(rank.map(|rank| rank as &dyn Communicator));
    workspace.prepare(&assembly, &state)?;
    let mut evaluation = Evaluation::new(terms, &state);
    let missing: Vec<f64> = (0..u.len()).map(|dof| if dof % 5 == 0 { 1e-3 } else { 0.0 }).collect();
    let trial = Trial { missing: Some(&missing), ..Trial::at(u, tangent) };
    workspace.evaluate(&assembly, &trial, &mut evaluation)?;
    workspace.share_histories(&mut evaluation.histories)?;
    let (own, pattern) = (workspace.shares().own(), workspace.pattern());
    let bits = |row: usize| evaluation.values[pattern.starts[row]..pattern.starts[row + 1]].iter().map(|v| v.to_bits());
    let rows = (0..pattern.rows()).map(|row| match tangent {
        Tangent::None => Default::default(),
        _ => (pattern.row(row).to_vec(), bits(row).collect()),
    });
    let rows = rows.collect();
    Ok(Found { own, rows, evaluation })
}

/// Evaluates on so many ranks.
fn together(made: &Made, u: &[f64], tangent: Tangent, size: usize) -> Vec<Result<Found, Failure>> {
    std::thread::scope(|scope| {
        let ranks = Rank::all(size).into_iter().map(|rank| scope.spawn(move || evaluate(made, u, tangent, Some(rank))));
        let ranks: Vec<_> = ranks.collect();
        ranks.into_iter().map(|rank| rank.join().unwrap()).collect()
    })
}

fn made() -> Made {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deck.toml");
    std::fs::write(&path, BLOCKS).unwrap();
    deck::load(&path, &[]).and_then(deck::build).unwrap_or_else(|d| panic!("{}", d.render(false)))
}

#[test]
fn ranks_find_the_bits_of_one() {
    let made = made();
    let u = moved(&made, 0.01);
    for tangent in [Tangent::Exact, Tangent::None] {
        let alone = evaluate(&made, &u, tangent, None).unwrap();
        assert!(alone.evaluation.branches.iter().flatten().any(|(branch, _)| *branch > 0), "something is in contact");
        for size in [1, 2, 3, 5] {
            let mut next = 0;
            for found in together(&made, &u, tangent, size) {
                let (found, one) = (found.unwrap(), &alone.evaluation);
                assert_eq!(found.own.start, next);
                next = found.own.end;
                for (row, (mine, its)) in found.rows.iter().zip(&alone.rows).enumerate() {
                    assert_eq!(mine, if found.own.contains(&row) { its } else { const { &(Vec::new(), Vec::new()) } });
                }
                let Evaluation { internal, load, magnitude, carried, apart, .. } = &found.evaluation;
                assert_eq!(
                    [internal, load, magnitude, carried],
                    [&one.internal, &one.load, &one.magnitude, &one.carried]
                );
                assert_eq!((apart, &found.evaluation.histories), (&one.apart, &one.histories));
                assert_eq!((&found.evaluation.energies, &found.evaluation.branches), (&one.energies, &one.branches));
            }
            assert_eq!(next, alone.rows.len());
        }
    }
}

#[test]
fn what_fails_on_one_rank_fails_on_all_as_on_one() {
    let made = made();
    let mut u = moved(&made, 0.01);
    // Turns a cell of the upper block inside out, which the first ranks do not own.
    let last = made.model.problem.wholes.iter().flat_map(|whole| whole.places()).map(|(node, _)| *node).max().unwrap();
    u[made.model.problem.dofs.node(last) + 2] -= 5.0;
    let alone = evaluate(&made, &u, Tangent::Exact, None).err().expect("a cell is turned inside out");
    assert_eq!(alone.kind, FailureKind::Inverted);
    for failure in together(&made, &u, Tangent::Exact, 3) {
        let failure = failure.err().unwrap();
        assert_eq!((failure.reason, failure.kind), (format!("{} (rank 2 of 3)", alone.reason), alone.kind));
    }
}

#[test]
fn ranks_that_come_with_different_motions_are_told() {
    let made = made();
    let failures = std::thread::scope(|scope| {
        let made = &made;
        let ranks = Rank::all(2).into_iter().enumerate().map(|(k, rank)| {
            scope.spawn(move || evaluate(made, &moved(made, 0.01 + 1e-3 * k as f64), Tangent::None, Some(rank)).err())
        });
        let ranks: Vec<_> = ranks.collect();
        ranks.into_iter().map(|rank| rank.join().unwrap()).collect::<Vec<_>>()
    });
    assert!(
        failures.iter().all(|failure| failure.as_ref().is_some_and(|f| f.kind == FailureKind::Apart)),
        "{failures:?}"
    );
}
