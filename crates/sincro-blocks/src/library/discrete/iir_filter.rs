//! `a[0]·y[k] = Σ b[j]·u[k−j] − Σ a[j]·y[k−j]`, or such sections one behind the other.
//!
//! Every section is a recursion in direct form II transposed, as in `discrete-transfer-function`; here polynomials are
//! in powers of z⁻¹, as MATLAB's `filter(b, a, u)` and `sosfilt` take them.

use crate::library::continuous::Rational;
use crate::library::prelude::*;

/// Block `iir-filter`: recursive digital filter, a cascade of sections. A vector is processed component by component.
#[derive(Clone, Debug, PartialEq)]
pub struct IirFilter {
    /// Sections in the order in which the signal passes them, each a quotient of polynomials in z (dimensionless).
    pub sections: Vec<Rational>,
}

impl IirFilter {
    /// Creates a filter of one section, `a[0]·y[k] = Σ b[j]·u[k−j] − Σ a[j]·y[k−j]`, from the coefficients of 1, z⁻¹,
    /// z⁻² … as MATLAB's `filter(b, a, u)` takes them (dimensionless).
    ///
    /// # Errors
    ///
    /// A message, if `a[0]` is zero or missing.
    pub fn new(b: &[f64], a: &[f64]) -> Result<Self, String> {
        Ok(Self { sections: vec![section(b, a)?] })
    }

    /// Numbers of memory for one component.
    fn n_kept(&self) -> usize {
        self.sections.iter().map(Rational::order).sum()
    }
}

/// From powers of z⁻¹ to powers of z: both are multiplied by the highest power.
fn section(b: &[f64], a: &[f64]) -> Result<Rational, String> {
    if a.first().is_none_or(|first| *first == 0.0) {
        return Err("the first coefficient of `a` is 0".into());
    }
    let n = b.len().max(a.len());
    let padded = |list: &[f64]| {
        let mut list = list.to_vec();
        list.resize(n, 0.0);
        list
    };
    Rational::new(&padded(b), &padded(a))
}

impl Described for IirFilter {
    const KIND: &'static Kind = &Kind {
        name: "iir-filter",
        category: Category::Discrete,
        summary: "A recursive filter, given by its coefficients or by sections of second order.",
        equation: "a[0]·y[k] = Σ b[j]·u[k−j] − Σ a[j]·y[k−j]",
        parameters: &[
            Parameter::optional("b", ValueKind::Numbers, "coefficients of u[k], u[k−1] …", "1"),
            Parameter::optional("a", ValueKind::Numbers, "coefficients of y[k], y[k−1] …", "1"),
            Parameter::optional(
                "sections",
                ValueKind::Matrix,
                "instead of b and a: a row b0, b1, b2, a0, a1, a2 for each section",
                "[]",
            ),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let help = "it is the factor of the present output, usually 1";
        let nothing = || section(&[1.0], &[1.0]).expect("a filter that does nothing");
        if !p.has("sections") {
            let (b, a) = (p.numbers("b"), p.numbers("a"));
            let section = section(&b, &a).unwrap_or_else(|words| {
                p.fault("a", words, help);
                nothing()
            });
            return Self { sections: vec![section] };
        }
        if p.has("a") || p.has("b") {
            p.fault("sections", "both `sections` and coefficients are given", "leave `sections` or `a` and `b` out");
        }
        let rows = p.matrix("sections");
        if rows.columns != 6 {
            let message = format!("a row of `sections` has {} numbers", rows.columns);
            p.fault("sections", message, "it has b0, b1, b2, a0, a1, a2");
            return Self { sections: vec![nothing()] };
        }
        let mut sections = Vec::new();
        for (k, row) in rows.entries.chunks_exact(6).enumerate() {
            sections.push(section(&row[..3], &row[3..]).unwrap_or_else(|words| {
                p.fault_at(&["sections", &k.to_string()], None, words, help);
                nothing()
            }));
        }
        Self { sections }
    }
}

impl Block for IirFilter {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        self.sections.iter().all(|section| section.b(0) != 0.0)
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() * self.n_kept() }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (n, is_read) = (self.n_kept(), Block::has_direct_feedthrough(self, 0));
        for (i, y) in y.iter_mut().enumerate() {
            let mut kept = &at.memory[i * n..(i + 1) * n];
            // without direct feedthrough, some section passes on nothing of it
            let mut x = if is_read { at.component(0, i) } else { R::zero() };
            for section in &self.sections {
                x = present(section, x, kept);
                kept = &kept[section.order()..];
            }
            *y = x;
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        let n = self.n_kept();
        for i in 0..at.node.n_out() {
            let (mut x, mut from) = (at.component(0, i), i * n);
            for section in &self.sections {
                let old = &at.memory[from..from + section.order()];
                let y = present(section, x, old);
                for j in 0..section.order() {
                    let own = R::splat(section.b(j + 1)) * x - R::splat(section.a(j + 1)) * y;
                    memory[from + j] = if j + 1 < old.len() { own + old[j + 1] } else { own };
                }
                x = y;
                from += section.order();
            }
        }
    }

    fn label(&self) -> String {
        format!("IIR {}", self.n_kept())
    }
}

/// The present output of a section.
#[inline(always)]
fn present<R: Real>(section: &Rational, x: R, kept: &[R]) -> R {
    let own = if section.b(0) == 0.0 { R::zero() } else { R::splat(section.b(0)) * x };
    if section.order() == 0 { own } else { own + kept[0] }
}
