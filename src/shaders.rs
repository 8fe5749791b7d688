//! The SPIR-V of every entry point of `glsl/`: `scan_add.comp` is [`SCAN_ADD_COMP`].
//!
//! Compiled by `build.rs`, or committed in `glsl/spirv/`; see there.

use crate::gpu::Binding;

/// The bytes as little-endian words, aligned for Vulkan.
const fn words<const COUNT: usize>(bytes: &[u8]) -> [u32; COUNT] {
    let (chunks, []) = bytes.as_chunks::<4>() else { panic!("SPIR-V is made of 4-byte words") };
    assert!(chunks.len() == COUNT);
    let mut words = [0; COUNT];
    let mut i = 0;
    while i < COUNT {
        words[i] = u32::from_le_bytes(chunks[i]);
        i += 1;
    }
    words
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// A shader, and its interface to the pipeline.
#[derive(Debug)]
pub struct Shader {
    /// The SPIR-V.
    pub words: &'static [u32],
    /// Read from the SPIR-V.
    pub interface: Interface,
}

/// The interface of a shader to its pipeline.
#[derive(Debug)]
pub struct Interface {
    /// Threads of a workgroup; 0 for graphics stages.
    pub group: [u32; 3],
    /// Bytes of the push constants.
    pub push_bytes: u32,
    /// Bindings, from binding 0 on.
    pub bindings: &'static [Binding],
    /// Ids of the specialisation constants.
    pub constants: &'static [u32],
}

/// Ids of specialisation constants.
pub use interfaces::constant;

/// The interfaces of all shaders.
mod interfaces {
    use super::{Binding, Interface};
    include!(concat!(env!("OUT_DIR"), "/spirv/interfaces.rs"));
}

/// The shaders of one way to trim: `glsl/include/trim.glsl`.
#[derive(Clone, Copy, Debug)]
pub struct TrimTest {
    /// Its name in pipelines' names.
    pub way: &'static str,
    /// Fragment shader of pass `visibility`.
    pub visibility: &'static Shader,
    /// Fragment shader of pass `operand_patch`.
    pub operand_patch: &'static Shader,
    /// Pass `gap_fill`.
    pub gap_fill: &'static Shader,
    /// Both again, for a volume that trims the scene; `None` if the way draws no such scene.
    pub within: Option<Within>,
    /// `None` if the way smooths no borders.
    pub borders: Option<Borders>,
    /// Pass `edge_line`, and within a volume; `None`: [`EDGE_LINE_PLAIN`], which trusts no trimmed face.
    pub edge_line: Option<[&'static Shader; 2]>,
    /// Pass `edge_fold`; `None`: that of scenes without trims.
    pub edge_fold: Option<&'static Shader>,
}

/// Shaders of smooth borders, without and with a volume.
#[derive(Clone, Copy, Debug)]
pub struct Borders {
    /// Pass `border_mix`.
    pub mix: [&'static Shader; 2],
    /// Pass `border_follow`.
    pub follow: [&'static Shader; 2],
}

/// Those of scenes without trims.
pub static BORDERS_PLAIN: Borders = Borders {
    mix: [&BORDER_MIX_PLAIN_COMP, &BORDER_MIX_PLAIN_VOLUME_COMP],
    follow: [&BORDER_FOLLOW_PLAIN_COMP, &BORDER_FOLLOW_PLAIN_VOLUME_COMP],
};

/// Pass `edge_line` of scenes without trims, and within a volume.
pub static EDGE_LINE_PLAIN: [&Shader; 2] = [&EDGE_LINE_PLAIN_COMP, &EDGE_LINE_PLAIN_VOLUME_COMP];

/// Shaders of scenes that a volume trims: `glsl/include/volume.glsl`.
#[derive(Clone, Copy, Debug)]
pub struct Within {
    /// Fragment shader of pass `visibility`.
    pub visibility: &'static Shader,
    /// Pass `gap_fill`.
    pub gap_fill: &'static Shader,
}

/// The u-intercept table.
pub static TRIM_TABLE: TrimTest = TrimTest {
    way: "table",
    visibility: &VISIBILITY_TABLE_FRAG,
    operand_patch: &OPERAND_PATCH_TABLE_FRAG,
    gap_fill: &GAP_FILL_TABLE_COMP,
    within: Some(Within { visibility: &VISIBILITY_TABLE_VOLUME_FRAG, gap_fill: &GAP_FILL_TABLE_VOLUME_COMP }),
    borders: Some(Borders {
        mix: [&BORDER_MIX_TABLE_COMP, &BORDER_MIX_TABLE_VOLUME_COMP],
        follow: [&BORDER_FOLLOW_TABLE_COMP, &BORDER_FOLLOW_TABLE_VOLUME_COMP],
    }),
    edge_line: Some([&EDGE_LINE_TABLE_COMP, &EDGE_LINE_TABLE_VOLUME_COMP]),
    edge_fold: Some(&EDGE_FOLD_TABLE_COMP),
};
/// Cells with lists of arcs.
pub static TRIM_EXACT: TrimTest = TrimTest {
    way: "exact",
    visibility: &VISIBILITY_EXACT_FRAG,
    operand_patch: &OPERAND_PATCH_EXACT_FRAG,
    gap_fill: &GAP_FILL_EXACT_COMP,
    within: Some(Within { visibility: &VISIBILITY_EXACT_VOLUME_FRAG, gap_fill: &GAP_FILL_EXACT_VOLUME_COMP }),
    borders: Some(Borders {
        mix: [&BORDER_MIX_EXACT_COMP, &BORDER_MIX_EXACT_VOLUME_COMP],
        follow: [&BORDER_FOLLOW_EXACT_COMP, &BORDER_FOLLOW_EXACT_VOLUME_COMP],
    }),
    edge_line: Some([&EDGE_LINE_EXACT_COMP, &EDGE_LINE_EXACT_VOLUME_COMP]),
    edge_fold: Some(&EDGE_FOLD_EXACT_COMP),
};

/// No test.
#[cfg(feature = "baselines")]
pub static TRIM_UNTRIMMED: TrimTest = TrimTest {
    way: "untrimmed",
    visibility: &BASELINE_VISIBILITY_UNTRIMMED_FRAG,
    operand_patch: &BASELINE_OPERAND_PATCH_UNTRIMMED_FRAG,
    gap_fill: &BASELINE_GAP_FILL_UNTRIMMED_COMP,
    within: None,
    borders: None,
    edge_line: None,
    edge_fold: None,
};

/// Bisection of monotone pieces.
#[cfg(feature = "baselines")]
pub static TRIM_BISECT: TrimTest = TrimTest {
    way: "bisect",
    visibility: &BASELINE_VISIBILITY_BISECT_FRAG,
    operand_patch: &BASELINE_OPERAND_PATCH_BISECT_FRAG,
    gap_fill: &BASELINE_GAP_FILL_BISECT_COMP,
    within: None,
    borders: None,
    edge_line: None,
    edge_fold: None,
};

/// Trim textures.
#[cfg(feature = "baselines")]
pub static TRIM_TEXTURE: TrimTest = TrimTest {
    way: "texture",
    visibility: &BASELINE_VISIBILITY_TEXTURE_FRAG,
    operand_patch: &BASELINE_OPERAND_PATCH_TEXTURE_FRAG,
    gap_fill: &BASELINE_GAP_FILL_TEXTURE_COMP,
    within: None,
    borders: None,
    edge_line: None,
    edge_fold: None,
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shader_begins_with_the_magic_number_and_is_whole() {
        assert_eq!(SCAN_ADD_COMP.words[0], 0x0723_0203);
        // instruction by instruction, by their lengths, the walk ends exactly at the last word
        let mut at = 5;
        while at < SCAN_ADD_COMP.words.len() {
            at += (SCAN_ADD_COMP.words[at] >> 16) as usize;
        }
        assert_eq!(at, SCAN_ADD_COMP.words.len());
    }

    /// The committed shaders, which embedders use, match the sources. After a change: `tools/shaders`.
    #[cfg(feature = "compile-shaders")]
    #[test]
    fn the_committed_shaders_are_those_of_the_sources() {
        use std::collections::BTreeMap;
        use std::path::Path;
        let read = |folder: &Path| -> BTreeMap<String, Vec<u8>> {
            let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
            files.map(|p| (p.file_name().unwrap().display().to_string(), std::fs::read(&p).unwrap())).collect()
        };
        let fresh = read(&Path::new(env!("OUT_DIR")).join("spirv"));
        let committed = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl/spirv"));
        let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&fresh), names(&committed), "run tools/shaders");
        let stale: Vec<_> = fresh.iter().filter(|(name, bytes)| committed[*name] != **bytes).map(|(n, _)| n).collect();
        assert!(stale.is_empty(), "run tools/shaders: {stale:?} differ from their sources");
    }
}
