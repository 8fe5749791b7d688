//! glTF 2.0, text with buffers beside it and the binary form.
//!
//! ```text
//!   scene ─▶ node (matrix) ─▶ node … ─▶ mesh ─▶ primitive: positions, indices ─accessor─▶ view ─▶ buffer
//!                                                material: base colour, linear
//! ```
//!
//! Metres become millimetres, and y, which points up, becomes z. Points and lines, textures, morph targets, animations
//! and skins are left out, with a warning, as are colours of vertices that differ; extensions are named. Every access
//! to a buffer is checked: a file may state any offset.
//!
//! Source: Khronos Group, *glTF 2.0 Specification*.

use super::{Found, MOST_PLACED, Piece, Placement, Wrong};
use crate::import::source::OtherFiles;
use crate::model::Colour;
use base64::Engine;
use glam::{DAffine3, DMat3, DMat4, DVec3};
use gltf::accessor::{Accessor, DataType, Dimensions};
use gltf::mesh::{Mode, Primitive};
use std::collections::HashSet;
use std::path::PathBuf;

/// Nodes within nodes.
const MOST_NESTED: usize = 256;

pub(super) fn read(bytes: &[u8], files: OtherFiles<'_>) -> Result<Found, Wrong> {
    let file = parsed(bytes)?;
    let mut found = Found { format: "glTF", unit: "metre".to_owned(), ..Found::default() };
    let buffers: Vec<Vec<u8>> =
        file.buffers().map(|b| buffer(&b, file.blob.as_deref(), files, &mut found.files)).collect::<Result<_, _>>()?;
    // pieces of a mesh, by its number
    let mut pieces = Vec::new();
    for mesh in file.meshes() {
        let first = found.pieces.len();
        for primitive in mesh.primitives() {
            let at =
                |what: String| Wrong::new(format!("mesh {}, primitive {}: {what}", mesh.index(), primitive.index()));
            if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
                found.notes.push(("lines left out", format!("mesh {}, primitive {}", mesh.index(), primitive.index())));
                continue;
            }
            let colours = primitive.get(&gltf::Semantic::Colors(0));
            if colours.is_some_and(|colours| single(&colours, &buffers).is_none()) {
                let what = format!("mesh {}, primitive {}: colours of vertices", mesh.index(), primitive.index());
                found.notes.push(("colours left out", what));
            }
            let name = mesh.name().unwrap_or_default().to_owned();
            found.pieces.push(Piece { name, ..self::piece(&primitive, &buffers).map_err(at)? });
        }
        pieces.push(first..found.pieces.len());
    }
    // metres to millimetres, y up to z up
    let up = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y) * DMat3::from_diagonal(DVec3::splat(1000.0));
    let up = DAffine3::from_mat3(up);
    let scene = file.default_scene().or_else(|| file.scenes().next());
    let mut waiting: Vec<_> = scene.iter().flat_map(|s| s.nodes()).map(|n| (n, up, 0)).collect();
    waiting.reverse();
    let mut shown = HashSet::new();
    while let Some((node, above, depth)) = waiting.pop() {
        if depth > MOST_NESTED {
            return Err(Wrong::new(format!("node {}: nodes nested more than {MOST_NESTED} deep", node.index())));
        }
        if found.placements.len() + waiting.len() > MOST_PLACED {
            return Err(Wrong::new(format!("more than {MOST_PLACED} placed meshes")));
        }
        let matrix = node.transform().matrix().map(|c| c.map(f64::from));
        let transform = above * DAffine3::from_mat4(DMat4::from_cols_array_2d(&matrix));
        if !transform.is_finite() {
            return Err(Wrong::new(format!("node {}: its matrix is not finite", node.index())));
        }
        shown.insert(node.index());
        if let Some(mesh) = node.mesh() {
            for piece in pieces[mesh.index()].clone() {
                let name = node.name().or(mesh.name()).unwrap_or_default().to_owned();
                found.placements.push(Placement { piece, transform, name });
            }
        }
        waiting.extend(node.children().map(|child| (child, transform, depth + 1)));
    }
    for (count, what) in
        [(file.textures().len(), "textures"), (file.animations().len(), "animations"), (file.skins().len(), "skins")]
    {
        if count > 0 {
            found.notes.push(("left out", format!("{count} {what}")));
        }
    }
    let bends = |weights: Option<&[f32]>| weights.is_some_and(|w| w.iter().any(|x| *x != 0.0));
    let bent =
        file.meshes().filter(|m| bends(m.weights())).count() + file.nodes().filter(|n| bends(n.weights())).count();
    if bent > 0 {
        found.notes.push(("morph targets left out", format!("{bent} meshes or nodes use them")));
    }
    for extension in file.extensions_used() {
        let copies = extension == "EXT_mesh_gpu_instancing";
        let kind = if copies { "copies left out" } else { "extension not used" };
        found.notes.push((kind, extension.to_owned()));
    }
    let hidden = file.nodes().filter(|n| n.mesh().is_some() && !shown.contains(&n.index())).count();
    if hidden > 0 && !found.placements.is_empty() {
        found
            .notes
            .push(("object not placed", format!("{hidden} nodes with a mesh are not in the scene that is drawn")));
    }
    if found.placements.is_empty() && !found.pieces.is_empty() {
        let all = (0..found.pieces.len()).map(|piece| Placement { piece, transform: up, name: String::new() });
        found.placements = all.collect();
    }
    Ok(found)
}

/// The document. Boxes of positions, which many writers leave out, may be missing: none is used.
fn parsed(bytes: &[u8]) -> Result<::gltf::Gltf, Wrong> {
    let wrong = |e: ::gltf::Error| {
        let old = matches!(e, ::gltf::Error::Deserialize(_) | ::gltf::Error::Binary(_)) && is_first_version(bytes);
        Wrong::new(if old { format!("glTF 1.0, and 2.0 is read: {e}") } else { e.to_string() })
    };
    match ::gltf::Gltf::from_slice(bytes) {
        Err(::gltf::Error::Validation(all))
            if all.iter().all(|(path, _)| path.0.ends_with(".min") || path.0.ends_with(".max")) =>
        {
            ::gltf::Gltf::from_slice_without_validation(bytes).map_err(wrong)
        }
        other => other.map_err(wrong),
    }
}

/// Whether a file says that it is of the first version.
fn is_first_version(bytes: &[u8]) -> bool {
    if bytes.starts_with(b"glTF") {
        return bytes.get(4..8) == Some(&1_u32.to_le_bytes()[..]);
    }
    let text = String::from_utf8_lossy(bytes);
    let asset = text.split("\"asset\"").nth(1).unwrap_or_default();
    let version = asset.split("\"version\"").nth(1).unwrap_or_default();
    version.trim_start_matches(|c: char| c.is_whitespace() || c == ':' || c == '"').starts_with('1')
}

/// The bytes of a buffer: within the file, as text in it, or in a file beside it, which `opened` then has.
fn buffer(
    buffer: &gltf::Buffer<'_>,
    blob: Option<&[u8]>,
    files: OtherFiles<'_>,
    opened: &mut Vec<PathBuf>,
) -> Result<Vec<u8>, Wrong> {
    let wrong = |what: String| Wrong::new(format!("buffer {}: {what}", buffer.index()));
    let bytes = match buffer.source() {
        gltf::buffer::Source::Bin => blob.ok_or_else(|| wrong("is not in the file".to_owned()))?.to_vec(),
        gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
            Some(data) => {
                let (_, text) =
                    data.split_once(";base64,").ok_or_else(|| wrong("text that is not base64".to_owned()))?;
                base64::engine::general_purpose::STANDARD.decode(text).map_err(|e| wrong(e.to_string()))?
            }
            None => {
                let name = unescaped(uri);
                let (path, bytes) = files.open(&name, u64::MAX).map_err(|why| wrong(format!("{name}: {why}")))?;
                opened.push(path);
                bytes
            }
        },
    };
    if bytes.len() < buffer.length() {
        return Err(wrong(format!("cut off: {} of {} bytes", bytes.len(), buffer.length())));
    }
    Ok(bytes)
}

/// A name without the escapes of a URI, `%20` and the like.
fn unescaped(uri: &str) -> String {
    let (mut bytes, mut rest) = (Vec::new(), uri.as_bytes());
    while let Some((&first, behind)) = rest.split_first() {
        let digits = behind.get(..2).filter(|d| first == b'%' && d.iter().all(u8::is_ascii_hexdigit));
        let code = digits.and_then(|d| u8::from_str_radix(std::str::from_utf8(d).ok()?, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = if code.is_some() { &behind[2..] } else { behind };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn piece(primitive: &Primitive<'_>, buffers: &[Vec<u8>]) -> Result<Piece, String> {
    let positions = primitive.get(&gltf::Semantic::Positions).ok_or("no positions")?;
    let points = vectors(&positions, buffers)?;
    if let Some(k) = points.iter().position(|p| !p.is_finite()) {
        return Err(format!("vertex {k} is not finite"));
    }
    let corners: Vec<u32> = match primitive.indices() {
        Some(indices) => numbers(&indices, buffers)?,
        None => (0..points.len() as u32).collect(),
    };
    if let Some(far) = corners.iter().find(|i| **i as usize >= points.len()) {
        return Err(format!("vertex {far} of {}", points.len()));
    }
    let few = usize::from(primitive.mode() == Mode::Triangles && !corners.len().is_multiple_of(3));
    let triangles: Vec<[u32; 3]> = match primitive.mode() {
        Mode::TriangleStrip => {
            let turned = |(k, w): (usize, &[u32])| if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            corners.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]]).collect(),
        _ => corners.chunks_exact(3).map(|w| [w[0], w[1], w[2]]).collect(),
    };
    let normals = match primitive.get(&gltf::Semantic::Normals) {
        Some(accessor) => vectors(&accessor, buffers)?,
        None => Vec::new(),
    };
    let smooth = normals.len() == points.len() && normals.iter().all(|n| n.is_finite());
    let normals = if smooth { triangles.iter().map(|t| t.map(|i| normals[i as usize])).collect() } else { Vec::new() };
    let material = primitive.material();
    let own = primitive.get(&gltf::Semantic::Colors(0)).and_then(|colours| single(&colours, buffers));
    let colour: Option<Colour> = (material.index().is_some() || own.is_some()).then(|| {
        let (base, own) = (material.pbr_metallic_roughness().base_color_factor(), own.unwrap_or([1.0; 4]));
        let [r, g, b, a] = std::array::from_fn(|k| base[k] * own[k]);
        let opaque = material.alpha_mode() == gltf::material::AlphaMode::Opaque;
        [r, g, b, if opaque { 1.0 } else { a }].map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 })
    });
    let colours = vec![colour; triangles.len()];
    Ok(Piece { points, triangles, normals, colours, few, ..Piece::default() })
}

/// The bytes of each entry of an accessor.
fn entries<'b>(accessor: &Accessor<'_>, buffers: &'b [Vec<u8>]) -> Result<Vec<&'b [u8]>, String> {
    if accessor.sparse().is_some() {
        return Err("a sparse accessor is not read".to_owned());
    }
    let view = accessor.view().ok_or("an accessor without a view")?;
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size).max(1);
    let part = buffers.get(view.buffer().index()).and_then(|b| {
        let end = view.offset().checked_add(view.length())?;
        b.get(view.offset()..end)?.get(accessor.offset()..)
    });
    let part = part.ok_or("a view beyond its buffer")?;
    let last = (accessor.count().max(1) - 1).checked_mul(stride).and_then(|at| at.checked_add(size));
    if accessor.count() > 0 && last.is_none_or(|end| end > part.len()) {
        return Err(format!("{} entries in {} bytes", accessor.count(), part.len()));
    }
    Ok((0..accessor.count()).map(|k| &part[k * stride..k * stride + size]).collect())
}

fn vectors(accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<Vec<DVec3>, String> {
    if accessor.data_type() != DataType::F32 || accessor.dimensions() != Dimensions::Vec3 {
        return Err("positions or normals that are not three floats".to_owned());
    }
    let number =
        |e: &[u8], k: usize| f64::from(f32::from_le_bytes([e[4 * k], e[4 * k + 1], e[4 * k + 2], e[4 * k + 3]]));
    let all = entries(accessor, buffers)?;
    Ok(all.into_iter().map(|e| DVec3::new(number(e, 0), number(e, 1), number(e, 2))).collect())
}

/// The colour that all vertices have; `None` where they differ.
fn single(colours: &Accessor<'_>, buffers: &[Vec<u8>]) -> Option<Colour> {
    let (size, part): (usize, fn(&[u8]) -> f32) = match colours.data_type() {
        DataType::U8 => (1, |e| f32::from(e[0]) / 255.0),
        DataType::U16 => (2, |e| f32::from(u16::from_le_bytes([e[0], e[1]])) / 65535.0),
        DataType::F32 => (4, |e| f32::from_le_bytes([e[0], e[1], e[2], e[3]])),
        _ => return None,
    };
    if !matches!(colours.dimensions(), Dimensions::Vec3 | Dimensions::Vec4) {
        return None;
    }
    let all = entries(colours, buffers).ok()?;
    let (first, others) = all.split_first()?;
    let parts: Vec<f32> = first.chunks_exact(size).map(part).collect();
    others.iter().all(|e| e == first).then(|| [parts[0], parts[1], parts[2], parts.get(3).copied().unwrap_or(1.0)])
}

fn numbers(accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<Vec<u32>, String> {
    let read: fn(&[u8]) -> u32 = match (accessor.data_type(), accessor.dimensions()) {
        (DataType::U8, Dimensions::Scalar) => |e| u32::from(e[0]),
        (DataType::U16, Dimensions::Scalar) => |e| u32::from(u16::from_le_bytes([e[0], e[1]])),
        (DataType::U32, Dimensions::Scalar) => |e| u32::from_le_bytes([e[0], e[1], e[2], e[3]]),
        _ => return Err("indices that are no whole numbers".to_owned()),
    };
    Ok(entries(accessor, buffers)?.into_iter().map(read).collect())
}
