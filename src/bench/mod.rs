//! Measuring intersection backends on the rays that a renderer shoots: streams of rays, worlds made for the purpose, and rates
//! that can be trusted on a machine with other work to do.

pub mod rates;
pub mod streams;
pub mod synthetic;
