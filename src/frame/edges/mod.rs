//! Lines along edges: their curves divided for the view, then drawn over the picture where they are seen.
//!
//! ```text
//!   edge_count ─(scan)─▶ edge_emit ──▶ chords, with the patches' tessellation
//!                                        │ line_list, fold_list: what to look at, and where
//!                                        ▼
//!   visibility, patches, meshes ──▶ edge_line ──▶ each pixel's best line ──edge_show──▶ the host's colour, edges' numbers
//!                                   edge_fold ──▶          outlines
//!   Boolean solids ──▶ edge_change, edge_join ──▶          where what is seen of them changes
//! ```
//!
//! Chords stay while the view does. docs/design/edges.md has the method.

mod capacities;
pub(crate) mod change;
pub(crate) mod divide;
pub(crate) mod fold;
pub(crate) mod join;
pub(crate) mod line;
pub(crate) mod list;
pub(crate) mod show;
mod solid_lines;

pub(crate) use capacities::Capacities;

use super::common::later::Later;
use super::common::line_items::LineItems;
use super::common::room::{COUNTED, Room};
use super::shading::numbers::NUMBER_FORMAT;
use super::shading::resolve;
use super::{Frame, WRITE_TO_READ};
use crate::abi::Chord;
use crate::bindings::{Placed, SeenSolids};
use crate::gpu::{Access, Attachment, Buffer, Commands, Device, GpuError, Image, Load, barrier};
use crate::picture::EdgeSettings;
use crate::scene::{SceneData, SolidData};
use crate::shaders::{TrimTest, constant};
use ash::vk;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread;

/// The passes of scenes with lines.
pub(crate) struct Passes {
    settings: EdgeSettings,
    /// The host wants their numbers.
    has_edge_image: bool,
    divide: divide::Divide,
    list: list::OfChords,
    /// The largest pipelines of all.
    follow: Later<FollowPasses>,
    /// Where there are Boolean solids.
    solids: Option<solid_lines::Passes>,
    show: show::Show,
}

/// Those that follow surfaces.
struct FollowPasses {
    /// Where outlines of curved faces are wanted.
    seeds: Option<list::SeedsOfChords>,
    line: line::Line,
    /// Where outlines of curved faces are wanted, and there are patches.
    fold: Option<(list::OfPixels, fold::Fold)>,
}

impl Passes {
    /// `None` where no line is drawn.
    pub(super) fn new(
        device: &Device,
        data: &SceneData,
        formats: resolve::Formats,
        test: Option<&TrimTest>,
    ) -> Result<Option<Self>, GpuError> {
        let Some(edges) = data.edges.as_ref().filter(|_| data.has_lines()) else { return Ok(None) };
        let folds = edges.settings.silhouettes;
        let numbers = formats.numbers[0].then_some(NUMBER_FORMAT);
        Ok(Some(Self {
            settings: edges.settings,
            has_edge_image: formats.numbers[0],
            divide: divide::Divide::new(device)?,
            list: list::OfChords::new(device, folds)?,
            follow: FollowPasses::later(device, data, test.copied(), folds),
            solids: solid_lines::Passes::new(device, data, &edges.settings)?,
            show: show::Show::new(device, data, (formats.colour, numbers))?,
        }))
    }
}

impl FollowPasses {
    /// `test`: how faces are trimmed; `None` where none is. `folds`: outlines of curved faces are wanted.
    fn later(device: &Device, data: &SceneData, test: Option<TrimTest>, folds: bool) -> Later<Self> {
        let (device, constants) = (device.clone(), constants(data));
        let volume = data.volume.as_ref().and_then(SolidData::kinds);
        let has_folds = folds && (data.has_patches || data.has_operands);
        Later::begin(move || {
            let (device, constants, test) = (&device, &constants, test.as_ref());
            let of_faces = || {
                let list = list::OfPixels::new(device, constants)?;
                Ok::<_, GpuError>((list, fold::Fold::new(device, constants, test)?))
            };
            // threads of their own: those of a pool may all wait for this one
            thread::scope(|scope| {
                let fold = has_folds.then(|| scope.spawn(of_faces));
                let seeds = folds.then(|| list::SeedsOfChords::new(device, constants)).transpose();
                let line = line::Line::new(device, constants, &line::Kinds { test, volume }, folds);
                let fold = fold.map(|fold| fold.join().unwrap_or_else(|panic| resume_unwind(panic))).transpose();
                Ok(Self { seeds: seeds?, line: line?, fold: fold? })
            })
        })
    }
}

/// What passes that follow surfaces are told of the scene.
fn constants(data: &SceneData) -> [(u32, u32); 6] {
    let meshes_and_solids = data.has_meshes() || data.solids.kinds().is_some();
    [
        (constant::SCENE_HAS_RATIONAL, u32::from(data.has_rational)),
        (constant::SCENE_HAS_FINE, u32::from(data.has_fine)),
        (constant::SCENE_HAS_MESHES, u32::from(data.has_meshes())),
        (constant::SCENE_HAS_MESHES_OR_SOLIDS, u32::from(meshes_and_solids)),
        (constant::SCENE_HAS_SOLIDS, u32::from(data.solids.kinds().is_some())),
        (constant::SOLIDS_HAVE_PATCHES, u32::from(data.has_operands)),
    ]
}

/// The stage.
pub(crate) struct EdgeStage {
    passes: Arc<Passes>,
    follow: Arc<FollowPasses>,
    /// How wide lines are, half of it: full ones, thin ones and bold ones.
    half_px: [f32; 3],
    counts: Buffer,
    starts: Buffer,
    chords: Buffer,
    draw: Buffer,
    /// Beside which of them folds may be.
    chord_seeds: Buffer,
    /// Pixels that lines cover, and those beside which folds are looked for: from edges, and from pixels around.
    points: LineItems,
    seeds: LineItems,
    fold_starts: LineItems,
    /// Each pixel's best line.
    best: Image,
    /// Of lines of Boolean solids; where there are some.
    solids: Option<solid_lines::Images>,
}

/// What passes that ask whether a point is seen read of Boolean solids.
fn seen_solids<'a>(parts: Option<&resolve::SolidBindings<'a>>, placed: &Placed<'a>, best: &'a Image) -> SeenSolids<'a> {
    // other things stand in for it in scenes without
    let boundary_operands = parts.and_then(|parts| parts.boundary_operands.as_ref());
    let faces: &Buffer = placed.faces;
    SeenSolids {
        operand_uv: parts.and_then(|parts| parts.operand_uv).unwrap_or(best),
        leaf_surfaces: parts.map_or(placed.patch_instances, |parts| parts.primitives.leaf_surfaces),
        surface_places: parts.map_or(placed.points, |parts| parts.primitives.surface_places),
        meshes: boundary_operands.map_or([faces; 3], |m| [m.meshes, m.triangles, m.positions]),
    }
}

/// Format of the image of each pixel's best line.
const BEST_FORMAT: vk::Format = vk::Format::R32_UINT;
/// Beyond the picture, lines are this much wider: for the pixels' own size, and what chords and rounding are off.
const BESIDE_PX: f32 = 2.0;

impl EdgeStage {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let piece_instances = room.counts.piece_instances;
        let half = 0.5 * f64::from(room.size.1) / EdgeSettings::HEIGHT;
        let settings = passes.settings;
        Ok(Self {
            passes: Arc::clone(passes),
            follow: passes.follow.get()?,
            half_px: [settings.width, settings.thin_width, settings.section_width].map(|width| (half * width) as f32),
            counts: room.words("edge chord counts", piece_instances)?,
            starts: room.words("edge chord starts", piece_instances + 1)?,
            chords: room.structs::<Chord>("edge chords", room.capacities.edges.chords)?,
            draw: room.indirect::<u32>("edge draw", divide::DRAW_WORDS)?,
            chord_seeds: room.words("edge chord seeds", room.capacities.edges.chords)?,
            points: LineItems::new(room, "line points", room.capacities.edges.points, false)?,
            seeds: LineItems::new(room, "line seeds", room.capacities.edges.seeds, true)?,
            fold_starts: LineItems::new(room, "fold starts", room.capacities.edges.starts, true)?,
            best: room.image("best lines", BEST_FORMAT, COUNTED)?,
            solids: passes.solids.as_ref().map(|solids| solid_lines::Images::new(room, solids)).transpose()?,
        })
    }

    /// Pieces of edges into chords.
    pub(super) fn divide(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let Some(edges) = &frame.scene.edges else { return };
        let (w, r) = WRITE_TO_READ;
        let bindings = divide::Bindings {
            frame: frame.constants,
            views: frame.views,
            piece_instances: &edges.piece_instances,
            pieces: &edges.pieces,
            points: &edges.points,
            counts: &self.counts,
            starts: &self.starts,
            counters: &frame.stages.common.counters,
            lines: &edges.lines,
            chords: &self.chords,
            draw: &self.draw,
        };
        let margin_px = self.half_px.into_iter().fold(0.0, f32::max) + BESIDE_PX;
        let params = divide::Params { instance_count: frame.counts.piece_instances, margin_px };
        let divide = &self.passes.divide;
        divide.count(cmd, &bindings, params);
        frame.stages.common.scan(cmd, &self.counts, &self.starts, frame.counts.piece_instances);
        cmd.after(w, r | w);
        divide.emit(cmd, &bindings, params, frame.capacities.edges.chords);
        if let Some(seeds) = &self.follow.seeds {
            cmd.after(w, r);
            let (chords, draw, chord_seeds) = (&self.chords, &self.draw, &self.chord_seeds);
            let placed = frame.scene.placed(frame.views);
            let bindings = list::SeedBindings { frame: frame.constants, placed, chords, edges, draw, chord_seeds };
            seeds.record(cmd, &bindings, frame.capacities.edges.chords);
            barrier::buffers(cmd, &[(chord_seeds, w, Access::FRAGMENT_READ)]);
        }
        let drawn = Access::VERTEX_READ | Access::FRAGMENT_READ | Access::COMPUTE_READ;
        let read = Access::VERTEX_READ | Access::INDIRECT_READ;
        barrier::buffers(cmd, &[(&self.chords, w, drawn), (&self.draw, w, read)]);
        cmd.after(w, w | Access::INDIRECT_READ);
    }

    /// Makes the lists of what to look at, and where, before the counters are read back.
    pub(super) fn list(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (s, v, passes) = (frame.scene, &frame.stages.visibility, &self.passes);
        let (w, r) = WRITE_TO_READ;
        let counters = &frame.stages.common.counters;
        let lists = [&self.points, &self.seeds, &self.fold_starts];
        let (read, cleared) = (r | w | Access::INDIRECT_READ, Access::TRANSFER_WRITE);
        let written = w | Access::FRAGMENT_WRITE;
        barrier::buffers(cmd, &lists.map(|list| (&list.buffer, read, cleared)));
        lists.iter().for_each(|list| list.clear(cmd));
        barrier::buffers(cmd, &lists.map(|list| (&list.buffer, cleared, written)));
        barrier::buffers(cmd, &[(counters, w | Access::INDIRECT_READ, written)]);
        if let Some(edges) = &s.edges {
            let bindings = list::ChordBindings {
                frame: frame.constants,
                edges,
                chords: &self.chords,
                points: &self.points,
                seeds: &self.seeds,
                counters,
                chord_seeds: &self.chord_seeds,
                draw: &self.draw,
            };
            passes.list.record(cmd, &bindings, v.image.size(), self.half_px);
        }
        if let Some((list, _)) = &self.follow.fold {
            // the image of best lines stands in for that of operands
            barrier::images(cmd, &[(&self.best, (Access::FRAGMENT_READ | r).discarded(), r)]);
            let placed = s.placed(frame.views);
            let parts = frame.solids().map(|solids| solids.resolve(frame));
            let bindings = list::PixelBindings {
                frame: frame.constants,
                placed,
                visibility: &v.image,
                meshes_and_solids: v.of_meshes_and_solids(),
                operand_uv: seen_solids(parts.as_ref(), &placed, &self.best).operand_uv,
                starts: &self.fold_starts,
                counters,
            };
            list.record(cmd, &bindings);
        }
        barrier::buffers(cmd, &lists.map(|list| (&list.buffer, written, read)));
        barrier::buffers(cmd, &[(counters, written, w)]);
    }

    /// Lines over the host's colour, which is whole, and their numbers.
    pub(super) fn draw(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (s, v, passes) = (frame.scene, &frame.stages.visibility, &self.passes);
        let (written, read) = (Access::FRAGMENT_WRITE, Access::FRAGMENT_READ);
        let (w, r) = WRITE_TO_READ;
        let parts = frame.solids().map(|solids| solids.resolve(frame));
        let solids = seen_solids(parts.as_ref(), &s.placed(frame.views), &self.best);
        barrier::images(cmd, &[(&self.best, (read | r).discarded(), Access::TRANSFER_WRITE)]);
        cmd.clear(&self.best, 0);
        barrier::images(cmd, &[(&self.best, Access::TRANSFER_WRITE, w)]);
        let trim = frame.trim_test();
        let found = |list: &LineItems| {
            barrier::buffers(cmd, &[(&list.buffer, w, r | w | Access::INDIRECT_READ)]);
            barrier::images(cmd, &[(&self.best, w, w)]);
        };
        if let (Some(edges), Some(sources)) = (&s.edges, &s.sources) {
            let bindings = line::Bindings {
                frame: frame.constants,
                placed: s.placed(frame.views),
                visibility: &v.image,
                meshes_and_solids: v.of_meshes_and_solids(),
                sources,
                chords: &self.chords,
                edges,
                best: &self.best,
                meshes: s.meshes.as_ref(),
                points: &self.points,
                seeds: &self.seeds,
                trim: &trim,
                volume: frame.volume(),
                solids,
            };
            let params = line::Params { half_px: self.half_px, hidden: u32::from(passes.settings.hidden) };
            self.follow.line.record(cmd, &bindings, params, || found(&self.seeds));
        }
        if let Some((_, fold)) = &self.follow.fold {
            let bindings = fold::Bindings {
                frame: frame.constants,
                placed: s.placed(frame.views),
                visibility: &v.image,
                meshes_and_solids: v.of_meshes_and_solids(),
                best: &self.best,
                meshes: s.meshes.as_ref(),
                solids,
                starts: &self.fold_starts,
                trim: &trim,
            };
            barrier::images(cmd, &[(&self.best, w, w)]);
            fold.record(cmd, &bindings, self.half_px[0], || found(&self.fold_starts));
        }
        barrier::images(cmd, &[(&self.best, w, written)]);
        if let (Some(solids), Some(images)) = (&passes.solids, &self.solids) {
            solids.draw(frame, cmd, (images, &self.best), self.half_px);
        }
        barrier::images(cmd, &[(&self.best, written, read)]);
        let stays = !matches!(frame.colour[0].load, Load::Discard); // the host's picture
        let bindings = show::Bindings {
            frame: frame.constants,
            best: &self.best,
            chords: &self.chords,
            edges: s.edges.as_ref(),
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
            resolved: frame.stages.unmixed().filter(|_| !stays),
        };
        let colours = show::Colours { seen: passes.settings.colour, hidden: passes.settings.hidden_colour };
        let numbers = frame.numbers.iter().filter(|_| passes.has_edge_image);
        let into: Vec<_> = frame.colour.iter().take(1).chain(numbers.flat_map(|n| n.first())).collect();
        let again = into.iter().map(|a| (a.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE));
        barrier::images(cmd, &again.collect::<Vec<_>>());
        let into: Vec<_> = into.into_iter().map(|a| Attachment { load: Load::Keep, ..*a }).collect();
        passes.show.record(cmd, &bindings, colours, &into);
    }
}
