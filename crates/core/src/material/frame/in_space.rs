//! The frame of any deformation.

use super::{Frame, Turning, cayley, halving};
use crate::tensor::Tensor2;

/// What turns in space.
pub(super) struct Turned {
    /// `(f + I)^-1`.
    a: Tensor2,
    spin: Tensor2,
    /// `c` of the half rotation, and `s`.
    halving: (f64, f64),
    q: Tensor2,
    half: Tensor2,
    /// What is left to turn from the left: the old stress, and the strain for half of the rotation.
    turn: Tensor2,
    turn_half: Tensor2,
}

impl Turned {
    /// By a deformation, from an old stress.
    pub fn new(f: &Tensor2, old: &Tensor2) -> Self {
        let identity = Tensor2::identity();
        let a = (*f + identity).inverse();
        let g = (*f - identity) * a * 2.0;
        let spin = g.skew() * 0.5;
        let halving = halving(&spin);
        let (q, half) = (cayley(&spin), cayley(&(spin * halving.0)));
        let (turn, turn_half) = (*old * q.transpose(), g.sym() * half.transpose());
        Self { a, spin, halving, q, half, turn, turn_half }
    }

    /// The frame.
    pub fn values(&self) -> Frame<f64> {
        Frame { de: (self.half * self.turn_half).sym(), q: self.q, stress: self.q * self.turn }
    }
}

/// A frame that turns in space. With `A = (f + I)^-1`, `B = (I - W/2)^-1` and `C` the same of the half rotation:
/// `dG = 4 A df A`, `dQ = B dW B`, `dH = C d(c W) C`, and the strain is `H sym(G) H^T`.
pub struct InSpace {
    turned: Turned,
    /// `H A` and `A H^T`, which give the strain of `dG` itself.
    sides: (Tensor2, Tensor2),
    /// What the frame changes by with each of the three components that `dW` has, in which all else is linear.
    turns: [Frame<f64>; 3],
}

/// Places of the components `yz`, `zx` and `xy` of a skew tensor.
const AXIAL: [(usize, usize); 3] = [(1, 2), (2, 0), (0, 1)];

impl InSpace {
    /// Of a deformation and an old stress.
    pub fn new(f: &Tensor2, old: &Tensor2) -> Self {
        let turned = Turned::new(f, old);
        let Turned { a, half, spin, halving: (c, s), .. } = turned;
        let identity = Tensor2::identity();
        let (b, b_half) = ((turned.q + identity) * 0.5, (half + identity) * 0.5);
        let along_spin = b_half * spin * b_half;
        let turn = |(i, j): (usize, usize)| {
            // `B dW B` where the only entries of `dW` are one and minus one.
            let within = |b: &Tensor2, k: usize, l: usize| b[(k, i)] * b[(j, l)] - b[(k, j)] * b[(i, l)];
            let dc = -0.5 * c * c * spin[(i, j)] / s;
            let dh = Tensor2::from_fn(|k, l| c * within(&b_half, k, l) + 2.0 * dc * along_spin[(k, l)]);
            let q = Tensor2::from_fn(|k, l| within(&b, k, l));
            Frame { de: twice_sym(&(dh * turned.turn_half)), q, stress: twice_sym(&(q * turned.turn)) }
        };
        let turns = [turn(AXIAL[0]), turn(AXIAL[1]), turn(AXIAL[2])];
        Self { turned, sides: (half * a, a * half.transpose()), turns }
    }
}

impl Turning for InSpace {
    fn values(&self) -> Frame<f64> {
        self.turned.values()
    }

    #[inline(always)]
    fn slope(&self, (m, n): (usize, usize)) -> Frame<f64> {
        let (a, (left, right), [x, y, z]) = (&self.turned.a, &self.sides, &self.turns);
        let along = |(i, j): (usize, usize)| 2.0 * (a[(i, m)] * a[(n, j)] - a[(j, m)] * a[(n, i)]);
        let (dx, dy, dz) = (along(AXIAL[0]), along(AXIAL[1]), along(AXIAL[2]));
        let strain = |i: usize, j: usize| 2.0 * (left[(i, m)] * right[(n, j)] + left[(j, m)] * right[(n, i)]);
        Frame {
            de: x.de * dx + y.de * dy + z.de * dz + Tensor2::from_fn(strain),
            q: x.q * dx + y.q * dy + z.q * dz,
            stress: x.stress * dx + y.stress * dy + z.stress * dz,
        }
    }
}

fn twice_sym(t: &Tensor2) -> Tensor2 {
    *t + t.transpose()
}
