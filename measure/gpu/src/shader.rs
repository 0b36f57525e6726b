//! Compute shaders around kernels, one thread a signal: what a kernel takes is read from buffers, item by item in rows of
//! threads, and what it gives is written there. A kernel in pieces reads, turns and writes one band at a time.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use zonal_codegen::emit::language::{Arrays, WGSL};
use zonal_codegen::emit::{Function, Module};
use zonal_codegen::families::Form;
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::{Param, Shape};
use zonal_codegen::ir::pieces::SET_UP;

/// Threads of a group: a wave of the GPUs before RDNA, two of those since.
pub(crate) const GROUP: usize = 64;
/// Signals that lie beside each other.
pub(crate) const ROW: usize = 1 << 16;

/// A buffer, and the place of its next number.
struct Buffer {
    name: &'static str,
    next: usize,
}

impl Buffer {
    fn new(name: &'static str) -> Self {
        Self { name, next: 0 }
    }

    fn number(&mut self) -> String {
        self.next += 1;
        format!("{}[{}u + at]", self.name, (self.next - 1) * ROW)
    }

    /// The numbers of an item: one, or one a channel.
    fn item(&mut self, channels: usize) -> String {
        match channels {
            1 => self.number(),
            _ => format!("vec3<f32>({}, {}, {})", self.number(), self.number(), self.number()),
        }
    }

    /// The statement that writes an item.
    fn written(&mut self, item: &str, channels: usize) -> String {
        match channels {
            1 => format!("    {} = {item};\n", self.number()),
            _ => ["x", "y", "z"].map(|letter| format!("    {} = {item}.{letter};\n", self.number())).concat(),
        }
    }
}

/// What a shader reads and writes.
struct Main {
    parameters: Buffer,
    coefficients: Buffer,
    results: Buffer,
    body: String,
}

impl Main {
    fn new() -> Self {
        let [parameters, coefficients, results] = ["parameters", "coefficients", "results"].map(Buffer::new);
        Self { parameters, coefficients, results, body: String::new() }
    }

    /// A parameter, read.
    fn argument(&mut self, function: &Function, param: &Param) -> String {
        let channels = param.kind.numbers(function.spec.channels());
        let buffer = if param.kind.is_scalar() { &mut self.parameters } else { &mut self.coefficients };
        let numbers: Vec<String> = (0..param.shape.len()).map(|_| buffer.item(channels)).collect();
        dialect(function).argument(param.shape, param.kind, &numbers)
    }

    /// What a piece takes besides the signal, each thing read once however many pieces take it.
    fn given(&mut self, piece: &Function, known: &mut BTreeMap<&'static str, String>) -> Vec<String> {
        let params = piece.built.code.params().iter().filter(|param| param.kind.is_scalar());
        params.map(|param| known.entry(param.name).or_insert_with(|| self.argument(piece, param)).clone()).collect()
    }

    /// A call, whose result gets a name.
    fn call(&mut self, function: &Function, name: &str, arguments: &[String]) {
        self.body += &format!("    let {name} = {}({});\n", function.shader_name(), arguments.join(", "));
    }

    /// Writes a result, item by item.
    fn write(&mut self, function: &Function, name: &str, (shape, kind): (Shape, Kind)) {
        for place in 0..shape.len() {
            let item = dialect(function).component(name, shape, kind, place);
            self.body += &self.results.written(&item, kind.numbers(function.spec.channels()));
        }
    }

    /// The whole text, with the functions that it calls.
    fn around(self, functions: &[Function]) -> String {
        let module = Module { functions: functions.to_vec(), ..Module::of(functions[0].clone()) };
        let text = module.text(&WGSL).unwrap_or_else(|limit| panic!("{limit}"));
        format!(
            "{text}\n\
             @group(0) @binding(0) var<storage, read> parameters: array<f32>;\n\
             @group(0) @binding(1) var<storage, read> coefficients: array<f32>;\n\
             @group(0) @binding(2) var<storage, read_write> results: array<f32>;\n\
             @compute @workgroup_size({GROUP})\n\
             fn main(@builtin(global_invocation_id) thread: vec3<u32>) {{\n    let at = thread.x;\n{}}}\n",
            self.body
        )
    }
}

fn dialect(function: &Function) -> zonal_codegen::emit::dialect::Dialect {
    function.dialect(&WGSL, None).unwrap_or_else(|limit| panic!("{limit}"))
}

/// Returns a shader that calls a function, as WGSL.
pub fn whole(function: &Function) -> String {
    let mut main = Main::new();
    let arguments: Vec<String> =
        function.built.code.params().iter().map(|param| main.argument(function, param)).collect();
    main.call(function, "result", &arguments);
    main.write(function, "result", function.built.code.result());
    main.around(std::slice::from_ref(function))
}

/// Returns a shader that does what a kernel of so many bands does, piece by piece, for `times` signals that are turned
/// alike, signal after signal in each band.
pub fn in_pieces(pieces: &[Function], order: usize, times: usize) -> String {
    let mut main = Main::new();
    let mut known = BTreeMap::new();
    if let Some(set_up) = pieces.iter().find(|piece| piece.spec.form == Form::SetUp) {
        let arguments = main.given(set_up, &mut known);
        main.call(set_up, "set_up", &arguments);
        known.insert(SET_UP, "set_up".to_owned());
    }
    let channels = pieces.iter().map(|piece| piece.spec.channels()).max().unwrap_or(1);
    for l in 0..order {
        for time in 0..times {
            let Some(piece) = pieces.iter().find(|piece| piece.spec.form == Form::Band(l)) else {
                for _ in 0..2 * l + 1 {
                    let item = main.coefficients.item(channels);
                    main.body += &main.results.written(&item, channels);
                }
                continue;
            };
            let signal = piece.built.code.params().last().expect("a band takes a signal").clone();
            let mut arguments = main.given(piece, &mut known);
            arguments.push(main.argument(piece, &signal));
            let name = format!("band_{l}_{time}_");
            main.call(piece, &name, &arguments);
            main.write(piece, &name, piece.built.code.result());
        }
    }
    main.around(pieces)
}

/// Where numbers of the signal and of the result lie in the memory of [`in_memory`], and those of the set-up; parameters lie
/// before.
const SIGNAL: usize = 2 << 20;
const MADE: usize = 1 << 20;

/// Returns the shaders that do what the pieces of a kernel do, a shader a piece with all arrays in memory.
pub fn in_memory(pieces: &[Function]) -> Vec<String> {
    let mut known = BTreeMap::from([(SET_UP, MADE.to_string())]);
    let mut parameters = Buffer::new("parameters");
    let mut shader = |piece: &Function| {
        let dialect = piece.dialect(&WGSL, Some(Arrays::Memory)).unwrap_or_else(|limit| panic!("{limit}"));
        let mut arguments: Vec<String> = Vec::new();
        for param in piece.built.code.params().iter().filter(|param| param.kind.is_scalar()) {
            let argument = known.entry(param.name).or_insert_with(|| {
                let first = parameters.next;
                let numbers: Vec<String> = (0..param.shape.len()).map(|_| parameters.number()).collect();
                match dialect.is_place(param.shape) {
                    true => first.to_string(),
                    false => dialect.argument(param.shape, param.kind, &numbers),
                }
            });
            arguments.push(argument.clone());
        }
        match piece.spec.form {
            Form::Band(l) => arguments.extend([SIGNAL + l * l; 2].map(|place| place.to_string())),
            _ => arguments.push(MADE.to_string()),
        }
        over_memory(piece, &format!("    {}({});\n", piece.shader_name(), arguments.join(", ")))
    };
    pieces.iter().map(&mut shader).collect()
}

/// A shader of a function that reads and writes a memory.
fn over_memory(function: &Function, body: &str) -> String {
    let module = Module { arrays: Some(Arrays::Memory), ..Module::of(function.clone()) };
    let text = module.text(&WGSL).unwrap_or_else(|limit| panic!("{limit}"));
    format!(
        "{text}\n\
         @group(0) @binding(0) var<storage, read> parameters: array<f32>;\n\
         @group(0) @binding(1) var<storage, read> coefficients: array<f32>;\n\
         @group(0) @binding(2) var<storage, read_write> results: array<f32>;\n\
         @group(0) @binding(3) var<storage, read_write> made: array<f32>;\n\
         var<private> at: u32;\n\
         fn zonal_read_f32(place: i32) -> f32 {{\n    \
         if place >= {SIGNAL} {{ return coefficients[u32(place - {SIGNAL}) * {ROW}u + at]; }}\n    \
         if place >= {MADE} {{ return made[u32(place - {MADE}) * {ROW}u + at]; }}\n    \
         return parameters[u32(place) * {ROW}u + at];\n}}\n\
         fn zonal_write_f32(place: i32, number: f32) {{\n    \
         if place >= {SIGNAL} {{ results[u32(place - {SIGNAL}) * {ROW}u + at] = number; }} else {{ \
         made[u32(place - {MADE}) * {ROW}u + at] = number; }}\n}}\n\
         @compute @workgroup_size({GROUP})\n\
         fn main(@builtin(global_invocation_id) thread: vec3<u32>) {{\n    at = thread.x;\n{body}}}\n"
    )
}

/// Returns a shader as SPIR-V.
///
/// # Panics
///
/// If naga refuses it, which is a fault of this file.
pub fn spirv(wgsl: &str) -> Vec<u32> {
    let module = naga::front::wgsl::parse_str(wgsl).unwrap_or_else(|error| panic!("{}", error.emit_to_string(wgsl)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{error:?}\n{wgsl}"));
    let options = spv::Options {
        flags: spv::WriterFlags::empty(),
        force_loop_bounding: false,
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        ..Default::default()
    };
    spv::write_vec(&module, &info, &options, None).unwrap_or_else(|error| panic!("{error}\n{wgsl}"))
}
