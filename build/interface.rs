//! What a compute shader needs of its pipeline, read out of unoptimised SPIR-V: the kind of each binding, the size of a
//! workgroup and of the push constants, and the names of specialisation constants.
//!
//! ```text
//!   OpDecorate id Binding n      OpVariable pointer id class      OpTypePointer pointer class type
//!   OpDecorate id SpecId n       OpName id "INSERT"               OpExecutionModeId main LocalSizeId x y z
//! ```
//!
//! Source: Khronos, *SPIR-V Specification* 1.6, sections 2.3, 3.6, 3.7 and 3.42.

use crate::reflect::{Module, instructions};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;

const OP_CONSTANT: u16 = 43;
const OP_TYPE_IMAGE: u16 = 25;
const OP_TYPE_SAMPLED_IMAGE: u16 = 27;
const OP_TYPE_POINTER: u16 = 32;
const OP_VARIABLE: u16 = 59;
const OP_DECORATE: u16 = 71;
const OP_EXECUTION_MODE_ID: u16 = 331;
const MODE_LOCAL_SIZE_ID: u32 = 38;
const DECORATION_SPEC_ID: u32 = 1;
const DECORATION_BINDING: u32 = 33;
const CLASS_UNIFORM: u32 = 2;
const CLASS_PUSH_CONSTANT: u32 = 9;
const CLASS_STORAGE_BUFFER: u32 = 12;
const DIM_BUFFER: u32 = 5;

/// One shader's.
#[derive(Default)]
struct Found {
    /// Ids of the workgroup's size.
    group: [u32; 3],
    /// Constants of 32 bits.
    numbers: HashMap<u32, u32>,
    /// Of ids.
    bindings: HashMap<u32, u32>,
    constants: BTreeMap<u32, u32>,
    /// Pointer type and storage class of ids.
    variables: HashMap<u32, (u32, u32)>,
    /// What pointers point to.
    pointers: HashMap<u32, u32>,
    /// Dimensions of images.
    images: HashMap<u32, u32>,
    /// Image of sampled images.
    sampled: HashMap<u32, u32>,
}

/// The line of `interfaces.rs` for a shader. Bindings count up from 0, each of a kind that `gpu::Binding` has.
pub fn of_compute(shader: &str, words: &[u32]) -> Result<String, String> {
    let mut found = Found::default();
    instructions(words, |op, operands| found.read(op, operands));
    let module = Module::parse(words);
    let mut kinds = BTreeMap::new();
    let mut push_bytes = 0;
    for (id, &(pointer, class)) in &found.variables {
        let target = found.pointers.get(&pointer).copied().unwrap_or_default();
        if class == CLASS_PUSH_CONSTANT {
            push_bytes = module.bytes(target).ok_or_else(|| format!("{shader}: push constants of no fixed size"))?;
        }
        let Some(&binding) = found.bindings.get(id) else { continue };
        let kind = match class {
            CLASS_STORAGE_BUFFER => "Storage",
            CLASS_UNIFORM => "Uniform",
            _ => match (found.images.get(&target), found.sampled.get(&target).and_then(|i| found.images.get(i))) {
                (Some(&DIM_BUFFER), _) => "Texels",
                (_, Some(_)) => "Sampled",
                (Some(_), _) => "StorageImage",
                _ => return Err(format!("{shader}: binding {binding} is of no kind that pipelines have")),
            },
        };
        kinds.insert(binding, kind);
    }
    if let Some(gap) = (0..).zip(kinds.keys()).find(|(expected, binding)| expected != *binding) {
        return Err(format!("{shader}: there is no binding {}", gap.0));
    }
    let group = found.group.map(|id| found.numbers.get(&id).copied().unwrap_or_default());
    if group.contains(&0) {
        return Err(format!("{shader}: the size of its workgroups is not told"));
    }
    let kinds: Vec<_> = kinds.values().map(|kind| format!("Binding::{kind}")).collect();
    let constants = found.constants.iter().filter_map(|(constant, id)| Some((module.names.get(id)?, constant)));
    let constants: Vec<_> = constants.map(|(name, constant)| format!("({name:?}, {constant})")).collect();
    let mut text = String::new();
    if shader.starts_with("baseline_") {
        text.push_str("#[cfg(feature = \"baselines\")]\n");
    }
    let _ = writeln!(
        text,
        "pub(super) const {}: Interface = Interface {{ group: {:?}, push_bytes: {push_bytes}, bindings: &[{}], constants: &[{}] }};",
        shader.replace('.', "_").to_uppercase(),
        group,
        kinds.join(", "),
        constants.join(", "),
    );
    Ok(text)
}

impl Found {
    fn read(&mut self, op: u16, operands: &[u32]) {
        match (op, operands) {
            (OP_EXECUTION_MODE_ID, &[_, MODE_LOCAL_SIZE_ID, x, y, z]) => self.group = [x, y, z],
            (OP_CONSTANT, &[_, id, value]) => {
                self.numbers.insert(id, value);
            }
            (OP_DECORATE, &[id, DECORATION_BINDING, binding]) => {
                self.bindings.insert(id, binding);
            }
            (OP_DECORATE, &[id, DECORATION_SPEC_ID, constant]) => {
                self.constants.insert(constant, id);
            }
            (OP_TYPE_POINTER, &[id, _, target]) => {
                self.pointers.insert(id, target);
            }
            (OP_TYPE_IMAGE, &[id, _, dim, ..]) => {
                self.images.insert(id, dim);
            }
            (OP_TYPE_SAMPLED_IMAGE, &[id, image]) => {
                self.sampled.insert(id, image);
            }
            (OP_VARIABLE, &[pointer, id, class, ..]) => {
                self.variables.insert(id, (pointer, class));
            }
            _ => {}
        }
    }
}
