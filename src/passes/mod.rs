//! The passes of a frame, one file each.
//!
//! A pass is made once ([`new`](scan::Scan::new) compiles its pipelines) and records into a command
//! buffer any number of times. It never allocates, submits or waits. Its header says what it READS
//! and WRITES; the barriers around it are the frame's, those between its own steps are its own.

pub mod scan;
