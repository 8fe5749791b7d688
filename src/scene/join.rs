//! A model that joins a scene: its arrays go behind the scene's.
//!
//! ```text
//!   scene    patches ████████░░░     instances ██████░░░░     …     ░ room, in buffers that have been larger once
//!   model            ▓▓                        ▓▓▓            numbers + lengths of the scene ─▶ Writes of the next frame
//! ```
//!
//! An upload lays parts one behind the other, then instances. So each array of a model, made by itself, is what an
//! upload of both has behind the scene's, once the numbers in it count on from the scene's. Pipelines stay, and so does
//! which arrays there are. A model that wants others ([`Kinds`]) does not join: the scene is made anew with it.
//!
//! Cost: what the model costs.

use super::data::SceneData;
use super::edit::{EditTarget, Write};
use super::instance::LivePart;
use super::picking::Picking;
use super::request::SceneRequest;
use crate::abi;
use crate::abi::constants::mesh_walk::NO_TRIANGLE;
use crate::model::Model;
use crate::picture::{TakenWay, TrimWay};
use bytemuck::Pod;
use std::ops::Range;

/// How long the arrays of a scene are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Lengths {
    patches: u32,
    points: u32,
    faces: u32,
    face_instances: u32,
    instances: u32,
    patch_instances: u32,
    bins: u32,
    cells: u32,
    cell_instances: u32,
    curves: u32,
    curve_points: u32,
    curve_instances: u32,
    wide_strips: u32,
    exact: [u32; 3],
    meshes: [u32; 5],
}

/// What pipelines and buffers a scene has, as bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Kinds(u32);

/// Numbers of the model that joins, in that of the whole scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct FirstNumbers {
    pub part: usize,
    pub instance: usize,
}

/// What has to be told of a model that joined.
pub(crate) struct Joined {
    /// To the GPU, where it has the scene.
    pub writes: Vec<Write>,
    /// There, the draws of its meshes.
    pub draws: Vec<(Range<u32>, Range<u32>)>,
    /// What its numbers stand for.
    pub picking: Picking,
}

impl Lengths {
    fn of(data: &SceneData) -> Self {
        let n = |length: usize| length as u32;
        let m = &data.meshes;
        Self {
            patches: n(data.patches.len()),
            points: n(data.points.len()),
            faces: n(data.faces.len()),
            face_instances: n(data.face_instances.len()),
            instances: n(data.instances.len()),
            patch_instances: n(data.patch_instances.len()),
            bins: data.bin_count,
            cells: n(data.cells.len()),
            cell_instances: n(data.cell_instances.len()),
            curves: n(data.curves.len()),
            curve_points: n(data.curve_points.len()),
            curve_instances: n(data.curve_instances.len()),
            wide_strips: n(data.wide_strips.len()),
            exact: [data.exact.faces.len(), data.exact.cells.len(), data.exact.arcs.len()].map(n),
            meshes: [m.meshes.len(), m.instances.len(), m.positions.len(), m.triangles.len(), m.normals.len()].map(n),
        }
    }

    /// Those of both; `None` where 32 bits do not count them.
    fn and(self, more: Self) -> Option<Self> {
        let both = |a: u32, b: u32| a.checked_add(b);
        let mut exact = self.exact;
        exact.iter_mut().zip(more.exact).try_for_each(|(a, b)| both(*a, b).map(|sum| *a = sum))?;
        let mut meshes = self.meshes;
        meshes.iter_mut().zip(more.meshes).try_for_each(|(a, b)| both(*a, b).map(|sum| *a = sum))?;
        Some(Self {
            patches: both(self.patches, more.patches)?,
            points: both(self.points, more.points)?,
            faces: both(self.faces, more.faces)?,
            face_instances: both(self.face_instances, more.face_instances)?,
            instances: both(self.instances, more.instances)?,
            patch_instances: both(self.patch_instances, more.patch_instances)?,
            bins: both(self.bins, more.bins)?,
            cells: both(self.cells, more.cells)?,
            cell_instances: both(self.cell_instances, more.cell_instances)?,
            curves: both(self.curves, more.curves)?,
            curve_points: both(self.curve_points, more.curve_points)?,
            curve_instances: both(self.curve_instances, more.curve_instances)?,
            wide_strips: both(self.wide_strips, more.wide_strips)?,
            exact,
            meshes,
        })
    }
}

impl Kinds {
    fn of(data: &SceneData) -> Self {
        let all = [
            data.has_patches,
            data.has_rational,
            data.has_pieces,
            data.has_fine,
            data.has_plain,
            data.has_trimmed,
            data.has_meshes(),
            !data.links.is_empty(),
            !data.cones.is_empty(),
            !data.wide_strips.is_empty(),
            data.follows_borders(),
        ];
        Self(all.iter().enumerate().fold(0, |bits, (bit, has)| bits | u32::from(*has) << bit))
    }

    /// Has all that the other has.
    fn has(self, other: Self) -> bool {
        other.0 & !self.0 == 0
    }

    fn links(self) -> bool {
        self.0 & 1 << 7 != 0
    }

    fn cones(self) -> bool {
        self.0 & 1 << 8 != 0
    }
}

/// What the arrays of a scene are like, for models that join it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joinable {
    lengths: Lengths,
    kinds: Kinds,
    /// Patches may lie behind others.
    hides: bool,
    /// Whole parts may.
    hides_parts: bool,
    /// What the scene is made by, with the way to trim that was taken.
    request: SceneRequest,
}

impl Joinable {
    /// Of a scene of a whole model; `None` where models do not join it: it has something that follows from all of it,
    /// or that is not arrays of parts one behind the other.
    pub(crate) fn of(data: &SceneData, model: &Model, request: SceneRequest) -> Option<Self> {
        let whole =
            request.sun.is_some() || request.thickness || request.highlight.is_some() || request.edges.is_some();
        #[cfg(feature = "baselines")]
        let whole = whole || request.baseline != Default::default();
        let is_whole = whole || request.editable || !is_of_parts(model);
        if is_whole || data.live.len() != model.instances.len() || data.live.iter().any(Option::is_none) {
            return None;
        }
        let mut request = request;
        let is_exact = data.way == Some(TakenWay::Exact);
        request.settings.trim = if is_exact { TrimWay::Exact } else { TrimWay::Table };
        let (hides, hides_parts) = (data.hides(), data.hides_parts());
        Some(Self { lengths: Lengths::of(data), kinds: Kinds::of(data), hides, hides_parts, request })
    }

    /// The arrays of a model that is to join, in a scene that is so wide; `None` where the scene has to be made anew
    /// with it.
    pub(crate) fn arrays_of(&self, model: &Model, extent: f64) -> Option<SceneData> {
        if !is_of_parts(model) || !model.is_opaque() {
            return None;
        }
        let mut data = SceneData::joining(model, self.request, extent).ok()?;
        let [parts, patches] = [self.lengths.instances, self.lengths.patch_instances].map(|n| n as usize);
        let hides = self.hides || data.hides_with(patches);
        let hides_parts = self.hides_parts || data.hides_parts_with([parts, patches]);
        if self.hides_parts {
            data.find_drawn_boxes();
        }
        let is_same = hides == self.hides && hides_parts == self.hides_parts;
        (self.kinds.has(Kinds::of(&data)) && is_same).then_some(data)
    }
}

/// Nothing but parts and their instances is drawn.
fn is_of_parts(model: &Model) -> bool {
    model.solids.is_empty() && model.trim.is_none()
}

impl SceneData {
    /// Puts the arrays of `model` behind those of the scene. `None` where 32 bits do not number all of both; then
    /// nothing has changed.
    pub(crate) fn join(
        &mut self,
        (model, mut new): (&Model, SceneData),
        to: &mut Joinable,
        first: FirstNumbers,
        is_uploaded: bool,
    ) -> Option<Joined> {
        let at = to.lengths;
        to.lengths = at.and(Lengths::of(&new))?;
        new.count_from(&at, first);
        if to.kinds.links() {
            new.links.resize(4 * new.patches.len(), abi::Link::default());
        }
        if to.kinds.cones() {
            new.cones.resize(new.patches.len(), [0.0; 4]);
        }
        if !to.hides {
            new.outside.clear();
        }
        let behind = new.live.iter().flatten().map(|live| LivePart { number: live.number + at.instances, ..*live });
        let numbers = first.instance..first.instance + new.live.len();
        self.live.resize(self.live.len().max(numbers.end), None);
        self.live[numbers].iter_mut().zip(behind).for_each(|(live, new)| *live = Some(new));
        self.boxes.join(std::mem::take(&mut new.boxes), (at.patches, at.patch_instances));
        if let Some(trimmed) = &mut self.trimmed {
            trimmed.join(new.trimmed.take(), new.placements.len());
        }
        self.placements.append(&mut new.placements);
        let picking = new.picking(model, |_, face| face);
        let mut arrays = Arrays { writes: is_uploaded.then(Vec::new) };
        let [faces, cells, arcs] = at.exact;
        let [meshes, mesh_instances, positions, triangles, normals] = at.meshes;
        let (own, m) = (&mut self.meshes, new.meshes);
        arrays.put(&mut own.meshes, m.meshes, EditTarget::Mesh(0), meshes);
        arrays.put(&mut own.instances, m.instances, EditTarget::Mesh(1), mesh_instances);
        arrays.put(&mut own.positions, m.positions, EditTarget::Mesh(2), positions);
        arrays.put(&mut own.triangles, m.triangles, EditTarget::Mesh(3), triangles);
        arrays.put(&mut own.normals, m.normals, EditTarget::Mesh(4), normals);
        arrays.put(&mut own.neighbours, m.neighbours, EditTarget::Mesh(5), 3 * triangles);
        arrays.put(&mut self.exact.faces, new.exact.faces, EditTarget::Exact(0), faces);
        arrays.put(&mut self.exact.cells, new.exact.cells, EditTarget::Exact(1), cells);
        arrays.put(&mut self.exact.arcs, new.exact.arcs, EditTarget::Exact(2), arcs);
        arrays.put(&mut self.patches, new.patches, EditTarget::Patches, at.patches);
        arrays.put(&mut self.outside, new.outside, EditTarget::Outside, at.patches);
        arrays.put(&mut self.cones, new.cones, EditTarget::Cones, at.patches);
        arrays.put(&mut self.points, new.points, EditTarget::Points, at.points);
        arrays.put(&mut self.links, new.links, EditTarget::Links, 4 * at.patches);
        arrays.put(&mut self.faces, new.faces, EditTarget::Faces, at.faces);
        arrays.put(&mut self.face_instances, new.face_instances, EditTarget::FaceInstances, at.face_instances);
        arrays.put(&mut self.patch_instances, new.patch_instances, EditTarget::Items, at.patch_instances);
        arrays.put(&mut self.sources, new.sources, EditTarget::Sources, at.instances);
        arrays.put(&mut self.cells, new.cells, EditTarget::Cells, at.cells);
        arrays.put(&mut self.cell_instances, new.cell_instances, EditTarget::CellInstances, at.cell_instances);
        arrays.put(&mut self.curves, new.curves, EditTarget::Curves, at.curves);
        arrays.put(&mut self.curve_points, new.curve_points, EditTarget::CurvePoints, at.curve_points);
        arrays.put(&mut self.curve_instances, new.curve_instances, EditTarget::CurveInstances, at.curve_instances);
        arrays.put(&mut self.wide_strips, new.wide_strips, EditTarget::WideStrips, at.wide_strips);
        // each by itself: a change of it takes the place of its write
        for (instance, number) in new.instances.into_iter().zip(at.instances..) {
            arrays.put(&mut self.instances, vec![instance], EditTarget::Instances, number);
        }
        let mut draws = m.draws;
        if !is_uploaded {
            self.bin_count += new.bin_count;
            own.draws.append(&mut draws);
            own.outward = own.draws.len();
        }
        Some(Joined { writes: arrays.writes.unwrap_or_default(), draws, picking })
    }

    /// Numbers in the arrays count from the beginning of a scene that has so much before them.
    fn count_from(&mut self, at: &Lengths, first: FirstNumbers) {
        for patch in &mut self.patches {
            patch.first += at.points;
            patch.face += at.faces;
        }
        for link in self.links.iter_mut().filter(|link| link.is_shared()) {
            link.next += 4 * at.patches;
        }
        for face in &mut self.faces {
            face.first_patch += at.patches;
            face.first_cell += at.cells;
            face.first_curve += at.curves;
        }
        for placed in &mut self.face_instances {
            placed.face += at.faces;
            placed.instance += at.instances;
            placed.first_patch_instance += at.patch_instances;
            placed.first_bin += at.bins;
            placed.first_cell += at.cell_instances;
            placed.first_curve += at.curve_instances;
        }
        let lists = [&mut self.patch_instances, &mut self.cell_instances, &mut self.curve_instances];
        lists.into_iter().flatten().for_each(|placed| *placed += at.face_instances);
        self.wide_strips.iter_mut().for_each(|bin| *bin += at.bins);
        self.curves.iter_mut().for_each(|curve| curve.first += at.curve_points);
        for source in self.sources.iter_mut().filter(|source| source[1] > 0) {
            source[0] += first.part as u32;
            source[1] += first.instance as u32;
        }
        let [_, cells, arcs] = at.exact;
        self.exact.faces.iter_mut().for_each(|face| face.first_cell += cells);
        for cell in &mut self.exact.cells {
            cell.first += if cell.first & abi::CELL_SPLIT != 0 { cells } else { arcs };
        }
        let [meshes, instances, positions, triangles, normals] = at.meshes;
        for mesh in &mut self.meshes.meshes {
            mesh.first_triangle += triangles;
            mesh.first_normal += normals;
        }
        for placed in &mut self.meshes.instances {
            placed.mesh += meshes;
            placed.instance += at.instances;
        }
        self.meshes.triangles.iter_mut().flatten().for_each(|corner| *corner += positions);
        let beyond = self.meshes.neighbours.iter_mut().filter(|corner| **corner != NO_TRIANGLE);
        beyond.for_each(|corner| *corner += 3 * triangles);
        for (corners, placed) in &mut self.meshes.draws {
            *corners = corners.start + 3 * triangles..corners.end + 3 * triangles;
            *placed = placed.start + instances..placed.end + instances;
        }
    }

    /// An instance of the model is gone: nobody sees it. `None` where that cannot be said of it alone.
    pub(crate) fn leave(&mut self, instance: usize) -> Option<()> {
        let part = (*self.live.get(instance)?)?;
        if self.casts_shadows {
            return None;
        }
        self.hide(part.number, true);
        Some(())
    }
}

/// Where the arrays of a model go.
struct Arrays {
    /// To the GPU; `None`: to the scene's own, which it does not have yet.
    writes: Option<Vec<Write>>,
}

impl Arrays {
    fn put<T: Pod>(&mut self, own: &mut Vec<T>, mut new: Vec<T>, to: EditTarget, first: u32) {
        match &mut self.writes {
            None => own.append(&mut new),
            Some(_) if new.is_empty() => {}
            Some(writes) => {
                let offset = u64::from(first) * size_of::<T>() as u64;
                writes.push(Write { to, offset, bytes: bytemuck::cast_slice(&new).to_vec() });
            }
        }
    }
}

#[cfg(test)]
mod tests;
