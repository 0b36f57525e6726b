//! The bands of a light as cubemaps: what `zonal bands` writes and refuses, that the images hold the bands, and that the text which
//! reads them computes what the library does (docs/MATH.md#band-tables, docs/MATH.md#antialiased-reflections).

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use std::path::Path;
use zonal_codegen::emit::bands::{Reads, shaded};
use zonal_codegen::emit::language::{GLSL, Target, WGSL};
use zonal_codegen::environment::{Map, Texel};
use zonal_codegen::plan::Plan;
use zonal_codegen::promise::samples::Random;
use zonal_codegen::scene::{Maps, Scene};
use zonal_picture::mirror::{Attenuation, Footprint, SHARPEST};
use zonal_tests::command::{Folder, Run};
use zonal_tests::repository;
use zonal_tests::shader::{Counts, Fma, Language, Shader, Value};
use zonal_tests::{Runner, spec};

const MAP: &str = "scenes/maps/forest_256x128.hdr";

fn ran(folder: &Folder, arguments: &[&str]) -> Run {
    folder.run(["bands"].iter().chain(arguments))
}

/// The side, whether texels are halves, and R, G and B of an image, row by row.
fn image(path: &Path) -> ([usize; 2], bool, Vec<[f64; 3]>) {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = reader.from_file(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let size = [image.layer_data.size.0, image.layer_data.size.1];
    let mut texels = vec![[0.0; 3]; size[0] * size[1]];
    let mut is_half = false;
    for channel in &image.layer_data.channel_data.list {
        let k = ["R", "G", "B"].iter().position(|name| channel.name.eq(name)).expect("R, G or B");
        let values: Vec<f64> = match &channel.sample_data {
            FlatSamples::F16(values) => values.iter().map(|value| f64::from(value.to_f32())).collect(),
            FlatSamples::F32(values) => values.iter().map(|value| f64::from(*value)).collect(),
            FlatSamples::U32(_) => panic!("whole numbers"),
        };
        is_half = matches!(channel.sample_data, FlatSamples::F16(_));
        texels.iter_mut().zip(values).for_each(|(texel, value)| texel[k] = value);
    }
    (size, is_half, texels)
}

#[test]
fn the_command_writes_the_bands_and_what_reads_them() {
    let folder = Folder::new();
    let map = repository(MAP).display().to_string();
    let run = ran(&folder, &[&map, "--order", "4"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    let files = folder.names();
    assert_eq!(files, ["bands"]);
    let name = |rest: &str| folder.path(&format!("bands/forest_256x128_{rest}"));
    let light = Map::read(&repository(MAP)).expect("a map").project(4);
    for band in 0..4 {
        let table = light.band_table(band, 0.01, Texel::Half).expect("it fits");
        let (size, is_half, texels) = image(&name(&format!("band_{band}.exr")));
        assert_eq!((size, is_half), ([6 * table.side, table.side], true), "band {band}");
        assert_eq!(texels, table.strip(), "band {band}");
        let line = run.out.lines().find(|line| line.contains(&format!("band_{band}.exr"))).expect("a line a band");
        assert!(line.contains(&table.bytes().to_string()), "{line}");
    }
    let account: toml::Table = std::fs::read_to_string(name("bands.toml")).expect("written").parse().expect("TOML");
    assert_eq!(account["order"].as_integer(), Some(4));
    assert_eq!(account["band"].as_array().map(Vec::len), Some(4));
    for (target, extension) in [(&WGSL, "wgsl"), (&GLSL, "glsl")] {
        let text = std::fs::read_to_string(name(&format!("bands.{extension}"))).expect("written");
        for function in ["samples", "shade", "sharpness", "mirrored"] {
            assert!(text.contains(&format!("forest_256x128_band_{function}(")), "{}: {function}", target.name);
        }
    }
    // What it wrote it may write again, in floats too.
    let run = ran(&folder, &[&map, "--order", "4", "--float", "--irradiance"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    let (size, is_half, texels) = image(&name("band_3.exr"));
    // Irradiance has no band 3.
    assert_eq!((size, is_half), ([6, 1], false));
    assert!(texels.iter().flatten().all(|value| value.abs() < 1e-12));
}

#[test]
fn what_cannot_be_written_is_refused() {
    let folder = Folder::new();
    let map = repository(MAP).display().to_string();
    for (arguments, code, parts) in [
        (&["none.hdr"][..], 1, &["none.hdr: cannot be read"][..]),
        (&[], 2, &["<MAP>"]),
        (&[&map, "--order", "0"], 2, &["0 is not in 1..=32"]),
        (&[&map, "--order", "33"], 2, &["33 is not in 1..=32"]),
        (&[&map, "--error", "0"], 2, &["errors are 0.00001 to 0.5"]),
        (&[&map, "--error", "NaN"], 2, &["errors are 0.00001 to 0.5"]),
        (&[&map, "--error", "few"], 2, &["`few` is no number"]),
        (&[&map, "--error", "1e-4"], 1, &["band 1 errs by", "take `--float`"]),
    ] {
        let run = ran(&folder, arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}: {}", run.err);
        assert!(!run.err.contains("panicked"), "{}", run.err);
        for part in parts {
            assert!(run.err.contains(part), "{arguments:?}: `{part}` is not in\n{}", run.err);
        }
        assert_eq!(folder.names(), Vec::<String>::new(), "{arguments:?} wrote something");
    }
    // What zonal did not write stays, and so does all else.
    std::fs::create_dir(folder.path("bands")).expect("a folder");
    folder.put("bands/forest_256x128_bands.toml", "mine");
    let run = ran(&folder, &[&map, "--order", "2"]);
    assert!(run.code == Some(1) && run.err.contains("was not written by zonal"), "{}", run.err);
    assert_eq!(std::fs::read_dir(folder.path("bands")).expect("a folder").count(), 1);
    let run = ran(&folder, &[&map, "--order", "2", "--force"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
}

#[test]
fn a_plan_says_what_is_cheaper_than_what_the_papers_write() {
    let text = "name = \"a\"\n[[kernel]]\nspec = \"isd_shade:5:rgb\"\n[[kernel]]\nspec = \"isd_shade_zonal:4\"\n\
                [[kernel]]\nspec = \"shade:5\"\n";
    let scene = Scene::parse("a.toml", text, Maps::Embedded(&[])).unwrap_or_else(|error| panic!("{error}"));
    let plan = Plan::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    let [isd, zonal, direct] = &plan.kernels[..] else { panic!("three kernels") };
    let total = |text: &str| {
        let spec = spec(text);
        spec.code().cost(spec.channels()).total
    };
    let [own, less] = ["isd_shade:5:rgb", "shade:5:rgb"].map(total);
    let read = shaded(5, 3);
    assert!(read < less && less < own);
    let want = format!("`shade:5:rgb` gives the same for {less} operations instead of {own}, and 25 reads of tables");
    assert!(isd.reason.contains(&want) && isd.reason.contains(&format!("do with {read},")), "{}", isd.reason);
    assert!(zonal.reason.contains("`shade_zonal:4` gives the same") && !zonal.reason.contains("tables"));
    assert_eq!(direct.reason, "asked for by the scene");
}

/// A function of the text that reads tables, with the language that the evaluator takes it in. Reads of band `one` give one, of
/// the others zero.
fn function(target: Target, order: usize, name: &str, one: usize) -> Shader {
    let reads = Reads { order, name: "light", group: 1, origin: "a test" };
    let mut text = reads.text(target).expect("there are textures").replace("ZONAL_HIGHP ", "");
    let is_wgsl = target.name == WGSL.name;
    for band in 0..order {
        let value = if band == one { "1.0" } else { "0.0" };
        let vector = if is_wgsl { "vec3<f32>" } else { "vec3" };
        let read = format!("light_read(light_{band}_map, dir, major)");
        text = text.replace(&read, &format!("{vector}({value})"));
    }
    let cut = |name: &str| {
        let start = text.find(&format!("light_{name}(")).expect("it is there");
        let start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let end = start + text[start..].find("\n}\n").expect("it ends") + 3;
        text[start..end].to_owned()
    };
    let text = format!("{}\n{}", cut("major"), cut(name));
    let language = if is_wgsl { Language::Wgsl } else { Language::Glsl };
    Shader::parse(language, &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn vector(v: [f64; 3]) -> Value {
    Value::Vec(v.map(|x| x as f32).to_vec())
}

fn called(shader: &Shader, name: &str, arguments: &[Value]) -> Value {
    let result = shader.call(name, arguments, &mut Counts::default(), Fma::Separate);
    result.unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_sharpness_of_a_pixel_is_that_of_the_library() {
    let mut random = Random::new(31);
    for target in [&WGSL, &GLSL] {
        let shader = function(target, 3, "sharpness", 0);
        let sharpness = |view, normal, slopes: [[f64; 3]; 2], variance: f64| {
            let arguments = [view, normal, slopes[0], slopes[1]].map(vector);
            let arguments: Vec<Value> = arguments.into_iter().chain([Value::F32(variance as f32)]).collect();
            let Value::F32(found) = called(&shader, "light_sharpness", &arguments) else { panic!("no number") };
            (f64::from(found), Footprint::new(view, normal, slopes).sharpness(variance))
        };
        for _ in 0..200 {
            let slopes = [(); 2].map(|()| random.unit::<3>().map(|x| 0.1 * x));
            let (found, want) = sharpness(random.unit(), random.unit(), slopes, 0.25);
            // Some twenty roundings of f32 of sums of like signs, but for the vectors' own, which may cancel in part.
            assert!((found / want - 1.0).abs() < 1e-5, "{}: {found} {want}", target.name);
        }
        let (view, normal) = ([0.0, 0.6, -0.8], [0.0, 0.0, 1.0]);
        let (flat, want) = sharpness(view, normal, [[0.0; 3]; 2], 0.25);
        assert!((flat / want - 1.0).abs() < 1e-6 && want == SHARPEST, "{flat}");
        // Grazing: a turn about the view moves nothing.
        assert!(sharpness([1.0, 0.0, 0.0], normal, [[0.0, 0.5, 0.0], [0.0; 3]], 1.0).0 > 0.99 * SHARPEST);
        assert_eq!(sharpness([1.0, 0.0, 0.0], normal, [[0.5, 0.0, 0.0], [0.0; 3]], 1.0), (2.0, 2.0));
        for extreme in [1e10, 1e18, 1e30, f64::INFINITY, f64::NAN] {
            let (found, want) = sharpness(view, normal, [[extreme, 0.0, 0.0], [0.0; 3]], 0.25);
            assert!((0.0..1e-15).contains(&found) && (0.0..1e-15).contains(&want), "{extreme}: {found} {want}");
        }
        assert_eq!(sharpness([f64::NAN; 3], normal, [[0.1; 3]; 2], 0.25), (0.0, 0.0));
    }
}

#[test]
fn a_mirror_reads_each_band_times_its_factor() {
    let order = 6;
    let gaussian = Runner::<f64>::new(&spec(&format!("gaussian:{order}")));
    let attenuation = Attenuation::new(order);
    for target in [&WGSL, &GLSL] {
        for band in 0..order {
            let shader = function(target, order, "mirrored", band);
            for kappa in [0.0, 0.5, 20.0, 1e4, SHARPEST] {
                let e = gaussian.run(&[vec![kappa]]).into_iter().map(|e| Value::F32(e as f32)).collect();
                let arguments = [vector([0.0, 0.6, 0.8]), Value::Array(e)];
                let Value::Vec(found) = called(&shader, "light_mirrored", &arguments) else { panic!("no vector") };
                let want = attenuation.factors(kappa)[band];
                // Four roundings of f32.
                assert!(found.iter().all(|v| (f64::from(*v) - want).abs() < 3e-7), "{band} {kappa}: {found:?} {want}");
            }
        }
    }
}
