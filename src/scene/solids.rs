//! Boolean solids as GPU data: switches, and the surfaces of their primitives.
//!
//! ```text
//!   solids ──one tree: their union──▶ Blist ──▶ Leaf per switch ──▶ LeafSurface per side ──▶ Surface
//!          ──transparent ones ──────▶ a Blist each, after it                                (shared where
//!   cylinder:  round side (quadric) ∩ below the top ∩ above the bottom                    sides coincide)
//! ```
//!
//! A surface is stored in coordinates of its own, of a size about 1, so single precision suffices. Its place stays in
//! `f64` and is given relative to the eye every frame.

mod blister;
mod boundary_operand;
mod order;
mod seen;
mod surface;

use super::face::pack_colour;
use crate::abi;
use crate::csg::Blist;
use crate::model::{Bounds, Items, Shape, Solid, SolidError, SurfaceTable};
use crate::picture::{SolidWay, TakenWay};
pub(crate) use blister::{Asked, Blister};
pub(super) use boundary_operand::Operand;
use glam::DVec3;
use std::borrow::Cow;
use std::ops::Range;
pub(super) use surface::Surface;
use surface::{Placed, sides_of};

/// The arrays for the GPU, and the centres, which frames convert to the eye's coordinates.
#[derive(Clone, Debug, Default)]
pub(crate) struct SolidData {
    pub leaves: Vec<abi::Leaf>,
    /// Leaves before this one belong to the opaque union. The others are lists of items that rays are followed through.
    pub followed: u32,
    pub leaf_surfaces: Vec<abi::LeafSurface>,
    /// The surfaces that are not planes; they come first.
    pub surfaces: Vec<Surface>,
    /// Middle of each leaf's box, model coordinates.
    pub leaf_centres: Vec<DVec3>,
    /// The place of each surface.
    pub places: Vec<Placed>,
    /// For each operand without equations, a leaf that shows it.
    pub operand_leaves: Vec<u32>,
    /// The box around each operand without equations.
    pub(super) operand_boxes: Vec<Bounds>,
    /// The meshes of operands: triangles, vertices relative to the middle of the operand's box, and the corners to draw
    /// of each mesh.
    pub operand_meshes: Vec<abi::OperandMesh>,
    pub operand_triangles: Vec<[u32; 3]>,
    pub operand_positions: Vec<[f32; 3]>,
    /// The surface of each triangle, or [`NO_PLANE`](abi::NO_PLANE); only for meshes with a triangle whose plane others
    /// share.
    pub operand_planes: Vec<u32>,
    pub operand_draws: Vec<Range<u32>>,
    /// The operands without equations, until their data is uploaded.
    pub(super) operands: Vec<boundary_operand::Operand>,
    /// For [`SolidWay::Cst`]: the leaves in the order of drawing.
    pub order: Vec<u32>,
    /// For [`SolidWay::Blister`].
    pub blister: Option<Blister>,
}

/// Why a solid is not drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what each field is
#[non_exhaustive]
pub enum UndrawnSolid {
    /// There are too many primitives, or the expression is too large.
    #[error(transparent)]
    Union(#[from] SolidError),
    /// There are more sides of primitives, or operands without equations, than an entry of a tile's list can number.
    #[error("more than {} sides of primitives, or operands without equations", 1u32 << (u32::BITS - abi::LEAF_FLAG_BITS))]
    Sides,
    /// A volume that trims a model has a primitive without equations.
    #[error("a volume that trims a model has a mesh or a part among its primitives; it needs equations")]
    Volume,
    /// The way to trim is a baseline's.
    #[error("what a volume trims is not drawn by `{0}`")]
    VolumeBy(&'static str),
}

/// Solids in three groups. The first `opaque` ones form one union. Rays are followed through each from `followed` on,
/// and those from `clear` on are transparent.
#[derive(Clone, Debug)]
pub(crate) struct Lists<'a> {
    pub solids: Cow<'a, [Solid]>,
    pub opaque: usize,
    pub followed: usize,
    pub clear: usize,
}

impl<'a> Lists<'a> {
    /// All solids as one union.
    pub(super) fn union(solids: &'a [Solid]) -> Self {
        let count = solids.len();
        Self { solids: Cow::Borrowed(solids), opaque: count, followed: count, clear: count }
    }

    /// Transparent items are followed; with `all`, every item is.
    pub(super) fn of(items: Items, all: bool) -> Self {
        let Items { opaque, parts, clear, .. } = items;
        let (first, second) = (opaque.len(), opaque.len() + parts.len());
        let solids = Cow::Owned([opaque, parts, clear].concat());
        Self { solids, opaque: first, followed: if all { 0 } else { first }, clear: second }
    }
}

/// Primitives and their shared surfaces.
struct Shared {
    whole: Solid,
    table: SurfaceTable,
    /// Numbers of the table's surfaces; [`NO_PLANE`](abi::NO_PLANE) for planes that belong to one triangle.
    surface_of: Vec<u32>,
    middle: DVec3,
    /// The operand number of each primitive without equations.
    boundary_operands: Vec<Option<u32>>,
    /// The first leaf of each primitive in the union: where it is added, and where it is subtracted.
    leaf_of: Vec<[Option<u32>; 2]>,
    /// The surface of primitives without volume.
    nothing: Option<u32>,
}

impl SolidData {
    /// The switches of all lists, one list after another.
    ///
    /// `coincidence` is that of [`Model::coincidence`](crate::model::Model::coincidence).
    pub(crate) fn new(lists: &Lists<'_>, coincidence: f64, way: SolidWay) -> Result<Self, UndrawnSolid> {
        let mut data = Self::default();
        let whole = Solid::union(&lists.solids)?;
        let table = SurfaceTable::new(&whole, coincidence);
        let middle = middle_of(&lists.solids);
        let surface_of = data.push_surfaces(&whole, &table, middle);
        let boundary_operands = vec![None; whole.primitives().len()];
        let leaf_of = vec![[None; 2]; whole.primitives().len()];
        let mut shared = Shared { whole, table, surface_of, middle, boundary_operands, leaf_of, nothing: None };
        let some = (lists.opaque < lists.solids.len()).then(|| Solid::union(&lists.solids[..lists.opaque]));
        let some = some.transpose()?;
        let seen = some.as_ref().unwrap_or(&shared.whole);
        let (union, reaches) = (Blist::new(seen.tree()).map_err(SolidError::from)?, seen.reaches());
        data.push_list(&mut shared, &union, 0, 0, &reaches);
        data.followed = data.leaves.len() as u32;
        let mut first = 0;
        for (k, solid) in lists.solids.iter().enumerate() {
            if k >= lists.followed {
                let list = Blist::new(solid.tree()).map_err(SolidError::from)?;
                let flags = if k < lists.clear { abi::LEAF_ELSEWHERE } else { 0 };
                // a ray that follows it meets what the union hides
                data.push_list(&mut shared, &list, first, flags, &solid.reaches());
            }
            first += solid.primitives().len() as u32;
        }
        if data.leaf_surfaces.len().max(data.operand_leaves.len()) >> (u32::BITS - abi::LEAF_FLAG_BITS) != 0 {
            return Err(UndrawnSolid::Sides);
        }
        number_exits(&mut data.leaves);
        data.put_planes_last();
        for item in data.followed as usize..data.leaves.len() {
            // an item that contains everything far away is present in every tile
            let leaf = &mut data.leaves[item];
            if leaf.item as usize == item && leaf.flags & abi::LEAF_FALLS == 0 {
                leaf.flags |= abi::LEAF_UNBOUNDED;
            }
        }
        if way == SolidWay::Cst && data.operand_leaves.is_empty() && !data.is_followed() {
            let mut used = vec![false; data.places.len()];
            let again = |side: &abi::LeafSurface| {
                std::mem::replace(&mut used[(side.surface >> abi::SIDE_SHIFT) as usize], true)
            };
            data.order = order::order(&data.leaves, data.leaf_surfaces.iter().any(again));
        }
        let splines = data.operands.iter().any(|operand| !operand.faces().is_empty());
        let peels = way == SolidWay::Blister && !splines && !data.is_followed();
        if peels && !data.leaves.is_empty() && blister::face_outward(&data, coincidence) {
            let made = Blister::new(&data, shared.whole.tree(), shared.whole.primitives(), &shared.leaf_of);
            data.blister = Some(made.map_err(SolidError::from)?);
        }
        Ok(data)
    }

    /// Adds surfaces in the order of their first faces, which give their places; returns their numbers. A triangle that
    /// shares its plane with no other gets none.
    fn push_surfaces(&mut self, whole: &Solid, table: &SurfaceTable, middle: DVec3) -> Vec<u32> {
        let mut users = vec![0u32; table.surfaces().len()];
        let primitives = || (0..).zip(whole.primitives());
        primitives().flat_map(|(p, _)| table.faces(p)).for_each(|face| users[face.surface as usize] += 1);
        let mut numbers = vec![abi::NO_PLANE; users.len()];
        for (p, primitive) in primitives() {
            let faces = table.faces(p).iter().map(|face| face.surface as usize);
            if let Shape::Mesh(mesh) = &primitive.shape {
                let thin = boundary_operand::Thin::of(primitive);
                for (t, surface) in faces.enumerate() {
                    if numbers[surface] == abi::NO_PLANE && (users[surface] > 1 || thin.is(mesh.corners(t))) {
                        numbers[surface] = self.push_surface(surface::of_triangle(primitive, mesh.corners(t), middle));
                    }
                }
                continue;
            }
            for (surface, placed) in faces.zip(sides_of(primitive, middle)) {
                if numbers[surface] == abi::NO_PLANE {
                    numbers[surface] = self.push_surface(Some(placed));
                }
            }
        }
        numbers
    }

    fn push_surface(&mut self, placed: Option<surface::Placed>) -> u32 {
        let Some(placed) = placed else { return abi::NO_PLANE };
        self.places.push(placed);
        self.places.len() as u32 - 1
    }

    /// Renumbers surfaces so that planes come last, and sorts sides likewise: a plane then needs no shape record.
    fn put_planes_last(&mut self) {
        let is_plane = |p: &Placed| p.surface().is_none();
        let mut order: Vec<usize> = (0..self.places.len()).collect();
        order.sort_by_key(|&i| is_plane(&self.places[i]));
        let mut number = vec![0; order.len()];
        (0..).zip(&order).for_each(|(new, &old)| number[old] = new);
        self.places = order.iter().map(|&old| self.places[old]).collect();
        self.surfaces = self.places.iter().map_while(Placed::surface).collect();
        for plane in self.operand_planes.iter_mut().filter(|plane| **plane != abi::NO_PLANE) {
            *plane = number[*plane as usize];
        }
        for side in &mut self.leaf_surfaces {
            let new = number[(side.surface >> abi::SIDE_SHIFT) as usize];
            let plane = if is_plane(&self.places[new as usize]) { abi::SIDE_PLANE } else { 0 };
            side.surface = new << abi::SIDE_SHIFT | plane | side.surface & abi::SIDE_NEGATIVE;
        }
        for sides in self.leaf_surfaces.chunk_by_mut(|a, b| a.leaf == b.leaf) {
            sides.sort_by_key(|side| side.surface & abi::SIDE_PLANE);
            let flags = &mut self.leaves[sides[0].leaf as usize].flags;
            for kind in sides.chunk_by_mut(|a, b| (a.surface ^ b.surface) & abi::SIDE_PLANE == 0) {
                *flags |= if kind[0].surface & abi::SIDE_PLANE != 0 { abi::LEAF_PLANES } else { abi::LEAF_ROUNDS };
                kind.iter_mut().rev().skip(1).for_each(|side| side.surface |= abi::SIDE_MORE);
            }
        }
    }

    /// Adds the switches of one list. Its primitives begin at `first_primitive`, and each matters only within its box
    /// in `reaches`.
    fn push_list(
        &mut self,
        shared: &mut Shared,
        list: &Blist,
        first_primitive: u32,
        all_flags: u32,
        reaches: &[Bounds],
    ) {
        let item = self.leaves.len() as u32;
        for (i, entry) in (0..).zip(list.entries()) {
            let (t, f) = entry.exits(i);
            let (in_exit, out_exit) = if entry.negative() { (f, t) } else { (t, f) };
            let exit = |to: u32| match to.checked_sub(list.outside()) {
                None => item + to,
                Some(0) => abi::EXIT_FALSE,
                Some(_) => abi::EXIT_TRUE,
            };
            let p = first_primitive + entry.primitive();
            let primitive = &shared.whole.primitives()[p as usize];
            // whether a point is within a boundary operand is decided by its box
            let is_boundary_operand = boundary_operand::is_boundary_operand(primitive);
            let bounds = if is_boundary_operand { primitive.bounds() } else { reaches[entry.primitive() as usize] };
            let bounded = bounds.is_empty() || bounds.min.is_finite() && bounds.max.is_finite();
            let (centre, half) = match bounded {
                true if bounds.is_empty() => (shared.middle, DVec3::ZERO), // a single point, anywhere
                // faces lie on the surface that they share, which may be that of a larger primitive
                true => {
                    let beyond = if is_boundary_operand { 0.0 } else { shared.table.distance() };
                    (bounds.centre(), (bounds.max - bounds.min) * 0.5 + beyond)
                }
                false => (shared.middle, DVec3::INFINITY),
            };
            let mut flags = all_flags;
            flags |= if bounded { 0 } else { abi::LEAF_UNBOUNDED };
            flags |= if entry.negative() { abi::LEAF_NEGATIVE } else { 0 };
            let leaf = self.leaves.len() as u32;
            shared.leaf_of[p as usize][usize::from(entry.negative())].get_or_insert(leaf);
            let operand = is_boundary_operand.then(|| {
                let known = &mut shared.boundary_operands[p as usize];
                *known.get_or_insert_with(|| {
                    let surfaces = shared.table.faces(p).iter().map(|f| shared.surface_of[f.surface as usize]);
                    self.push_boundary_operand(surfaces, primitive, leaf)
                })
            });
            flags |= if is_boundary_operand { abi::LEAF_BOUNDARY } else { 0 };
            let first = self.leaf_surfaces.len() as u32;
            let faces = if is_boundary_operand { &[] } else { shared.table.faces(p) };
            let sides =
                faces.iter().map(|f| shared.surface_of[f.surface as usize] << abi::SIDE_SHIFT | u32::from(f.flipped));
            self.leaf_surfaces.extend(sides.map(|surface| abi::LeafSurface { surface, leaf }));
            if faces.is_empty() && !is_boundary_operand {
                // no point is within a primitive without volume
                let nowhere = || self.push_surface(Some(surface::nowhere(shared.middle)));
                let nothing = *shared.nothing.get_or_insert_with(nowhere);
                self.leaf_surfaces.push(abi::LeafSurface { surface: nothing << abi::SIDE_SHIFT, leaf });
            }
            self.leaf_centres.push(centre);
            self.leaves.push(abi::Leaf {
                half_size: half.as_vec3().to_array().map(f32::next_up),
                first: operand.unwrap_or(first),
                count: self.leaf_surfaces.len() as u32 - first,
                colour: pack_colour(primitive.colour),
                id: primitive.id,
                in_exit: exit(in_exit),
                out_exit: exit(out_exit),
                flags,
                item,
                ..Default::default()
            });
        }
    }

    /// Faces of primitives of these numbers are cuts.
    pub(super) fn mark_cuts(&mut self, cuts: &[u32]) {
        for leaf in self.leaves.iter_mut().filter(|leaf| cuts.contains(&leaf.id)) {
            leaf.flags |= abi::LEAF_CAP;
        }
    }

    /// [`SolidWay::Events`] finds the faces, by request or because no other way can.
    pub(crate) fn is_by_events(&self) -> bool {
        !self.leaves.is_empty() && self.blister.is_none() && self.order.is_empty()
    }

    /// Whether rays are followed through some of the lists.
    pub(crate) fn is_followed(&self) -> bool {
        (self.followed as usize) < self.leaves.len()
    }

    /// Some solid that is seen through is no closed part or mesh alone: those have edges of their own.
    pub(crate) fn has_clear_solids(&self) -> bool {
        let leaves = (0..).zip(&self.leaves).skip(self.followed as usize);
        let is_one = |(number, leaf): (u32, &abi::Leaf)| leaf.flags & abi::LEAF_BOUNDARY == 0 || leaf.item != number;
        leaves.filter(|(_, leaf)| leaf.flags & abi::LEAF_ELSEWHERE == 0).any(is_one)
    }

    /// Number of faces of solids that are seen through that one ray may meet, at most: both ends of each leaf's span,
    /// and of its gap. `None` where an operand without equations bounds one.
    pub(crate) fn most_clear_faces(&self) -> Option<u32> {
        let leaves = self.leaves[self.followed as usize..].iter().filter(|leaf| leaf.flags & abi::LEAF_ELSEWHERE == 0);
        leaves.map(|leaf| (leaf.flags & abi::LEAF_BOUNDARY == 0).then(|| if self.has_gap(leaf) { 4 } else { 2 })).sum()
    }

    /// Whether a ray may be within a leaf with equations twice.
    fn has_gap(&self, leaf: &abi::Leaf) -> bool {
        let mut sides = self.leaf_surfaces[leaf.first as usize..][..leaf.count as usize].iter();
        sides.any(|side| {
            let surface = self.places[(side.surface >> abi::SIDE_SHIFT) as usize].surface();
            let is_convex = |s: Surface| !s.is_torus && s.squares.iter().all(|square| *square >= 0.0);
            surface.is_some_and(|s| !is_convex(s) || side.surface & abi::SIDE_NEGATIVE != 0)
        })
    }

    /// Whether the leaf of an operand without equations belongs to a solid that is seen through, beside other leaves.
    pub(super) fn is_in_clear_solid(&self, leaf: u32) -> bool {
        let Some(of) = self.leaves.get(leaf as usize).filter(|of| of.flags & abi::LEAF_ELSEWHERE == 0) else {
            return false;
        };
        let second = self.leaves.get(of.item as usize + 1);
        leaf >= self.followed && second.is_some_and(|second| second.item == of.item)
    }

    /// The volume that trims a scene; `None` if it is all of space.
    pub(super) fn volume(volume: &Solid, coincidence: f64, way: TakenWay) -> Result<Option<Self>, UndrawnSolid> {
        if !matches!(way, TakenWay::Table | TakenWay::Exact) {
            return Err(UndrawnSolid::VolumeBy(way.name()));
        }
        if volume.tree().fold(|_| None).as_constant() == Some(true) {
            return Ok(None);
        }
        let mut data = Self::new(&Lists::union(std::slice::from_ref(volume)), coincidence, SolidWay::Events)?;
        if !data.operand_leaves.is_empty() {
            return Err(UndrawnSolid::Volume);
        }
        if data.leaves.is_empty() {
            data.push_nothing(); // every walk begins at a leaf
        }
        Ok(Some(data))
    }

    /// Adds a leaf that contains no point.
    fn push_nothing(&mut self) {
        let nothing = self.push_surface(Some(surface::nowhere(DVec3::ZERO)));
        self.leaf_surfaces.push(abi::LeafSurface { surface: nothing << abi::SIDE_SHIFT, leaf: 0 });
        let (in_exit, out_exit) = (abi::EXIT_TRUE, abi::EXIT_FALSE);
        self.leaf_centres.push(DVec3::ZERO);
        self.leaves.push(abi::Leaf { count: 1, in_exit, out_exit, ..Default::default() });
        self.put_planes_last();
    }

    /// The most general kind of surface, `SURFACE_*`; `None` without leaves.
    pub(crate) fn kinds(&self) -> Option<u32> {
        (!self.leaves.is_empty()).then(|| match self.surfaces.as_slice() {
            [] => abi::SURFACE_PLANE,
            some if some.iter().any(|s| s.is_torus) => abi::SURFACE_TORUS,
            _ => abi::SURFACE_QUADRIC,
        })
    }

    /// The part that frames still need after the upload.
    pub(crate) fn centres_only(self) -> Self {
        let Self { leaf_centres, places, operand_boxes, .. } = self;
        Self { leaf_centres, places, operand_boxes, ..Self::default() }
    }
}

/// A point near all bounded solids.
fn middle_of(solids: &[Solid]) -> DVec3 {
    let all = solids.iter().map(Solid::bounds).filter(|b| b.min.is_finite() && b.max.is_finite());
    let all = all.fold(crate::model::Bounds::EMPTY, crate::model::Bounds::union);
    if all.is_empty() { DVec3::ZERO } else { all.centre() }
}

/// Numbers the leaves so that all leaves whose chain of out-exits passes through a leaf form a range, and marks the end
/// of each chain. Exits lead forward.
fn number_exits(leaves: &mut [abi::Leaf]) {
    let mut size = vec![1u32; leaves.len()];
    for i in 0..leaves.len() {
        let out = leaves[i].out_exit;
        if out < abi::EXIT_FALSE {
            size[out as usize] += size[i];
        }
    }
    // parents stand after their children, so they are numbered first; `next` is the first free number below each leaf,
    // and below the two ends
    let mut next = vec![0u32; leaves.len()];
    let mut ends = 0;
    for i in (0..leaves.len()).rev() {
        let out = leaves[i].out_exit;
        let free = if out < abi::EXIT_FALSE { &mut next[out as usize] } else { &mut ends };
        let pre = *free;
        *free += size[i];
        next[i] = pre + 1;
        let falls = match out {
            abi::EXIT_FALSE => abi::LEAF_FALLS,
            abi::EXIT_TRUE => 0,
            _ => leaves[out as usize].flags & abi::LEAF_FALLS,
        };
        let leaf = &mut leaves[i];
        (leaf.pre, leaf.end) = (pre, pre + size[i]);
        leaf.flags |= falls;
    }
}
