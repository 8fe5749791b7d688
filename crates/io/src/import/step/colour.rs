//! Colours of items.
//!
//! ```text
//!   STYLED_ITEM('',(style),item)  ▶ PRESENTATION_STYLE_ASSIGNMENT ▶ SURFACE_STYLE_USAGE
//!     ▶ SURFACE_SIDE_STYLE ▶ SURFACE_STYLE_FILL_AREA ▶ FILL_AREA_STYLE ▶ FILL_AREA_STYLE_COLOUR
//!                          ▶ SURFACE_STYLE_RENDERING_WITH_PROPERTIES ▶ SURFACE_STYLE_TRANSPARENT
//!     ▶ COLOUR_RGB('',r,g,b)  or  DRAUGHTING_PRE_DEFINED_COLOUR('red')
//! ```
//!
//! Beside FILL_AREA stand styles of curves on the surface: SURFACE_STYLE_BOUNDARY, SILHOUETTE, PARAMETER_LINE, … No
//! curve is drawn, so their colours are not used. They are counted where an item has no other colour.
//!
//! A face takes its own colour, else its shell's, its solid's, its representation's. An OVER_RIDING_STYLED_ITEM beats a
//! STYLED_ITEM on the same item. A colour on a MAPPED_ITEM, or one given for the context of one occurrence, belongs to
//! that instance. A context is the path of a CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM, or, for a body, the
//! occurrence's own representation in a PRESENTATION_STYLE_BY_CONTEXT.
//!
//! The standard names no colour space; every known writer stores the values of its screen, sRGB. The model stores
//! linear light.
//!
//! Source: ISO 10303-46, 6.4 to 6.7.

use super::body::{FACES, SHELLS};
use super::entity::{Entity, Fault, Fields};
use super::geometry::Ledger;
use super::part21::{File, Value};
use super::product::Products;
use crate::import::colour::linear;
use crate::model::Colour;
use std::collections::{BTreeSet, HashMap};

/// Colours by the number of the styled item.
#[derive(Debug, Default)]
pub(super) struct Colours {
    items: HashMap<u32, Colour>,
    /// Colours of single occurrences: by the first relationship of their path, with the others.
    contexts: HashMap<u32, Vec<(Vec<u32>, Colour)>>,
    /// Colours of bodies, and of representations that list them, by an occurrence's representation and their number.
    occurrences: HashMap<(u32, u32), Colour>,
}

/// Style entities that lead to a surface's colour.
const STYLES: [&str; 9] = [
    "PRESENTATION_STYLE_ASSIGNMENT",
    BY_CONTEXT,
    "SURFACE_STYLE_USAGE",
    "SURFACE_SIDE_STYLE",
    "SURFACE_STYLE_FILL_AREA",
    "FILL_AREA_STYLE",
    "FILL_AREA_STYLE_COLOUR",
    "SURFACE_STYLE_RENDERING",
    "SURFACE_STYLE_RENDERING_WITH_PROPERTIES",
];

/// A style for one context: a representation.
const BY_CONTEXT: &str = "PRESENTATION_STYLE_BY_CONTEXT";

/// Styles of curves on a surface: its border, its outline, its (u, v) lines. No curve is drawn, and none paints its face.
const CURVES: [&str; 5] = [
    "SURFACE_STYLE_BOUNDARY",
    "SURFACE_STYLE_SILHOUETTE",
    "SURFACE_STYLE_SEGMENTATION_CURVE",
    "SURFACE_STYLE_CONTROL_GRID",
    "SURFACE_STYLE_PARAMETER_LINE",
];

/// The colour and transparency found below a style so far.
#[derive(Clone, Copy, Default)]
struct Found {
    rgb: Option<[f64; 3]>,
    transparency: Option<f64>,
    /// There are styles of curves on the surface.
    curves: bool,
    /// A colour that cannot be read.
    unread: Option<u32>,
}

impl Colours {
    /// Reads all styled items.
    pub fn read(file: &File<'_>, ledger: &Ledger<'_>) -> Self {
        let mut colours = Self::default();
        let usages = usages(file);
        let context = "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM";
        for kind in ["STYLED_ITEM", "OVER_RIDING_STYLED_ITEM", context] {
            for id in file.of_kind(kind) {
                // an unreadable style costs its colour, not the shape
                if let Err(fault) = colours.styled(file, ledger, id, (kind == context, &usages)) {
                    ledger.note("colour ignored", id, fault.to_string());
                }
            }
        }
        colours
    }

    /// The colour of an item, in linear light.
    pub fn of_item(&self, id: u32) -> Option<Colour> {
        self.items.get(&id).copied()
    }

    /// The colour of an occurrence: `path` are the relationships that place it, `body` is its body and the list that
    /// holds that.
    pub fn of_path(&self, path: &[u32], body: [u32; 2]) -> Option<Colour> {
        // the outermost occurrence rules
        let own = |id: &u32| body.iter().find_map(|item| self.occurrences.get(&(*id, *item)));
        if let Some(colour) = path.iter().find_map(own) {
            return Some(*colour);
        }
        let styles = path.iter().filter_map(|id| self.contexts.get(id)).flatten();
        let styled =
            styles.filter(|(others, _)| others.iter().all(|o| path.contains(o))).map(|(_, colour)| *colour).next();
        styled.or_else(|| path.iter().find_map(|id| self.of_item(*id)))
    }

    /// `usages`: the representations of occurrences.
    fn styled(
        &mut self,
        file: &File<'_>,
        ledger: &Ledger<'_>,
        id: u32,
        (in_context, usages): (bool, &BTreeSet<u32>),
    ) -> Result<(), Fault> {
        let fields = Entity::find(file, id)?;
        let base = fields.fields("STYLED_ITEM", 1).unwrap_or_else(|_| fields.all().after_name());
        let mut found = Found::default();
        for style in base.references(0)? {
            search(file, ledger, style?, &mut found)?;
        }
        if let (None, Some(colour)) = (found.rgb, found.unread) {
            let name = Entity::find(file, colour)?.name();
            ledger.note("colour ignored", id, format!("{name} #{colour} is no colour that is known"));
        }
        let (Some(rgb), Some(item)) = (found.rgb, base.optional(1)) else {
            if found.curves {
                ledger.ignore("colours of the curves on a surface", 1);
            }
            return Ok(());
        };
        let colour = linear(rgb, 1.0 - found.transparency.unwrap_or(0.0));
        if let Some(usage) = occurrence(file, base, usages) {
            let kinds = Entity::find(file, item)?;
            if kinds.kinds().any(|k| FACES.contains(&k) || SHELLS.contains(&k)) {
                ledger.note("colour ignored", id, format!("#{item} is a part of a body, and it is for one occurrence"));
            } else {
                self.occurrences.insert((usage, item), colour);
            }
            return Ok(());
        }
        if !in_context {
            self.items.insert(item, colour);
            return Ok(());
        }
        let mut path: Vec<u32> =
            base.value(3).and_then(Value::list).into_iter().flatten().filter_map(Value::reference).collect();
        if let Some(first) = path.pop() {
            self.contexts.entry(first).or_default().push((path, colour));
        }
        Ok(())
    }
}

/// The representation among `usages` for which a styled item, by its fields behind the name, has its style.
pub(super) fn occurrence(file: &File<'_>, styled: Fields<'_>, usages: &BTreeSet<u32>) -> Option<u32> {
    let styles = styled.references(0).ok()?.filter_map(Result::ok);
    let by_context = |style: u32| Entity::find(file, style).ok()?.fields(BY_CONTEXT, 0).ok()?.optional(1);
    styles.filter_map(by_context).find(|context| usages.contains(context))
}

/// The representations of occurrences, where any style is for one context.
pub(super) fn usages(file: &File<'_>) -> BTreeSet<u32> {
    let by_context = file.of_kind(BY_CONTEXT).next().is_some();
    if by_context { Products::of_usages(file) } else { BTreeSet::new() }
}

/// Follows a style down to its first colour and transparency.
fn search(file: &File<'_>, ledger: &Ledger<'_>, id: u32, found: &mut Found) -> Result<(), Fault> {
    ledger.nested(id, || {
        let entity = Entity::find(file, id)?;
        let kinds: Vec<&str> = entity.kinds().collect();
        if kinds.iter().any(|k| STYLES.contains(k)) {
            return entity.references().try_for_each(|r| search(file, ledger, r, found));
        }
        if kinds.contains(&"COLOUR_RGB") {
            let fields = entity.fields("COLOUR_RGB", 1)?;
            let rgb = [fields.real(0)?, fields.real(1)?, fields.real(2)?];
            found.rgb = found.rgb.or(Some(rgb.map(|c| c.clamp(0.0, 1.0))));
        } else if kinds.iter().any(|k| k.ends_with("PRE_DEFINED_COLOUR")) {
            let rgb = named(&entity.all().text(0));
            found.rgb = found.rgb.or(rgb);
            found.unread = found.unread.or(rgb.is_none().then_some(id));
        } else if kinds.iter().any(|k| CURVES.contains(k)) {
            found.curves = true;
        } else if let Ok(fields) = entity.fields("SURFACE_STYLE_TRANSPARENT", 0) {
            found.transparency = found.transparency.or(Some(fields.real(0)?.clamp(0.0, 1.0)));
        } else if kinds.iter().any(|k| k.starts_with("COLOUR_")) {
            found.unread = found.unread.or(Some(id));
        }
        Ok(())
    })
}

/// DRAUGHTING_PRE_DEFINED_COLOUR (ISO 10303-202).
fn named(name: &str) -> Option<[f64; 3]> {
    Some(match name {
        "red" => [1.0, 0.0, 0.0],
        "green" => [0.0, 1.0, 0.0],
        "blue" => [0.0, 0.0, 1.0],
        "yellow" => [1.0, 1.0, 0.0],
        "magenta" => [1.0, 0.0, 1.0],
        "cyan" => [0.0, 1.0, 1.0],
        "black" => [0.0, 0.0, 0.0],
        "white" => [1.0, 1.0, 1.0],
        _ => return None,
    })
}
