//! Offsets and sizes of structs, read out of SPIR-V by name.
//!
//! ```text
//!   OpName            id "SceneFace"              OpTypeStruct id member types …
//!   OpMemberName      id 1 "first_row"            OpMemberDecorate id 1 Offset 4
//! ```
//!
//! A struct counts when its name is that of a `repr(C)` struct of `src/abi` and every member has an
//! offset, which is so exactly in buffers and push constants. Two shaders that lay the same struct
//! out differently are an error here; a shader and Rust that do are a failed assertion there.
//!
//! Source: Khronos, *SPIR-V Specification* 1.6, sections 2.3 and 3.42.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const OP_NAME: u16 = 5;
const OP_MEMBER_NAME: u16 = 6;
const OP_TYPE_INT: u16 = 21;
const OP_TYPE_FLOAT: u16 = 22;
const OP_TYPE_VECTOR: u16 = 23;
const OP_TYPE_MATRIX: u16 = 24;
const OP_TYPE_ARRAY: u16 = 28;
const OP_TYPE_STRUCT: u16 = 30;
pub const OP_CONSTANT: u16 = 43;
pub const OP_DECORATE: u16 = 71;
const OP_MEMBER_DECORATE: u16 = 72;
const DECORATION_ARRAY_STRIDE: u32 = 6;
const DECORATION_MATRIX_STRIDE: u32 = 7;
const DECORATION_OFFSET: u32 = 35;

/// A struct as the shaders see it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Layout {
    fields: Vec<(String, u32)>,
    bytes: u32,
}

/// Structs of `src/abi` that shaders put together from texels alone: nothing but what is drawn with them tells that they
/// are laid out so.
const OF_TEXELS: [&str; 9] =
    ["Curve", "ExactArc", "ExactBand", "ExactCell", "ExactFace", "LeafSurface", "Patch", "SunFacet", "SunTriangle"];

/// The layouts found so far.
pub struct Layouts {
    wanted: BTreeSet<String>,
    found: BTreeMap<String, (Layout, String)>,
}

impl Layouts {
    /// Looks for the public structs of the Rust sources in `abi`.
    pub fn new(abi: &Path) -> Result<Self, String> {
        let mut wanted = BTreeSet::new();
        for path in crate::files(abi) {
            let source = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            let names = source.lines().filter_map(|line| line.strip_prefix("pub struct "));
            let end = |c: char| !c.is_alphanumeric() && c != '_';
            wanted.extend(names.filter_map(|rest| rest.split(end).next()).map(str::to_owned));
        }
        wanted.retain(|name| !OF_TEXELS.contains(&name.as_str()));
        Ok(Self { wanted, found: BTreeMap::new() })
    }

    /// Adds the structs of one unoptimised module.
    pub fn add(&mut self, shader: &str, words: &[u32]) -> Result<(), String> {
        let module = Module::parse(words);
        for (&id, members) in &module.structs {
            let Some(name) = module.names.get(&id).filter(|name| self.wanted.contains(*name)) else { continue };
            let Some(layout) = module.layout(id, members) else { continue };
            match self.found.get(name) {
                Some((other, first)) if *other != layout => {
                    return Err(format!("{name} differs: {other:?} in {first}, {layout:?} in {shader}"));
                }
                Some(_) => {}
                None => {
                    self.found.insert(name.clone(), (layout, shader.to_owned()));
                }
            }
        }
        Ok(())
    }

    /// `layout.rs`. A struct of `src/abi` that no shader has is an error: its name would go unchecked.
    pub fn assertions(&self) -> Result<String, String> {
        let unseen: Vec<_> = self.wanted.iter().filter(|name| !self.found.contains_key(*name)).cloned().collect();
        if !unseen.is_empty() {
            return Err(format!(
                "structs of src/abi that no buffer or push constant of glsl has: {}",
                unseen.join(", ")
            ));
        }
        let mut text = String::from("// Written by build.rs from the shaders: what they read is what Rust writes.\n");
        for (name, (layout, _)) in &self.found {
            for (field, offset) in &layout.fields {
                let _ = writeln!(
                    text,
                    "const _: () = assert!(core::mem::offset_of!(crate::abi::{name}, {field}) == {offset});"
                );
            }
            let bytes = layout.bytes;
            let _ = writeln!(text, "const _: () = assert!(core::mem::size_of::<crate::abi::{name}>() == {bytes});");
        }
        Ok(text)
    }
}

/// A type's size and the width of its widest scalar, in bytes.
#[derive(Clone, Copy)]
struct Size {
    bytes: u32,
    align: u32,
}

#[derive(Clone, Copy)]
enum Type {
    Scalar { bytes: u32 },
    Vector { of: u32, count: u32 },
    Matrix { column: u32, count: u32 },
    Array { of: u32, length: u32 },
}

/// What layouts need of a module.
#[derive(Default)]
pub struct Module {
    pub names: HashMap<u32, String>,
    member_names: HashMap<(u32, u32), String>,
    offsets: HashMap<(u32, u32), u32>,
    matrix_strides: HashMap<(u32, u32), u32>,
    array_strides: HashMap<u32, u32>,
    constants: HashMap<u32, u32>,
    types: HashMap<u32, Type>,
    structs: BTreeMap<u32, Vec<u32>>,
}

impl Module {
    pub fn parse(words: &[u32]) -> Self {
        let mut module = Self::default();
        instructions(words, |op, operands| module.read(op, operands));
        module
    }

    fn read(&mut self, op: u16, operands: &[u32]) {
        match (op, operands) {
            (OP_NAME, [id, text @ ..]) => {
                self.names.insert(*id, string(text));
            }
            (OP_MEMBER_NAME, [id, member, text @ ..]) => {
                self.member_names.insert((*id, *member), string(text));
            }
            (OP_DECORATE, &[id, DECORATION_ARRAY_STRIDE, stride]) => {
                self.array_strides.insert(id, stride);
            }
            (OP_MEMBER_DECORATE, &[id, member, DECORATION_OFFSET, offset]) => {
                self.offsets.insert((id, member), offset);
            }
            (OP_MEMBER_DECORATE, &[id, member, DECORATION_MATRIX_STRIDE, stride]) => {
                self.matrix_strides.insert((id, member), stride);
            }
            (OP_CONSTANT, &[_, id, value, ..]) => {
                self.constants.insert(id, value);
            }
            (OP_TYPE_INT | OP_TYPE_FLOAT, &[id, bits, ..]) => {
                self.types.insert(id, Type::Scalar { bytes: bits / 8 });
            }
            (OP_TYPE_VECTOR, &[id, of, count]) => {
                self.types.insert(id, Type::Vector { of, count });
            }
            (OP_TYPE_MATRIX, &[id, column, count]) => {
                self.types.insert(id, Type::Matrix { column, count });
            }
            (OP_TYPE_ARRAY, &[id, of, length]) => {
                self.types.insert(id, Type::Array { of, length });
            }
            (OP_TYPE_STRUCT, [id, members @ ..]) => {
                self.structs.insert(*id, members.to_vec());
            }
            _ => {}
        }
    }

    /// `None` when a member has no offset or no fixed size: not a struct of a buffer, or a whole block.
    fn layout(&self, id: u32, members: &[u32]) -> Option<Layout> {
        let fields = (0u32..)
            .zip(members)
            .map(|(i, _)| Some((self.member_names.get(&(id, i))?.clone(), *self.offsets.get(&(id, i))?)))
            .collect::<Option<Vec<_>>>()?;
        Some(Layout { fields, bytes: self.struct_size(id, members)?.bytes })
    }

    /// Scalar layout: the end of the last member, rounded up to the widest scalar.
    fn struct_size(&self, id: u32, members: &[u32]) -> Option<Size> {
        let mut size = Size { bytes: 0, align: 1 };
        for (i, &member) in (0u32..).zip(members) {
            let of_member = self.size(member, self.matrix_strides.get(&(id, i)).copied())?;
            size.bytes = size.bytes.max(self.offsets.get(&(id, i))? + of_member.bytes);
            size.align = size.align.max(of_member.align);
        }
        size.bytes = size.bytes.next_multiple_of(size.align);
        Some(size)
    }

    /// Bytes of a type.
    pub fn bytes(&self, id: u32) -> Option<u32> {
        Some(self.size(id, None)?.bytes)
    }

    fn size(&self, id: u32, matrix_stride: Option<u32>) -> Option<Size> {
        if let Some(members) = self.structs.get(&id) {
            return self.struct_size(id, members);
        }
        Some(match *self.types.get(&id)? {
            Type::Scalar { bytes } => Size { bytes, align: bytes },
            Type::Vector { of, count } => {
                let scalar = self.size(of, None)?;
                Size { bytes: scalar.bytes * count, align: scalar.align }
            }
            Type::Matrix { column, count } => {
                let size = self.size(column, None)?;
                Size { bytes: matrix_stride.unwrap_or(size.bytes) * count, align: size.align }
            }
            Type::Array { of, length } => {
                let stride = *self.array_strides.get(&id)?;
                Size { bytes: stride * self.constants.get(&length)?, align: self.size(of, matrix_stride)?.align }
            }
        })
    }
}

/// Every instruction's opcode and operands.
pub fn instructions(words: &[u32], mut read: impl FnMut(u16, &[u32])) {
    // The header has five words; the first of an instruction holds its length and opcode.
    let mut rest = &words[5.min(words.len())..];
    while let Some(&first) = rest.first() {
        let (op, length) = (first as u16, (first >> 16) as usize);
        let Some(instruction) = rest.get(..length.max(1)) else { break };
        rest = &rest[instruction.len()..];
        read(op, &instruction[1..]);
    }
}

/// A string of SPIR-V: UTF-8 in little-endian words, ended by a zero byte.
fn string(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|&byte| byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
