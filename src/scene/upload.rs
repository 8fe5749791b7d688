//! The scene's persistent buffers. Each exists only if the model needs it.

#[cfg(feature = "baselines")]
use super::Division;
use super::solids::Surface;
use super::{Blister, EdgeData, SceneData, SolidData};
#[cfg(feature = "baselines")]
use crate::baselines::TrimMethod;
use crate::bindings::{Placed, Primitives};
use crate::gpu::{Buffer, Device, GpuError, Pool, Texel, TexelBuffer, Uploads};
use crate::picture::TakenWay;
use ash::vk;
use bytemuck::Pod;
use std::ops::Range;

/// A scene in GPU memory.
pub(crate) struct Scene {
    pub patches: TexelBuffer,
    /// The cells of each patch that no part of the face covers; `None` without occlusion culling.
    pub(super) outside: Option<Buffer>,
    /// The cone of each patch's normals; `None` if no part is closed and without trims.
    pub cones: Option<Buffer>,
    /// Homogeneous control points, and fine nets.
    pub points: TexelBuffer,
    /// Sides that faces share; `None` if there are none.
    pub links: Option<Buffer>,
    pub faces: TexelBuffer,
    pub face_instances: TexelBuffer,
    pub instances: TexelBuffer,
    pub patch_instances: TexelBuffer,
    /// Slefes and their table; `None` if bounds divide the patches.
    #[cfg(feature = "baselines")]
    slefes: Option<Buffer>,
    /// Buffers of the trim test; `None` if no patch is trimmed.
    pub trims: Option<Trims>,
    /// Boolean solids; `None` when there are none.
    pub solids: Option<Solids>,
    /// Buffers of meshes; `None` if there are none.
    pub meshes: Option<MeshBuffers>,
    /// The volume that trims faces and meshes; `None` without one.
    pub volume: Option<Volume>,
    /// The model's part and instance of each instance; `None` if no output needs them.
    pub sources: Option<TexelBuffer>,
    /// Buffers of lines along edges; `None` without lines.
    pub edges: Option<EdgeBuffers>,
    /// The sun's picture; `None` without a sun, or if nothing casts shadows.
    pub sun: Option<SunTiles>,
}

/// Pieces of the parts' edges, and their placed copies.
pub(crate) struct EdgeBuffers {
    pub pieces: Buffer,
    pub points: TexelBuffer,
    pub lines: Buffer,
    pub own_faces: Buffer,
    pub piece_instances: Buffer,
    pub face_keys: TexelBuffer,
}

/// The sun's picture.
pub(crate) struct SunTiles {
    pub tiles: Buffer,
    pub leaves: Buffer,
    /// Triangles of operands and of placed parts, and each tile's lists; `None` if there are none.
    pub triangles: Option<TexelBuffer>,
    pub facets: Option<TexelBuffer>,
    pub lists: Option<TexelBuffer>,
}

/// A volume's switches and surfaces.
pub(crate) struct Volume {
    pub leaves: Buffer,
    pub leaf_surfaces: TexelBuffer,
    pub surfaces: TexelBuffer,
}

/// The Blist's switches and surfaces.
pub(crate) struct Solids {
    pub leaves: Buffer,
    pub leaf_surfaces: TexelBuffer,
    pub surfaces: TexelBuffer,
    /// The leaves in the order of drawing, and their number; only if each is drawn by itself.
    pub order: Option<(Buffer, u32)>,
    /// For way `blister`: the walk, and the order of its leaves.
    pub blister: Option<(Blister, Buffer)>,
    /// `None` if every operand has equations.
    pub boundary_operands: Option<BoundaryOperands>,
}

/// Operands without equations: a leaf of each, and their meshes.
pub(crate) struct BoundaryOperands {
    pub leaves: Buffer,
    pub meshes: Buffer,
    pub triangles: Buffer,
    pub positions: Buffer,
    /// Surfaces of the triangles, by number.
    pub planes: Buffer,
    /// Corners of each mesh's triangles.
    pub draws: Vec<Range<u32>>,
}

/// Triangles, their instances, and the draws over both.
pub(crate) struct MeshBuffers {
    pub meshes: Buffer,
    pub instances: Buffer,
    pub positions: Buffer,
    pub triangles: Buffer,
    /// Of the triangles; `None` where no borders are smooth.
    pub neighbours: Option<Buffer>,
    pub normals: Buffer,
    /// Corners of triangles, and mesh instances, of each draw.
    pub draws: Vec<(Range<u32>, Range<u32>)>,
    /// From this draw on, only outer faces are drawn.
    pub outward: usize,
}

/// Buffers of the scene's way to trim.
pub(crate) enum Trims {
    Table(Box<TableScene>),
    Exact(Box<ExactScene>),
    #[cfg(feature = "baselines")]
    Baseline(Box<BaselineScene>),
}

/// Buffers of a baseline's way to trim.
#[cfg(feature = "baselines")]
pub(crate) enum BaselineScene {
    Untrimmed,
    /// Faces, bands, cells, lists, pieces, points.
    Bisect([TexelBuffer; 6]),
    /// Curves and cells; the texels of each pixel and the number of placed faces.
    Texture(TableScene, Buffer),
}

/// Cells and their arcs; see `glsl/include/exact.glsl`.
pub(crate) struct ExactScene {
    pub faces: TexelBuffer,
    pub cells: TexelBuffer,
    pub arcs: TexelBuffer,
}

impl ExactScene {
    /// The buffers in the order of the trim test.
    pub(crate) fn all(&self) -> [&TexelBuffer; 3] {
        [&self.faces, &self.cells, &self.arcs]
    }
}

/// Trim curves, and the cells from which their scan lines' density is computed.
pub(crate) struct TableScene {
    pub cells: Buffer,
    pub cell_instances: Buffer,
    pub curves: TexelBuffer,
    pub curve_points: TexelBuffer,
    pub curve_instances: TexelBuffer,
    /// Bin instances of strips with several bins; `None` without any.
    pub wide_strips: Option<Buffer>,
}

impl Solids {
    /// The switches, with the places of surfaces for one frame's eye.
    pub(crate) fn primitives<'a>(&'a self, surface_places: &'a TexelBuffer) -> Primitives<'a> {
        let Self { leaves, leaf_surfaces, surfaces, .. } = self;
        Primitives { leaves, leaf_surfaces, surfaces, surface_places }
    }
}

impl Volume {
    /// The switches, with the places of surfaces for one frame's eye.
    pub(crate) fn primitives<'a>(&'a self, surface_places: &'a TexelBuffer) -> Primitives<'a> {
        let Self { leaves, leaf_surfaces, surfaces } = self;
        Primitives { leaves, leaf_surfaces, surfaces, surface_places }
    }
}

impl Scene {
    /// The cells of each patch that no part of the face covers.
    ///
    /// # Panics
    /// In a scene without occlusion culling.
    pub(crate) fn outside(&self) -> &Buffer {
        self.outside.as_ref().expect("scenes with occlusion culling have it")
    }

    /// Slefes and their table.
    ///
    /// # Panics
    /// In a scene whose patches are divided by bounds.
    #[cfg(feature = "baselines")]
    pub(crate) fn slefes(&self) -> &Buffer {
        self.slefes.as_ref().expect("scenes that slefes divide have them")
    }

    /// The trim table's input, in scenes that it trims.
    pub(crate) fn table(&self) -> Option<&TableScene> {
        if let Some(Trims::Table(trims)) = &self.trims { Some(trims) } else { None }
    }

    /// The exact trim test's buffers, in scenes that it trims.
    pub(crate) fn exact(&self) -> Option<&ExactScene> {
        if let Some(Trims::Exact(trims)) = &self.trims { Some(trims) } else { None }
    }

    /// A baseline's buffers, in scenes that it trims.
    #[cfg(feature = "baselines")]
    pub(crate) fn baseline(&self) -> Option<&BaselineScene> {
        if let Some(Trims::Baseline(trims)) = &self.trims { Some(trims) } else { None }
    }

    /// The scene's patches with these views.
    pub(crate) fn placed<'a>(&'a self, views: &'a TexelBuffer) -> Placed<'a> {
        Placed {
            views,
            face_instances: &self.face_instances,
            faces: &self.faces,
            patches: &self.patches,
            patch_instances: &self.patch_instances,
            points: &self.points,
        }
    }

    /// Makes the buffers. The arrays that they are for are in the returned [`Uploads`].
    pub(crate) fn new<'d>(device: &Device, data: &'d SceneData) -> Result<(Self, Uploads<'d>), GpuError> {
        let mut uploads = Uploads::new();
        let scene = Self {
            patches: texels(&mut uploads, device, "patches", &data.patches, Texel::U32x4)?,
            outside: (!data.outside.is_empty())
                .then(|| persistent(&mut uploads, device, "patches outside", &data.outside))
                .transpose()?,
            cones: (!data.cones.is_empty())
                .then(|| persistent(&mut uploads, device, "patch cones", &data.cones))
                .transpose()?,
            points: texels(&mut uploads, device, "points", &data.points, Texel::F32x4)?,
            links: (!data.links.is_empty())
                .then(|| persistent(&mut uploads, device, "patch links", &data.links))
                .transpose()?,
            faces: read_both(&mut uploads, device, "faces", &data.faces, Texel::U32x4)?,
            face_instances: read_both(&mut uploads, device, "face instances", &data.face_instances, Texel::U32x4)?,
            instances: read_both(&mut uploads, device, "instances", &data.instances, Texel::U32x4)?,
            patch_instances: read_both(&mut uploads, device, "patch instances", &data.patch_instances, Texel::Words)?,
            #[cfg(feature = "baselines")]
            slefes: match &data.division {
                Division::Bound => None,
                Division::Slefe(table) => Some(persistent(&mut uploads, device, "slefes", table)?),
            },
            trims: match data.trim_way() {
                None => None,
                Some(TakenWay::Table) => Some(Trims::Table(Box::new(table_scene(&mut uploads, device, data)?))),
                #[cfg(feature = "baselines")]
                Some(TakenWay::Baseline(method)) => {
                    Some(Trims::Baseline(Box::new(baseline_scene(&mut uploads, device, data, method)?)))
                }
                Some(TakenWay::Exact) => Some(Trims::Exact(Box::new(ExactScene {
                    faces: texels(&mut uploads, device, "trim faces", &data.exact.faces, Texel::U32x4)?,
                    cells: texels(&mut uploads, device, "trim cells", &data.exact.cells, Texel::Words)?,
                    arcs: texels(&mut uploads, device, "trim arcs", &data.exact.arcs, Texel::U32x4)?,
                }))),
            },
            solids: (!data.solids.leaves.is_empty())
                .then(|| {
                    Ok(Solids {
                        leaves: persistent(&mut uploads, device, "solid leaves", &data.solids.leaves)?,
                        leaf_surfaces: texels(
                            &mut uploads,
                            device,
                            "solid sides",
                            &data.solids.leaf_surfaces,
                            Texel::U32x2,
                        )?,
                        surfaces: surfaces(&mut uploads, device, "solid surfaces", &data.solids)?,
                        boundary_operands: (!data.solids.operand_leaves.is_empty())
                            .then(|| boundary_operands(&mut uploads, device, &data.solids))
                            .transpose()?,
                        order: (!data.solids.order.is_empty())
                            .then(|| persistent(&mut uploads, device, "solid order", &data.solids.order))
                            .transpose()?
                            .map(|order| (order, data.solids.order.len() as u32)),
                        blister: (data.solids.blister.as_ref())
                            .map(|b| {
                                let order = if b.order.is_empty() { &[0] } else { b.order.as_slice() };
                                Ok((b.clone(), persistent(&mut uploads, device, "solid order", order)?))
                            })
                            .transpose()?,
                    })
                })
                .transpose()?,
            meshes: data
                .has_meshes()
                .then(|| {
                    let m = &data.meshes;
                    Ok(MeshBuffers {
                        meshes: persistent(&mut uploads, device, "meshes", &m.meshes)?,
                        instances: persistent(&mut uploads, device, "mesh instances", &m.instances)?,
                        positions: persistent(&mut uploads, device, "mesh positions", &m.positions)?,
                        triangles: persistent(&mut uploads, device, "mesh triangles", &m.triangles)?,
                        neighbours: (!m.neighbours.is_empty())
                            .then(|| persistent(&mut uploads, device, "mesh neighbours", &m.neighbours))
                            .transpose()?,
                        normals: persistent(&mut uploads, device, "mesh normals", &m.normals)?,
                        draws: m.draws.clone(),
                        outward: m.outward,
                    })
                })
                .transpose()?,
            volume: data
                .volume
                .as_ref()
                .map(|v| {
                    Ok(Volume {
                        leaves: persistent(&mut uploads, device, "volume leaves", &v.leaves)?,
                        leaf_surfaces: texels(&mut uploads, device, "volume sides", &v.leaf_surfaces, Texel::U32x2)?,
                        surfaces: surfaces(&mut uploads, device, "volume surfaces", v)?,
                    })
                })
                .transpose()?,
            sources: (data.has_numbers || data.has_lines())
                .then(|| texels(&mut uploads, device, "instance sources", &data.sources, Texel::U32x2))
                .transpose()?,
            edges: (data.edges.as_ref().filter(|edges| !edges.piece_instances.is_empty()))
                .map(|edges| edge_buffers(&mut uploads, device, edges))
                .transpose()?,
            sun: (data.sun.as_ref().filter(|sun| sun.has_casters()))
                .map(|sun| {
                    let none = [Default::default()];
                    let leaves = if sun.leaves.is_empty() { &none } else { sun.leaves.as_slice() };
                    let usage = Buffer::STORAGE;
                    Ok(SunTiles {
                        tiles: persistent(&mut uploads, device, "sun tiles", &sun.tiles)?,
                        leaves: uploads.owned_buffer(device, Pool::Persistent, "sun leaves", usage, leaves)?,
                        triangles: some_texels(&mut uploads, device, "sun triangles", &sun.triangles, Texel::U32x4)?,
                        facets: some_texels(&mut uploads, device, "sun facets", &sun.facets, Texel::U32x4)?,
                        lists: some_texels(&mut uploads, device, "sun lists", &sun.lists, Texel::Words)?,
                    })
                })
                .transpose()?,
        };
        Ok((scene, uploads))
    }
}

fn edge_buffers<'d>(uploads: &mut Uploads<'d>, device: &Device, edges: &'d EdgeData) -> Result<EdgeBuffers, GpuError> {
    Ok(EdgeBuffers {
        pieces: persistent(uploads, device, "edge pieces", &edges.pieces)?,
        points: texels(uploads, device, "edge points", &edges.points, Texel::F32x4)?,
        lines: persistent(uploads, device, "edge lines", &edges.lines)?,
        own_faces: persistent(uploads, device, "edge faces", &edges.own_faces)?,
        piece_instances: persistent(uploads, device, "piece instances", &edges.piece_instances)?,
        face_keys: texels(uploads, device, "edge face keys", &edges.face_keys, Texel::Words)?,
    })
}

fn table_scene<'d>(uploads: &mut Uploads<'d>, device: &Device, data: &'d SceneData) -> Result<TableScene, GpuError> {
    Ok(TableScene {
        cells: persistent(uploads, device, "trim cells", &data.cells)?,
        cell_instances: persistent(uploads, device, "trim cell instances", &data.cell_instances)?,
        curves: texels(uploads, device, "trim curves", &data.curves, Texel::U32x4)?,
        curve_points: texels(uploads, device, "trim curve points", &data.curve_points, Texel::Numbers)?,
        curve_instances: texels(uploads, device, "trim curve instances", &data.curve_instances, Texel::Words)?,
        wide_strips: (!data.wide_strips.is_empty())
            .then(|| persistent(uploads, device, "trim wide strips", &data.wide_strips))
            .transpose()?,
    })
}

#[cfg(feature = "baselines")]
fn baseline_scene<'d>(
    uploads: &mut Uploads<'d>,
    device: &Device,
    data: &'d SceneData,
    method: TrimMethod,
) -> Result<BaselineScene, GpuError> {
    Ok(match method {
        TrimMethod::Untrimmed => BaselineScene::Untrimmed,
        TrimMethod::Bisect { .. } => {
            let b = &data.bisect;
            BaselineScene::Bisect([
                texels(uploads, device, "trim bisect faces", &b.faces, Texel::Words)?,
                texels(uploads, device, "trim bisect bands", &b.bands, Texel::U32x2)?,
                texels(uploads, device, "trim bisect cells", &b.cells, Texel::U32x4)?,
                texels(uploads, device, "trim bisect lists", &b.lists, Texel::Words)?,
                texels(uploads, device, "trim bisect pieces", &b.pieces, Texel::U32x2)?,
                texels(uploads, device, "trim bisect points", &b.points, Texel::Numbers)?,
            ])
        }
        TrimMethod::Texture { eighths } => {
            let knob = [(eighths as f32 / 8.0).to_bits(), data.face_instances.len() as u32];
            let knob = uploads.owned_buffer(device, Pool::Persistent, "trim texture knob", Buffer::STORAGE, &knob)?;
            BaselineScene::Texture(table_scene(uploads, device, data)?, knob)
        }
    })
}

fn boundary_operands<'d>(
    uploads: &mut Uploads<'d>,
    device: &Device,
    data: &'d SolidData,
) -> Result<BoundaryOperands, GpuError> {
    Ok(BoundaryOperands {
        leaves: persistent(uploads, device, "operand leaves", &data.operand_leaves)?,
        meshes: persistent(uploads, device, "operand meshes", &data.operand_meshes)?,
        triangles: persistent(uploads, device, "operand triangles", &data.operand_triangles)?,
        positions: persistent(uploads, device, "operand positions", &data.operand_positions)?,
        planes: persistent(uploads, device, "operand planes", &data.operand_planes)?,
        draws: data.operand_draws.clone(),
    })
}

fn surfaces(uploads: &mut Uploads<'_>, device: &Device, name: &str, data: &SolidData) -> Result<TexelBuffer, GpuError> {
    let texels: Vec<_> = data.surfaces.iter().map(Surface::texels).collect();
    let usage = vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
    let buffer = uploads.owned_buffer(device, Pool::Persistent, name, usage, &texels)?;
    TexelBuffer::new(device, buffer, Texel::F32x4)
}

/// Buffers for passes that read structs and for passes that fetch texels.
fn read_both<'d, T: Pod>(
    uploads: &mut Uploads<'d>,
    device: &Device,
    name: &str,
    data: &'d [T],
    texel: Texel,
) -> Result<TexelBuffer, GpuError> {
    let usage = Buffer::STORAGE | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
    TexelBuffer::new(device, uploads.buffer(device, Pool::Persistent, name, usage, data)?, texel)
}

/// Buffers for passes that only fetch texels, so the size limit of storage buffers does not apply.
fn texels<'d, T: Pod>(
    uploads: &mut Uploads<'d>,
    device: &Device,
    name: &str,
    data: &'d [T],
    texel: Texel,
) -> Result<TexelBuffer, GpuError> {
    let usage = vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
    let buffer = uploads.buffer(device, Pool::Persistent, name, usage, data)?;
    TexelBuffer::new(device, buffer, texel)
}

/// `None` if `data` is empty.
fn some_texels<'d, T: Pod>(
    uploads: &mut Uploads<'d>,
    device: &Device,
    name: &str,
    data: &'d [T],
    texel: Texel,
) -> Result<Option<TexelBuffer>, GpuError> {
    (!data.is_empty()).then(|| texels(uploads, device, name, data, texel)).transpose()
}

fn persistent<'d, T: Pod>(
    uploads: &mut Uploads<'d>,
    device: &Device,
    name: &str,
    data: &'d [T],
) -> Result<Buffer, GpuError> {
    uploads.buffer(device, Pool::Persistent, name, Buffer::STORAGE, data)
}
