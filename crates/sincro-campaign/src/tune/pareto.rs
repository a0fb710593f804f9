//! Two goals at once: candidates that no other is better than in both, by NSGA-II on the unit cube.
//!
//! A population is bred by simulated binary crossover and polynomial mutation; of parents and children the better half
//! survives by rank of dominance, then by distance from its neighbours on the front. What breaks limits is dominated by
//! what breaks them less. Draws are counter-based: the same seed gives the same bits. Source: key `deb2002`.

use sincro_math::elementary::pow;

use super::Candidate;
use crate::design::random::{Purpose, uniform};

/// Candidates of a generation.
pub(super) const POPULATION: usize = 32;
/// Distribution indices of crossover and mutation: larger ones keep children nearer to their parents.
const CROSSOVER: f64 = 15.0;
const MUTATION: f64 = 20.0;

/// True if the first candidate is no worse in both goals and better in one, or breaks the limits less.
pub(super) fn dominates(a: &Candidate, b: &Candidate) -> bool {
    if a.violation > 0.0 || b.violation > 0.0 {
        return a.violation < b.violation;
    }
    (a.goal <= b.goal && a.second <= b.second) && (a.goal < b.goal || a.second < b.second)
}

/// Point of the unit cube with what came out of it.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// Point of the unit cube.
    pub point: Vec<f64>,
    /// Candidate of these values.
    pub candidate: Candidate,
}

/// Ranks of dominance (0 is the front) and distances from the neighbours in the same rank.
fn sort(members: &[Member]) -> Vec<(usize, f64)> {
    let n = members.len();
    let mut ranked: Vec<(usize, f64)> = vec![(usize::MAX, 0.0); n];
    let mut rank = 0;
    while ranked.iter().any(|(r, _)| *r == usize::MAX) {
        let open: Vec<usize> = (0..n).filter(|i| ranked[*i].0 == usize::MAX).collect();
        let is_beaten = |i: usize| open.iter().any(|j| dominates(&members[*j].candidate, &members[i].candidate));
        let mut front: Vec<usize> = open.iter().copied().filter(|i| !is_beaten(*i)).collect();
        for goal in [|c: &Candidate| c.goal, |c: &Candidate| c.second] {
            let value = |i: usize| goal(&members[i].candidate);
            front.sort_by(|a, b| value(*a).total_cmp(&value(*b)));
            let width = (value(front[front.len() - 1]) - value(front[0])).max(f64::MIN_POSITIVE);
            for (k, i) in front.iter().enumerate() {
                let is_end = k == 0 || k + 1 == front.len();
                let gap = if is_end { f64::INFINITY } else { (value(front[k + 1]) - value(front[k - 1])) / width };
                ranked[*i] = (rank, ranked[*i].1 + gap);
            }
        }
        rank += 1;
    }
    ranked
}

/// The best members, as many as a population, in the order of rank and distance.
pub(super) fn survivors(members: Vec<Member>) -> Vec<Member> {
    let ranked = sort(&members);
    let mut order: Vec<usize> = (0..members.len()).collect();
    order.sort_by(|a, b| ranked[*a].0.cmp(&ranked[*b].0).then(ranked[*b].1.total_cmp(&ranked[*a].1)).then(a.cmp(b)));
    order.into_iter().take(POPULATION).map(|i| members[i].clone()).collect()
}

/// Points of the first generation: the start, then points all over the cube.
pub(super) fn first(start: &[f64], seed: u64) -> Vec<Vec<f64>> {
    let point = |i: usize| match i {
        0 => start.to_vec(),
        _ => (0..start.len()).map(|k| uniform(seed, Purpose::Mutation, k as u32, i as u64)).collect(),
    };
    (0..POPULATION).map(point).collect()
}

/// Children of a population sorted by [`survivors`].
pub(super) fn children(parents: &[Member], generation: u64, seed: u64) -> Vec<Vec<f64>> {
    let n = parents[0].point.len();
    // streams: those of coordinates for crossover and mutation, then the choices
    let draw = |stream: usize, child: usize| {
        uniform(seed, Purpose::Mutation, stream as u32, generation * POPULATION as u64 + child as u64)
    };
    let child = |i: usize| -> Vec<f64> {
        // of two drawn at random the better, which comes first
        let pick = |stream: usize| {
            let one = |s: usize| ((draw(s, i) * parents.len() as f64) as usize).min(parents.len() - 1);
            &parents[one(stream).min(one(stream + 1))].point
        };
        let (a, b) = (pick(3 * n), pick(3 * n + 2));
        (0..n)
            .map(|k| {
                let u = draw(k, i);
                let exponent = 1.0 / (CROSSOVER + 1.0);
                let spread = if u < 0.5 { pow(2.0 * u, exponent).0 } else { pow(1.0 / (2.0 * (1.0 - u)), exponent).0 };
                let x = 0.5 * ((1.0 + spread) * a[k] + (1.0 - spread) * b[k]);
                let v = draw(n + k, i);
                let exponent = 1.0 / (MUTATION + 1.0);
                let change =
                    if v < 0.5 { pow(2.0 * v, exponent).0 - 1.0 } else { 1.0 - pow(2.0 * (1.0 - v), exponent).0 };
                let mutates = draw(2 * n + k, i) < 1.0 / n as f64;
                (x + if mutates { change } else { 0.0 }).clamp(0.0, 1.0)
            })
            .collect()
    };
    (0..POPULATION).map(child).collect()
}

/// Adds a candidate that keeps all limits to the front, unless one of it is as good; removes those that it beats.
pub(super) fn add(front: &mut Vec<Candidate>, candidate: &Candidate) {
    let is_known =
        |c: &Candidate| dominates(c, candidate) || (c.goal == candidate.goal && c.second == candidate.second);
    if candidate.violation > 0.0 || !candidate.second.is_finite() || front.iter().any(is_known) {
        return;
    }
    front.retain(|c| !dominates(candidate, c));
    let place = front.partition_point(|c| c.goal < candidate.goal);
    front.insert(place, candidate.clone());
}

/// The candidate of a front that is nearest to the best of both goals, each relative to its width on the front.
pub(super) fn knee(front: &[Candidate]) -> Option<&Candidate> {
    let (first, last) = (front.first()?, front.last()?);
    let share = |x: f64, from: f64, to: f64| if to > from { (x - from) / (to - from) } else { 0.0 };
    let distance = |c: &Candidate| {
        let (a, b) = (share(c.goal, first.goal, last.goal), share(c.second, last.second, first.second));
        a * a + b * b
    };
    front.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(point: &[f64]) -> Candidate {
        // Schaffer's problem with a distance from its front: the front is x from 0 to 1 at y = 0
        let (x, y) = (4.0 * point[0] - 2.0, point[1]);
        Candidate {
            values: point.to_vec(),
            goal: x * x + y,
            second: (x - 1.0) * (x - 1.0) + y,
            violation: 0.0,
            violations: Vec::new(),
            measures: Vec::new(),
        }
    }

    #[test]
    fn the_front_of_a_known_problem_is_found() {
        let member = |point: Vec<f64>| Member { candidate: of(&point), point };
        let mut parents: Vec<Member> = first(&[0.9, 0.9], 1).into_iter().map(member).collect();
        let mut front = Vec::new();
        for generation in 1..25 {
            let mut all: Vec<Member> = children(&parents, generation, 1).into_iter().map(member).collect();
            all.extend(parents);
            all.iter().for_each(|m| add(&mut front, &m.candidate));
            parents = survivors(all);
        }
        assert!(front.len() > 20, "{}", front.len());
        for c in &front {
            // √f₁ + √f₂ = 1 on the front
            let sum = c.goal.sqrt() + c.second.sqrt();
            assert!((0.999..1.1).contains(&sum), "{sum}");
        }
        let (least, greatest) = (front[0].goal, front[front.len() - 1].goal);
        assert!(least < 0.01 && greatest > 0.8, "{least} {greatest}");
        let knee = knee(&front).unwrap();
        assert!((knee.goal - 0.25).abs() < 0.05, "{knee:?}");
    }

    #[test]
    fn what_breaks_limits_less_comes_first() {
        let with = |violation| Candidate { violation, ..of(&[0.5, 0.0]) };
        assert!(dominates(&with(0.1), &with(0.2)) && dominates(&with(0.0), &with(0.1)));
        assert!(!dominates(&with(0.0), &with(0.0)));
    }
}
