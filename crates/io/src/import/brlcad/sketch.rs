//! Sketches, and solids extruded from them.
//!
//! ```text
//!   sketch   VL {{x y} ...}   SL {{line S 0 E 1} {carc S 1 E 2 R r L 0 O 0} {bezier D 3 P {2 3 4 5}}}
//!   extrude  V + x A + y B, moved along H
//! ```
//!
//! Segments are put end to end as they are listed or found; one of a negative radius is the whole circle about `E`
//! through `S`.

use super::Fault;
use super::body::{flat, frame};
use super::object::{Database, Record};
use crate::construct::curve::{ellipse, line};
use crate::construct::{Chain, extruded_solid};
use crate::model::Part;
use crate::spline::{BSpline, Bezier, Control};
use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::TAU;

/// A curve between two vertices; the same one twice for a closed curve.
struct Segment {
    ends: [usize; 2],
    curve: BSpline<DVec3>,
}

/// The solid of an extrusion in the frame of its profile, and that frame.
pub(super) fn extruded(object: &Record<'_>, database: &Database<'_>) -> Result<(Part, DAffine3), Fault> {
    let name = object.value("S").ok_or_else(|| object.fault("`S` is missing"))?;
    let found = database.objects.get(name).map(|o| &o.record).filter(|r| r.kind == "sketch");
    let sketch = found.ok_or_else(|| object.fault(format!("there is no sketch `{name}`")))?;
    let profile = profile(sketch)?;
    let (x, y, h) = (object.vector("A")?, object.vector("B")?, object.vector("H")?);
    let normal = x.cross(y);
    if normal == DVec3::ZERO {
        return Err(object.fault("`A` and `B` are parallel"));
    }
    let own = frame(x, y, normal, object.vector("V")?);
    let along = own.matrix3.inverse() * h;
    let part = extruded_solid(&profile, along).map_err(|e| object.fault(e))?;
    Ok((part, own))
}

/// The closed chains of a sketch.
fn profile(sketch: &Record<'_>) -> Result<Vec<Chain>, Fault> {
    let numbers = sketch.list("VL")?;
    let vertices: Vec<DVec2> = numbers.chunks_exact(2).map(DVec2::from_slice).collect();
    let listed = sketch.value("SL").ok_or_else(|| sketch.fault("`SL` is missing"))?;
    let mut left: Vec<Segment> = Vec::new();
    for (i, text) in groups(listed).into_iter().enumerate() {
        left.push(segment(text, &vertices).map_err(|what| sketch.fault(format!("segment {i}: {what}")))?);
    }
    left.reverse();
    let mut chains = Vec::new();
    while let Some(first) = left.pop() {
        let (start, mut end) = (first.ends[0], first.ends[1]);
        let mut chain = vec![first.curve];
        while end != start {
            let next = left.iter().rposition(|s| s.ends.contains(&end));
            let next = next.ok_or_else(|| sketch.fault(format!("the curve ends at vertex {end}")))?;
            let Segment { ends, curve } = left.remove(next);
            let ahead = ends[0] == end;
            end = ends[usize::from(ahead)];
            chain.push(if ahead { curve } else { curve.reversed() });
        }
        chains.push(chain);
    }
    Ok(chains)
}

/// What stands within the outermost braces.
fn groups(text: &str) -> Vec<&str> {
    let (mut depth, mut start, mut all) = (0_usize, 0, Vec::new());
    for (i, c) in text.char_indices() {
        match c {
            '{' => {
                depth += 1;
                if depth == 1 {
                    start = i + 1;
                }
            }
            '}' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    all.push(&text[start..i]);
                }
            }
            _ => {}
        }
    }
    all
}

fn segment(text: &str, vertices: &[DVec2]) -> Result<Segment, String> {
    let words: Vec<&str> = text.split(|c: char| c.is_whitespace() || c == '{' || c == '}').collect();
    let words: Vec<&str> = words.into_iter().filter(|w| !w.is_empty()).collect();
    let place = |key: &str| words.iter().position(|w| *w == key).map(|i| i + 1);
    let number = |key: &str| {
        let word = place(key).and_then(|i| words.get(i)).and_then(|w| w.parse::<f64>().ok());
        word.filter(|x| x.is_finite()).ok_or_else(|| format!("`{key}` is no number"))
    };
    let vertex = |x: f64| {
        let inside = x >= 0.0 && x.fract() == 0.0 && x < vertices.len() as f64;
        inside.then_some(x as usize).ok_or_else(|| format!("there is no vertex {x}"))
    };
    let said = |e: crate::construct::ConstructError| e.to_string();
    match words.first().copied().unwrap_or_default() {
        "line" => {
            let ends = [vertex(number("S")?)?, vertex(number("E")?)?];
            let [a, b] = ends.map(|i| vertices[i].extend(0.0));
            let curve = line(a, b).and_then(|c| flat(&c)).map_err(said)?;
            Ok(Segment { ends, curve })
        }
        "carc" => {
            let (s, e, radius) = (vertex(number("S")?)?, vertex(number("E")?)?, number("R")?);
            let (start, end) = (vertices[s], vertices[e]);
            let (ends, centre, turn) = if radius <= 0.0 {
                ([s, s], end, TAU)
            } else {
                // the centre is beside the middle of the chord
                let chord = end - start;
                let beside = radius * radius - 0.25 * chord.length_squared();
                if beside < -1e-9 * radius * radius || chord == DVec2::ZERO {
                    return Err(format!("no arc of radius {radius} joins its ends"));
                }
                let side = if number("L")? == 0.0 { -1.0 } else { 1.0 };
                let centre = start + 0.5 * chord + chord.normalize().perp() * (side * beside.max(0.0).sqrt());
                let angle = (start - centre).angle_to(end - centre).rem_euclid(TAU);
                ([s, e], centre, if number("O")? == 0.0 { angle } else { angle - TAU })
            };
            let x = start - centre;
            let y = x.perp() * turn.signum();
            let arc = ellipse(centre.extend(0.0), x.extend(0.0), y.extend(0.0), 0.0, turn.abs());
            Ok(Segment { ends, curve: arc.and_then(|c| flat(&c)).map_err(said)? })
        }
        "bezier" => {
            let degree = number("D")?;
            let from = place("P").ok_or("`P` is missing")?;
            let places = words.get(from..).unwrap_or_default().iter().map(|w| {
                let x = w.parse::<f64>().map_err(|_| format!("`{w}` is no vertex"))?;
                vertex(x)
            });
            let places = places.collect::<Result<Vec<_>, String>>()?;
            if places.len() < 2 || places.len() as f64 != degree + 1.0 {
                return Err(format!("{} points of a curve of degree {degree}", places.len()));
            }
            let points = places.iter().map(|i| DVec3::from_point(vertices[*i], 1.0)).collect();
            let curve = BSpline::from_bezier(Bezier { points }, 0.0, 1.0).map_err(|e| e.to_string())?;
            Ok(Segment { ends: [places[0], places[places.len() - 1]], curve })
        }
        other => Err(format!("`{other}` is not read")),
    }
}
