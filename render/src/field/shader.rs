//! A compute shader around a way's kernel: a thread a point, which reads its transfer and writes what it sends to the view.

use crate::field::tables::Cube;
use crate::field::ways::{Lobes, Turn, Way};
use std::fmt::Write;
use zonal_codegen::emit::Module;
// Names a language: the adapter takes this one.
use zonal_codegen::emit::language::WGSL;
use zonal_codegen::fault::Fault;
use zonal_codegen::generate;

/// How many threads a workgroup has.
pub const GROUP: usize = 64;
/// The binding of the first band's cube.
const CUBES: usize = 5;

/// What a shader's bindings hold, by their numbers.
pub struct Inputs<'a> {
    /// Transfer: the first coefficient of all points, then the next.
    pub transfer: &'a [f32],
    /// The light, R, G, B and nothing.
    pub light: &'a [[f32; 4]],
    /// Normals, and nothing.
    pub normals: &'a [[f32; 4]],
    /// A cube a band.
    pub cubes: &'a [Cube],
}

/// Which of a shader's bindings a way has: 0 transfer, 1 result, 2 light, 3 normals, 4 sampler, then a cube a band.
pub fn bindings(way: Way, order: usize) -> Vec<usize> {
    match way.turn {
        Turn::None => vec![0, 1, 2],
        Turn::Samples => [0, 1, 3, 4].into_iter().chain(CUBES..CUBES + order).collect(),
        _ => vec![0, 1, 2, 3],
    }
}

/// Returns the text of a way at an order.
///
/// # Errors
///
/// If there is no kernel, or it is too long for compilers.
pub fn text(way: Way, order: usize) -> Result<String, Fault> {
    let count = order * order;
    let mut text = String::new();
    let mut name = String::new();
    if let Some(spec) = way.spec(order, true)? {
        name = spec.name();
        let functions = generate::build(&[spec]);
        let module = Module { name: "field".to_owned(), functions, ..Module::default() };
        text = module.text(&WGSL).map_err(|limit| Fault::new(limit.to_string(), ""))?;
    }
    let has = bindings(way, order);
    let mut declare = |at: usize, line: &str| {
        if has.contains(&at) {
            let _ = writeln!(text, "@group(0) @binding({at}) {line};");
        }
    };
    declare(0, "var<storage, read> transfer: array<f32>");
    declare(1, "var<storage, read_write> result: array<vec4<f32>>");
    declare(2, &format!("var<uniform> light: array<vec4<f32>, {count}>"));
    declare(3, "var<storage, read> normals: array<vec4<f32>>");
    declare(4, "var linear: sampler");
    (0..order).for_each(|l| declare(CUBES + l, &format!("var band{l}_: texture_cube<f32>")));
    let _ = write!(
        text,
        "@compute @workgroup_size({GROUP})\nfn main(@builtin(global_invocation_id) id: vec3<u32>) {{\n    \
         let i = id.x;\n    if (i >= arrayLength(&result)) {{\n        return;\n    }}\n"
    );
    let list = |items: Vec<String>| format!("array<vec3<f32>, {count}>({})", items.join(", "));
    let light = list((0..count).map(|i| format!("light[{i}].xyz")).collect());
    if way.turn != Turn::None {
        text.push_str("    let n = normals[i].xyz;\n");
    }
    let axes = "    let k = 1.0 / (1.0 + n.z);\n    let x = vec3<f32>(1.0 - n.x * n.x * k, -n.x * n.y * k, -n.x);\n    \
                let y = vec3<f32>(-n.x * n.y * k, 1.0 - n.y * n.y * k, -n.y);\n";
    match way.turn {
        Turn::Quaternion => {
            text.push_str("    let q = normalize(vec4<f32>(n.y, -n.x, 0.0, 1.0 + n.z));\n");
            let _ = writeln!(text, "    let c = {name}(q, {light});");
        }
        Turn::Matrix => {
            text.push_str(axes);
            let _ = writeln!(text, "    let m = transpose(mat3x3<f32>(x, y, n));\n    let c = {name}(m, {light});");
        }
        Turn::Normal => {
            let _ = writeln!(text, "    let c = {name}(vec3<f32>(-n.xy, n.z), {light});");
        }
        Turn::Samples => {
            text.push_str(axes);
            let lobes = Lobes::of(order);
            for (at, v) in lobes.directions.iter().enumerate() {
                let [a, b, c] = v.map(|x| format!("{:?}", x as f32));
                let _ = writeln!(text, "    let d{at}_ = {a} * x + {b} * y + {c} * n;");
            }
            let read = |l: usize, at: &usize| format!("textureSampleLevel(band{l}_, linear, d{at}_, 0.0).xyz");
            let samples = lobes.bands.iter().enumerate();
            let samples = samples.flat_map(|(l, members)| members.iter().map(move |at| read(l, at)));
            let _ = writeln!(text, "    let c = {name}({});", list(samples.collect()));
        }
        Turn::None => {
            let _ = writeln!(text, "    let c = {light};");
        }
    }
    text.push_str("    let points = arrayLength(&result);\n    var sum = vec3<f32>(0.0);\n");
    for i in 0..count {
        let _ = writeln!(text, "    sum += transfer[{i}u * points + i] * c[{i}];");
    }
    text.push_str("    result[i] = vec4<f32>(sum, 1.0);\n}\n");
    Ok(text)
}
