//! Parity of the decision about gap candidates, by `tests/gpu/glsl/gap_decide.comp`: the same choice in every random
//! situation. Depths are multiples of 2⁻⁶ and slopes of 2⁻⁸, so that compared values are equal or far apart.

use super::Random;
use super::harness::{Gpu, Mismatch, same, words};
use crate::abi::Frame;
use crate::gpu::{Binding, ComputeInfo, Pipeline, Resource};
use crate::twin::gap_decide::{Candidate, From, Kind, Outline, Situation, decide};
use bytemuck::{Pod, Zeroable};

/// As in the shader.
const MOST_CANDIDATES: usize = 8;
const SITUATIONS: usize = 40_000;

/// A candidate, as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
struct Given {
    kind: u32,
    from: u32,
    face: u32,
    instance: u32,
    flags: u32,
    depth: f32,
    miss: f32,
    slope: [f32; 2],
    word: [u32; 2],
    into: [f32; 2],
}

/// A situation, as the shader reads it; the own face is the last of `given`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Pixel {
    flags: u32,
    other_depth: f32,
    seen: [u32; 2],
    count: u32,
    given: [Given; MOST_CANDIDATES + 1],
}

fn bits(flags: &[bool]) -> u32 {
    flags.iter().rev().fold(0, |word, &flag| word << 1 | u32::from(flag))
}

impl Given {
    fn new(c: &Candidate) -> Self {
        Self {
            kind: c.kind as u32,
            from: c.from as u32,
            face: c.face,
            instance: c.instance,
            flags: bits(&[c.inside, c.away, c.outline.ends]),
            depth: c.depth,
            miss: c.miss,
            slope: c.slope,
            word: c.word,
            into: c.outline.into,
        }
    }
}

impl Pixel {
    fn new(s: &Situation, candidates: &[Candidate]) -> Self {
        let mut given = [Given::default(); MOST_CANDIDATES + 1];
        given.iter_mut().zip(candidates).for_each(|(given, c)| *given = Given::new(c));
        given[MOST_CANDIDATES] = Given::new(&s.own);
        let of_seen = [s.border, s.isolated, s.empty, s.empty_beside, s.other_beside, s.other.is_some()];
        let flags = [&of_seen[..], &[s.cut_open, s.in_solid]].concat();
        let other_depth = s.other.unwrap_or_default();
        Self { flags: bits(&flags), other_depth, seen: s.seen, count: candidates.len() as u32, given }
    }
}

fn frame() -> Frame {
    Frame { gap_radius_px: 0.25, deviation_px: 0.125, focal: 512.0, perspective: 1, ..Frame::default() }
}

/// `word` identifies the candidate.
fn random_candidate(random: &mut Random, word: u32) -> Candidate {
    let mut flag = || random.integer(0, 1) == 1;
    let (inside, away, ends) = (flag(), flag(), flag());
    let mut slope = || random.integer(0, 8) as f32 / 256.0 - 1.0 / 64.0;
    let (slope, into) = ([slope(), slope()], [slope(), slope()]);
    Candidate {
        kind: random.pick(&[Kind::Absent, Kind::Near, Kind::Near, Kind::Present]),
        from: random.pick(&[From::Beside, From::Beside, From::Beside, From::Beyond, From::Fold]),
        face: random.integer(1, 4),
        instance: random.integer(0, 2),
        inside,
        away,
        depth: 1.0 + random.integer(0, 12) as f32 / 64.0,
        miss: random.pick(&[0.0, 0.0, 0.0, 0.25, 0.5]),
        slope,
        word: [word, random.integer(0, 1 << 30)],
        outline: Outline { into, ends },
    }
}

fn random_situation(random: &mut Random) -> (Situation, Vec<Candidate>) {
    let count = random.integer(0, MOST_CANDIDATES as u32);
    let candidates = (1..=count).map(|k| random_candidate(random, k)).collect();
    let mut flag = || random.integer(0, 3) == 1;
    let (isolated, empty, other, cut_open, in_solid) = (flag(), flag(), flag(), flag(), flag());
    let (empty_beside, other_beside, border) = (flag(), flag(), !flag());
    let own = random_candidate(random, MOST_CANDIDATES as u32 + 1);
    let own = Candidate { from: From::Beside, ..own };
    let other = other.then(|| 1.0 + random.integer(0, 12) as f32 / 64.0);
    let own = if empty { Candidate::default() } else { own };
    let seen = if empty { [0; 2] } else { [77, 7] };
    let s = Situation { border, isolated, empty, empty_beside, other_beside, other, cut_open, in_solid, seen, own };
    (s, candidates)
}

fn situations() -> Vec<(Situation, Vec<Candidate>)> {
    let mut random = Random::new(41);
    (0..SITUATIONS).map(|_| random_situation(&mut random)).collect()
}

/// `given` on the GPU against the twin with `expected`.
fn compare(
    gpu: &Gpu,
    given: &[(Situation, Vec<Candidate>)],
    expected: &[(Situation, Vec<Candidate>)],
) -> Result<Vec<[u32; 2]>, Mismatch> {
    let spirv = words(include_bytes!("../../tests/gpu/spirv/gap_decide.comp.spv"));
    let bindings = [Binding::Uniform, Binding::Storage, Binding::Storage];
    let info = ComputeInfo { name: "gap decide", spirv: &spirv, bindings: &bindings, push_bytes: 4, constants: &[] };
    let pipeline = Pipeline::compute(gpu.device(), &info).unwrap();
    let pixels: Vec<_> = given.iter().map(|(s, candidates)| Pixel::new(s, candidates)).collect();
    let buffers = [
        gpu.upload("frame", &[frame()]),
        gpu.upload("pixels", &pixels),
        gpu.upload("answers", &vec![[99u32; 2]; pixels.len()]),
    ];
    gpu.run(|cmd| {
        cmd.bind(&pipeline, &buffers.each_ref().map(Resource::from), bytemuck::bytes_of(&(pixels.len() as u32)));
        cmd.dispatch(pixels.len().div_ceil(64) as u32);
    });
    let answers = gpu.read(&buffers[2], pixels.len());
    let twin: Vec<_> = expected.iter().map(|(s, candidates)| decide(&frame(), s, candidates)).collect();
    same("answers", &answers, &twin).map(|()| answers)
}

#[test]
fn parity() {
    for gpu in Gpu::all() {
        let situations = situations();
        let answers = compare(&gpu, &situations, &situations).unwrap();
        // every kind of choice occurs often: nothing, the visible face, the own face, a candidate
        let own = MOST_CANDIDATES as u32 + 1;
        let count = |kind: fn(u32, u32) -> bool| answers.iter().filter(|word| kind(word[0], own)).count();
        let kinds =
            [count(|w, _| w == 0), count(|w, _| w == 77), count(|w, own| w == own), count(|w, own| w > 0 && w < own)];
        assert!(kinds.iter().all(|&n| n > SITUATIONS / 200), "{kinds:?}");
        gpu.finish();
    }
}

/// One situation without the candidate that it chooses.
#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let situations = situations();
    let choice = |(s, all): &(Situation, Vec<Candidate>)| decide(&frame(), s, all);
    let without = |n: usize| {
        let (s, all) = &situations[n];
        (*s, all.iter().filter(|c| c.word != choice(&situations[n])).copied().collect::<Vec<_>>())
    };
    let index = (0..SITUATIONS).find(|&n| choice(&without(n)) != choice(&situations[n])).unwrap();
    let mut other = situations.clone();
    other[index] = without(index);
    let mismatch = compare(&gpu, &other, &situations).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("answers", index));
    gpu.finish();
}
