//! The covered share of a pixel: its twin against closed forms and against the loops in `f64`, and parity of
//! `coverage.glsl` with its twin.

use super::Random;
use super::exact::{random_loop, twin};
use super::hard::{
    self,
    loops::{circle, closed, curve, polygon},
};
use crate::model::TrimLoop;
use crate::scene::ExactData;
use crate::spline::Bezier;
use crate::trim::{ExactTrim, LoopIndex};
use crate::twin::coverage::{Along, Cover, MOST_CELLS};
use glam::{DMat2, DVec2};

/// Points along a pixel's side in the reference, which counts those inside.
const FINE: u32 = 48;

fn data(faces: &[Vec<TrimLoop>]) -> ExactData {
    let mut data = ExactData::default();
    for loops in faces {
        data.push(&ExactTrim::with_flats(loops, DVec2::ZERO, DVec2::ONE), false);
    }
    data
}

/// A pixel somewhere in the domain.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    uv: [f32; 2],
    along: Along,
}

impl Pixel {
    /// A pixel around `uv`, about `size` of the domain wide: turned, skewed, from either side.
    fn random(random: &mut Random, uv: DVec2, size: f64) -> Self {
        let first = DVec2::from_angle(random.range(0.0, std::f64::consts::TAU));
        let turn = random.range(0.3, 2.8) * if random.integer(0, 1) == 0 { 1.0 } else { -1.0 };
        let second = DVec2::from_angle(turn).rotate(first) * 2f64.powf(random.range(-1.5, 1.5));
        let grid = random.integer(0, 3) == 0;
        let (first, second) = if grid { (DVec2::X, DVec2::NEG_Y) } else { (first, second) };
        let along = [first, second].map(|d| (d / size).as_vec2().to_array());
        Self { uv: uv.as_vec2().to_array(), along }
    }

    /// From pixels to the domain.
    fn to_domain(self) -> impl Fn(DVec2) -> DVec2 {
        let [u, v] = self.along.map(|d| DVec2::from(d.map(f64::from)));
        let inverse = DMat2::from_cols(u, v).inverse();
        let centre = DVec2::from(self.uv.map(f64::from));
        move |p| centre + inverse * p
    }
}

fn cover(data: &ExactData, face: usize, pixel: &Pixel) -> Cover {
    twin(data).cover(face, pixel.uv, pixel.along)
}

/// Winding numbers of evenly spread points of the pixel.
fn windings(index: &LoopIndex, pixel: &Pixel) -> Vec<i32> {
    let to_domain = pixel.to_domain();
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(FINE) - 0.5;
    let points = (0..FINE * FINE).map(|i| DVec2::new(at(i % FINE), at(i / FINE)));
    points.map(|p| index.winding(to_domain(p))).collect()
}

/// Area of the part of the unit square around the origin within `offset` along the unit vector `normal`.
fn half_plane(normal: DVec2, offset: f64) -> f64 {
    let (small, large) = (normal.abs().min_element(), normal.abs().max_element());
    let from_corner = 0.5 * (small + large) - offset.abs();
    let cut = match from_corner {
        x if x <= 0.0 => 0.0,
        x if x < small => x * x / (2.0 * small * large),
        x => (x - 0.5 * small) / large,
    };
    if offset < 0.0 { cut } else { 1.0 - cut }
}

/// A square with one side through the pixel: the closed form of a half plane, within the rounding of `f32`. Pixels are
/// some 1e-3 of the domain, so 2⁻²⁴ of the domain is 6e-5 of a pixel; this is multiplied by the border's length.
#[test]
fn a_straight_border_covers_what_its_half_plane_does() {
    let mut random = Random::new(21);
    let (mut cut, mut worst) = (0, 0.0f64);
    for _ in 0..4000 {
        let inward = DVec2::from_angle(random.range(0.0, std::f64::consts::TAU));
        let inward = if random.integer(0, 4) == 0 { DVec2::Y } else { inward };
        let base = DVec2::splat(0.5);
        let side = 0.2 * inward.perp();
        let corners = [base - side, base - side + 0.3 * inward, base + side + 0.3 * inward, base + side];
        let square = polygon(&corners.map(|p| (p.x, p.y)));
        let square = if random.integer(0, 1) == 0 { square } else { square.reversed() };
        let pixel = Pixel::random(&mut random, base, 1e-3);
        let to_domain = pixel.to_domain();
        let uv = base + (to_domain(DVec2::X) - base) * random.range(-0.8, 0.8);
        let pixel = Pixel { uv: uv.as_vec2().to_array(), ..pixel };
        // the border in pixels: points p with inward · (centre + M p - base) = 0
        let centre = DVec2::from(pixel.uv.map(f64::from));
        let slope = |d: DVec2| inward.dot(pixel.to_domain()(d) - centre);
        let gradient = DVec2::new(slope(DVec2::X), slope(DVec2::Y));
        let offset = -inward.dot(centre - base) / gradient.length();
        let expected = 1.0 - half_plane(gradient.normalize(), offset);
        let found = cover(&data(&[vec![square]]), 0, &pixel);
        let off = (f64::from(found.share) - expected).abs();
        assert!(off < 4e-4, "{found:?}, not {expected}, at {pixel:?}, inward {inward}");
        cut += usize::from(found.cut);
        worst = worst.max(off);
        if found.cut && expected > 0.01 && expected < 0.99 {
            let outward = DVec2::from(found.outward.map(f64::from)).normalize();
            assert!(outward.dot(-gradient.normalize()) > 0.99, "{outward}, not {}", -gradient.normalize());
        }
    }
    println!("{cut} pixels cut, worst {worst:e}");
    assert!(cut > 2000 && worst > 0.0);
}

/// Discs and stars from half a pixel to many, holes, corners and slits, and borders that waver by roundings, against 48
/// x 48 points. Points count a border along a row of them with an error of half a row, 0.010, and other borders with
/// less; arcs of half a pixel's radius bulge over their chords by an area of 0.007.
#[test]
fn shapes_cover_what_points_in_them_say() {
    let mut random = Random::new(22);
    let (mut cut, mut worst, mut sum) = (0, 0.0f64, 0.0);
    for _ in 0..3000 {
        let centre = DVec2::new(random.range(0.3, 0.7), random.range(0.3, 0.7));
        let size = 10f64.powf(random.range(-4.0, -1.5));
        let radius = size * 10f64.powf(random.range(-0.3, 1.5));
        let star = |n: u32, spread: f64| {
            let corner = |i: u32| {
                let far = if i.is_multiple_of(2) { radius } else { radius * spread };
                centre + DVec2::from_angle(f64::from(i) / f64::from(n) * std::f64::consts::TAU) * far
            };
            polygon(&(0..n).map(|i| (corner(i).x, corner(i).y)).collect::<Vec<_>>())
        };
        let square = polygon(&[(0.01, 0.01), (0.99, 0.01), (0.99, 0.99), (0.01, 0.99)]);
        let wave = |random: &mut Random, n: i32| {
            let at = |i: i32| DVec2::new(0.1 + 0.8 * f64::from(i) / f64::from(3 * n), centre.y);
            let height = 10f64.powf(random.range(-8.0, -6.0));
            let points: Vec<_> = (0..=3 * n).map(|i| at(i) + DVec2::Y * random.range(-height, height)).collect();
            let cubic = |i: usize| curve(&points[i..i + 4].iter().map(|p| (p.x, p.y)).collect::<Vec<_>>());
            let corners = [points[points.len() - 1], DVec2::new(0.9, 0.95), DVec2::new(0.1, 0.95), points[0]];
            let sides = corners.windows(2).map(|pair| Bezier::line(pair[0], pair[1]));
            closed((0..points.len() - 1).step_by(3).map(cubic).chain(sides).collect())
        };
        let shape = match random.integer(0, 4) {
            0 => vec![circle(centre, radius)],
            1 => vec![square, circle(centre, radius).reversed()],
            4 => vec![wave(&mut random, 4)],
            2 => vec![star(4, random.range(0.02, 1.0))],
            _ => vec![star(10, 0.5).reversed()],
        };
        let way = DVec2::from_angle(random.range(0.0, std::f64::consts::TAU));
        let is_wave = shape.len() == 1 && shape[0].curves().count() == 7;
        let far = if is_wave { size } else { radius };
        let uv = centre + way * far * random.range(0.4, 1.1) * if is_wave { random.range(0.0, 1.0) } else { 1.0 };
        let pixel = Pixel::random(&mut random, uv, size);
        let found = cover(&data(std::slice::from_ref(&shape)), 0, &pixel);
        let windings = windings(&LoopIndex::new(&shape), &pixel);
        let expected = windings.iter().filter(|w| **w != 0).count() as f64 / windings.len() as f64;
        let off = (f64::from(found.share) - expected).abs();
        assert!(off < 0.02, "{found:?}, not {expected}, at {pixel:?} of {shape:?}");
        if found.cut {
            (cut, worst, sum) = (cut + 1, worst.max(off), sum + off * off);
        }
    }
    println!("{cut} pixels cut, worst {worst:.4}, root mean square {:.5}", (sum / f64::from(cut)).sqrt());
    assert!(cut > 1000 && (sum / f64::from(cut)).sqrt() < 0.003);
}

/// Every hard case of trimming (loops that turn back, touch, or run along scan lines), at pixels beside its rows and in
/// its focus, unless a point of the pixel is within two loops.
#[test]
fn hard_cases() {
    let mut random = Random::new(23);
    let (mut cut, mut asked) = (0, 0);
    let mut left_whole = Vec::new();
    for case in hard::all() {
        let (index, data) = (LoopIndex::new(&case.loops), data(std::slice::from_ref(&case.loops)));
        let rows = case.rows.iter().map(|&(u, v, _)| (u, v)).chain([case.focus; 8]);
        for (u, v) in rows.take(40) {
            let size = 10f64.powf(random.range(-3.5, -1.5));
            let mut near = |reach: f64| random.range(-reach, reach) * size;
            let uv = DVec2::new(u + near(0.7), v + near(0.7));
            let pixel = Pixel::random(&mut random, uv, size);
            let windings = windings(&index, &pixel);
            if windings.iter().any(|w| w.abs() > 1) || (windings.contains(&1) && windings.contains(&-1)) {
                continue;
            }
            let found = cover(&data, 0, &pixel);
            let expected = windings.iter().filter(|w| **w != 0).count() as f64 / windings.len() as f64;
            let off = (f64::from(found.share) - expected).abs();
            if off > 0.025 && !found.cut {
                left_whole.push(case.name);
                continue;
            }
            assert!(off < 0.025, "{}: {found:?}, not {expected}, at {pixel:?}", case.name);
            cut += usize::from(found.cut);
            asked += 1;
        }
    }
    println!("{cut} of {asked} pixels cut; left whole, more than {MOST_CELLS} cells: {left_whole:?}");
    assert!(left_whole.iter().all(|name| ["7 comb", "7 holes"].contains(name)));
    assert!(cut > 100 && asked > 2 * hard::all().len());
}

/// `tests/gpu/glsl/coverage.comp` wraps the include.
#[cfg(feature = "headless")]
mod parity {
    use super::super::harness::{Gpu, Mismatch, same};
    use super::*;
    use crate::twin::coverage::Bound;

    /// Pixels of each face on the GPU, with the data of `given`, against the twin with `expected`; compares bits.
    fn compare(gpu: &Gpu, given: &ExactData, expected: &ExactData, pixels: &[Vec<Pixel>]) -> Result<(), Mismatch> {
        let words = |pixels: &Vec<Pixel>| pixels.iter().map(|p| [p.uv, p.along[0], p.along[1]]).collect();
        let asked: Vec<Vec<[[f32; 2]; 3]>> = pixels.iter().map(words).collect();
        let spirv = include_bytes!("../../tests/gpu/spirv/coverage.comp.spv");
        let answers = gpu.answers("coverage", spirv, given, (&asked, [99u32; 4]));
        for ((face, pixels), answers) in pixels.iter().enumerate().zip(answers) {
            let twin: Vec<_> = pixels.iter().map(|pixel| words_of(cover(expected, face, pixel))).collect();
            // 0 and -0 are the same border
            let unsigned = |word: u32| if word == (-0.0f32).to_bits() { 0 } else { word };
            let answers: Vec<_> = answers.into_iter().map(|a| a.map(unsigned)).collect();
            if gpu.is_exact() {
                same("answers", &answers, &twin)?;
                continue;
            }
            let wrong = |i: &usize| !is_near(answers[*i], twin[*i], &pixels[*i]);
            if let Some(index) = (0..pixels.len()).find(wrong) {
                let values = format!("GPU {:?}, twin {:?}, {:?}", answers[index], twin[index], pixels[index]);
                return Err(Mismatch { buffer: "answers", index, values });
            }
        }
        Ok(())
    }

    /// Whether the difference is within the error of quotients and roots: `twin::coverage`.
    fn is_near(gpu: [u32; 4], twin: [u32; 4], pixel: &Pixel) -> bool {
        let bound = Bound::of(pixel.along);
        let number = |words: [u32; 4], i: usize| f32::from_bits(words[i]);
        let off = |i: usize| if gpu[i] == twin[i] { 0.0 } else { (number(gpu, i) - number(twin, i)).abs() };
        let long = |words: [u32; 4]| number(words, 1).abs().max(number(words, 2).abs());
        // a border of length 0 may or may not count as crossing the pixel
        let same_cut = gpu[3] == twin[3] || long(gpu).max(long(twin)) <= bound.outward;
        off(0) <= bound.share && off(1).max(off(2)) <= bound.outward && same_cut
    }

    /// As in `coverage.comp`.
    fn words_of(c: Cover) -> [u32; 4] {
        let [x, y] = c.outward.map(|x| (x + 0.0).to_bits());
        [c.share.to_bits(), x, y, u32::from(c.cut)]
    }

    fn faces() -> (Vec<Vec<TrimLoop>>, Vec<Vec<Pixel>>) {
        let mut random = Random::new(24);
        let mut faces: Vec<Vec<TrimLoop>> = hard::all().into_iter().map(|case| case.loops).collect();
        faces.extend((0..30).map(|_| vec![random_loop(&mut random), random_loop(&mut random)]));
        let pixels = faces.iter().map(|loops| {
            let curves: Vec<_> = loops.iter().flat_map(TrimLoop::curves).collect();
            let mut pixels: Vec<Pixel> = (0..120)
                .map(|_| {
                    let curve = &curves[random.integer(0, curves.len() as u32 - 1) as usize];
                    let size = 10f64.powf(random.range(-4.0, -1.0));
                    let off = DVec2::new(random.range(-0.6, 0.6), random.range(-0.6, 0.6)) * size;
                    let uv = curve.point(random.range(0.0, 1.0)) + off;
                    Pixel::random(&mut random, uv, size)
                })
                .collect();
            let along = pixels[0].along;
            pixels.push(Pixel { uv: [f32::NAN, 0.5], along });
            pixels.push(Pixel { uv: [0.5; 2], along: [[0.0; 2]; 2] });
            pixels
        });
        let pixels = pixels.collect();
        (faces, pixels)
    }

    #[test]
    fn parity() {
        for gpu in Gpu::all() {
            let (faces, pixels) = faces();
            let data = data(&faces);
            compare(&gpu, &data, &data, &pixels).unwrap();
            gpu.finish();
        }
    }

    #[test]
    fn a_difference_is_seen() {
        let (faces, pixels) = faces();
        let data = data(&faces);
        let mut other = data.clone();
        let arc = other.arcs.iter().position(|arc| arc.fullness > 0.0).unwrap();
        other.arcs[arc].shape ^= crate::abi::ARC_UP;
        for gpu in Gpu::all() {
            assert!(compare(&gpu, &other, &data, &pixels).is_err());
            gpu.finish();
        }
    }

    /// A change of the share by little more than the bound is reported.
    #[test]
    fn a_little_more_than_the_bound_is_seen() {
        let random = &mut Random::new(25);
        let square = polygon(&[(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)]);
        let data = data(&[vec![square]]);
        let size = 2f64.powf(random.range(-8.0, -7.0));
        let along = [[(1.0 / size) as f32, 0.0], [0.0, (1.0 / size) as f32]];
        let bound = Bound::of(along);
        // the side u = 0.25 halves the pixel; a move by half a pixel covers all of it
        let pixel = |way: f32| Pixel { uv: [0.25 + way * size as f32, 0.5], along };
        for gpu in Gpu::all() {
            let least = if gpu.is_exact() { 1e-3 } else { 1.5 * bound.share };
            let (there, moved) = (vec![vec![pixel(0.0)]], vec![vec![pixel(least)]]);
            compare(&gpu, &data, &data, &there).unwrap();
            let twin = words_of(cover(&data, 0, &moved[0][0]));
            let spirv = include_bytes!("../../tests/gpu/spirv/coverage.comp.spv");
            let asked = vec![vec![[there[0][0].uv, along[0], along[1]]]];
            let answer = gpu.answers("coverage", spirv, &data, (&asked, [99u32; 4]))[0][0];
            assert!(!is_near(answer, twin, &there[0][0]), "{answer:?}, {twin:?}");
            gpu.finish();
        }
    }
}
