//! Fillets: arcs that round the corners of a profile, tangent to the two straight segments that they join.

use super::shapes::{ShapeKind, find};
use crate::tensor::Vec3;

/// The arc of a radius that rounds the middle corner; none where nothing turns or the profile runs back.
fn fillet([a, b, c]: [Vec3; 3], radius: f64) -> Option<[Vec3; 3]> {
    let (back, on) = ((a - b).unit(), (c - b).unit());
    let half = 0.5 * back.cross(on).norm().atan2(back.dot(on));
    let bisector = back + on;
    if bisector.norm() < 1e-9 || half < 1e-6 {
        return None;
    }
    let cut = radius / half.tan();
    let nearest = b + bisector.unit() * (radius / half.sin() - radius);
    Some([b + back * cut, nearest, b + on * cut])
}

/// A segment of a profile before it is built: which one it was or rounds, its shape and its nodes.
pub type Draft = (usize, &'static ShapeKind, Vec<Vec3>);

/// Ends nearer to each other than this part of a segment's length are one point.
const TOGETHER: f64 = 1e-9;

/// A profile each of whose corners between straight segments is rounded by an arc of the same radius.
///
/// # Errors
/// In words, where two arcs do not fit on the segment between them.
pub fn rounded(profile: Vec<Draft>, radius: f64) -> Result<Vec<Draft>, String> {
    let (n, arc, before) = (profile.len(), find("arc")?, profile.clone());
    let straight = |i: usize| (before[i].2.len() == 2).then(|| [before[i].2[0], before[i].2[1]]);
    let (mut cut, mut arcs) = (profile, vec![None; n]);
    for i in 0..n {
        let next = (i + 1) % n;
        let (Some([a, b]), Some([from, c])) = (straight(i), straight(next)) else { continue };
        if i == next || (from - b).norm() > TOGETHER * (b - a).norm() {
            continue;
        }
        if let Some(nodes) = fillet([a, b, c], radius) {
            (cut[i].2[1], cut[next].2[0]) = (nodes[0], nodes[2]);
            arcs[i] = Some((i, arc, nodes.to_vec()));
        }
    }
    let mut whole = Vec::new();
    for (segment, arc) in cut.into_iter().zip(arcs) {
        if let Some([a, b]) = straight(segment.0) {
            let (left, least) = ((segment.2[1] - segment.2[0]).dot(b - a), TOGETHER * (b - a).dot(b - a));
            if left <= -least {
                return Err(format!("the fillet is too large for segment {}", segment.0 + 1));
            }
            // Two arcs that meet leave nothing between them.
            whole.extend((left > least).then_some(segment));
        } else {
            whole.push(segment);
        }
        whole.extend(arc);
    }
    Ok(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(side: f64) -> Vec<Draft> {
        let at = |x: f64, y: f64| Vec3::new(x * side, y * side, 0.0);
        let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        (0..4).map(|i| (i, find("line").unwrap(), vec![corners[i], corners[(i + 1) % 4]])).collect()
    }

    #[test]
    fn all_corners_of_a_closed_profile_are_rounded_tangentially() {
        let built: Vec<_> =
            rounded(square(4.0), 1.0).unwrap().iter().map(|(_, kind, nodes)| kind.build(nodes).unwrap()).collect();
        assert_eq!(built.len(), 8);
        for i in 0..8 {
            let (one, next) = (&built[i], &built[(i + 1) % 8]);
            assert!((one.point(1.0) - next.point(0.0)).norm() < 1e-14);
            assert!((one.tangent(1.0).unit() - next.tangent(0.0).unit()).norm() < 1e-12);
        }
        let length: f64 = built.iter().map(|segment| segment.length()).sum();
        assert!((length - 8.0 - std::f64::consts::TAU).abs() < 1e-12);
    }

    #[test]
    fn fillets_that_do_not_fit_are_refused_and_open_ends_stay() {
        assert!(rounded(square(1.9), 1.0).is_err());
        let arcs = rounded(square(2.0), 1.0).unwrap();
        assert!(arcs.len() == 4 && arcs.iter().all(|(_, kind, _)| kind.key == "arc"));
        let mut open = square(4.0);
        open.pop();
        let shapes: Vec<&str> = rounded(open, 1.0).unwrap().iter().map(|(_, kind, _)| kind.key).collect();
        assert_eq!(shapes, ["line", "arc", "line", "arc", "line"]);
    }
}
