//! Memory for what rays jump about in.

// Advice about memory is unsafe to give, as there is some that loses what is written.
#![allow(unsafe_code)]

/// An empty vector with room for `count`, which the system is asked to hold in large pages: a ray through a large tree misses the
/// processor's table of pages more often than its caches. (From 500 thousand triangles on 1.1 times as many rays a second: docs/backends.md.)
pub fn vec_in_large_pages<T>(count: usize) -> Vec<T> {
    let mut vec = Vec::<T>::with_capacity(count);
    #[cfg(target_os = "linux")]
    {
        const PAGE: usize = 4096;
        let room = vec.spare_capacity_mut();
        let start = room.as_mut_ptr().cast::<u8>();
        let skipped = start.align_offset(PAGE);
        let bytes = size_of_val(room).saturating_sub(skipped) / PAGE * PAGE;
        if bytes > 0 {
            // SAFETY: the range is within the vector's memory, and this advice changes how fast it is, not what is in it.
            let advised = unsafe {
                let start = start.add(skipped).cast();
                rustix::mm::madvise(start, bytes, rustix::mm::Advice::LinuxHugepage)
            };
            // A system without large pages does as well as it can.
            let _ = advised;
        }
    }
    vec
}
