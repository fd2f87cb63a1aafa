//! Meshes in the PLY format.
