//! DXF drawings as regions.
//!
//! ```text
//!   LINE ARC CIRCLE ELLIPSE LWPOLYLINE POLYLINE ─▶ runs of corners; runs whose ends meet are closed ─▶ Region
//!   INSERT ─▶ the runs of a BLOCK, scaled, turned, moved
//! ```
//!
//! As in OpenSCAD, a layer argument selects among the entities outside of blocks, a block comes whole with its INSERT,
//! the base point of a block is ignored, and rows and columns are not repeated; a note reports the last two.

use super::Region;
use glam::{DAffine2, DVec2};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;

/// Corners, and uses of blocks, that one drawing may have.
const MOST_CORNERS: usize = 4_000_000;

/// Deepest blocks in blocks.
const MOST_LEVELS: usize = 32;

/// An entity of a DXF file: its group codes and their values.
struct Entity<'a> {
    kind: &'a str,
    values: Vec<(i32, &'a str)>,
}

impl<'a> Entity<'a> {
    fn text(&self, code: i32) -> &'a str {
        self.values.iter().find(|(c, _)| *c == code).map_or("", |(_, v)| v)
    }

    fn number(&self, code: i32, default: f64) -> f64 {
        self.text(code).parse().ok().filter(|x: &f64| x.is_finite()).unwrap_or(default)
    }

    fn point(&self, code: i32) -> DVec2 {
        DVec2::new(self.number(code, 0.0), self.number(code + 10, 0.0))
    }
}

/// The entities of a drawing, and its blocks.
#[derive(Default)]
struct Drawing<'a> {
    entities: Vec<Entity<'a>>,
    /// By name: the BLOCK itself, and its entities.
    blocks: HashMap<&'a str, Vec<Entity<'a>>>,
}

impl<'a> Drawing<'a> {
    fn read(text: &'a str) -> Result<Self, String> {
        let mut lines = text.lines().zip(1..);
        let (mut drawing, mut kind, mut section) = (Self::default(), "", "");
        let mut block: Vec<Entity<'_>> = Vec::new();
        while let Some((code, number)) = lines.next() {
            let code: i32 = code.trim().parse().map_err(|_| format!("line {number} holds no group code"))?;
            let (value, _) =
                lines.next().ok_or_else(|| format!("the file ends in line {number}, after a group code"))?;
            let value = value.trim();
            if code == 0 {
                if matches!(value, "ENDBLK" | "BLOCK" | "ENDSEC" | "EOF")
                    && let Some(first) = block.first()
                {
                    let name = first.text(2);
                    drawing.blocks.insert(name, std::mem::take(&mut block));
                }
                kind = value;
                let entity = Entity { kind, values: Vec::new() };
                match (section, kind) {
                    (_, "EOF") => return Ok(drawing),
                    (_, "ENDSEC") => section = "",
                    ("ENTITIES", _) => drawing.entities.push(entity),
                    // entities between blocks belong to none
                    ("BLOCKS", _) if kind == "BLOCK" || !block.is_empty() && kind != "ENDBLK" => block.push(entity),
                    _ => {}
                }
                continue;
            }
            match (section, kind, code) {
                (_, "SECTION", 2) => section = value,
                ("ENTITIES", ..) => drawing.entities.last_mut().into_iter().for_each(|e| e.values.push((code, value))),
                ("BLOCKS", ..) => block.last_mut().into_iter().for_each(|e| e.values.push((code, value))),
                _ => {}
            }
        }
        Err("the file is cut off: it has no EOF".to_owned())
    }
}

/// Runs of corners, and notes on entities that are not among them.
#[derive(Default)]
struct Runs<'a> {
    all: Vec<(Vec<DVec2>, bool)>,
    corners: usize,
    unread: BTreeMap<&'a str, usize>,
    notes: Vec<String>,
    /// Names of the blocks within which the work is.
    trail: Vec<&'a str>,
}

impl<'a> Runs<'a> {
    fn spend(&mut self, corners: usize) -> Result<(), String> {
        self.corners += corners;
        if self.corners > MOST_CORNERS { Err(format!("more than {MOST_CORNERS} corners")) } else { Ok(()) }
    }

    fn note(&mut self, text: String) {
        if !self.notes.contains(&text) {
            self.notes.push(text);
        }
    }

    /// Adds those of `entities` that lie on `layer`, all where it is empty.
    fn add(
        &mut self,
        drawing: &Drawing<'a>,
        entities: &[Entity<'a>],
        layer: &str,
        segments: &impl Fn(f64) -> f64,
    ) -> Result<(), String> {
        for (i, entity) in entities.iter().enumerate() {
            if !layer.is_empty() && entity.text(8) != layer {
                continue;
            }
            let run = match entity.kind {
                "LINE" => (vec![entity.point(10), entity.point(11)], false),
                "CIRCLE" => (arc(entity.point(10), entity.number(40, 0.0), 0.0, TAU, segments), true),
                "ARC" => {
                    let (a, b) = (entity.number(50, 0.0).to_radians(), entity.number(51, 360.0).to_radians());
                    let b = if b <= a { b + TAU } else { b };
                    (arc(entity.point(10), entity.number(40, 0.0), a, b - a, segments), false)
                }
                "ELLIPSE" => ellipse(entity, segments),
                "LWPOLYLINE" => bulged(&vertices(&entity.values), entity.number(70, 0.0) as i64 & 1 == 1, segments),
                "POLYLINE" => {
                    let following = entities[i + 1..].iter().take_while(|e| e.kind == "VERTEX");
                    let all: Vec<_> = following.map(|v| (v.point(10), v.number(42, 0.0))).collect();
                    bulged(&all, entity.number(70, 0.0) as i64 & 1 == 1, segments)
                }
                "INSERT" => {
                    self.insert(drawing, entity, segments)?;
                    continue;
                }
                "VERTEX" | "SEQEND" | "ATTRIB" => continue,
                other => {
                    *self.unread.entry(other).or_default() += 1;
                    continue;
                }
            };
            self.spend(run.0.len())?;
            self.all.push(run);
        }
        Ok(())
    }

    /// Adds the runs of a block, scaled, then turned, then moved.
    fn insert(
        &mut self,
        drawing: &Drawing<'a>,
        insert: &Entity<'a>,
        segments: &impl Fn(f64) -> f64,
    ) -> Result<(), String> {
        self.spend(1)?;
        let name = insert.text(2);
        let Some((block, members)) = drawing.blocks.get(name).and_then(|all| all.split_first()) else {
            self.note(format!("the block {name:?} of an INSERT is not there"));
            return Ok(());
        };
        if self.trail.contains(&name) || self.trail.len() >= MOST_LEVELS {
            self.note(format!("the block {name:?} is within itself, or deeper than {MOST_LEVELS} levels"));
            return Ok(());
        }
        if block.point(10) != DVec2::ZERO {
            self.note(format!("the base point of the block {name:?} is not looked at, as in OpenSCAD"));
        }
        if insert.number(70, 1.0) > 1.0 || insert.number(71, 1.0) > 1.0 {
            self.note(format!("the block {name:?} is drawn once, not in rows and columns, as in OpenSCAD"));
        }
        let first = self.all.len();
        self.trail.push(name);
        self.add(drawing, members, "", segments)?;
        self.trail.pop();
        let scale = DVec2::new(insert.number(41, 1.0), insert.number(42, 1.0));
        let map = DAffine2::from_scale_angle_translation(scale, insert.number(50, 0.0).to_radians(), insert.point(10));
        self.all[first..].iter_mut().flat_map(|(run, _)| run).for_each(|p| *p = map.transform_point2(*p));
        Ok(())
    }
}

/// The region of a DXF file, and notes on what is left out. `layer`: only the entities on it, all where it is empty;
/// `segments` of a circle by its radius.
pub(super) fn region(
    bytes: &[u8],
    layer: &str,
    segments: impl Fn(f64) -> f64,
) -> Result<(Region, Vec<String>), String> {
    let text = String::from_utf8_lossy(bytes);
    let drawing = Drawing::read(&text)?;
    let mut runs = Runs::default();
    runs.add(&drawing, &drawing.entities, layer, &segments)?;
    let Runs { all, unread, mut notes, .. } = runs;
    let (closed, open) = joined(all);
    notes.extend(unread.into_iter().map(|(kind, n)| format!("{n} of {kind} are not read")));
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
