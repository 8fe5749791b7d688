//! `[camera.NAME]` and `[picture]`.

use super::items::Scene;
use super::text::{Outcome, Table, Value};
use crate::import::camera::{Lens, NamedCamera, PictureSettings, Stance};
use crate::model::{Bounds, Camera};
use glam::DVec3;

/// Default room around a fitted box.
const MARGIN: f64 = 1.08;
/// Largest side of a picture.
const MOST_PIXELS: usize = 16384;

/// Reads one camera; `bounds_of` gives the box of everything placed under a name.
pub(super) fn camera<'a>(
    scene: &Scene<'a>,
    name: &str,
    mut table: Table<'a>,
    bounds_of: impl Fn(Value<'a>) -> Outcome<Bounds>,
) -> Outcome<NamedCamera> {
    let unit = scene.unit;
    let up = table.read("up", Value::direction)?.unwrap_or(DVec3::Z);
    let eye = table.read("eye", Value::point)?;
    let stance = match eye {
        Some(eye) => {
            let target = table.read("target", Value::point)?;
            if target == Some(eye) {
                return Err(table.need("target")?.fault("it is where the eye is"));
            }
            for key in ["fit", "from", "margin"] {
                if let Some(value) = table.get(key) {
                    return Err(value.fault("a camera with an `eye` is not fitted"));
                }
            }
            Stance::At { eye: eye * unit, target: target.map(|t| t * unit) }
        }
        None => {
            let bounds = table.read("fit", |v| {
                if v.is_flag() {
                    return Ok(None);
                }
                let boxes = v.names()?.into_iter().map(&bounds_of).collect::<Outcome<Vec<_>>>()?;
                Ok(Some(boxes.into_iter().fold(Bounds::EMPTY, Bounds::union)))
            })?;
            let bounds = bounds.flatten();
            let from = table.read("from", Value::direction)?.unwrap_or(Camera::FROM);
            let margin = table.read("margin", Value::positive)?.unwrap_or(MARGIN);
            if let Some(value) = table.get("target") {
                return Err(value.fault("a fitted camera looks at the middle of what it fits"));
            }
            Stance::Fit { from, bounds, margin }
        }
    };
    let direction = match stance {
        Stance::At { eye, target: Some(target) } => eye - target,
        Stance::At { .. } => up.any_orthogonal_vector(),
        Stance::Fit { from, .. } => from,
    };
    if direction.normalize().cross(up.normalize()).length() < 1e-9 {
        return Err(table.get("up").or(table.get("from")).or(table.get("eye")).map_or_else(
            || super::text::Fault::new(table.at, "the view runs along `up`"),
            |v| v.fault("the view runs along `up`"),
        ));
    }
    let lens = match (table.get("fov"), table.get("ortho")) {
        (Some(_), Some(ortho)) => return Err(ortho.fault("beside `fov`")),
        (None, Some(ortho)) => {
            let fitted = matches!(stance, Stance::Fit { .. });
            let height = if fitted && matches!(ortho.flag(), Ok(true)) { None } else { Some(ortho.positive()? * unit) };
            Lens::Parallel { height }
        }
        (fov, None) => {
            let degrees = fov.map_or(Ok(Camera::FOV_DEG), Value::number)?;
            if !(degrees > 0.0 && degrees < 180.0) {
                return Err(table.need("fov")?.fault("an angle between 0 and 180 degrees is wanted"));
            }
            Lens::Perspective { fov_y: degrees.to_radians() }
        }
    };
    table.finish()?;
    Ok(NamedCamera { name: name.to_owned(), stance, up, lens })
}

/// Reads the settings of the picture.
pub(super) fn picture(mut table: Table<'_>, cameras: &[NamedCamera]) -> Outcome<PictureSettings> {
    let size = table.read("size", |v| {
        let sides = v.list()?.into_iter().map(|n| n.count(1, MOST_PIXELS)).collect::<Outcome<Vec<_>>>()?;
        let [w, h] = sides[..] else { return Err(v.fault("width and height are wanted")) };
        Ok((w as u32, h as u32))
    })?;
    let camera = table.read("camera", |v| {
        let name = v.text()?;
        let index = cameras.iter().position(|c| c.name == name);
        index.ok_or_else(|| v.fault(format!("there is no camera `{}`", super::text::shortened(name))))
    })?;
    let background = table.read("background", Value::colour)?;
    let sun = table.read("sun", Value::direction)?;
    table.finish()?;
    Ok(PictureSettings { size, camera, background, sun })
}
