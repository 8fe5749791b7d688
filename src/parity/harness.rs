//! A watched device, transfers to and from it, and comparisons that name the place of a difference.

use super::Case;
use super::arithmetic::Imitation;
use crate::bindings::Bounded;
use crate::frame::tessellation::split;
use crate::gpu::{
    Access, Binding, Buffer, Commands, ComputeInfo, Device, Pipeline, Pool, ReadBack, Resource, Texel, TexelBuffer,
    Uploads, barrier,
};
use crate::headless::{HeadlessDevice, HeadlessOptions};
use crate::scene::ExactData;
use ash::vk;
use bytemuck::Pod;
use std::fmt::Debug;

/// A device under validation and synchronisation validation.
pub(super) struct Gpu {
    watched: HeadlessDevice,
    /// Quotients and roots are rounded correctly.
    is_exact: bool,
}

/// Allowed difference from the twin's result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slack {
    /// Of a whole number from a `ceil`.
    pub count: u32,
    /// Of a float, relative.
    pub relative: f32,
}

/// The first difference.
#[derive(Debug, PartialEq)]
pub(super) struct Mismatch {
    pub buffer: &'static str,
    pub index: usize,
    pub values: String,
}

impl Gpu {
    pub(super) fn new() -> Self {
        let options = HeadlessOptions { validation: true, ..Default::default() };
        let watched = HeadlessDevice::new(&options).unwrap_or_else(|error| panic!("these tests need Vulkan: {error}"));
        let is_exact = watched.device().driver().contains("llvmpipe");
        Self { watched, is_exact }
    }

    /// The device; if its arithmetic is exact, also imitations of other GPUs on it.
    pub(super) fn all() -> Vec<Self> {
        let mut all = vec![Self::new()];
        if all[0].is_exact {
            all.extend(Imitation::ALL.map(Self::imitating));
        }
        all
    }

    /// A device whose shaders have the quotients and roots of another GPU.
    pub(super) fn imitating(imitation: Imitation) -> Self {
        let gpu = Self { is_exact: false, ..Self::new() };
        gpu.device().rewrite(imitation.rewriting());
        gpu
    }

    pub(super) fn device(&self) -> &Device {
        self.watched.device()
    }

    /// Quotients and roots are rounded correctly.
    pub(super) fn is_exact(&self) -> bool {
        self.is_exact
    }

    /// 0 if quotients and roots are rounded correctly. Otherwise Vulkan allows 2.5 and 3 units in the last place for an
    /// operation; no pass chains more than eight of them.
    pub(super) fn slack(&self) -> Slack {
        if self.is_exact {
            Slack { count: 0, relative: 0.0 }
        } else {
            Slack { count: 1, relative: 24.0 * f32::EPSILON }
        }
    }

    /// A buffer of `data` for storage, constants and indirect commands.
    pub(super) fn upload<T: Pod>(&self, name: &str, data: &[T]) -> Buffer {
        let record = |cmd: &Commands<'_>| {
            let mut uploads = Uploads::new();
            let usage = Buffer::INDIRECT | vk::BufferUsageFlags::UNIFORM_BUFFER;
            let buffer = uploads.buffer(cmd.device(), Pool::Transient, name, usage, data).unwrap();
            let staging = uploads.record(cmd, name, u64::MAX).unwrap();
            staging.finish(cmd, Access::COMPUTE_WRITE | Access::INDIRECT_READ | Access::UNIFORM_READ);
            (buffer, staging)
        };
        self.watched.submit(record).unwrap().0
    }

    /// The same, also for texel fetches.
    pub(super) fn upload_texels<T: Pod>(&self, name: &str, data: &[T], texel: Texel) -> TexelBuffer {
        let record = |cmd: &Commands<'_>| {
            let mut uploads = Uploads::new();
            let usage = Buffer::STORAGE | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
            let buffer = uploads.buffer(cmd.device(), Pool::Transient, name, usage, data).unwrap();
            let staging = uploads.record(cmd, name, u64::MAX).unwrap();
            staging.finish(cmd, Access::COMPUTE_READ);
            (TexelBuffer::new(cmd.device(), buffer, texel).unwrap(), staging)
        };
        self.watched.submit(record).unwrap().0
    }

    /// The buffers of the exact trim test, in its order.
    pub(super) fn upload_exact(&self, data: &ExactData) -> [TexelBuffer; 3] {
        [
            self.upload_texels("faces", &data.faces, Texel::U32x4),
            self.upload_texels("cells", &data.cells, Texel::Words),
            self.upload_texels("arcs", &data.arcs, Texel::U32x4),
        ]
    }

    /// The results of a wrapper in `tests/gpu/glsl` for points of each face that is trimmed exactly. Its bindings are
    /// those of [`upload_exact`](Self::upload_exact), the points and the results, which are `blank` before; its push
    /// constants are the face and the number of points.
    pub(super) fn answers<Q: Pod, A: Pod>(
        &self,
        name: &str,
        spirv: &[u8],
        data: &ExactData,
        (questions, blank): (&[Vec<Q>], A),
    ) -> Vec<Vec<A>> {
        let texels = self.upload_exact(data);
        let bindings = [vec![Binding::TexelBuffer; texels.len()], vec![Binding::Storage; 2]].concat();
        let spirv = words(spirv);
        let info = ComputeInfo { name, spirv: &spirv, bindings: &bindings, push_bytes: 8, constants: &[] };
        let pipeline = Pipeline::compute(self.device(), &info).unwrap();
        let of_face = |(face, questions): (usize, &Vec<Q>)| {
            let asked = self.upload("questions", questions);
            let answers = self.upload("answers", &vec![blank; questions.len()]);
            self.run(|cmd| {
                let of_wrapper = [&asked, &answers].map(Resource::from);
                let resources: Vec<_> = texels.iter().map(Resource::from).chain(of_wrapper).collect();
                cmd.bind(&pipeline, &resources, bytemuck::bytes_of(&[face as u32, questions.len() as u32]));
                cmd.dispatch(questions.len().div_ceil(64) as u32);
            });
            self.read(&answers, questions.len())
        };
        questions.iter().enumerate().map(of_face).collect()
    }

    /// Records, submits, waits.
    pub(super) fn run(&self, record: impl FnOnce(&Commands<'_>)) {
        self.watched.submit(record).unwrap();
        // a pass is made anew for each case, and under validation a pipeline takes longer than a case
        self.watched.keep_pipelines();
    }

    /// The first `count` values of a buffer written by a pass.
    pub(super) fn read<T: Pod>(&self, buffer: &Buffer, count: usize) -> Vec<T> {
        let bytes = (count * size_of::<T>()) as u64;
        let back = ReadBack::new(self.device(), "read back", bytes).unwrap();
        self.run(|cmd| {
            barrier::buffers(cmd, &[(buffer, Access::COMPUTE_WRITE, Access::TRANSFER_READ)]);
            back.record(cmd, buffer, bytes);
        });
        back.values(count)
    }

    /// Fails the test if the validation layers reported anything.
    pub(super) fn finish(self) {
        let messages: Vec<_> = self.watched.shutdown().iter().map(ToString::to_string).collect();
        assert!(messages.is_empty(), "validation messages:\n{}", messages.join("\n"));
    }
}

/// The words of a SPIR-V file.
pub(super) fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

/// The arrays of a case in GPU memory.
pub(super) struct SceneBuffers {
    pub frame: Buffer,
    pub views: Buffer,
    pub instances: Buffer,
    pub face_instances: TexelBuffer,
    pub faces: TexelBuffer,
    pub patches: TexelBuffer,
    pub points: TexelBuffer,
    pub patch_instances: Buffer,
    pub cells: Buffer,
    pub cell_instances: Buffer,
    pub curves: TexelBuffer,
    pub curve_points: TexelBuffer,
    pub curve_instances: TexelBuffer,
    pub runs: Buffer,
}

impl SceneBuffers {
    pub(super) fn new(gpu: &Gpu, case: &Case) -> Self {
        let d = &case.data;
        Self {
            frame: gpu.upload("frame", &[case.frame]),
            views: gpu.upload("views", &case.views),
            instances: gpu.upload("instances", &d.instances),
            face_instances: gpu.upload_texels("face instances", &d.face_instances, Texel::U32x4),
            faces: gpu.upload_texels("faces", &d.faces, Texel::U32x4),
            patches: gpu.upload_texels("patches", &d.patches, Texel::U32x4),
            points: gpu.upload_texels("points", &d.points, Texel::F32x4),
            patch_instances: gpu.upload("patch instances", &d.patch_instances),
            cells: gpu.upload("cells", &d.cells),
            cell_instances: gpu.upload("cell instances", &d.cell_instances),
            curves: gpu.upload_texels("curves", &d.curves, Texel::U32x4),
            curve_points: gpu.upload_texels("curve points", &d.curve_points, Texel::Numbers),
            curve_instances: gpu.upload_texels("curve instances", &d.curve_instances, Texel::Words),
            runs: gpu.upload("runs of patch instances", &case.runs),
        }
    }

    /// The bindings of passes that bound the segments of patches.
    pub(super) fn bounded<'a>(
        &'a self,
        taus: &'a Buffer,
        counters: &'a Buffer,
        cones: Option<&'a Buffer>,
    ) -> Bounded<'a> {
        Bounded {
            frame: &self.frame,
            views: &self.views,
            instances: &self.instances,
            face_instances: &self.face_instances,
            faces: &self.faces,
            patches: &self.patches,
            patch_instances: &self.patch_instances,
            taus,
            counters,
            cones,
            points: &self.points,
            runs: &self.runs,
        }
    }

    /// The bindings of pass `split`. `counts`: of sub-patches, and of vertices.
    pub(super) fn split<'a>(
        &'a self,
        taus: &'a Buffer,
        factors: &'a Buffer,
        counts: [&'a Buffer; 2],
        links: Option<&'a Buffer>,
    ) -> split::Bindings<'a> {
        split::Bindings {
            frame: &self.frame,
            face_instances: &self.face_instances,
            faces: &self.faces,
            patches: &self.patches,
            patch_instances: &self.patch_instances,
            taus,
            factors,
            sub_patch_counts: counts[0],
            vertex_counts: counts[1],
            runs: &self.runs,
            links,
        }
    }
}

/// Compares by `near`; returns the first place where it does not hold.
fn all_near<T: Debug>(
    buffer: &'static str,
    gpu: &[T],
    twin: &[T],
    near: impl Fn(&T, &T) -> bool,
) -> Result<(), Mismatch> {
    assert_eq!(gpu.len(), twin.len(), "lengths of `{buffer}`");
    match gpu.iter().zip(twin).position(|(g, t)| !near(g, t)) {
        None => Ok(()),
        Some(index) => {
            let values = format!("GPU {:?}, twin {:?}", gpu[index], twin[index]);
            Err(Mismatch { buffer, index, values })
        }
    }
}

/// Exactly equal.
pub(super) fn same<T: Debug + PartialEq>(buffer: &'static str, gpu: &[T], twin: &[T]) -> Result<(), Mismatch> {
    all_near(buffer, gpu, twin, |g, t| g == t)
}

/// Whole numbers within the slack.
pub(super) fn counts(buffer: &'static str, gpu: &[u32], twin: &[u32], slack: Slack) -> Result<(), Mismatch> {
    all_near(buffer, gpu, twin, |&g, &t| g.abs_diff(t) <= slack.count)
}

/// Two whole numbers in a word, each within the slack; a word is 0 only if the twin's is.
pub(super) fn halves(buffer: &'static str, gpu: &[u32], twin: &[u32], slack: Slack) -> Result<(), Mismatch> {
    let half = |g: u32, t: u32| g.abs_diff(t) <= slack.count;
    all_near(buffer, gpu, twin, |&g, &t| (g == 0) == (t == 0) && half(g & 0xffff, t & 0xffff) && half(g >> 16, t >> 16))
}

/// Floats within the slack; with none, bit for bit.
pub(super) fn floats(buffer: &'static str, gpu: &[f32], twin: &[f32], slack: Slack) -> Result<(), Mismatch> {
    all_near(buffer, gpu, twin, |g, t| g.to_bits() == t.to_bits() || (g - t).abs() < slack.relative * t.abs())
}

#[test]
fn comparisons_see_one_bit() {
    let none = Slack { count: 0, relative: 0.0 };
    let mismatch = |result: Result<(), Mismatch>| result.unwrap_err().index;
    assert_eq!(same("a", &[1, 2, 3], &[1, 2, 3]), Ok(()));
    assert_eq!(mismatch(same("a", &[1, 2, 3], &[1, 2, 4])), 2);
    assert_eq!(mismatch(counts("a", &[7, 8], &[7, 9], none)), 1);
    assert_eq!(mismatch(counts("a", &[7, 8], &[7, 10], Slack { count: 1, ..none })), 1);
    assert_eq!(mismatch(halves("a", &[5 | 7 << 16], &[5 | 8 << 16], none)), 0);
    assert_eq!(mismatch(halves("a", &[0], &[1], Slack { count: 1, ..none })), 0);
    assert_eq!(mismatch(floats("a", &[1.0], &[1.0f32.next_up()], none)), 0);
    assert_eq!(mismatch(floats("a", &[0.0], &[-0.0], none)), 0);
    assert_eq!(floats("a", &[1.0], &[1.0f32.next_up()], Slack { relative: 1e-6, ..none }), Ok(()));
}
