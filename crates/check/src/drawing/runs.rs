//! Stretches of a path that are one to the eye.
//!
//! ```text
//!   places where lines meet      ├──────×───────────×──────┤
//!   samples, exact rays             •  •   •  •  •    •  •
//!   states differ across a place          ends there, if the ray beside it agrees
//!   states differ elsewhere      bisection to WITHIN px: faces that pass through each other, what the places missed
//! ```

use super::meet::Meetings;
use super::path::Path;
use super::sight::{Sight, State};
use crate::Probe;

/// Pixels between samples.
const SPACING: f64 = 3.0;
/// Samples between two places at most.
const MOST: f64 = 2000.0;
/// Pixels: places nearer to each other are one, and stretches shorter are none.
const SHORT: f64 = 0.01;
/// Pixels to which an end is found by bisection.
const WITHIN: f64 = 0.005;
/// Pixels beside a place at which rays say whether visibility changes there.
const BESIDE: f64 = 0.02;

/// A stretch, by the path's measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Run {
    pub from: f64,
    pub to: f64,
    pub state: State,
}

/// Asks along one path.
struct Walk<'w, 's, 'p> {
    path: &'w Path<'s>,
    sight: &'w Sight<'s>,
    probe: &'w mut Probe<'p>,
    /// From where on the path has which state.
    begins: Vec<(f64, State)>,
}

/// All stretches of the path number `number`; `places` are parameters at which visibility may change.
pub(super) fn runs(
    number: usize,
    path: &Path<'_>,
    sight: &Sight<'_>,
    meetings: &Meetings<'_>,
    places: &[f64],
    probe: &mut Probe<'_>,
) -> Vec<Run> {
    let length = path.length();
    if length <= SHORT {
        return Vec::new();
    }
    let inner = places.iter().map(|s| path.measure(*s)).filter(|x| *x > SHORT && *x < length - SHORT);
    let mut cuts: Vec<f64> = inner.collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < SHORT);
    cuts.insert(0, 0.0);
    cuts.push(length);
    let mut walk = Walk { path, sight, probe, begins: Vec::new() };
    let mut last: Option<(f64, State)> = None;
    for pair in cuts.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let count = ((to - from) / SPACING).ceil().clamp(1.0, MOST);
        let samples: Vec<f64> = (0..count as usize).map(|k| from + (to - from) * (k as f64 + 0.5) / count).collect();
        if samples.iter().all(|x| meetings.is_covered(number, path.parameter(*x))) {
            walk.begins.push((from, State::Gone));
            last = None;
            continue;
        }
        for (k, x) in samples.into_iter().enumerate() {
            let state = walk.state(x);
            match last {
                None => walk.begins.push((from, state)),
                Some((_, before)) if before == state => {}
                Some((at, before)) => {
                    let around = [(from - BESIDE).max(at), (from + BESIDE).min(x)];
                    if k == 0 && around.map(|x| walk.state(x)) == [before, state] {
                        walk.begins.push((from, state));
                    } else {
                        walk.change((at, before), (x, state));
                    }
                }
            }
            last = Some((x, state));
        }
    }
    merged(&walk.begins, length)
}

impl Walk<'_, '_, '_> {
    fn state(&mut self, measure: f64) -> State {
        match self.sight.state(self.path.parameter(measure), self.probe) {
            State::Unsure(kind) => State::Seen(kind),
            state => state,
        }
    }

    /// Between two samples whose states differ.
    fn change(&mut self, (mut a, before): (f64, State), (mut b, after): (f64, State)) {
        while b - a > WITHIN {
            let middle = 0.5 * (a + b);
            let state = self.state(middle);
            if state == before {
                a = middle;
            } else if state == after {
                b = middle;
            } else {
                self.change((a, before), (middle, state));
                self.change((middle, state), (b, after));
                return;
            }
        }
        self.begins.push((0.5 * (a + b), after));
    }
}

/// The stretches, neighbours of one state joined; what is shorter than [`SHORT`] belongs to the stretch before it.
fn merged(begins: &[(f64, State)], length: f64) -> Vec<Run> {
    let mut out: Vec<Run> = Vec::new();
    for (k, (from, state)) in begins.iter().enumerate() {
        let to = begins.get(k + 1).map_or(length, |next| next.0);
        match out.last_mut() {
            Some(run) if run.state == *state || to - from < SHORT => run.to = to,
            _ => out.push(Run { from: *from, to, state: *state }),
        }
    }
    out
}
