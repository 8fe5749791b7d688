//! Parity of the pass `sort`: exact, whatever the order in which the rows were filled.

use super::Random;
use super::chain::Chain;
use super::harness::{Gpu, Mismatch, same};
use super::shapes::cases;
use crate::abi::{Counters, Frame};
use crate::frame::trim::sort::{Bindings, Sort};
use crate::gpu::{Buffer, Texel};
use crate::twin;
use crate::twin::cross::ordered_bits;

/// Rows after `cross`.
#[derive(Clone)]
struct Rows {
    starts: Vec<u32>,
    total: u32,
    counters: Counters,
    windings: Vec<i32>,
    intercepts: Vec<u32>,
}

impl Rows {
    fn of(chain: &Chain) -> Self {
        // as before this pass
        let counters = Counters { intercepts: 0, failed: 0, ..chain.counters };
        let intercepts = chain.intercepts.clone();
        Self {
            starts: chain.row_starts.clone(),
            total: chain.row_total,
            counters,
            windings: chain.row_windings.clone(),
            intercepts,
        }
    }

    /// Each row in a different order.
    fn shuffled(mut self, random: &mut Random) -> Self {
        let room = self.intercepts.len();
        let ends = self.starts.iter().skip(1).copied().chain([self.total]).map(|end| end as usize);
        for (start, end) in self.starts.iter().map(|&start| start as usize).zip(ends).filter(|&(_, end)| end <= room) {
            let row = &mut self.intercepts[start..end];
            (1..row.len()).for_each(|i| row.swap(i, random.integer(0, i as u32) as usize));
        }
        self
    }
}

/// The results of the pass.
struct Run {
    rows: Buffer,
    intercepts: Buffer,
    counters: Buffer,
}

impl Run {
    fn new(gpu: &Gpu, frame: &Frame, given: &Rows) -> Self {
        let frame_buffer = gpu.upload("frame", &[*frame]);
        let row_starts = gpu.upload_texels("row starts", &given.starts, Texel::Words);
        let row_total = gpu.upload("row total", &[given.total]);
        let told = gpu.upload("rows", &vec![[0u32; 2]; given.starts.len()]);
        let intercepts = gpu.upload("intercepts", &given.intercepts);
        let counters = gpu.upload("counters", &[given.counters]);
        let row_windings = gpu.upload("row windings", &given.windings);
        let rows = given.starts.len() as u32;
        let dispatches = gpu.upload("dispatches", &[0, 0, 0, rows.div_ceil(128), 1, 1]);
        let bindings = Bindings {
            frame: &frame_buffer,
            row_starts: &row_starts,
            row_total: &row_total,
            rows: &told,
            intercepts: &intercepts,
            counters: &counters,
            row_windings: Some(&row_windings),
            dispatches: &dispatches,
        };
        let pass = Sort::new(gpu.device(), true).unwrap();
        gpu.run(|cmd| pass.record(cmd, &bindings));
        Self { rows: told, intercepts, counters }
    }

    fn compare(&self, gpu: &Gpu, frame: &Frame, expected: &Rows) -> Result<(), Mismatch> {
        let (mut flips, mut after) = (expected.intercepts.clone(), expected.counters);
        let counts =
            twin::sort::sort(frame, &expected.starts, expected.total, &expected.windings, &mut flips, &mut after);
        let rows: Vec<[u32; 2]> =
            expected.starts.iter().copied().zip(counts.iter().copied()).map(<[u32; 2]>::from).collect();
        same("rows", &gpu.read(&self.rows, rows.len()), &rows)?;
        let found = flips_of(expected, &counts, &gpu.read(&self.intercepts, flips.len()));
        same("flips", &found, &flips_of(expected, &counts, &flips))?;
        same("counters", &gpu.read(&self.counters, 1), &[after])
    }
}

fn compare(gpu: &Gpu, frame: &Frame, given: &Rows, expected: &Rows) -> Result<(), Mismatch> {
    Run::new(gpu, frame, given).compare(gpu, frame, expected)
}

/// The flips of all rows, one row after another; words behind them are unused.
fn flips_of(rows: &Rows, counts: &[u32], words: &[u32]) -> Vec<u32> {
    let of_row = |(&start, &count): (&u32, &u32)| &words[start as usize..][..(count >> 1) as usize];
    rows.starts.iter().zip(counts).filter(|&(_, &count)| count > 1).flat_map(of_row).copied().collect()
}

#[test]
fn parity() {
    let (gpus, mut random) = (Gpu::all(), Random::new(2));
    for case in cases() {
        let rows = Rows::of(&Chain::new(&case));
        for gpu in &gpus {
            compare(gpu, &case.frame, &rows.clone().shuffled(&mut random), &rows).unwrap();
        }
    }
    gpus.into_iter().for_each(Gpu::finish);
}

/// Rows far longer than in a drawing, with equal entries, negative `u` and windings of any sign.
#[test]
fn parity_of_long_rows() {
    let gpu = Gpu::new();
    let mut random = Random::new(3);
    let (starts, intercepts) = (Vec::new(), Vec::new());
    let mut rows = Rows { starts, total: 0, counters: Counters::default(), windings: Vec::new(), intercepts };
    for length in [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 64, 0, 1000, 8, 4097] {
        rows.starts.push(rows.intercepts.len() as u32);
        rows.windings.push(random.integer(0, 4) as i32 - 2);
        rows.intercepts.extend((0..length).map(|_| {
            let u = (random.range(-0.5, 1.5) * 100.0).round() as f32 / 100.0;
            ordered_bits(u) & !1 | random.integer(0, 1)
        }));
    }
    rows.total = rows.intercepts.len() as u32;
    rows.counters.rows = rows.starts.len() as u32;
    let frame = Frame { intercept_capacity: rows.total, ..Default::default() };
    compare(&gpu, &frame, &rows, &rows.clone().shuffled(&mut random)).unwrap();
    let tight = Frame { intercept_capacity: rows.total - 1, ..frame }; // the last row has no room
    compare(&gpu, &tight, &rows, &rows).unwrap();
    gpu.finish();
}

/// A row so long that a driver may end the loops that sort it is either right or counted as a clamp.
#[test]
fn a_row_of_too_many_is_told_of() {
    let gpu = Gpu::new();
    let mut random = Random::new(4);
    let length = 40_000;
    let intercepts = (0..length).map(|_| ordered_bits(random.range(0.0, 1.0) as f32) & !1 | random.integer(0, 1));
    let counters = Counters { rows: 1, ..Counters::default() };
    let intercepts = intercepts.collect();
    let rows = Rows { starts: vec![0], total: length, counters, windings: vec![0], intercepts };
    let frame = Frame { intercept_capacity: length, ..Default::default() };
    let run = Run::new(&gpu, &frame, &rows);
    let clamps = gpu.read::<Counters>(&run.counters, 1)[0].clamps;
    let compared = run.compare(&gpu, &frame, &rows);
    assert!(clamps == 1 || compared.is_ok(), "{clamps} clamps, {compared:?}");
    drop(run);
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let rows = Rows::of(&Chain::new(case));
    let mut other = rows.clone();
    other.intercepts[6] ^= 2; // the last stored bit of u
    assert_eq!(compare(&gpu, &case.frame, &other, &rows).unwrap_err().buffer, "flips");
    let mut other = rows.clone();
    other.intercepts[6] ^= 1; // the direction
    assert!(compare(&gpu, &case.frame, &other, &rows).is_err());
    let mut other = rows.clone();
    other.windings[0] ^= 1; // the winding at the row's start
    assert_eq!(compare(&gpu, &case.frame, &other, &rows).unwrap_err().buffer, "rows");
    gpu.finish();
}
