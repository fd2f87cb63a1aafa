//! Brute force, the reference.
