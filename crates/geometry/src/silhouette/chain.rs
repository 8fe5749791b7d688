//! Branches that meet, end to end.

use super::{Branch, Fold};
use glam::DVec2;

/// Ends of branches this near to each other, in shares of the domain, are one point: roots on a line that two cells share
/// agree to 1e-12.
const SAME: f64 = 1e-8;

/// Chains of branches; `size` is the domain's.
pub(super) fn chains(branches: Vec<Branch>, size: DVec2) -> Vec<Fold> {
    let mut branches = branches;
    let ends = |b: &Branch| b.ends().map(|p| p / size);
    let mut placed: Vec<[DVec2; 2]> = branches.iter().map(ends).collect();
    drop_twins(&mut branches, &mut placed);
    let next = partners(&placed);
    let mut used = vec![false; branches.len()];
    let mut folds = Vec::new();
    for first in 0..branches.len() {
        if used[first] {
            continue;
        }
        used[first] = true;
        let mut chain = vec![(first, false)];
        // forwards from the end of the first, then backwards from its start
        for backwards in [false, true] {
            loop {
                let &(last, reversed) = if backwards { &chain[0] } else { &chain[chain.len() - 1] };
                let end = usize::from(reversed == backwards);
                let Some((branch, at)) = next[last][end].filter(|(b, _)| !used[*b]) else { break };
                used[branch] = true;
                let joined = (branch, (at == 1) != backwards);
                chain.insert(if backwards { 0 } else { chain.len() }, joined);
            }
        }
        folds.push(Fold { branches: chain.into_iter().map(|(b, r)| (branches[b].clone(), r)).collect() });
    }
    folds
}

/// A fold along a side that two patches share is found in both.
fn drop_twins(branches: &mut Vec<Branch>, placed: &mut Vec<[DVec2; 2]>) {
    let is_side = |b: &Branch| b.bracket.0 == b.bracket.1;
    let mut keep = vec![true; branches.len()];
    for b in (0..branches.len()).filter(|b| is_side(&branches[*b])) {
        let same = |a: usize| (0..2).all(|e| placed[a][e].distance(placed[b][e]) <= SAME);
        keep[b] = !(0..b).any(|a| is_side(&branches[a]) && same(a));
    }
    let mut kept = keep.iter().copied();
    branches.retain(|_| kept.next().unwrap_or(true));
    let mut kept = keep.iter().copied();
    placed.retain(|_| kept.next().unwrap_or(true));
}

/// Of each end the branch and end that it meets, where it meets one alone.
fn partners(placed: &[[DVec2; 2]]) -> Vec<[Option<(usize, usize)>; 2]> {
    let mut ends: Vec<(DVec2, usize, usize)> =
        placed.iter().enumerate().flat_map(|(b, p)| [(p[0], b, 0), (p[1], b, 1)]).collect();
    ends.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
    let ends = &ends;
    let near = |i: usize| {
        let here = ends[i].0;
        let before = (0..i).rev().take_while(move |j| here.x - ends[*j].0.x <= SAME);
        let after = (i + 1..ends.len()).take_while(move |j| ends[*j].0.x - here.x <= SAME);
        before.chain(after).filter(|j| ends[*j].0.distance(here) <= SAME).collect::<Vec<_>>()
    };
    let mut next = vec![[None; 2]; placed.len()];
    for i in 0..ends.len() {
        if let [only] = near(i)[..] {
            next[ends[i].1][ends[i].2] = Some((ends[only].1, ends[only].2));
        }
    }
    next
}
