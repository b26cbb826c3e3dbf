//! Hyperelastic laws: from the constants of Abaqus and CalculiX to ours.

use super::list;
use crate::model::{Form, Rubber};

/// Poisson's ratio of rubber whose change of volume a deck leaves to the program.
const POISSON: f64 = 0.475;

/// The law with its constants, and what is not the same.
pub fn law(rubber: &Rubber) -> Option<((&'static str, String), String)> {
    let (c, shear) = (&rubber.constants, shear(rubber)?);
    let given = if rubber.d1 > 0.0 {
        String::new()
    } else {
        format!("; D1 is zero, which means no change of volume, and becomes that of Poisson's ratio {POISSON}")
    };
    let remark =
        format!("the change of volume stores K/2 ((J^2 - 1)/2 - ln J) in place of (J - 1)^2/D1, K = 2/D1{given}");
    let bulk = if rubber.d1 > 0.0 { 2.0 / rubber.d1 } else { shear * 2.0 * (1.0 + POISSON) / (3.0 - 6.0 * POISSON) };
    let bulk = format!("bulk = {bulk:?}\n");
    let law = match (rubber.form, c.as_slice()) {
        (Form::NeoHooke, _) => ("neo_hookean", format!("shear = {shear:?}\n{bulk}")),
        (Form::MooneyRivlin, [c10, c01, ..]) => ("mooney_rivlin", format!("c10 = {c10:?}\nc01 = {c01:?}\n{bulk}")),
        (Form::Yeoh, [c10, c20, c30, ..]) => ("yeoh", format!("c10 = {c10:?}\nc20 = {c20:?}\nc30 = {c30:?}\n{bulk}")),
        (Form::Ogden, pairs) => {
            // W = 2 mu / alpha^2 (...) there, mu / alpha (...) here.
            let term = |[mu, alpha]: &[f64; 2]| list(&[2.0 * mu / alpha, *alpha]);
            let terms: Vec<String> = pairs.as_chunks::<2>().0.iter().map(term).collect();
            ("ogden", format!("terms = [{}]\n{bulk}", terms.join(", ")))
        }
        (Form::ArrudaBoyce, [mu, stretch, ..]) => {
            ("arruda_boyce", format!("modulus = {mu:?}\nlocking_stretch = {stretch:?}\n{bulk}"))
        }
        _ => return None,
    };
    Some((law, remark))
}

/// The shear modulus of the undeformed solid.
fn shear(rubber: &Rubber) -> Option<f64> {
    let c = &rubber.constants;
    Some(match rubber.form {
        Form::NeoHooke | Form::Yeoh => 2.0 * c.first()?,
        Form::MooneyRivlin => 2.0 * (c.first()? + c.get(1)?),
        Form::Ogden => c.as_chunks::<2>().0.iter().map(|[mu, _]| mu).sum(),
        Form::ArrudaBoyce => {
            let square = c.get(1)?.powi(-2);
            let series = [1.0, 3.0 / 5.0, 99.0 / 175.0, 513.0 / 875.0, 42_039.0 / 67_375.0];
            c.first()? * series.iter().rev().fold(0.0, |sum, term| sum * square + term)
        }
    })
}
