//! A rigid ball that is pressed into an elastic block and then slides over it with friction: contact in space small
//! enough to stand in a test. Node by node, by a penalty and Coulomb's friction, smoothed at small slips.
#![allow(dead_code)]

use asperity::Failure;
use asperity::material::{Rate, laws::Elastic};
use asperity::mesh::generate::Block;
use asperity::mesh::{Space, cells};
use asperity::model::{Model, StepBuilder};
use asperity::solid::BodyOptions;
use asperity::solve::{AttemptRecord, Factors, NewtonOptions, Observer};
use asperity::system::{Attempt, Branch, Dofs, History, Instant, Local, State, Stencil, Stencils, Term};
use asperity::tensor::{Dual, Scalar, Vec3};
use std::sync::Arc;

const YOUNG: f64 = 100.0;
/// A few times the modulus over the depth of a cell, which is one: soft enough for the set of closed nodes to settle
/// within some iterations. With the penalties that decks have by default old factors do less often: see the manual.
const PENALTY: f64 = 400.0;
const FRICTION: f64 = 0.3;
/// Slip of an increment, in cells, at which friction is near its limit.
const CREEP: f64 = 0.02;
/// Radius, depth and travel of the ball over the edge of the block.
const RADIUS: f64 = 0.5;
const DEPTH: f64 = 0.03;
const TRAVEL: f64 = 0.1;

/// The ball.
struct Ball {
    dofs: Dofs,
    top: Vec<(usize, Vec3)>,
    /// Where it touches the block first.
    touch: Vec3,
    /// Edge of the block.
    side: f64,
}

impl Ball {
    /// Its centre: down in the first unit of time, along the first axis in the second.
    fn centre(&self, time: f64) -> Vec3 {
        let (down, along) = (time.min(1.0) * DEPTH, (time - 1.0).max(0.0) * TRAVEL);
        self.touch + Vec3([along, 0.0, RADIUS - down]) * self.side
    }
}

impl Term for Ball {
    fn name(&self) -> &str {
        "ball"
    }
    fn initial(&self) -> History {
        History::new(self.top.iter().map(|_| 0))
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        _: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let (before, now) = (self.centre(at.time - at.dt), self.centre(at.time));
        Ok(Box::new(OpenBall { ball: self, u: &accepted.u, before, now }))
    }
    fn name_of(&self, stencil: usize) -> String {
        format!("node {} under the ball", self.top[stencil].0)
    }
    fn branches(&self) -> &'static [&'static str] {
        &["open", "closed"]
    }
}

/// The ball in one increment.
struct OpenBall<'a> {
    ball: &'a Ball,
    u: &'a [f64],
    before: Vec3,
    now: Vec3,
}

impl OpenBall<'_> {
    /// Force of the ball on a node: pressure, and friction against the slip of the increment.
    fn force<T: Scalar>(&self, index: usize, u: Vec3<T>) -> Option<Vec3<T>> {
        let (node, place) = self.ball.top[index];
        let first = self.ball.dofs.node(node);
        let r = u + (place - self.now).lift();
        let (normal, penetration) = (r.unit(), -(r.norm() - RADIUS * self.ball.side));
        if penetration.re() <= 0.0 {
            return None;
        }
        let before = Vec3([self.u[first], self.u[first + 1], self.u[first + 2]]);
        let motion = u - (before + self.now - self.before).lift();
        let slip = motion - normal * motion.dot(normal);
        let smooth = (slip.dot(slip) + CREEP * CREEP).sqrt();
        let pressure = penetration * PENALTY;
        Some(normal * pressure - slip * (pressure * FRICTION / smooth))
    }
}

impl Attempt for OpenBall<'_> {
    fn scratch(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let first = |node: usize| self.ball.dofs.node(node);
        self.ball.top.iter().for_each(|&(node, _)| out.push(first(node)..first(node) + 3, 0));
        Ok(())
    }
    fn evaluate(&self, index: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let u = Vec3([0, 1, 2].map(|i| Dual::<3>::variable(local.u[i], i)));
        let Some(force) = self.force(index, u) else { return Ok(0) };
        for (i, force) in force.0.into_iter().enumerate() {
            local.force[i] = -force.re;
            if local.wants_tangent {
                (0..3).for_each(|j| local.tangent[3 * i + j] = -force.du[j]);
            }
        }
        Ok(1)
    }
}

/// The block, of so many unit cells along each edge, held at its bottom.
pub fn model(size: usize, factors: Factors) -> Model {
    let side = size as f64;
    let mesh = Arc::new(Block::new([0.0; 3], [side; 3], [size; 3], &cells::HEX8).mesh("block").expect("a mesh"));
    let top: Vec<_> = mesh.groups["block.front"].nodes.iter().map(|&n| (n, mesh.points[n])).collect();
    let touch = Vec3([0.45 * side, 0.51 * side, side]);
    let step = |name: &str| StepBuilder::new(name).count(4).hold("block.back");
    Model::builder(Space::Solid, mesh)
        .body("block", Arc::new(Rate(Elastic::new(YOUNG, 0.3))), BodyOptions::default())
        .load(move |site| Ok(Box::new(Ball { dofs: site.dofs.clone(), top, touch, side })))
        .step(step("press"))
        .step(step("slide"))
        .newton(NewtonOptions { factors, ..NewtonOptions::default() })
        .build()
        .expect("a model")
}

/// Gathers the attempts of a run.
#[derive(Default)]
pub struct Attempts(pub Vec<AttemptRecord>);

impl Attempts {
    /// Newton iterations of all attempts, and how many of them factorised.
    pub fn iterations(&self) -> (usize, usize) {
        let all = self.0.iter().flat_map(|attempt| &attempt.iterations[1..]);
        (all.clone().count(), all.filter(|iteration| iteration.factorised).count())
    }

    /// Prints one line an iteration.
    pub fn print(&self) {
        for attempt in &self.0 {
            println!("  increment {}, attempt {}: {:?}", attempt.increment, attempt.attempt, attempt.failure);
            for line in &attempt.iterations {
                let (residual, step, changes) = (line.residual, line.step, line.changes);
                println!("    {residual:.1e} step {step:.2} changes {changes} factorised {}", line.factorised);
            }
        }
    }
}

impl Observer for Attempts {
    fn attempt(&mut self, attempt: &AttemptRecord) {
        self.0.push(attempt.clone());
    }
}

/// Largest difference over the largest displacement.
pub fn distance(u: &[f64], v: &[f64]) -> f64 {
    let largest = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    u.iter().zip(v).fold(0.0_f64, |m, (u, v)| m.max((u - v).abs())) / largest
}
