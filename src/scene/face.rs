//! One face: patches, cells and trim curves, with indices relative to the face.

use super::cells::{cells, strips};
use super::cones::Normals;
use super::edit::{EditFace, EditLoop, EditPatch};
use super::exact::exact_trim;
use super::fine::fine_net;
pub(super) use super::flatten::Cuts;
use super::flatten::flattened;
use super::sides::side_flags;
use super::sub_patches::{SubPatches, sub_patches};
use crate::abi;
use crate::abi::Side;
use crate::model::{Face, TrimLoop};
use crate::picture::TakenWay;
use crate::spline::{Bezier, Control, Patch, PatchGrid, SurfacePatch};
use crate::trim::{ExactTrim, LoopIndex, RectSide, chord_bend};
use glam::{DVec2, DVec3};

/// A side is a point if its control points are at most this far from each other, relative to the patch's size: some
/// roundings of single precision.
pub(super) const POINT: f64 = 1e-6;

/// One face's part of the scene's arrays.
#[derive(Clone)]
pub(super) struct FaceData {
    pub face: abi::Face,
    pub patches: Vec<abi::Patch>,
    /// The cells of each patch that no part of the face covers.
    pub outside: Vec<[u32; 2]>,
    /// Normals of each patch of a [`Body::Seamless`].
    pub normals: Vec<Normals>,
    pub points: Vec<[f32; 4]>,
    pub cells: Vec<abi::Cell>,
    pub curves: Vec<abi::Curve>,
    pub curve_points: Vec<f32>,
    /// The exact way's data; empty for other ways.
    pub exact: ExactTrim,
    /// The data that edits need, in editable scenes.
    pub edit: Option<EditFace>,
    pub rational: bool,
    /// The face has several patches, which do not all follow one equation.
    pub pieces: bool,
    /// Some patch has a fine net.
    pub fine: bool,
    /// Smooth borders may follow the surface: it is not one patch of a plane, which its terms of second order are.
    pub followed: bool,
}

/// The kind of part that a face belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Body {
    Open,
    /// Declared closed.
    Closed,
    /// Declared closed, and without trims.
    Seamless,
}

/// The rectangle of the surface's parameters, and its map to the unit square.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Domain {
    pub origin: DVec2,
    pub size: DVec2,
}

impl Domain {
    pub(super) fn unit(&self, p: DVec2) -> DVec2 {
        (p - self.origin) / self.size
    }
}

/// How the faces of a scene are trimmed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trimming {
    pub way: TakenWay,
    /// Trims are smoothed: pass `coverage` measures the borders.
    pub smooth: bool,
    /// Loops may be edited.
    pub editable: bool,
    /// Extent of the picture for which patches are split ([`sub_patches`](super::sub_patches)), in units of the part.
    /// If it is infinite, no patch is split.
    pub extent: f64,
}

impl FaceData {
    pub(super) fn new(face: &Face, origin: DVec3, body: Body, trim: Trimming, cuts: Cuts) -> Self {
        let Trimming { way, smooth, editable, .. } = trim;
        let flat = flattened(face.surface.patches(), cuts.in_face(face));
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let domain = Domain { origin: DVec2::new(u0, v0), size: DVec2::new(u1 - u0, v1 - v0) };
        let index = (!face.loops.is_empty()).then(|| LoopIndex::new(&face.loops));
        let SubPatches { grid, sides, shares } = match &index {
            None => {
                let sides = vec![Side::Inside; flat.patches.len()];
                SubPatches::whole(flat.clone(), sides)
            }
            Some(index) => sub_patches(flat.clone(), index, trim.extent),
        };
        let trimmed = sides.contains(&Side::Boundary);
        let table = trimmed && needs_curves(way);
        let editable = editable && trimmed && matches!(way, TakenWay::Table | TakenWay::Exact);
        let mut data = Self {
            face: abi::Face {
                domain: [u0 as f32, v0 as f32, (u1 - u0) as f32, (v1 - v0) as f32],
                count_u: grid.count_u as u32,
                count_v: grid.count_v as u32,
                strips: if table { strips(face, flat.count_v, way) } else { 0 },
                ..Default::default()
            },
            patches: Vec::new(),
            // an edit would change these cells
            outside: if editable { vec![[0; 2]; sides.len()] } else { outside(&grid, &sides, index.as_ref()) },
            normals: if body == Body::Seamless { Normals::of(&grid, face.same_sense, origin) } else { Vec::new() },
            points: Vec::new(),
            cells: Vec::new(),
            curves: Vec::new(),
            curve_points: Vec::new(),
            exact: match way {
                TakenWay::Exact if trimmed => exact_trim(&face.loops, &domain, smooth),
                _ => ExactTrim::default(),
            },
            edit: None,
            rational: !face.surface.is_polynomial(),
            pieces: flat.patches.len() > 1 && !face.kind.is_elementary(),
            fine: false,
            followed: false,
        };
        let flag = |on: bool, bit: u32| if on { bit } else { 0 };
        let (lo, hi) = face.surface.bounds();
        let size = (hi - lo).length();
        data.face.flags = flag(face.same_sense, abi::FACE_SAME_SENSE)
            | flag(body != Body::Open, abi::FACE_SOLID)
            | flag(trimmed, abi::FACE_TRIMMED)
            | side_flags(&flat, size);
        for (n, (patch, side)) in grid.patches.iter().zip(&sides).enumerate() {
            data.push_patch(&grid, n, patch, (*side, editable), origin, &domain);
            let shares = [shares[0][n % grid.count_u], shares[1][n / grid.count_u]];
            let pushed = data.patches.last_mut().expect("it was pushed");
            pushed.shape = abi::Patch::with_shares(pushed.shape, shares);
        }
        data.followed = is_followed(data.face.flags, &data.patches);
        data.edit = editable.then(|| data.edit_face(&grid, domain, smooth));
        if let Some(edit) = data.edit.as_mut().filter(|_| !table) {
            edit.loops.extend(face.loops.iter().map(|l| EditLoop::new(l, 0, 0)));
        }
        if table {
            // sub-patches would add more cells than they save rows
            let mut is_cut = vec![false; flat.patches.len()];
            for (p, _) in grid.patches.iter().zip(&sides).filter(|(_, side)| **side == Side::Boundary) {
                is_cut[flat.index(0.5 * (p.u.0 + p.u.1), 0.5 * (p.v.0 + p.v.1))] = true;
            }
            for (n, (patch, cut)) in flat.patches.iter().zip(is_cut).enumerate() {
                let first = data.cells.len();
                if cut || editable {
                    data.cells.extend(cells(&data.face, patch, origin, &domain));
                }
                if let Some(edit) = &mut data.edit {
                    edit.cells.extend(data.cells[first..].iter().map(|cell| (n as u32, cell.speed_v)));
                }
                if !cut {
                    data.cells[first..].iter_mut().for_each(|cell| cell.speed_v = -cell.speed_v);
                }
            }
            face.loops.iter().for_each(|l| data.push_loop(l, &domain));
        }
        if !trimmed {
            data.close_seams(grid.count_u, grid.count_v);
        }
        data.name(face);
        data
    }

    /// Sets the number and the colour, in which faces of like parts differ.
    pub(super) fn name(&mut self, face: &Face) {
        self.face.id = face.id;
        self.face.colour = face.colour.map_or(DEFAULT_COLOUR, pack_colour);
    }

    fn push_patch(
        &mut self,
        grid: &PatchGrid,
        n: usize,
        p: &SurfacePatch,
        (side, editable): (Side, bool),
        origin: DVec3,
        domain: &Domain,
    ) {
        let (i, j) = (n % grid.count_u, n / grid.count_u);
        let border = |on: bool, bit: u32| if on { bit } else { 0 };
        let borders = border(i == 0, abi::BORDER_U0)
            | border(i + 1 == grid.count_u, abi::BORDER_U1)
            | border(j == 0, abi::BORDER_V0)
            | border(j + 1 == grid.count_v, abi::BORDER_V1);
        // beyond a pole the surface folds over, so a trimmed face is not continued there
        let poles = if self.face.flags & abi::FACE_TRIMMED != 0 { poles(&p.patch) } else { 0 };
        let borders = borders & !poles;
        let bend = p.patch.derivative_bound();
        let (lo, hi) = outward_box(&p.patch, origin);
        let corner = domain.unit(DVec2::new(p.u.0, p.v.0));
        let size = domain.unit(DVec2::new(p.u.1, p.v.1)) - corner;
        self.patches.push(abi::Patch {
            box_min: lo,
            first: self.points.len() as u32,
            box_max: hi,
            shape: abi::Patch::pack_shape((p.patch.degree_u, p.patch.degree_v), self.rational, side, borders),
            domain: [corner.x as f32, corner.y as f32, size.x as f32, size.y as f32],
            bend: flat_is_zero([bend.uu, bend.twist, bend.vv], p.patch.bounds()).map(|x| x as f32),
            face: 0,
        });
        if side == Side::Outside && !editable {
            return; // never drawn: its control points are not uploaded
        }
        // only the ratios of weights matter: one unit for the whole face keeps shared control points
        // the same bit for bit; those of a polynomial face become 1, exactly
        let unit = if self.rational { grid.patches[0].patch.points[0].w } else { p.patch.points[0].w };
        for q in &p.patch.points {
            let local = (q.truncate() - origin * q.w) / unit;
            self.points.push([
                local.x as f32,
                local.y as f32,
                local.z as f32,
                if self.rational { (q.w / unit) as f32 } else { 1.0 },
            ]);
        }
        if let Some(net) = fine_net(&p.patch, origin, unit) {
            self.points.extend(net);
            self.fine = true;
            let patch = self.patches.last_mut().expect("it was pushed above");
            patch.shape = abi::Patch::with_fine_net(patch.shape);
        }
    }

    /// The data about patches that edits need.
    fn edit_face(&self, grid: &PatchGrid, domain: Domain, smooth: bool) -> EditFace {
        let rect = |p: &SurfacePatch| (DVec2::new(p.u.0, p.v.0), DVec2::new(p.u.1, p.v.1));
        let patch = |(p, word): (&SurfacePatch, &abi::Patch)| {
            let (lo, hi) = rect(p);
            EditPatch { lo, hi, shape: word.shape }
        };
        let patches = grid.patches.iter().zip(&self.patches).map(patch).collect();
        EditFace {
            domain,
            smooth,
            loops: Vec::new(),
            patches,
            first_patch: 0,
            first_cell: 0,
            cells: Vec::new(),
            exact: None,
        }
    }

    fn push_loop(&mut self, l: &TrimLoop, domain: &Domain) {
        let (mut curves, points) = loop_curves(l, domain);
        let first = self.curve_points.len() as u32;
        curves.iter_mut().for_each(|c| c.first += first);
        if let Some(edit) = &mut self.edit {
            edit.loops.push(EditLoop::new(l, self.curves.len() as u32, first));
        }
        self.curves.extend(curves);
        self.curve_points.extend(points);
    }

    /// If the first and last column (row) of control points are equal up to rounding, makes them equal bit for bit and
    /// marks the face closed: its seam then has no crack.
    fn close_seams(&mut self, count_u: usize, count_v: usize) {
        if self.seam(count_u, count_v, true) {
            self.face.flags |= abi::FACE_CLOSED_U;
        }
        if self.seam(count_u, count_v, false) {
            self.face.flags |= abi::FACE_CLOSED_V;
        }
    }

    fn seam(&mut self, count_u: usize, count_v: usize, along_u: bool) -> bool {
        /// Relative to the face's size: a few roundings of single precision.
        const SAME: f32 = 1e-6;
        let size = self.points.iter().flatten().fold(0.0f32, |m, x| m.max(x.abs()));
        let lines = if along_u { count_v } else { count_u };
        let mut pairs = Vec::new(); // (control point of the first side, of the last side)
        for line in 0..lines {
            let (a, b) = if along_u {
                (line * count_u, line * count_u + count_u - 1)
            } else {
                (line, (count_v - 1) * count_u + line)
            };
            let (a, b) = (&self.patches[a], &self.patches[b]);
            let (n, k) = ((a.shape & 15) as usize, (a.shape >> 4 & 15) as usize);
            let side = if along_u { k } else { n };
            for s in 0..=side {
                let (i, j) = if along_u { (s * (n + 1), s * (n + 1) + n) } else { (s, k * (n + 1) + s) };
                pairs.push((a.first as usize + i, b.first as usize + j));
            }
        }
        let near = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).all(|(x, y)| (x - y).abs() <= SAME * size.max(1.0));
        let same = pairs.iter().all(|&(a, b)| near(self.points[a], self.points[b]));
        if same {
            pairs.iter().for_each(|&(a, b)| self.points[b] = self.points[a]);
        }
        same
    }
}

/// A loop's curves and control points, with indices relative to the first ones. Curves along a scan line have no
/// crossings; they only mark cells at borders (`glsl/include/border_cells.glsl`).
pub(super) fn loop_curves(l: &TrimLoop, domain: &Domain) -> (Vec<abi::Curve>, Vec<f32>) {
    // every joint is rounded once and used by both its curves, so the loop stays closed in f32
    let curves: Vec<Bezier<DVec3>> = l.curves().collect();
    let (mut out, mut points) = (Vec::with_capacity(curves.len()), Vec::new());
    let mut rightmost = f32::NEG_INFINITY;
    let joint = |c: &Bezier<DVec3>| {
        let p = domain.unit(c.points[0].point());
        [p.x as f32, p.y as f32]
    };
    for (k, c) in curves.iter().enumerate() {
        let (start, end) = (joint(c), joint(&curves[(k + 1) % curves.len()]));
        let unit: Vec<DVec3> =
            c.points.iter().map(|p| DVec3::from_point(domain.unit(p.point()), p.z / c.points[0].z)).collect();
        let v = |p: &DVec3| (p.y / p.z) as f32;
        let lowest = unit.iter().map(v).fold(start[1].min(end[1]), f32::min);
        let highest = unit.iter().map(v).fold(start[1].max(end[1]), f32::max);
        let u = |p: &DVec3| (p.x / p.z) as f32;
        let leftmost = unit.iter().map(u).fold(start[0].min(end[0]), f32::min);
        rightmost = unit.iter().map(u).fold(rightmost.max(start[0]), f32::max);
        let degree = c.degree() as u32;
        let bend = chord_bend(&Bezier { points: unit.clone() });
        out.push(abi::Curve {
            start,
            end,
            first: points.len() as u32,
            degree,
            bend: [round_up(bend.x), round_up(bend.y)],
            range_v: [lowest, highest],
            range_u: [leftmost, f32::NAN], // set when all curves are known
        });
        if degree > 1 {
            points.extend(unit.iter().flat_map(|p| [p.x as f32, p.y as f32, p.z as f32]));
        }
    }
    out.iter_mut().for_each(|c| c.range_u[1] = rightmost);
    (out, points)
}

/// Neutral grey, linear 0.55, opaque.
pub(super) const DEFAULT_COLOUR: u32 = 0xff8c_8c8c;

/// Linear colour to unorm bytes, red lowest.
pub(super) fn pack_colour(c: crate::model::Colour) -> u32 {
    u32::from_le_bytes(c.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8))
}

/// Whether the way needs curves and cells in every view.
fn needs_curves(way: TakenWay) -> bool {
    way == TakenWay::Table || way.is_texture()
}

/// For each patch that a loop crosses: a bit for each of [`abi::OUTSIDE_CELLS`] x [`abi::OUTSIDE_CELLS`] cells, row by
/// row from the lowest bit on. A bit is set if no part of the face covers the cell.
fn outside(grid: &PatchGrid, sides: &[Side], loops: Option<&LoopIndex>) -> Vec<[u32; 2]> {
    let cells = |p: &SurfacePatch| {
        let Some(index) = loops else { return [0; 2] };
        let (corner, end) = (DVec2::new(p.u.0, p.v.0), DVec2::new(p.u.1, p.v.1));
        let mut bits = 0u64;
        // a square that a loop crosses is divided into four, down to single cells
        let mut left = vec![(0, 0, abi::OUTSIDE_CELLS)];
        while let Some((i, j, side)) = left.pop() {
            let at = |i: u32, j: u32| {
                corner + (end - corner) * DVec2::new(f64::from(i), f64::from(j)) / f64::from(abi::OUTSIDE_CELLS)
            };
            match index.classify(at(i, j), at(i + side, j + side)) {
                RectSide::Inside => {}
                RectSide::Outside => {
                    for row in j..j + side {
                        bits |= ((1 << side) - 1) << (row * abi::OUTSIDE_CELLS + i);
                    }
                }
                RectSide::Boundary if side > 1 => {
                    let half = side / 2;
                    left.extend(
                        [(i, j), (i + half, j), (i, j + half), (i + half, j + half)].map(|(i, j)| (i, j, half)),
                    );
                }
                RectSide::Boundary => {}
            }
        }
        [bits as u32, (bits >> 32) as u32]
    };
    let of = |(p, side): (&SurfacePatch, &Side)| if *side == Side::Boundary { cells(p) } else { [0; 2] };
    grid.patches.iter().zip(sides).map(of).collect()
}

/// Border bits of the sides that are points, within [`POINT`] of the patch's size.
pub(super) fn poles(patch: &Patch) -> u32 {
    let (lo, hi) = patch.bounds();
    let near = POINT * (hi - lo).length();
    let (n, k) = (patch.degree_u, patch.degree_v);
    let column = |i: usize| (0..=k).map(move |j| j * (n + 1) + i);
    let row = |j: usize| (0..=n).map(move |i| j * (n + 1) + i);
    let at = |i: usize| patch.points[i].point();
    let bit = |is_point: bool, bit: u32| if is_point { bit } else { 0 };
    bit(column(0).all(|i| at(i).distance(at(0)) <= near), abi::BORDER_U0)
        | bit(column(n).all(|i| at(i).distance(at(n)) <= near), abi::BORDER_U1)
        | bit(row(0).all(|i| at(i).distance(at(0)) <= near), abi::BORDER_V0)
        | bit(row(k).all(|i| at(i).distance(at(k * (n + 1))) <= near), abi::BORDER_V1)
}

/// The box of the control points relative to `origin`, rounded outwards.
pub(super) fn outward_box(patch: &Patch, origin: DVec3) -> ([f32; 3], [f32; 3]) {
    let (lo, hi) = patch.bounds();
    let (lo, hi) = (lo - origin, hi - origin);
    let down = |x: f64| (x as f32).next_down();
    (lo.to_array().map(down), hi.to_array().map(round_up))
}

/// Second derivatives, rounded up; exactly 0 if all of them vanish up to rounding.
fn flat_is_zero(bend: [f64; 3], (lo, hi): (DVec3, DVec3)) -> [f64; 3] {
    let rounding = 1e-12 * (hi - lo).length();
    if bend.iter().all(|x| *x <= rounding) { [0.0; 3] } else { bend.map(|x| f64::from(round_up(x))) }
}

/// Whether some point of a border may lie where a sheet of the face does not reach by its terms of second order, or where
/// the surface goes on beyond an end: `glsl/include/border_mix.glsl`. What a plane's terms leave out is 0, and within the
/// one patch of a face no place is beyond [`MOST_FROM_MIDDLE`](crate::abi::constants::border_reach::MOST_FROM_MIDDLE).
fn is_followed(flags: u32, patches: &[abi::Patch]) -> bool {
    let sides = abi::BORDER_U0 | abi::BORDER_U1 | abi::BORDER_V0 | abi::BORDER_V1;
    let goes_on = abi::FACE_MEETS_U | abi::FACE_MEETS_V | sides << abi::FACE_POINTS;
    let is_plane = matches!(patches, [patch] if patch.bend == [0.0; 3]);
    !is_plane || flags & goes_on != 0
}

/// A single-precision number above `x`.
pub(super) fn round_up(x: f64) -> f32 {
    (x as f32).next_up()
}
