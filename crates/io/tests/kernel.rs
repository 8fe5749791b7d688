//! Volumes of the gallery's solids, against those that Open CASCADE finds in the output of `selvedge export`
//! (`tools/verify_export`, quadrature to 1e-9). `tools/verify_csg --closed-forms` does so for Boolean solids.
//!
//! Ours are fluxes of `x / 3` through the exact faces: Gauss's rule on each patch of a whole face, and for a trimmed one
//! along its loops, `∬ f du dv = ∮ (∫ f du) dv` by Green's theorem.

use glam::DVec2;
use selvedge_geometry::model::{Face, Model, Part};
use selvedge_geometry::spline::{Control, PatchGrid};
use selvedge_io::import;
use std::path::Path;

/// Share of a volume.
const SAME: f64 = 1e-6;

/// Points and weights of Gauss's rule with five points on `0..1`.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_095),
    (0.230_765_344_947_158, 0.239_314_335_249_683),
    (0.5, 0.284_444_444_444_444),
    (0.769_234_655_052_842, 0.239_314_335_249_683),
    (0.953_089_922_969_332, 0.118_463_442_528_095),
];
/// Intervals of it in a patch, and along a curve of a loop.
const INTERVALS: u32 = 8;

/// Places and weights in `a..b`, in `count` intervals.
fn places(a: f64, b: f64, count: u32) -> impl Iterator<Item = (f64, f64)> {
    let h = (b - a) / f64::from(count);
    (0..count).flat_map(move |k| GAUSS.map(|(x, w)| (a + h * (f64::from(k) + x), h * w)))
}

fn through(grid: &PatchGrid, u: f64, v: f64) -> f64 {
    let jet = grid.jet(u, v);
    jet.point.dot(jet.du.cross(jet.dv)) / 3.0
}

fn flux(face: &Face) -> f64 {
    let grid = face.surface.patches();
    let mut sum = 0.0;
    if face.loops.is_empty() {
        for p in &grid.patches {
            for (u, wu) in places(p.u.0, p.u.1, INTERVALS) {
                sum += places(p.v.0, p.v.1, INTERVALS).map(|(v, wv)| wu * wv * through(&grid, u, v)).sum::<f64>();
            }
        }
    }
    let mut knots = face.surface.knots().0.to_vec();
    knots.dedup();
    let plane = face.surface.degrees() == (1, 1);
    for c in face.loops.iter().flat_map(|l| l.curves()) {
        for (t, w) in places(0.0, 1.0, INTERVALS) {
            let (h, dh) = c.jet(t);
            let p: DVec2 = h.point();
            let rise = (dh.y - p.y * dh.z) / h.z;
            // from the first knot to the curve; of a plane one interval is exact
            let inner = |(a, b): (f64, f64)| {
                let count = if plane { 1 } else { INTERVALS };
                places(a, b, count).map(|(u, w)| w * through(&grid, u, p.y)).sum::<f64>()
            };
            let spans = knots.windows(2).map(|s| (s[0].min(p.x), s[1].min(p.x))).filter(|s| s.0 < s.1);
            sum += w * rise * spans.map(inner).sum::<f64>();
        }
    }
    if face.same_sense { sum } else { -sum }
}

fn volume(part: &Part) -> f64 {
    assert!(part.closed);
    part.faces.iter().map(flux).sum()
}

fn scene(name: &str) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/gallery");
    import::open(&folder.join(name)).unwrap().model
}

#[test]
fn parts_are_as_large_as_a_kernel_finds_them() {
    let mut worst: f64 = 0.0;
    for (name, kernel) in [
        (
            "teapot.toml",
            &[311.480_959_782_967_94, 32.430_545_232_754_1, 8.219_835_907_438_954, 6.067_203_092_867_555_5][..],
        ),
        ("gears.toml", &[16_623.060_186_768_376, 3_822.964_688_377_436_7, 15_572.728_600_746_641]),
        ("lathed.toml", &[80_587.237_360_974_67]),
        ("polyloop.toml", &[3_000.0, 2_617.366_666_666_666, 3_404.100_000_000_001, 3_468.985_464_169_503_8]),
        ("subdivided.toml", &[118_697.355_808_555_63]),
        ("trimmed.toml", &[85_273.381_522_933_18]),
    ] {
        let model = scene(name);
        let bodies = |p: &Part| p.closed && !p.faces.is_empty();
        let placed = model.instances.iter().filter(|i| bodies(&model.parts[i.part]));
        let ours: Vec<f64> = placed.map(|i| i.transform.matrix3.determinant() * volume(&model.parts[i.part])).collect();
        assert_eq!(ours.len(), kernel.len(), "{name}: {ours:?}");
        for (a, b) in ours.iter().zip(kernel) {
            let off = (a - b).abs() / b;
            eprintln!("{name}: {a} and {b}: {off:.1e}");
            worst = worst.max(off);
        }
    }
    // all copies together
    let model = scene("instances.toml");
    let all: f64 = model.instances.iter().map(|i| volume(&model.parts[i.part])).sum();
    worst = worst.max((all - 50_073.060_415_171_42).abs() / all);
    assert!(worst <= SAME, "{worst:e}");
}
