//! What a contact answers over the coordinates over which its forces bend: penetration and slips.

use super::increment::in_contact;
use crate::Failure;
use crate::interface::{Interface, MOST_VARIABLES, Past};
use crate::system::{Answer, COORDINATES, Coordinates};
use crate::tensor::Dual;

/// Pressure and shear over penetration and slip `y`, for what `past` is before the increment; a point that is farther
/// than `least` beyond touching is closed.
pub(in crate::contact) fn answer(
    law: &dyn Interface,
    past: &Past,
    least: f64,
    y: &Coordinates,
) -> Result<Answer, Failure> {
    let mut answer = Answer::default();
    if y[0] <= law.opens(past, [y[1], y[2]]) + least {
        return Ok(answer);
    }
    for (i, stress) in stress_of(law, past, motion(law, past, least, y))?.into_iter().enumerate() {
        (answer.stress[i], answer.slopes[i]) = (stress.re, stress.du);
    }
    Ok(answer)
}

/// The same where friction goes by the mean pressure around the point: over penetration, `slips` slips, and the
/// penetration that the mean stands for, to which no stress of its own belongs.
pub(in crate::contact) fn answer_by_mean(
    law: &dyn Interface,
    past: &Past,
    (least, slips): (f64, usize),
    y: &Coordinates,
) -> Result<Answer, Failure> {
    let (mut local, mean) = (*y, slips + 1);
    local[mean] = 0.0;
    let mut whole = answer(law, past, least, &local)?;
    if y[0] <= law.opens(past, [local[1], local[2]]) + least {
        return Ok(whole);
    }
    let mut motion = motion(law, past, least, &local);
    motion[0] = Coordinate::variable(y[mean], mean);
    let [_, shear @ ..] = stress_of(law, past, motion)?;
    for (i, shear) in shear.iter().enumerate().take(slips) {
        (whole.stress[i + 1], whole.slopes[i + 1]) = (shear.re, shear.du);
    }
    (whole.stress[mean], whole.slopes[mean]) = (0.0, [0.0; COORDINATES]);
    Ok(whole)
}

type Coordinate = Dual<COORDINATES>;

/// What the law is asked at coordinates `y`: penetration, and the slips from the touch on.
fn motion(law: &dyn Interface, past: &Past, least: f64, y: &Coordinates) -> [Coordinate; 3] {
    let (touch, penetration) = (law.touch(past), Coordinate::variable(y[0] - least, 0));
    let part = in_contact(penetration - touch, past.penetration - touch);
    let [s, t] = [1, 2].map(|i| Coordinate::variable(y[i], i) * part);
    [penetration, s, t]
}

/// The stresses of a motion with its derivatives.
fn stress_of(law: &dyn Interface, past: &Past, motion: [Coordinate; 3]) -> Result<[Coordinate; 3], Failure> {
    let past = Past { penetration: past.penetration.max(law.touch(past)), ..*past };
    let mut vars = [0.0; MOST_VARIABLES];
    let vars = &mut vars[..past.vars.len()];
    vars.copy_from_slice(past.vars);
    Ok(law.respond(motion.map(|y| y.re), &past, vars)?.chained(motion))
}
