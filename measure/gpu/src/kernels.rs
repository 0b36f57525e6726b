//! What is compiled: every kernel of the catalogue as one function and, where it leaves bands apart, in pieces.

use crate::shader;
use rayon::prelude::*;
use std::collections::BTreeMap;
use zonal_codegen::emit::Function;
use zonal_codegen::families::{Form, Spec};
use zonal_codegen::generate;
pub use zonal_codegen::promise::registers::Called;

/// A kernel to compile.
#[derive(Clone)]
pub struct Kernel {
    /// The spec.
    pub spec: String,
    /// How it is called.
    pub called: Called,
    /// Its operations, for all channels.
    pub operations: usize,
    /// Its roots and reciprocals.
    pub special: usize,
    /// Numbers that it is given besides the signal.
    pub reads: usize,
    /// Numbers that it holds at once.
    pub held: usize,
    /// It, as SPIR-V.
    pub spirv: Vec<u32>,
}

fn kernels_of(spec: &Spec, functions: &BTreeMap<Spec, Function>) -> Vec<Kernel> {
    let function = &functions[spec];
    let cost = function.built.code.cost(spec.channels());
    let held = |pieces: &[Function]| {
        let bands = pieces.iter().filter(|piece| piece.spec.form != Form::SetUp);
        bands.map(|piece| piece.built.code.held(piece.spec.channels())).max().unwrap_or_default()
    };
    let kernel = |called, held: usize, text: String| Kernel {
        spec: spec.to_string(),
        called,
        operations: cost.total,
        special: cost.special,
        reads: function.built.code.reads(),
        held,
        spirv: shader::spirv(&text),
    };
    let whole = std::slice::from_ref(function);
    let mut all = vec![kernel(Called::Whole, held(whole), shader::whole(function))];
    let pieces: Vec<Function> = spec.in_pieces().iter().map(|piece| functions[piece].clone()).collect();
    if !pieces.is_empty() {
        all.push(kernel(Called::Pieces, held(&pieces), shader::in_pieces(&pieces, spec.order, 1)));
    }
    // A kernel that channels share operations in is another one for a single channel.
    let single: Vec<Spec> = spec.base().in_pieces();
    if spec.rgb && !single.is_empty() {
        let pieces: Vec<Function> = single.iter().map(|piece| functions[piece].clone()).collect();
        all.push(kernel(Called::Channels, held(&pieces), shader::in_pieces(&pieces, spec.order, spec.channels())));
    }
    all
}

/// Returns the shaders of these specs.
pub fn shaders(specs: &[Spec]) -> Vec<Kernel> {
    let with_pieces = |spec: &Spec| [vec![spec.clone()], spec.in_pieces(), spec.base().in_pieces()].concat();
    let all: Vec<Spec> = specs.iter().flat_map(with_pieces).collect();
    let functions: BTreeMap<Spec, Function> = all.iter().cloned().zip(generate::build(&all)).collect();
    specs.par_iter().flat_map_iter(|spec| kernels_of(spec, &functions)).collect()
}
