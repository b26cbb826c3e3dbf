//! Asperity.
