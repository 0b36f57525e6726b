//! The shader texts of the whole catalogue, read back through naga and run: equal to the f32 interpreter to the last
//! bit, with the operations that the graph counts.

use rayon::prelude::*;
use std::collections::BTreeSet;
use zonal_codegen::emit::language::{GLSL, Target, WGSL};
use zonal_codegen::emit::{Function, Module};
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::{Param, Shape};
use zonal_codegen::promise::samples;
use zonal_tests::catalogue;
use zonal_tests::shader::{Counts, Fma, Language, Shader, Value};

/// How many inputs each kernel is run on; the first are the extremes.
const CASES: usize = 20;

/// An argument from one list of numbers a channel.
fn argument(param: &Param, channels: &[Vec<f32>]) -> Value {
    let first = &channels[0];
    let vector = |i: usize, size: usize| Value::Vec(first[size * i..size * (i + 1)].to_vec());
    let number = |i: usize| match channels.len() {
        1 => Value::F32(first[i]),
        _ => Value::Vec(channels.iter().map(|channel| channel[i]).collect()),
    };
    match param.shape {
        Shape::Scalar => number(0),
        Shape::Vec3 | Shape::Vec4 | Shape::Pair => Value::Vec(first.clone()),
        Shape::Mat3 => Value::Mat(first.chunks(3).map(<[f32]>::to_vec).collect()),
        Shape::Pairs(n) => Value::Array((0..n).map(|i| vector(i, 2)).collect()),
        Shape::Vectors(n) => Value::Array((0..n).map(|i| vector(i, 3)).collect()),
        Shape::Array(n) => Value::Array((0..n).map(number).collect()),
    }
}

/// The numbers of a result, channel by channel.
fn channels_of(value: &Value, kind: Kind, channels: usize) -> Vec<Vec<f32>> {
    let split = |value: &Value| -> Vec<f32> {
        match value {
            Value::F32(x) => vec![*x],
            Value::Vec(v) => v.clone(),
            other => panic!("a result holds numbers, not {other:?}"),
        }
    };
    let items: Vec<Vec<f32>> = match value {
        Value::Array(items) => items.iter().map(split).collect(),
        other => vec![split(other)],
    };
    match kind.numbers(channels) {
        3 => (0..3).map(|channel| items.iter().map(|item| item[channel]).collect()).collect(),
        _ => vec![items.concat()],
    }
}

/// Prints a function, runs its text channel by channel on seeded inputs, and compares it with the interpreter.
pub(crate) fn check(function: &Function, target: Target, language: Language) {
    let inputs = samples::inputs(function.built.code.params(), 21, CASES + 2, None);
    check_on(function, target, language, &inputs);
}

/// Holds the text of a function to the interpreter, to the last bit and operation; two inputs more than cases lend their
/// signals to the channels.
pub(crate) fn check_on(function: &Function, target: Target, language: Language, inputs: &[Vec<Vec<f64>>]) {
    let text = Module::of(function.clone()).text(target).expect("the catalogue fits its targets");
    let name = function.shader_name();
    let shader = Shader::parse(language, &text).unwrap_or_else(|error| panic!("{name} in {target}: {error}"));
    assert_eq!(shader.functions(), std::slice::from_ref(&name), "{target}");
    let (params, channels) = (function.built.code.params(), function.spec.channels());
    let (_, kind) = function.built.code.result();
    let costs = match &function.built.code {
        Code::Branch(branch) => branch.costs(channels).to_vec(),
        code => vec![code.cost(channels)],
    };
    let mut taken = BTreeSet::new();
    let runner = function.built.code.runner::<f32>();
    for case in 0..inputs.len() - 2 {
        let of_channel = |channel: usize| -> Vec<Vec<f32>> {
            // Channels differ in their signals and share their parameters.
            let from = |param: &Param| if param.kind.is_scalar() { case } else { case + channel };
            let list = |(i, param): (usize, &Param)| inputs[from(param)][i].iter().map(|&x| x as f32).collect();
            params.iter().enumerate().map(list).collect()
        };
        let all: Vec<Vec<Vec<f32>>> = (0..channels).map(of_channel).collect();
        let arguments: Vec<Value> = params
            .iter()
            .enumerate()
            .map(|(i, param)| {
                let channels = &all[..param.kind.numbers(channels)];
                argument(param, &channels.iter().map(|channel| channel[i].clone()).collect::<Vec<_>>())
            })
            .collect();
        let mut counts = Counts::default();
        let result =
            shader.call(&name, &arguments, &mut counts, Fma::Separate).unwrap_or_else(|e| panic!("{name}: {e}"));
        let got = channels_of(&result, kind, channels);
        for (channel, got) in got.iter().enumerate() {
            let slices: Vec<&[f32]> = all[channel].iter().map(Vec::as_slice).collect();
            let want = runner.run(&slices, Contraction::Separate);
            let bits = |values: &[f32]| -> Vec<u32> {
                values.iter().map(|x| if x.is_nan() { 0x7fc0_0000 } else { x.to_bits() }).collect()
            };
            assert_eq!(bits(got), bits(&want), "{name} in {target}, case {case}, channel {channel}");
        }
        let found = [counts.mul + counts.fma, counts.add + counts.fma, counts.choice, counts.special];
        let expected = costs.iter().map(|cost| [cost.mul + cost.fma, cost.add + cost.fma, cost.choice, cost.special]);
        let way = expected.clone().position(|expected| expected.map(|n| n as u64) == found);
        let all: Vec<_> = expected.collect();
        let way = way.unwrap_or_else(|| {
            panic!("{name} in {target}: {found:?} multiplications, additions, choices, special ones, not {all:?}")
        });
        taken.insert(way);
    }
    assert_eq!(taken.len(), costs.len(), "{name} in {target}: every way is taken");
}

fn check_all(target: Target, language: Language) {
    assert!(catalogue().len() > 400);
    catalogue().par_iter().for_each(|function| check(function, target, language));
}

#[test]
fn every_wgsl_function_computes_what_the_interpreter_does() {
    check_all(&WGSL, Language::Wgsl);
}

#[test]
fn every_glsl_function_computes_what_the_interpreter_does() {
    check_all(&GLSL, Language::Glsl);
}
