//! How far terms of second order reach: the twin against surfaces in `f64`, and parity of `border_reach.glsl` with its
//! twin.

use super::Random;
use crate::construct::shapes;
use crate::spline::Patch;
use crate::twin::border_reach::{ASIDE, REMAINDER_PX, is_in_reach, remainder_px, third_order};
use glam::{DMat3, DQuat, DVec2, DVec3};

/// A sheet in a parallel view: a patch, its middle, and the change of the pixel with a step on the model.
struct Sheet {
    patch: Patch,
    to_px: DMat3,
    middle: DVec2,
}

/// What the shader derives from three evaluations.
struct Terms {
    at: DVec2,
    first: [DVec2; 2],
    second: [DVec2; 3],
    third: [f32; 3],
}

impl Sheet {
    /// Pixel and its derivatives.
    fn jet(&self, uv: DVec2) -> [DVec2; 3] {
        let jet = self.patch.jet(uv.x, uv.y);
        [jet.point, jet.du, jet.dv].map(|p| (self.to_px * p).truncate())
    }

    fn terms(&self) -> Terms {
        let h = f64::from(ASIDE);
        let [at, du, dv] = self.jet(self.middle);
        let [p, du_p, dv_p] = self.jet(self.middle + DVec2::new(h, 0.0));
        let [q, du_q, dv_q] = self.jet(self.middle + DVec2::new(0.0, h));
        let changes = [p - at - 0.5 * h * (du + du_p), q - at - 0.5 * h * (dv + dv_q), (dv_p - dv - du_q + du) / h];
        let homogeneous = |change: DVec2| [change.x as f32, change.y as f32, 0.0, 0.0];
        Terms {
            at,
            first: [du, dv],
            second: [(du_p - du) / h, 0.5 * (dv_p - dv + du_q - du) / h, (dv_q - dv) / h],
            third: third_order([at.x as f32, at.y as f32, 0.0, 1.0], changes.map(homogeneous)),
        }
    }
}

impl Terms {
    fn pixel(&self, step: DVec2) -> DVec2 {
        let [uu, uv, vv] = self.second;
        let bend = step.x * step.x * uu + 2.0 * step.x * step.y * uv + step.y * step.y * vv;
        self.at + step.x * self.first[0] + step.y * self.first[1] + 0.5 * bend
    }
}

/// A patch of a round face, turned at random, 5 to 1000 px large; half of the middles lie close to a side, where a ball
/// has its poles and a cone its tip.
fn sheet(patches: &[Patch], random: &mut Random) -> Sheet {
    let patch = patches[random.integer(0, patches.len() as u32 - 1) as usize].clone();
    let mut unit = || random.range(-1.0, 1.0);
    let turn = DQuat::from_xyzw(unit(), unit(), unit(), unit()).normalize();
    let size = 10f64.powf(random.range(0.7, 3.0));
    let v = random.pick(&[(0.0, 0.1), (0.9, 1.0), (0.0, 1.0), (0.0, 1.0)]);
    let middle = DVec2::new(random.range(0.0, 1.0), random.range(v.0, v.1));
    Sheet { patch, to_px: DMat3::from_quat(turn) * size, middle }
}

/// Within reach the terms are off by at most a third more than [`REMAINDER_PX`]. One step of a thousand is exempt:
/// there mixed terms cancel, or those of fourth order count. Most steps that are out of reach are off by more than it.
#[test]
fn terms_hold_where_they_reach() {
    let mut random = Random::new(71);
    let bodies = [shapes::sphere(1.0), shapes::cone(1.0, 0.0, 1.5), shapes::torus(1.0, 0.4)].map(Result::unwrap);
    let faces = bodies.iter().flat_map(|body| &body.part.faces);
    let patches: Vec<Patch> = faces.flat_map(|face| face.surface.patches().patches).map(|p| p.patch).collect();
    let (mut held, mut beyond, mut rare, mut off) = (0, 0, 0, 0);
    for _ in 0..20_000 {
        let sheet = sheet(&patches, &mut random);
        let terms = sheet.terms();
        let long = 10f64.powf(random.range(-2.5, -0.2));
        let step = DVec2::from_angle(random.range(0.0, 6.3)) * long;
        let error = (terms.pixel(step) - sheet.jet(sheet.middle + step)[0]).length();
        let single = |p: DVec2| [p.x as f32, p.y as f32];
        if is_in_reach(terms.third, single(sheet.middle), single(step)) {
            held += 1;
            rare += usize::from(error > 4.0 / 3.0 * f64::from(REMAINDER_PX));
            assert!(error <= 4.0 * f64::from(REMAINDER_PX), "{error} px, step {step}");
        } else {
            beyond += 1;
            off += usize::from(error > f64::from(REMAINDER_PX));
        }
    }
    assert!(held > 5000 && beyond > 1000, "{held} within reach, {beyond} beyond");
    assert!(rare * 1000 <= held, "{rare} of {held} are farther off than they reach");
    assert!(off * 2 > beyond, "{off} of {beyond} are off");
}

/// A parabola has no terms of third order; steps beyond the patches beside it are out of reach even so.
#[test]
fn a_parabola_is_followed_to_the_next_patch() {
    let point = |x: f64, y: f64| DVec3::new(x, y, x * x).extend(1.0);
    let row = |y: f64| [point(0.0, y), DVec3::new(20.0, y, 0.0).extend(1.0), point(40.0, y)];
    let patch = Patch { degree_u: 2, degree_v: 1, points: [row(0.0), row(30.0)].concat() };
    let sheet = Sheet { patch, to_px: DMat3::IDENTITY, middle: DVec2::splat(0.25) };
    let terms = sheet.terms();
    assert!(remainder_px(terms.third, [1.5, 1.5]) < 0.01, "{:?}", terms.third);
    let reaches = |u: f32, v: f32| is_in_reach(terms.third, [0.25; 2], [u, v]);
    assert!(reaches(1.7, 0.0) && reaches(-1.2, 1.7));
    assert!(!reaches(1.8, 0.0) && !reaches(0.0, -1.3) && !reaches(f32::NAN, 0.0));
}

/// `tests/gpu/glsl/border_reach.comp` wraps the include.
#[cfg(feature = "headless")]
mod parity {
    use super::super::harness::{Gpu, Mismatch, same, words};
    use super::*;
    use crate::abi;
    use crate::gpu::{Binding, ComputeInfo, Pipeline, Resource};
    use crate::twin::border_reach::{FACTORS, is_over_pole, over_seams};
    use bytemuck::{Pod, Zeroable};

    const COUNT: usize = 20_000;

    /// A question, as the shader reads it.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, Pod, Zeroable)]
    struct Given {
        q: [f32; 4],
        changes: [[f32; 4]; 3],
        middle: [f32; 2],
        uv: [f32; 2],
        at: [f32; 2],
        flags: u32,
    }

    /// The answers, as the shader writes them: bits of the factors, of the remainder and of the place; in reach; over a
    /// pole.
    type Answer = [u32; 8];

    fn givens() -> Vec<Given> {
        let mut random = Random::new(72);
        let mut number = |lo: f64, hi: f64| random.range(lo, hi) as f32;
        let mut all: Vec<Given> = (0..COUNT)
            .map(|_| {
                let w = number(0.5, 20.0);
                let size = 10f32.powf(number(-7.0, -3.0)) * w;
                let mut change = || [number(-1.0, 1.0), number(-1.0, 1.0), 0.0, number(-1e-3, 1e-3)].map(|x| x * size);
                let changes = [change(), change(), change()];
                Given {
                    q: [number(0.0, 2000.0) * w, number(0.0, 1000.0) * w, w, w],
                    changes,
                    middle: [number(0.0, 1.0), number(0.0, 1.0)],
                    uv: [number(-0.4, 0.4), number(-0.4, 0.4)],
                    at: [number(-0.5, 1.5), number(-0.5, 1.5)],
                    flags: 0,
                }
            })
            .collect();
        let flags = [
            abi::FACE_MEETS_U,
            abi::FACE_MEETS_V,
            abi::FACE_MEETS_U | (abi::BORDER_V0 | abi::BORDER_V1) << abi::FACE_POINTS,
            abi::FACE_MEETS_U | abi::FACE_MEETS_V,
            abi::BORDER_U1 << abi::FACE_POINTS,
            abi::FACE_CLOSED_U | abi::FACE_TRIMMED,
        ];
        all.iter_mut().zip(flags.into_iter().cycle()).for_each(|(given, flags)| given.flags = flags);
        all
    }

    fn expected(g: &Given) -> Answer {
        let third = third_order(g.q, g.changes);
        let at = over_seams(g.flags, g.at);
        let numbers = [third[0], third[1], third[2], remainder_px(third, g.uv), at[0], at[1]].map(f32::to_bits);
        let told = [is_in_reach(third, g.middle, g.uv), is_over_pole(g.flags, g.at)].map(u32::from);
        [numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], told[0], told[1]]
    }

    /// Within the error of quotients and roots: `twin::border_reach`.
    fn is_near(g: &Given, answer: &Answer) -> bool {
        const D: f32 = 2.5 * f32::EPSILON;
        let twin = expected(g);
        let number = |answer: &Answer, k: usize| f32::from_bits(answer[k]);
        let bounds: [f32; 3] = std::array::from_fn(|k| {
            let of_axis = |axis: usize| {
                let place = (g.q[axis] / g.q[3] * g.changes[k][3]).abs();
                3.0 * D * (g.changes[k][axis].abs() + place) / g.q[3]
            };
            2.0 * ((of_axis(0) + of_axis(1)) * FACTORS[k] + 3.0 * D * number(&twin, k))
        });
        let left = remainder_px(bounds, g.uv) + 4.0 * D * number(&twin, 3);
        let near = |k: usize, bound: f32| (number(answer, k) - number(&twin, k)).abs() <= bound;
        let clear = (number(&twin, 3) - REMAINDER_PX).abs() > left;
        (0..3).all(|k| near(k, bounds[k]))
            && near(3, left)
            && answer[4..6] == twin[4..6]
            && (answer[6] == twin[6] || !clear)
            && answer[7] == twin[7]
    }

    fn compare(gpu: &Gpu, uploaded: &[Given], givens: &[Given]) -> Result<Vec<Answer>, Mismatch> {
        let spirv = words(include_bytes!("../../tests/gpu/spirv/border_reach.comp.spv"));
        let bindings = [Binding::Storage; 2];
        let info =
            ComputeInfo { name: "border reach", spirv: &spirv, bindings: &bindings, push_bytes: 4, constants: &[] };
        let pipeline = Pipeline::compute(gpu.device(), &info).unwrap();
        let buffers = [gpu.upload("givens", uploaded), gpu.upload("answers", &vec![[99u32; 8]; givens.len()])];
        gpu.run(|cmd| {
            cmd.bind(&pipeline, &buffers.each_ref().map(Resource::from), bytemuck::bytes_of(&(givens.len() as u32)));
            cmd.dispatch(givens.len().div_ceil(64) as u32);
        });
        let answers: Vec<Answer> = gpu.read(&buffers[1], givens.len());
        if gpu.is_exact() {
            let twin: Vec<Answer> = givens.iter().map(expected).collect();
            return same("answers", &answers, &twin).map(|()| answers);
        }
        match (0..givens.len()).find(|&i| !is_near(&givens[i], &answers[i])) {
            None => Ok(answers),
            Some(index) => {
                let values = format!("GPU {:?}, twin {:?}", answers[index], expected(&givens[index]));
                Err(Mismatch { buffer: "answers", index, values })
            }
        }
    }

    #[test]
    fn parity() {
        let givens = givens();
        for gpu in Gpu::all() {
            let answers = compare(&gpu, &givens, &givens).unwrap();
            let share = |k: usize| answers.iter().filter(|answer| answer[k] == 1).count() * 100 / COUNT;
            assert!((5..95).contains(&share(6)) && share(7) > 5, "{} {}", share(6), share(7));
            let moved = answers.iter().zip(&givens).filter(|(a, g)| a[4..6] != g.at.map(f32::to_bits)).count();
            assert!(moved > COUNT / 10, "{moved} go over a seam");
            gpu.finish();
        }
    }

    /// One sheet that twists twice as much.
    #[test]
    fn a_difference_is_seen() {
        let gpu = Gpu::new();
        let givens = givens();
        let mut given = givens.clone();
        given[4711].changes[2] = given[4711].changes[2].map(|x| 2.0 * x);
        let mismatch = compare(&gpu, &given, &givens).unwrap_err();
        assert_eq!((mismatch.buffer, mismatch.index), ("answers", 4711));
        gpu.finish();
    }
}
