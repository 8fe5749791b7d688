//! Parity of the pass `seen_squares`: exact. Pass `mesh` draws the input, which is read back for the twin.

use super::harness::{Gpu, Mismatch, same};
use super::shapes::cases;
use super::{Case, Random};
use crate::abi::constants::visible::{GAP_CANDIDATE, SEEN_MESH, SEEN_OPERAND, SEEN_SOLID};
use crate::abi::{MeshInstance, TILE};
use crate::frame::shading::seen_squares::{Bindings, SeenSquares};
use crate::frame::visibility::mesh::{self, Mesh};
use crate::frame::visibility::patches::{DEPTH_FORMAT, VISIBILITY_FORMAT};
use crate::gpu::{Access, Attachment, Image, ImageInfo, Load, Pool, ReadBack, barrier};
use crate::twin::squares::seen_squares;
use ash::vk;

fn image(gpu: &Gpu, name: &str, format: vk::Format, usage: vk::ImageUsageFlags, size: (u32, u32)) -> Image {
    let usage = usage | vk::ImageUsageFlags::TRANSFER_SRC;
    Image::new(gpu.device(), &ImageInfo { name, size, format, usage, pool: Pool::Transient }).unwrap()
}

fn visibility(gpu: &Gpu, name: &str, size: (u32, u32)) -> Image {
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::STORAGE;
    image(gpu, name, VISIBILITY_FORMAT, usage, size)
}

/// An image with the same word everywhere.
fn filled(gpu: &Gpu, word: u32, size: (u32, u32)) -> Image {
    let image = visibility(gpu, "filled", size);
    gpu.run(|cmd| {
        barrier::images(cmd, &[(&image, Access::COLOUR_WRITE.discarded(), Access::COLOUR_WRITE)]);
        cmd.rendering(size, &[Attachment { image: &image, load: Load::ColourU32([word, 0, 0, 0]) }], None, || ());
        barrier::images(cmd, &[(&image, Access::COLOUR_WRITE, Access::COMPUTE_READ)]);
    });
    image
}

/// The visibility image of triangles, its first words, and reversed depths.
pub(super) struct Drawn {
    pub seen: Image,
    pub words: Vec<u32>,
    pub depth: Image,
    pub depths: Vec<f32>,
}

/// `count` triangles of each placed face, of a hundredth to the whole of a patch.
pub(super) fn drawn(gpu: &Gpu, case: &Case, random: &mut Random, count: u32, size: (u32, u32)) -> Drawn {
    let d = &case.data;
    let (mut positions, mut draws, mut mesh_instances) = (Vec::new(), Vec::new(), Vec::new());
    for (k, placed) in (0..).zip(&d.face_instances) {
        let boxes: Vec<_> =
            d.patches.iter().filter(|p| p.face == placed.face).map(|p| (p.box_min, p.box_max)).collect();
        let first = positions.len() as u32;
        for _ in 0..count {
            let (lo, hi) = random.pick(&boxes);
            let size: [f64; 3] = std::array::from_fn(|k| f64::from(hi[k]) - f64::from(lo[k]));
            let reach = 10f64.powf(random.range(-2.0, 0.0)) * size.into_iter().fold(0.0, f64::max);
            let from: [f64; 3] = std::array::from_fn(|k| f64::from(lo[k]) + size[k] * random.range(0.0, 1.0));
            for _ in 0..3 {
                positions.push(from.map(|x| (x + reach * random.range(-0.5, 0.5)) as f32));
            }
        }
        mesh_instances.push(MeshInstance { mesh: 0, instance: placed.instance });
        draws.push((first..positions.len() as u32, k..k + 1));
    }
    let triangles: Vec<u32> = (0..positions.len() as u32).collect();
    let seen = visibility(gpu, "drawn", size);
    let tested = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
    let depth = image(gpu, "depth", DEPTH_FORMAT, tested, size);
    let kinds = mesh::Kinds { both: true, outward: false, volume: None };
    let pass = Mesh::new(gpu.device(), (VISIBILITY_FORMAT, DEPTH_FORMAT), kinds).unwrap();
    let bindings = mesh::Bindings {
        frame: &gpu.upload("frame", &[case.frame]),
        views: &gpu.upload("views", &case.views),
        mesh_instances: &gpu.upload("mesh instances", &mesh_instances),
        triangles: &gpu.upload("triangles", &triangles),
        positions: &gpu.upload("positions", &positions),
        volume: None,
    };
    let pixels = (size.0 * size.1) as usize;
    let back = ReadBack::new(gpu.device(), "seen", 8 * pixels as u64).unwrap();
    let depths = ReadBack::new(gpu.device(), "depths", 4 * pixels as u64).unwrap();
    gpu.run(|cmd| {
        barrier::images(
            cmd,
            &[
                (&seen, Access::COLOUR_WRITE.discarded(), Access::COLOUR_WRITE),
                (&depth, Access::DEPTH_WRITE.discarded(), Access::DEPTH_WRITE),
            ],
        );
        pass.record(cmd, &bindings, (&seen, &depth), &draws, draws.len());
        barrier::images(
            cmd,
            &[
                (&seen, Access::COLOUR_WRITE, Access::TRANSFER_READ),
                (&depth, Access::DEPTH_WRITE, Access::TRANSFER_READ),
            ],
        );
        back.record_image(cmd, &seen, vk::ImageAspectFlags::COLOR);
        depths.record_image(cmd, &depth, vk::ImageAspectFlags::DEPTH);
        let read = Access::COMPUTE_READ;
        barrier::images(cmd, &[(&seen, Access::TRANSFER_READ, read), (&depth, Access::TRANSFER_READ, read)]);
    });
    let words = back.values::<[u32; 2]>(pixels).into_iter().map(|[word, _]| word).collect();
    Drawn { seen, words, depth, depths: depths.values(pixels) }
}

/// The pass over two images, against the twin of the expected input.
fn compare(
    gpu: &Gpu,
    case: &Case,
    (visibility, meshes_and_solids): (&Image, &Image),
    sees: impl Fn(usize) -> bool,
) -> Result<Vec<u32>, Mismatch> {
    let (width, height) = visibility.size();
    let tiles = (width.div_ceil(TILE) * height.div_ceil(TILE)) as usize;
    let squares = gpu.upload("seen squares", &vec![99u32; tiles]);
    let pass = SeenSquares::new(gpu.device()).unwrap();
    let frame = &gpu.upload("frame", &[case.frame]);
    gpu.run(|cmd| pass.record(cmd, &Bindings { frame, visibility, meshes_and_solids, squares: &squares }));
    let found = gpu.read(&squares, tiles);
    same("seen squares", &found, &seen_squares([width, height], |[x, y]| sees((y * width + x) as usize)))?;
    Ok(found)
}

#[test]
fn parity_is_exact_and_sees_a_difference() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let size = (case.frame.size[0] as u32, case.frame.size[1] as u32);
    assert!(
        !(size.0.is_multiple_of(TILE) && size.1.is_multiple_of(TILE)),
        "some tiles are cut off by the picture's end: {size:?}"
    );
    let mut random = Random::new(5);
    let few = drawn(&gpu, case, &mut random, 2, size);
    let many = drawn(&gpu, case, &mut random, 40, size);
    let squares = compare(&gpu, case, (&few.seen, &few.seen), |n| few.words[n] != 0).unwrap();
    let sides = |side: u32| squares.iter().filter(|s| **s == side).count();
    assert!(sides(0) > 0 && sides(1) > 0, "{} and {}", sides(0), sides(1));
    let squares = compare(&gpu, case, (&few.seen, &many.seen), |n| few.words[n] != 0 || many.words[n] != 0).unwrap();
    assert!(squares.iter().any(|side| *side > 1), "nothing but single tiles");
    compare(&gpu, case, (&few.seen, &many.seen), |n| few.words[n] != 0).unwrap_err();
    // patches and meshes count, solids and operands do not; an empty word, candidate or not, leaves it to the other
    // image
    for (word, is_seen) in [(7, true), (SEEN_MESH | 7, true), (GAP_CANDIDATE | 7, true)] {
        compare(&gpu, case, (&filled(&gpu, word, size), &few.seen), |_| is_seen).unwrap();
    }
    for word in [SEEN_SOLID | 7, SEEN_OPERAND | 7] {
        compare(&gpu, case, (&filled(&gpu, word, size), &few.seen), |_| false).unwrap();
    }
    for word in [0, GAP_CANDIDATE] {
        compare(&gpu, case, (&filled(&gpu, word, size), &few.seen), |n| few.words[n] != 0).unwrap();
    }
    drop((few, many));
    gpu.finish();
}
