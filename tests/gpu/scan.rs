//! Parity of the prefix sum with its twin, exactly.

use crate::support::{assert_silent, read, upload, watched};
use selvedge::gpu::{Access, Buffer, Pool, barrier};
use selvedge::headless::HeadlessDevice;
use selvedge::internals::scan::{BLOCK, Bindings, Count, MAX_COUNT, Scan, block_count};
use selvedge::internals::twin;

/// Values whose total overflows, so that the sums wrap (xorshift, Marsaglia 2003).
fn values(count: u32) -> Vec<u32> {
    let mut x = 0x9E37_79B9u32;
    let mut next = || {
        x ^= x << 13;
        x ^= x >> 17;
        x ^= x << 5;
        x
    };
    (0..count).map(|_| next()).collect()
}

struct Scratch {
    offsets: Buffer,
    sums: Buffer,
    total: Buffer,
}

impl Scratch {
    fn new(device: &HeadlessDevice, count: u32) -> Self {
        let words =
            |name, words: u32| Buffer::storage(device.device(), Pool::Transient, name, u64::from(words) * 4).unwrap();
        Self { offsets: words("offsets", count), sums: words("sums", block_count(count)), total: words("total", 4) }
    }

    fn bindings<'a>(&'a self, values: &'a Buffer) -> Bindings<'a> {
        Bindings { values, offsets: &self.offsets, sums: &self.sums, total: &self.total, total_index: 2 }
    }
}

fn assert_parity(device: &HeadlessDevice, scan: &Scan, count: u32) {
    let values = values(count);
    let (offsets, total) = twin::scan::scan(&values);
    let gpu_values = upload(device, "values", &values);
    let scratch = Scratch::new(device, count);
    let bindings = scratch.bindings(&gpu_values);
    device.submit(|cmd| scan.record(cmd, Count::Host(count), &bindings)).unwrap();
    assert_eq!(read::<u32>(device, &scratch.total, 3)[2], total, "total of {count}");
    let on_gpu = read::<u32>(device, &scratch.offsets, count as usize);
    let first = on_gpu.iter().zip(&offsets).position(|(a, b)| a != b);
    assert_eq!(first, None, "first difference of {count}");
}

#[test]
fn parity_around_lanes_and_blocks() {
    let device = watched();
    let scan = Scan::new(device.device(), true).unwrap();
    for count in [0, 1, 255, 256, 257, 1023, 1024, 1025, 100_000, 1_000_003] {
        assert_parity(&device, &scan, count);
    }
    drop(scan);
    assert_silent(device);
}

/// From `BLOCK²` elements on, the sums of the blocks fill more than one block.
#[test]
fn parity_where_the_sums_are_many() {
    let device = watched();
    let scan = Scan::new(device.device(), true).unwrap();
    for count in [(1 << 24) + 1, BLOCK * BLOCK, BLOCK * BLOCK + 1, 3 * BLOCK * BLOCK + 7] {
        assert_parity(&device, &scan, count);
    }
    drop(scan);
    assert_silent(device);
}

/// Two scans in one submission; the second in place, with its total behind the offsets.
#[test]
fn several_in_a_frame_and_in_place() {
    let device = watched();
    let scan = Scan::new(device.device(), true).unwrap();
    let (first, second) = (values(5000), values(3000));
    let gpu_first = upload(&device, "first", &first);
    let mut with_total = second.clone();
    with_total.push(0);
    let in_place = upload(&device, "in place", &with_total);
    let scratch = Scratch::new(&device, 5000);
    device
        .submit(|cmd| {
            scan.record(cmd, Count::Host(5000), &scratch.bindings(&gpu_first));
            // The scans share `sums`.
            barrier::buffers(cmd, &[(&scratch.sums, Access::COMPUTE_WRITE, Access::COMPUTE_WRITE)]);
            let sums = &scratch.sums;
            let whole = Bindings { values: &in_place, offsets: &in_place, sums, total: &in_place, total_index: 3000 };
            scan.record(cmd, Count::Host(3000), &whole);
        })
        .unwrap();
    assert_eq!(read::<u32>(&device, &scratch.offsets, 5000), twin::scan::scan(&first).0);
    let (mut expected, total) = twin::scan::scan(&second);
    expected.push(total);
    assert_eq!(read::<u32>(&device, &in_place, 3001), expected);
    drop((scan, gpu_first, in_place, scratch));
    assert_silent(device);
}

/// The GPU has the count: exact, with more workgroups than needed, none, and beyond the capacity.
#[test]
fn counted_by_the_gpu() {
    let device = watched();
    let scan = Scan::new(device.device(), true).unwrap();
    let capacity = 10_000;
    let all = values(capacity);
    let gpu_values = upload(&device, "values", &all);
    let untouched = vec![u32::MAX; capacity as usize];
    for (counted, groups) in [(4097, block_count(4097)), (1024, block_count(capacity)), (0, 0), (20_000, 20)] {
        let used = counted.min(capacity) as usize;
        let counts = upload(&device, "counts", &[7, counted]);
        let arguments = upload(&device, "arguments", &[9, 9, groups, 1, 1]);
        let mut scratch = Scratch::new(&device, capacity);
        scratch.offsets = upload(&device, "offsets", &untouched);
        device
            .submit(|cmd| {
                barrier::buffers(cmd, &[(&arguments, Access::TRANSFER_WRITE, Access::INDIRECT_READ)]);
                let count = Count::Gpu { counts: &counts, index: 1, arguments: &arguments, offset: 8, capacity };
                scan.record(cmd, count, &scratch.bindings(&gpu_values));
            })
            .unwrap();
        let (mut expected, total) = twin::scan::scan(&all[..used]);
        expected.extend(&untouched[used..]);
        assert_eq!(read::<u32>(&device, &scratch.total, 3)[2], total, "total of {counted}");
        assert_eq!(read::<u32>(&device, &scratch.offsets, capacity as usize), expected, "offsets of {counted}");
    }
    drop((scan, gpu_values));
    assert_silent(device);
}

#[test]
#[should_panic(expected = "a scan of 2147483649 elements")]
fn too_many_elements_are_refused() {
    let device = watched();
    let scan = Scan::new(device.device(), true).unwrap();
    let scratch = Scratch::new(&device, 1);
    let _ = device.submit(|cmd| {
        scan.record(cmd, Count::Host(MAX_COUNT + 1), &scratch.bindings(&scratch.offsets));
    });
}
