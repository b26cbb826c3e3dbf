//! Orders of the schemes of every law of the registries, those of solids and those of interfaces: the walk is that of the tests of
//! the library.

#[allow(dead_code)]
mod interfaces;
#[allow(dead_code)]
mod solids;

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;
use asperity::integrate::Scheme;

/// The case.
pub const CASE: Case = Case { name: "orders", measure };

fn measure(_bench: &Bench) -> Result<Measured, Error> {
    let solids = solids::schemes::orders().into_iter().map(|order| ("solid", order.law, order.scheme, order.found));
    let interfaces =
        interfaces::schemes::orders().into_iter().map(|order| ("interface", order.law, order.scheme, order.found));
    let mut measured = Measured::new();
    // What is exact but for rounding has no order.
    let all = solids.chain(interfaces).filter_map(|(kind, law, scheme, found)| Some((kind, law, scheme, found?)));
    for (kind, law, scheme, found) in all {
        let scheme = match scheme {
            Scheme::BackwardEuler => "euler",
            Scheme::TwoStep => "two_step",
            Scheme::Adaptive(_) => "adaptive",
            Scheme::Midpoint(_) => "midpoint",
        };
        // Of the frames and decks of a law the least counts.
        let key = format!("{kind}_{law}_{scheme}");
        match measured.iter_mut().find(|(known, _)| *known == key) {
            Some((_, least)) => *least = found.min(*least),
            None => measured.push((key, found)),
        }
    }
    Ok(measured)
}
