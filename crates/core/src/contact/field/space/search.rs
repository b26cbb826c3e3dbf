//! Which faces of the surface see which part of the target, in space.

use super::overlap::{FacePart, whole};
use crate::contact::field::configuration::{Configuration, SeenPart, TargetInPlace};
use crate::contact::field::cover::Patch;
use crate::tool::BoundingBox;

impl Configuration<'_> {
    /// The patches of a face, within `reach` or nearly so: one for each smooth piece of a tool that some of its places see,
    /// one for each face of a body.
    pub(in crate::contact::field) fn patches_in_space(
        &self,
        number: usize,
        reach: f64,
        near: &mut Vec<usize>,
    ) -> Vec<SeenPart> {
        let face = self.face(number);
        let corners = &face.placed.nodes()[..face.face.corners()];
        let patch = |target: usize| Patch { face: number, target, ends: [None; 2], near: [-1.0, 1.0], tip: None };
        match &self.target {
            TargetInPlace::Tool(_) => {
                let places: Vec<[f64; 2]> = whole(face.face.corners()).map(|place| place.xi).collect();
                (0..self.contact.pieces).filter_map(|piece| self.judge(&face, patch(piece), &places)).collect()
            }
            TargetInPlace::Faces(faces) => {
                // Farther than the band, since a node has one and not each of its faces.
                faces.near(&BoundingBox::of(face.placed.nodes().iter().copied()), 2.0 * reach, near);
                let candidates = near.iter().filter(|&&target| self.contact.may_touch(number, target));
                let look = |&target: &usize| {
                    let other = &faces.placed(target).nodes()[..faces.corners(target)];
                    let part = FacePart::new(corners, other)?;
                    Some((self.judge(&face, patch(target), part.places())?, part))
                };
                keep_nearest(candidates.filter_map(look).collect())
            }
        }
    }
}

/// Of patches of one face that lie over each other, the nearest.
fn keep_nearest(all: Vec<(SeenPart, FacePart)>) -> Vec<SeenPart> {
    let nearer = |a: &SeenPart, b: &SeenPart| (a.middle.abs(), a.patch.target) < (b.middle.abs(), b.patch.target);
    let hidden = |(seen, part): &(SeenPart, FacePart)| {
        let hides = |(other, over): &(SeenPart, FacePart)| nearer(other, seen) && over.covers(part);
        all.iter().any(hides)
    };
    all.iter().filter(|found| !hidden(found)).map(|(seen, _)| *seen).collect()
}
