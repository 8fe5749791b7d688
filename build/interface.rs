//! What a shader needs of its pipeline, read out of unoptimised SPIR-V: the kind of each binding, the size of a
//! workgroup and of the push constants, and the specialisation constants. A constant's name has one id in all shaders.
//!
//! ```text
//!   OpDecorate id Binding n      OpVariable pointer id class      OpTypePointer pointer class type
//!   OpDecorate id SpecId n       OpName id "INSERT"               OpExecutionModeId main LocalSizeId x y z
//! ```
//!
//! Source: Khronos, *SPIR-V Specification* 1.6, sections 2.3, 3.6, 3.7 and 3.42.

use crate::reflect::{Module, OP_CONSTANT, OP_DECORATE, instructions};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;

const OP_TYPE_IMAGE: u16 = 25;
const OP_TYPE_SAMPLED_IMAGE: u16 = 27;
const OP_TYPE_POINTER: u16 = 32;
const OP_VARIABLE: u16 = 59;
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

/// All of `interfaces.rs`.
#[derive(Default)]
pub struct Interfaces {
    shaders: String,
    /// Ids of specialisation constants.
    constants: BTreeMap<String, u32>,
}

impl Interfaces {
    /// A shader's, whose bindings are of the kinds that `gpu::Binding` has. Those of a compute shader count up from 0.
    pub fn add(&mut self, shader: &str, words: &[u32]) -> Result<(), String> {
        let mut found = Found::default();
        instructions(words, |op, operands| found.read(op, operands));
        let module = Module::parse(words);
        let (bindings, push_bytes) = found.bindings(shader, &module)?;
        let is_compute = shader.ends_with(".comp");
        if let (true, Some(gap)) = (is_compute, bindings.iter().position(|kind| *kind == UNUSED)) {
            return Err(format!("{shader}: there is no binding {gap}"));
        }
        let group = found.group.map(|id| found.numbers.get(&id).copied().unwrap_or_default());
        if is_compute && group.contains(&0) {
            return Err(format!("{shader}: the size of its workgroups is not stated"));
        }
        let constants = found.constants.iter().filter_map(|(constant, id)| Some((module.names.get(id)?, *constant)));
        let mut ids = Vec::new();
        for (name, constant) in constants {
            let is_new = !self.constants.contains_key(name);
            if is_new && self.constants.values().any(|id| *id == constant) {
                return Err(format!("{shader}: the id {constant} of `{name}` is another constant's"));
            }
            if *self.constants.entry(name.clone()).or_insert(constant) != constant {
                return Err(format!("{shader}: `{name}` has another id than {constant} elsewhere"));
            }
            ids.push(constant);
        }
        if shader.starts_with("baseline_") {
            self.shaders.push_str("#[cfg(feature = \"baselines\")]\n");
        }
        let bindings: Vec<_> = bindings.iter().map(|kind| format!("Binding::{kind}")).collect();
        let _ = writeln!(
            self.shaders,
            "pub(super) const {}: Interface = Interface {{ group: {group:?}, push_bytes: {push_bytes}, bindings: &[{}], constants: &{ids:?} }};",
            shader.replace('.', "_").to_uppercase(),
            bindings.join(", "),
        );
        Ok(())
    }

    /// The file.
    pub fn text(&self) -> String {
        let mut text = String::from("// Written by build.rs from the shaders: what they need of their pipelines.\n");
        text.push_str("pub mod constant {\n");
        for (name, id) in &self.constants {
            let _ = writeln!(text, "    pub const {name}: u32 = {id};");
        }
        text.push_str("}\n");
        text + &self.shaders
    }
}

/// Kind of a binding that the shader has not.
const UNUSED: &str = "Unused";

impl Found {
    /// The kind of each binding from 0 on, and bytes of the push constants.
    fn bindings(&self, shader: &str, module: &Module) -> Result<(Vec<&'static str>, u32), String> {
        let mut kinds = Vec::new();
        let mut push_bytes = 0;
        for (id, &(pointer, class)) in &self.variables {
            let target = self.pointers.get(&pointer).copied().unwrap_or_default();
            if class == CLASS_PUSH_CONSTANT {
                push_bytes =
                    module.bytes(target).ok_or_else(|| format!("{shader}: push constants of no fixed size"))?;
            }
            let Some(&binding) = self.bindings.get(id) else { continue };
            let kind = match class {
                CLASS_STORAGE_BUFFER => "Storage",
                CLASS_UNIFORM => "Uniform",
                _ => match (self.images.get(&target), self.sampled.get(&target).and_then(|i| self.images.get(i))) {
                    (Some(&DIM_BUFFER), _) => "TexelBuffer",
                    (_, Some(_)) => "Sampled",
                    (Some(_), _) => "StorageImage",
                    _ => return Err(format!("{shader}: binding {binding} is of no kind that pipelines have")),
                },
            };
            kinds.resize(kinds.len().max(binding as usize + 1), UNUSED);
            kinds[binding as usize] = kind;
        }
        Ok((kinds, push_bytes))
    }

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
