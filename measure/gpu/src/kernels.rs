//! What is compiled: every kernel of the catalogue as one function and, where it leaves bands apart, in pieces.

use crate::shader;
use rayon::prelude::*;
use std::collections::BTreeMap;
use zonal_codegen::emit::Function;
use zonal_codegen::families::{Form, Spec};
use zonal_codegen::generate;
use zonal_codegen::plan::contest::weight;
pub use zonal_codegen::promise::registers::Called;

/// A shader, and how often it runs for a signal.
#[derive(Clone)]
pub struct Pass {
    /// It, as SPIR-V.
    pub spirv: Vec<u32>,
    /// How many threads it takes.
    pub times: u64,
}

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
    /// What its operations and the numbers that it is given besides the signal weigh together.
    pub weight: usize,
    /// Numbers that it holds at once.
    pub held: usize,
    /// Its shaders, which run after each other.
    pub passes: Vec<Pass>,
}

/// What bands hold at once, in numbers, from which on they are compiled with their arrays in memory too: RDNA 3 has 128
/// registers for a thread while ten waves run, and some are for places.
pub const MUCH: usize = 96;

/// The numbers that the bands of a kernel in pieces hold at once, or one function.
fn held(pieces: &[Function]) -> usize {
    let bands = pieces.iter().filter(|piece| piece.spec.form != Form::SetUp);
    bands.map(|piece| piece.built.code.held(piece.spec.channels())).max().unwrap_or_default()
}

fn kernels_of(spec: &Spec, functions: &BTreeMap<Spec, Function>) -> Vec<Kernel> {
    let function = &functions[spec];
    let cost = function.built.code.cost(spec.channels());
    let once = |text: String| vec![Pass { spirv: shader::spirv(&text), times: 1 }];
    let kernel = |called, held: usize, passes: Vec<Pass>| Kernel {
        spec: spec.to_string(),
        called,
        operations: cost.total,
        special: cost.special,
        weight: weight(&function.built.code, spec.channels()),
        held,
        passes,
    };
    let whole = std::slice::from_ref(function);
    let mut all = vec![kernel(Called::Whole, held(whole), once(shader::whole(function)))];
    let built = |specs: Vec<Spec>| specs.iter().map(|piece| functions[piece].clone()).collect::<Vec<Function>>();
    let pieces = built(spec.in_pieces());
    if !pieces.is_empty() {
        all.push(kernel(Called::Pieces, held(&pieces), once(shader::in_pieces(&pieces, spec.order, 1))));
    }
    // A kernel that channels share operations in is another one for a single channel.
    let single = if spec.rgb { built(spec.base().in_pieces()) } else { pieces };
    if spec.rgb && !single.is_empty() {
        let text = shader::in_pieces(&single, spec.order, spec.channels());
        all.push(kernel(Called::Channels, held(&single), once(text)));
    }
    if held(&single) >= MUCH {
        let times = |piece: &Function| if piece.spec.form == Form::SetUp { 1 } else { spec.channels() as u64 };
        let pass = |(text, piece): (String, &Function)| Pass { spirv: shader::spirv(&text), times: times(piece) };
        let passes = shader::in_memory(&single).into_iter().zip(&single).map(pass).collect();
        all.push(kernel(Called::Memory, held(&single), passes));
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
