//! The ways to trim.
//!
//! ```text
//!   way      scene buffers   buffers of the frame   passes before the draw     what the test reads
//!   table    TableScene      table::Buffers         table.rs: density … sort   table::Buffers
//!   exact    ExactScene      none                   none                       ExactScene
//! ```
//!
//! A scene uses one way; passes, pipelines and buffers of the other ways do not exist. The test of the way is compiled
//! into the passes that [`TrimTest`](crate::shaders::TrimTest) names.

pub(crate) mod capacities;
pub(crate) mod carry;
pub(crate) mod cross;
pub(crate) mod density;
pub(crate) mod dispatch_arguments;
mod edit;
pub(crate) mod lines;
pub(crate) mod segments;
pub(crate) mod sort;
pub(super) mod table;

pub(crate) use capacities::Capacities;

use super::Frame;
#[cfg(feature = "baselines")]
use super::baselines;
use super::common::room::Room;
use crate::gpu::{Commands, Device, GpuError, Resource, Timestamps};
use crate::picture::TakenWay;
use crate::scene::{ExactScene, SceneData};
use crate::shaders::{TRIM_EXACT, TRIM_TABLE, TrimTest};
use std::sync::Arc;
pub(crate) use table::BorderCells;
use table::Table;

/// The passes of the way that the scene uses.
pub(crate) enum Passes {
    Table(Arc<table::Passes>),
    Exact,
    #[cfg(feature = "baselines")]
    Baseline(Arc<baselines::Passes>),
}

impl Passes {
    /// `None` if no patch is trimmed.
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Option<Self>, GpuError> {
        Ok(match data.trim_way() {
            None => None,
            Some(TakenWay::Table) => Some(Self::Table(Arc::new(table::Passes::new(device, data)?))),
            Some(TakenWay::Exact) => Some(Self::Exact),
            #[cfg(feature = "baselines")]
            Some(TakenWay::Baseline(method)) => Some(Self::Baseline(Arc::new(baselines::Passes::new(device, method)?))),
        })
    }

    pub(super) fn test(&self) -> &'static TrimTest {
        match self {
            Self::Table(_) => &TRIM_TABLE,
            Self::Exact => &TRIM_EXACT,
            #[cfg(feature = "baselines")]
            Self::Baseline(passes) => passes.test(),
        }
    }
}

/// The stage.
pub(crate) enum Trim {
    Table(Box<Table>),
    Exact,
    #[cfg(feature = "baselines")]
    Baseline(Box<baselines::Trim>),
}

impl Trim {
    pub(super) fn new(room: &Room<'_>, passes: &Passes) -> Result<Self, GpuError> {
        Ok(match passes {
            Passes::Table(passes) => Self::Table(Box::new(Table::new(room, passes)?)),
            Passes::Exact => Self::Exact,
            #[cfg(feature = "baselines")]
            Passes::Baseline(passes) => Self::Baseline(Box::new(baselines::Trim::new(room, passes)?)),
        })
    }

    /// Clears the counters of the passes before the draw.
    pub(super) fn begin(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        match self {
            Self::Table(table) => table.begin(frame, cmd),
            Self::Exact => {}
            #[cfg(feature = "baselines")]
            Self::Baseline(trim) => trim.begin(cmd),
        }
    }

    /// Makes the u-intercept table, in scenes trimmed by it, unless the previous frame's is valid.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, times: &mut Timestamps) {
        if let Self::Table(table) = self {
            frame.unless_table_reused(cmd, table, || times.scope(cmd, "trim table", || table.record(frame, cmd)));
        }
    }

    /// Makes trim textures, in scenes trimmed by them, after patches are divided.
    #[cfg(feature = "baselines")]
    pub(super) fn record_baseline(&self, frame: &Frame<'_>, cmd: &Commands<'_>, times: &mut Timestamps) {
        if let Self::Baseline(trim) = self {
            trim.record(frame, cmd, times);
        }
    }

    /// The trim test's resources, in its order.
    pub(super) fn test<'a>(&'a self, frame: &Frame<'a>) -> Vec<Resource<'a>> {
        match self {
            Self::Table(table) => table.test(),
            Self::Exact => frame.scene.exact().into_iter().flat_map(ExactScene::all).map(Resource::from).collect(),
            #[cfg(feature = "baselines")]
            Self::Baseline(trim) => trim.test(frame.scene),
        }
    }
}
