//! A program in the intermediate representation of Cranelift.

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::immediates::Ieee64;
use cranelift_codegen::ir::{
    self, AbiParam, InstBuilder, MemFlagsData, SigRef, Signature, StackSlotData, StackSlotKind, Value, types,
};
use cranelift_codegen::isa::{CallConv, TargetFrontendConfig};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use sincro_math::elementary::Binary;
use sincro_math::record::{Operation, Program};

use super::order::{Order, Part};

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

/// Writes the body of `function`, whose signature is [`signature`].
pub(super) fn translate(
    program: &Program,
    function: &mut ir::Function,
    context: &mut FunctionBuilderContext,
    (callees, frontend): (Callees, TargetFrontendConfig),
) {
    let order = Order::new(program);
    let mut builder = FunctionBuilder::new(function, context);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    builder.seal_block(block);
    let places = builder.block_params(block).to_vec();
    let call = builder.func.signature.call_conv;
    let width = sincro_math::lanes::width();
    // angles of each set, then their sines, then their cosines; whole rows of lanes
    let mut n = 0;
    let mut slots = Vec::new();
    for angles in &order.sets {
        slots.push(Slots { first: n, n: angles.len().next_multiple_of(width) });
        n += 3 * angles.len().next_multiple_of(width);
    }
    // lines of the cache
    let slot = builder.create_sized_stack_slot(StackSlotData::new(StackSlotKind::ExplicitSlot, 8 * n as u32, 6));
    let work = builder.ins().stack_addr(types::I64, slot, 0);
    let mut signatures = |n_integers: usize, n_numbers: usize, has_result: bool| {
        let mut of = Signature::new(call);
        of.params = vec![AbiParam::new(types::I64); n_integers];
        of.params.extend(vec![AbiParam::new(types::F64); n_numbers]);
        of.returns = vec![AbiParam::new(types::F64); usize::from(has_result)];
        builder.import_signature(of)
    };
    let signatures = [signatures(3, 0, false), signatures(1, 1, true), signatures(1, 2, true)];
    let values = vec![None; program.operations().len()];
    let (inputs, parameters) = (places[0], places[1]);
    let mut body =
        Body { builder, program, order: &order, inputs, parameters, work, slots, signatures, callees, values };
    let mut undecided: Vec<Value> = Vec::new();
    for part in &order.parts {
        match part {
            Part::Operation(k) => body.operation(*k, &mut undecided),
            Part::Angles(set) => body.sines(*set),
        }
    }
    for (k, &output) in program.outputs().iter().enumerate() {
        let value = body.value(output);
        body.builder.ins().store(MemFlagsData::trusted(), value, places[2], offset(k));
    }
    let is_decided = body.all_false(&undecided);
    body.builder.ins().return_(&[is_decided]);
    body.builder.finalize(frontend);
}

/// Place of the angles of a set in the working memory, behind which their sines and their cosines stand.
#[derive(Clone, Copy)]
struct Slots {
    first: usize,
    n: usize,
}

fn offset(k: usize) -> i32 {
    8 * k as i32
}

struct Body<'a> {
    builder: FunctionBuilder<'a>,
    program: &'a Program,
    order: &'a Order,
    inputs: Value,
    parameters: Value,
    /// Working memory.
    work: Value,
    slots: Vec<Slots>,
    /// Signatures of [`Callees`], in their order.
    signatures: [SigRef; 3],
    callees: Callees,
    /// Results of the operations that compute something.
    values: Vec<Option<Value>>,
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
            _ => self.values[k as usize].expect("operands come before what needs them"),
        }
    }

    /// Sine (0) or cosine (1) of an angle.
    fn sine(&mut self, angle: u32, which: usize) -> Value {
        let (set, place) = self.order.places[&angle];
        let Slots { first, n } = self.slots[set];
        let at = offset(first + (1 + which) * n + place);
        self.builder.ins().load(types::F64, MemFlagsData::trusted(), self.work, at)
    }

    /// Finds sines and cosines of the angles of a set; the last is repeated up to a full row of lanes.
    fn sines(&mut self, set: usize) {
        let order = self.order;
        let (angles, Slots { first, n }) = (&order.sets[set], self.slots[set]);
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
        if matches!(
            operation,
            Operation::Constant(_)
                | Operation::Input(_)
                | Operation::Parameter(_)
                | Operation::Sin(_)
                | Operation::Cos(_)
        ) {
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
        self.values[k as usize] = Some(value);
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
