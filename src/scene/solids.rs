//! Boolean solids turned into what the GPU keeps: switches, and the surfaces around their primitives.
//!
//! ```text
//!   solids ──one tree: their union──▶ Blist ──▶ Leaf per switch ──▶ LeafSurface per side ──▶ Surface
//!          ──those seen through─────▶ a Blist each, behind it                            (shared where
//!   cylinder:  round side (quadric) ∩ below the top ∩ above the bottom                    sides coincide)
//! ```
//!
//! A surface is stored in coordinates of its own, of about the size of 1, so single precision suffices;
//! where it is stays in `f64` and is given relative to the eye every frame.

mod blister;
mod order;
mod seen;
mod shell;
mod surface;

use super::face::pack_colour;
use crate::abi;
use crate::csg::Blist;
use crate::model::{Bounds, Items, Primitive, Shape, Solid, SolidError, SurfaceTable};
use crate::picture::{SolidWay, TakenWay};
pub(crate) use blister::{Asked, Blister};
use glam::DVec3;
pub(super) use shell::Operand;
use std::borrow::Cow;
use std::ops::Range;
pub(super) use surface::Surface;
use surface::{Placed, sides_of};

/// The arrays that the GPU gets, and the centres that change with the eye.
#[derive(Clone, Debug, Default)]
pub(crate) struct SolidData {
    pub leaves: Vec<abi::Leaf>,
    /// From this one on they are lists of items that rays are followed through; before it, of the union that is seen.
    pub followed: u32,
    pub leaf_surfaces: Vec<abi::LeafSurface>,
    /// Of those that are no planes, which come first.
    pub surfaces: Vec<Surface>,
    /// Middle of each leaf's box, model coordinates.
    pub leaf_centres: Vec<DVec3>,
    /// Where each surface is.
    pub places: Vec<Placed>,
    /// Of each operand without equations, a leaf that shows it.
    pub shell_leaves: Vec<u32>,
    /// And the box around it.
    pub(super) shell_boxes: Vec<Bounds>,
    /// The meshes around them: triangles, vertices relative to the middle of the operand's box, and corners to
    /// draw of each.
    pub operand_meshes: Vec<abi::OperandMesh>,
    pub operand_triangles: Vec<[u32; 3]>,
    pub operand_positions: Vec<[f32; 3]>,
    /// Of each triangle of meshes some of whose triangles lie in a plane with others, the surface, or
    /// [`NO_PLANE`](abi::NO_PLANE).
    pub operand_planes: Vec<u32>,
    pub operand_draws: Vec<Range<u32>>,
    /// Those, until the GPU has what is made of them.
    pub(super) operands: Vec<shell::Operand>,
    /// For [`SolidWay::Cst`]: the leaves as they are drawn.
    pub order: Vec<u32>,
    /// For [`SolidWay::Blister`].
    pub blister: Option<Blister>,
}

/// Why a solid is not drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what each field is
#[non_exhaustive]
pub enum UndrawnSolid {
    /// There are too many primitives, or their expression is too large.
    #[error(transparent)]
    Union(#[from] SolidError),
    /// Primitives have more sides, or there are more operands without equations, than an entry of a tile's list can name.
    #[error("more than {} sides of primitives, or operands without equations", 1u32 << (u32::BITS - abi::LEAF_FLAG_BITS))]
    Sides,
    /// A volume that trims a model is not made of what has equations.
    #[error("a volume that trims a model has a mesh or a part among its primitives; it needs equations")]
    Volume,
    /// The way to trim is for comparisons.
    #[error("what a volume trims is not drawn by `{0}`")]
    VolumeBy(&'static str),
}

/// Solids, and what becomes of them: the first `opaque` are one union, from `followed` on rays are followed through
/// each, and those from `clear` on are drawn so.
#[derive(Clone, Debug)]
pub(crate) struct Lists<'a> {
    pub solids: Cow<'a, [Solid]>,
    pub opaque: usize,
    pub followed: usize,
    pub clear: usize,
}

impl<'a> Lists<'a> {
    /// The union of all.
    pub(super) fn union(solids: &'a [Solid]) -> Self {
        let count = solids.len();
        Self { solids: Cow::Borrowed(solids), opaque: count, followed: count, clear: count }
    }

    /// What is seen through is followed; `all`: everything is.
    pub(super) fn of(items: Items, all: bool) -> Self {
        let Items { opaque, parts, clear, .. } = items;
        let (first, second) = (opaque.len(), opaque.len() + parts.len());
        let solids = Cow::Owned([opaque, parts, clear].concat());
        Self { solids, opaque: first, followed: if all { 0 } else { first }, clear: second }
    }
}

/// Primitives and the surfaces that they share.
struct Shared {
    whole: Solid,
    table: SurfaceTable,
    /// Numbers of the surfaces in the table, [`NO_PLANE`](abi::NO_PLANE) of those that triangles have to themselves.
    surface_of: Vec<u32>,
    middle: DVec3,
    /// Numbers of the primitives that are shells.
    shells: Vec<Option<u32>>,
    /// First leaves of each in the union: where it adds, and where it is taken away.
    leaf_of: Vec<[Option<u32>; 2]>,
    /// The surface of what has no volume.
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
        let shells = vec![None; whole.primitives().len()];
        let leaf_of = vec![[None; 2]; whole.primitives().len()];
        let mut shared = Shared { whole, table, surface_of, middle, shells, leaf_of, nothing: None };
        let some = (lists.opaque < lists.solids.len()).then(|| Solid::union(&lists.solids[..lists.opaque]));
        let some = some.transpose()?;
        let seen = some.as_ref().unwrap_or(&shared.whole);
        let (union, reaches) = (Blist::new(seen.tree()).map_err(SolidError::from)?, seen.reaches());
        data.push_list(&mut shared, &union, 0, 0, &reaches);
        data.followed = data.leaves.len() as u32;
        let mut first = 0;
        // what is followed tells of solids beyond what their unions show
        let boxes: Vec<Bounds> = shared.whole.primitives().iter().map(Primitive::bounds).collect();
        for (k, solid) in lists.solids.iter().enumerate() {
            if k >= lists.followed {
                let list = Blist::new(solid.tree()).map_err(SolidError::from)?;
                let flags = if k < lists.clear { abi::LEAF_ELSEWHERE } else { 0 };
                data.push_list(&mut shared, &list, first, flags, &boxes[first as usize..]);
            }
            first += solid.primitives().len() as u32;
        }
        if data.leaf_surfaces.len().max(data.shell_leaves.len()) >> (u32::BITS - abi::LEAF_FLAG_BITS) != 0 {
            return Err(UndrawnSolid::Sides);
        }
        number_exits(&mut data.leaves);
        data.put_planes_last();
        for item in data.followed as usize..data.leaves.len() {
            // an item that holds all that is far away is there in every tile
            let leaf = &mut data.leaves[item];
            if leaf.item as usize == item && leaf.flags & abi::LEAF_FALLS == 0 {
                leaf.flags |= abi::LEAF_UNBOUNDED;
            }
        }
        if way == SolidWay::Cst && data.shell_leaves.is_empty() && !data.is_followed() {
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

    /// Surfaces in the order in which their first faces are met, which say where they are; returns their numbers. A
    /// triangle that lies in a plane by itself does without.
    fn push_surfaces(&mut self, whole: &Solid, table: &SurfaceTable, middle: DVec3) -> Vec<u32> {
        let mut users = vec![0u32; table.surfaces().len()];
        let primitives = || (0..).zip(whole.primitives());
        primitives().flat_map(|(p, _)| table.faces(p)).for_each(|face| users[face.surface as usize] += 1);
        let mut numbers = vec![abi::NO_PLANE; users.len()];
        for (p, primitive) in primitives() {
            let faces = table.faces(p).iter().map(|face| face.surface as usize);
            if let Shape::Mesh(mesh) = &primitive.shape {
                let thin = shell::Thin::of(primitive);
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

    /// Surfaces get their numbers, and sides their order: so that planes need no shape, and are told by their sides.
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

    /// The switches of one list, whose primitives are those from `first_primitive` on and matter within `reaches`.
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
            // places within shells are told from their boxes
            let is_shell = shell::is_shell(primitive);
            let bounds = if is_shell { primitive.bounds() } else { reaches[entry.primitive() as usize] };
            let bounded = bounds.is_empty() || bounds.min.is_finite() && bounds.max.is_finite();
            let (centre, half) = match bounded {
                true if bounds.is_empty() => (shared.middle, DVec3::ZERO), // somewhere, a point
                // a face is that of the surface that it shares: of another primitive, which may be larger
                true => {
                    let beyond = if is_shell { 0.0 } else { shared.table.distance() };
                    (bounds.centre(), (bounds.max - bounds.min) * 0.5 + beyond)
                }
                false => (shared.middle, DVec3::INFINITY),
            };
            let mut flags = all_flags;
            flags |= if bounded { 0 } else { abi::LEAF_UNBOUNDED };
            flags |= if entry.negative() { abi::LEAF_NEGATIVE } else { 0 };
            let leaf = self.leaves.len() as u32;
            shared.leaf_of[p as usize][usize::from(entry.negative())].get_or_insert(leaf);
            let shell = is_shell.then(|| {
                let known = &mut shared.shells[p as usize];
                *known.get_or_insert_with(|| {
                    let surfaces = shared.table.faces(p).iter().map(|f| shared.surface_of[f.surface as usize]);
                    self.push_shell(surfaces, primitive, leaf)
                })
            });
            flags |= if is_shell { abi::LEAF_SHELL } else { 0 };
            let first = self.leaf_surfaces.len() as u32;
            let faces = if is_shell { &[] } else { shared.table.faces(p) };
            let sides =
                faces.iter().map(|f| shared.surface_of[f.surface as usize] << abi::SIDE_SHIFT | u32::from(f.flipped));
            self.leaf_surfaces.extend(sides.map(|surface| abi::LeafSurface { surface, leaf }));
            if faces.is_empty() && !is_shell {
                // a primitive without volume is the inside of no point
                let nowhere = || self.push_surface(Some(surface::nowhere(shared.middle)));
                let nothing = *shared.nothing.get_or_insert_with(nowhere);
                self.leaf_surfaces.push(abi::LeafSurface { surface: nothing << abi::SIDE_SHIFT, leaf });
            }
            self.leaf_centres.push(centre);
            self.leaves.push(abi::Leaf {
                half_size: half.as_vec3().to_array().map(f32::next_up),
                first: shell.unwrap_or(first),
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

    /// [`SolidWay::Events`] finds the faces: asked for, or for want of another way.
    pub(crate) fn is_by_events(&self) -> bool {
        !self.leaves.is_empty() && self.blister.is_none() && self.order.is_empty()
    }

    /// Whether rays are followed through some of the lists.
    pub(crate) fn is_followed(&self) -> bool {
        (self.followed as usize) < self.leaves.len()
    }

    /// The volume that trims a scene; `None` when it is everywhere.
    pub(super) fn volume(volume: &Solid, coincidence: f64, way: TakenWay) -> Result<Option<Self>, UndrawnSolid> {
        if !matches!(way, TakenWay::Table | TakenWay::Exact) {
            return Err(UndrawnSolid::VolumeBy(way.name()));
        }
        if volume.tree().fold(|_| None).as_constant() == Some(true) {
            return Ok(None);
        }
        let mut data = Self::new(&Lists::union(std::slice::from_ref(volume)), coincidence, SolidWay::Events)?;
        if !data.shell_leaves.is_empty() {
            return Err(UndrawnSolid::Volume);
        }
        if data.leaves.is_empty() {
            data.push_nothing(); // every walk begins at a leaf
        }
        Ok(Some(data))
    }

    /// A leaf that no point is in.
    fn push_nothing(&mut self) {
        let nothing = self.push_surface(Some(surface::nowhere(DVec3::ZERO)));
        self.leaf_surfaces.push(abi::LeafSurface { surface: nothing << abi::SIDE_SHIFT, leaf: 0 });
        let (in_exit, out_exit) = (abi::EXIT_TRUE, abi::EXIT_FALSE);
        self.leaf_centres.push(DVec3::ZERO);
        self.leaves.push(abi::Leaf { count: 1, in_exit, out_exit, ..Default::default() });
        self.put_planes_last();
    }

    /// `None` without leaves, else the most general kind of surface: `SURFACE_*`.
    pub(crate) fn kinds(&self) -> Option<u32> {
        (!self.leaves.is_empty()).then(|| match self.surfaces.as_slice() {
            [] => abi::SURFACE_PLANE,
            some if some.iter().any(|s| s.is_torus) => abi::SURFACE_TORUS,
            _ => abi::SURFACE_QUADRIC,
        })
    }

    /// What frames need once the GPU has the rest.
    pub(crate) fn centres_only(self) -> Self {
        let Self { leaf_centres, places, shell_boxes, .. } = self;
        Self { leaf_centres, places, shell_boxes, ..Self::default() }
    }
}

/// A point near everything that is bounded.
fn middle_of(solids: &[Solid]) -> DVec3 {
    let all = solids.iter().map(Solid::bounds).filter(|b| b.min.is_finite() && b.max.is_finite());
    let all = all.fold(crate::model::Bounds::EMPTY, crate::model::Bounds::union);
    if all.is_empty() { DVec3::ZERO } else { all.centre() }
}

/// Numbers the leaves so that the leaves whose chain of out-exits passes a leaf are a range, and marks
/// where the chains end. Exits lead forward.
fn number_exits(leaves: &mut [abi::Leaf]) {
    let mut size = vec![1u32; leaves.len()];
    for i in 0..leaves.len() {
        let out = leaves[i].out_exit;
        if out < abi::EXIT_FALSE {
            size[out as usize] += size[i];
        }
    }
    // parents stand behind their children, so they are numbered first; `next` is the first number free
    // below each leaf, and below the two ends
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
