//! Order of evaluation in which sines and cosines are found many at a time.
//!
//! Operations keep the order of the program. Where the first sine or cosine of a set is needed, whatever the angles of
//! the set still lack is evaluated, then all of the set at once. A set has the angles that depend on equally many
//! others, one after the other: those of a step of semi-implicit Euler are one set, those of a Runge–Kutta step four.

use std::collections::BTreeMap;

use sincro_math::record::{Operation, Program};

/// Part of the evaluation of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The operation with this index.
    Operation(u32),
    /// Sines and cosines of the set with this index.
    Angles(usize),
}

/// Evaluation of a program in parts.
#[derive(Debug)]
pub(super) struct Order {
    pub parts: Vec<Part>,
    /// Operations whose results are the angles of each set.
    pub sets: Vec<Vec<u32>>,
    /// Set of an angle, and its place there.
    pub places: BTreeMap<u32, (usize, usize)>,
}

impl Order {
    pub fn new(program: &Program) -> Self {
        let operations = program.operations();
        // number of angles, one of which depends on the other, on which a result depends
        let mut depths = vec![0_usize; operations.len()];
        let (mut sets, mut places): (Vec<Vec<u32>>, _) = (Vec::new(), BTreeMap::new());
        for (k, operation) in operations.iter().enumerate() {
            let below = operation.operands().iter().map(|&x| depths[x as usize]).max().unwrap_or(0);
            depths[k] = below;
            if let Operation::Sin(angle) | Operation::Cos(angle) = *operation {
                depths[k] += 1;
                sets.resize(sets.len().max(below + 1), Vec::new());
                places.entry(angle).or_insert_with(|| {
                    sets[below].push(angle);
                    (below, sets[below].len() - 1)
                });
            }
        }
        let mut new = Self { parts: Vec::new(), sets, places };
        let mut done = Done { operations: vec![false; operations.len()], sets: vec![false; new.sets.len()] };
        for k in 0..operations.len() as u32 {
            new.need(k, operations, &mut done);
        }
        new
    }

    /// Adds operation `k` with all that it lacks.
    fn need(&mut self, k: u32, operations: &[Operation], done: &mut Done) {
        // without recursion: programs are long
        let mut needed = vec![Part::Operation(k)];
        while let Some(part) = needed.last().cloned() {
            let (is_done, before) = match part {
                Part::Operation(k) => {
                    let before = match operations[k as usize] {
                        Operation::Sin(angle) | Operation::Cos(angle) => vec![Part::Angles(self.places[&angle].0)],
                        other => other.operands().into_iter().map(Part::Operation).collect(),
                    };
                    (done.operations[k as usize], before)
                }
                Part::Angles(set) => {
                    (done.sets[set], self.sets[set].iter().map(|&angle| Part::Operation(angle)).collect())
                }
            };
            let lacking = |part: &Part| match part {
                Part::Operation(k) => !done.operations[*k as usize],
                Part::Angles(set) => !done.sets[*set],
            };
            let lacks: Vec<Part> =
                if is_done { Vec::new() } else { before.into_iter().filter(lacking).rev().collect() };
            if !lacks.is_empty() {
                needed.extend(lacks);
                continue;
            }
            needed.pop();
            if !is_done {
                match part {
                    Part::Operation(k) => done.operations[k as usize] = true,
                    Part::Angles(set) => done.sets[set] = true,
                }
                self.parts.push(part);
            }
        }
    }
}

/// Marks of what has been added.
struct Done {
    operations: Vec<bool>,
    sets: Vec<bool>,
}

#[cfg(test)]
mod tests {
    use sincro_math::Real;
    use sincro_math::record::record;

    use super::*;

    #[test]
    fn angles_that_do_not_depend_on_each_other_make_one_set() {
        let program = record(3, 1, |x| {
            let first = x[0].sin_cos().0;
            let sum = first + (x[1] + x[2]).sin_cos().1;
            vec![sum.sin_cos().0 * first, x[2].sin_cos().0]
        });
        let program = program.unwrap();
        let order = Order::new(&program);
        assert_eq!(order.sets.iter().map(Vec::len).collect::<Vec<_>>(), [3, 1]);
        let at = |part: &Part| order.parts.iter().position(|other| other == part).unwrap();
        for (k, operation) in program.operations().iter().enumerate() {
            let here = at(&Part::Operation(k as u32));
            assert!(operation.operands().iter().all(|x| at(&Part::Operation(*x)) < here));
            if let Operation::Sin(angle) | Operation::Cos(angle) = operation {
                assert!(at(&Part::Angles(order.places[angle].0)) < here);
            }
        }
        assert!(
            order.sets.iter().enumerate().all(|(set, angles)| {
                angles.iter().all(|angle| at(&Part::Operation(*angle)) < at(&Part::Angles(set)))
            })
        );
        assert_eq!(order.parts.len(), program.operations().len() + 2);
    }
}
