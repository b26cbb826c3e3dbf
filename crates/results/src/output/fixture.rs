//! A body in a large smooth motion, for the tests of this room.

use super::quantities::Parts;
use asperity_core::material::Rate;
use asperity_core::material::laws::Elastic;
use asperity_core::mesh::generate::{Block, Rectangle};
use asperity_core::mesh::{Cell, Mesh, Space};
use asperity_core::solid::{Body, BodyOptions, Formulation, Integration};
use asperity_core::system::{Constraints, Dofs, Energies, Instant, Local, State, Stencils, Term};
use std::sync::Arc;

/// Thickness in the plane.
const THICKNESS: f64 = 3.0;

/// A body of a few cells.
pub struct Fixture {
    pub space: Space,
    pub mesh: Arc<Mesh>,
    pub dofs: Dofs,
    pub body: Body,
    /// Everything is prescribed.
    pub held: Constraints,
}

impl Fixture {
    pub fn new(space: Space, formulation: Formulation, integration: Integration) -> Self {
        Self::with(space, BodyOptions { formulation, integration, ..BodyOptions::default() })
    }
    /// With any options, but for the thickness.
    pub fn with(space: Space, options: BodyOptions) -> Self {
        let mesh = Arc::new(mesh(space));
        let dofs = Dofs::new(space.dimension(), mesh.points.len(), 0);
        let options = BodyOptions { thickness: THICKNESS, ..options };
        let all = (0..mesh.cell_count()).collect();
        let law = Arc::new(Rate(Elastic::new(200.0, 0.3)));
        let body = Body::new("block", (mesh.clone(), dofs.clone(), space), all, law, options).unwrap();
        let held = Constraints::new(dofs.count(), &(0..dofs.count()).collect::<Vec<_>>(), &[]);
        Self { space, mesh, dofs, body, held }
    }
    pub fn parts(&self) -> Parts<'_> {
        Parts {
            space: self.space,
            mesh: &self.mesh,
            dofs: &self.dofs,
            bodies: vec![(0, &self.body)],
            materials: vec![0],
            material_names: vec!["rubber".into()],
            contacts: vec![],
            fluids: vec![],
            springs: vec![],
            tools: vec![],
            solid_tools: vec![],
            rigid: vec![],
            supports: vec![("all".into(), (0..self.mesh.points.len()).collect())],
            watched: vec![],
            constraints: vec![&self.held],
            idle: vec![],
            follows: false,
        }
    }
    /// The state before any motion.
    pub fn start(&self) -> State {
        let zero = vec![0.0; self.dofs.count()];
        State {
            u: zero.clone(),
            internal: zero.clone(),
            load: zero,
            energies: vec![Energies::default()],
            histories: vec![self.body.initial()],
            ..State::default()
        }
    }
    /// The state after a part of the motion, in one increment of time 1 from `before`.
    pub fn after(&self, before: &State, part: f64) -> State {
        let u: Vec<f64> = motion(&self.mesh, &self.dofs).iter().map(|x| part * x).collect();
        let instant = Instant { time: before.time + 1.0, dt: 1.0, ..Instant::default() };
        let attempt = self.body.attempt(before, &before.histories[0], instant).unwrap();
        let (mut stencils, mut local) = (Stencils::default(), Local::default());
        let mut state = before.clone();
        state.internal.fill(0.0);
        state.energies[0].stored = 0.0;
        attempt.stencils(&u, &mut stencils).unwrap();
        for (i, stencil) in stencils.list.iter().enumerate() {
            let own = stencils.dofs(stencil);
            local.reset(own.len());
            local.u = own.iter().map(|&dof| u[dof]).collect();
            attempt.evaluate(i, stencil, state.histories[0].slot_mut(i), &mut local).unwrap();
            own.iter().zip(&local.force).for_each(|(&dof, force)| state.internal[dof] += force);
            state.energies[0].stored += local.energies.stored;
        }
        State { increment: before.increment + 1, time: instant.time, u, ..state }
    }
}

fn mesh(space: Space) -> Mesh {
    let made = match space {
        Space::Solid => Block::new([0.0; 3], [1.0, 2.0, 1.5], [2, 2, 1], Cell::named("hex8").unwrap()).mesh("block"),
        _ => Rectangle::new([1.0, 0.0], [2.0, 3.0], [2, 3], Cell::named("quad8").unwrap()).mesh("block"),
    };
    made.unwrap()
}

/// A large smooth motion that is no affine one.
fn motion(mesh: &Mesh, dofs: &Dofs) -> Vec<f64> {
    let mut u = vec![0.0; dofs.count()];
    for (node, x) in mesh.points.iter().enumerate() {
        let wave = [0.1 * (x[1] + x[2]).sin(), 0.2 * x[0] * x[1], -0.15 * x[0] + 0.1 * x[2]];
        u[dofs.node(node)..][..dofs.per_node()].copy_from_slice(&wave[..dofs.per_node()]);
    }
    u
}
