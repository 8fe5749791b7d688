//! The stages that a scene needs: passes, made with the scene, and buffers, made for pictures of one size.

use super::antialiasing::coverage::Coverage;
use super::antialiasing::samples::{self, MoreSamples};
use super::antialiasing::smooth_borders::{self, SmoothBorders};
use super::antialiasing::smooth_trims::{self, SmoothTrims};
use super::capacities::Capacities;
use super::common::room::Room;
use super::common::{self, Common};
use super::counts::Counts;
use super::edges::{self, EdgeStage};
use super::gaps::gap_fill::GapFill;
use super::gaps::{self, Gaps};
use super::occlusion::{self, Occlusion};
use super::shading::contact::{self, Contact};
use super::shading::linear::{self, Linear};
use super::shading::{self, Shading, resolve};
use super::solids::{self, Solids};
use super::tessellation::{self, Tessellation};
use super::transparency::{self, Transparency};
use super::trim::{self, Trim};
use super::visibility::{self, Visibility};
use crate::gpu::{Device, GpuError, Image};
use crate::scene::SceneData;
use std::sync::Arc;

/// The passes of the stages that a scene needs. They stay while the picture's size changes.
pub(crate) struct Passes {
    common: Arc<common::Passes>,
    tessellation: Option<Arc<tessellation::Passes>>,
    occlusion: Option<Arc<occlusion::Passes>>,
    trim: Option<trim::Passes>,
    gaps: Option<Arc<GapFill>>,
    solids: Option<solids::Passes>,
    visibility: Arc<visibility::Passes>,
    shading: Arc<shading::Passes>,
    samples: Option<Arc<samples::Passes>>,
    transparency: Option<Arc<transparency::Passes>>,
    linear: Option<Arc<linear::Passes>>,
    contact: Option<Arc<contact::Passes>>,
    smooth_trims: Option<Arc<Coverage>>,
    smooth_borders: Option<Arc<smooth_borders::Passes>>,
    edges: Option<Arc<edges::Passes>>,
}

impl Passes {
    pub(crate) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Self, GpuError> {
        let trim = trim::Passes::new(device, data)?;
        let test = trim.as_ref().map(trim::Passes::test);
        // a driver takes milliseconds for each pipeline and makes them on several threads at once
        let pictures = || {
            let shading = shading::Passes::new(device, data, formats)?;
            let samples = samples::Passes::new(device, data, formats)?;
            let linear = linear::Passes::new(device, data, formats)?;
            let contact = contact::Passes::new(device, data)?;
            Ok::<_, GpuError>((shading, samples, (linear, contact), common::Passes::new(device, data)?))
        };
        let patches = || {
            let tessellation = tessellation::Passes::new(device, data)?;
            let occlusion = occlusion::Passes::new(device, data)?;
            Ok::<_, GpuError>((tessellation, occlusion, visibility::Passes::new(device, data, test)?))
        };
        let gaps = || test.map(|test| gaps::passes(device, data, test)).transpose();
        let over = || {
            let transparency = transparency::Passes::new(device, data, formats)?;
            let smooth_trims = smooth_trims::pass(device, data, formats)?;
            let smooth_borders = smooth_borders::Passes::new(device, data, test)?;
            let edges = edges::Passes::new(device, data, formats, test)?;
            Ok::<_, GpuError>((transparency, smooth_trims, smooth_borders, edges))
        };
        let ((gaps, over), (solids, (patches, pictures))) = rayon::join(
            || rayon::join(gaps, over),
            || rayon::join(|| solids::Passes::new(device, data, test), || rayon::join(patches, pictures)),
        );
        let ((tessellation, occlusion, visibility), pictures) = (patches?, pictures?);
        let (shading, samples, (linear, contact), common) = pictures;
        let (transparency, smooth_trims, smooth_borders, edges) = over?;
        Ok(Self {
            common: Arc::new(common),
            tessellation: tessellation.map(Arc::new),
            occlusion: occlusion.map(Arc::new),
            gaps: gaps?.map(Arc::new),
            trim,
            solids: solids?,
            visibility: Arc::new(visibility),
            shading: Arc::new(shading),
            samples: samples.map(Arc::new),
            transparency: transparency.map(Arc::new),
            smooth_trims: smooth_trims.map(Arc::new),
            smooth_borders: smooth_borders.map(Arc::new),
            linear: linear.map(Arc::new),
            contact: contact.map(Arc::new),
            edges: edges.map(Arc::new),
        })
    }
}

/// The stages of a frame that the scene needs, for pictures of one size.
pub(crate) struct Stages {
    /// What they were made for.
    counts: Counts,
    capacities: Capacities,
    size: (u32, u32),
    pub(super) common: Common,
    pub(super) tessellation: Tessellation,
    pub(super) occlusion: Option<Occlusion>,
    pub(super) trim: Option<Trim>,
    pub(super) gaps: Option<Gaps>,
    pub(super) solids: Option<Solids>,
    pub(super) visibility: Visibility,
    pub(super) shading: Shading,
    pub(super) transparency: Option<Transparency>,
    pub(super) samples: Option<MoreSamples>,
    pub(super) linear: Option<Linear>,
    pub(super) contact: Option<Contact>,
    pub(super) smooth_trims: Option<SmoothTrims>,
    pub(super) smooth_borders: Option<SmoothBorders>,
    /// Once a frame draws lines.
    pub(super) edges: Option<EdgeStage>,
}

impl Stages {
    pub(crate) fn new(
        device: &Device,
        passes: &Passes,
        counts: Counts,
        capacities: Capacities,
        size: (u32, u32),
    ) -> Result<Self, GpuError> {
        let room = &Room { device, counts, capacities, size };
        let (trimmed, edges) = ([counts.bins, counts.curves, capacities.trim.rows], counts.piece_instances);
        let scanned = [counts.patch_lists() * counts.patch_instances + 1, counts.face_instances, edges]
            .into_iter()
            .chain(trimmed);
        let scanned = scanned.fold(solids::buffers::scanned(room), u32::max);
        let p = passes;
        Ok(Self {
            counts,
            capacities,
            size,
            common: Common::new(room, &p.common, scanned)?,
            tessellation: Tessellation::new(room, p.tessellation.as_ref())?,
            occlusion: p.occlusion.as_ref().map(|p| Occlusion::new(room, p)).transpose()?,
            trim: p.trim.as_ref().map(|p| Trim::new(room, p)).transpose()?,
            gaps: p.gaps.as_ref().map(|p| Gaps::new(room, p)).transpose()?,
            solids: p.solids.as_ref().map(|p| Solids::new(room, p)).transpose()?,
            visibility: Visibility::new(room, &p.visibility)?,
            shading: Shading::new(room, &p.shading)?,
            transparency: p.transparency.as_ref().map(|p| Transparency::new(room, p)).transpose()?,
            samples: p.samples.as_ref().map(|p| MoreSamples::new(room, p)).transpose()?,
            linear: p.linear.as_ref().map(|p| Linear::new(room, p)).transpose()?,
            contact: p.contact.as_ref().map(|p| Contact::new(room, p)).transpose()?,
            smooth_trims: p.smooth_trims.as_ref().map(SmoothTrims::new),
            smooth_borders: p.smooth_borders.as_ref().map(|p| SmoothBorders::new(room, p)).transpose()?,
            edges: None,
        })
    }

    /// Makes the stage of lines, where the scene has one, for the first frame that draws them.
    pub(crate) fn make_lines(&mut self, device: &Device, passes: &Passes) -> Result<(), GpuError> {
        let room = Room { device, counts: self.counts, capacities: self.capacities, size: self.size };
        if let (Some(passes), None) = (&passes.edges, &self.edges) {
            self.edges = Some(EdgeStage::new(&room, passes)?);
        }
        Ok(())
    }

    /// They suffice for a scene with so much, and for a picture of this size.
    pub(crate) fn suffice(&self, counts: Counts, capacities: Capacities, size: (u32, u32)) -> bool {
        self.size == size && counts.fits(self.counts) && self.capacities.takes_as_much(capacities)
    }

    /// Linear colour and depth, if a later pass mixes the colour from them.
    pub(super) fn unmixed(&self) -> Option<&Image> {
        self.linear.as_ref().map(|linear| &linear.resolved)
    }

    /// Size of the picture.
    pub(crate) fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The spare image in place of the host's image of this number, which passes must draw together with others: depth,
    /// face, (u, v), normal, edge, part, instance.
    pub(crate) fn spare(&self, number: usize) -> Option<&Image> {
        self.shading.spare(number)
    }

    /// Boolean solids, if the scene has any.
    pub(crate) fn solids(&self) -> Option<&Solids> {
        self.solids.as_ref()
    }
}
