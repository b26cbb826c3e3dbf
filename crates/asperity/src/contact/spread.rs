//! The linear functions of the corners of an edge or a face at one of its places: those of its full shape would not do for
//! multipliers, since the integrals of serendipity functions are negative.

use super::augment::Shift;

/// Most corners of a face.
pub const MOST: usize = 4;

/// The corners around a contact point and their functions there; of an edge the last two are none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    corners: [usize; MOST],
    functions: [f64; MOST],
}

impl Spread {
    /// At a place of a face with the first so many of these corners.
    pub fn new((corners, count): ([usize; MOST], usize), at: [f64; 2]) -> Self {
        Self { corners, functions: functions(count, at) }
    }

    /// What multipliers of the corners stand for.
    pub fn of(&self, shifts: &[Shift]) -> Shift {
        let mut here = Shift::default();
        for (corner, function) in self.iter() {
            here.closure += function * shifts[corner].closure;
            here.slip += shifts[corner].slip * function;
        }
        here
    }

    /// Corners with their functions.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.corners.into_iter().zip(self.functions).filter(|(_, function)| *function != 0.0)
    }
}

/// Linear functions of the corners of a face with so many.
fn functions(count: usize, [x, y]: [f64; 2]) -> [f64; MOST] {
    let side = |sign: f64, x: f64| 0.5 * (1.0 + sign * x);
    match count {
        2 => [side(-1.0, x), side(1.0, x), 0.0, 0.0],
        3 => [1.0 - x - y, x, y, 0.0],
        _ => [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| side(a, x) * side(b, y)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_sum_to_one_and_are_one_at_their_corners() {
        for (count, corners) in [
            (2, &[[-1.0, 0.0], [1.0, 0.0]][..]),
            (3, &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
            (4, &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]),
        ] {
            for (i, &corner) in corners.iter().enumerate() {
                assert_eq!(functions(count, corner)[i], 1.0);
            }
            assert!((functions(count, [0.3, 0.2]).iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
        for name in ["tri3", "quad4"] {
            let cell = crate::mesh::Cell::named(name).unwrap();
            let (mut n, mut gradient) = ([0.0; 4], [[0.0; 3]; 4]);
            (cell.shape)([0.3, 0.2, 0.0], &mut n[..cell.nodes.len()], &mut gradient[..cell.nodes.len()]);
            assert_eq!(functions(cell.nodes.len(), [0.3, 0.2]), n, "{name}");
        }
    }
}
