//! The table's look-up: its twin against the exact loops, and parity of `table.glsl` with its twin,
//! exactly.

use super::chain::Chain;
use super::shapes::{model_and_cameras, model_with_sieve, sheet_loops, sieve_loops};
use super::{Case, Random};
use crate::abi::{BORDER_BANDS, Face, StripRows};
use crate::trim::LoopIndex;
use crate::twin::table::{ALONG_BEFORE, ALONG_BEHIND, Table};
use crate::twin::u_bins::bin_of;
use glam::DVec2;

/// The face instance of the sheet and its strips, in the first instance of the model.
const SHEET: usize = 2;

/// The table at the end of a chain; `flips` are its intercepts after sorting, as floats.
fn table<'a>(case: &Case, chain: &'a Chain, flips: &'a [f32]) -> Table<'a> {
    Table {
        strips: &chain.strips,
        row_starts: &chain.row_starts,
        row_counts: &chain.flip_counts,
        flips,
        border_cells: &chain.border_cells,
        row_capacity: case.frame.row_capacity,
    }
}

/// Half the sides of the tested boxes.
const AROUND: [f32; 2] = [0.004, 0.002];

/// The box around a point.
fn around([u, v]: [f32; 2]) -> ([f32; 2], [f32; 2]) {
    ([u - AROUND[0], v - AROUND[1]], [u + AROUND[0], v + AROUND[1]])
}

/// Points of the normalised domain, some outside, some on its border.
fn points(count: usize) -> Vec<[f32; 2]> {
    let mut random = Random::new(4);
    let border = [[0.0, 0.0], [1.0, 1.0], [0.5, 0.0], [0.5, 1.0], [f32::NAN, 0.5], [0.5, f32::NAN]];
    let inner = (border.len()..count).map(|_| [random.range(-0.1, 1.1) as f32, random.range(-0.1, 1.1) as f32]);
    border.into_iter().chain(inner).collect()
}

/// The rows of the strip that contains a point; `None` if its bin is not visible.
fn rows_at(chain: &Chain, first_bin: u32, face: &Face, [u, v]: [f32; 2]) -> Option<StripRows> {
    let strip = first_bin + (v * face.strip_count() as f32) as u32 * face.bin_count();
    let (rows, bin) = (chain.strips[strip as usize], bin_of(u, face.bin_count()));
    (rows.lines > 0 && bin >= rows.first_bin && bin <= rows.last_bin()).then_some(rows)
}

/// A point has the result of the exact loops, unless it is nearer to a loop than half a row and a chord.
#[test]
fn the_table_decides_as_the_exact_loops_do() {
    let (model, cameras) = model_and_cameras();
    let sieve = model_with_sieve();
    let views = cameras.iter().flat_map(|camera| [(&model, sheet_loops(), camera), (&sieve, sieve_loops(), camera)]);
    let mut decided = [0, 0];
    for (model, loops, camera) in views {
        let case = Case::new(model, camera, 0.5);
        let chain = Chain::new(&case);
        let flips: Vec<f32> = chain.flips.iter().map(|&bits| f32::from_bits(bits)).collect();
        let table = table(&case, &chain, &flips);
        let placed = case.data.face_instances[SHEET];
        let (exact, domain) = (LoopIndex::new(&loops), DVec2::new(3.0, 2.0));
        let face = &case.data.faces[SHEET];
        let strips = face.strip_count();
        let speed = chain.density.face_speeds[SHEET].map(f64::from);
        for [u, v] in points(20_000).into_iter().filter(|p| p[1] > 0.0 && p[1] < 1.0) {
            let Some(rows) = rows_at(&chain, placed.first_bin, face, [u, v]) else { continue };
            // the nearest row, and a chord that deviates by chord_px where a unit covers the most pixels
            let row = 0.5 / f64::from(strips * rows.lines);
            let chord = f64::from(case.frame.chord_px) / speed[0].min(speed[1]);
            let uv = DVec2::new(u.into(), v.into());
            let off = exact.distance_scaled(uv * domain, 1.0 / domain, 1.0);
            const ROUNDING: f64 = 1e-6; // of single precision, and the direction in the last bit of u
            if off > row + chord + ROUNDING {
                let inside = table.inside(placed.first_bin, face, [u, v]);
                assert_eq!(inside, exact.contains(uv * domain), "{uv}, {off:e} from the nearest loop");
                decided[usize::from(inside)] += 1;
            }
        }
    }
    assert!(decided.iter().all(|&n| n > 3000), "outside, inside: {decided:?}");
}

/// If a box counts as inside or outside as a whole, points all over it do; and most boxes do.
#[test]
fn boxes_that_no_border_meets_are_all_the_same() {
    let (model, cameras) = model_and_cameras();
    let sieve = model_with_sieve();
    let mut all_said = [[0, 0, 0]; 2]; // undecided, outside, inside; of the sheet and of the sieve
    for (k, model, camera) in cameras.iter().flat_map(|camera| [(0, &model, camera), (1, &sieve, camera)]) {
        let said = &mut all_said[k];
        let case = Case::new(model, camera, 0.5);
        let chain = Chain::new(&case);
        let flips: Vec<f32> = chain.flips.iter().map(|&bits| f32::from_bits(bits)).collect();
        let table = table(&case, &chain, &flips);
        let (first, face) = (case.data.face_instances[SHEET].first_bin, &case.data.faces[SHEET]);
        for p in points(5_000) {
            let (lo, hi) = around(p);
            if !table.same(first, face, lo, hi) {
                said[0] += 1;
                continue;
            }
            if rows_at(&chain, first, face, p).is_none() {
                continue;
            }
            let inside = table.inside(first, face, p);
            said[1 + usize::from(inside)] += 1;
            for k in 0..15 * 15 {
                let at = |axis: usize, k: u32| lo[axis] + (hi[axis] - lo[axis]) * (k as f32 / 14.0);
                let q = [at(0, k % 15).min(hi[0]), at(1, k / 15).min(hi[1])];
                assert_eq!(table.inside(first, face, q), inside, "{q:?} unlike {p:?}");
            }
        }
    }
    let [sheet, sieve] = all_said;
    assert!(
        sheet[1] > 1000 && sheet[2] > 1000 && sheet[0] < sheet[1] + sheet[2],
        "not told, outside, inside: {sheet:?}"
    );
    assert!(sieve[1] > 100 && sieve[2] > 100, "not told, outside, inside: {sieve:?}"); // most of it is near a hole
}

/// If a line is reported without a border, all of it is like its point; if with a border, some of it is not.
#[test]
fn lines_without_borders_are_all_the_same() {
    let (model, cameras) = model_and_cameras();
    let sieve = model_with_sieve();
    let mut lines = [[0, 0]; 2]; // without and with a border; of the sheet and of the sieve
    let mut unseen = 0;
    for (k, model, camera) in cameras.iter().flat_map(|camera| [(0, &model, camera), (1, &sieve, camera)]) {
        let case = Case::new(model, camera, 0.5);
        let chain = Chain::new(&case);
        let flips: Vec<f32> = chain.flips.iter().map(|&bits| f32::from_bits(bits)).collect();
        let table = table(&case, &chain, &flips);
        let (first, face) = (case.data.face_instances[SHEET].first_bin, &case.data.faces[SHEET]);
        for [u, v] in points(5_000).into_iter().filter(|p| p[0] >= 0.0 && p[0] < 1.0) {
            let reach = 4.0 * AROUND[0];
            let told = table.along(first, face, [u, v], reach);
            let inside = table.inside(first, face, [u, v]);
            for (bit, way) in [(ALONG_BEFORE, -1.0), (ALONG_BEHIND, 1.0)] {
                let steps = (1..400).map(|step| u + way * reach * (step as f32 / 400.0));
                let mut steps = steps.take_while(|&at| bin_of(at, face.bin_count()) == bin_of(u, face.bin_count()));
                let changes = steps.any(|at| table.inside(first, face, [at, v]) != inside);
                assert!(!changes || told & bit != 0, "{u}, {v}: a border in way {way} is not told");
                lines[k][usize::from(told & bit != 0)] += 1;
                unseen += u32::from(told & bit != 0 && !changes); // nearer than a step to an end, or to another border
            }
        }
    }
    let [sheet, sieve] = lines;
    assert!(sheet[0] > 1000 && sheet[1] > 300 && sieve[0] > 1000 && sieve[1] > 1000, "without, with: {lines:?}");
    assert!(unseen * 50 < sheet[1] + sieve[1], "{unseen} of the borders that are told were not found: {lines:?}");
}

/// `tests/gpu/glsl/table.comp` wraps the include.
#[cfg(feature = "headless")]
mod parity {
    use super::super::harness::{Gpu, Mismatch, same, words};
    use super::super::shapes::cases;
    use super::*;
    use crate::gpu::{Binding, ComputeInfo, Pipeline, Resource, Texel};

    /// Words of the module; `include_bytes` aligns to bytes only.
    fn compare(gpu: &Gpu, case: &Case, given: &Chain, expected: &Chain) -> Result<(), Mismatch> {
        let placed = case.data.face_instances[SHEET];
        let (face, points) = (&case.data.faces[SHEET], points(4096));
        let frame = gpu.upload("frame", &[case.frame]);
        let of_strips = gpu.upload_texels("strips", &given.strips, Texel::U32x4);
        let rows: Vec<[u32; 2]> =
            given.row_starts.iter().copied().zip(given.flip_counts.iter().copied()).map(<[u32; 2]>::from).collect();
        let rows = gpu.upload_texels("rows", &rows, Texel::U32x2);
        let flips = gpu.upload_texels("flips", &given.flips, Texel::U32x2);
        let border_cells = gpu.upload_texels("border cells", &given.border_cells, Texel::U32x4);
        let uvs = gpu.upload("points", &points);
        let answers = gpu.upload("answers", &vec![7u32; points.len()]);
        let info = ComputeInfo {
            name: "table",
            spirv: &words(include_bytes!("../../tests/gpu/spirv/table.comp.spv")),
            bindings: &[vec![Binding::Uniform], vec![Binding::TexelBuffer; 4], vec![Binding::Storage; 2]].concat(),
            push_bytes: 16,
            constants: &[],
        };
        let pipeline = Pipeline::compute(gpu.device(), &info).unwrap();
        let push = [placed.first_bin, face.strips, AROUND[0].to_bits(), AROUND[1].to_bits()];
        gpu.run(|cmd| {
            let texels = [&of_strips, &rows, &flips, &border_cells].map(Resource::from);
            let of_points = [&uvs, &answers].map(Resource::from);
            let resources: Vec<_> = [Resource::from(&frame)].into_iter().chain(texels).chain(of_points).collect();
            cmd.bind(&pipeline, &resources, bytemuck::bytes_of(&push));
            cmd.dispatch(points.len() as u32 / 64);
        });
        let flips: Vec<f32> = expected.flips.iter().map(|&bits| f32::from_bits(bits)).collect();
        let table = table(case, expected, &flips);
        let answer = |&p: &[f32; 2]| {
            let (lo, hi) = around(p);
            let told = table.same(placed.first_bin, face, lo, hi);
            table.along(placed.first_bin, face, p, AROUND[0])
                | u32::from(told) << 3
                | u32::from(table.inside(placed.first_bin, face, p)) << 4
        };
        let twin: Vec<u32> = points.iter().map(answer).collect();
        same("answers", &gpu.read(&answers, points.len()), &twin)
    }

    #[test]
    fn parity() {
        let gpus = Gpu::all();
        for case in cases() {
            let chain = Chain::new(&case);
            gpus.iter().for_each(|gpu| compare(gpu, &case, &chain, &chain).unwrap());
        }
        gpus.into_iter().for_each(Gpu::finish);
    }

    #[test]
    fn a_difference_is_seen() {
        let gpu = Gpu::new();
        let case = &cases()[0];
        let chain = Chain::new(case);
        let mut other = chain.clone();
        let strip = case.data.face_instances[SHEET].first_bin as usize + 2;
        let row = chain.strip_starts[strip] as usize;
        other.flip_counts[row..].fill(0);
        assert!(compare(&gpu, case, &other, &chain).is_err());
        let mut other = chain.clone();
        other.border_cells[strip * BORDER_BANDS as usize..].fill([0; 4]);
        assert!(compare(&gpu, case, &other, &chain).is_err());
        gpu.finish();
    }
}
