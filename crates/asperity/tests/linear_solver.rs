//! The linear solver of the library keeps to the contract that any other must keep to.

#[path = "support/contract.rs"]
mod contract;

use asperity::solve::{Factors, Frontal};

#[test]
fn frontal_keeps_the_contract() {
    for factors in [Factors::Auto, Factors::Fresh, Factors::Kept] {
        contract::hold(&mut Frontal::new(factors), true);
    }
}
