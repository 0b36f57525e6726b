//! Test vectors: what the interpreter gives in f32 and f64 for seeded inputs or for those of a file, as JSON that an
//! engine's own tests can read. Arrays are nested as the parameters are: pairs by pairs, a matrix by columns, an RGB
//! signal by triples. Beside each parameter stands for which of its values the kernel's promises hold, null for a signal;
//! and what it is where a file leaves it out, null if none may.

use super::spec_of;
use serde_json::{Map, Value, json};
use std::path::PathBuf;
use zonal_cli::inputs::{Channels, from_file, lengths};
use zonal_cli::terminal::{Failure, out_json, progress};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::ir::kernel::Param;
use zonal_codegen::promise::samples;

/// A number; what is not finite is a string, since JSON has no number for it.
fn number(number: f64) -> Value {
    match number {
        _ if number.is_nan() => json!("NaN"),
        f64::INFINITY => json!("Infinity"),
        f64::NEG_INFINITY => json!("-Infinity"),
        _ => json!(number),
    }
}

/// Flat numbers as nested lists.
fn nest(numbers: &[f64], lengths: &[usize]) -> Value {
    match lengths {
        [] => numbers.first().map_or(Value::Null, |&first| number(first)),
        [_, inner @ ..] => {
            let size = inner.iter().product::<usize>().max(1);
            numbers.chunks(size).map(|part| nest(part, inner)).collect()
        }
    }
}

/// The channels side by side.
fn interleave(channels: &[Vec<f64>]) -> Vec<f64> {
    (0..channels[0].len()).flat_map(|i| channels.iter().map(move |channel| channel[i])).collect()
}

/// Seeded inputs; the channels of a signal differ.
fn seeded(spec: &Spec, params: &[Param], count: usize, seed: u64) -> Vec<Vec<Channels>> {
    let channels: Vec<_> = (0..spec.channels() as u64)
        .map(|channel| samples::inputs(params, seed.wrapping_add(channel << 32), count, None))
        .collect();
    (0..count)
        .map(|case| {
            let of_param = |(i, param): (usize, &Param)| -> Channels {
                let channels = &channels[..param.kind.numbers(channels.len())];
                channels.iter().map(|channel| channel[case][i].clone()).collect()
            };
            params.iter().enumerate().map(of_param).collect()
        })
        .collect()
}

/// What the kernel gives in `T` for one case, flat, its channels side by side.
fn run<T: Number>(runner: &zonal_codegen::ir::code::Runner<T>, case: &[Channels], channels: usize) -> Vec<f64> {
    let results: Vec<Vec<f64>> = (0..channels)
        .map(|channel| {
            let inputs: Vec<Vec<T>> = case
                .iter()
                .map(|param| param[channel.min(param.len() - 1)].iter().map(|&number| T::from_f64(number)).collect())
                .collect();
            let slices: Vec<&[T]> = inputs.iter().map(Vec::as_slice).collect();
            runner.run(&slices, Contraction::Separate).into_iter().map(T::to_f64).collect()
        })
        .collect();
    interleave(&results)
}

pub fn print(text: &str, file: Option<PathBuf>, count: usize, seed: u64) -> Result<(), Failure> {
    let spec = spec_of(text)?;
    let bar = progress("building and running");
    let code = spec.code();
    let params = code.params();
    let cases = match file {
        Some(path) => from_file(&path, &spec, params)?,
        None => seeded(&spec, params, count, seed),
    };
    let (shape, kind) = code.result();
    let result = lengths(shape, kind, spec.rgb);
    let channels = kind.numbers(spec.channels());
    let (narrow, wide) = (code.runner::<f32>(), code.runner::<f64>());
    let cases: Vec<Value> = cases
        .iter()
        .map(|case| {
            let inputs: Map<String, Value> = params
                .iter()
                .zip(case)
                .map(|(param, channels)| {
                    (param.name.to_owned(), nest(&interleave(channels), &lengths(param.shape, param.kind, spec.rgb)))
                })
                .collect();
            json!({
                "inputs": inputs,
                "f32": nest(&run(&narrow, case, channels), &result),
                "f64": nest(&run(&wide, case, channels), &result),
            })
        })
        .collect();
    let parameters: Vec<Value> = params
        .iter()
        .map(|param| {
            json!({
                "name": param.name,
                "shape": lengths(param.shape, param.kind, spec.rgb),
                "doc": param.doc,
                "domain": param.domain.in_words(param.name),
                "usual": param.usual,
            })
        })
        .collect();
    drop(bar);
    out_json(&json!({
        "spec": spec.to_string(),
        "name": spec.name(),
        "parameters": parameters,
        "result": {"shape": result, "doc": code.result_doc()},
        "multiply_add": "rounded twice",
        "cases": cases,
    }))
}
