//! The layout that Rust gives each structure is the one that the C compiler gives it.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_char};
use std::mem::{align_of, offset_of, size_of};

use embree_sys::*;

/// `struct EmbreeLayout` of `src/layout.c`.
#[repr(C)]
struct CLayout {
    name: *const c_char,
    size: usize,
    align_or_offset: usize,
}

unsafe extern "C" {
    static embree_layouts: CLayout;
    static embree_layout_count: usize;
}

/// Name -> (size, alignment of the type or offset of the field), as C says.
fn c_layouts() -> BTreeMap<String, (usize, usize)> {
    // SAFETY: src/layout.c defines the table with this many entries, each with a constant string; nothing writes to it.
    let table = unsafe { std::slice::from_raw_parts(&raw const embree_layouts, embree_layout_count) };
    table
        .iter()
        .map(|entry| {
            // SAFETY: each name is a string literal.
            let name = unsafe { CStr::from_ptr(entry.name) };
            (
                name.to_str().expect("ASCII").to_owned(),
                (entry.size, entry.align_or_offset),
            )
        })
        .collect()
}

const fn size_behind<T>(_: *const T) -> usize {
    size_of::<T>()
}

/// The same table from Rust's side: each type with its fields.
macro_rules! rust_layouts {
    ($($type:ident { $($field:ident)* })*) => {
        vec![$(
            (stringify!($type).to_owned(), (size_of::<$type>(), align_of::<$type>())),
            $((
                concat!(stringify!($type), ".", stringify!($field)).to_owned(),
                {
                    let value = std::mem::MaybeUninit::<$type>::uninit();
                    // SAFETY: only an address inside the allocation is made; nothing is read.
                    let field = unsafe { &raw const (*value.as_ptr()).$field };
                    (size_behind(field), offset_of!($type, $field))
                },
            ),)*
        )*]
    };
}

macro_rules! rays_and_hits {
    ($($ray:ident $hit:ident $rayhit:ident)*) => {
        rust_layouts! { $(
            $ray { org_x org_y org_z tnear dir_x dir_y dir_z time tfar mask id flags }
            $hit { Ng_x Ng_y Ng_z u v primID geomID instID }
            $rayhit { ray hit }
        )* }
    };
}

#[test]
fn rust_and_c_agree_on_every_structure() {
    let mut rust = rays_and_hits! {
        RTCRay RTCHit RTCRayHit
        RTCRay4 RTCHit4 RTCRayHit4
        RTCRay8 RTCHit8 RTCRayHit8
        RTCRay16 RTCHit16 RTCRayHit16
    };
    rust.extend(rust_layouts! {
        RTCBounds { lower_x lower_y lower_z upper_x upper_y upper_z }
        RTCQuaternionDecomposition {
            scale_x scale_y scale_z skew_xy skew_xz skew_yz shift_x shift_y shift_z
            quaternion_r quaternion_i quaternion_j quaternion_k translation_x translation_y translation_z
        }
        RTCBoundsFunctionArguments { geometryUserPtr primID timeStep bounds_o }
        RTCIntersectFunctionNArguments { valid geometryUserPtr primID context rayhit N geomID }
        RTCOccludedFunctionNArguments { valid geometryUserPtr primID context ray N geomID }
        RTCFilterFunctionNArguments { valid geometryUserPtr context ray hit N }
        EmbreeContext { instID }
        EmbreeQuery { context user filter coherent }
    });
    let rust: BTreeMap<_, _> = rust.into_iter().collect();
    assert_eq!(rust, c_layouts());
}

#[test]
fn packets_have_the_size_known_of_each_version() {
    // One more word a lane in Embree 4: the primitive of an instance array.
    let expected = match VERSION {
        (3, 13, _) => 640,
        (4, 3.., _) => 672,
        _ => return,
    };
    assert_eq!(size_of::<RTCRayHit8>(), expected);
    assert_eq!(size_of::<RTCRay8>(), 384);
}

#[test]
fn a_query_starts_with_its_context() {
    // Callbacks find the query by its context's address.
    assert_eq!(offset_of!(EmbreeQuery, context), 0);
}
