//! All parameters of a pipeline as a key: pipelines with equal descriptions are interchangeable.

use super::layout::Binding;
use super::{Blend, ComputeInfo, GraphicsInfo};
use ash::vk;
use std::hash::{DefaultHasher, Hash, Hasher};

/// The description of a pipeline.
///
/// Each list is preceded by its length, so different descriptions have different words. A 128-bit digest replaces the
/// SPIR-V, which may have hundreds of kilobytes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Description(Vec<u32>);

impl Description {
    pub(super) fn of_compute(info: &ComputeInfo<'_>) -> Self {
        let &ComputeInfo { name, spirv, bindings, push_bytes, constants } = info;
        let mut description = Self(vec![0]);
        description.push_common(name, bindings, push_bytes, constants);
        description.push_shader(spirv);
        description
    }

    pub(super) fn of_graphics(info: &GraphicsInfo<'_>) -> Self {
        let &GraphicsInfo {
            name,
            stages,
            bindings,
            push_bytes,
            constants,
            topology,
            patch_points,
            cull,
            front,
            colour,
            depth,
            stencil,
        } = info;
        let mut description = Self(vec![1]);
        description.push_common(name, bindings, push_bytes, constants);
        description.push(stages.len() as u32);
        for (stage, spirv) in stages {
            description.push(stage.as_raw());
            description.push_shader(spirv);
        }
        let words = [topology.as_raw() as u32, patch_points, cull.as_raw(), front.as_raw() as u32];
        words.into_iter().for_each(|word| description.push(word));
        description.push(colour.len() as u32);
        for target in colour {
            description.push_format(target.format);
            description.push(match target.blend {
                Blend::Replace => 0,
                Blend::Over => 1,
                Blend::Add => 2,
                Blend::Leave => 3,
            });
        }
        description.push(u32::from(depth.is_some()));
        if let Some(depth) = depth {
            description.push_format(depth.format);
            description.push(depth.compare.as_raw() as u32);
            description.push(u32::from(depth.write));
        }
        description.push(u32::from(stencil.is_some()));
        if let Some(stencil) = stencil {
            description.push_format(stencil.format);
            description.push(stencil.pass.as_raw() as u32);
        }
        description
    }

    /// The name is part of the key, because messages of the validation layer and captures show it.
    fn push_common(&mut self, name: &str, bindings: &[Binding], push_bytes: u32, constants: &[(u32, u32)]) {
        self.push(name.len() as u32);
        name.bytes().for_each(|byte| self.push(u32::from(byte)));
        self.push(bindings.len() as u32);
        bindings.iter().for_each(|binding| self.push(*binding as u32));
        self.push(push_bytes);
        self.push(constants.len() as u32);
        for (id, bits) in constants {
            self.push(*id);
            self.push(*bits);
        }
    }

    fn push_format(&mut self, format: vk::Format) {
        self.push(format.as_raw() as u32);
    }

    fn push_shader(&mut self, spirv: &[u32]) {
        self.push(spirv.len() as u32);
        for salt in 0..2_u64 {
            let mut digest = DefaultHasher::new();
            (salt, spirv).hash(&mut digest);
            let digest = digest.finish();
            self.push(digest as u32);
            self.push((digest >> 32) as u32);
        }
    }

    fn push(&mut self, word: u32) {
        self.0.push(word);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ColourTarget, DepthTest, StencilTest};
    use super::*;

    const SPIRV: &[u32] = &[1, 2, 3, 4];
    const COMPUTE: ComputeInfo<'static> = ComputeInfo {
        name: "a",
        spirv: SPIRV,
        bindings: &[Binding::Storage, Binding::Uniform],
        push_bytes: 8,
        constants: &[(0, 1), (2, 3)],
    };

    fn all_differ(all: &[Description]) {
        for (i, a) in all.iter().enumerate() {
            assert!(all[i + 1..].iter().all(|b| a != b), "{i}: {a:?}");
        }
    }

    #[test]
    fn equal_descriptions_are_equal() {
        let copy = SPIRV.to_vec();
        assert_eq!(
            Description::of_compute(&COMPUTE),
            Description::of_compute(&ComputeInfo { spirv: &copy, ..COMPUTE })
        );
    }

    #[test]
    fn each_word_of_a_compute_pipeline_counts() {
        let of = |info: ComputeInfo<'_>| Description::of_compute(&info);
        all_differ(&[
            of(COMPUTE),
            of(ComputeInfo { name: "b", ..COMPUTE }),
            of(ComputeInfo { name: "", ..COMPUTE }),
            of(ComputeInfo { spirv: &[1, 2, 3, 5], ..COMPUTE }),
            of(ComputeInfo { spirv: &[1, 2, 3], ..COMPUTE }),
            of(ComputeInfo { bindings: &[Binding::Storage], ..COMPUTE }),
            of(ComputeInfo { bindings: &[Binding::Uniform, Binding::Storage], ..COMPUTE }),
            of(ComputeInfo { push_bytes: 4, ..COMPUTE }),
            of(ComputeInfo { constants: &[(0, 1)], ..COMPUTE }),
            of(ComputeInfo { constants: &[(0, 1), (2, 4)], ..COMPUTE }),
            of(ComputeInfo { constants: &[(0, 1), (3, 3)], ..COMPUTE }),
        ]);
    }

    #[test]
    fn each_word_of_a_graphics_pipeline_counts() {
        let (vertex, fragment) = (vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT);
        let target = |format, blend| ColourTarget { format, blend };
        let (unorm, srgb) = (vk::Format::R8G8B8A8_UNORM, vk::Format::R8G8B8A8_SRGB);
        let colour = [target(unorm, Blend::Replace)];
        let depth = DepthTest { format: vk::Format::D32_SFLOAT, compare: vk::CompareOp::LESS, write: true };
        let stencil = StencilTest { format: vk::Format::S8_UINT, pass: vk::StencilOp::REPLACE };
        let plain = GraphicsInfo {
            name: "a",
            stages: &[(vertex, SPIRV), (fragment, SPIRV)],
            bindings: &[Binding::Storage],
            push_bytes: 0,
            constants: &[(0, 1)],
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            patch_points: 0,
            cull: vk::CullModeFlags::NONE,
            front: vk::FrontFace::CLOCKWISE,
            colour: &colour,
            depth: Some(depth),
            stencil: Some(stencil),
        };
        let of = |info: GraphicsInfo<'_>| Description::of_graphics(&info);
        let with_colour = |format, blend| of(GraphicsInfo { colour: &[target(format, blend)], ..plain });
        all_differ(&[
            of(plain),
            of(GraphicsInfo { name: "b", ..plain }),
            of(GraphicsInfo { stages: &[(vertex, SPIRV)], ..plain }),
            of(GraphicsInfo { stages: &[(fragment, SPIRV), (vertex, SPIRV)], ..plain }),
            of(GraphicsInfo { stages: &[(vertex, SPIRV), (fragment, &SPIRV[1..])], ..plain }),
            of(GraphicsInfo { bindings: &[], ..plain }),
            of(GraphicsInfo { push_bytes: 4, ..plain }),
            of(GraphicsInfo { constants: &[(0, 0)], ..plain }),
            of(GraphicsInfo { topology: vk::PrimitiveTopology::PATCH_LIST, ..plain }),
            of(GraphicsInfo { patch_points: 4, ..plain }),
            of(GraphicsInfo { cull: vk::CullModeFlags::BACK, ..plain }),
            of(GraphicsInfo { front: vk::FrontFace::COUNTER_CLOCKWISE, ..plain }),
            of(GraphicsInfo { colour: &[], ..plain }),
            with_colour(srgb, Blend::Replace),
            with_colour(unorm, Blend::Over),
            with_colour(unorm, Blend::Add),
            with_colour(unorm, Blend::Leave),
            of(GraphicsInfo { depth: None, ..plain }),
            of(GraphicsInfo { depth: Some(DepthTest { format: vk::Format::D16_UNORM, ..depth }), ..plain }),
            of(GraphicsInfo { depth: Some(DepthTest { compare: vk::CompareOp::ALWAYS, ..depth }), ..plain }),
            of(GraphicsInfo { depth: Some(DepthTest { write: false, ..depth }), ..plain }),
            of(GraphicsInfo { stencil: None, ..plain }),
            of(GraphicsInfo { stencil: Some(StencilTest { pass: vk::StencilOp::KEEP, ..stencil }), ..plain }),
            of(GraphicsInfo {
                stencil: Some(StencilTest { format: vk::Format::D24_UNORM_S8_UINT, ..stencil }),
                ..plain
            }),
            Description::of_compute(&COMPUTE),
        ]);
    }
}
