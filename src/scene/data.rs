//! The whole scene as plain arrays, and the transforms that stay in `f64`.

use super::cones::{Normals, cones};
use super::deep_zoom::Cut;
use super::edges::EdgeData;
use super::edit::EditScene;
use super::exact::ExactData;
use super::face::{Body, Cuts, FaceData, Trimming, pack_colour};
use super::in_sight::PartBoxes;
use super::instance::{LivePart, Shown, placed_part, stretch};
use super::link::link;
use super::mesh::Meshes;
use super::parts::{PlacedPart, Told, drawn_as_faces, each_made};
use super::request::SceneRequest;
use super::solids::{Lists, SolidData, UndrawnSolid};
use super::sun::SunData;
use super::trimmed::Trimmed;
use super::way::taken;
use crate::abi;
use crate::model::{Bounds, Instance, Isolated, Mesh, Model, Part, SolidError};
#[cfg(any(test, feature = "baselines"))]
use crate::picture::SceneSettings;
use crate::picture::{Highlight, Samples, Smooth, TakenWay};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;
use std::ops::Range;

/// Scenes with fewer patches have no occlusion culling: it costs more than it saves.
const FEWEST_HIDDEN: usize = 64;

/// The measure by which patches are divided.
#[derive(Clone, Debug, Default)]
pub(crate) enum Division {
    /// Bounds on the patches' derivatives.
    #[default]
    Bound,
    /// Slefes, with the table that the pass reads: `baselines::slefe::words`.
    #[cfg(feature = "baselines")]
    Slefe(Vec<u32>),
}

/// The arrays that the GPU gets; see `glsl/include/scene.glsl` for how they refer to each other.
#[derive(Clone, Debug, Default)]
pub(crate) struct SceneData {
    pub patches: Vec<abi::Patch>,
    /// The cells of each patch that no part of the face covers; for scenes with occlusion culling.
    pub outside: Vec<[u32; 2]>,
    /// The cone of each patch's normals (`twin::cone`); empty if no part is closed and without trims.
    pub cones: Vec<[f32; 4]>,
    pub points: Vec<[f32; 4]>,
    /// Four links a patch; empty if no two untrimmed faces share a side.
    pub links: Vec<abi::Link>,
    pub faces: Vec<abi::Face>,
    pub face_instances: Vec<abi::FaceInstance>,
    pub instances: Vec<abi::Instance>,
    /// Face instance of each patch instance, cell instance and curve instance.
    pub patch_instances: Vec<u32>,
    pub cell_instances: Vec<u32>,
    pub curve_instances: Vec<u32>,
    /// Number of bins in all strips of all placed faces.
    pub bin_count: u32,
    /// Bin instances of strips with several bins.
    pub wide_strips: Vec<u32>,
    pub cells: Vec<abi::Cell>,
    pub curves: Vec<abi::Curve>,
    pub curve_points: Vec<f32>,
    pub exact: ExactData,
    pub meshes: Meshes,
    /// Some patch has unequal weights.
    pub has_rational: bool,
    /// Some face has several patches, which do not all follow one equation as those of a plane or cylinder do.
    pub has_pieces: bool,
    /// Some patch has a fine net.
    pub has_fine: bool,
    /// Smooth borders may follow some face's surface.
    pub has_followed: bool,
    /// Some patch is drawn without a trim test.
    pub has_plain: bool,
    /// Some patch needs a trim test.
    pub has_trimmed: bool,
    /// The data that edits of loops need, in editable scenes.
    pub edit: Option<EditScene>,
    /// The scene's faces, if the trim test bisects them.
    #[cfg(feature = "baselines")]
    pub bisect: crate::baselines::bisect::Bisect,
    pub division: Division,
    /// Patches are also drawn without a trim test.
    #[cfg(feature = "baselines")]
    pub untested: bool,
    #[cfg(feature = "baselines")]
    pub(super) corners: Option<bool>,
    /// The way to trim that the request names or the model's size suggests.
    pub(super) way: Option<TakenWay>,
    /// Samples of each pixel.
    pub samples: Samples,
    /// The borders that are smoothed.
    pub(super) smooth: Smooth,
    /// Radius of ambient occlusion; `None` without it.
    pub ambient: Option<f64>,
    /// Part (relative to its centre) to model, per instance.
    pub placements: Vec<DAffine3>,
    /// The boxes of each placement's patches.
    pub(super) boxes: PartBoxes,
    /// Whether each placement is hidden; empty if none is.
    pub(super) hidden: Vec<bool>,
    /// Each instance of the model that is drawn as faces alone; empty in a cut of a model.
    pub(super) live: Vec<Option<LivePart>>,
    /// Placed parts cast shadows. Their shadow triangles are fixed when the scene is made.
    pub(super) casts_shadows: bool,
    /// Boxes around all that the table trims; `None` without a table.
    pub trimmed: Option<Trimmed>,
    /// Boolean solids.
    pub solids: SolidData,
    /// The volume that trims faces and meshes; `None` without one, or if it is all of space.
    pub volume: Option<SolidData>,
    /// Some patch is drawn as a surface of its own, not as part of an operand.
    pub has_patches: bool,
    /// Some patch bounds an operand of the Boolean solids.
    pub has_operands: bool,
    /// Something is transparent or highlighted.
    pub is_layered: bool,
    /// Styles may show curvature.
    pub curvature: bool,
    /// The scene measures lengths within solids.
    pub thickness: bool,
    pub highlight: Option<Highlight>,
    /// Largest size of the event lists, in bytes.
    pub solid_budget: Option<u64>,
    /// Instances that are drawn opaque although their colour is transparent, because they are not closed.
    pub open: usize,
    pub sun: Option<SunData>,
    /// Number of things that cast no shadow, in a scene with a sun.
    pub shadowless: usize,
    /// The model's part and instance of each instance, from 1 on; 0 if it is neither.
    pub sources: Vec<[u32; 2]>,
    /// The origin and the first face of each part.
    pub(super) parts: Vec<(DVec3, usize)>,
    /// Lines along edges; `None` without them.
    pub edges: Option<EdgeData>,
    /// Boolean solids that are drawn as meshes; they come last in `meshes`.
    pub(super) isolated: Vec<Mesh>,
    /// The host's images include the numbers of edges, parts and instances.
    pub has_numbers: bool,
}

impl SceneData {
    #[cfg(any(test, feature = "baselines"))]
    pub(crate) fn new(model: &Model, request: impl Into<SceneRequest>) -> Result<Self, UndrawnSolid> {
        Self::telling(model, request.into(), &|_| ())
    }

    /// The arrays of a model. Calls `told` with the number of faces made since the last call.
    pub(crate) fn telling(model: &Model, request: SceneRequest, told: Told<'_>) -> Result<Self, UndrawnSolid> {
        // an edit would change where cuts save tests
        let extent = if request.editable { f64::INFINITY } else { model.control_bounds().diagonal() };
        Ok(Self::of(model, model, (request, told), |_, scale| extent / scale)?.complete())
    }

    /// Of a model that joins a scene of this extent, which may have occlusion culling ([`join`](Self::join)).
    pub(super) fn joining(model: &Model, request: SceneRequest, extent: f64) -> Result<Self, UndrawnSolid> {
        Self::of(model, model, (request, &|_| ()), |_, scale| extent / scale)
    }

    /// With nothing that a scene of these parts alone does not read.
    fn complete(mut self) -> Self {
        if !self.hides() {
            self.outside = Vec::new();
        }
        if self.hides_parts() {
            self.find_drawn_boxes();
        }
        self
    }

    /// The arrays of a cut for a close view. The shadows are those of the whole model.
    pub(crate) fn cut_from(whole: &Model, cut: &Cut, request: impl Into<SceneRequest>) -> Result<Self, UndrawnSolid> {
        let mut data = Self::of(whole, &cut.model, (request.into(), &|_| ()), |part, _| cut.extents[part])?.complete();
        for source in data.sources.iter_mut().filter(|source| source[1] > 0) {
            *source = cut.source_of(source[1] as usize - 1, whole);
        }
        cut.mark_ends(&mut data);
        Ok(data)
    }

    /// The arrays of a model whose patches are not split.
    #[cfg(any(test, feature = "baselines"))]
    pub(crate) fn uncut(model: &Model, settings: SceneSettings) -> Result<Self, UndrawnSolid> {
        Ok(Self::of(model, model, (settings.into(), &|_| ()), |_, _| f64::INFINITY)?.complete())
    }

    /// `extent` gets a part and the scale of its largest copy, and returns the extent of [`Trimming`].
    fn of(
        whole: &Model,
        model: &Model,
        (settings, told): (SceneRequest, Told<'_>),
        extent: impl Fn(usize, f64) -> f64,
    ) -> Result<Self, UndrawnSolid> {
        let way = taken(model, settings);
        let trim = Trimming {
            way,
            smooth: settings.smooth == Smooth::Trims,
            editable: settings.editable,
            extent: f64::INFINITY,
        };
        let edits = settings.editable && matches!(way, TakenWay::Table | TakenWay::Exact);
        let edit = edits.then(EditScene::default);
        let all = settings.thickness || settings.highlight.is_some();
        let items = (all || !model.is_opaque()).then(|| model.items(all)).transpose()?;
        let is_whole = std::ptr::eq(whole, model);
        let is_drawn = |nth: &usize| items.as_ref().is_none_or(|items| items.drawn[*nth]);
        let drawn: Vec<usize> = (0..model.instances.len()).filter(is_drawn).collect();
        let model = &*drawn_as_faces(model, items.as_ref());
        let open = items.as_ref().map_or(0, |items| items.open);
        let clear = items.as_ref().is_some_and(|items| !items.clear.is_empty());
        let seen_through = items.as_ref().map_or(0, |items| items.clear.len());
        // Only the nearest face can be drawn without the solids; everything else needs all of them.
        let nearest = items.is_none() && settings.sun.is_none() && model.trim.is_none();
        let isolated = nearest.then(|| Isolated::of(&model.solids, model.coincidence())).transpose()?.flatten();
        let union = isolated.as_ref().map_or(&model.solids, |isolated| &isolated.rest);
        let lists = items.map_or_else(|| Lists::union(union), |items| Lists::of(items, all));
        let mut solids = SolidData::new(&lists, model.coincidence(), settings.solids)?;
        solids.mark_cuts(&whole.cuts);
        // a part that a volume cuts open casts no shadow: the shadow would be that of the uncut part
        let is_cut = model.trim.is_some();
        let sun = settings.sun.map(|towards| match is_whole {
            _ if is_cut => Ok(SunData::new(towards, &solids, None)),
            true => Ok(SunData::new(towards, &solids, Some(model))),
            false => {
                let items = (!whole.is_opaque()).then(|| whole.items(all)).transpose()?;
                Ok(SunData::new(towards, &solids, Some(&drawn_as_faces(whole, items.as_ref()))))
            }
        });
        let sun = sun.transpose().map_err(|e: SolidError| UndrawnSolid::from(e))?;
        let cut = if is_cut { model.instances.len() } else { 0 };
        let shadowless = sun.as_ref().map_or(0, |sun| sun.left_out + cut + seen_through);
        let volume = model
            .trim
            .as_ref()
            .map(|volume| SolidData::volume(volume, model.coincidence(), way))
            .transpose()?
            .flatten();
        let mut data = Self {
            is_layered: (clear || settings.highlight.is_some()) && solids.is_followed(),
            curvature: settings.curvature,
            thickness: settings.thickness,
            highlight: settings.highlight,
            solid_budget: settings.solid_budget,
            open,
            sun,
            shadowless,
            solids,
            volume,
            way: Some(way),
            samples: settings.samples,
            smooth: settings.smooth,
            ambient: settings.ambient,
            edit,
            ..Self::default()
        };
        #[cfg(feature = "baselines")]
        {
            (data.untested, data.corners) = (settings.baseline.untested, settings.baseline.corners);
            if let Some(segments) = settings.baseline.slefe_segments {
                data.division = Division::Slefe(crate::baselines::slefe::words(segments));
            }
        }
        // a part that is cut open shows its back faces
        let open = data.volume.is_some();
        // the largest scale of each placed part's copies
        let mut scales: Vec<Option<f64>> = vec![None; model.parts.len()];
        for i in &model.instances {
            let largest = scales[i.part].unwrap_or(0.0);
            scales[i.part] = Some(largest.max(stretch(i.transform.matrix3)));
        }
        let mut first_faces = Vec::with_capacity(model.parts.len());
        let mut origins = Vec::with_capacity(model.parts.len());
        let mut placed = Vec::with_capacity(model.parts.len());
        let bounds: Vec<Bounds> = model.parts.par_iter().map(Part::control_bounds).collect();
        for (nth, ((part, bounds), scale)) in model.parts.iter().zip(&bounds).zip(scales).enumerate() {
            let origin = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
            origins.push(origin);
            let Some(scale) = scale else { continue };
            let body = match part.closed && !open {
                false => Body::Open,
                true if part.faces.iter().all(|f| f.loops.is_empty()) => Body::Seamless,
                true => Body::Closed,
            };
            // The border of an open shell hides a surface behind it that bends away by less than the triangles'
            // deviation. Sub-patches have other triangles and may show that surface.
            let extent = if body == Body::Open { f64::INFINITY } else { extent(nth, scale) };
            let trim = Trimming { extent, ..trim };
            placed.push(PlacedPart { number: nth, part, origin, body, trim, cuts: Cuts::of(&part.faces) });
        }
        each_made(&placed, told, |placed, faces| {
            let (nth, first) = (placed.number, data.faces.len());
            first_faces.resize(nth + 1, first);
            let normals: Vec<Normals> = faces.iter().flat_map(|f| &f.normals).copied().collect();
            faces.into_iter().for_each(|f| data.push_face(f));
            if data.link(first) {
                data.push_cones(first, &normals, 0.5 * bounds[nth].diagonal());
            }
            #[cfg(feature = "baselines")]
            if let TakenWay::Baseline(crate::baselines::TrimMethod::Bisect { steps, sorted }) = way {
                placed.part.faces.iter().for_each(|f| data.bisect.push(f, steps, sorted));
            }
        });
        first_faces.resize(model.parts.len(), data.faces.len());
        data.casts_shadows = data.sun.is_some() && !is_cut;
        data.live = vec![None; if is_whole { whole.instances.len() } else { 0 }];
        for (instance, nth) in model.instances.iter().zip(drawn) {
            data.sources.push([instance.part as u32 + 1, nth as u32 + 1]);
            let part = &model.parts[instance.part];
            let (origin, first) = (origins[instance.part], first_faces[instance.part]);
            if is_whole && !(all && part.closed && !is_cut) {
                data.live[nth] = Some(LivePart { number: data.instances.len() as u32, origin });
            }
            data.push_instance(instance, origin, first..first + part.faces.len(), 0);
        }
        data.parts = origins.iter().copied().zip(first_faces.iter().copied()).collect();
        if let Some(edit) = &mut data.edit {
            edit.first_faces = first_faces;
        }
        data.meshes = Meshes::new(model, &origins, open);
        for mesh in isolated.iter().flat_map(|isolated| &isolated.meshes) {
            let origin = mesh.bounds().centre();
            let instance = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
            data.push_instance(&instance, origin, 0..0, 0);
            data.meshes.push_outward(mesh, origin, data.instances.len() as u32 - 1);
        }
        if data.smooths_borders() {
            data.meshes.find_neighbours();
        }
        data.isolated = isolated.map_or_else(Vec::new, |isolated| isolated.meshes);
        data.push_operands(trim);
        if !data.links.is_empty() {
            data.links.resize(4 * data.patches.len(), abi::Link::default());
        }
        if data.cones.iter().all(|cone| *cone == [0.0; 4]) {
            data.cones = Vec::new();
        } else {
            data.cones.resize(data.patches.len(), [0.0; 4]);
        }
        data.sources.resize(data.instances.len(), [0; 2]);
        data.trimmed = Trimmed::by_table(&data);
        data.boxes = PartBoxes::of(&data);
        Ok(data)
    }

    /// Links the sides at which the faces from `first_face` on meet. Returns whether all sides of untrimmed faces are
    /// linked.
    fn link(&mut self, first_face: usize) -> bool {
        link(&self.faces, first_face..self.faces.len(), &self.patches, &mut self.points, &mut self.links)
    }

    /// Adds the cones of the faces from `first_face` on, a part within `radius` of its origin.
    fn push_cones(&mut self, first_face: usize, normals: &[Normals], radius: f64) {
        if !normals.is_empty() {
            let cones = cones(&self.faces[first_face..], &self.links, normals, radius);
            self.cones.resize(self.patches.len() - cones.len(), [0.0; 4]);
            self.cones.extend(cones);
        }
    }

    /// How faces are trimmed; `None` when no patch is.
    pub(crate) fn trim_way(&self) -> Option<TakenWay> {
        self.way.filter(|_| self.has_trimmed)
    }

    /// The scene has occlusion culling: enough patches, one sample a pixel, and patches other than those of operands,
    /// which rays cross whether or not they are hidden.
    pub(crate) fn hides(&self) -> bool {
        self.hides_with(0)
    }

    /// The same with so many more patch instances.
    pub(super) fn hides_with(&self, more: usize) -> bool {
        self.patch_instances.len() + more >= FEWEST_HIDDEN && !self.has_operands && self.samples == Samples::One
    }

    /// Some mesh is placed.
    pub(crate) fn has_meshes(&self) -> bool {
        !self.meshes.draws.is_empty()
    }

    /// Patches or meshes are drawn as surfaces of their own.
    pub(crate) fn has_surfaces(&self) -> bool {
        self.has_patches || self.has_meshes()
    }

    /// Places the operands of Boolean solids without equations like parts, after the parts.
    fn push_operands(&mut self, trim: Trimming) {
        let mut operands = std::mem::take(&mut self.solids.operands);
        for operand in &mut operands {
            let first = self.faces.len();
            let cuts = Cuts::of(operand.faces());
            for face in operand.faces() {
                let mut f =
                    FaceData::new(face, operand.origin, Body::Closed, Trimming { editable: false, ..trim }, cuts);
                f.face.flags |= abi::FACE_OPERAND;
                f.face.id = operand.primitive.id;
                if face.colour.is_none() {
                    f.face.colour = pack_colour(operand.primitive.colour);
                }
                self.push_face(f);
            }
            self.link(first);
            let faces = first..self.faces.len();
            self.has_operands |= !faces.is_empty();
            let transform = operand.primitive.transform;
            let instance = Instance { part: 0, transform, colour: None, name: String::new() };
            let number = self.instances.len() as u32;
            operand.placed = Some((number, first));
            self.push_instance(&instance, operand.origin, faces, operand.number);
            for mesh in operand.meshes.clone() {
                self.solids.operand_meshes[mesh].instance = number;
            }
        }
        self.solids.operands = operands;
    }

    fn push_face(&mut self, mut f: FaceData) {
        let (face, point, curve_point) =
            (self.faces.len() as u32, self.points.len() as u32, self.curve_points.len() as u32);
        f.face.first_patch = self.patches.len() as u32;
        f.face.first_cell = self.cells.len() as u32;
        f.face.first_curve = self.curves.len() as u32;
        for p in &mut f.patches {
            p.face = face;
            p.first += point;
            match p.side() {
                abi::Side::Inside => self.has_plain = true,
                abi::Side::Boundary => self.has_trimmed = true,
                abi::Side::Outside => {}
            }
        }
        f.curves.iter_mut().for_each(|c| c.first += curve_point);
        if self.way == Some(TakenWay::Exact) {
            let place = self.exact.push(&f.exact, f.edit.is_some());
            if let Some(face) = &mut f.edit {
                face.exact = Some((place, ExactData::of(&f.exact, &place)));
            }
        }
        if let Some(scene) = &mut self.edit {
            if let Some(face) = &mut f.edit {
                (face.first_patch, face.first_cell) = (f.face.first_patch, f.face.first_cell);
                for l in &mut face.loops {
                    l.first_curve += f.face.first_curve;
                    l.first_point += curve_point;
                }
                // an edit may remove every loop from a patch
                self.has_plain = true;
            }
            scene.faces.push(f.edit.take());
        }
        self.has_rational |= f.rational;
        self.has_pieces |= f.pieces;
        self.has_fine |= f.fine;
        let is_surface = f.face.flags & abi::FACE_OPERAND == 0;
        self.has_followed |= f.followed && is_surface;
        self.has_patches |= is_surface;
        self.faces.push(f.face);
        self.patches.append(&mut f.patches);
        self.outside.append(&mut f.outside);
        self.points.append(&mut f.points);
        self.cells.append(&mut f.cells);
        self.curves.append(&mut f.curves);
        self.curve_points.append(&mut f.curve_points);
    }

    fn push_instance(&mut self, i: &Instance, origin: DVec3, faces: Range<usize>, operand: u32) {
        self.instances.push(placed_part(i.transform, Shown::default().over(i.colour), operand));
        self.placements.push(i.transform * DAffine3::from_translation(origin));
        let instance = self.instances.len() as u32 - 1;
        for face in faces {
            let (f, next) = (&self.faces[face], self.faces.get(face + 1));
            let end = |of: fn(&abi::Face) -> u32, all: usize| next.map_or(all as u32, of);
            let placed = self.face_instances.len() as u32;
            let cells = end(|n| n.first_cell, self.cells.len()) - f.first_cell;
            let curves = end(|n| n.first_curve, self.curves.len()) - f.first_curve;
            self.face_instances.push(abi::FaceInstance {
                face: face as u32,
                instance,
                first_patch_instance: self.patch_instances.len() as u32,
                first_bin: self.bin_count,
                first_cell: self.cell_instances.len() as u32,
                first_curve: self.curve_instances.len() as u32,
                ..abi::FaceInstance::default()
            });
            let (strips, bins) = (f.strip_count(), f.bin_count());
            if bins > 1 {
                self.wide_strips.extend((0..strips).map(|strip| self.bin_count + strip * bins));
            }
            self.bin_count += strips * bins;
            let repeat = |list: &mut Vec<u32>, n: u32| list.extend(std::iter::repeat_n(placed, n as usize));
            repeat(&mut self.patch_instances, f.count_u * f.count_v);
            repeat(&mut self.cell_instances, cells);
            repeat(&mut self.curve_instances, curves);
        }
    }
}
