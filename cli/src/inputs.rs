//! Inputs of kernels as JSON: a list of objects keyed by parameter name, whose lists are nested as the parameters are, or
//! flat, or for an RGB signal the values of grey. What a parameter usually is may be left out.

use serde_json::Value;
use std::path::Path;
use std::sync::Arc;
use zonal_codegen::families::Spec;
use zonal_codegen::input;
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::{Param, Shape};
use zonal_codegen::scene::diagnostic::{Diagnostic, Place, Source};

/// The largest file of inputs that is read, in bytes.
const MAX_BYTES: usize = 1 << 26;

/// One parameter's numbers in flat order, for one channel or for three.
pub type Channels = Vec<Vec<f64>>;

/// How deep and how long the lists of a parameter or a result are.
pub fn lengths(shape: Shape, kind: Kind, rgb: bool) -> Vec<usize> {
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

/// Returns each case's parameters, in the order of `params`, from the file at `path`.
///
/// # Errors
///
/// As [`from_text`], and where the file cannot be read or is larger than 64 MiB.
pub fn from_file(path: &Path, spec: &Spec, params: &[Param]) -> Result<Vec<Vec<Channels>>, Diagnostic> {
    let name = path.display().to_string();
    let text = input::read_text(path, MAX_BYTES)
        .map_err(|error| Diagnostic::nowhere(format!("{name}: cannot be read ({error})"), "check the path"))?;
    from_text(&name, &text, spec, params)
}

/// Returns each case's parameters, in the order of `params`, from a text that messages call `name`.
///
/// # Errors
///
/// If it is no JSON, or a parameter is unknown, left out, or not as deep and as long as it should be, or a number does not
/// fit in f32.
pub fn from_text(name: &str, text: &str, spec: &Spec, params: &[Param]) -> Result<Vec<Vec<Channels>>, Diagnostic> {
    let expected =
        "the file is a list of objects keyed by parameter name, as `zonal vectors` prints them under `inputs`";
    let value: Value = serde_json::from_str(text).map_err(|error| {
        let line_start: usize = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
        let start = (line_start + error.column().saturating_sub(1)).min(text.len());
        let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
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
