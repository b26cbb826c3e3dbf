//! Ways that graze: in at one side of something and out at another that does not look the other way, deep in it between.

use super::check::{Look, Manner, Other, Worst, along, keep};
use super::hierarchy::{bounds, meet};
use super::rigid::Rigid;
use crate::Failure;
use crate::tensor::Vec3;

/// A way through something counts, whatever its sides, where it leads deeper than this part of a cell,
const GRAZED: f64 = 0.5;
/// as seen at so many places at most.
const GRAZES: usize = 64;
/// Looks at bodies on their way past each other, at most.
const HALTS: usize = 16;

/// How deep a point of a cell of that size lay in a closed tool on a straight way that begins and ends outside.
pub(super) fn grazed(path: &[Vec3], tool: &Rigid, size: f64) -> Option<f64> {
    let least = GRAZED * size;
    let way: f64 = path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    if !tool.closed || way < least || !meet(&bounds(path.iter().copied()), &tool.bounds) {
        return None;
    }
    let count = ((2.0 * way / least) as usize).min(GRAZES);
    let deep = |i: usize| tool.depth(along(path, i as f64 / count as f64), f64::INFINITY);
    let deepest = (1..count).filter_map(deep).map(|deep| deep.depth).fold(0.0, f64::max);
    (deepest > least).then_some(deepest)
}

impl Look<'_> {
    /// Bodies whose ways meet and that touch at the end of none: one may have grazed the other, in at one side and out at one that
    /// does not look the other way.
    fn strangers(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let all = (0..self.placed.len()).flat_map(|own| (0..self.placed.len()).map(move |other| [own, other]));
        all.filter(|&[own, other]| {
            own != other
                && self.reported[self.prepared.pair(own, Other::Whole(other))] == 0.0
                && meet(&self.placed[own].swept, &self.placed[other].swept)
        })
    }

    /// Into how many parts the way of such bodies is divided for a look between: none moves by more than half a cell past the
    /// other in one, within reason. Zero where none moves farther.
    pub(super) fn halts(&self) -> usize {
        let mut most = 0.0_f64;
        for [own, other] in self.strangers() {
            let (a, b) = (&self.placed[own], &self.placed[other]);
            let count = b.now.len().max(1) as f64;
            let carried = b.now.iter().zip(&b.before).fold(Vec3::zero(), |sum, (now, before)| sum + (*now - *before));
            let carried = carried * count.recip();
            for (vertex, (now, before)) in a.now.iter().zip(&a.before).enumerate() {
                if meet(&bounds([*before, *now]), &b.swept) {
                    most = most.max((*now - *before - carried).norm() / a.size_at(vertex));
                }
            }
        }
        if most > GRAZED { ((most / GRAZED).ceil() as usize).min(HALTS) } else { 0 }
    }

    /// Refuses bodies that lie deep in one another, on the way to where they touch no more.
    pub(super) fn grazes(&self) -> Result<(), Failure> {
        let mut worst: Worst = None;
        for [own, other] in self.strangers() {
            self.in_other(own, other, &mut |found| {
                let initial = self.prepared.initial[self.prepared.pair(own, found.other)];
                keep(&mut worst, ((found.depth - found.sagitta - initial) / found.size, found));
            });
        }
        match worst.filter(|(part, _)| *part > GRAZED) {
            Some((_, mut found)) => {
                found.manner = Manner::Through;
                Err(self.refusal(&found))
            }
            None => Ok(()),
        }
    }
}
