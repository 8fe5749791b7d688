//! Every class of damage with the message that it must have, word for word.
//!
//! A solid that cannot be read is nothing: what it is taken from goes with it, what it is joined to stays. A fault
//! that leaves nothing refuses the file.

use super::{BOX, ROD};
use crate::import::brlcad;
use crate::import::damage::{one_change_one_message, outcome, primitives, replaced};

fn first(text: &str) -> (String, usize) {
    outcome(brlcad(text.as_bytes(), "t.asc"), |_| true, primitives)
}

#[test]
fn every_change_has_its_message() {
    let good = format!(
        "title {{A box}}\nunits mm\n{BOX}{ROD}put two comb tree {{u {{l box}} {{l rod}}}}\nput all comb region yes tree {{- {{l two}} {{l rod {{1 0 0 2 0 1 0 2 0 0 1 0 0 0 0 1}}}}}}\n"
    );
    assert_eq!(first(&good).1, 9);
    let changes = [
        ("truncated", "V3 {4 4 0}", "", "error: t.asc:3: box arb8: `V3` is missing", 0),
        ("truncated", "4 0} V4", "", "error: t.asc:3: a brace or quote does not close", 0),
        ("truncated", "{l rod}}", "", "error: t.asc:5: a brace or quote does not close", 0),
        ("truncated", "put all", "", "", 8),
        ("swapped", "{l box}", "{l bux}", "t.asc:5: solid left out: `bux` does not exist", 9),
        (
            "swapped",
            "V5 {0 0 4}",
            "V5 {4 4 4}",
            "t.asc:3: faces that are not flat: box arb8: corners lie 2.309e0 mm off, and patches are drawn between them",
            3,
        ),
        ("swapped", "arb8", "tgc", "t.asc:3: solid left out: box tgc: `V` is missing", 2),
        ("cycle", "{l box}", "{l all}", "error: t.asc:5: `two` is part of itself", 0),
        ("cycle", "{l box}", "{l two}", "error: t.asc:5: `two` is part of itself", 0),
        ("huge", "H {0 0 9}", "H {0 0 1e999}", "error: t.asc:4: rod tgc: `H` is not 3 finite numbers", 0),
        ("huge", "H {0 0 9}", "H {0 0 9 9 9 9 9 9}", "error: t.asc:4: rod tgc: `H` is not 3 finite numbers", 0),
        ("NaN", "A {1 0 0}", "A {nan 0 0}", "error: t.asc:4: rod tgc: `A` is not 3 finite numbers", 0),
        ("NaN", "{1 0 0 2 0 1", "{1 0 0 nan 0 1", "error: t.asc:6: tree: not a matrix", 0),
        ("NaN", "V3 {4 4 0}", "V3 {4 inf 0}", "t.asc:3: solid left out: box arb8: `V3` is not 3 finite numbers", 2),
        ("type", "A {1 0 0}", "A {one 0 0}", "error: t.asc:4: rod tgc: `A` is not 3 finite numbers", 0),
        ("type", "A {1 0 0}", "A 1", "error: t.asc:4: rod tgc: `A` is not 3 finite numbers", 0),
        ("type", "{1 0 0 2 0 1", "{x 0 0 2 0 1", "error: t.asc:6: tree: `x` with 0 operands is not read", 0),
        ("type", "{- {l two}", "{7 {l two}", "error: t.asc:6: tree: `7` with 2 operands is not read", 0),
        ("type", "put two comb", "pot two comb", "error: t.asc:5: `pot` is not a statement of such a file", 0),
    ];
    one_change_one_message(&good, replaced, first, &changes);
}
