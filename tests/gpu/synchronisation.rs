//! Synchronisation validation reports a missing barrier.

use crate::support::watched;
use selvedge::gpu::{Access, Buffer, Pool, barrier};
use selvedge::headless::Message;
use selvedge::internals::scan::{Bindings, Count, Scan};

/// Fills `values`, then scans them, with or without the barrier between.
fn fill_then_scan(with_barrier: bool) -> Vec<Message> {
    let device = watched();
    let buffer = |name| Buffer::storage(device.device(), Pool::Transient, name, 4096).unwrap();
    let [values, offsets, sums, total] = ["values", "offsets", "sums", "total"].map(buffer);
    let bindings = Bindings { values: &values, offsets: &offsets, sums: &sums, total: &total, total_index: 0 };
    let scan = Scan::new(device.device(), true).unwrap();
    device
        .submit(|cmd| {
            cmd.fill(&values, 1);
            if with_barrier {
                barrier::buffers(cmd, &[(&values, Access::TRANSFER_WRITE, Access::COMPUTE_READ)]);
            }
            scan.record(cmd, Count::Host(1000), &bindings);
        })
        .unwrap();
    drop((values, offsets, sums, total, scan));
    device.shutdown()
}

#[test]
fn a_missing_barrier_is_seen() {
    assert_eq!(fill_then_scan(true), []);
    let messages = fill_then_scan(false);
    let hazard = messages.iter().find(|m| m.id == "SYNC-HAZARD-READ-AFTER-WRITE");
    let text = &hazard.unwrap_or_else(|| panic!("no read-after-write hazard among {messages:?}")).text;
    assert!(text.contains("values"), "the hazard names the buffer: {text}");
}
