//! What goes into one file: functions and constants, and why one of them cannot be printed.

use crate::emit::dialect::Dialect;
use crate::emit::language::{self, Arrays, Form, Target};
use crate::families::family::Spec;
use crate::ir::graph::Kind;
use crate::promise::built::Built;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A function to print: a kernel, the spec it serves and its name.
#[derive(Clone, Debug)]
pub struct Function {
    /// The kernel.
    pub built: Arc<Built>,
    /// The spec, its channels included.
    pub spec: Spec,
    /// A name that replaces the spec's own.
    pub name: Option<String>,
}

/// Constants to print: coefficients of an environment.
#[derive(Clone, Debug, PartialEq)]
pub struct Constants {
    /// The name, in lower case.
    pub name: String,
    /// What they are.
    pub doc: String,
    /// RGB coefficients, index l(l+1)+m.
    pub values: Vec<[f64; 3]>,
}

/// What goes into one file.
#[derive(Clone, Debug, Default)]
pub struct Module {
    /// The name of the file without its extension.
    pub name: String,
    /// What made it: a spec or a scene.
    pub origin: String,
    /// The functions, in order.
    pub functions: Vec<Function>,
    /// The constants, in order.
    pub constants: Vec<Constants>,
    /// How the functions take and return arrays; a language's own way if it is left open.
    pub arrays: Option<Arrays>,
    /// The form of the file; a language's own if it is left open, or the language does not know it.
    pub form: Option<&'static str>,
}

/// Why a kernel cannot be printed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{spec}` cannot be printed for {target}: {why}; {help}")]
pub struct Limit {
    /// The kernel.
    pub spec: String,
    /// The language.
    pub target: Target,
    /// What stands in the way.
    pub why: String,
    /// What to do.
    pub help: String,
}

impl Module {
    /// Returns the module of one function, named as it is in a shader.
    pub fn of(function: Function) -> Self {
        let (name, origin) = (function.shader_name(), format!("`{}`", function.spec));
        Self { name, origin, functions: vec![function], ..Self::default() }
    }
}

impl Module {
    /// Returns the form of the file in a language, if it is not the language's own.
    pub fn form(&self, target: Target) -> Option<&'static Form> {
        self.form.and_then(|name| target.form(name))
    }

    /// Returns a text of the module with functions for those that a user writes, so that it can be checked.
    ///
    /// # Errors
    ///
    /// If a function cannot be printed in the language.
    pub(crate) fn with_stand_ins(&self, target: Target, text: &str) -> Result<String, Limit> {
        let Some(memory) = target.memory.filter(|_| self.arrays == Some(Arrays::Memory)) else {
            return Ok(text.to_owned());
        };
        let mut functions: BTreeSet<String> = BTreeSet::new();
        for function in &self.functions {
            let dialect = function.dialect(target, self.arrays)?;
            for kind in [Kind::Scalar, Kind::Signal] {
                let of = dialect.number(kind);
                functions.insert((memory.read)(&dialect.accessor("read", kind), &of));
                functions.insert((memory.write)(&dialect.accessor("write", kind), &of));
            }
        }
        let functions = functions.into_iter().collect::<Vec<_>>().join("\n");
        Ok(if memory.first { format!("{functions}\n{text}") } else { format!("{text}\n{functions}\n") })
    }

    /// Returns what the file is called in a language, with its extension.
    pub fn file_name(&self, target: Target) -> String {
        let extension = self.form(target).map_or(target.extension, |form| form.extension);
        format!("{}.{extension}", self.name)
    }
}

impl Function {
    /// Returns its name in a language whose functions are not generic.
    pub fn shader_name(&self) -> String {
        self.name.clone().unwrap_or_else(|| self.spec.name())
    }

    /// Returns the name of the function that is generic over the signal, and that of its RGB twin if the spec is RGB.
    pub(crate) fn generic_names(&self) -> (String, Option<String>) {
        match (&self.name, self.spec.rgb) {
            (Some(name), false) => (name.clone(), None),
            (Some(name), true) => (format!("{name}_channels"), Some(name.clone())),
            (None, false) => (self.spec.stem(), None),
            (None, true) => (self.spec.base().stem(), Some(self.spec.stem())),
        }
    }

    /// Returns whether a parameter is a signal.
    pub(crate) fn has_signal(&self) -> bool {
        self.built.code.params().iter().any(|param| !param.kind.is_scalar())
    }

    /// Returns how the function is printed in a language.
    ///
    /// # Errors
    ///
    /// If the language has no f16 and the function needs it, if it cannot pass arrays as it is asked to, or if it has no
    /// operators on vectors and the function has three channels.
    pub fn dialect(&self, target: Target, arrays: Option<Arrays>) -> Result<Dialect, Limit> {
        if self.spec.half && target.half.is_none() {
            let why = format!("{} f16", language::only(|language| language.half.is_some()));
            let names: Vec<String> = language::ALL
                .iter()
                .filter(|language| language.half.is_some())
                .map(|language| format!("`{language}`"))
                .collect();
            let help = format!("leave `f16` out, or name {} as the only target", names.join(" or "));
            return Err(self.limit(target, why, help));
        }
        if let Some(arrays) = arrays.filter(|arrays| !target.arrays.contains(arrays)) {
            let why = format!("{} does not pass arrays as `{}`", target.title, arrays.name());
            return Err(self.limit(target, why, "leave `arrays` out, or name another target".to_owned()));
        }
        let plain = Dialect::new(target);
        let rgb = self.spec.rgb && target.generic.is_none();
        if rgb && !target.vector_operators {
            let why = format!("{} has no operators on vectors, which a signal of three channels needs", target.title);
            let help = "leave `rgb` out and call the function once a channel, or name another target".to_owned();
            return Err(self.limit(target, why, help));
        }
        Ok(Dialect { rgb, half: self.spec.half, arrays: arrays.unwrap_or(plain.arrays), ..plain })
    }

    pub(crate) fn limit(&self, target: Target, why: String, help: String) -> Limit {
        Limit { spec: self.spec.to_string(), target, why, help }
    }
}
