//! Checks of a scene's settings.

use super::RenderError;
use crate::picture::{FrameSettings, Samples, SceneSettings, TrimWay};
use crate::scene::{SceneData, SceneRequest};

/// Smooth trims exclude some other settings.
pub(super) fn check_smooth_trims(data: &SceneData, settings: SceneRequest) -> Result<(), RenderError> {
    let refused = match settings.trim {
        _ if settings.samples != Samples::One => Some("several samples a pixel, which smooth them, too"),
        _ if data.is_layered => Some("something to see through, or to mark"),
        #[cfg(feature = "baselines")]
        _ if settings.baseline.trim.is_some() => Some("another way to trim than `exact`"),
        TrimWay::Auto | TrimWay::Exact => None,
        TrimWay::Table => Some("another way to trim than `exact`"),
    };
    refused.map_or(Ok(()), |what| Err(RenderError::SmoothTrims(what)))
}

/// The radius of ambient occlusion is finite and positive, and a pixel has one sample.
pub(super) fn check_ambient(settings: SceneSettings) -> Result<(), RenderError> {
    match settings.ambient {
        Some(radius) if !(radius.is_finite() && radius > 0.0) => Err(RenderError::AmbientRadius(radius)),
        Some(_) if settings.samples != Samples::One => Err(RenderError::AmbientSamples),
        _ => Ok(()),
    }
}

/// The scale of a style of curvature has an end, and the scene has what the style needs.
pub(super) fn check_curvature(frame: FrameSettings, scene: bool) -> Result<(), RenderError> {
    match frame.curvature_range {
        _ if !frame.style.is_curvature() => Ok(()),
        range if !(range.is_finite() && range > 0.0) => Err(RenderError::CurvatureRange(range)),
        _ if !scene => Err(RenderError::NoCurvature),
        _ => Ok(()),
    }
}

/// The direction towards the sun is finite and has a length.
pub(super) fn check_sun(settings: SceneSettings) -> Result<(), RenderError> {
    let nowhere = settings.sun.filter(|s| !s.is_finite() || *s == glam::DVec3::ZERO);
    nowhere.map_or(Ok(()), |towards| Err(RenderError::Sun(towards)))
}
