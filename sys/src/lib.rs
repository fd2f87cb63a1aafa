//! Bindings to the installed Embree.
