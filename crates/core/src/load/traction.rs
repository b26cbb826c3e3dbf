//! Force per undeformed area, of fixed direction: `F_L = t integral of N_L dA_0`.

use super::dead::{DeadLoad, On, Part};
use super::face::{Face, area};
use super::{Site, body_force};
use crate::Error;
use crate::amplitude::Timeline;
use crate::mesh::Side;

/// A dead traction on sides, given by its components along the axes (stresses), over the undeformed area.
///
/// # Errors
/// An input error if a side cannot carry a load.
pub fn traction(name: &str, site: &Site, sides: &[Side], components: Vec<Timeline>) -> Result<DeadLoad, Error> {
    let part = |&side: &Side| {
        let face = Face::new(name, &site.mesh, side)?;
        let mut shares = vec![0.0; face.nodes.len()];
        for point in &face.points {
            let place = point.place(face.undeformed(&site.mesh), site.space);
            let area = area(site, place).norm() * point.weight;
            shares.iter_mut().zip(&point.n).for_each(|(share, n)| *share += n * area);
        }
        let dofs = site.unknowns(face.nodes.iter().copied());
        Ok(Part { on: On::Side(side), dofs, shares: body_force::along_axes(&shares, site) })
    };
    Ok(DeadLoad::new(name, components, sides.iter().map(part).collect::<Result<_, Error>>()?))
}
