//! From specs to text that is checked: kernels built, each once whatever its channels, printed and validated.

use crate::emit::language::Target;
use crate::emit::validate::{Invalid, validate};
use crate::emit::{Function, Limit, Module};
use crate::families::family::Spec;
use crate::files::File;
use crate::promise::built::Built;
use crate::promise::registers::Registers;
use crate::threads;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Why a set of kernels could not be generated.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// A kernel cannot be printed for a target.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// A validator refused a text.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// Builds the kernels of specs, each once whatever its channels, in parallel.
pub fn build(specs: &[Spec]) -> Vec<Function> {
    let bases: BTreeSet<Spec> = specs.iter().map(Spec::base).collect();
    // What pieces are of is measured once for all of them.
    let wholes: BTreeSet<Spec> = bases.iter().map(Spec::whole).collect();
    let built = threads::map(&wholes, |spec| Arc::new(Built::new(spec)));
    let mut built: BTreeMap<Spec, Arc<Built>> = wholes.iter().cloned().zip(built).collect();
    for spec in bases.iter().filter(|spec| spec.form.is_piece()) {
        let piece = Arc::new(Built::piece(spec, &built[&spec.whole()]));
        built.insert(spec.clone(), piece);
    }
    let function = |spec: &Spec| Function { built: built[&spec.base()].clone(), spec: spec.clone(), name: None };
    specs.iter().map(function).collect()
}

/// Prints and validates one module in one language, by [`validate`], below a folder, which may be empty and else ends in
/// `/`. What a form makes of the text is not validated again.
pub fn file(module: &Module, target: Target, folder: &str) -> Result<File, GenerateError> {
    let path = format!("{folder}{}", module.file_name(target));
    let text = module.text(target)?;
    validate(target, &path, &module.with_stand_ins(target, &text)?)?;
    let text = match module.form(target) {
        Some(form) => (form.text)(&module.name, text),
        None => text,
    };
    Ok(File { path, text })
}

/// The cost, the footprint and the accuracy of a spec, as `list` shows them.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Row {
    /// The spec.
    pub spec: String,
    /// The function's name in shaders.
    pub name: String,
    /// The order.
    pub order: usize,
    /// How many channels the signal has.
    pub channels: usize,
    /// The operations.
    #[serde(flatten)]
    pub cost: crate::ir::listing::Cost,
    /// Constants and live values.
    #[serde(flatten)]
    pub footprint: crate::ir::listing::Footprint,
    /// Vector registers on RDNA 2, called by one function.
    #[serde(rename = "rdna2")]
    pub registers: Registers,
    /// The errors.
    #[serde(flatten)]
    pub accuracy: crate::promise::accuracy::Accuracy,
    /// For a zonal factorisation the non-zero entries of its sparse matrix in the bands from 2 on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nonzeros: Option<usize>,
}

impl Row {
    /// The row of a function.
    pub fn of(function: &Function) -> Self {
        let spec = &function.spec;
        Self {
            spec: spec.to_string(),
            name: function.shader_name(),
            order: spec.order,
            channels: spec.channels(),
            cost: function.built.code.cost(spec.channels()),
            footprint: function.built.code.footprint(),
            registers: Registers::of(spec, &function.built.code),
            accuracy: function.built.accuracy.clone(),
            nonzeros: spec.family.nonzeros.map(|count| count(spec.order)),
        }
    }
}
