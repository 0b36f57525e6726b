//! Files of the one language whose functions are generic over their numbers: a function serves every number of channels,
//! so that its RGB twin is a wrapper, and what it is generic over stands in a module of its own.

use crate::emit::dialect::Dialect;
use crate::emit::function::WrapperText;
// Names a language: a module of Rust is laid out as crates are, which no other language has.
use crate::emit::language::record::{Generic, Numbers, Way};
use crate::emit::language::{Arrays, RUST};
use crate::emit::module::{Function, Limit, Module};
use crate::emit::plain::{self, head, render};
use crate::emit::support;
use crate::ir::kernel::Shape;
use std::collections::BTreeSet;
use tera::Context;

impl Function {
    fn wrapper(&self, dialect: Dialect, of: &Generic, function: &str, name: String) -> WrapperText {
        let [scalar, _] = of.numbers;
        let numbers = Numbers { scalar: scalar.to_owned(), signal: of.channels.to_owned() };
        let language = dialect.language;
        let params = self.built.code.params();
        let arguments: Vec<String> = params
            .iter()
            .map(|param| match (param.kind.is_scalar(), param.shape) {
                (true, _) => param.name.to_owned(),
                (false, Shape::Scalar) => format!("Channels({})", param.name),
                (false, _) => format!("&{}.map(Channels)", param.name),
            })
            .collect();
        let (shape, kind) = self.built.code.result();
        let open = match shape {
            Shape::Scalar => ".0",
            _ => ".map(|v| v.0)",
        };
        let parameter = |param: &crate::ir::kernel::Param| {
            (language.parameter)(param.name, &language.type_of(&numbers, param.shape, param.kind), Way::In)
        };
        WrapperText {
            name,
            params: params.iter().map(parameter).collect(),
            result: language.type_of(&numbers, shape, kind).text,
            call: format!("{function}::<T, Channels<T, 3>>({}){open}", arguments.join(", ")),
        }
    }
}

// Names a language: modules, `use` lines and the traits that functions are generic over are Rust's alone.
impl Module {
    /// Returns the Rust items of the module's functions and constants, without what they stand on.
    ///
    /// # Errors
    ///
    /// If a function works in f16, or is asked to pass arrays otherwise than by value.
    pub fn rust_items(&self) -> Result<String, Limit> {
        let mut functions = Vec::new();
        for function in &self.functions {
            let dialect = function.dialect(&RUST, self.arrays)?;
            let (name, rgb) = function.generic_names();
            let known = functions.iter().position(|known: &crate::emit::function::FunctionText| known.name == name);
            let at = match known {
                Some(at) => at,
                None => {
                    functions.push(function.text(dialect, name.clone(), &function.spec.base())?);
                    functions.len() - 1
                }
            };
            if let (Some(rgb), Some(generic), false) = (rgb, &RUST.generic, dialect.arrays == Arrays::Sink) {
                functions[at].wrappers.push(function.wrapper(dialect, generic, &name, rgb));
            }
        }
        let mut context = Context::new();
        context.insert("tables", &plain::constants(self, &RUST));
        context.insert("functions", &functions);
        Ok(render(RUST.template, &context))
    }

    /// Returns a Rust file of the module's items that uses `real` from its parent.
    ///
    /// # Errors
    ///
    /// As [`Module::rust_items`].
    pub fn rust_file(&self) -> Result<String, Limit> {
        Ok(format!("{}\n{}", self.rust_head(), self.with_uses("super::real")?))
    }

    /// The items under the `use` lines that they need.
    fn with_uses(&self, real: &str) -> Result<String, Limit> {
        let items = self.rust_items()?;
        let used: Vec<&str> = ["Channels", "Real", "Signal"].into_iter().filter(|name| items.contains(*name)).collect();
        Ok(match used.is_empty() {
            true => items,
            false => format!("use {real}::{{{}}};\n{items}", used.join(", ")),
        })
    }

    fn rust_head(&self) -> String {
        head(&self.origin).iter().map(|line| format!("// {line}\n")).collect()
    }

    /// Returns a Rust file that stands alone: `real`, then a module for each order, then the constants.
    ///
    /// # Errors
    ///
    /// As [`Module::rust_items`].
    pub fn rust_alone(&self) -> Result<String, Limit> {
        let mut text = format!(
            "{}\n/// What the kernels are generic over.\n#[allow(dead_code)]\npub mod real {{\n{}}}\n",
            self.rust_head(),
            support::real(support::Std::Always)
        );
        let orders: BTreeSet<usize> = self.functions.iter().map(|function| function.spec.order).collect();
        for order in orders {
            let module = Self {
                functions: self.functions.iter().filter(|function| function.spec.order == order).cloned().collect(),
                arrays: self.arrays,
                ..Self::default()
            };
            text += &format!(
                "\n/// Kernels of order {order}.\n#[allow(dead_code)]\npub mod sh{order} {{\n{}}}\n",
                module.with_uses("super::real")?
            );
        }
        for table in plain::constants(self, &RUST) {
            text += &format!("\n{table}\n");
        }
        Ok(text)
    }
}
