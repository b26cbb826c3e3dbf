//! How much nearer a target lies to the faces around a node than in the mean.
//!
//! The gap of a node is a mean over its faces: under flat faces of length `h` a cylinder of radius `R` is felt when it stands
//! `h^2 / 12 R` in them, and up to `5 h^2 / 24 R` where it comes between two rows of nodes; a facet that leans against the next one
//! by `t`, flat on what it rests on, when that lies `h t / 6` in it. What a bar takes for a support would be beside it by a good part of what
//! bends it. A node therefore closes when the target touches the part of its faces that is nearer to it than to other nodes: to its
//! penetration is added by how much the least gap there is less than the mean, so far as the gap is not linear.
//!
//! Where an edge of a body touches, that is a [`corner`](super::corner) of its own.
//!
//! As for a tip in the plane ([`tip`](super::tip)) this is so where one or two rows of nodes touch. Where the surface follows the target
//! the mean gap is nearer to that of the curved surface: around a node of a third row no other has a larger gap, and nothing is added to
//! it and to those beside it. Nor is it where flat and curved faces of second degree meet in space. What is round on either side lies nearest where it is, not where the gap
//! less its slope is least, as do flat faces that lean against what is flat.
//!
//! What bears flattens. A contact narrower than a face has an approach that the mesh does not resolve, about that of Hertz; what it takes is no
//! longer added, and nothing is where the contact is four fifths of a face wide. Between bulky bodies that is so almost from the beginning,
//! between slender ones hardly at all.
//!
//! What is added is found at the beginning of an increment, from the accepted state; what flattening takes of it is a spring in series with the
//! law, and goes with the pressure of the same iteration. What pressures do over the change of both is accounted as supplied.

use super::configuration::{Configuration, TargetInPlace};
use super::cover::FaceInPlace;
use super::faces::{FaceProjection, FaceRay, LEAST_COSINE};
use crate::contact::record::entry;
use crate::system::History;
use crate::tensor::Vec3;

/// The mean gap less the least one over the half faces around a node, over the range of what a linear gap leaves: of a parabola
/// `5/24` over `1/2` at most, with its vertex half a face away, of facets that lean against each other `1/6` over `1/2`.
const MOST: f64 = 5.0 / 12.0;
/// That range around a node inside the surface over that on one of its faces, of a parabola.
const WITHIN: f64 = 4.0;
/// Where the centre of a node's function lies on the way from it to the middle of a face.
const CENTRE: f64 = 2.0 / 3.0;
/// By how much the gap of a node around is larger, over what may be added, from which on all of it is: under flat faces it is 2.4 times that
/// and more.
const BESIDE: f64 = 2.0;
/// Gap over the size of a face up to which a node may be one that others touch around.
const TOUCHES: f64 = 0.1;
/// Edges from a node that has no larger gaps around it to what it has nothing added.
const ROWS: usize = 2;
/// `a^2 / h^2` of a cylinder up to which it is narrow in a face: its logarithm is -2.
const NARROW: f64 = 0.135_335_283_236_612_7;
/// Places along each half edge at which the gap is looked at.
const PLACES: [f64; 3] = [0.0, 0.5, 1.0];

impl Configuration<'_> {
    /// For each slot of an accepted configuration how much nearer the target is than in the mean, if its gap is no larger than `far`. Nothing over
    /// round tools in the plane, which have tips, of flat faces over any of these or their own surface, and where flat faces of second degree
    /// meet curved ones. `depths` are those of its faces.
    pub(super) fn nearer(&self, history: &History, (far, depths): (f64, &[f64])) -> Vec<Nearer> {
        let (contact, surface) = (self.contact, &self.contact.parts.surface);
        let mean = |slot: usize| {
            let values = history.slot(slot);
            (values[entry::SEGMENT] >= 0.0).then(|| -values[entry::PENETRATION])
        };
        let mut nearer = vec![Nearer::default(); contact.slots()];
        let is_tool = matches!(self.target, TargetInPlace::Tool(_));
        // Tools in the plane have tips, but where what is round lies on a straight one.
        let has_tips = surface.plane && is_tool;
        let may_bear = |node: usize, piece: usize| {
            if surface.is_round_at(node) {
                !(has_tips && contact.is_round(piece))
            } else {
                !(has_tips || contact.roles.itself || surface.is_curved_at(node))
            }
        };
        let mut gaps = Vec::new();
        for piece in 0..contact.pieces {
            let gap = |node: usize| mean(contact.slot(node, piece));
            let close = |node: usize| gap(node).is_some_and(|gap| gap <= far);
            if !(0..surface.nodes.len()).any(close) {
                continue;
            }
            let closed = |node: usize| history.slot(contact.slot(node, piece))[entry::STATUS] > 0.0;
            // By how much farther from the target than a node that touches one of those around it is, and the least of that up to two edges away.
            let beside = |node: usize| {
                let touches = |gap: &f64| surface.plane || *gap <= TOUCHES * contact.size_at(contact.slot(node, piece));
                let Some(own) = gap(node).filter(touches) else { return f64::INFINITY };
                let farther = surface.neighbours(node).map(|other| gap(other).map_or(f64::INFINITY, |gap| gap - own));
                let most = farther.fold(f64::NEG_INFINITY, f64::max);
                // Where the surface ends beyond what touches something round nothing else could be farther.
                let ends = most < 0.0 && contact.is_round(piece) && surface.ends_at(node);
                if ends { f64::INFINITY } else { most.max(0.0) }
            };
            let spread = |values: Vec<f64>, of: fn(f64, f64) -> f64| -> Vec<f64> {
                let around = |node: usize| surface.neighbours(node).map(|other| values[other]).fold(values[node], of);
                (0..values.len()).map(around).collect()
            };
            let mut straight: Vec<f64> = (0..surface.nodes.len()).map(beside).collect();
            let mut bears: Vec<f64> = (0..surface.nodes.len()).map(|node| f64::from(u8::from(closed(node)))).collect();
            for _ in 0..ROWS {
                straight = spread(straight, f64::min);
                bears = spread(spread(bears, f64::max), f64::max);
            }
            // A surface that folds, slides or spreads onto a flat tool or a body touches it beside what bears already.
            let rolls = is_tool && contact.is_round(piece);
            let follows = |node: usize| !rolls && !closed(node) && bears[node] > 0.0;
            let near = |&node: &usize| straight[node] > 0.0 && close(node) && !follows(node) && may_bear(node, piece);
            for node in (0..surface.nodes.len()).filter(near) {
                let Some(around) = self.around(node, piece, (far, depths), &mut gaps) else { continue };
                let than = gap(node).map_or(0.0, |gap| gap - around.least);
                let more = than.min(MOST * around.range);
                if more > 0.0 {
                    let (slot, most) = (contact.slot(node, piece), more.min(straight[node] / BESIDE));
                    let scale = (contact.parts.options.modulus * around.bend * contact.size_at(slot)).recip();
                    nearer[slot] = Nearer { most, scale, round: around.round };
                    if closed(node) {
                        // What bears is not pushed any farther.
                        let old = history.slot(slot);
                        let left = 1.0 - nearer[slot].approach(old[entry::PRESSURE])[0];
                        nearer[slot].most = if left > 0.0 { most.min(old[entry::NEARER] / left) } else { most };
                    }
                }
            }
        }
        nearer
    }

    /// The gaps of a piece around a node, with room for them. What leans against a flat tool or a body does not touch it with the node: the least gap is then of
    /// what is left by the linear one.
    fn around(
        &self,
        node: usize,
        piece: usize,
        (far, depths): (f64, &[f64]),
        gaps: &mut Vec<PlaceGap>,
    ) -> Option<Around> {
        let support = &self.contact.parts.surface.nodes[node].support;
        let (mut within, mut center) = (0.0, Vec3::zero());
        gaps.clear();
        let part = (support.len() as f64).recip();
        for &(number, corner) in support {
            let (begin, face) = (gaps.len(), self.face(number));
            let range = [-2.0 * depths[number], far + 2.0 * self.contact.longest];
            for (nearest, xi) in places(&face, corner) {
                let gap = self.gap_at((&face, number), xi, (piece, range));
                gaps.extend(gap.map(|gap| PlaceGap { nearest: nearest && gap.nearest, ..gap }));
            }
            within += WITHIN * part * beyond_linear(&gaps[begin..]).range;
            let [own, middle] = [face.face.corner_place(corner), face.face.middle()].map(|xi| face.at(xi).x);
            center += (own + (middle - own) * CENTRE) * part;
        }
        let Beyond { slope, range, bend, round } = beyond_linear(gaps);
        let (round_target, round_node) = (self.contact.is_round(piece), self.contact.parts.surface.is_round_at(node));
        let leans = |gap: &PlaceGap| if round_target || round_node { 0.0 } else { slope.dot(gap.x - center) };
        let half = gaps.iter().filter(|gap| gap.nearest);
        let least = half.map(|gap| gap.gap - leans(gap)).fold(f64::INFINITY, f64::min);
        let range = range.max(within);
        // Over flat faces that of a parabola of this range, of which one half is seen where they end.
        let bend =
            if round_node { bend } else { 2.0 * range / self.contact.size_at(self.contact.slot(node, piece)).powi(2) };
        least.is_finite().then_some(Around { least, range, bend, round })
    }

    /// The gap at which a node lies in front of a piece, however far away; zero where nothing of that is in front of it.
    pub(super) fn parted(&self, node: usize, piece: usize) -> f64 {
        let gap = |&(number, corner): &(usize, usize)| {
            let face = self.face(number);
            let xi = face.face.corner_place(corner);
            Some(self.gap_at((&face, number), xi, (piece, [0.0, f64::INFINITY]))?.gap)
        };
        let gaps = self.contact.parts.surface.nodes[node].support.iter().filter_map(gap);
        gaps.reduce(f64::min).map_or(0.0, |gap| gap.max(0.0))
    }

    /// A place of a face, and the gap there of a piece and those that it meets at an edge of their body; `nearest` where it is that of the piece.
    fn gap_at(
        &self,
        (face, number): (&FaceInPlace, usize),
        xi: [f64; 2],
        (piece, range): (usize, [f64; 2]),
    ) -> Option<PlaceGap> {
        let at = face.at(xi);
        let (x, n) = (at.x, at.normal.unit());
        let rise = self.contact.parts.surface.rise(number, &self.arcs.own, xi).0;
        match &self.target {
            TargetInPlace::Tool(tool) => {
                let foot = tool.closest(piece, x);
                let gap = foot.gap - rise;
                foot.beyond.is_none().then_some(PlaceGap { x, n: foot.normal, gap, nearest: true })
            }
            TargetInPlace::Faces(faces) => {
                let ray = FaceRay { x, n };
                let together = |other: usize| {
                    let of = |face: usize| self.contact.piece_of(face);
                    of(other) == piece
                        || self.contact.edges_of(piece).any(|edge| edge.faces.map(of).contains(&of(other)))
                };
                let admits = |other: usize, hit: &FaceProjection| {
                    let faces_it = -hit.normal().dot(ray.n) > LEAST_COSINE;
                    faces_it && together(other) && self.contact.may_touch(number, other)
                };
                let (other, hit) = faces.nearest(&ray, range, admits)?;
                // Along the bisector of both normals, as it is from either side.
                let between = (0.5 * (1.0 - hit.normal().dot(ray.n))).sqrt();
                let gap = hit.gap * between - rise - self.seen_rise(other, hit.s);
                Some(PlaceGap { x, n, gap, nearest: self.contact.piece_of(other) == piece })
            }
        }
    }
}

/// How much nearer a target lies to the faces around a node than in the mean.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nearer {
    /// How much is added to the penetration where nothing bears.
    pub most: f64,
    /// `p / E* K h` for a unit of pressure `p`, with `K` the curvatures of the gap and `h` the length of a face.
    scale: f64,
    /// How nearly round the gap is: one under a ball, zero under a cylinder.
    round: f64,
}

impl Nearer {
    /// By how much a pressure makes less what is added, with its slope.
    pub fn flattening(&self, pressure: f64) -> [f64; 2] {
        self.approach(pressure).map(|part| self.most * part)
    }

    /// The approach that the mesh does not resolve of a contact that bears a pressure, over the mean gap, up to the whole, with its slope: of a ball
    /// `a^2 / R` over `h^2 / 6 R` with `a^3 = 3 F R / 4 E*`, of a cylinder `a^2 ln(h / a) / 2 R` over `h^2 / 12 R` with `a^2 = 4 P' R / pi E*`
    /// (Hertz; Johnson 1985).
    fn approach(&self, pressure: f64) -> [f64; 2] {
        let bears = pressure * self.scale;
        if bears <= 0.0 {
            return [0.0; 2];
        }
        // `a^2 / h^2` of both; the logarithm is for contacts that are narrow in a face, and goes on along its tangent.
        let [cylinder, ball] = [4.0 / std::f64::consts::PI * bears, (1.5 * bears).powf(2.0 / 3.0)];
        let log = -cylinder.ln();
        let [line, rate] = if log > 2.0 { [cylinder * log, log - 1.0] } else { [cylinder + NARROW, 1.0] };
        let [flat, round] = [3.0 * (1.0 - self.round), 6.0 * self.round * ball];
        let part = flat * line + round;
        let slope = (flat * cylinder * rate + round * (2.0 / 3.0)) / pressure;
        if part < 1.0 { [part, slope] } else { [1.0, 0.0] }
    }
}

/// The gaps around a node.
struct Around {
    /// The least over the half faces.
    least: f64,
    /// The range of what a linear gap leaves,
    range: f64,
    /// the sum of its curvatures,
    bend: f64,
    /// and how nearly round it is: the less of these over the larger.
    round: f64,
}

/// The distance at a place of the surface.
#[derive(Clone, Copy)]
struct PlaceGap {
    x: Vec3,
    /// Its direction.
    n: Vec3,
    gap: f64,
    /// Whether the place is nearer to the node than to others.
    nearest: bool,
}

/// Places of a face, and whether they belong to the part that is nearest to a corner.
fn places<'a>(face: &'a FaceInPlace, corner: usize) -> impl Iterator<Item = (bool, [f64; 2])> + 'a {
    let count = face.face.corners();
    let between = |x: [f64; 2], y: [f64; 2], t: f64| std::array::from_fn(|i| x[i] + t * (y[i] - x[i]));
    let middle = face.face.middle();
    (0..count).flat_map(move |k| {
        let [at, a, b] = [0, 1, count - 1].map(|step| face.face.corner_place((k + step) % count));
        // An edge of the plane has two corners, and no width.
        let across: &[f64] = if count == 2 { &PLACES[..1] } else { &PLACES };
        across.iter().flat_map(move |&s| {
            PLACES.into_iter().map(move |t| {
                let [from, to] = [between(at, between(at, a, 0.5), t), between(between(at, b, 0.5), middle, t)];
                (k == corner, between(from, to, s))
            })
        })
    })
}

/// What the linear function along the surface that is nearest to gaps at places leaves of them.
struct Beyond {
    slope: Vec3,
    range: f64,
    /// The sum of its curvatures.
    bend: f64,
    /// The less of them over the larger.
    round: f64,
}

/// The linear function along the surface that is nearest to gaps at places, with their normals, and what it leaves.
fn beyond_linear(gaps: &[PlaceGap]) -> Beyond {
    let part = (gaps.len() as f64).recip();
    let [middle, normal] = [|gap: &PlaceGap| gap.x, |gap: &PlaceGap| gap.n]
        .map(|of| gaps.iter().fold(Vec3::zero(), |sum, gap| sum + of(gap)) * part);
    let (mean, n) = (gaps.iter().map(|gap| gap.gap).sum::<f64>() * part, normal.unit());
    let along = |gap: &PlaceGap| {
        let x = gap.x - middle;
        x - n * n.dot(x)
    };
    let farthest = |from: Vec3| {
        let across = gaps.iter().map(|gap| along(gap) - from * from.dot(along(gap)));
        across.max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or(Vec3::zero())
    };
    let first = farthest(Vec3::zero());
    let second = farthest(first.unit());
    let axes = [first.unit(), if second.norm() > THIN * first.norm() { second.unit() } else { Vec3::zero() }];
    // Normal equations of both slopes.
    let (mut squares, mut moments) = ([0.0; 3], [0.0; 2]);
    for gap in gaps {
        let ([s, t], rest) = (axes.map(|axis| axis.dot(along(gap))), gap.gap - mean);
        squares = [squares[0] + s * s, squares[1] + s * t, squares[2] + t * t];
        moments = [moments[0] + s * rest, moments[1] + t * rest];
    }
    let ([a, b, c], [p, q]) = (squares, moments);
    let det = a * c - b * b;
    let slopes = if c > 0.0 && det > 0.0 { [(c * p - b * q) / det, (a * q - b * p) / det] } else { [p / a, 0.0] };
    let slope = axes[0] * slopes[0] + axes[1] * slopes[1];
    let left = |gap: &PlaceGap| gap.gap - mean - slope.dot(along(gap));
    let extent = |[least, most]: [f64; 2], left: f64| [least.min(left), most.max(left)];
    let [least, most] = gaps.iter().map(left).fold([f64::INFINITY, f64::NEG_INFINITY], extent);
    let range = most - least;
    if range.is_nan() || range <= 0.0 {
        return Beyond { slope: Vec3::zero(), range: 0.0, bend: 0.0, round: 0.0 };
    }
    // How it bends, by its moments with the products of both coordinates; of these the principal values.
    let moment = |[a, b]: [Vec3; 2]| -> f64 {
        let product = |gap: &PlaceGap| a.dot(along(gap)) * b.dot(along(gap));
        let middle = gaps.iter().map(product).sum::<f64>() * part;
        gaps.iter().map(|gap| (product(gap) - middle) * left(gap)).sum()
    };
    let [first, mixed, second] = [[0, 0], [0, 1], [1, 1]].map(|pair| moment(pair.map(|i: usize| axes[i])));
    let (mean, half) = (0.5 * (first + second), (0.5 * (first - second)).hypot(mixed));
    let round = if mean > half { (mean - half) / (mean + half) } else { 0.0 };
    let (sin, cos) = (0.5 * (2.0 * mixed).atan2(first - second)).sin_cos();
    let direction = axes[0] * cos + axes[1] * sin;
    let square = |gap: &PlaceGap| direction.dot(along(gap)).powi(2);
    let middle = gaps.iter().map(square).sum::<f64>() * part;
    let squares: f64 = gaps.iter().map(|gap| (square(gap) - middle).powi(2)).sum();
    // At least that of a parabola of this range over all of the places.
    let least = 2.0 * range / gaps.iter().map(|gap| along(gap).dot(along(gap))).fold(0.0, f64::max);
    Beyond { slope, range, bend: (2.0 * (mean + half) / squares * (1.0 + round)).max(least), round }
}

/// Part of the size of places across which they have no width.
const THIN: f64 = 1e-3;
