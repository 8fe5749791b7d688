//! The scene's counts, and checks that 32 bits number all of them.

use super::common::kernel::MOST_THREADS;
use super::solids::lists::{Limits, Lists};
use super::trim::BorderCells;
use crate::abi::{Factors, Leaf, MeshInstance, PieceInstance, StripRows};
use crate::picture::{Samples, TakenWay};
use crate::scene::SceneData;
use std::fmt;

/// The scene's counts, summed over placed faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub patch_instances: u32,
    /// Lists of patches of one segment a side: of plain ones, and of trimmed ones.
    pub corner_lists: u32,
    /// Groups of faces of placed parts.
    pub placed_groups: u32,
    pub cells: u32,
    pub bins: u32,
    /// v-strips with several bins.
    pub wide_strips: u32,
    pub curves: u32,
    pub face_instances: u32,
    /// A pass reads the views of all placed parts, not only of those in sight.
    pub views_all: bool,
    /// The scene has occlusion culling.
    pub hides: bool,
    /// The same of groups of faces of placed parts.
    pub hides_parts: bool,
    /// Patches or meshes are drawn as surfaces of their own.
    pub has_surfaces: bool,
    /// Leaves of Boolean solids.
    pub leaves: u32,
    /// Operands of Boolean solids without equations.
    pub boundary_operands: u32,
    /// Patches bound some operands.
    pub operand_patches: bool,
    /// [`SolidWay::Blister`](crate::picture::SolidWay::Blister) draws the solids.
    pub blister: bool,
    /// [`SolidWay::Events`](crate::picture::SolidWay::Events) draws the solids, band by band if lists are too large.
    pub events: bool,
    /// Most bytes of the lists of events: [`SceneSettings::solid_budget`](crate::picture::SceneSettings::solid_budget).
    pub solid_budget: Option<u64>,
    pub triangles: u32,
    /// Sides of leaves with equations, and triangles of the other leaves.
    pub leaf_sides: u32,
    pub sides: u32,
    pub mesh_instances: u32,
    /// The way to trim, if some face is trimmed.
    pub trim: Option<TakenWay>,
    /// Samples of each pixel.
    pub samples: Samples,
    /// The first leaf of items that rays are followed through, if there are any.
    pub followed_leaf: u32,
    pub is_followed: bool,
    /// Styles may show curvature.
    pub curvature: bool,
    /// The scene measures lengths within solids.
    pub thickness: bool,
    /// Instances drawn opaque, although transparent, because they are not closed.
    pub open: u32,
    /// Number of things that cast no shadow, in a scene with a sun.
    pub shadowless: u32,
    /// Placed pieces of edges along which lines are drawn.
    pub piece_instances: u32,
    /// How many of them are curved.
    pub curved_piece_instances: u32,
    /// There are lines, along edges or silhouettes.
    pub lines: bool,
    /// Faces' surfaces may be followed to points at borders.
    pub follows_borders: bool,
}

impl Counts {
    pub(crate) fn of(data: &SceneData) -> Self {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let by_view = !matches!(data.trim_way(), None | Some(TakenWay::Exact)) || data.has_lines();
        Self {
            patch_instances: data.patch_instances.len() as u32,
            corner_lists: data.corner_lists(),
            placed_groups: data.placed_groups(),
            cells: data.cell_instances.len() as u32,
            bins: data.bin_count,
            wide_strips: count(data.wide_strips.len()),
            curves: data.curve_instances.len() as u32,
            face_instances: data.face_instances.len() as u32,
            views_all: by_view || data.has_meshes() || data.has_operands || !data.solids.leaves.is_empty(),
            hides: data.hides(),
            hides_parts: data.hides_parts(),
            has_surfaces: data.has_surfaces(),
            leaves: data.solids.leaves.len() as u32,
            boundary_operands: data.solids.operand_leaves.len() as u32,
            operand_patches: data.has_operands,
            blister: data.solids.blister.is_some(),
            events: data.solids.is_by_events(),
            solid_budget: data.solid_budget,
            triangles: count(data.meshes.triangles.len().max(data.meshes.positions.len() / 3)),
            leaf_sides: count(data.solids.leaf_surfaces.len()),
            sides: count(data.solids.leaf_surfaces.len() + data.solids.operand_triangles.len()),
            mesh_instances: count(data.meshes.instances.len()),
            trim: data.trim_way(),
            samples: data.samples,
            followed_leaf: data.solids.followed,
            is_followed: data.solids.is_followed(),
            curvature: data.curvature,
            thickness: data.thickness,
            open: count(data.open),
            shadowless: count(data.shadowless),
            piece_instances: data.edges.as_ref().map_or(0, |edges| count(edges.piece_instances.len())),
            curved_piece_instances: data.edges.as_ref().map_or(0, |edges| count(edges.curved_piece_instances())),
            lines: data.has_lines(),
            follows_borders: data.follows_borders(),
        }
    }

    /// What grows when a model joins the scene.
    fn sizes(&mut self) -> [&mut u32; 9] {
        let Self {
            patch_instances,
            placed_groups,
            cells,
            bins,
            wide_strips,
            curves,
            face_instances,
            triangles,
            mesh_instances,
            ..
        } = self;
        [patch_instances, placed_groups, cells, bins, wide_strips, curves, face_instances, triangles, mesh_instances]
    }

    /// With those of a model that joins the scene: parts, and nothing that the scene has none of.
    pub(crate) fn and(mut self, mut more: Self) -> Self {
        let pairs = self.sizes().into_iter().zip(more.sizes());
        pairs.for_each(|(sum, more)| *sum = sum.saturating_add(*more));
        self.views_all |= more.views_all;
        self
    }

    /// With half as much again of all that grows.
    pub(crate) fn with_spare(mut self) -> Self {
        self.sizes().into_iter().for_each(|size| *size = size.saturating_add(*size / 2));
        self
    }

    /// Buffers that were made for `room` hold as much.
    pub(crate) fn fits(mut self, mut room: Self) -> bool {
        self.sizes().into_iter().zip(room.sizes()).all(|(size, room)| size <= room)
    }

    /// Lists of sub-patches, and of draws: plain, trimmed, and patches that are drawn by their corners.
    pub(crate) fn patch_lists(self) -> u32 {
        2 + self.corner_lists
    }

    /// The crossings of rays with operands are stored.
    pub(crate) fn has_fragments(self) -> bool {
        self.boundary_operands > 0 && !self.blister
    }

    /// Limits of the event lists, for storage buffers of `range` bytes.
    pub(crate) fn limits(self, range: u32) -> Limits {
        Limits { range, budget: self.solid_budget.unwrap_or(u64::MAX) }
    }

    pub(crate) fn lists(self, size: (u32, u32), range: u32) -> Lists {
        Lists { size, has_fragments: self.has_fragments(), limits: self.limits(range) }
    }

    /// Checks that 32 bits number everything, and that a storage buffer of `range` bytes holds the largest list of each
    /// kind.
    pub(crate) fn check(self, range: u32) -> Result<(), TooMany> {
        let border_cells = if self.operand_patches { size_of::<BorderCells>() } else { 0 };
        let word = size_of::<u32>();
        let all = [
            ("patches", self.patch_instances, MOST_SEEN - 1, size_of::<Factors>(), FEWER_PARTS),
            ("cells", self.cells, MOST_THREADS, word, EXACT),
            ("bins of v-strips", self.bins, MOST_THREADS, border_cells.max(size_of::<StripRows>()), EXACT),
            ("v-strips with several bins", self.wide_strips, MOST_THREADS, word, EXACT),
            ("curves", self.curves, MOST_THREADS, word, EXACT),
            ("triangles", self.triangles, MOST_TRIANGLES, 3 * word, "draw fewer of the meshes, or coarser ones"),
            ("primitives", self.leaves, MOST_THREADS, size_of::<Leaf>(), FEWER_SOLIDS),
            ("placed meshes", self.mesh_instances, MOST_SEEN, size_of::<MeshInstance>(), FEWER_PARTS),
            (
                "pieces of edges",
                self.piece_instances,
                MOST_THREADS,
                size_of::<PieceInstance>(),
                "draw lines along fewer edges",
            ),
            ("sides of primitives", self.sides, MOST_SEEN, word, FEWER_SOLIDS),
        ];
        let over = all.into_iter().find_map(|(what, count, most, bytes, help)| {
            let over = TooMany::of_numbers(what, count, most, help);
            over.or_else(|| TooMany::of_bytes((what, count), bytes, range, help))
        });
        over.map_or(Ok(()), Err)
    }
}

/// The model, or one view of it, exceeds the engine's numbers or the device's buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{count} {what} are too many: at most {most} can be drawn{}; {help}{}", Why(.bytes), Where(.bytes))]
#[non_exhaustive]
pub struct TooMany {
    /// The kind of thing of which there are too many.
    pub what: &'static str,
    /// Their number.
    pub count: u32,
    /// The largest possible number.
    pub most: u32,
    /// If a buffer is too small: the bytes needed, and the most bytes that the device binds.
    pub bytes: Option<(u64, u64)>,
    /// What to do instead.
    pub help: &'static str,
}

/// The reason, as part of the message of [`TooMany`].
struct Why<'a>(&'a Option<(u64, u64)>);

impl fmt::Display for Why<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some((wanted, most)) => {
                write!(f, ", because they want {wanted} bytes in one buffer, and this device binds {most}")?;
                write!(f, " (maxStorageBufferRange, maxTexelBufferElements)")
            }
            None => Ok(()),
        }
    }
}

/// The devices that draw it, as part of the message of [`TooMany`].
struct Where<'a>(&'a Option<(u64, u64)>);

impl fmt::Display for Where<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_some() { f.write_str(", or take a device or driver that binds more") } else { Ok(()) }
    }
}

impl TooMany {
    /// `None` if `count` is at most `most`.
    pub(crate) fn of_numbers(what: &'static str, count: u32, most: u32, help: &'static str) -> Option<Self> {
        (count > most).then_some(Self { what, count, most, bytes: None, help })
    }

    /// `None` if a buffer of `range` bytes holds `count` elements of this size.
    pub(crate) fn of_bytes(
        (what, count): (&'static str, u32),
        bytes: usize,
        range: u32,
        help: &'static str,
    ) -> Option<Self> {
        let wanted = u64::from(count) * bytes as u64;
        let most = range / bytes as u32;
        (count > most).then_some(Self { what, count, most, bytes: Some((wanted, range.into())), help })
    }

    /// Whether the trim table is too large. The exact way needs none.
    pub(crate) fn is_of_table(&self) -> bool {
        self.help == EXACT
    }
}

/// [`TooMany::help`].
pub(super) const EXACT: &str = "trim by the way `exact`, or by `auto`, which takes it where the other has no room";
pub(super) const FEWER_PARTS: &str = "draw fewer parts at once, or place fewer copies";
const FEWER_SOLIDS: &str = "draw fewer of the Boolean solids at once";
pub(super) const SMALLER: &str = "draw a smaller picture";

/// Most triangles: 32 bits number their corners, and the coordinates of their vertices.
pub(super) const MOST_TRIANGLES: u32 = u32::MAX / 3;
/// The numbers that the visibility image can tell apart.
pub(super) const MOST_SEEN: u32 = 1 << 29;
