//! Imitates the arithmetic of other GPUs: shaders are rewritten so that quotients and roots are slightly wrong.
//!
//! Vulkan allows a quotient to be 2.5 units in the last place off, and a root three and more (Vulkan 1.3, appendix A,
//! "Precision and Operation of SPIR-V Instructions"). Sums and products are correctly rounded. `precise` forbids
//! contraction, so in a pass whose arithmetic is `precise` GPUs differ in quotients and roots. Here each of those is
//! multiplied by `1 + EPS` or `1 - EPS`, which is one to two units in the last place.

/// 2⁻²³.
const EPS: f32 = f32::EPSILON;

/// How quotients and roots are changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Imitation {
    /// All become larger.
    Up,
    /// All become smaller.
    Down,
    /// They become larger and smaller in turn, in the order of the module.
    Mixed,
}

impl Imitation {
    pub(super) const ALL: [Self; 3] = [Self::Up, Self::Down, Self::Mixed];

    /// The rewriting of a module.
    pub(super) fn rewriting(self) -> fn(&[u32]) -> Vec<u32> {
        match self {
            Self::Up => |words| rewritten(words, [1.0 + EPS; 2]),
            Self::Down => |words| rewritten(words, [1.0 - EPS; 2]),
            Self::Mixed => |words| rewritten(words, [1.0 + EPS, 1.0 - EPS]),
        }
    }
}

// Opcodes: SPIR-V specification, section 3.42.
const EXT_INST: u32 = 12;
const TYPE_FLOAT: u32 = 22;
const TYPE_VECTOR: u32 = 23;
const CONSTANT: u32 = 43;
const CONSTANT_COMPOSITE: u32 = 44;
const FUNCTION: u32 = 54;
const F_ADD: u32 = 129;
const F_SUB: u32 = 131;
const F_MUL: u32 = 133;
const F_DIV: u32 = 136;
/// Products of vectors and matrices, up to `OpMatrixTimesMatrix`.
const PRODUCTS: std::ops::RangeInclusive<u32> = 142..=146;
const DOT: u32 = 148;
const DECORATE: u32 = 71;
const NO_CONTRACTION: u32 = 42;
/// `Sqrt` and `InverseSqrt` of GLSL.std.450.
const ROOTS: [u32; 2] = [31, 32];

fn instructions(words: &[u32]) -> impl Iterator<Item = &[u32]> {
    let mut rest = &words[5..];
    std::iter::from_fn(move || {
        let length = (*rest.first()? >> 16) as usize;
        let (instruction, others) = rest.split_at(length);
        rest = others;
        Some(instruction)
    })
}

fn opcode(instruction: &[u32]) -> u32 {
    instruction[0] & 0xffff
}

/// The type of an instruction that is a quotient or root of single precision.
fn granted(instruction: &[u32], sizes: &[(u32, u32)]) -> Option<u32> {
    let is_root = opcode(instruction) == EXT_INST && ROOTS.contains(&instruction[4]);
    let kind = (is_root || opcode(instruction) == F_DIV).then(|| instruction[1])?;
    sizes.iter().any(|(id, _)| *id == kind).then_some(kind)
}

/// The module with its quotients and roots multiplied by the two factors in turn.
fn rewritten(words: &[u32], factors: [f32; 2]) -> Vec<u32> {
    let mut bound = words[3];
    let mut fresh = || {
        bound += 1;
        bound - 1
    };
    // types of numbers and vectors of single precision, and their sizes
    let mut sizes: Vec<(u32, u32)> = Vec::new();
    for instruction in instructions(words) {
        match opcode(instruction) {
            TYPE_FLOAT if instruction[2] == 32 => sizes.push((instruction[1], 1)),
            TYPE_VECTOR if sizes.iter().any(|(id, size)| (*id, *size) == (instruction[2], 1)) => {
                sizes.push((instruction[1], instruction[3]));
            }
            _ => {}
        }
    }
    let constants: Vec<(u32, [u32; 2])> = sizes.iter().map(|(id, _)| (*id, [fresh(), fresh()])).collect();
    let of_type = |kind: u32| constants.iter().find(|(id, _)| *id == kind).expect("a type of above").1;
    let mut all = words[..5].to_vec();
    let (mut declared, mut turn) = (false, 0);
    for instruction in instructions(words) {
        if opcode(instruction) == FUNCTION && !declared {
            declared = true;
            let number = sizes.iter().find(|(_, size)| *size == 1).map(|(id, _)| of_type(*id));
            for &(id, size) in &sizes {
                for (nth, factor) in factors.iter().enumerate() {
                    let made = of_type(id)[nth];
                    if size == 1 {
                        all.extend([4 << 16 | CONSTANT, id, made, factor.to_bits()]);
                    } else {
                        all.extend([(3 + size) << 16 | CONSTANT_COMPOSITE, id, made]);
                        all.extend(std::iter::repeat_n(number.expect("vectors are of numbers")[nth], size as usize));
                    }
                }
            }
        }
        match granted(instruction, &sizes) {
            None => all.extend(instruction),
            Some(kind) => {
                let right = fresh();
                let first = all.len();
                all.extend(instruction);
                all[first + 2] = right;
                all.extend([5 << 16 | F_MUL, kind, instruction[2], right, of_type(kind)[turn]]);
                turn = 1 - turn;
            }
        }
    }
    all[3] = bound;
    all
}

/// Counts sums that a driver may contract with a product, and dot products, whose rounding is not specified.
fn contracted(words: &[u32]) -> usize {
    let is_held = |id: u32| instructions(words).any(|i| opcode(i) == DECORATE && (i[1], i[2]) == (id, NO_CONTRACTION));
    let is_product = |i: &[u32]| opcode(i) == F_MUL || PRODUCTS.contains(&opcode(i));
    let products: Vec<u32> = instructions(words).filter(|i| is_product(i)).map(|i| i[2]).collect();
    let is_free = |id: &u32| products.contains(id) && !is_held(*id);
    let contracts = |i: &[u32]| match opcode(i) {
        F_ADD | F_SUB => !is_held(i[2]) && i[3..5].iter().any(is_free),
        DOT => !is_held(i[2]),
        _ => false,
    };
    instructions(words).filter(|i| contracts(i)).count()
}

/// In these passes, which are compared with their twins, no driver may contract sums with products.
#[test]
fn compared_passes_are_not_contracted() {
    use crate::shaders::*;
    let compared = [
        ("bound", &BOUND_COMP),
        ("carry", &CARRY_COMP),
        ("cross", &CROSS_COMP),
        ("cull_early", &CULL_EARLY_COMP),
        ("density", &DENSITY_COMP),
        ("depth_pyramid", &DEPTH_PYRAMID_COMP),
        ("edge_count", &EDGE_COUNT_COMP),
        ("edge_emit", &EDGE_EMIT_COMP),
        ("emit", &EMIT_COMP),
        ("lines", &LINES_COMP),
        ("seen_squares", &SEEN_SQUARES_COMP),
        ("segments", &SEGMENTS_COMP),
        ("dispatch_arguments", &DISPATCH_ARGUMENTS_COMP),
        ("solid_blocks", &SOLID_BLOCKS_COMP),
        ("solid_fold", &SOLID_FOLD_COMP),
        ("solid_tiles", &SOLID_TILES_COMP),
        ("sort", &SORT_COMP),
        ("split", &SPLIT_COMP),
    ];
    for (name, shader) in compared {
        assert_eq!(contracted(shader.words), 0, "{name} is not `precise`");
    }
    // this pass is not compared bit for bit: it shows that the count finds contractions
    assert!(contracted(GAP_FILL_TABLE_COMP.words) > 10);
}

#[test]
fn each_quotient_and_root_is_multiplied_once() {
    let words = crate::shaders::CROSS_COMP.words;
    let count = |words: &[u32], op| instructions(words).filter(|i| opcode(i) == op).count();
    let (before, after) = (count(words, F_DIV), rewritten(words, [1.5, 0.5]));
    let roots = instructions(words).filter(|i| opcode(i) == EXT_INST && ROOTS.contains(&i[4])).count();
    assert!(before > 3, "{before} quotients");
    assert_eq!(count(&after, F_DIV), before);
    assert_eq!(count(&after, F_MUL), count(words, F_MUL) + before + roots);
}
