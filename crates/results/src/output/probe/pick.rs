//! The words for a quantity at nodes: its name, and one component or invariant of it.

use crate::output::{Frame, QuantityPlace, Unit, Width};
use asperity_core::declare::nearest;
use asperity_core::tensor::{Tensor2, principal};

/// What means over the points of cells are called after.
pub const MEANS: &str = "_averaged";

/// What is found by a name, or by that of the means over points.
pub fn or_means<T>(name: &str, find: impl Fn(&str) -> Option<T>) -> Option<T> {
    find(name).or_else(|| find(&format!("{name}{MEANS}")))
}

/// A quantity and what of it is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Pick {
    /// Its name in the frames.
    pub quantity: String,
    /// Its dimension.
    pub unit: Unit,
    /// Columns: the words of each, and what it is.
    pub columns: Vec<(String, Part)>,
    width: Width,
}

/// One number of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A component by its place.
    Component(usize),
    /// Length of a vector.
    Length,
    /// A principal value of a symmetric tensor, 0 for the greatest.
    Principal(usize),
    /// A third of the trace of a symmetric tensor.
    Mean,
    /// `sqrt(3/2 s:s)` of the deviator of a stress, `sqrt(2/3 e:e)` of that of a strain.
    Equivalent,
}

const INVARIANTS: [(&str, Part); 5] = [
    ("major", Part::Principal(0)),
    ("middle", Part::Principal(1)),
    ("minor", Part::Principal(2)),
    ("mean", Part::Mean),
    ("equivalent", Part::Equivalent),
];

/// The quantities at the nodes of frames like this one.
pub fn names(frame: &Frame) -> impl Iterator<Item = &str> {
    frame.at(QuantityPlace::Node).map(|quantity| quantity.name.as_str())
}

/// The words for the numbers of a value.
fn words(width: Width) -> Vec<(&'static str, Part)> {
    let components = width.columns(false).iter();
    let components = components.filter(|(_, word)| !word.is_empty()).map(|&(i, word)| (&word[1..], Part::Component(i)));
    let more: &[_] = match width {
        Width::Scalar => &[],
        Width::Vector | Width::Axial => &[("length", Part::Length)],
        Width::Symmetric => &INVARIANTS,
    };
    components.chain(more.iter().copied()).collect()
}

impl Pick {
    /// What `text` says in a model whose frames are like this one: all components where it names none.
    ///
    /// # Errors
    /// In words, with the nearest name.
    pub fn new(text: &str, frame: &Frame, plane: bool) -> Result<Self, String> {
        let find = |name: &str| or_means(name, |name| frame.get(QuantityPlace::Node, name));
        let picked = |name: &str, columns| {
            find(name).map(|found| Self { quantity: found.name.clone(), unit: found.unit, columns, width: found.width })
        };
        if let Some(found) = find(text) {
            let columns = found.width.columns(plane).iter();
            let columns = columns.map(|&(i, word)| (format!("{text}{word}"), Part::Component(i))).collect();
            return picked(text, columns).ok_or_else(String::new);
        }
        let lost = |name: &str| {
            let all = || names(frame).flat_map(|name| [name, name.strip_suffix(MEANS).unwrap_or(name)]);
            let near = nearest(name, all()).map_or("; ".to_owned(), |near| format!("; did you mean `{near}`? "));
            let list = names(frame).map(|name| name.strip_suffix(MEANS).unwrap_or(name)).collect::<Vec<_>>().join(", ");
            format!("there is no quantity `{name}` at the nodes{near}there are {list}")
        };
        let Some((name, word)) = text.rsplit_once('.') else { return Err(lost(text)) };
        let Some(found) = find(name) else { return Err(lost(name)) };
        let known = words(found.width);
        let Some((_, part)) = known.iter().find(|(known, _)| *known == word) else {
            let list = known.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
            let near = nearest(word, known.iter().map(|(word, _)| *word));
            let near = near.map_or("; ".to_owned(), |near| format!("; did you mean `{near}`? "));
            let has = if known.is_empty() { "it is a single number".to_owned() } else { format!("it has {list}") };
            return Err(format!("`{name}` has no part `{word}`{near}{has}"));
        };
        picked(name, vec![(text.to_owned(), *part)]).ok_or_else(String::new)
    }
    /// Whether a sum over nodes is a quantity of the whole.
    pub fn adds_up(&self) -> bool {
        let extensive = matches!(self.unit, Unit::Force | Unit::Moment | Unit::Energy | Unit::Volume | Unit::Area);
        extensive && self.columns.iter().all(|(_, part)| matches!(part, Part::Component(_)))
    }
    /// Numbers in a value.
    pub fn width(&self) -> usize {
        self.width.size()
    }
}

impl Part {
    /// This part of a value; `unit` tells stress from strain.
    pub fn of(self, value: &[f64], unit: Unit) -> f64 {
        if let Self::Component(i) = self {
            return value.get(i).copied().unwrap_or(f64::NAN);
        }
        if value.iter().any(|x| x.is_nan()) {
            return f64::NAN;
        }
        let tensor = || value.first_chunk::<6>().map(|value| Tensor2::from_voigt(*value));
        let of = |part: &dyn Fn(Tensor2) -> f64| tensor().map_or(f64::NAN, part);
        match self {
            Self::Component(_) => f64::NAN,
            Self::Length => value.iter().map(|x| x * x).sum::<f64>().sqrt(),
            Self::Principal(place) => of(&|tensor| {
                let (mut values, _) = principal(&tensor);
                values.sort_by(|a, b| b.total_cmp(a));
                values[place]
            }),
            Self::Mean => of(&|tensor| tensor.trace() / 3.0),
            Self::Equivalent => of(&|tensor| {
                let deviator = tensor.deviator();
                let factor = if unit == Unit::Stress { 1.5 } else { 2.0 / 3.0 };
                (factor * deviator.contract(deviator)).sqrt()
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Quantity;

    fn frame() -> Frame {
        let mut frame = Frame::new(1, 1, 1.0);
        let mut push = |name, unit, width, values| {
            frame.push(Quantity::new(name, unit, QuantityPlace::Node, width, values)).unwrap();
        };
        push("displacement", Unit::Length, Width::Vector, vec![3.0, 4.0, 0.0]);
        push("cauchy_stress_averaged", Unit::Stress, Width::Symmetric, vec![1.0, 1.0, 4.0, 2.0, 0.0, 0.0]);
        frame
    }

    #[test]
    fn parts_are_read_by_their_words() {
        let frame = frame();
        let read = |text: &str| {
            let pick = Pick::new(text, &frame, true).unwrap();
            let value = frame.get(QuantityPlace::Node, &pick.quantity).unwrap().at(0);
            pick.columns.iter().map(|(_, part)| part.of(value, pick.unit)).collect::<Vec<_>>()
        };
        assert_eq!(read("displacement"), [3.0, 4.0]);
        assert_eq!(read("displacement.length"), [5.0]);
        // The block of x and y has the principal values 1 + 2 and 1 - 2.
        let principal = ["major", "middle", "minor"].map(|word| read(&format!("cauchy_stress.{word}"))[0]);
        assert!(principal.iter().zip([4.0, 3.0, -1.0]).all(|(a, b)| (a - b).abs() < 1e-14), "{principal:?}");
        assert_eq!(read("cauchy_stress_averaged.mean"), [2.0]);
        assert!((read("cauchy_stress.equivalent")[0] - 21_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn names_of_nothing_are_told_with_the_nearest() {
        let told = |text: &str| Pick::new(text, &frame(), true).unwrap_err();
        assert!(told("displacment.y").contains("did you mean `displacement`?"));
        assert!(told("cauchy_stress.majr").contains("did you mean `major`?"));
        assert!(told("displacement.xx").contains("x, y, z, length"));
        assert!(!Pick::new("displacement.y", &frame(), true).unwrap().adds_up());
    }
}
