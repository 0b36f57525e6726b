//! Every text of the catalogue under compilers that are not naga: glslangValidator for each version of GLSL that a file
//! is meant for, spirv-val for the SPIR-V that naga makes of WGSL.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use zonal_codegen::emit::Function;
use zonal_codegen::emit::language::{Arrays, GLSL, WGSL};
use zonal_gpu_tests::system::compile;
use zonal_gpu_tests::wrap;
use zonal_tests::catalogue;

/// The versions of GLSL that a file is meant for.
const VERSIONS: [&str; 3] = ["300 es", "330", "450"];
/// How many files one compiler process takes.
const BATCH: usize = 64;

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).expect("the target folder can be written");
    path
}

/// Writes a file for each function and hands all of them to a compiler.
fn all_compile(
    name: &str,
    extension: &str,
    write: impl Fn(&Function) -> Vec<u8> + Sync,
    compiler: impl Fn(&[PathBuf]) -> Result<(), String> + Sync,
) {
    let folder = folder(name);
    let files: Vec<PathBuf> = catalogue()
        .par_iter()
        .map(|function| {
            let path = folder.join(format!("{}.{extension}", function.shader_name()));
            std::fs::write(&path, write(function)).expect("the target folder can be written");
            path
        })
        .collect();
    let refused: Vec<String> = files.par_chunks(BATCH).filter_map(|batch| compiler(batch).err()).collect();
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}

fn glslang(files: &[PathBuf]) -> Result<(), String> {
    compile("glslangValidator", "glslang-tools", &[], files)
}

#[test]
fn glslang_accepts_every_glsl_text_in_every_version() {
    for version in VERSIONS {
        let write = |function: &Function| fragment(function, version, None);
        all_compile(&format!("glsl {version}"), "frag", write, glslang);
    }
}

/// A fragment shader around a function that passes arrays in one way.
fn fragment(function: &Function, version: &str, arrays: Option<Arrays>) -> Vec<u8> {
    let dialect = wrap::dialect(function, &GLSL, arrays);
    wrap::fragment(function, dialect, version, &wrap::file(function, dialect)).into_bytes()
}

#[test]
fn glslang_accepts_arrays_in_structs_and_by_reference() {
    for arrays in [Arrays::Struct, Arrays::Reference] {
        // The version that allows least.
        let write = |function: &Function| fragment(function, VERSIONS[0], Some(arrays));
        all_compile(arrays.name(), "frag", write, glslang);
    }
}

#[test]
fn glslang_refuses_one_bad_file_among_good_ones() {
    let folder = folder("glsl bad");
    let text = "#version 300 es\nprecision highp float;\nout vec4 colour;\nvoid main() { colour = vec4(1.0); }\n";
    let files: Vec<PathBuf> = ["good", "bad", "last"].map(|name| folder.join(format!("{name}.frag"))).into();
    for file in &files {
        std::fs::write(file, text).expect("the target folder can be written");
    }
    assert_eq!(glslang(&files), Ok(()));
    std::fs::write(&files[1], text.replace("1.0", "undeclared")).expect("the target folder can be written");
    assert!(glslang(&files).is_err());
}

/// The SPIR-V that naga makes of a compute shader around a function.
fn spirv(function: &Function) -> Vec<u8> {
    let dialect = wrap::dialect(function, &WGSL, None);
    let text = wrap::compute(function, dialect, &wrap::file(function, dialect));
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    let words =
        spv::write_vec(&module, &info, &spv::Options::default(), None).expect("naga writes what it has validated");
    bytemuck::pod_collect_to_vec(&words)
}

#[test]
fn spirv_val_accepts_what_naga_makes_of_every_wgsl_text() {
    let validate = |files: &[PathBuf]| {
        // It takes one file at a time.
        files.iter().try_for_each(|file| {
            compile("spirv-val", "spirv-tools", &["--target-env", "vulkan1.1"], std::slice::from_ref(file))
        })
    };
    all_compile("spirv", "spv", spirv, validate);
}
