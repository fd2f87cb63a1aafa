//! The statistics that the tests of this crate decide by.
//!
//! A test draws from fixed seeds, so it always gives the same answer; these functions make that answer mean something. Each
//! one says how often it would be wrong for a correct program (its significance, after Sidak's correction for the number of
//! comparisons made), and `tests/statistics.rs` proves that each one fails where it should.

#![allow(dead_code, reason = "each test binary uses a part of this module")]

pub mod chi2;
pub mod means;
pub mod microfacet;
pub mod random;
pub mod reference;
pub mod render;

/// The level of each of `tests` independent tests that together have the level `significance` (Sidak 1967).
pub fn sidak(significance: f64, tests: usize) -> f64 {
    -((-significance).ln_1p() / tests as f64).exp_m1()
}
