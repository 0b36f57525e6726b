//! Test vectors: what the interpreter gives in f32 and f64 for seeded inputs or for those of a file, as JSON that an
//! engine's own tests can read. Arrays are nested as the parameters are: pairs by pairs, a matrix by columns, an RGB
//! signal by triples. Beside each parameter stands for which of its values the kernel's promises hold, null for a signal;
//! and what it is where a file leaves it out, null if none may.

use super::spec_of;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zonal_cli::terminal::{Failure, out_json, progress};
use zonal_codegen::families::Spec;
use zonal_codegen::input;
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::{Param, Shape};
use zonal_codegen::promise::samples;
use zonal_codegen::scene::diagnostic::{Diagnostic, Place, Source};

/// The largest file of inputs that is read, in bytes.
const MAX_BYTES: usize = 1 << 26;

/// One parameter's numbers in flat order, for one channel or for three.
type Channels = Vec<Vec<f64>>;

/// How deep and how long the lists of a parameter or a result are.
fn lengths(shape: Shape, kind: Kind, rgb: bool) -> Vec<usize> {
    let mut lengths = match shape {
        Shape::Scalar => vec![],
        Shape::Vec3 => vec![3],
        Shape::Vec4 => vec![4],
        Shape::Mat3 => vec![3, 3],
        Shape::Pair => vec![2],
        Shape::Pairs(n) => vec![n, 2],
        Shape::Array(n) => vec![n],
        Shape::Vectors(n) => vec![n, 3],
    };
    if !kind.is_scalar() && rgb {
        lengths.push(3);
    }
    lengths
}

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

/// Reads nested lists of exactly these lengths.
fn flatten(value: &Value, lengths: &[usize], numbers: &mut Vec<f64>) -> Result<(), String> {
    let kind = match value {
        Value::Null => "null".to_owned(),
        Value::Bool(_) => "a boolean".to_owned(),
        Value::String(_) => "a text".to_owned(),
        Value::Object(_) => "an object".to_owned(),
        Value::Number(number) => format!("the number {number}"),
        Value::Array(items) => format!("a list of {}", items.len()),
    };
    match (value, lengths) {
        (Value::Number(number), []) => match number.as_f64().filter(|number| (*number as f32).is_finite()) {
            Some(number) => {
                numbers.push(number);
                Ok(())
            }
            None => Err(format!("{number} does not fit in f32")),
        },
        (Value::Array(items), [length, inner @ ..]) if items.len() == *length => {
            items.iter().try_for_each(|item| flatten(item, inner, numbers))
        }
        (_, []) => Err(format!("expected a number, found {kind}")),
        (_, [length]) => Err(format!("expected a list of {length} numbers, found {kind}")),
        (_, [length, inner, ..]) => Err(format!("expected a list of {length} lists of {inner} numbers, found {kind}")),
    }
}

/// Reads a parameter: nested as it should be, or as one flat list, or for an RGB signal as the values of grey.
fn read(value: &Value, param: &Param, rgb: bool) -> Result<Channels, String> {
    let full = lengths(param.shape, param.kind, rgb);
    let channels = param.kind.numbers(if rgb { 3 } else { 1 });
    let flat = value.as_array().filter(|items| items.first().is_some_and(|item| !item.is_array())).map(Vec::len);
    let mut numbers = Vec::new();
    if channels == 3 && flat == Some(param.shape.len()) {
        flatten(value, &[param.shape.len()], &mut numbers)?;
        return Ok(vec![numbers; 3]);
    }
    match flat {
        Some(length) if full.len() > 1 && length == full.iter().product::<usize>() => {
            flatten(value, &[length], &mut numbers)?
        }
        _ => flatten(value, &full, &mut numbers)?,
    }
    Ok((0..channels).map(|channel| numbers.iter().skip(channel).step_by(channels).copied().collect()).collect())
}

fn from_file(path: &Path, spec: &Spec, params: &[Param]) -> Result<Vec<Vec<Channels>>, Diagnostic> {
    let name = path.display().to_string();
    let text = input::read_text(path, MAX_BYTES)
        .map_err(|error| Diagnostic::nowhere(format!("{name}: cannot be read ({error})"), "check the path"))?;
    let expected =
        "the file is a list of objects keyed by parameter name, as `zonal vectors` prints them under `inputs`";
    let value: Value = serde_json::from_str(&text).map_err(|error| {
        let line_start: usize = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
        let start = (line_start + error.column().saturating_sub(1)).min(text.len());
        let source = Arc::new(Source { name: name.clone(), text: text.clone() });
        Diagnostic::at(&Place { source, span: start..start }, format!("is no JSON: {error}"), expected)
    })?;
    let known: Vec<&str> = params.iter().map(|param| param.name).collect();
    let parameters = format!("the parameters of `{spec}` are {}", known.join(", "));
    let fault = |message: String, help: &str| Diagnostic::nowhere(format!("{name}: {message}"), help);
    let objects = value.as_array().ok_or_else(|| fault("is no list".to_owned(), expected))?;
    let mut cases = Vec::new();
    for (i, object) in objects.iter().enumerate() {
        let object = object.as_object().ok_or_else(|| fault(format!("item {i} is no object"), expected))?;
        if let Some(key) = object.keys().find(|key| !known.contains(&key.as_str())) {
            return Err(fault(format!("object {i}: `{key}` is no parameter"), &parameters));
        }
        let mut case = Vec::new();
        for param in params {
            let Some(value) = object.get(param.name) else {
                let usual = param.usual.map(|number| vec![number; param.shape.len()]);
                let usual = usual.ok_or_else(|| fault(format!("object {i} has no `{}`", param.name), &parameters))?;
                case.push(vec![usual; param.kind.numbers(spec.channels())]);
                continue;
            };
            let channels = read(value, param, spec.rgb);
            case.push(channels.map_err(|why| {
                fault(format!("object {i}, `{}`: {why}", param.name), &format!("`{}` is {}", param.name, param.doc))
            })?);
        }
        cases.push(case);
    }
    Ok(cases)
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
