//! Runs the text of generated shader functions without a GPU, and counts their operations. naga parses and
//! validates the text; each value of its module then becomes a run of 32-bit words in one memory, so that an
//! access copies only the words that it names. The arithmetic is `f32`, operation by operation, as Rust rounds
//! it. This module knows the language of shaders and nothing of the generator.
//! One file: one evaluator, its values, built-in functions and statements.

use std::fmt::Debug;

use naga::front::{glsl, wgsl};
use naga::valid::{Capabilities, FunctionInfo, ValidationFlags, Validator};
use naga::{
    AddressSpace, Arena, ArraySize, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal,
    MathFunction, Module, Scalar, ShaderStage, Statement, Type, TypeInner, UnaryOperator, UniqueArena,
};

/// A loop that runs longer than this is an error, so that a test of a wrong loop ends.
const LONGEST_LOOP: u32 = 1 << 20;

/// An argument or a result of a shader function.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A float.
    F32(f32),
    /// A signed integer.
    I32(i32),
    /// An unsigned integer.
    U32(u32),
    /// A truth value.
    Bool(bool),
    /// A vector of two to four floats.
    Vec(Vec<f32>),
    /// An array of values of one type.
    Array(Vec<Value>),
    /// A matrix, as its columns.
    Mat(Vec<Vec<f32>>),
}

/// The language of a shader's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// WGSL, with or without an entry point.
    Wgsl,
    /// GLSL 4.50 functions, with neither `#version` nor `main`.
    Glsl,
}

/// What the built-in function `fma(a, b, c)` does: a driver may choose either.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fma {
    /// One rounding, `f32::mul_add`.
    Fused,
    /// Two roundings, `a * b + c`.
    Separate,
}

/// The float operations that calls executed; an operation on a vector counts once a component.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Multiplications.
    pub mul: u64,
    /// Additions and subtractions; a change of sign is free.
    pub add: u64,
    /// Calls of `fma`, fused or not.
    pub fma: u64,
    /// Calls of `min` and `max`, two of them for a `clamp`, and selections; a comparison and `abs` are free.
    pub choice: u64,
    /// Divisions, `sqrt`, `inverseSqrt`, `exp2` and `log2`.
    pub special: u64,
}

/// A parsed and validated text, ready to run.
pub struct Shader {
    module: Module,
    /// The memory of each function, in the order of `module.functions`, or why it cannot run.
    frames: Vec<Result<Frame, String>>,
    /// The words of its private variables.
    global_words: usize,
}

/// Where private variables lie, at the start of a call's memory.
type Globals = Vec<(Handle<GlobalVariable>, usize)>;

/// The private variables of a module, which are zero at first, and how many words they take.
fn globals(module: &Module) -> Result<(Globals, usize), String> {
    let (mut places, mut next) = (Vec::new(), 0);
    for (handle, global) in module.global_variables.iter() {
        if global.space == AddressSpace::Private && global.init.is_none() {
            places.push((handle, next));
            next += Shape::of(&module.types, &module.types[global.ty].inner)?.words;
        }
    }
    Ok((places, next))
}

impl Shader {
    /// Parses and validates a text. What the evaluator does not support is an error of [`Shader::call`] alone, so
    /// that one such function does not hide the others.
    pub fn parse(language: Language, text: &str) -> Result<Shader, String> {
        let wrapped;
        let (module, source) = match language {
            Language::Wgsl => (wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?, text),
            Language::Glsl => {
                wrapped = format!("#version 450\n{text}\nvoid main() {{}}\n");
                let module = glsl::Frontend::default()
                    .parse(&glsl::Options::from(ShaderStage::Compute), &wrapped)
                    .map_err(|errors| errors.emit_to_string(&wrapped))?;
                (module, wrapped.as_str())
            }
        };
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .map_err(|error| error.emit_to_string(source))?;
        let (globals, global_words) = globals(&module)?;
        let frame = |(handle, function)| Frame::new(&module, function, &info[handle], &globals);
        let frames = module.functions.iter().map(frame).collect();
        Ok(Shader { module, frames, global_words })
    }

    /// The names of the functions, callees before callers, entry points left out; overloads of one name repeat it.
    pub fn functions(&self) -> Vec<String> {
        let is_entry = |name: &String| self.module.entry_points.iter().any(|e| e.name == *name);
        let names = self.module.functions.iter().filter_map(|(_, f)| f.name.clone());
        names.filter(|name| !is_entry(name)).collect()
    }

    /// Calls a function, and adds what it executes to `counts`. Of overloads, the one that takes these arguments runs.
    pub fn call(&self, function: &str, args: &[Value], counts: &mut Counts, fma: Fma) -> Result<Value, String> {
        let functions = self.module.functions.iter();
        let mut overloads = functions.filter(|(_, f)| f.name.as_deref() == Some(function)).peekable();
        if overloads.peek().is_none() {
            let known = self.functions().join("`, `");
            return Err(format!("no function `{function}`; there are `{known}`"));
        }
        let (handle, words) = overloads
            .find_map(|(handle, f)| Some((handle, self.encode_arguments(f, args)?)))
            .ok_or_else(|| format!("no `{function}` takes arguments of these types"))?;
        let result = self.module.functions[handle].result.as_ref();
        let ty = result.ok_or_else(|| format!("`{function}` returns nothing"))?.ty;
        let mut machine = Machine { shader: self, memory: vec![0; self.global_words], counts, fma };
        machine
            .invoke(handle, &words)
            .and_then(|words| self.decode(ty, &words))
            .map_err(|error| format!("`{function}`: {error}"))
    }

    fn encode_arguments(&self, function: &Function, args: &[Value]) -> Option<Vec<u32>> {
        let mut words = Vec::new();
        if function.arguments.len() != args.len() {
            return None;
        }
        for (argument, value) in function.arguments.iter().zip(args) {
            self.encode(argument.ty, value, &mut words)?;
        }
        Some(words)
    }

    fn encode(&self, ty: Handle<Type>, value: &Value, words: &mut Vec<u32>) -> Option<()> {
        match (&self.module.types[ty].inner, value) {
            (&TypeInner::Scalar(Scalar::F32), Value::F32(x)) => words.push(x.to_bits()),
            (&TypeInner::Scalar(Scalar::I32), Value::I32(x)) => words.push(*x as u32),
            (&TypeInner::Scalar(Scalar::U32), Value::U32(x)) => words.push(*x),
            (&TypeInner::Scalar(Scalar::BOOL), Value::Bool(x)) => words.push(u32::from(*x)),
            (&TypeInner::Vector { size, scalar: Scalar::F32 }, Value::Vec(xs)) if xs.len() == size as usize => {
                words.extend(xs.iter().map(|x| x.to_bits()));
            }
            (&TypeInner::Matrix { columns, rows, scalar: Scalar::F32 }, Value::Mat(m))
                if m.len() == columns as usize && m.iter().all(|c| c.len() == rows as usize) =>
            {
                words.extend(m.iter().flatten().map(|x| x.to_bits()));
            }
            (&TypeInner::Array { base, size: ArraySize::Constant(count), .. }, Value::Array(xs))
                if xs.len() == count.get() as usize =>
            {
                for x in xs {
                    self.encode(base, x, words)?;
                }
            }
            _ => return None,
        }
        Some(())
    }

    fn decode(&self, ty: Handle<Type>, words: &[u32]) -> Result<Value, String> {
        let floats = |words: &[u32]| words.iter().copied().map(f32::from_bits).collect();
        Ok(match (&self.module.types[ty].inner, words) {
            (&TypeInner::Scalar(Scalar::F32), &[x]) => Value::F32(f32::from_bits(x)),
            (&TypeInner::Scalar(Scalar::I32), &[x]) => Value::I32(x as i32),
            (&TypeInner::Scalar(Scalar::U32), &[x]) => Value::U32(x),
            (&TypeInner::Scalar(Scalar::BOOL), &[x]) => Value::Bool(x != 0),
            (&TypeInner::Vector { scalar: Scalar::F32, .. }, _) => Value::Vec(floats(words)),
            (&TypeInner::Matrix { rows, scalar: Scalar::F32, .. }, _) => {
                Value::Mat(words.chunks(rows as usize).map(floats).collect())
            }
            (&TypeInner::Array { base, size: ArraySize::Constant(count), .. }, _) => {
                let items = words.chunks(words.len() / count.get() as usize);
                Value::Array(items.map(|item| self.decode(base, item)).collect::<Result<_, _>>()?)
            }
            (inner, _) => return Err(format!("a result of type {inner:?} is not supported")),
        })
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Float,
    Sint,
    Uint,
    Bool,
    Matrix,
    Array,
    Pointer,
}

/// A type, seen as words. A pointer is one word, and carries the stride and count of what it points at.
#[derive(Clone, Copy)]
struct Shape {
    /// Of a vector, the kind of its components.
    kind: Kind,
    words: usize,
    /// The words of one element, where there are elements.
    stride: usize,
    count: usize,
}

impl Shape {
    fn of(types: &UniqueArena<Type>, inner: &TypeInner) -> Result<Shape, String> {
        let scalar = |scalar: Scalar| match scalar {
            Scalar::F32 => Ok(Kind::Float),
            Scalar::I32 => Ok(Kind::Sint),
            Scalar::U32 => Ok(Kind::Uint),
            Scalar::BOOL => Ok(Kind::Bool),
            other => Err(format!("a scalar of type {other:?} is not supported")),
        };
        let shape = |kind, stride, count| Shape { kind, words: stride * count, stride, count };
        Ok(match *inner {
            TypeInner::Scalar(s) => shape(scalar(s)?, 1, 1),
            TypeInner::Vector { size, scalar: s } => shape(scalar(s)?, 1, size as usize),
            TypeInner::Matrix { columns, rows, scalar: Scalar::F32 } => {
                shape(Kind::Matrix, rows as usize, columns as usize)
            }
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                let item = Shape::of(types, &types[base].inner)?;
                shape(Kind::Array, item.words, count.get() as usize)
            }
            TypeInner::Pointer { base, .. } => {
                let target = Shape::of(types, &types[base].inner)?;
                Shape { kind: Kind::Pointer, words: 1, ..target }
            }
            TypeInner::ValuePointer { size, .. } => {
                let count = size.map_or(1, |size| size as usize);
                Shape { kind: Kind::Pointer, words: 1, stride: 1, count }
            }
            _ => return Err(format!("a value of type {inner:?} is not supported")),
        })
    }
}

/// Where an expression's words lie, and what they are.
#[derive(Clone, Copy)]
struct Slot {
    at: usize,
    shape: Shape,
}

/// The memory of one call of a function: arguments, then local variables, then one slot an expression.
struct Frame {
    /// The memory as the call begins, with constants in their slots.
    words: Vec<u32>,
    /// The slot of each expression.
    slots: Vec<Slot>,
    /// The words that hold a pointer to a local variable, each with the place of that variable.
    pointers: Vec<(usize, usize)>,
}

impl Frame {
    fn new(module: &Module, function: &Function, info: &FunctionInfo, globals: &Globals) -> Result<Frame, String> {
        let types = &module.types;
        let mut words = Vec::new();
        let mut arguments = Vec::new();
        for argument in &function.arguments {
            arguments.push(words.len());
            words.resize(words.len() + Shape::of(types, &types[argument.ty].inner)?.words, 0);
        }
        let mut locals = Vec::new();
        for (_, local) in function.local_variables.iter() {
            locals.push(words.len());
            match local.init {
                Some(init) => words.extend(constant(module, &function.expressions, init)?),
                None => words.resize(words.len() + Shape::of(types, &types[local.ty].inner)?.words, 0),
            }
        }
        let mut slots = Vec::new();
        let mut pointers = Vec::new();
        for (handle, expression) in function.expressions.iter() {
            let shape = Shape::of(types, info[handle].ty.inner_with(types))?;
            let mut at = words.len();
            match *expression {
                Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => {
                    words.extend(constant(module, &function.expressions, handle)?);
                }
                Expression::FunctionArgument(index) => at = arguments[index as usize],
                Expression::LocalVariable(local) => {
                    pointers.push((at, locals[local.index()]));
                    words.push(0);
                }
                Expression::GlobalVariable(global) => {
                    let place = globals.iter().find(|(known, _)| *known == global);
                    words.push(place.ok_or_else(|| unsupported(expression))?.1 as u32);
                }
                Expression::Override(_) => return Err(unsupported(expression)),
                _ => words.resize(at + shape.words, 0),
            }
            slots.push(Slot { at, shape });
        }
        Ok(Frame { words, slots, pointers })
    }
}

/// The words of a constant expression.
fn constant(module: &Module, expressions: &Arena<Expression>, handle: Handle<Expression>) -> Result<Vec<u32>, String> {
    Ok(match expressions[handle] {
        Expression::Literal(Literal::F32(x)) => vec![x.to_bits()],
        Expression::Literal(Literal::I32(x)) => vec![x as u32],
        Expression::Literal(Literal::U32(x)) => vec![x],
        Expression::Literal(Literal::Bool(x)) => vec![u32::from(x)],
        Expression::Constant(named) => constant(module, &module.global_expressions, module.constants[named].init)?,
        Expression::ZeroValue(ty) => {
            vec![0; Shape::of(&module.types, &module.types[ty].inner)?.words]
        }
        Expression::Splat { size, value } => constant(module, expressions, value)?.repeat(size as usize),
        Expression::Compose { ref components, .. } => {
            let mut words = Vec::new();
            for &component in components {
                words.extend(constant(module, expressions, component)?);
            }
            words
        }
        ref other => return Err(unsupported(other)),
    })
}

fn unsupported(what: &impl Debug) -> String {
    format!("{what:?} is not supported")
}

/// How a statement leaves.
enum Flow {
    Next,
    Break,
    Continue,
    Return(Option<Handle<Expression>>),
}

/// A function in the middle of a call.
#[derive(Clone, Copy)]
struct Activation<'a> {
    function: &'a Function,
    frame: &'a Frame,
    base: usize,
}

impl Activation<'_> {
    fn slot(&self, expression: Handle<Expression>) -> Slot {
        let slot = self.frame.slots[expression.index()];
        Slot { at: self.base + slot.at, ..slot }
    }
}

/// One call from outside: the frames of the functions that are running, one after the other.
struct Machine<'a> {
    shader: &'a Shader,
    memory: Vec<u32>,
    counts: &'a mut Counts,
    fma: Fma,
}

impl<'a> Machine<'a> {
    fn invoke(&mut self, handle: Handle<Function>, args: &[u32]) -> Result<Vec<u32>, String> {
        let shader = self.shader;
        let frame = shader.frames[handle.index()].as_ref().map_err(Clone::clone)?;
        let function = &shader.module.functions[handle];
        let base = self.memory.len();
        self.memory.extend_from_slice(&frame.words);
        self.memory[base..base + args.len()].copy_from_slice(args);
        for &(pointer, target) in &frame.pointers {
            self.memory[base + pointer] = (base + target) as u32;
        }
        let activation = Activation { function, frame, base };
        let result = match self.block(activation, &function.body)? {
            Flow::Return(Some(value)) => self.words(activation.slot(value)).to_vec(),
            _ => Vec::new(),
        };
        self.memory.truncate(base);
        Ok(result)
    }

    fn block(&mut self, a: Activation<'a>, block: &'a Block) -> Result<Flow, String> {
        for statement in block.iter() {
            match self.statement(a, statement)? {
                Flow::Next => {}
                flow => return Ok(flow),
            }
        }
        Ok(Flow::Next)
    }

    fn statement(&mut self, a: Activation<'a>, statement: &'a Statement) -> Result<Flow, String> {
        match statement {
            Statement::Emit(range) => {
                for expression in range.clone() {
                    self.evaluate(a, expression)?;
                }
            }
            Statement::Block(block) => return self.block(a, block),
            Statement::If { condition, accept, reject } => {
                let taken = self.word(a.slot(*condition)) != 0;
                return self.block(a, if taken { accept } else { reject });
            }
            Statement::Loop { body, continuing, break_if } => {
                return self.repeat(a, body, continuing, *break_if);
            }
            Statement::Break => return Ok(Flow::Break),
            Statement::Continue => return Ok(Flow::Continue),
            Statement::Return { value } => return Ok(Flow::Return(*value)),
            Statement::Store { pointer, value } => {
                let to = self.word(a.slot(*pointer)) as usize;
                let value = a.slot(*value);
                self.copy(value.at, to, value.shape.words);
            }
            Statement::Call { function, arguments, result } => {
                let mut words = Vec::new();
                for &argument in arguments {
                    words.extend_from_slice(self.words(a.slot(argument)));
                }
                let words = self.invoke(*function, &words)?;
                if let Some(result) = result {
                    let at = a.slot(*result).at;
                    self.memory[at..at + words.len()].copy_from_slice(&words);
                }
            }
            other => return Err(unsupported(other)),
        }
        Ok(Flow::Next)
    }

    fn repeat(
        &mut self,
        a: Activation<'a>,
        body: &'a Block,
        continuing: &'a Block,
        break_if: Option<Handle<Expression>>,
    ) -> Result<Flow, String> {
        for _ in 0..LONGEST_LOOP {
            match self.block(a, body)? {
                Flow::Next | Flow::Continue => {}
                Flow::Break => return Ok(Flow::Next),
                flow @ Flow::Return(_) => return Ok(flow),
            }
            self.block(a, continuing)?;
            if break_if.is_some_and(|condition| self.word(a.slot(condition)) != 0) {
                return Ok(Flow::Next);
            }
        }
        Err(format!("a loop did not end in {LONGEST_LOOP} rounds"))
    }

    fn evaluate(&mut self, a: Activation<'a>, handle: Handle<Expression>) -> Result<(), String> {
        let out = a.slot(handle);
        match a.function.expressions[handle] {
            Expression::Compose { ref components, .. } => {
                let mut to = out.at;
                for &component in components {
                    let from = a.slot(component);
                    self.copy(from.at, to, from.shape.words);
                    to += from.shape.words;
                }
            }
            Expression::AccessIndex { base, index } => {
                self.access(out, a.slot(base), i64::from(index))?;
            }
            Expression::Access { base, index } => {
                let index = a.slot(index);
                let word = self.word(index);
                let signed = index.shape.kind == Kind::Sint;
                let index = if signed { i64::from(word as i32) } else { i64::from(word) };
                self.access(out, a.slot(base), index)?;
            }
            Expression::Splat { value, .. } => {
                self.map(&"Splat", out, [a.slot(value)], |[x]| Some(x))?;
            }
            Expression::Swizzle { vector, pattern, .. } => {
                let vector = a.slot(vector);
                for lane in 0..out.shape.words {
                    self.memory[out.at + lane] = self.memory[vector.at + pattern[lane] as usize];
                }
            }
            Expression::Load { pointer } => {
                let from = self.word(a.slot(pointer)) as usize;
                self.copy(from, out.at, out.shape.words);
            }
            Expression::Unary { op, expr } => {
                let operand = a.slot(expr);
                self.map(&op, out, [operand], |[x]| unary(op, operand.shape.kind, x))?;
            }
            Expression::Binary { op, left, right } => {
                let operands = [a.slot(left), a.slot(right)];
                let kinds = operands.map(|operand| operand.shape.kind);
                self.map(&op, out, operands, |words| binary(op, kinds, words))?;
                if out.shape.kind == Kind::Float {
                    let lanes = out.shape.words as u64;
                    match op {
                        BinaryOperator::Multiply => self.counts.mul += lanes,
                        BinaryOperator::Add | BinaryOperator::Subtract => self.counts.add += lanes,
                        _ => self.counts.special += lanes,
                    }
                }
            }
            Expression::Select { condition, accept, reject } => {
                let operands = [a.slot(condition), a.slot(accept), a.slot(reject)];
                self.map(&"Select", out, operands, |[c, x, y]| Some(if c != 0 { x } else { y }))?;
                if out.shape.kind == Kind::Float {
                    self.counts.choice += out.shape.words as u64;
                }
            }
            Expression::Math { fun: MathFunction::Dot, arg, arg1: Some(other), .. } => {
                let [left, right] = [arg, other].map(|x| a.slot(x));
                let lanes = left.shape.words;
                let number = |at: usize| f32::from_bits(self.memory[at]);
                let product = |lane: usize| number(left.at + lane) * number(right.at + lane);
                let sum = (1..lanes).fold(product(0), |sum, lane| sum + product(lane));
                self.memory[out.at] = sum.to_bits();
                self.counts.mul += lanes as u64;
                self.counts.add += lanes as u64 - 1;
            }
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                let operands = [arg, arg1.unwrap_or(arg), arg2.unwrap_or(arg)].map(|x| a.slot(x));
                let (kind, fused) = (operands[0].shape.kind, self.fma == Fma::Fused);
                self.map(&fun, out, operands, |words| math(fun, kind, fused, words))?;
                let lanes = out.shape.words as u64;
                match fun {
                    MathFunction::Fma => self.counts.fma += lanes,
                    MathFunction::Sqrt | MathFunction::InverseSqrt | MathFunction::Exp2 | MathFunction::Log2 => {
                        self.counts.special += lanes;
                    }
                    MathFunction::Min | MathFunction::Max if kind == Kind::Float => self.counts.choice += lanes,
                    MathFunction::Clamp if kind == Kind::Float => self.counts.choice += 2 * lanes,
                    _ => {}
                }
            }
            Expression::As { expr, convert, .. } => {
                let operand = a.slot(expr);
                let (from, to) = (operand.shape.kind, out.shape.kind);
                self.map(&"As", out, [operand], |[x]| match convert {
                    Some(_) => cast(from, to, x),
                    None => Some(x),
                })?;
            }
            ref other => return Err(unsupported(other)),
        }
        Ok(())
    }

    /// Takes an element of a value, or turns a pointer into one to the element.
    fn access(&mut self, out: Slot, base: Slot, index: i64) -> Result<(), String> {
        let Shape { kind, stride, count, .. } = base.shape;
        let element = usize::try_from(index).ok().filter(|&element| element < count);
        let Some(element) = element else {
            return Err(format!("index {index} is outside {count} elements"));
        };
        if kind == Kind::Pointer {
            self.memory[out.at] = self.memory[base.at] + (element * stride) as u32;
        } else {
            self.copy(base.at + element * stride, out.at, out.shape.words);
        }
        Ok(())
    }

    /// Applies a function to each component; an operand of one word serves all components.
    fn map<const N: usize>(
        &mut self,
        what: &impl Debug,
        out: Slot,
        operands: [Slot; N],
        f: impl Fn([u32; N]) -> Option<u32>,
    ) -> Result<(), String> {
        for lane in 0..out.shape.words {
            let words = operands.map(|x| self.memory[x.at + if x.shape.words == 1 { 0 } else { lane }]);
            self.memory[out.at + lane] = f(words).ok_or_else(|| {
                let kinds = operands.map(|operand| operand.shape.kind);
                format!("{what:?} of {kinds:?} is not supported, or has no result for {words:?}")
            })?;
        }
        Ok(())
    }

    fn word(&self, slot: Slot) -> u32 {
        self.memory[slot.at]
    }

    fn words(&self, slot: Slot) -> &[u32] {
        &self.memory[slot.at..slot.at + slot.shape.words]
    }

    fn copy(&mut self, from: usize, to: usize, words: usize) {
        self.memory.copy_within(from..from + words, to);
    }
}

fn unary(op: UnaryOperator, kind: Kind, x: u32) -> Option<u32> {
    match (op, kind) {
        (UnaryOperator::Negate, Kind::Float) => Some((-f32::from_bits(x)).to_bits()),
        (UnaryOperator::Negate, Kind::Sint) => Some(x.wrapping_neg()),
        (UnaryOperator::LogicalNot, Kind::Bool) => Some(x ^ 1),
        (UnaryOperator::BitwiseNot, Kind::Sint | Kind::Uint) => Some(!x),
        _ => None,
    }
}

fn binary(op: BinaryOperator, kinds: [Kind; 2], [x, y]: [u32; 2]) -> Option<u32> {
    use BinaryOperator as Op;
    match kinds {
        [Kind::Float, Kind::Float] => {
            let (x, y) = (f32::from_bits(x), f32::from_bits(y));
            let result = match op {
                Op::Add => x + y,
                Op::Subtract => x - y,
                Op::Multiply => x * y,
                Op::Divide => x / y,
                _ => return compare(op, x, y),
            };
            Some(result.to_bits())
        }
        [Kind::Sint, Kind::Sint] => {
            let (i, j) = (x as i32, y as i32);
            match op {
                Op::Divide => i.checked_div(j).map(|q| q as u32),
                Op::Modulo => i.checked_rem(j).map(|r| r as u32),
                _ => whole(op, x, y).or_else(|| compare(op, i, j)),
            }
        }
        [Kind::Uint, Kind::Uint] => match op {
            Op::Divide => x.checked_div(y),
            Op::Modulo => x.checked_rem(y),
            Op::ShiftLeft => x.checked_shl(y),
            Op::ShiftRight => x.checked_shr(y),
            _ => whole(op, x, y).or_else(|| compare(op, x, y)),
        },
        [Kind::Sint, Kind::Uint] => match op {
            Op::ShiftLeft => x.checked_shl(y),
            Op::ShiftRight => (x as i32).checked_shr(y).map(|s| s as u32),
            _ => None,
        },
        [Kind::Bool, Kind::Bool] => match op {
            Op::And | Op::LogicalAnd => Some(x & y),
            Op::InclusiveOr | Op::LogicalOr => Some(x | y),
            _ => compare(op, x, y),
        },
        _ => None,
    }
}

/// What signed and unsigned integers do alike.
fn whole(op: BinaryOperator, x: u32, y: u32) -> Option<u32> {
    Some(match op {
        BinaryOperator::Add => x.wrapping_add(y),
        BinaryOperator::Subtract => x.wrapping_sub(y),
        BinaryOperator::Multiply => x.wrapping_mul(y),
        BinaryOperator::And => x & y,
        BinaryOperator::InclusiveOr => x | y,
        BinaryOperator::ExclusiveOr => x ^ y,
        _ => return None,
    })
}

fn compare<T: PartialOrd>(op: BinaryOperator, x: T, y: T) -> Option<u32> {
    Some(u32::from(match op {
        BinaryOperator::Equal => x == y,
        BinaryOperator::NotEqual => x != y,
        BinaryOperator::Less => x < y,
        BinaryOperator::LessEqual => x <= y,
        BinaryOperator::Greater => x > y,
        BinaryOperator::GreaterEqual => x >= y,
        _ => return None,
    }))
}

/// `min` by the formula of both languages' specifications: the second where it is less than the first, else the first.
fn smaller(x: f32, y: f32) -> f32 {
    if y < x { y } else { x }
}

/// `max` by the formula of both languages' specifications: the second where the first is less than it, else the first.
fn larger(x: f32, y: f32) -> f32 {
    if x < y { y } else { x }
}

fn math(fun: MathFunction, kind: Kind, fused: bool, words: [u32; 3]) -> Option<u32> {
    let [x, y, z] = words;
    match kind {
        Kind::Float => {
            let [x, y, z] = words.map(f32::from_bits);
            let result = match fun {
                MathFunction::Abs => x.abs(),
                MathFunction::Min => smaller(x, y),
                MathFunction::Max => larger(x, y),
                MathFunction::Clamp => smaller(larger(x, y), z),
                MathFunction::Exp2 => x.exp2(),
                MathFunction::Log2 => x.log2(),
                MathFunction::Fma if fused => x.mul_add(y, z),
                MathFunction::Fma => x * y + z,
                MathFunction::Sqrt => x.sqrt(),
                MathFunction::InverseSqrt => 1.0 / x.sqrt(),
                _ => return None,
            };
            Some(result.to_bits())
        }
        Kind::Sint => {
            let [x, y, z] = words.map(|word| word as i32);
            let result = match fun {
                MathFunction::Abs => x.wrapping_abs(),
                MathFunction::Min => x.min(y),
                MathFunction::Max => x.max(y),
                MathFunction::Clamp => x.max(y).min(z),
                _ => return None,
            };
            Some(result as u32)
        }
        Kind::Uint => match fun {
            MathFunction::Abs => Some(x),
            MathFunction::Min => Some(x.min(y)),
            MathFunction::Max => Some(x.max(y)),
            MathFunction::Clamp => Some(x.max(y).min(z)),
            _ => None,
        },
        _ => None,
    }
}

fn cast(from: Kind, to: Kind, x: u32) -> Option<u32> {
    use Kind::{Bool, Float, Sint, Uint};
    Some(match (from, to) {
        (Float, Sint) => f32::from_bits(x) as i32 as u32,
        (Float, Uint) => f32::from_bits(x) as u32,
        (Float, Bool) => u32::from(f32::from_bits(x) != 0.0),
        (Sint, Float) => (x as i32 as f32).to_bits(),
        (Uint | Bool, Float) => (x as f32).to_bits(),
        (Sint | Uint, Bool) => u32::from(x != 0),
        (Float, Float) | (Sint | Uint | Bool, Sint | Uint) | (Bool, Bool) => x,
        _ => return None,
    })
}
