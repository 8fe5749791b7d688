//! `selvedge measure`: lengths, areas, volumes and distances of a model, with their errors.
//!
//! ```text
//!   face:12, edge:40@2 ──▶ items of the model ──selvedge_geometry::measure──▶ rows ─▶ table, JSON
//! ```

mod items;
mod name;

pub use name::{Name, edge, face, face_or_edge, part};

use crate::args::MeasureArgs;
use crate::progress::during;
use crate::{Outcome, output, reading};
use anyhow::{Result, bail};
use items::Items;
use rayon::prelude::*;
use selvedge_geometry::measure::{Measured, Value, one, two};
use serde::Serialize;

/// What one item, or two together, measure.
#[derive(Debug, Serialize)]
struct Row {
    items: Vec<String>,
    values: Vec<ValueRow>,
    points: Vec<PointRow>,
}

/// A number and the estimate of its error.
#[derive(Debug, Serialize)]
struct ValueRow {
    what: &'static str,
    value: f64,
    error: f64,
    unit: &'static str,
}

/// A point or a direction.
#[derive(Debug, Serialize)]
struct PointRow {
    what: &'static str,
    at: [f64; 3],
}

/// Reads the model and prints its measurements.
pub fn run(args: &MeasureArgs) -> Result<Outcome> {
    let import = reading::open(&args.model, &args.read, &args.subdivide)?;
    let mut wanted = wanted(args);
    let has_edges = args.list || wanted.iter().flatten().any(|name| matches!(name, Name::Edge(_)));
    let items = during("finding edges", || Items::new(&import.model, has_edges));
    if wanted.is_empty() {
        wanted = items.parts().into_iter().map(|part| vec![part]).collect();
        if wanted.is_empty() {
            bail!("{}: nothing to measure: no placed part has faces", reading::named(&args.model));
        }
    }
    if args.list {
        let all = items.list();
        let lines = all.iter().map(|one| [one.item.clone(), one.kind.clone(), one.part.clone(), point(one.at)]);
        return print(args.json, &all, ["item", "kind", "part", "a point of it"], lines);
    }
    let rows: Result<Vec<Row>> =
        during("measuring", || wanted.par_iter().map(|names| measured(&items, names)).collect());
    let rows = rows.map_err(|error| error.context(reading::named(&args.model)))?;
    print(args.json, &rows, ["item", "quantity", "value", "error", "unit"], rows.iter().flat_map(lines))
}

/// The names of the arguments: single items, and pairs.
fn wanted(args: &MeasureArgs) -> Vec<Vec<Name>> {
    let single = args.face.iter().chain(&args.edge).chain(&args.part).map(|name| vec![*name]);
    single.chain(args.between.chunks(2).map(<[Name]>::to_vec)).collect()
}

fn measured(items: &Items<'_>, names: &[Name]) -> Result<Row> {
    let found = names.iter().map(|name| items.find(*name)).collect::<Result<Vec<_>>>()?;
    let measured = match &found[..] {
        [(_, item)] => one(item),
        [(_, a), (_, b)] => two(a, b),
        _ => None,
    };
    let items: Vec<String> = found.iter().map(|(name, _)| name.to_string()).collect();
    let Some(Measured { values, points, .. }) = measured else {
        bail!("{}: there is nothing to measure", items.join(" and "));
    };
    let value = |Value { what, value, error, unit }| ValueRow { what, value, error, unit };
    let values = values.into_iter().map(value).collect();
    let points = points.into_iter().map(|(what, at)| PointRow { what, at: at.to_array() }).collect();
    Ok(Row { items, values, points })
}

/// The lines of a table; numbers have all their digits.
fn lines(row: &Row) -> Vec<[String; 5]> {
    let items = row.items.join(" ");
    let line = |what: &str, value: String, error: String, unit: &str| {
        [items.clone(), what.to_owned(), value, error, unit.to_owned()]
    };
    let values = row.values.iter().map(|v| line(v.what, v.value.to_string(), format!("{:.0e}", v.error), v.unit));
    let points = row.points.iter().map(|p| line(p.what, point(p.at), String::new(), ""));
    values.chain(points).collect()
}

fn point(at: [f64; 3]) -> String {
    at.map(|x| x.to_string()).join(", ")
}

fn print<const N: usize>(
    json: bool,
    value: &impl Serialize,
    header: [&str; N],
    lines: impl Iterator<Item = [String; N]>,
) -> Result<Outcome> {
    if json {
        output::print(&serde_json::to_string_pretty(value)?)?;
    } else {
        let mut table = output::table(header);
        for line in lines {
            table.add_row(line);
        }
        output::print(&table.to_string())?;
    }
    Ok(Outcome::Good)
}
