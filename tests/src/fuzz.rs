//! Inputs that nobody would write: those that zonal ships, changed at random places from a seed. Whatever a reader is given,
//! it returns a value or an error.

use crate::tabulated::{SIZE, array, pairs};
use exr::compression::Compression;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::LazyLock;
use std::time::{Duration, Instant};
use zonal_cli::inputs;
use zonal_codegen::catalog;
use zonal_codegen::environment::Map;
use zonal_codegen::families::Spec;
use zonal_codegen::families::isd::directions;
use zonal_codegen::families::product::plan::Records;
use zonal_codegen::ir::kernel::Param;
use zonal_codegen::promise::samples::Random;
use zonal_codegen::reflectance::measured::Measured;
use zonal_codegen::scene::{Maps, Scene};
use zonal_picture::mesh::Mesh;
use zonal_picture::normal_map::NormalMap;

/// The scenes beside their package.
const SCENES: [&str; 4] = [
    include_str!("../../scenes/glossy.toml"),
    include_str!("../../scenes/diffuse.toml"),
    include_str!("../../scenes/teapot.toml"),
    include_str!("../../scenes/lights.toml"),
];
/// A mesh with a face of each kind.
const MESH: &str = "o a\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
                    f 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//1 3//1 4//1\nf -1/-1/-1 -2/-2/-1 -3/-3/-1\n";
/// A scene of one triangle in glTF.
const GLTF: &str = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\
                    \"nodes\":[{\"mesh\":0,\"scale\":[-2,1,1]}],\
                    \"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0},\"indices\":1}]}],\
                    \"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\
                    \"min\":[0,0,0],\"max\":[1,1,0]},\
                    {\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"}],\
                    \"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":3}],\
                    \"buffers\":[{\"byteLength\":39,\"uri\":\"data:;base64,\
                    AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC\"}]}";
/// Plans of products: one by pairs, one with rings.
const PLANS: &str = "[[plan]]\norders = [2, 2, 3]\noperations = 27\nseed = 1\ntries = 1\n\
                     pairs = [\"10 10: 00 20\", \"11 10: 21\", \"11 11: 00 20 22\"]\n\
                     [[plan]]\norders = [2, 2, 2]\nsquare = true\noperations = 20\nseed = 1\ntries = 1\npairs = [\"10 10: 00\"]\n\
                     [[plan.rings]]\nclasses = [1, 1]\nnodes = 1\nexponent = 1\n";
/// Directions of one band.
const DIRECTIONS: &str = "[[set]]\nbands = 1\nseed = 1\ntries = 1\ncondition = 1.0\n\
                          directions = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]\n";
/// Inputs of `rotate:3:rgb`: nested, flat, and grey.
const INPUTS: &str = "[{\"q\": [0, 0, 0, 1], \"c\": [[1, 2, 3], [4, 5, 6], [7, 8, 9], [1, 2, 3], [4, 5, 6], [7, 8, 9], \
                      [1, 2, 3], [4, 5, 6], [7, 8, 9]]}, {\"q\": [0.5, -0.5, 5e-1, 0.5], \"c\": [1, 2, 3, 4, 5, 6, 7, 8, 9]}]";
/// What numbers are replaced by, and what is put in anywhere.
const EXTREMES: [&[u8]; 16] = [
    b"0",
    b"-1",
    b"1e308",
    b"-1e-320",
    b"nan",
    b"inf",
    b"18446744073709551616",
    b"4294967295",
    b"2147483648",
    b"\"",
    b"[[",
    b"\0",
    b"\xff",
    b"\n",
    b"environment",
    b"..",
];

/// Reads an input and returns whether it was accepted.
type Reader = fn(&[u8]) -> bool;

/// What is changed, and what reads it.
struct Kind {
    name: &'static str,
    seeds: Vec<Vec<u8>>,
    read: Reader,
}

fn kinds() -> Vec<Kind> {
    let texts = |texts: &[&str]| texts.iter().map(|text| text.as_bytes().to_vec()).collect();
    let specs: Vec<String> = catalog::standard().iter().map(Spec::to_string).collect();
    let hdr = [&b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n-Y 8 +X 16\n"[..], &[128, 64, 32, 129].repeat(128)]
        .concat();
    let cube = [&b"#?RADIANCE\n\n+X 16 -Y 12\n"[..], &[128, 64, 32, 129].repeat(192)].concat();
    // Its radiance is below zero, so that it is never accepted; what it tries is the decoder.
    let dwa = include_bytes!("../data/adversarial_sky_negative.exr").to_vec();
    let exr = [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::PIZ].map(exr);
    let normals =
        zonal_scenes::below("normals").next().and_then(zonal_scenes::embedded).expect("there is a normal map");
    vec![
        Kind {
            name: "scene",
            seeds: texts(&SCENES),
            read: |bytes| Scene::parse("fuzz", &String::from_utf8_lossy(bytes), Maps::Embedded(&[])).is_ok(),
        },
        Kind {
            name: "spec",
            seeds: specs.into_iter().map(String::into_bytes).collect(),
            read: |bytes| String::from_utf8_lossy(bytes).parse::<Spec>().is_ok(),
        },
        Kind { name: "hdr", seeds: vec![hdr], read: |bytes| Map::from_bytes("fuzz", bytes).is_ok() },
        Kind { name: "cube", seeds: vec![cube], read: |bytes| Map::from_bytes("fuzz", bytes).is_ok() },
        Kind { name: "png", seeds: vec![png()], read: |bytes| Map::from_bytes("fuzz", bytes).is_ok() },
        Kind { name: "exr", seeds: exr.into_iter().collect(), read: |bytes| Map::from_bytes("fuzz", bytes).is_ok() },
        Kind { name: "dwa", seeds: vec![dwa], read: |bytes| Map::from_bytes("fuzz", bytes).is_ok() },
        Kind { name: "obj", seeds: texts(&[MESH]), read: |bytes| Mesh::from_obj("fuzz", bytes).is_ok() },
        Kind {
            name: "gltf",
            seeds: texts(&[GLTF]),
            read: |bytes| zonal_bake::gltf::read("fuzz", bytes, Path::new("nowhere")).is_ok(),
        },
        Kind {
            name: "plans",
            seeds: texts(&[PLANS]),
            read: |bytes| Records::read(&String::from_utf8_lossy(bytes)).is_ok(),
        },
        Kind {
            name: "directions",
            seeds: texts(&[DIRECTIONS]),
            read: |bytes| directions::Records::read(&String::from_utf8_lossy(bytes)).is_ok(),
        },
        Kind {
            name: "reflectances",
            seeds: vec![
                array(&[2, 3, 2, 3, 3], &[0.5; 108]),
                pairs(2, |view, light| [view[0].abs(), light[2], 0.5]),
                {
                    let head = SIZE.map(|side| (side as i32).to_le_bytes()).concat();
                    [head, vec![0; 48]].concat()
                },
            ],
            read: |bytes| Measured::from_bytes("fuzz", bytes).is_ok(),
        },
        Kind { name: "inputs", seeds: texts(&[INPUTS]), read: read_inputs },
        Kind {
            name: "normals",
            seeds: vec![normals.to_vec()],
            read: |bytes| NormalMap::from_bytes("fuzz", bytes).is_ok(),
        },
    ]
}

/// Reads inputs of a kernel, as `zonal vectors` does.
fn read_inputs(bytes: &[u8]) -> bool {
    static KERNEL: LazyLock<(Spec, Vec<Param>)> = LazyLock::new(|| {
        let spec: Spec = "rotate:3:rgb".parse().expect("is in the catalogue");
        let params = spec.code().params().to_vec();
        (spec, params)
    });
    inputs::from_text("fuzz", &String::from_utf8_lossy(bytes), &KERNEL.0, &KERNEL.1).is_ok()
}

/// A map as an OpenEXR image.
fn exr(compression: Compression) -> Vec<u8> {
    use exr::prelude::*;
    let mut bytes = Cursor::new(Vec::new());
    let channels = SpecificChannels::rgb(|place: Vec2<usize>| (1.0_f32, place.x() as f32, f16::from_f32(0.5)));
    let encoding = Encoding { compression, ..Encoding::UNCOMPRESSED };
    let written = Image::from_encoded_channels((16, 8), encoding, channels).write().to_buffered(&mut bytes);
    written.expect("memory takes any image");
    bytes.into_inner()
}

/// A map as a PNG image of 16 bits.
fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 16, 8);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Sixteen);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&[77; 16 * 8 * 8]));
    written.expect("memory takes any image");
    bytes
}

/// A number below `end`, which is above 0.
fn below(random: &mut Random, end: usize) -> usize {
    (random.bits() % end as u64) as usize
}

/// Changes a text at one to eight places.
fn changed(seed: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=below(random, 8) {
        let at = below(random, bytes.len() + 1);
        // Most formats decide by their first bytes.
        let at = if random.bits().is_multiple_of(2) { at.min(below(random, 400)) } else { at };
        let to = (at + below(random, 16)).min(bytes.len());
        let extreme = EXTREMES[below(random, EXTREMES.len())];
        match below(random, 6) {
            0 if at < bytes.len() => bytes[at] = random.bits() as u8,
            1 => drop(bytes.drain(at..to)),
            2 => drop(bytes.splice(at..at, bytes[at..to].repeat(1 + below(random, 20)))),
            3 => drop(bytes.splice(at..at, extreme.iter().copied())),
            4 => {
                let is_digit = |byte: &u8| byte.is_ascii_digit();
                let start = bytes[at..].iter().position(is_digit).map_or(at, |found| at + found);
                let length = bytes[start..].iter().take_while(|byte| is_digit(byte)).count();
                drop(bytes.splice(start..start + length, extreme.iter().copied()));
            }
            _ if below(random, 10) == 0 => bytes.truncate(at),
            _ => {}
        }
    }
    bytes
}

/// What became of many inputs of one kind.
#[derive(Debug)]
pub struct Outcome {
    /// The kind.
    pub kind: &'static str,
    /// How many inputs were read.
    pub count: usize,
    /// How many of them the reader accepted.
    pub accepted: usize,
    /// The inputs on which the reader panicked, as text.
    pub panics: Vec<String>,
    /// How long the slowest input took.
    pub longest: Duration,
    /// That input.
    pub slowest: Vec<u8>,
}

/// Reads `count` changed inputs, shared between the kinds, from a seed.
pub fn run(count: usize, seed: u64) -> Vec<Outcome> {
    let kinds = kinds();
    let share = count.div_ceil(kinds.len());
    let outcome = |(number, kind): (u64, Kind)| {
        let mut random = Random::new(seed ^ (number << 32));
        let mut outcome = Outcome {
            kind: kind.name,
            count: share,
            accepted: 0,
            panics: vec![],
            longest: Duration::ZERO,
            slowest: vec![],
        };
        for _ in 0..share {
            let input = changed(&kind.seeds[below(&mut random, kind.seeds.len())], &mut random);
            let start = Instant::now();
            match catch_unwind(AssertUnwindSafe(|| (kind.read)(&input))) {
                Ok(accepted) => outcome.accepted += usize::from(accepted),
                Err(_) => outcome.panics.push(String::from_utf8_lossy(&input).into_owned()),
            }
            let time = start.elapsed();
            if time > outcome.longest {
                (outcome.longest, outcome.slowest) = (time, input);
            }
        }
        outcome
    };
    (0..).zip(kinds).map(outcome).collect()
}
