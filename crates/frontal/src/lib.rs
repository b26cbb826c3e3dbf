//! Sparse LU.
