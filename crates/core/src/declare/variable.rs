//! History variables that a law declares, so that they are turned, named and written without its help.

/// Nature of a history variable: how it turns and how it is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableKind {
    /// One value, which does not turn.
    Scalar,
    /// Three components.
    Vector,
    /// Six components XX YY ZZ XY YZ XZ.
    Symmetric,
}

/// A history variable of a law, besides the stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variable {
    /// The name outputs use: `equivalent_plastic_strain`.
    pub name: &'static str,
    /// Its nature.
    pub kind: VariableKind,
}

impl Variable {
    /// Number of values it takes.
    pub fn len(&self) -> usize {
        match self.kind {
            VariableKind::Scalar => 1,
            VariableKind::Vector => 3,
            VariableKind::Symmetric => 6,
        }
    }
    /// Never: every variable has a value.
    pub fn is_empty(&self) -> bool {
        false
    }
}
