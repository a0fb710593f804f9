//! Division of a program into functions, and the memory through which they pass numbers on.
//!
//! The time in which registers are allocated grows faster than a function: programs are cut into functions of some
//! hundreds of operations. A result that a later function needs stands in memory from its own on, as angles and their
//! sines do.

use sincro_math::record::{Operation, Program};

use super::order::{Order, Part};

/// Number of parts of a function.
const PARTS_OF_A_FUNCTION: usize = 600;

/// Place of the angles of a set in the working memory, behind which their sines and their cosines stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angles {
    pub first: usize,
    /// Number of angles, in whole rows of lanes.
    pub n: usize,
}

/// Functions of a program, and places in their working memory, in numbers from its start.
#[derive(Debug)]
pub(super) struct Layout {
    pub order: Order,
    pub angles: Vec<Angles>,
    /// Function of each operation.
    pub functions: Vec<usize>,
    /// Place of each result that a later function needs.
    pub places: Vec<Option<usize>>,
    /// Length of the working memory.
    pub n: usize,
}

impl Layout {
    /// Divides a program whose angles are found in rows of `width`.
    pub fn new(program: &Program, width: usize) -> Self {
        let order = Order::new(program);
        let mut n = 0;
        let of_set = |set: &Vec<u32>| {
            let new = Angles { first: n, n: set.len().next_multiple_of(width) };
            n += 3 * new.n;
            new
        };
        let angles = order.sets.iter().map(of_set).collect();
        let operations = program.operations();
        let (mut functions, mut last_uses) = (vec![0; operations.len()], vec![0; operations.len()]);
        for (k, part) in order.parts.iter().enumerate() {
            let function = k / PARTS_OF_A_FUNCTION;
            match part {
                Part::Operation(k) => {
                    functions[*k as usize] = function;
                    let operands = operations[*k as usize].operands();
                    operands.iter().for_each(|&x| last_uses[x as usize] = function);
                }
                Part::Angles(set) => order.sets[*set].iter().for_each(|&x| last_uses[x as usize] = function),
            }
        }
        let mut places = vec![None; operations.len()];
        let (mut free, mut taken): (Vec<usize>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
        let mut function = 0;
        for part in &order.parts {
            let Part::Operation(k) = part else { continue };
            let k = *k as usize;
            if functions[k] > function {
                function = functions[k];
                // places that no function needs from this one on
                taken.retain(|&(last, place)| {
                    if last < function {
                        free.push(place);
                    }
                    last >= function
                });
            }
            if last_uses[k] > function && !is_in_memory(&operations[k]) {
                let place = free.pop().unwrap_or_else(|| {
                    n += 1;
                    n - 1
                });
                places[k] = Some(place);
                taken.push((last_uses[k], place));
            }
        }
        Self { order, angles, functions, places, n }
    }

    /// Parts of each function.
    pub fn parts(&self) -> impl ExactSizeIterator<Item = &[Part]> {
        self.order.parts.chunks(PARTS_OF_A_FUNCTION)
    }
}

/// Returns true if the result of an operation stands in memory, or in the code, without being computed by it.
pub(super) fn is_in_memory(operation: &Operation) -> bool {
    matches!(
        operation,
        Operation::Constant(_) | Operation::Input(_) | Operation::Parameter(_) | Operation::Sin(_) | Operation::Cos(_)
    )
}

#[cfg(test)]
mod tests {
    use sincro_math::Real;
    use sincro_math::record::{Recorded, record};

    use super::*;

    #[test]
    fn results_that_later_functions_need_have_places_of_their_own_until_then() {
        let program = record(2, 1, |x| {
            let kept = x[0] * x[1];
            let mut y = x[1];
            for k in 0..3 * PARTS_OF_A_FUNCTION {
                y = y * x[0] + Recorded::splat(k as f64 + 0.5);
            }
            vec![y + kept.sin_cos().0, kept]
        });
        let program = program.unwrap();
        let layout = Layout::new(&program, 8);
        assert!(layout.parts().len() > 5);
        let operations = program.operations();
        for (k, operation) in operations.iter().enumerate() {
            for x in operation.operands().into_iter().map(|x| x as usize) {
                let passes = layout.functions[x] < layout.functions[k] && !is_in_memory(&operations[x]);
                assert!(!passes || layout.places[x].is_some(), "result {x} for operation {k}");
            }
        }
        // what is kept, and what goes from each function to the next
        let n_places = layout.n - layout.angles.iter().map(|angles| 3 * angles.n).sum::<usize>();
        assert!((2..=4).contains(&n_places), "{n_places}");
    }
}
