//! The ways to trim, as the frame sees them.
//!
//! ```text
//!   way      scene buffers   buffers of the frame   passes before the draw     what the test reads
//!   table    TableScene      TableBuffers           table.rs: density … sort   TableParts::test
//!   exact    ExactScene      none                   none                       its buffers
//! ```
//!
//! A scene uses one way; the others' passes, pipelines and buffers do not exist. Whatever the way, its
//! test is compiled into the passes `visibility` and `heal` ([`TrimTest`](crate::shaders::TrimTest)).

pub(crate) mod carry;
pub(crate) mod cross;
pub(crate) mod density;
mod edit;
pub(crate) mod lines;
pub(crate) mod segments;
pub(crate) mod sizes;
pub(crate) mod sort;
mod table;

use super::Frame;
#[cfg(feature = "baselines")]
use super::baselines::{RivalParts, RivalPasses};
use crate::frame::buffers::TrimBuffers;
use crate::frame::gaps::gap_fill;
use crate::gpu::{Device, GpuError, Resource};
use crate::picture::TakenWay;
use crate::scene::{ExactScene, SceneData, SolidData, Trims};
use crate::shaders::{TRIM_EXACT, TRIM_TABLE, TrimTest};
use table::{TableParts, TablePasses};

/// The passes of the way that the scene uses, and `heal`.
pub(super) struct TrimPasses {
    way: Way,
    pub heal: gap_fill::GapFill,
}

enum Way {
    Table(Box<TablePasses>),
    Exact,
    #[cfg(feature = "baselines")]
    Rival(RivalPasses),
}

impl TrimPasses {
    /// `None` when no patch is trimmed.
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Option<Self>, GpuError> {
        let Some(way) = data.trim_way() else { return Ok(None) };
        let way = match way {
            TakenWay::Table => {
                Way::Table(Box::new(TablePasses::new(device, !data.wide_strips.is_empty(), data.has_operands)?))
            }
            TakenWay::Exact => Way::Exact,
            #[cfg(feature = "baselines")]
            TakenWay::Rival(rival) => Way::Rival(RivalPasses::new(device, rival)?),
        };
        let others = data.has_meshes() || data.solids.kinds().is_some();
        let volume = data.volume.as_ref().and_then(SolidData::kinds);
        let heal = gap_fill::GapFill::new(device, way.test(), (data.has_rational, others), volume)?;
        Ok(Some(Self { way, heal }))
    }

    pub(super) fn test(&self) -> &'static TrimTest {
        self.way.test()
    }
}

impl Way {
    fn test(&self) -> &'static TrimTest {
        match self {
            Self::Table(_) => &TRIM_TABLE,
            Self::Exact => &TRIM_EXACT,
            #[cfg(feature = "baselines")]
            Self::Rival(passes) => passes.test(),
        }
    }
}

/// What trimming works on in one frame.
pub(super) struct TrimParts<'a> {
    pub passes: &'a TrimPasses,
    pub buffers: &'a TrimBuffers,
    way: Parts<'a>,
}

enum Parts<'a> {
    Table(TableParts<'a>),
    Exact(&'a ExactScene),
    #[cfg(feature = "baselines")]
    Rival(RivalParts<'a>),
}

impl<'a> Frame<'a> {
    /// `None` when no patch is trimmed.
    pub(super) fn trim(&self) -> Option<TrimParts<'a>> {
        let passes = self.passes.trim.as_ref()?;
        let (scene, buffers) = (self.scene.trims.as_ref()?, self.buffers.trim.as_ref()?);
        let way = match (&passes.way, scene) {
            (Way::Table(passes), Trims::Table(scene)) => {
                Parts::Table(TableParts { passes, scene, buffers: buffers.table.as_ref()? })
            }
            #[cfg(feature = "baselines")]
            (Way::Rival(passes), Trims::Rival(scene)) => {
                Parts::Rival(RivalParts { passes, scene, buffers: buffers.texture.as_ref() })
            }
            (Way::Exact, Trims::Exact(scene)) => Parts::Exact(scene),
            _ => unreachable!("passes and buffers are made for one way"),
        };
        Some(TrimParts { passes, buffers, way })
    }
}

impl<'a> TrimParts<'a> {
    /// The table's passes, where the scene is trimmed by table.
    pub(super) fn table(&self) -> Option<TableParts<'a>> {
        match self.way {
            Parts::Table(parts) => Some(parts),
            Parts::Exact(_) => None,
            #[cfg(feature = "baselines")]
            Parts::Rival(_) => None,
        }
    }

    /// A way to compare with, where the scene is trimmed so.
    #[cfg(feature = "baselines")]
    pub(super) fn rival(&self) -> Option<RivalParts<'a>> {
        match self.way {
            Parts::Rival(parts) => Some(parts),
            _ => None,
        }
    }

    /// What the trim test reads, in its order.
    pub(super) fn test(&self) -> Vec<Resource<'a>> {
        match self.way {
            Parts::Table(parts) => parts.test(),
            Parts::Exact(s) => s.all().map(Resource::from).to_vec(),
            #[cfg(feature = "baselines")]
            Parts::Rival(parts) => parts.test(),
        }
    }
}
