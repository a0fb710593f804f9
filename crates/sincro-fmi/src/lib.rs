//! Shared library of exported FMUs: the C interface of FMI 2.0 and 3.0.
//!
//! One library serves all scenes. Everything that simulates is in [`sincro_fmu`]; here, pointers become slices and
//! texts, calls are checked against the order that the standard asks for, and panics are caught. An instance and a
//! saved state are numbers that an importer keeps in place of pointers: one that was freed, or never was, is an error
//! of the call, and the importer lives on.
//!
//! | modules | hold |
//! |---|---|
//! | `fmi2`, `fmi3` | the functions of the two versions |
//! | `component` | an instance with its mode: which call may be made when |
//! | `registry` | all instances of the process by their numbers |
//! | `log`, `pointers` | messages to the importer, pointers of C |

// the interface is one of C pointers: this crate and the loader of foreign FMUs are the places that dereference them
#![allow(unsafe_code)]

mod component;
mod fmi2;
mod fmi3;
mod log;
mod pointers;
mod registry;

#[cfg(test)]
mod tests;
