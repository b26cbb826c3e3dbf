//! Linear equations between displacements.

use crate::diagnose::Diagnostic;
use crate::form::{Form, Words, list, number, refers, table, table_of, word};
use crate::reader::{Name, Reader};
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};

table! {
    /// A sum of displacements, each with a factor, that stays zero.
    pub struct EquationKeys check equation {
        /// What is added up. The group of the first term may hold many nodes, for each of which the equation holds; those of
        /// the others hold one.
        terms: Vec<EquationTerm> = list(table_of(), 2..=usize::MAX).required(),
    }
}

table! {
    /// A displacement and its factor.
    pub struct EquationTerm {
        /// The node, as a group.
        group: Name = refers(Names::Group).required(),
        /// Along which axis.
        axis: Spot<Axis> = word().spot().required(),
        /// What it is multiplied by.
        factor: f64 = number(unit::NONE, Range::ANY).required(),
    }
}

/// An axis of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axis(pub usize);

impl Words for Axis {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self(0), "x", "along x (r)"),
            (Self(1), "y", "along y (z when axisymmetric)"),
            (Self(2), "z", "along z, in space"),
        ]
    }
}

fn equation(equation: &EquationKeys, reader: &mut Reader) {
    if equation.terms.iter().all(|term| term.factor == 0.0) {
        let what = format!("`{}` says nothing: all its factors are zero", reader.path());
        reader.report(Diagnostic::error(what).at(equation.place));
    }
}
