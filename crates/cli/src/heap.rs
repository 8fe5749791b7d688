//! Memory that was freed.

/// Gives freed memory back to the system. glibc keeps the pages between blocks that are in use, and they count as
/// memory that the process holds; other allocators decide by themselves.
pub fn trim() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    glibc::malloc_trim(0);
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
mod glibc {
    use std::ffi::c_int;

    // SAFETY: the declaration is that of malloc.h, and any thread may call it: MT-Safe in malloc_trim(3).
    unsafe extern "C" {
        /// `pad`: free bytes that stay at the heap's end. Returns 1 if memory was given back.
        pub safe fn malloc_trim(pad: usize) -> c_int;
    }
}

#[cfg(all(test, target_os = "linux", target_env = "gnu"))]
mod tests {
    use selvedge_jobs::resident;
    use std::hint::black_box;

    /// The last block is in use: the heap does not shrink by itself below it.
    #[test]
    fn freed_memory_goes_back() {
        const BLOCK: usize = 1 << 10;
        const MOST: usize = 256 << 10;
        let held = || resident().expect("the system tells");
        let mut blocks: Vec<Box<[u8]>> = (0..MOST).map(|_| black_box(vec![1; BLOCK].into_boxed_slice())).collect();
        let last = blocks.pop();
        let full = held();
        drop(blocks);
        // half of all blocks: other tests of the process take and free memory, too
        let some = (MOST * BLOCK / 2) as u64;
        let freed = held();
        assert!(freed + some > full, "{freed} of {full} bytes are held: the heap shrank by itself");
        super::trim();
        let trimmed = held();
        assert!(trimmed + some < full, "{trimmed} of {full} bytes are held");
        drop(last);
    }
}
