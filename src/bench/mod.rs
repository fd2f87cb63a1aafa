//! Measuring intersection backends on the rays that a renderer shoots: `lucerna bench`.
//!
//! A [`case`] is a world and [`streams`] of rays, [`recorded`] from a render, [traced](paths) through a [`synthetic`] world, or read from a
//! [`mod@file`]. The [`contenders`] are builds of both backends and the ways to trace through each; [`rates`] times them side by side and
//! [`answers`] compares what they find. The [`report`] of it all becomes a [`table`] for terminals and a [`page`] with plots.

pub mod answers;
pub mod case;
pub mod contenders;
pub mod file;
pub mod machine;
pub mod page;
pub mod paths;
pub mod rates;
pub mod recorded;
pub mod report;
pub mod streams;
pub mod synthetic;
pub mod table;
