//! A graphics pipeline whose bindings and push constants come from its shaders. It draws triangles, or patches of one
//! point if it has tessellation stages.

use crate::gpu::{Binding, ColourTarget, DepthTest, Device, GpuError, GraphicsInfo, Pipeline, StencilTest};
use crate::shaders::Shader;
use ash::vk;

/// The parameters of a graphics pipeline.
#[derive(Clone, Copy)]
pub(crate) struct Draw<'a> {
    pub name: &'a str,
    pub vertex: &'static Shader,
    /// Tessellation control and evaluation shader.
    pub tessellation: Option<[&'static Shader; 2]>,
    pub fragment: Option<&'static Shader>,
    /// Specialisation constants: ids of `shaders::constant`, and values. A stage without the constant ignores it.
    pub constants: &'a [(u32, u32)],
    pub cull: vk::CullModeFlags,
    /// Colour targets, in `location` order.
    pub colour: &'a [ColourTarget],
    pub depth: Option<DepthTest>,
    pub stencil: Option<StencilTest>,
}

impl<'a> Draw<'a> {
    /// Draws both sides of triangles, without attachments.
    pub(crate) fn new(name: &'a str, vertex: &'static Shader, fragment: impl Into<Option<&'static Shader>>) -> Self {
        Self {
            name,
            vertex,
            tessellation: None,
            fragment: fragment.into(),
            constants: &[],
            cull: vk::CullModeFlags::NONE,
            colour: &[],
            depth: None,
            stencil: None,
        }
    }

    /// Makes the pipeline.
    pub(crate) fn pipeline(&self, device: &Device) -> Result<Pipeline, GpuError> {
        use vk::ShaderStageFlags as Stage;
        let mut stages = vec![(Stage::VERTEX, self.vertex)];
        if let Some([control, evaluation]) = self.tessellation {
            stages.extend([(Stage::TESSELLATION_CONTROL, control), (Stage::TESSELLATION_EVALUATION, evaluation)]);
        }
        stages.extend(self.fragment.map(|shader| (Stage::FRAGMENT, shader)));
        let interfaces = || stages.iter().map(|(_, shader)| &shader.interface);
        let modules: Vec<_> = stages.iter().map(|(stage, shader)| (*stage, shader.words)).collect();
        let info = GraphicsInfo {
            name: self.name,
            stages: &modules,
            bindings: &merged(self.name, interfaces().map(|interface| interface.bindings)),
            push_bytes: interfaces().map(|interface| interface.push_bytes).max().unwrap_or_default(),
            constants: self.constants,
            topology: match self.tessellation {
                Some(_) => vk::PrimitiveTopology::PATCH_LIST,
                None => vk::PrimitiveTopology::TRIANGLE_LIST,
            },
            patch_points: u32::from(self.tessellation.is_some()),
            cull: self.cull,
            front: vk::FrontFace::COUNTER_CLOCKWISE,
            colour: self.colour,
            depth: self.depth,
            stencil: self.stencil,
        };
        Pipeline::graphics(device, &info)
    }
}

/// The bindings of all stages.
///
/// # Panics
/// If two stages use one binding for different resources.
fn merged<'b>(name: &str, stages: impl Iterator<Item = &'b [Binding]>) -> Vec<Binding> {
    let mut all = Vec::new();
    for bindings in stages {
        all.resize(all.len().max(bindings.len()), Binding::Unused);
        for (i, (merged, binding)) in all.iter_mut().zip(bindings).enumerate() {
            if *merged == Binding::Unused {
                *merged = *binding;
            }
            let agree = *binding == Binding::Unused || binding == merged;
            assert!(agree, "the stages of `{name}` have {merged:?} and {binding:?} at binding {i}");
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use Binding::{Storage, TexelBuffer, Uniform, Unused};

    #[test]
    fn each_stage_adds_its_bindings() {
        let stages: [&[Binding]; 3] = [&[], &[Uniform, Unused, Unused, Storage], &[Unused, TexelBuffer]];
        assert_eq!(merged("a", stages.into_iter()), [Uniform, TexelBuffer, Unused, Storage]);
    }

    #[test]
    #[should_panic(expected = "the stages of `a` have Uniform and Storage at binding 0")]
    fn stages_that_differ_are_told() {
        let stages: [&[Binding]; 2] = [&[Uniform], &[Storage]];
        merged("a", stages.into_iter());
    }
}
