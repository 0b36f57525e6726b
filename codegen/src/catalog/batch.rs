//! The kernels that work on many signals at once: in pieces where bands are apart, each number handed over as soon as it is
//! known, so that a vector unit's registers suffice. The runtime's batches are made of them.

// Names a language: batches are made of Rust.
use crate::emit::language::{Arrays, RUST};
use crate::emit::validate::validate;
use crate::emit::{Function, Module};
use crate::families::family::Spec;
use crate::files::File;
use crate::generate::{GenerateError, build};
use std::collections::BTreeSet;

/// From this order on the usual rotation is that by z, y, z, which is the one whose set-up serves many signals.
const ZYZ_FROM: usize = 4;

/// The kernels of an order, pieces in place of what has them.
fn specs(order: usize) -> Vec<Spec> {
    // Names a family: what is done to many signals at once is a choice.
    let mut wanted = vec![format!("rotate:{order}"), format!("tilt:{order}")];
    wanted.extend((order < ZYZ_FROM).then(|| format!("rotate:{order}:zyz")));
    let whole = ["basis", "eval", "product"].map(|name| format!("{name}:{order}"));
    let spec = |text: &String| text.parse::<Spec>().expect("a kernel of the catalogue");
    let pieces = wanted.iter().flat_map(|text| spec(text).in_pieces());
    // A product of a high order is none of the catalogue's.
    let is_known = |spec: &Spec| (spec.family.shown)(order).contains(spec);
    pieces.chain(whole.iter().filter_map(|text| text.parse().ok()).filter(is_known)).collect()
}

/// The Rust files, one an order.
///
/// # Errors
///
/// If a kernel's text is refused: a fault of zonal.
pub(super) fn files(orders: &BTreeSet<usize>) -> Result<Vec<File>, GenerateError> {
    let functions: Vec<Function> = build(&orders.iter().flat_map(|&order| specs(order)).collect::<Vec<_>>());
    let file = |&order: &usize| {
        let module = Module {
            name: format!("sh{order}"),
            origin: format!("the standard catalogue, order {order}: many signals at once"),
            functions: functions.iter().filter(|function| function.spec.order == order).cloned().collect(),
            arrays: Some(Arrays::Sink),
            ..Module::default()
        };
        let path = format!("rust/batch/sh{order}.rs");
        let text = module.rust_file()?;
        validate(&RUST, &path, &text)?;
        Ok(File { path, text })
    };
    orders.iter().map(file).collect()
}
