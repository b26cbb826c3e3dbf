//! Pressure of fixed direction: `F_L = -p integral of N_L n_0 dA_0`, along the undeformed normal.

use super::Site;
use super::dead::{DeadLoad, On, Part};
use super::face::{Face, area};
use crate::Error;
use crate::amplitude::Timeline;
use crate::mesh::Side;

/// A dead pressure (a stress, positive into the body) on sides, along the undeformed normal over the undeformed area.
///
/// # Errors
/// An input error if a side cannot carry a load.
pub fn dead_pressure(name: &str, site: &Site, sides: &[Side], value: Timeline) -> Result<DeadLoad, Error> {
    let part = |&side: &Side| {
        let face = Face::new(name, &site.mesh, side)?;
        let dim = site.space.dimension();
        let mut shares = vec![(0, 0.0); dim * face.nodes.len()];
        for point in &face.points {
            let inward = -area(site, point.place(face.undeformed(&site.mesh), site.space)) * point.weight;
            for (shares, n) in shares.chunks_exact_mut(dim).zip(&point.n) {
                (0..dim).for_each(|axis| shares[axis].1 += n * inward[axis]);
            }
        }
        Ok(Part { on: On::Side(side), dofs: site.unknowns(face.nodes.iter().copied()), shares })
    };
    Ok(DeadLoad::new(name, vec![value], sides.iter().map(part).collect::<Result<_, Error>>()?))
}
