//! Parity: every compute pass on the GPU against its twin, buffer by buffer.
//!
//! ```text
//!   shapes ──▶ Case (SceneData, views, Frame) ──▶ Chain (all twins, in the frame's order)
//!                 │                                  │ inputs of a pass      │ its outputs
//!                 ▼                                  ▼                       ▼
//!              upload ────────────────────────▶ the pass on the GPU ──▶ compare: exact, or within Slack
//! ```
//!
//! Each pass gets its inputs from the twins before it, so a difference names the pass that caused it; [`frame`] then
//! compares whole frames with the chain. Every file also gives the GPU one changed number and asserts that the
//! comparison names its place.

mod border_reach;
#[path = "../../tests/shapes/cages.rs"]
pub(crate) mod cages;
mod chain;
mod coverage;
mod exact;
mod hard;
mod mesh_walk;
mod shapes;

#[cfg(feature = "headless")]
use crate::{abi, spline::Patch};
#[cfg(feature = "headless")]
use glam::DVec4;

pub(crate) use crate::fixtures::{Case, Random};
pub(crate) use shapes::{placed, untrimmed};

#[cfg(feature = "headless")]
mod arithmetic;
#[cfg(all(feature = "headless", feature = "baselines"))]
mod baseline_slefe;
#[cfg(feature = "headless")]
mod bound;
#[cfg(feature = "headless")]
mod carry;
#[cfg(feature = "headless")]
mod cross;
#[cfg(feature = "headless")]
mod density;
#[cfg(feature = "headless")]
mod dispatch_arguments;
#[cfg(feature = "headless")]
mod edges;
#[cfg(feature = "headless")]
mod emit;
#[cfg(feature = "headless")]
mod frame;
#[cfg(feature = "headless")]
mod gap_decide;
#[cfg(feature = "headless")]
mod gate;
#[cfg(feature = "headless")]
mod harness;
#[cfg(feature = "headless")]
mod in_sight;
#[cfg(feature = "headless")]
mod lines;
#[cfg(feature = "headless")]
mod occlusion;
#[cfg(feature = "headless")]
mod operand_sort;
#[cfg(feature = "headless")]
mod parts;
#[cfg(feature = "headless")]
mod reset;
#[cfg(feature = "headless")]
mod segments;
#[cfg(feature = "headless")]
mod solid_lists;
#[cfg(feature = "headless")]
mod solids;
#[cfg(feature = "headless")]
mod sort;
#[cfg(feature = "headless")]
mod split;
#[cfg(feature = "headless")]
mod squares;
mod table;

#[cfg(feature = "headless")]
impl Case {
    /// A patch as it was uploaded, in part coordinates.
    fn patch(&self, packed: &abi::Patch) -> Patch {
        let (n, k) = packed.degrees();
        let first = packed.first as usize;
        let points = self.data.points[first..first + (n + 1) * (k + 1)].iter().map(|p| DVec4::from(p.map(f64::from)));
        Patch { degree_u: n, degree_v: k, points: points.collect() }
    }
}
