//! Values of variables, of all numeric types, as `f64`.

use super::super::description::NumberKind;
use super::{Component, Functions, Handle, Status};
use crate::description::FmiVersion;

/// Evaluates `$body` with `$number` as the Rust type of an integer or of a short real number.
macro_rules! with_number {
    ($kind:expr, $number:ident => $body:expr) => {
        match $kind {
            NumberKind::Float32 => {
                type $number = f32;
                $body
            }
            NumberKind::Int8 => {
                type $number = i8;
                $body
            }
            NumberKind::UInt8 => {
                type $number = u8;
                $body
            }
            NumberKind::Int16 => {
                type $number = i16;
                $body
            }
            NumberKind::UInt16 => {
                type $number = u16;
                $body
            }
            NumberKind::Int32 => {
                type $number = i32;
                $body
            }
            NumberKind::UInt32 => {
                type $number = u32;
                $body
            }
            NumberKind::Int64 => {
                type $number = i64;
                $body
            }
            NumberKind::UInt64 => {
                type $number = u64;
                $body
            }
            NumberKind::Float64 | NumberKind::Boolean => unreachable!("these are taken before"),
        }
    };
}

impl Functions {
    /// Reads variables of one type, arrays whole: `values` has a place for each number.
    pub(in super::super) fn get(
        &self,
        c: Component,
        kind: NumberKind,
        references: &[u32],
        values: &mut [f64],
    ) -> Result<(), String> {
        let name = self.name_of(kind, "Get");
        match (kind, self.version) {
            (NumberKind::Float64, _) => self.get_as(c, &name, references, values, |x: f64| x),
            (NumberKind::Boolean, FmiVersion::V2) => self.get_as(c, &name, references, values, |x: i32| truth(x != 0)),
            (NumberKind::Boolean, FmiVersion::V3) => self.get_as(c, &name, references, values, |x: u8| truth(x != 0)),
            _ => with_number!(kind, Number => self.get_as(c, &name, references, values, |x: Number| x as f64)),
        }
    }

    fn get_as<T: Copy + Default>(
        &self,
        c: Component,
        name: &str,
        references: &[u32],
        values: &mut [f64],
        convert: impl Fn(T) -> f64,
    ) -> Result<(), String> {
        let mut numbers = vec![T::default(); values.len()];
        let (r, n, x, m) = (references.as_ptr(), references.len(), numbers.as_mut_ptr(), values.len());
        let status = match self.version {
            FmiVersion::V2 => {
                type Get<T> = unsafe extern "C" fn(Handle, *const u32, usize, *mut T) -> Status;
                // SAFETY: a place for each reference, as version 2 has no arrays
                unsafe { self.find::<Get<T>>(name)?(c.0, r, n.min(m), x) }
            }
            FmiVersion::V3 => {
                type Get<T> = unsafe extern "C" fn(Handle, *const u32, usize, *mut T, usize) -> Status;
                // SAFETY: as many places as the call is told
                unsafe { self.find::<Get<T>>(name)?(c.0, r, n, x, m) }
            }
        };
        Self::check(name, status)?;
        values.iter_mut().zip(numbers).for_each(|(value, number)| *value = convert(number));
        Ok(())
    }

    /// Sets variables of one type, arrays whole: integers are rounded, and cut off at the bounds of their type.
    pub(in super::super) fn set(
        &self,
        c: Component,
        kind: NumberKind,
        references: &[u32],
        values: &[f64],
    ) -> Result<(), String> {
        let name = self.name_of(kind, "Set");
        match (kind, self.version) {
            (NumberKind::Float64, _) => self.set_as(c, &name, references, values),
            (NumberKind::Float32, _) => {
                let numbers: Vec<f32> = values.iter().map(|x| *x as f32).collect();
                self.set_as(c, &name, references, &numbers)
            }
            (NumberKind::Boolean, FmiVersion::V2) => {
                let numbers: Vec<i32> = values.iter().map(|x| i32::from(*x != 0.0)).collect();
                self.set_as(c, &name, references, &numbers)
            }
            (NumberKind::Boolean, FmiVersion::V3) => {
                let numbers: Vec<u8> = values.iter().map(|x| u8::from(*x != 0.0)).collect();
                self.set_as(c, &name, references, &numbers)
            }
            _ => with_number!(kind, Number => {
                let numbers: Vec<Number> = values.iter().map(|x| x.round() as Number).collect();
                self.set_as(c, &name, references, &numbers)
            }),
        }
    }

    fn set_as<T: Copy>(&self, c: Component, name: &str, references: &[u32], values: &[T]) -> Result<(), String> {
        let (r, n, x, m) = (references.as_ptr(), references.len(), values.as_ptr(), values.len());
        let status = match self.version {
            FmiVersion::V2 => {
                type Set<T> = unsafe extern "C" fn(Handle, *const u32, usize, *const T) -> Status;
                // SAFETY: a value for each reference, as version 2 has no arrays
                unsafe { self.find::<Set<T>>(name)?(c.0, r, n.min(m), x) }
            }
            FmiVersion::V3 => {
                type Set<T> = unsafe extern "C" fn(Handle, *const u32, usize, *const T, usize) -> Status;
                // SAFETY: as many values as the call is told
                unsafe { self.find::<Set<T>>(name)?(c.0, r, n, x, m) }
            }
        };
        Self::check(name, status)
    }

    /// Name of the function for a type, without its prefix.
    fn name_of(&self, kind: NumberKind, verb: &str) -> String {
        match (self.version, kind) {
            (_, NumberKind::Boolean) => format!("{verb}Boolean"),
            (FmiVersion::V2, NumberKind::Float64 | NumberKind::Float32) => format!("{verb}Real"),
            (FmiVersion::V2, _) => format!("{verb}Integer"),
            (FmiVersion::V3, kind) => format!("{verb}{kind:?}"),
        }
    }
}

fn truth(x: bool) -> f64 {
    f64::from(u8::from(x))
}
