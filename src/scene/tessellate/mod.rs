//! Surfaces that become triangles before they are rendered.

mod displacement;
mod loop_subdivision;

pub(super) use displacement::displaced;
pub(super) use loop_subdivision::subdivided;

/// More triangles than this are more than a shape can have meant: some gigabytes.
const MOST_TRIANGLES: u64 = 1 << 26;

fn too_many() -> String {
    format!("this shape would become more than {MOST_TRIANGLES} triangles")
}
