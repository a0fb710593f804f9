//! Machine code of programs: the one module that makes and calls it.

// compiled code is called through pointers, and calls back through them; this crate is built without optimisation, so
// that all that takes time in such a call is inlined into others, or stands in `sincro_math`
#![allow(unsafe_code)]

use std::sync::Mutex;

use cranelift_codegen::Context;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::FunctionBuilderContext;
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Module, default_libcall_names};
use sincro_math::Real;
use sincro_math::elementary::{Binary, Unary};
use sincro_math::lanes;
use sincro_math::record::Program;

use super::layout::Layout;
use super::translation::{Callees, signature, signature_of_function, translate, translate_calls};
use crate::native::INPUT_LIMIT;

/// Function on places of inputs, parameters and outputs; 0 if it does not know the inputs.
type Signature = unsafe extern "C" fn(*const f64, *const f64, *mut f64) -> i64;

/// Function of a [`Code`], which must outlive it.
#[derive(Clone, Copy)]
pub(super) struct Function(Signature);

/// Machine code in memory of its own, given back at its end.
pub(super) struct Code(Mutex<Option<JITModule>>);

impl Code {
    /// Compiles programs, and returns their functions in their order.
    pub fn new(programs: &[&Program]) -> Result<(Self, Vec<Function>), String> {
        let mut flags = settings::builder();
        // programs have no operation twice: what the optimiser would find is not worth its time
        let known = [("opt_level", "none"), ("enable_verifier", "false"), ("is_pic", "false")];
        // the working memory of a long program is longer than a page of the stack
        let probes = [("enable_probestack", "true"), ("probestack_strategy", "inline")];
        for (name, value) in known.into_iter().chain(probes) {
            flags.set(name, value).map_err(failed)?;
        }
        let isa = cranelift_native::builder().map_err(failed)?;
        let isa = isa.finish(settings::Flags::new(flags)).map_err(failed)?;
        let (call, frontend) = (isa.default_call_conv(), isa.frontend_config());
        let mut module = JITModule::new(JITBuilder::with_isa(isa, default_libcall_names()));
        let callees = Callees {
            sines: sines as *const () as i64,
            unary: unary as *const () as i64,
            binary: binary as *const () as i64,
        };
        let (mut context, mut builder_context) = (Context::new(), FunctionBuilderContext::new());
        let mut functions = Vec::new();
        for program in programs {
            let layout = Layout::new(program, lanes::width());
            let mut parts = Vec::new();
            for index in 0..layout.parts().len() {
                context.func.signature = signature_of_function(call);
                let part = (*program, &layout, index);
                translate(part, &mut context.func, &mut builder_context, (callees, frontend));
                parts.push(define(&mut module, &mut context)?);
            }
            context.func.signature = signature(call);
            let parts: Vec<_> =
                parts.into_iter().map(|part| module.declare_func_in_func(part, &mut context.func)).collect();
            translate_calls(&layout, &parts, &mut context.func, (&mut builder_context, frontend));
            functions.push(define(&mut module, &mut context)?);
        }
        module.finalize_definitions().map_err(failed)?;
        let of = |id| {
            let address = module.get_finalized_function(id);
            // SAFETY: the function at this address was translated with this signature, and it is finished
            Function(unsafe { core::mem::transmute::<*const u8, Signature>(address) })
        };
        let functions = functions.into_iter().map(of).collect();
        Ok((Self(Mutex::new(Some(module))), functions))
    }

    /// Calls a function of this code; the callers have checked the lengths. Returns false if it does not have the bits
    /// of its program.
    #[inline]
    pub fn call(&self, Function(f): Function, inputs: &[f64], parameters: &[f64], outputs: &mut [f64]) -> bool {
        // not one after the other: the comparisons are made in lanes
        let are_known = inputs.iter().fold(true, |known, x| known & (x.abs() < INPUT_LIMIT));
        if !are_known {
            return false;
        }
        // SAFETY: the code is in memory while `self` lives; the function reads and writes within the arrays alone
        let is_decided = unsafe { f(inputs.as_ptr(), parameters.as_ptr(), outputs.as_mut_ptr()) };
        is_decided != 0 && outputs.iter().fold(true, |finite, x| finite & x.is_finite())
    }
}

fn failed(error: impl std::fmt::Display) -> String {
    format!("Cranelift fails: {error}")
}

/// Compiles the function in `context`, and clears that.
fn define(module: &mut JITModule, context: &mut Context) -> Result<FuncId, String> {
    let id = module.declare_anonymous_function(&context.func.signature).map_err(failed)?;
    module.define_function(id, context).map_err(failed)?;
    module.clear_context(context);
    Ok(id)
}

impl Drop for Code {
    fn drop(&mut self) {
        let module = self.0.get_mut().ok().and_then(Option::take);
        if let Some(module) = module {
            // SAFETY: whoever has a function of this code has the code too, which nobody has any more
            unsafe { module.free_memory() };
        }
    }
}

/// Sines of `n` angles at `angles`, then their cosines, to `to`.
extern "C" fn sines(angles: *const f64, to: *mut f64, n: usize) {
    // SAFETY: compiled code calls it with places of these lengths on its stack; the angles are written, and the sines
    // are numbers whatever stands there
    let (angles, to) = unsafe { (core::slice::from_raw_parts(angles, n), core::slice::from_raw_parts_mut(to, 2 * n)) };
    lanes::sines_and_cosines(angles, to);
}

extern "C" fn unary(f: usize, x: f64) -> f64 {
    x.unary(Unary::ALL[f])
}

extern "C" fn binary(f: usize, x: f64, y: f64) -> f64 {
    x.binary(Binary::ALL[f], y)
}
