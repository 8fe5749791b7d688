// Written by build.rs from the shaders: what they read is what Rust writes.
const _: () = assert!(core::mem::offset_of!(crate::abi::ScanParams, count) == 0);
const _: () = assert!(core::mem::offset_of!(crate::abi::ScanParams, count_index) == 4);
const _: () = assert!(core::mem::offset_of!(crate::abi::ScanParams, total_index) == 8);
const _: () = assert!(core::mem::size_of::<crate::abi::ScanParams>() == 12);
