//! Writes the table of every function of `generated/rust`, as closures over rows of numbers, one a parameter. A function
//! is what its signature says: which parameters go by reference, and whether it is generic over the signal.

use std::path::Path;
use std::{env, fs};
use syn::{FnArg, GenericParam, Item, ItemFn, Type, Visibility};

fn main() {
    let kernels = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../generated/rust");
    println!("cargo::rerun-if-changed={}", kernels.display());
    let mut rows = String::new();
    for order in 2..=10 {
        let path = kernels.join(format!("sh{order}.rs"));
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        for item in &file.items {
            if let Item::Fn(function @ ItemFn { vis: Visibility::Public(_), .. }) = item {
                rows += &row(&format!("sh{order}"), function);
            }
        }
    }
    let table = format!("macro_rules! every_function {{ ($table:ident, $scalar:ident) => {{\n{rows}}} }}\n");
    let out = Path::new(&env::var_os("OUT_DIR").expect("cargo sets it")).join("table.rs");
    fs::write(&out, table).unwrap_or_else(|error| panic!("{}: {error}", out.display()));
}

fn row(module: &str, function: &ItemFn) -> String {
    let signature = &function.sig;
    let (mut reads, mut values) = (String::new(), Vec::new());
    for (i, input) in signature.inputs.iter().enumerate() {
        let FnArg::Typed(input) = input else { panic!("{}: no method is generated", signature.ident) };
        reads += &format!("let x{i} = read(&rows[{i}]); ");
        values.push(format!("{}x{i}", if matches!(*input.ty, Type::Reference(_)) { "&" } else { "" }));
    }
    let types = signature.generics.params.iter().filter(|param| matches!(param, GenericParam::Type(_))).count();
    let (name, values, count) = (&signature.ident, values.join(", "), values.len());
    let types = vec!["$scalar"; types].join(", ");
    format!(
        "$table.insert(\"{module}::{name}\", |rows| {{ assert_eq!(rows.len(), {count}); {reads}\
         written(zonal::{module}::{name}::<{types}>({values})) }});\n"
    )
}
