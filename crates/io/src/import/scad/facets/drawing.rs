//! Drawings as regions: SVG through usvg, and the entities of a DXF file.
//!
//! ```text
//!   SVG   every path is filled, by odd and even; y runs upwards from the lower edge of the sheet; millimetres
//!   DXF   LINE ARC CIRCLE ELLIPSE LWPOLYLINE POLYLINE of the layer that is asked for: runs whose ends meet are closed
//! ```

use super::Region;
use glam::DVec2;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Numbers of corners that one drawing may have.
const MOST_CORNERS: usize = 4_000_000;

/// The filled paths of an SVG file at so many dots an inch, its curves in `segments` for a circle.
pub(super) fn svg(bytes: &[u8], dpi: f64, segments: f64, centred: bool) -> Result<Region, String> {
    let options = usvg::Options { dpi: dpi as f32, ..usvg::Options::default() };
    let tree = usvg::Tree::from_data(bytes, &options).map_err(|e| e.to_string())?;
    let unit = 25.4 / dpi;
    let size = DVec2::new(f64::from(tree.size().width()), f64::from(tree.size().height()));
    let mut paths = Vec::new();
    let mut waiting: Vec<&usvg::Group> = vec![tree.root()];
    while let Some(group) = waiting.pop() {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => waiting.push(inner),
                usvg::Node::Path(path) => paths.push(path),
                usvg::Node::Image(_) | usvg::Node::Text(_) => {}
            }
        }
    }
    let steps = (segments / 4.0).ceil().clamp(2.0, 1000.0) as u32;
    let regions = paths.iter().map(|path| {
        let transform = path.abs_transform();
        let place = |p: usvg::tiny_skia_path::Point| {
            let mut p = p;
            transform.map_point(&mut p);
            unit * DVec2::new(f64::from(p.x), size.y - f64::from(p.y))
        };
        let (mut done, mut open): (Vec<Vec<DVec2>>, Vec<DVec2>) = (Vec::new(), Vec::new());
        for segment in path.data().segments() {
            use usvg::tiny_skia_path::PathSegment;
            let control = match segment {
                PathSegment::MoveTo(p) => {
                    done.push(std::mem::take(&mut open));
                    open.push(place(p));
                    continue;
                }
                PathSegment::Close => continue,
                PathSegment::LineTo(p) => {
                    open.push(place(p));
                    continue;
                }
                PathSegment::QuadTo(a, b) => vec![place(a), place(b)],
                PathSegment::CubicTo(a, b, c) => vec![place(a), place(b), place(c)],
            };
            let mut row = vec![open.last().copied().unwrap_or_default()];
            row.extend(control);
            for i in 1..=steps {
                let mut points = row.clone();
                while points.len() > 1 {
                    points = points.windows(2).map(|w| w[0].lerp(w[1], f64::from(i) / f64::from(steps))).collect();
                }
                open.push(points[0]);
            }
        }
        done.push(open);
        done.retain(|c| c.len() > 2);
        Region::new(&done, true)
    });
    let all = Region::union(regions.collect());
    let shift = glam::DAffine2::from_translation(-0.5 * unit * size);
    Ok(if centred { all.moved(&shift) } else { all })
}

/// An entity of a DXF file: its group codes and their values.
struct Entity<'a> {
    kind: &'a str,
    values: Vec<(i32, &'a str)>,
}

impl Entity<'_> {
    fn text(&self, code: i32) -> &str {
        self.values.iter().find(|(c, _)| *c == code).map_or("", |(_, v)| v)
    }

    fn number(&self, code: i32, default: f64) -> f64 {
        self.text(code).parse().ok().filter(|x: &f64| x.is_finite()).unwrap_or(default)
    }

    fn point(&self, code: i32) -> DVec2 {
        DVec2::new(self.number(code, 0.0), self.number(code + 10, 0.0))
    }
}

/// What stands in the section of entities.
fn entities(text: &str) -> Result<Vec<Entity<'_>>, String> {
    let mut lines = text.lines().zip(1..);
    let (mut all, mut kind, mut kept): (Vec<Entity<'_>>, &str, bool) = (Vec::new(), "", false);
    while let Some((code, number)) = lines.next() {
        let code: i32 = code.trim().parse().map_err(|_| format!("line {number} holds no group code"))?;
        let (value, _) = lines.next().ok_or_else(|| format!("the file ends in line {number}, after a group code"))?;
        let value = value.trim();
        match code {
            0 => {
                kind = value;
                kept &= kind != "ENDSEC";
                if kept {
                    all.push(Entity { kind, values: Vec::new() });
                }
            }
            2 if kind == "SECTION" => kept = value == "ENTITIES",
            _ => all.last_mut().filter(|_| kept).into_iter().for_each(|e| e.values.push((code, value))),
        }
        if kind == "EOF" {
            return Ok(all);
        }
    }
    Err("the file is cut off: it has no EOF".to_owned())
}

/// Closed runs of a DXF file; `layer`: only what lies on it, all where it is empty; `segments` of a circle by its radius.
pub(super) fn dxf(bytes: &[u8], layer: &str, segments: impl Fn(f64) -> f64) -> Result<(Region, Vec<String>), String> {
    let text = String::from_utf8_lossy(bytes);
    let entities = entities(&text)?;
    let mut runs: Vec<(Vec<DVec2>, bool)> = Vec::new();
    let mut left = HashMap::new();
    let mut corners = 0;
    for (i, entity) in entities.iter().enumerate() {
        if !layer.is_empty() && entity.text(8) != layer {
            continue;
        }
        let run = match entity.kind {
            "LINE" => (vec![entity.point(10), entity.point(11)], false),
            "CIRCLE" => (arc(entity.point(10), entity.number(40, 0.0), 0.0, TAU, &segments), true),
            "ARC" => {
                let (a, b) = (entity.number(50, 0.0).to_radians(), entity.number(51, 360.0).to_radians());
                let b = if b <= a { b + TAU } else { b };
                (arc(entity.point(10), entity.number(40, 0.0), a, b - a, &segments), false)
            }
            "ELLIPSE" => ellipse(entity, &segments),
            "LWPOLYLINE" => bulged(&vertices(&entity.values), entity.number(70, 0.0) as i64 & 1 == 1, &segments),
            "POLYLINE" => {
                let following = entities[i + 1..].iter().take_while(|e| e.kind == "VERTEX");
                let all: Vec<_> = following.map(|v| (v.point(10), v.number(42, 0.0))).collect();
                bulged(&all, entity.number(70, 0.0) as i64 & 1 == 1, &segments)
            }
            "VERTEX" | "SEQEND" => continue,
            other => {
                *left.entry(other.to_owned()).or_insert(0_usize) += 1;
                continue;
            }
        };
        corners += run.0.len();
        if corners > MOST_CORNERS {
            return Err(format!("more than {MOST_CORNERS} corners"));
        }
        runs.push(run);
    }
    let (closed, open) = joined(runs);
    let mut notes: Vec<String> = left.into_iter().map(|(kind, n)| format!("{n} of {kind} are not read")).collect();
    notes.sort();
    if open > 0 {
        notes.push(format!("{open} runs do not close"));
    }
    Ok((Region::new(&closed, true), notes))
}

fn arc(centre: DVec2, radius: f64, start: f64, turn: f64, segments: &impl Fn(f64) -> f64) -> Vec<DVec2> {
    let n = (segments(radius) * turn.abs() / TAU).ceil().clamp(1.0, 1e4) as u32;
    let whole = turn.abs() >= TAU;
    let at = |i: u32| centre + radius * DVec2::from_angle(start + turn * f64::from(i) / f64::from(n));
    (0..n + u32::from(!whole)).map(at).collect()
}

fn ellipse(entity: &Entity<'_>, segments: &impl Fn(f64) -> f64) -> (Vec<DVec2>, bool) {
    let (centre, major) = (entity.point(10), entity.point(11));
    let minor = entity.number(40, 1.0) * major.perp();
    let (a, b) = (entity.number(41, 0.0), entity.number(42, TAU));
    let turn = if b <= a { b + TAU - a } else { b - a };
    let points = arc(DVec2::ZERO, 1.0, a, turn, &|_| segments(major.length()));
    (points.into_iter().map(|p| centre + p.x * major + p.y * minor).collect(), turn > TAU - 1e-9)
}

fn vertices(values: &[(i32, &str)]) -> Vec<(DVec2, f64)> {
    let mut all: Vec<(DVec2, f64)> = Vec::new();
    for (code, value) in values {
        let number = value.parse().ok().filter(|x: &f64| x.is_finite()).unwrap_or(0.0);
        match (code, all.last_mut()) {
            (10, _) => all.push((DVec2::new(number, 0.0), 0.0)),
            (20, Some(last)) => last.0.y = number,
            (42, Some(last)) => last.1 = number,
            _ => {}
        }
    }
    all
}

/// A run of lines and arcs; the bulge is the tangent of a quarter of an arc's angle.
fn bulged(vertices: &[(DVec2, f64)], closed: bool, segments: &impl Fn(f64) -> f64) -> (Vec<DVec2>, bool) {
    let mut points = Vec::new();
    for (i, &(a, bulge)) in vertices.iter().enumerate() {
        points.push(a);
        let last = i + 1 == vertices.len();
        let (b, _) = vertices[(i + 1) % vertices.len()];
        if bulge != 0.0 && (closed || !last) && a != b {
            let turn = 4.0 * bulge.atan();
            let centre = 0.5 * (a + b) + (b - a).perp() * (1.0 - bulge * bulge) / (4.0 * bulge);
            let along = arc(centre, a.distance(centre), (a - centre).to_angle(), turn, segments);
            points.extend(along.get(1..along.len() - 1).unwrap_or_default());
        }
    }
    (points, closed)
}

/// Closed runs, made of runs whose ends meet; how many are left over.
fn joined(runs: Vec<(Vec<DVec2>, bool)>) -> (Vec<Vec<DVec2>>, usize) {
    let size = runs.iter().flat_map(|r| &r.0).fold(0.0_f64, |s, p| s.max(p.abs().max_element()));
    let near = 1e-6 * size;
    let key = |p: DVec2| (p / near.max(f64::MIN_POSITIVE)).round().to_array().map(|x| x as i64);
    let mut ends: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    let (mut closed, mut open) = (Vec::new(), Vec::new());
    for (points, whole) in runs {
        if whole || points.len() > 2 && points[0].distance(points[points.len() - 1]) <= near {
            closed.push(points);
        } else if points.len() > 1 {
            for end in [points[0], points[points.len() - 1]] {
                ends.entry(key(end)).or_default().push(open.len());
            }
            open.push(Some(points));
        }
    }
    let mut left = 0;
    for start in 0..open.len() {
        let Some(mut run) = open[start].take() else { continue };
        loop {
            let last = run[run.len() - 1];
            if run.len() > 2 && last.distance(run[0]) <= near {
                run.pop();
                closed.push(run);
                break;
            }
            let [x, y] = key(last);
            let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x.saturating_add(i), y.saturating_add(j)]));
            let meets = |k: &usize| {
                let other = open[*k].as_ref()?;
                let (first, end) = (other[0], other[other.len() - 1]);
                (first.distance(last) <= near)
                    .then_some((*k, false))
                    .or((end.distance(last) <= near).then_some((*k, true)))
            };
            let Some((next, turned)) = around.filter_map(|k| ends.get(&k)).flatten().find_map(meets) else {
                left += 1;
                break;
            };
            let mut more = open[next].take().expect("it was just there");
            if turned {
                more.reverse();
            }
            run.extend(more.into_iter().skip(1));
        }
    }
    (closed, left)
}
