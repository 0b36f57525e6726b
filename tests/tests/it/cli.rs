//! The command line as a user sees it: bad input of every kind gets one clear message, an exit code and no file; what
//! the commands print can be read back.
//! One file: a test a command.

use serde_json::Value;
use std::collections::BTreeSet;
use std::io::Read;
use std::process::{Command, Stdio};
use zonal_codegen::emit::language;
use zonal_codegen::emit::validate::validate;
use zonal_tests::command::{Folder, Run, command, zonal};
use zonal_tests::{numbers, repository};

/// Runs what must fail; the folder must hold nothing but what was there.
fn fails(folder: &Folder, arguments: &[&str]) -> String {
    let before = folder.names();
    let Run { code, out, err } = folder.run(arguments);
    assert_eq!(code, Some(1), "{arguments:?}: {out}{err}");
    assert_eq!(folder.names(), before, "{arguments:?} wrote something");
    assert!(!err.contains("panicked"), "{err}");
    err
}

/// A scene's text and what its error must say.
fn refused(scene: &str, place: &str, parts: &[&str]) {
    let folder = Folder::new();
    std::fs::copy(repository("scenes/maps/studio_256x128.hdr"), folder.path("studio.hdr")).expect("copied");
    folder.put("bad.toml", scene);
    for command in ["generate", "plan"] {
        let message = fails(&folder, &[command, "bad.toml"]);
        assert!(message.contains(&format!("bad.toml:{place}\n")), "{place} is not in\n{message}");
        assert!(message.contains('^') || message.contains('|'), "no caret in\n{message}");
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in\n{message}");
        }
    }
}

const ENVIRONMENT: &str = "name = \"a\"\n[environment]\nsignal = \"radiance\"\nbudget = 0.1\n";

#[test]
fn unknown_keys_are_refused_with_a_suggestion() {
    refused("nmae = \"a\"\n", "1:1", &["unknown field `nmae`", "did you mean `name`?", "^^^^"]);
    refused(
        "name = \"a\"\n[[kernel]]\nspecs = \"eval:3\"\n",
        "3:1",
        &["unknown field `specs`", "did you mean `spec`?", "3 | specs = \"eval:3\"", "^^^^^"],
    );
    refused(&format!("{ENVIRONMENT}map = \"studio.hdr\"\nbuget = 1\n"), "6:1", &["`buget`", "did you mean `budget`?"]);
    refused("name = \"a\"\n[[rotation]]\nangle = 3\n", "3:1", &["`angle`", "did you mean `max_angle`?"]);
    refused("name = \"a\"\ntargets = [\"wgsl\", \"glls\"]\n", "2:20", &["`glls` is no target", "did you mean `glsl`?"]);
    refused(
        "name = \"a\"\n[[rotation]]\nkind = \"tlit\"\n",
        "3:8",
        &["unknown variant `tlit`", "did you mean `tilt`?", "^^^^^^"],
    );
}

#[test]
fn wrong_types_are_refused() {
    refused("name = 5\n", "1:8", &["invalid type: integer `5`, expected a string"]);
    refused("name = \"a\"\n[[kernel]]\nspec = [\"eval:3\"]\n", "3:8", &["invalid type: sequence"]);
    refused("name = \"a\"\ntargets = \"wgsl\"\n", "2:11", &["expected a sequence"]);
    refused("name = \"a\"\nkernel = \"eval:3\"\n", "2:10", &["expected a sequence"]);
    let rotation = |line: &str| {
        let all = ["kind = \"y\"", "order = 5", "max_angle = 9", "max_error = 1"];
        let key = line.split(' ').next().expect("a key");
        let lines: Vec<&str> = all.into_iter().map(|other| if other.starts_with(key) { line } else { other }).collect();
        format!("name = \"a\"\n[[rotation]]\n{}\n", lines.join("\n"))
    };
    refused(&rotation("order = true"), "4:9", &["expected an order from 2 to 16 or \"environment\""]);
    refused(&rotation("order = \"five\""), "4:9", &["`five` is no order"]);
    refused(&rotation("order = 5.5"), "4:9", &["floating point", "expected an order"]);
    refused(&rotation("max_angle = \"15\""), "5:13", &["invalid type: string"]);
    refused(&rotation("max_angle = -1"), "5:13", &["-1 is out of range", "above 0 and up to 180"]);
    refused(&rotation("max_angle = nan"), "5:13", &["NaN is out of range"]);
    refused(&rotation("max_error = inf"), "6:13", &["inf is out of range"]);
    refused(
        &format!("{}signals = 0\n", rotation("order = 5")),
        "7:11",
        &["0 signals are out of range", "from 1 to 1000000"],
    );
    refused(&rotation("max_error = 1e-9"), "6:13", &["no method keeps an error of 0.000000001", "allow"]);
}

#[test]
fn orders_out_of_range_are_refused() {
    refused(
        "name = \"a\"\n[[kernel]]\nspec = \"eval:1\"\n",
        "3:14",
        &["order 1 is out of range", "orders are 2 to 16"],
    );
    refused("name = \"a\"\n[[kernel]]\nspec = \"eval:17\"\n", "3:9", &["order 17 is too long unrolled"]);
    refused("name = \"a\"\n[[kernel]]\nspec = 'basis:99'\n", "3:15", &["order 99 is out of range", "^^"]);
    refused("name = \"a\"\n[[kernel]]\nspec = \"eval:99999999999999999999\"\n", "3:14", &["is no order"]);
    refused("name = \"a\"\n[[rotation]]\nkind = \"y\"\norder = 17\n", "4:9", &["order 17 is out of range"]);
    refused("name = \"a\"\n[[rotation]]\nkind = \"y\"\norder = -5\n", "4:9", &["order -5 is out of range"]);
    refused(&format!("{ENVIRONMENT}map = \"studio.hdr\"\nmax_order = 40\n"), "6:13", &["order 40 is out of range"]);
    refused(&format!("{ENVIRONMENT}map = \"studio.hdr\"\nmax_order = \"environment\"\n"), "6:13", &["cannot be"]);
    refused(&ENVIRONMENT.replace("0.1", "1.5"), "2:1", &["missing field `map`"]);
    refused(&format!("{}map = \"studio.hdr\"\n", ENVIRONMENT.replace("0.1", "1.5")), "4:10", &["1.5 is out of range"]);
    refused("name = \"a\"\n[[kernel]]\nspec = \"eval:environment\"\n", "3:14", &["no environment", "^^^^^^^^^^^"]);
}

#[test]
fn what_no_picture_can_be_made_of_is_refused() {
    let brdf = |table: &str, place: &str, parts: &[&str]| {
        refused(&format!("name = \"a\"\n[brdf]\n{table}\n"), place, parts);
    };
    brdf("kind = \"phnog\"", "3:8", &["unknown variant `phnog`", "did you mean `phong`?"]);
    brdf("exponent = 2", "2:1", &["missing field `kind`"]);
    brdf("kind = \"phong\"", "3:8", &["needs its `exponent`", "add `exponent = 20`"]);
    brdf("kind = \"phong\"\nexponent = 0", "4:12", &["an exponent of 0 is out of range", "from 1 to 1000"]);
    brdf("kind = \"lambert\"\nexponent = 3", "4:12", &["has no `exponent`", "leave it out"]);
    brdf("kind = \"ward\"\nalpha = [0.2, nan]", "4:9", &["a roughness of NaN is out of range", "from 0.05 to 1"]);
    brdf("kind = \"ward\"\nalpha = [0.2]", "4:9", &["expected a number or two"]);
    let picture = |line: &str, column: &str, parts: &[&str]| {
        let scene = format!("name = \"a\"\n[picture]\nmesh = \"sphere\"\n{line}\n");
        refused(&scene, &format!("4:{column}"), parts);
    };
    picture("nromals = \"a.png\"", "1", &["`nromals`", "did you mean `normals`?"]);
    picture("size = [0, 540]", "8", &["0 by 540 pixels is out of range", "from 1 to 4096"]);
    picture("size = [960, 5400000000]", "8", &["960 by 5400000000 pixels is out of range"]);
    picture("size = [960, -1]", "14", &["integer `-1`"]);
    picture("order = 17", "9", &["order 17 is out of range: orders are 2 to 16"]);
    picture("method = \"tlit\"", "10", &["unknown variant `tlit`", "did you mean `tilt`?"]);
    picture("strength = inf", "12", &["a strength of inf is out of range", "from 0 to 10"]);
    picture("elevation = 90", "13", &["an elevation in degrees of 90 is out of range"]);
    picture("distance = 1", "12", &["a distance in radii of the object of 1 is out of range"]);
    picture("field = 180", "9", &["a field of view in degrees of 180 is out of range"]);
    picture("exposure = 1e9", "12", &["an exposure in stops of 1000000000 is out of range"]);
    refused("name = \"a\"\n[picture]\nsize = [1, 1]\n", "2:1", &["missing field `mesh`"]);
}

#[test]
fn unknown_methods_are_refused() {
    refused(
        "name = \"a\"\n[[kernel]]\nspec = \"rotat:5\"\n",
        "3:9",
        &["`rotat` is no family", "did you mean `rotate`?", "^^^^^"],
    );
    refused("name = \"a\"\n[[kernel]]\nspec = \"rotate:5:zyx\"\n", "3:18", &["`zyx` is no method", "`zyz`"]);
    refused("name = \"a\"\n[[kernel]]\nspec = \"eval:5:rbg\"\n", "3:16", &["`rbg` is no method of `eval`", "`rgb`"]);
    refused("name = \"a\"\n[[kernel]]\nspec = \"\"\n", "3:9", &["is no family"]);
    let folder = Folder::new();
    let message = fails(&folder, &["show", "rotate:5:zxz"]);
    assert!(message.contains("--> SPEC:1:10\n") && message.contains("did you mean"), "{message}");
}

#[test]
fn methods_that_cannot_take_the_angle_are_refused() {
    refused(
        "name = \"a\"\n[[kernel]]\nspec = \"taylor15:5\"\nmax_angle = 60\n",
        "4:13",
        &["`taylor15:5` takes angles up to", "not 60", "`rotate_y:5` takes every angle", "^^"],
    );
    refused("name = \"a\"\n[[kernel]]\nspec = \"tilt:5\"\nmax_angle = 90.5\n", "4:13", &["not 90.5", "`rotate:5`"]);
    let folder = Folder::new();
    folder.put("good.toml", "name = \"a\"\n[[kernel]]\nspec = \"rotate_y:5\"\nmax_angle = 60\n");
    assert_eq!(folder.run(["plan", "good.toml"]).code, Some(0));
}

#[test]
fn duplicate_names_are_refused() {
    let kernels = |kernels: &[&str]| {
        let tables: Vec<String> = kernels.iter().map(|keys| format!("[[kernel]]\n{keys}\n")).collect();
        format!("name = \"a\"\n{}", tables.concat())
    };
    refused(&kernels(&["spec = \"eval:3\"", "spec = \"eval:3\""]), "5:8", &["`eval:3` stands twice"]);
    refused(
        &kernels(&["spec = \"eval:3\"\nname = \"shade\"", "spec = \"eval:4\"\nname = \"shade\""]),
        "7:8",
        &["the name `shade` is taken already"],
    );
    refused(
        &kernels(&["spec = \"eval:3\"", "spec = \"eval:4\"\nname = \"sh3_eval\""]),
        "6:8",
        &["`sh3_eval` is taken"],
    );
    // In Rust the functions of an order have the short names.
    refused(&kernels(&["spec = \"eval:3\"", "spec = \"basis:3\"\nname = \"eval\""]), "6:8", &["`eval` is taken"]);
    refused("name = \"a\"\nname = \"b\"\n", "2:1", &["duplicate key"]);
    refused("name = \"a\"\ntargets = [\"wgsl\", \"wgsl\"]\n", "2:20", &["`wgsl` stands twice"]);
}

#[test]
fn names_that_a_target_would_not_take_are_refused() {
    let named = |name: &str| format!("name = \"a\"\n[[kernel]]\nspec = \"eval:3\"\nname = \"{name}\"\n");
    for (name, why) in [
        ("my-eval", "is no identifier"),
        ("3eval", "is no identifier"),
        ("größe", "is no identifier"),
        ("", "is no identifier"),
        ("texture", "reserved in WGSL"),
        ("precise", "reserved in WGSL"),
        ("sampler2D", "reserved in GLSL"),
        ("subroutine", "reserved in WGSL"),
        ("dyn", "reserved in Rust"),
        ("box", "reserved in Rust"),
        ("mix", "built-in function"),
        ("gl_eval", "starts with `gl_`"),
        ("my__eval", "holds `__`"),
        ("eval3", "ends in a digit, and naga renames"),
    ] {
        let why = if name == "texture" { "`texture` is" } else { why };
        refused(&named(name), "4:8", &[why]);
    }
    refused("name = \"../a\"\n[[kernel]]\nspec = \"eval:3\"\n", "1:8", &["is no identifier"]);
    refused("name = \"\"\n[[kernel]]\nspec = \"eval:3\"\n", "1:8", &["is no identifier"]);
    refused(&format!("{ENVIRONMENT}map = \"studio.hdr\"\nname = \"fn\"\n"), "6:8", &["reserved in WGSL"]);
}

#[test]
fn maps_that_cannot_be_used_are_refused() {
    let folder = Folder::new();
    let scene = |map: &str| {
        folder.put("bad.toml", format!("{ENVIRONMENT}map = \"{map}\"\n[[kernel]]\nspec = \"eval:environment\"\n"));
        let message = fails(&folder, &["generate", "bad.toml"]);
        assert!(message.contains("bad.toml:5:7\n") && message.contains('^'), "{message}");
        let alone = fails(&folder, &["project", map]);
        let first = |text: &str| text.lines().next().unwrap_or("").to_owned();
        assert!(first(&alone).contains(&first(&message)), "{alone}\n{message}");
        message
    };
    let studio = std::fs::read(repository("scenes/maps/studio_256x128.hdr")).expect("a map");
    assert!(scene("none.hdr").contains("none.hdr: cannot be read"));
    assert!(scene(".").contains("hold no face of a cube"));
    folder.put("short.hdr", &studio[..studio.len() / 2]);
    assert!(scene("short.hdr").contains("cannot be decoded (it ends too early)"));
    folder.put("text.exr", "no image at all");
    assert!(scene("text.exr").contains("neither Radiance HDR nor OpenEXR"));
    folder.put("empty.hdr", "");
    assert!(scene("empty.hdr").contains("holds nothing"));
    std::fs::copy(repository("tests/data/adversarial_sky_negative.exr"), folder.path("sky.exr")).expect("copied");
    let message = scene("sky.exr");
    assert!(
        message.contains("negative radiance, down to -3394") && message.contains("clamp the map to 0"),
        "{message}"
    );
    for (value, name) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf")] {
        folder.put("odd.exr", exr(value));
        assert!(
            scene("odd.exr")
                .contains(&format!("1 of its texels are not finite, the first at column 1, row 0 ({name})"))
        );
    }
}

/// An uncompressed OpenEXR image of 2×1 texels, all of it 1 but for the red of the second texel.
fn exr(red: f32) -> Vec<u8> {
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        for text in [name, kind] {
            bytes.extend(text.as_bytes());
            bytes.push(0);
        }
        bytes.extend((value.len() as u32).to_le_bytes());
        bytes.extend(value);
    };
    let mut channels = Vec::new();
    for name in [b'B', b'G', b'R'] {
        channels.extend([name, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
    }
    channels.push(0);
    let window: Vec<u8> = [0u32, 0, 1, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    attribute("channels", "chlist", &channels);
    attribute("compression", "compression", &[0]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    bytes.push(0);
    let start = bytes.len() as u64 + 8;
    bytes.extend(start.to_le_bytes());
    bytes.extend(0u32.to_le_bytes());
    bytes.extend(24u32.to_le_bytes());
    bytes.extend([1.0, 1.0, 1.0, 1.0, 1.0, red].iter().flat_map(|x: &f32| x.to_le_bytes()));
    bytes
}

#[test]
fn output_never_leaves_its_folder() {
    for output in ["../out", "/tmp/out", "a/../../out", ""] {
        let scene = format!("name = \"a\"\noutput = \"{output}\"\n[[kernel]]\nspec = \"eval:3\"\n");
        refused(&scene, "2:10", &["leads out of the folder", "without `..`"]);
    }
}

#[test]
fn folders_that_cannot_be_written_are_refused() {
    let folder = Folder::new();
    folder.put("file", "a regular file");
    let message = fails(&folder, &["generate", "--out", "file/out"]);
    assert!(message.contains("cannot create `file/out`: `file` is a file"), "{message}");
    // A folder stands where a file should be: nothing beside it is written.
    let taken = folder.path("out/glossy.rs");
    std::fs::create_dir_all(&taken).expect("a folder");
    let message = fails(&folder, &["generate", "--out", "out"]);
    assert!(message.contains("cannot write `out/glossy.rs`"), "{message}");
    assert_eq!(std::fs::read_dir(folder.path("out")).expect("readable").count(), 1);
}

#[test]
fn texts_that_are_no_scenes_are_refused() {
    refused("name = \"a\n", "1:10", &["string"]);
    refused("name = \"a\"\n[[kernel]\n", "2:10", &["unclosed", "^"]);
    refused("[[kernel]]\nspec = \"eval:3\"\n", "1:1", &["missing field `name`", "add it"]);
    refused("name = \"a\"\n", "1:8", &["asks for nothing"]);
    refused("name = \"a\"\n[environment]\n", "2:1", &["missing field"]);
    let folder = Folder::new();
    for (content, part) in [
        (&b""[..], "bad.toml: is empty"),
        (b" \n\n", "is empty"),
        (b"\xff\xfe\0\x01", "is no text (byte 0"),
        (b"\0\0", "bad.toml:1:"),
    ] {
        folder.put("bad.toml", content);
        let message = fails(&folder, &["generate", "bad.toml"]);
        assert!(message.contains(part), "{message}");
    }
    folder.put("bad.toml", vec![b'#'; 2 << 20]);
    assert!(fails(&folder, &["generate", "bad.toml"]).contains("larger than a scene may be"));
    assert!(fails(&folder, &["generate", "none.toml"]).contains("none.toml: cannot be read"));
    assert!(fails(&folder, &["generate", "."]).contains("cannot be read"));
    // Deep nesting must not overflow the stack.
    folder.put("bad.toml", format!("name = {}", "[".repeat(100_000)));
    fails(&folder, &["generate", "bad.toml"]);
}

#[test]
fn arguments_that_make_no_sense_are_usage_errors() {
    let folder = Folder::new();
    for arguments in [
        &["generate", "a", "b"][..],
        &["frobnicate"],
        &["show", "eval:3", "--target", "hlsl"],
        &["list", "--order", "99"],
        &["project", "a.hdr", "--order", "0"],
        &["vectors", "eval:3", "--count", "0"],
    ] {
        let run = folder.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.err);
        assert!(run.err.contains("error:"), "{}", run.err);
    }
}

#[test]
fn generating_twice_touches_nothing() {
    let folder = Folder::new();
    let first = folder.run(["generate"]);
    assert_eq!(first.code, Some(0), "{}", first.err);
    let names = ["glossy.glsl", "glossy.md", "glossy.rs", "glossy.wgsl"];
    let state = || {
        names.map(|name| {
            let path = folder.path("zonal-out/glossy").join(name);
            let time = std::fs::metadata(&path).and_then(|data| data.modified()).expect("a file");
            (std::fs::read(path).expect("a file"), time)
        })
    };
    let before = state();
    let second = folder.run(["generate", repository("scenes/glossy.toml").to_str().expect("a path")]);
    assert!(second.out.contains(" 0 were new or changed"), "{}", second.out);
    assert_eq!(state(), before, "the embedded scene is the one in scenes/, and unchanged files stay");
    assert_eq!(std::fs::read_dir(folder.path("zonal-out/glossy")).expect("readable").count(), names.len());
    for part in [
        "The light `city`",
        "order 7, which is bands 0 to 6: what `phong:8` reflects errs by",
        "`sh7_rotate_rgb`",
        "glossy.wgsl (",
        " validated, of which ",
    ] {
        assert!(first.out.contains(part), "`{part}` is not in\n{}", first.out);
    }
}

#[test]
fn list_has_the_figures() {
    let folder = Folder::new();
    let run = folder.run(["list", "--json", "--order", "3"]);
    let rows: Value = serde_json::from_str(&run.out).expect("JSON");
    let rows = rows.as_array().expect("a list");
    assert!(rows.len() > 40);
    for row in rows {
        for key in ["mul", "add", "fma", "special", "total", "order", "channels", "constants", "live", "rounding_f32"] {
            assert!(row[key].is_number(), "{key} in {row}");
        }
        let sum = ["mul", "add", "fma", "choice"].iter().map(|key| row[key].as_u64().expect("a count")).sum::<u64>();
        assert_eq!(row["total"].as_u64(), Some(sum), "{row}");
    }
    let specs: BTreeSet<&str> = rows.iter().filter_map(|row| row["spec"].as_str()).collect();
    assert!(specs.contains("rotate:3") && specs.contains("eval:3:rgb"));
    let table = folder.run(["list", "--order", "3", "--family", "tilt"]).out;
    assert_eq!(table.lines().count(), 4, "{table}");
    assert!(table.contains("| tilt:3:rgb |"), "{table}");
}

#[test]
fn show_prints_what_validates() {
    let folder = Folder::new();
    for spec in ["basis:5", "eval:3:rgb", "rotate:4", "tilt:6:rgb", "taylor15:5:loop", "zhf:3"] {
        for target in language::ALL {
            let run = folder.run(["show", spec, "--target", target.name]);
            assert_eq!(run.code, Some(0), "{}", run.err);
            assert!(run.out.contains("@generated by zonal") && run.out.contains(spec));
            validate(target, spec, &run.out).expect("valid");
        }
    }
}

#[test]
fn vectors_read_their_own_inputs() {
    let folder = Folder::new();
    for spec in [
        "basis:4",
        "eval:3:rgb",
        "rotate:3:matrix:rgb",
        "rotate:4:euler",
        "taylor15:5",
        "tilt:4",
        "rotate_z:3",
        "rotate:5:loop",
    ] {
        let text = folder.run(["vectors", spec, "--count", "20", "--seed", "7"]).out;
        let vectors: Value = serde_json::from_str(&text).expect("JSON");
        let cases = vectors["cases"].as_array().expect("cases");
        assert_eq!(cases.len(), 20);
        let inputs: Vec<&Value> = cases.iter().map(|case| &case["inputs"]).collect();
        folder.put("inputs.json", serde_json::to_string(&inputs).expect("JSON"));
        assert_eq!(folder.run(["vectors", spec, "--inputs", "inputs.json"]).out, text, "{spec}");
    }
}

#[test]
fn vectors_say_the_domain_of_each_parameter_in_words() {
    let folder = Folder::new();
    for (spec, domains) in [
        ("basis:4", &[Some("for dir of unit length")][..]),
        ("tilt:3:rgb", &[Some("for every n of unit length with n.z >= 0"), None]),
        ("rotate:3:angles", &[Some("for every angle"), None]),
        ("rotate:5:lf3", &[Some("for every angle"), Some("for an angle up to 25 degrees"), None]),
        ("lifted:5", &[Some("for an angle up to 30 degrees about y")]),
    ] {
        let vectors: Value = serde_json::from_str(&folder.run(["vectors", spec, "--count", "1"]).out).expect("JSON");
        let found: Vec<Option<&str>> = vectors["parameters"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|param| param.get("domain").expect("is said").as_str())
            .collect();
        assert_eq!(found, domains, "{spec}");
    }
}

#[test]
fn vectors_take_lists_flat_or_nested_and_grey() {
    let folder = Folder::new();
    let results = |spec: &str, inputs: &str| {
        folder.put("inputs.json", inputs);
        let run = folder.run(["vectors", spec, "--inputs", "inputs.json"]);
        assert_eq!(run.code, Some(0), "{}", run.err);
        let vectors: Value = serde_json::from_str(&run.out).expect("JSON");
        vectors["cases"][0]["f64"].clone()
    };
    let up = numbers(&results("basis:2", r#"[{"dir": [0, 0, 1]}]"#));
    assert_eq!(up[1], 0.0);
    assert!((up[0] - 0.28209479177387814).abs() < 1e-15 && (up[2] - 0.4886025119029199).abs() < 1e-15);
    let grey = results("eval:2:rgb", r#"[{"dir": [0, 0, 1], "c": [1, 2, 3, 4]}]"#);
    let triples = results("eval:2:rgb", r#"[{"dir": [0, 0, 1], "c": [[1,1,1],[2,2,2],[3,3,3],[4,4,4]]}]"#);
    assert_eq!(grey, triples);
    assert_eq!(numbers(&grey), [numbers(&grey)[0]; 3]);
    let nested = results("rotate:2:matrix", r#"[{"m": [[1,0,0],[0,1,0],[0,0,1]], "c": [1,2,3,4]}]"#);
    assert_eq!(numbers(&nested), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(results("rotate:2:matrix", r#"[{"m": [1,0,0,0,1,0,0,0,1], "c": [1,2,3,4]}]"#), nested);
    assert_eq!(numbers(&results("rotate_z:2", r#"[{"cs": [1, 0], "c": [1,2,3,4]}]"#)), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn vectors_say_what_is_wrong_with_inputs() {
    let folder = Folder::new();
    for (inputs, parts) in [
        ("[{\"dir\": [0, 0 1]}]", &["inputs.json:1:16\n", "is no JSON"][..]),
        ("{\"dir\": [0, 0, 1]}", &["is no list"]),
        ("[5]", &["item 0 is no object"]),
        ("[{\"dir\": [0, 0, 1]}, {}]", &["object 1 has no `dir`"]),
        ("[{\"direction\": [0, 0, 1]}]", &["object 0: `direction` is no parameter", "are dir"]),
        ("[{\"dir\": [0, 1]}]", &["object 0, `dir`: expected a list of 3 numbers, found a list of 2"]),
        ("[{\"dir\": [0, 0, \"1\"]}]", &["expected a number, found a text"]),
        ("[{\"dir\": [0, 0, null]}]", &["expected a number, found null"]),
        ("[{\"dir\": [0, 0, [1]]}]", &["expected a number, found a list of 1"]),
        ("[{\"dir\": 1}]", &["expected a list of 3 numbers, found the number 1"]),
        ("[{\"dir\": [0, 0, 1e300]}]", &["does not fit in f32"]),
        ("[{\"dir\": [0, 0, NaN]}]", &["is no JSON"]),
        ("", &["is no JSON"]),
    ] {
        folder.put("inputs.json", inputs);
        let message = fails(&folder, &["vectors", "basis:3", "--inputs", "inputs.json"]);
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in\n{message}");
        }
    }
    fails(&folder, &["vectors", "basis:3", "--inputs", "none.json"]);
    fails(&folder, &["vectors", "basis:3:rgb"]);
}

#[test]
fn a_closed_pipe_ends_in_silence() {
    let mut child = command()
        .args(["vectors", "rotate:5", "--count", "2000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("runs");
    let mut start = [0; 10];
    child.stdout.take().expect("a pipe").read_exact(&mut start).expect("prints");
    let end = child.wait_with_output().expect("ends");
    assert_eq!((end.status.code(), String::from_utf8_lossy(&end.stderr).as_ref()), (Some(0), ""));
}

#[test]
fn a_catalogue_is_checked_and_never_eats_other_files() {
    let folder = Folder::new();
    folder.put("notes.txt", "mine");
    let message = fails(&folder, &["catalog", "--dir", "."]);
    assert!(message.contains("`.` is no catalogue: it holds files, but no COSTS.md"), "{message}");
    folder.put("COSTS.md", "stale");
    let Run { code, out, err } = folder.run(["catalog", "--check", "--dir", "."]);
    assert_eq!(code, Some(1));
    for line in ["stale: COSTS.md", "orphaned: notes.txt"] {
        assert!(out.lines().any(|found| found == line), "{line}");
    }
    // Some hundred are missing: the first of them are named.
    let missing: Vec<&str> = out.lines().filter(|line| line.starts_with("missing: ")).collect();
    assert!(missing.len() == 11 && missing[10].ends_with(" others"), "{out}");
    assert!(err.contains("run `zonal catalog --dir .`"), "{err}");
    let message = fails(&folder, &["catalog", "--dir", "."]);
    assert!(message.contains("zonal did not write its `notes.txt`"), "{message}");
}

#[test]
fn the_renderer_is_found_and_what_it_says_is_passed_on() {
    let folder = Folder::new();
    // Alone in a folder, so that no renderer is beside it.
    let alone = folder.path("zonal");
    std::fs::copy(zonal(), &alone).expect("copied");
    let run = |path: &std::path::Path, arguments: &[&str]| {
        // Not under cargo, which would compile the renderer.
        Command::new(&alone).env("PATH", path).env_remove("CARGO").args(arguments).output().expect("the command starts")
    };
    let output = run(&folder.path("nowhere"), &["render", "a.toml"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    for part in ["`zonal-render` is neither", "cargo install zonal-render", "cargo run -p zonal-render"] {
        assert!(message.contains(part), "{message}");
    }
    if cfg!(unix) {
        use std::os::unix::fs::PermissionsExt;
        std::fs::create_dir(folder.path("bin")).expect("a folder");
        let other = folder.put("bin/zonal-render", "#!/bin/sh\necho \"drawn $*\"\nexit 3\n");
        std::fs::set_permissions(&other, std::fs::Permissions::from_mode(0o755)).expect("permitted");
        let output =
            run(other.parent().expect("a folder"), &["render", "a.toml", "--compare", "-o", "b.png", "--help"]);
        assert_eq!(String::from_utf8_lossy(&output.stdout), "drawn a.toml --compare -o b.png --help\n");
        assert_eq!(output.status.code(), Some(3));
    }
}

#[test]
fn the_explorer_refuses_a_port_that_is_taken_and_a_folder_that_cannot_be() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port");
    let port = taken.local_addr().expect("an address").port().to_string();
    let folder = Folder::new();
    let message = fails(&folder, &["explore", "--port", &port]);
    assert!(message.contains(&format!("cannot serve on port {port} of 127.0.0.1")), "{message}");
    assert!(message.contains("name another with `--port`"), "{message}");
    folder.put("file", "in the way");
    let message = fails(&folder, &["explore", "--no-serve", "--out", "file/page"]);
    assert!(message.contains("cannot create `file/page`: `file` is a file"), "{message}");
    for arguments in [["--port", "99999"], ["--port", "http"]] {
        let Run { code, err, .. } = folder.run([&["explore"], &arguments[..]].concat());
        assert_eq!(code, Some(2), "{err}");
        assert!(err.contains("invalid value"), "{err}");
    }
}

/// The answer of a server to a request line: its status, its content type and its body.
fn answer(address: &str, request: &str) -> (String, String, Vec<u8>) {
    use std::io::Write;
    let mut stream = std::net::TcpStream::connect(address).expect("the server listens");
    write!(stream, "{request} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n").expect("sent");
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).expect("answered");
    let end = bytes.windows(4).position(|window| window == b"\r\n\r\n").expect("a head");
    let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let content = head.lines().find_map(|line| line.strip_prefix("Content-Type: ")).unwrap_or("").to_owned();
    (head.split(' ').nth(1).unwrap_or("").to_owned(), content, bytes[end + 4..].to_vec())
}

/// The answer of a server to a body that is sent to `/map` with some more lines of a head: its status and its body.
fn posted(address: &str, lines: &str, body: &[u8]) -> (String, String) {
    use std::io::Write;
    let mut stream = std::net::TcpStream::connect(address).expect("the server listens");
    write!(stream, "POST /map HTTP/1.1\r\nHost: {address}\r\n{lines}\r\n").expect("sent");
    stream.write_all(body).expect("sent");
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).expect("answered");
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let (head, body) = text.split_once("\r\n\r\n").expect("a head");
    (head.split(' ').nth(1).unwrap_or("").to_owned(), body.to_owned())
}

/// What a dropped map is answered with, and what guards the place it is sent to.
fn takes_maps(address: &str) {
    let hdr = [&b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 2 +X 4\n"[..], &[128, 64, 32, 129].repeat(8)].concat();
    let body = [format!("{} folder/sky.hdr\n\n", hdr.len()).as_bytes(), &hdr].concat();
    let length = |length: usize| format!("Content-Length: {length}\r\n");
    let own = format!("{}Origin: http://{address}\r\n", length(body.len()));
    let (status, row) = posted(address, &own, &body);
    assert_eq!(status, "200", "{row}");
    let row: serde_json::Value = serde_json::from_str(&row).expect("a row of the index");
    assert_eq!((&row["id"], &row["label"]), (&"own-dropped-1".into(), &"sky.hdr".into()));
    assert_eq!(row["told"], "4 × 2, latitude and longitude, Radiance HDR");
    // A uniform map is band 0 alone.
    assert!((row["shares"][0].as_f64().expect("a number") - 1.0).abs() < 1e-12, "{row}");
    let file = format!("GET /{}", row["file"].as_str().expect("a path"));
    assert_eq!(answer(address, &file).0, "200");
    for (lines, body, status, told) in [
        (length(14), &b"7 a.txt\n\nA text"[..], "422", "the request is none of this page: it ends too early"),
        (
            length(15),
            b"6 a.txt\n\nA text",
            "422",
            "a.txt: holds unknown data, neither Radiance HDR nor OpenEXR nor PNG",
        ),
        (length(13), b"4 a.jpg\n\n\xff\xd8\xff\xe0", "422", "holds a Jpeg image"),
        (length((1 << 28) + 1), b"", "413", "larger than 256 MB together; name them on the command line"),
        (String::new(), b"", "411", "a body needs its length"),
        (length(1) + "Origin: http://example.org\r\n", b"a", "403", "maps are taken from this page alone"),
        (length(1) + "Host: example.org\r\n", b"a", "403", "served to this machine alone"),
    ] {
        // A length that is wrong would be waited for.
        let lines = if status == "422" { length(body.len()) } else { lines };
        let (found, text) = posted(address, &lines, body);
        assert_eq!(found, status, "{text}");
        assert!(text.contains(told), "{text}");
    }
}

#[test]
fn the_explorer_refuses_what_it_cannot_show_before_it_serves() {
    let folder = Folder::new();
    let explore =
        |arguments: &[&str]| fails(&folder, &[&["explore", "--no-serve", "--out", "page"], arguments].concat());
    assert!(explore(&["none.hdr"]).contains("none.hdr: cannot be read"));
    folder.put("a.hdr", "a text");
    assert!(explore(&["a.hdr"]).contains("a.hdr: holds unknown data"));
    folder.put("a.obj", "a text");
    assert!(explore(&["--mesh", "a.obj"]).contains("a.obj: "));
    assert!(explore(&["--mesh", "none.obj"]).contains("none.obj: cannot be read"));
    folder.put("a.toml", "name = \"a\"\n[environment]\nmap = \"b.hdr\"\nsignal = \"radiance\"\nbudget = 0.1\n");
    let message = explore(&["a.toml"]);
    assert!(message.contains("b.hdr: cannot be read") && message.contains("a.toml:3"), "{message}");
    assert!(!folder.path("page").exists(), "nothing is half-written");
}

#[test]
fn the_explorer_is_written_and_served() {
    use std::io::{BufRead, BufReader};
    let folder = Folder::new();
    let mut child = command()
        .args(["explore", "--out"])
        .arg(folder.path("page"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("runs");
    let lines: Vec<String> =
        BufReader::new(child.stdout.take().expect("a pipe")).lines().take(2).map(|line| line.expect("text")).collect();
    assert!(lines[0].contains("files in `") && lines[1].ends_with("shows it; end with ctrl-c"), "{lines:?}");
    let address = lines[1].trim_start_matches("http://").split('/').next().expect("an address").to_owned();
    assert!(address.starts_with("127.0.0.1:"), "{address} is open to others");
    for (path, file, content) in [
        ("/", "index.html", "text/html; charset=utf-8"),
        ("/style.css", "style.css", "text/css; charset=utf-8"),
        ("/app.js?again", "app.js", "text/javascript; charset=utf-8"),
        ("/data/index.json", "data/index.json", "application/json"),
        ("/data/errors.bin", "data/errors.bin", "application/octet-stream"),
        ("/shaders/5-tilt-isotropic.wgsl", "shaders/5-tilt-isotropic.wgsl", "text/plain; charset=utf-8"),
        ("/shaders/5-tilt-isotropic.frag", "shaders/5-tilt-isotropic.frag", "text/plain; charset=utf-8"),
    ] {
        let (status, found, body) = answer(&address, &format!("GET {path}"));
        assert_eq!((status.as_str(), found.as_str()), ("200", content), "{path}");
        assert!(body == std::fs::read(folder.path("page").join(file)).expect("written"), "{path} is served otherwise");
    }
    for (request, status) in [
        ("GET /../index.html", "404"),
        ("GET /Cargo.toml", "404"),
        ("GET //", "200"),
        ("POST /", "405"),
        ("HEAD /", "200"),
        ("GET /favicon.ico", "204"),
        ("GET / HTTP/1.1\r\nHost: example.org\r\nX:", "403"),
    ] {
        assert_eq!(answer(&address, request).0, status, "{request}");
    }
    takes_maps(&address);
    child.kill().expect("stopped");
    let end = child.wait_with_output().expect("ends");
    assert_eq!(String::from_utf8_lossy(&end.stderr), "");
    // Writing it again changes nothing: the page has no date and no path in it.
    let Run { code, out, .. } = folder.run(["explore", "--no-serve", "--out", "page"]);
    assert!(code == Some(0) && out.contains(" 0 were new or changed"), "{out}");
}

#[test]
fn a_plan_is_plotted_if_asked() {
    let folder = Folder::new();
    let rotation = "[[rotation]]\nkind = \"quaternion\"\norder = 4\nmax_angle = 10\nmax_error = 0.01\n";
    folder.put("good.toml", format!("name = \"a\"\n{rotation}"));
    assert_eq!(folder.run(["plan", "good.toml", "--plot", "plots/a.svg"]).code, Some(0));
    let svg = std::fs::read_to_string(folder.path("plots/a.svg")).expect("is written");
    // Every method that was weighed is a line of its own with a label.
    for text in ["<svg", "rotate:4 ", "rotate_small:4:taylor1", "rotate_small:4:lf5", ", chosen", "of the worst band"] {
        assert!(svg.contains(text), "{text}:\n{svg}");
    }
    let refused = folder.run(["plan", "good.toml", "--plot", "a.png"]);
    assert!(refused.code == Some(1) && refused.err.contains("`.svg`"), "{}", refused.err);
    folder.put("plain.toml", "name = \"a\"\n[[kernel]]\nspec = \"eval:3\"\n");
    let refused = folder.run(["plan", "plain.toml", "--plot", "b.svg"]);
    assert!(refused.code == Some(1) && refused.err.contains("nothing to plot"), "{}", refused.err);
    assert!(!folder.path("b.svg").exists(), "nothing is half-written");
}
