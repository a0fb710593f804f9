//! Simplex search of Nelder and Mead (1965) in the unit cube, by comparisons alone.

/// Next point that the search wants to know, given all it knows.
#[derive(Debug)]
pub struct Simplex {
    /// Corners with their merits, the best first.
    corners: Vec<Vec<f64>>,
}

impl Simplex {
    /// A simplex about a start with edges of `edge`, inside the cube.
    #[must_use]
    pub fn new(start: &[f64], edge: f64) -> Self {
        let mut corners = vec![start.to_vec()];
        for j in 0..start.len() {
            let mut corner = start.to_vec();
            corner[j] = if corner[j] + edge <= 1.0 { corner[j] + edge } else { corner[j] - edge };
            corners.push(corner);
        }
        Self { corners }
    }

    /// Searches with at most `budget` evaluations; `merit` is an evaluation, smaller is better by `better`. Returns the
    /// number of evaluations.
    pub fn search<M: Clone>(
        self,
        budget: usize,
        mut merit: impl FnMut(&[f64]) -> Option<M>,
        better: impl Fn(&M, &M) -> bool,
    ) -> usize {
        let mut n_made = 0;
        let mut of = |x: &[f64], n_made: &mut usize| {
            *n_made += 1;
            merit(x)
        };
        let mut known: Vec<(Vec<f64>, M)> = Vec::new();
        for corner in self.corners {
            let Some(m) = of(&corner, &mut n_made) else { return n_made };
            known.push((corner, m));
        }
        let n = known.len() - 1;
        let blend = |a: &[f64], b: &[f64], t: f64| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| (a + t * (b - a)).clamp(0.0, 1.0)).collect()
        };
        while n_made < budget {
            // insertion keeps equals in their order
            for i in 1..known.len() {
                let mut j = i;
                while j > 0 && better(&known[j].1, &known[j - 1].1) {
                    known.swap(j, j - 1);
                    j -= 1;
                }
            }
            let size = known[1..]
                .iter()
                .flat_map(|(x, _)| x.iter().zip(&known[0].0).map(|(a, b)| (a - b).abs()))
                .fold(0.0, f64::max);
            if size < 1e-6 {
                break;
            }
            let centre: Vec<f64> =
                (0..n).map(|j| known[..n].iter().map(|(x, _)| x[j]).sum::<f64>() / n as f64).collect();
            let worst = known[n].0.clone();
            let reflected = blend(&worst, &centre, 2.0);
            let Some(m) = of(&reflected, &mut n_made) else { break };
            if better(&m, &known[0].1) {
                let expanded = blend(&worst, &centre, 3.0);
                let Some(e) = of(&expanded, &mut n_made) else { break };
                known[n] = if better(&e, &m) { (expanded, e) } else { (reflected, m) };
            } else if better(&m, &known[n - 1].1) {
                known[n] = (reflected, m);
            } else {
                let contracted = blend(&worst, &centre, if better(&m, &known[n].1) { 1.5 } else { 0.5 });
                let Some(c) = of(&contracted, &mut n_made) else { break };
                if better(&c, &known[n].1) {
                    known[n] = (contracted, c);
                    continue;
                }
                let best = known[0].0.clone();
                for (x, m) in &mut known[1..] {
                    *x = blend(&best, x, 0.5);
                    let Some(found) = of(x, &mut n_made) else { return n_made };
                    *m = found;
                }
            }
        }
        n_made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_minimum_is_found() {
        let mut best = (f64::INFINITY, Vec::new());
        let merit = |x: &[f64]| {
            let f = (x[0] - 0.3) * (x[0] - 0.3) + 5.0 * (x[1] - 0.6) * (x[1] - 0.6);
            if f < best.0 {
                best = (f, x.to_vec());
            }
            Some(f)
        };
        Simplex::new(&[0.9, 0.1], 0.1).search(300, merit, |a, b| a < b);
        assert!((best.1[0] - 0.3).abs() < 1e-4 && (best.1[1] - 0.6).abs() < 1e-4, "{best:?}");
    }
}
