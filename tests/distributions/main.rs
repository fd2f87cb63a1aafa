//! What is sampled against the density it claims: BSDFs, lights, the choice of a light, cameras, pixel filters.

#[path = "../common/mod.rs"]
mod common;

mod bsdfs;
mod camera_importance;
mod cameras;
mod energy;
mod environments;
mod furnace;
mod hair;
mod kinds;
mod light_emission;
mod light_samplers;
mod lights;
mod measured;
mod narrow;
mod shapes;
mod spherical;
mod textured;

use glam::Vec2;

/// The first two of four random numbers.
fn first_two(u: [f32; 4]) -> Vec2 {
    Vec2::new(u[0], u[1])
}
