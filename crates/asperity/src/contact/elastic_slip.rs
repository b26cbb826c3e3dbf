//! The tangential penalty that follows from an elastic slip: a point that is about to slide has slipped elastically by a stated
//! part of its edge or face. A stiffer interface than that resolves nothing that the mesh shows, and has points change
//! between stick and slip with every small motion.
//!
//! It is one number for a contact and an attempt, from the pressures of the accepted state alone, so that a restart finds
//! the same.

use super::ContactOptions;
use crate::interface::Interface;

/// Part of the largest tangential penalty before the contact has borne pressure.
const FIRST: f64 = 0.01;

/// The tangential penalty of an attempt whose points bear these accepted pressures on edges or faces of these lengths: the
/// mean over the closed ones.
pub fn tangential_penalty(
    (law, options): (&dyn Interface, &ContactOptions),
    points: impl Iterator<Item = (f64, f64)>,
) -> f64 {
    let Some(part) = options.elastic_slip else { return options.tangential_penalty };
    let (mut sum, mut closed) = (0.0, 0_usize);
    for (pressure, length) in points.filter(|(pressure, _)| *pressure > 0.0) {
        let Some(stress) = law.sliding_stress(pressure) else { return options.tangential_penalty };
        sum += stress / (part * length);
        closed += 1;
    }
    if sum > 0.0 { (sum / closed as f64).min(options.tangential_penalty) } else { FIRST * options.tangential_penalty }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactForm, Guard, Loads, Normals, Overlap};
    use crate::interface::laws;

    fn options(elastic_slip: Option<f64>) -> ContactOptions {
        ContactOptions {
            penalty: 1e4,
            tangential_penalty: 1e3,
            elastic_slip,
            thickness: 1.0,
            loads: Loads::Both,
            coupling: true,
            guard: Guard::Warn,
            augmentation: None,
            overlap: Overlap::Keep,
            wear: None,
            form: ContactForm::Traction,
            normals: Normals::Own,
        }
    }

    fn found(elastic_slip: Option<f64>, points: &[(f64, f64)]) -> f64 {
        let law = laws::ALL.iter().find(|law| law.name == "coulomb").map(|law| (law.build)(&[0.2]).unwrap()).unwrap();
        tangential_penalty((&*law, &options(elastic_slip)), points.iter().copied())
    }

    /// Friction 0.2 times 10 and 30 over a hundredth of lengths of 2 and 3: 100 and 200 in the mean.
    #[test]
    fn a_point_slides_after_the_stated_part_of_its_edge() {
        let points = [(10.0, 2.0), (0.0, 1.0), (30.0, 3.0), (-1.0, 1.0)];
        assert!((found(Some(0.01), &points) - 150.0).abs() < 1e-12);
        assert_eq!(found(Some(1e-9), &points), 1e3, "at most the largest");
        assert_eq!(found(Some(0.01), &points[1..2]), 10.0, "nothing has borne yet");
        assert_eq!(found(None, &points), 1e3);
    }
}
