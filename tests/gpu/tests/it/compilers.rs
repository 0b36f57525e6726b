//! Every text of the catalogue under compilers that are not naga: glslangValidator for each version of GLSL that a file
//! is meant for, spirv-val for the SPIR-V that naga makes of WGSL. And the files of `generated/` together, as somebody has
//! them who copies several: all of GLSL under glslangValidator, each file twice; of WGSL, which has no guards, the first
//! orders under naga, and the names of all.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use zonal_codegen::catalog::{ORDERS, standard};
use zonal_codegen::emit::Function;
use zonal_codegen::emit::bands::Reads;
use zonal_codegen::emit::language::{Arrays, GLSL, Target, WGSL};
use zonal_codegen::families::Group;
use zonal_gpu_tests::system::compile;
use zonal_gpu_tests::wrap;
use zonal_tests::{catalogue, repository};

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
fn glslang_accepts_arrays_passed_in_other_ways() {
    for arrays in [Arrays::Struct, Arrays::Reference, Arrays::Vec4] {
        // The version that allows least.
        let write = |function: &Function| fragment(function, VERSIONS[0], Some(arrays));
        all_compile(arrays.name(), "frag", write, glslang);
    }
}

#[test]
fn glslang_accepts_bare_functions_in_every_version() {
    let bare = GLSL.form("bare").expect("GLSL has it");
    for version in VERSIONS {
        let folder = folder(&format!("bare {version}"));
        let low = catalogue().iter().filter(|function| function.spec.order <= 3);
        let files: Vec<PathBuf> = low
            .map(|function| {
                let dialect = wrap::dialect(function, &GLSL, None);
                let text = (bare.text)("", wrap::file(function, dialect));
                assert!(!text.contains("//") && !text.contains('#') && !text.contains("ZONAL_HIGHP"), "{text}");
                let text = format!("#define ZONAL_HIGHP\n{text}");
                let path = folder.join(format!("{}.frag", function.shader_name()));
                std::fs::write(&path, wrap::fragment(function, dialect, version, &text)).expect("can be written");
                path
            })
            .collect();
        for batch in files.chunks(BATCH) {
            glslang(batch).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}

#[test]
fn glslang_accepts_what_reads_a_lights_bands_in_every_version() {
    for version in VERSIONS {
        let folder = folder(&format!("bands {version}"));
        let write = |order: usize| {
            let reads = Reads { order, name: "light", group: 1, origin: "a test" };
            let text = reads.text(&GLSL).expect("GLSL has textures");
            // The file says the precision of all that it has, and needs none around it.
            let around = "out ZONAL_HIGHP vec4 colour;\nvoid main() { colour = vec4(light_0_at(vec3(1.0)), 1.0); }\n";
            let path = folder.join(format!("order{order}.frag"));
            std::fs::write(&path, format!("#version {version}\n{text}{around}")).expect("can be written");
            path
        };
        let files: Vec<PathBuf> = [1, 2, 3, 10, 16].map(write).into();
        glslang(&files).unwrap_or_else(|error| panic!("{version}: {error}"));
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

/// Whether glslang gives anything in a text relaxed precision where the shader around it asks for mediump.
fn is_relaxed(name: &str, text: &str) -> bool {
    // Of SPIR-V: how many words stand before the first instruction, two instructions, one decoration.
    const HEADER: usize = 5;
    const DECORATE: [u32; 2] = [71, 72];
    const RELAXED_PRECISION: u32 = 0;
    let folder = folder(&format!("mediump {name}"));
    let [source, target] = ["kernels.frag", "kernels.spv"].map(|file| folder.join(file));
    let whole =
        format!("#version 310 es\nprecision mediump float;\nprecision mediump int;\n{text}\nvoid main() {{}}\n");
    std::fs::write(&source, whole).expect("the target folder can be written");
    let arguments = ["-G", "--keep-uncalled", "-o", target.to_str().expect("the target folder has a name of letters")];
    let compiled = compile("glslangValidator", "glslang-tools", &arguments, &[source]);
    compiled.unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
    let bytes = std::fs::read(&target).expect("glslang has written it");
    let words: Vec<u32> =
        bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().expect("four"))).collect();
    let mut at = HEADER;
    let mut is_relaxed = false;
    while let Some(&first) = words.get(at) {
        let (length, instruction) = ((first >> 16) as usize, first & 0xffff);
        let decoration = DECORATE.iter().position(|known| *known == instruction);
        is_relaxed |= decoration.is_some_and(|member| words[at + 2 + member] == RELAXED_PRECISION);
        at += length;
    }
    is_relaxed
}

#[test]
fn no_kernel_computes_in_mediump_in_a_shader_that_does() {
    let files = group_files(&GLSL, ORDERS);
    assert!(files.len() > 40, "{}", files.len());
    let relaxed: Vec<&str> = files
        .par_iter()
        .filter(|(name, text)| is_relaxed(&name.replace('/', " "), text))
        .map(|(name, _)| &**name)
        .collect();
    assert!(relaxed.is_empty(), "{relaxed:?}");
    // A form with arrays in structs and a loop, which no file of the catalogue has.
    for (spec, arrays) in [("rotate:3:rgb", Arrays::Struct), ("rotate:3:loop", Arrays::Vec4)] {
        let function = &zonal_codegen::generate::build(&[spec.parse().expect("a spec")])[0];
        let text = wrap::file(function, wrap::dialect(function, &GLSL, Some(arrays)));
        assert!(!is_relaxed(&function.shader_name(), &text), "{spec}");
        // What the test would see if the words that prevent it were missing.
        let without = text.replace("#define ZONAL_HIGHP highp", "#define ZONAL_HIGHP");
        assert!(is_relaxed("signature", &without), "{spec}");
        assert!(is_relaxed("body", &text.replace("precision highp", "precision mediump")), "{spec}");
    }
}

#[test]
fn a_uniform_buffer_holds_what_vec4_takes() {
    for spec in ["eval:3:rgb", "eval:3", "rotate:2:angles", "rotate:3:loop"] {
        let function = &zonal_codegen::generate::build(&[spec.parse().expect("a spec")])[0];
        let accepts = |arrays: Arrays| {
            let dialect = wrap::dialect(function, &WGSL, Some(arrays));
            let of = function.built.code.params().last().expect("the coefficients");
            let text = format!(
                "{}\n@group(0) @binding(0) var<uniform> probe: {};\n",
                wrap::file(function, dialect),
                dialect.passed(of.shape, of.kind).text
            );
            let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)));
            Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).is_ok()
        };
        assert!(accepts(Arrays::Vec4), "{spec}");
        // Only vectors of three have a stride of sixteen bytes by themselves.
        assert_eq!(accepts(Arrays::Value), spec.ends_with("rgb"), "{spec}");
    }
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

/// The checked-in files of some orders in one language, each with its name.
fn group_files(target: Target, orders: impl Iterator<Item = usize>) -> Vec<(String, String)> {
    let all = standard();
    let has = |order: usize, group: Group| all.iter().any(|spec| spec.order == order && spec.family.group == group);
    orders
        .flat_map(|order| Group::ALL.map(|group| (order, group)))
        .filter(|&(order, group)| has(order, group))
        .map(|(order, group)| format!("{target}/sh{order}_{}.{}", group.name(), target.extension))
        .map(|name| {
            let path = repository("generated").join(&name);
            let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            (name, text)
        })
        .collect()
}

/// A fragment shader of files, one after the other, that uses nothing of them.
fn together<'a>(version: &str, files: impl Iterator<Item = &'a String>) -> String {
    let text: String = files.map(String::as_str).collect();
    let precision = if version.ends_with("es") { "precision highp float;\n" } else { "" };
    format!("#version {version}\n{precision}{text}\nout vec4 colour;\nvoid main() {{ colour = vec4(1.0); }}\n")
}

#[test]
fn glslang_accepts_all_group_files_together_and_each_of_them_twice() {
    let (folder, files) = (folder("glsl together"), group_files(&GLSL, ORDERS));
    assert!(files.len() > 6 * ORDERS.count(), "only {} files", files.len());
    VERSIONS.par_iter().for_each(|version| {
        let texts = || files.iter().map(|(_, text)| text);
        let path = folder.join(format!("{version}.frag"));
        std::fs::write(&path, together(version, texts().chain(texts()))).expect("the target folder can be written");
        glslang(&[path]).unwrap_or_else(|error| panic!("{error}"));
    });
}

#[test]
fn glslang_refuses_a_group_file_twice_without_its_guard() {
    let (folder, files) = (folder("glsl twice"), group_files(&GLSL, 2..=2));
    let bare = |text: &str| -> String {
        let inside = text.trim_end().strip_suffix("#endif").expect("the guard ends the file");
        let is_guard = |line: &&str| line.starts_with("#ifndef ZONAL_SH") || line.starts_with("#define ZONAL_SH");
        inside.lines().filter(|line| !is_guard(line)).map(|line| format!("{line}\n")).collect()
    };
    let texts: Vec<String> = files.iter().map(|(_, text)| bare(text)).collect();
    let path = folder.join("twice.frag");
    let check = |text: String| {
        std::fs::write(&path, text).expect("the target folder can be written");
        glslang(std::slice::from_ref(&path))
    };
    assert_eq!(check(together(VERSIONS[0], texts.iter())), Ok(()));
    let refused = check(together(VERSIONS[0], texts.iter().chain(&texts))).expect_err("a function stands twice");
    assert!(refused.contains("function already has a body"), "{refused}");
}

/// What a file of WGSL declares for all that stand beside it.
fn declared(text: &str) -> Vec<&str> {
    let keywords = ["fn", "const", "struct", "alias", "override", "var"];
    let words = text.lines().filter_map(|line| line.split_once(' ')).filter(|(first, _)| keywords.contains(first));
    words.filter_map(|(_, rest)| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()).collect()
}

#[test]
fn naga_accepts_the_wgsl_group_files_of_the_first_orders_together() {
    let text: String = group_files(&WGSL, 2..=4).into_iter().map(|(_, text)| text).collect();
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    // What the next test reads is what naga does, but that it renames what ends in a digit.
    assert_eq!(declared(&text).len(), module.functions.len() + module.constants.len());
}

#[test]
fn no_name_stands_in_two_wgsl_group_files() {
    let files = group_files(&WGSL, ORDERS);
    let mut places: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (file, text) in &files {
        // What a module begins with would have to stand before everything else.
        assert!(!text.lines().any(|line| ["enable ", "requires "].iter().any(|word| line.starts_with(word))), "{file}");
        declared(text).into_iter().for_each(|name| places.entry(name).or_default().push(file));
    }
    let functions = catalogue().iter().map(Function::shader_name);
    assert!(functions.clone().count() > 700);
    functions.for_each(|name| assert!(places.contains_key(name.as_str()), "{name} is in no file"));
    places.iter().for_each(|(name, files)| assert_eq!(files.len(), 1, "{name} stands in {files:?}"));
}
