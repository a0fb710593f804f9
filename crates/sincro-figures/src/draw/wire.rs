//! Wires: round corners, arrow heads at inputs, dots where they branch.

use std::collections::{BTreeMap, BTreeSet};

use super::canvas::Canvas;
use super::route::{Point, Run};
use super::size::Side;

/// Radius of corners.
const RADIUS: i64 = 5;
/// Length of an arrow head.
const HEAD: i64 = 7;

/// Draws a net.
pub(super) fn draw(canvas: &mut Canvas, run: &Run, is_wide: bool) {
    let class = if is_wide { "sd-wire sd-wide" } else { "sd-wire" };
    let web = Web::new(run);
    let data: Vec<String> = web.chains().iter().map(|chain| rounded(&pulled_back(chain, run))).collect();
    if !data.is_empty() {
        canvas.path(class, &data.join(""));
    }
    for dot in web.branches() {
        canvas.circle("sd-solid", (dot.0 as f64, dot.1 as f64), 2.8);
    }
    for ((x, y), side) in &run.heads {
        let (x, y, long) = (*x, *y, HEAD + 1);
        canvas.path(
            "sd-solid",
            &match side {
                Side::Left => format!("M{x} {y}l-{long} -4v8z"),
                Side::Above => format!("M{x} {y}l-4 -{long}h8z"),
                Side::Below => format!("M{x} {y}l-4 {long}h8z"),
            },
        );
    }
}

/// Places of a net, with those next to each.
struct Web {
    next: BTreeMap<Point, BTreeSet<Point>>,
}

impl Web {
    fn new(run: &Run) -> Self {
        let places: BTreeSet<Point> = run.pieces.iter().flat_map(|(a, b)| [*a, *b]).collect();
        let mut next: BTreeMap<Point, BTreeSet<Point>> = BTreeMap::new();
        for (a, b) in &run.pieces {
            let (low, high) = (a.min(b), a.max(b));
            let on_piece = |p: &&Point| {
                (low.0 == high.0 && p.0 == low.0 && (low.1..=high.1).contains(&p.1))
                    || (low.1 == high.1 && p.1 == low.1 && (low.0..=high.0).contains(&p.0))
            };
            let on: Vec<Point> = places.iter().filter(on_piece).copied().collect();
            for pair in on.windows(2) {
                next.entry(pair[0]).or_default().insert(pair[1]);
                next.entry(pair[1]).or_default().insert(pair[0]);
            }
        }
        Self { next }
    }

    /// Places where more than two pieces meet.
    fn branches(&self) -> impl Iterator<Item = Point> {
        self.next.iter().filter(|(_, next)| next.len() > 2).map(|(place, _)| *place)
    }

    /// Ways between ends and branches, each once.
    fn chains(&self) -> Vec<Vec<Point>> {
        let mut chains = Vec::new();
        let mut done: BTreeSet<(Point, Point)> = BTreeSet::new();
        for (&start, nexts) in self.next.iter().filter(|(_, next)| next.len() != 2) {
            for &first in nexts {
                if done.contains(&(start, first)) {
                    continue;
                }
                let mut chain = vec![start, first];
                while let [.., before, last] = chain[..] {
                    done.insert((before, last));
                    done.insert((last, before));
                    let onward = self.next[&last].iter().find(|place| **place != before);
                    match onward {
                        Some(&place) if self.next[&last].len() == 2 => chain.push(place),
                        _ => break,
                    }
                }
                chains.push(straightened(&chain));
            }
        }
        chains
    }
}

/// Without places in the middle of straight pieces.
fn straightened(chain: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (k, &place) in chain.iter().enumerate() {
        let is_between = kept.last().zip(chain.get(k + 1)).is_some_and(|(before, after)| {
            (before.0 == place.0 && after.0 == place.0) || (before.1 == place.1 && after.1 == place.1)
        });
        if !is_between {
            kept.push(place);
        }
    }
    kept
}

/// With its ends pulled back from the points of arrow heads.
fn pulled_back(chain: &[Point], run: &Run) -> Vec<Point> {
    let mut chain = chain.to_vec();
    let last = chain.len() - 1;
    for end in [0, last] {
        match run.heads.iter().find(|(head, _)| *head == chain[end]) {
            Some((_, Side::Left)) => chain[end].0 -= HEAD,
            Some((_, Side::Above)) => chain[end].1 -= HEAD,
            Some((_, Side::Below)) => chain[end].1 += HEAD,
            None => {}
        }
    }
    chain
}

/// Path data with round corners.
fn rounded(chain: &[Point]) -> String {
    let mut data = format!("M{} {}", chain[0].0, chain[0].1);
    for k in 1..chain.len() {
        let (before, here) = (chain[k - 1], chain[k]);
        let Some(&after) = chain.get(k + 1) else {
            data.push_str(&format!("L{} {}", here.0, here.1));
            continue;
        };
        let length = |a: Point, b: Point| (a.0 - b.0).abs() + (a.1 - b.1).abs();
        let radius = RADIUS.min(length(before, here) / 2).min(length(here, after) / 2);
        let toward = |b: Point| (here.0 + (b.0 - here.0).signum() * radius, here.1 + (b.1 - here.1).signum() * radius);
        let (a, b) = (toward(before), toward(after));
        data.push_str(&format!("L{} {}Q{} {} {} {}", a.0, a.1, here.0, here.1, b.0, b.1));
    }
    data
}
