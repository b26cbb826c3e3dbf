//! Probes: chosen quantities at a node, of a group, at a point that the material carries, or along a line of such points,
//! a row an increment in a table of its own.

mod pick;
mod place;
mod table;

pub use pick::{MEANS, Pick, names, or_means};
pub use place::{ProbeSpot, Share, shares, spot};
pub use table::ProbeTable;

use super::{Frame, QuantityPlace};

/// What is read where.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// The name that its file has.
    pub name: String,
    /// Where it is read.
    pub at: At,
    /// Nodal quantities by the user's words, each with a component or an invariant where it has several.
    pub quantities: Vec<String>,
}

/// Where a probe reads.
#[derive(Debug, Clone, PartialEq)]
pub enum At {
    /// At nodes, with their shares: a mean and whatever else is asked of them.
    Nodes(Vec<Share>, Vec<Take>),
    /// At a point, by the nodes of the cell that it lies in.
    Point(ProbeSpot),
    /// At points along a line, each with its distance from the first.
    Path(Vec<(f64, ProbeSpot)>),
}

/// What is taken of the values of a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Take {
    /// The mean over its faces, or over its cells, or where it has neither over its nodes.
    Mean,
    /// The least at its nodes.
    Least,
    /// The greatest at its nodes.
    Greatest,
    /// The sum over its nodes.
    Sum,
}

impl Take {
    /// All, with the word for each.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Mean, "mean"), (Self::Least, "least"), (Self::Greatest, "greatest"), (Self::Sum, "sum")];

    /// Its word.
    pub fn word(self) -> &'static str {
        Self::ALL.iter().find(|(take, _)| *take == self).map_or("", |(_, word)| word)
    }

    /// Of values at nodes with the shares of these; nodes without a value do not count.
    fn of(self, shares: &[Share], value: impl Fn(usize) -> f64) -> f64 {
        let known = || shares.iter().map(|share| (share.part, value(share.node))).filter(|(_, x)| !x.is_nan());
        let values = || known().map(|(_, x)| x);
        match self {
            Self::Least => values().reduce(f64::min).unwrap_or(f64::NAN),
            Self::Greatest => values().reduce(f64::max).unwrap_or(f64::NAN),
            Self::Sum => values().sum(),
            Self::Mean => {
                let [sum, whole] = known().fold([0.0; 2], |[sum, whole], (part, x)| [sum + part * x, whole + part]);
                // Sides on the axis have no area.
                if whole > 0.0 { sum / whole } else { values().sum::<f64>() / values().count() as f64 }
            }
        }
    }
}

impl Probe {
    /// What is wrong with its quantities in a model whose frames are like this one, in words; with each the number of the
    /// quantity.
    pub fn faults(&self, frame: &Frame, plane: bool) -> Vec<(usize, String)> {
        let sums = matches!(&self.at, At::Nodes(_, takes) if takes.contains(&Take::Sum));
        let fault = |(i, name): (usize, &String)| match Pick::new(name, frame, plane) {
            Err(fault) => Some((i, fault)),
            Ok(pick) if sums && !pick.adds_up() => Some((
                i,
                format!("a sum of `{name}` over nodes has no meaning: forces and loads add up, fields have a mean"),
            )),
            Ok(_) => None,
        };
        self.quantities.iter().enumerate().filter_map(fault).collect()
    }
    /// The values of a quantity at the nodes, one after another.
    fn values(frame: &Frame, pick: &Pick) -> Option<Vec<f64>> {
        frame.get(QuantityPlace::Node, &pick.quantity).map(|quantity| quantity.values.clone())
    }
}
