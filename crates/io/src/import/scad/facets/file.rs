//! `import(file)` and `surface(file)`: files beside the one that names them, or where others are searched.

use super::solid::Triangles;
use super::{Body, Region, Shape, dxf, relief, svg};
use crate::import::meshes;
use crate::import::scad::Fault;
use crate::import::scad::args::{Args, Value};
use crate::import::source::OtherFiles;
use glam::{DAffine2, DVec2};
use std::path::PathBuf;

/// Bytes of a file that is taken in.
const MOST_BYTES: u64 = 1 << 30;

/// The shape in a file, which `opened` then has, and notes on what is left out.
pub(super) fn read(
    args: &Args<'_>,
    files: OtherFiles<'_>,
    opened: &mut Vec<PathBuf>,
) -> Result<(Shape, Vec<String>), Fault> {
    let Some(Value::Text(file)) = args.get("file").filter(|v| !matches!(v, Value::Text(t) if t.is_empty())) else {
        return Err(args.fault("no file is named"));
    };
    let wrong = |what: String| args.fault(format!("{file}: {what}"));
    let of_file = |notes: Vec<String>| -> Vec<String> { notes.into_iter().map(|n| format!("{file}: {n}")).collect() };
    let (path, bytes) = files.open(file, MOST_BYTES).map_err(wrong)?;
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if !opened.contains(&path) {
        opened.push(path);
    }
    if args.node == "surface" {
        let relief = relief::read(&bytes, args.flag("invert")).map_err(wrong)?;
        return Ok((Shape::Solid(Body::mesh(relief.mesh(args.flag("center")))), Vec::new()));
    }
    match ending.as_str() {
        "svg" => {
            let dpi = args.number("dpi", 72.0)?;
            if !(1e-3..=1e6).contains(&dpi) {
                return Err(args.fault(format!("{dpi} dots an inch")));
            }
            let (region, mut notes) =
                svg::region(&bytes, dpi, args.segments(10.0), args.flag("center")).map_err(wrong)?;
            if matches!(args.get("layer"), Some(Value::Text(layer)) if !layer.is_empty()) {
                notes.push("`layer` of an SVG file is not read: all layers are there".to_owned());
            }
            Ok((placed(args, &region)?, of_file(notes)))
        }
        "dxf" => {
            let layer = match args.get("layer") {
                Some(Value::Text(layer)) => layer.as_str(),
                _ => "",
            };
            let (region, notes) = dxf::region(&bytes, layer, |r| args.segments(r)).map_err(wrong)?;
            Ok((placed(args, &region)?, of_file(notes)))
        }
        "stl" | "off" | "3mf" | "amf" => {
            let (pieces, notes) = meshes::pieces(&bytes, &ending).map_err(wrong)?;
            let mut body = Body::default();
            for (points, triangles) in pieces {
                body = Body::union(vec![body, Body::mesh(Triangles::welded(&points, triangles).outwards())]);
            }
            Ok((Shape::Solid(body), of_file(notes)))
        }
        _ => Err(wrong("a kind of file that is not imported: STL, OFF, 3MF, AMF, SVG and DXF are".to_owned())),
    }
}

/// `origin` is moved to the origin, then scaled.
fn placed(args: &Args<'_>, region: &Region) -> Result<Shape, Fault> {
    let scale = args.number("scale", 1.0)?;
    let origin = DVec2::from_array(args.vector::<2>("origin", 0.0)?);
    if !scale.is_finite() || !origin.is_finite() {
        return Err(args.fault("a scale or origin that is not finite"));
    }
    let map = DAffine2::from_scale(DVec2::splat(scale)) * DAffine2::from_translation(-origin);
    Ok(Shape::Flat(region.moved(&map)))
}
