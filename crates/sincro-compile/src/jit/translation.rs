//! A program in the intermediate representation of Cranelift.

use std::collections::BTreeMap;

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::immediates::Ieee64;
use cranelift_codegen::ir::{
    self, AbiParam, FuncRef, InstBuilder, MemFlagsData, SigRef, Signature, StackSlotData, StackSlotKind, Value, types,
};
use cranelift_codegen::isa::{CallConv, TargetFrontendConfig};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use sincro_math::elementary::Binary;
use sincro_math::record::{Operation, Program};

use super::layout::{Angles, Layout, is_in_memory};
use super::order::Part;

/// Addresses of what compiled code calls.
#[derive(Clone, Copy, Debug)]
pub(super) struct Callees {
    /// `(angles, sines, n)`: sines of `n` angles, then their cosines; `n` is a multiple of the number of lanes.
    pub sines: i64,
    /// `(f, x)`: elementary function number `f` of one argument.
    pub unary: i64,
    /// `(f, x, y)`: elementary function number `f` of two arguments.
    pub binary: i64,
}

/// Signature of a compiled program: places of its inputs, parameters and outputs; returns 0 if it does not know them.
pub(super) fn signature(call: CallConv) -> Signature {
    let mut signature = Signature::new(call);
    signature.params = vec![AbiParam::new(types::I64); 3];
    signature.returns = vec![AbiParam::new(types::I64)];
    signature
}

/// Signature of a function of a program: as [`signature`], then the place of the working memory.
pub(super) fn signature_of_function(call: CallConv) -> Signature {
    let mut signature = signature(call);
    signature.params.push(AbiParam::new(types::I64));
    signature
}

/// Writes the body of a program, whose signature is [`signature`], which calls its `functions`.
pub(super) fn translate_calls(
    layout: &Layout,
    functions: &[FuncRef],
    function: &mut ir::Function,
    (context, frontend): (&mut FunctionBuilderContext, TargetFrontendConfig),
) {
    let mut builder = FunctionBuilder::new(function, context);
    let mut arguments = begin(&mut builder);
    // lines of the cache
    let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, 8 * layout.n as u32, 6);
    let slot = builder.create_sized_stack_slot(slot);
    arguments.push(builder.ins().stack_addr(types::I64, slot, 0));
    let mut are_known = builder.ins().iconst(types::I64, 1);
    for function in functions {
        let call = builder.ins().call(*function, &arguments);
        let is_known = builder.inst_results(call)[0];
        are_known = builder.ins().band(are_known, is_known);
    }
    builder.ins().return_(&[are_known]);
    builder.finalize(frontend);
}

/// Writes the body of function `index` of a program, whose signature is [`signature_of_function`].
pub(super) fn translate(
    (program, layout, index): (&Program, &Layout, usize),
    function: &mut ir::Function,
    context: &mut FunctionBuilderContext,
    (callees, frontend): (Callees, TargetFrontendConfig),
) {
    let mut builder = FunctionBuilder::new(function, context);
    let arguments = begin(&mut builder);
    let call = builder.func.signature.call_conv;
    let mut signatures = |n_integers: usize, n_numbers: usize, has_result: bool| {
        let mut of = Signature::new(call);
        of.params = vec![AbiParam::new(types::I64); n_integers];
        of.params.extend(vec![AbiParam::new(types::F64); n_numbers]);
        of.returns = vec![AbiParam::new(types::F64); usize::from(has_result)];
        builder.import_signature(of)
    };
    let signatures = [signatures(3, 0, false), signatures(1, 1, true), signatures(1, 2, true)];
    let values = BTreeMap::new();
    let (inputs, parameters, work) = (arguments[0], arguments[1], arguments[3]);
    let mut body = Body { builder, program, layout, index, inputs, parameters, work, signatures, callees, values };
    let mut undecided: Vec<Value> = Vec::new();
    for part in layout.parts().nth(index).into_iter().flatten() {
        match part {
            Part::Operation(k) => body.operation(*k, &mut undecided),
            Part::Angles(set) => body.sines(*set),
        }
    }
    for (k, &output) in program.outputs().iter().enumerate() {
        if layout.functions[output as usize] == index {
            let value = body.value(output);
            body.builder.ins().store(MemFlagsData::trusted(), value, arguments[2], offset(k));
        }
    }
    let is_decided = body.all_false(&undecided);
    body.builder.ins().return_(&[is_decided]);
    body.builder.finalize(frontend);
}

/// Begins the one block of a function; returns its arguments.
fn begin(builder: &mut FunctionBuilder<'_>) -> Vec<Value> {
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    builder.seal_block(block);
    builder.block_params(block).to_vec()
}

fn offset(k: usize) -> i32 {
    8 * k as i32
}

struct Body<'a> {
    builder: FunctionBuilder<'a>,
    program: &'a Program,
    layout: &'a Layout,
    /// Index of the function.
    index: usize,
    inputs: Value,
    parameters: Value,
    work: Value,
    /// Signatures of [`Callees`], in their order.
    signatures: [SigRef; 3],
    callees: Callees,
    /// Results of the operations of this function that compute something.
    values: BTreeMap<u32, Value>,
}

impl Body<'_> {
    /// Result of operation `k`. What stands in memory is read anew for each use: there are few registers.
    fn value(&mut self, k: u32) -> Value {
        let flags = MemFlagsData::trusted();
        match self.program.operations()[k as usize] {
            Operation::Constant(x) => self.builder.ins().f64const(Ieee64::with_bits(x.to_bits())),
            Operation::Input(i) => self.builder.ins().load(types::F64, flags, self.inputs, offset(i as usize)),
            Operation::Parameter(i) => self.builder.ins().load(types::F64, flags, self.parameters, offset(i as usize)),
            Operation::Sin(angle) => self.sine(angle, 0),
            Operation::Cos(angle) => self.sine(angle, 1),
            _ if self.layout.functions[k as usize] == self.index => self.values[&k],
            _ => {
                let place = self.layout.places[k as usize].expect("a later function needs it");
                self.builder.ins().load(types::F64, flags, self.work, offset(place))
            }
        }
    }

    /// Sine (0) or cosine (1) of an angle.
    fn sine(&mut self, angle: u32, which: usize) -> Value {
        let (set, place) = self.layout.order.places[&angle];
        let Angles { first, n } = self.layout.angles[set];
        let at = offset(first + (1 + which) * n + place);
        self.builder.ins().load(types::F64, MemFlagsData::trusted(), self.work, at)
    }

    /// Finds sines and cosines of the angles of a set; the last is repeated up to a full row of lanes.
    fn sines(&mut self, set: usize) {
        let layout = self.layout;
        let (angles, Angles { first, n }) = (&layout.order.sets[set], layout.angles[set]);
        let values: Vec<Value> = angles.iter().map(|&angle| self.value(angle)).collect();
        for k in 0..n {
            let value = values[k.min(values.len() - 1)];
            self.builder.ins().store(MemFlagsData::trusted(), value, self.work, offset(first + k));
        }
        let from = self.builder.ins().iadd_imm_s(self.work, i64::from(offset(first)));
        let to = self.builder.ins().iadd_imm_s(self.work, i64::from(offset(first + n)));
        let n = self.builder.ins().iconst(types::I64, n as i64);
        self.call(self.signatures[0], self.callees.sines, &[from, to, n]);
    }

    /// Calls the function at an address; its result, if it has one.
    fn call(&mut self, signature: SigRef, address: i64, arguments: &[Value]) -> Option<Value> {
        let callee = self.builder.ins().iconst(types::I64, address);
        let call = self.builder.ins().call_indirect(signature, callee, arguments);
        self.builder.inst_results(call).first().copied()
    }

    /// Computes operation `k`; conditions under which its value depends on the sign of a zero, which programs do not
    /// keep, are added to `undecided`.
    fn operation(&mut self, k: u32, undecided: &mut Vec<Value>) {
        let operation = self.program.operations()[k as usize];
        if is_in_memory(&operation) {
            return;
        }
        let x: Vec<Value> = operation.operands().iter().map(|&x| self.value(x)).collect();
        if let Operation::Binary(Binary::Atan2 | Binary::Pow, ..) = operation {
            let zero = self.builder.ins().f64const(0.0);
            let is_zero = self.builder.ins().fcmp(FloatCC::Equal, x[0], zero);
            let is_not_above = self.builder.ins().fcmp(FloatCC::UnorderedOrLessThanOrEqual, x[1], zero);
            undecided.push(self.builder.ins().band(is_zero, is_not_above));
        }
        let ins = self.builder.ins();
        let value = match operation {
            Operation::Add(..) => ins.fadd(x[0], x[1]),
            Operation::Sub(..) => ins.fsub(x[0], x[1]),
            Operation::Mul(..) => ins.fmul(x[0], x[1]),
            Operation::Div(..) => ins.fdiv(x[0], x[1]),
            Operation::Neg(_) => ins.fneg(x[0]),
            Operation::Sqrt(_) => ins.sqrt(x[0]),
            Operation::Abs(_) => ins.fabs(x[0]),
            Operation::CopySign(..) => ins.fcopysign(x[0], x[1]),
            Operation::IfLess(_) => {
                let is_less = ins.fcmp(FloatCC::LessThan, x[0], x[1]);
                self.builder.ins().select(is_less, x[2], x[3])
            }
            Operation::IfOdd(_) => {
                let lowest = self.shifted(x[0], 63);
                self.builder.ins().select(lowest, x[1], x[2])
            }
            Operation::FlipBy { bit, .. } => {
                let sign = self.shifted(x[1], 63 - i64::from(bit));
                let bits = self.builder.ins().bitcast(types::I64, MemFlagsData::new(), x[0]);
                let flipped = self.builder.ins().bxor(bits, sign);
                self.builder.ins().bitcast(types::F64, MemFlagsData::new(), flipped)
            }
            Operation::Unary(f, _) => {
                let f = self.builder.ins().iconst(types::I64, f as i64);
                self.call(self.signatures[1], self.callees.unary, &[f, x[0]]).expect("it returns a number")
            }
            Operation::Binary(f, ..) => {
                let f = self.builder.ins().iconst(types::I64, f as i64);
                self.call(self.signatures[2], self.callees.binary, &[f, x[0], x[1]]).expect("it returns a number")
            }
            Operation::Constant(_)
            | Operation::Input(_)
            | Operation::Parameter(_)
            | Operation::Sin(_)
            | Operation::Cos(_) => unreachable!("they stand in memory"),
        };
        self.values.insert(k, value);
        if let Some(place) = self.layout.places[k as usize] {
            self.builder.ins().store(MemFlagsData::trusted(), value, self.work, offset(place));
        }
    }

    /// Bits of a number shifted to the left by `n`, the sign alone kept.
    fn shifted(&mut self, x: Value, n: i64) -> Value {
        let bits = self.builder.ins().bitcast(types::I64, MemFlagsData::new(), x);
        let shifted = self.builder.ins().ishl_imm_u(bits, n);
        self.builder.ins().band_imm_s(shifted, i64::MIN)
    }

    /// 1 if no condition holds, else 0.
    fn all_false(&mut self, conditions: &[Value]) -> Value {
        let mut any = self.builder.ins().iconst(types::I8, 0);
        for condition in conditions {
            any = self.builder.ins().bor(any, *condition);
        }
        let is_none = self.builder.ins().icmp_imm_u(ir::condcodes::IntCC::Equal, any, 0);
        self.builder.ins().uextend(types::I64, is_none)
    }
}
