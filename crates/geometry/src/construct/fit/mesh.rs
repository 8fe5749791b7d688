//! The placement of a fit's new lines.

use super::cells::Cell;

/// A span is at most so many times as long as a neighbour, so that the interpolating cubic spline does not oscillate.
const GRADE: f64 = 4.0;
/// Most pieces of one span in one round.
const MOST: f64 = 4.0;
/// Spans shorter than this share of the domain are not split.
const SHORTEST: f64 = 1e-13;

/// More lines in `u` and `v`, enough for the error to fall below `tolerance` if it falls as `h⁴`. `None` when no span
/// can be split.
pub(super) fn refined(lines: &[Vec<f64>; 2], cells: &[Cell], tolerance: f64) -> Option<[Vec<f64>; 2]> {
    let spans_u = lines[0].len() - 1;
    let mut ask = [vec![1.0f64; spans_u], vec![1.0f64; lines[1].len() - 1]];
    for (index, cell) in cells.iter().enumerate().filter(|(_, c)| c.bound > tolerance) {
        let ratio = cell.bound / tolerance;
        for (axis, span, share) in [(0, index % spans_u, cell.along_u), (1, index / spans_u, 1.0 - cell.along_u)] {
            // a direction with little share in the error is not split
            if share * ratio > 0.5 && share > 0.05 {
                let pieces = (1.2 * ratio * share.max(0.5)).powf(0.25).ceil().clamp(2.0, MOST);
                ask[axis][span] = ask[axis][span].max(pieces);
            }
        }
    }
    let next = [split(&lines[0], &ask[0]), split(&lines[1], &ask[1])];
    let more = next[0].len() > lines[0].len() || next[1].len() > lines[1].len();
    more.then_some(next)
}

/// Splits each span into its number of pieces, then halves those that are too long beside their neighbours.
fn split(lines: &[f64], pieces: &[f64]) -> Vec<f64> {
    let shortest = SHORTEST * (lines[lines.len() - 1] - lines[0]);
    let mut out = vec![lines[0]];
    for (w, n) in lines.windows(2).zip(pieces) {
        let length = w[1] - w[0];
        let n = if length > n * shortest { *n as usize } else { 1 };
        out.extend((1..n).map(|i| w[0] + length * (i as f64 / n as f64)));
        out.push(w[1]);
    }
    loop {
        let length = |i: usize| out[i + 1] - out[i];
        let beside = |i: usize| {
            let before = if i > 0 { length(i - 1) } else { f64::INFINITY };
            let after = if i + 2 < out.len() { length(i + 1) } else { f64::INFINITY };
            before.min(after)
        };
        let long: Vec<usize> = (0..out.len() - 1).filter(|i| length(*i) > GRADE * beside(*i) * 1.001).collect();
        if long.is_empty() {
            return out;
        }
        for i in long.into_iter().rev() {
            out.insert(i + 1, 0.5 * (out[i] + out[i + 1]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splits_and_grades() {
        let lines = [0.0, 1.0, 2.0];
        assert_eq!(split(&lines, &[1.0, 2.0]), [0.0, 1.0, 1.5, 2.0]);
        let graded = split(&[0.0, 8.0, 9.0], &[1.0, 1.0]);
        assert_eq!(graded, [0.0, 4.0, 8.0, 9.0]);
    }

    /// The shortest spans are not split, so that a jump ends in an error and not in lines without number.
    #[test]
    fn stops_at_rounding() {
        let lines = [0.0, 1e-14, 1.0];
        assert!(split(&lines, &[4.0, 1.0]).len() < 60);
    }
}
