//! Pictures against the truth: of the light's first bands by brute force, of the README by the command that made it; and
//! what cannot be drawn says why. They run on any adapter, a software one is enough.

use indicatif::ProgressBar;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::reflectance::measured::Measured;
use zonal_codegen::scene::{Maps, Scene};
use zonal_picture::method::Method;
use zonal_render::figures::{Errors, Figures, Inputs, drawn, pixel_errors};
use zonal_render::frame::Surface;
use zonal_render::gpu::{Gpu, Stage};
use zonal_render::reference::Lights;
use zonal_render::strip;
use zonal_render::subject::{Instead, Subject};

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn gpu() -> Gpu {
    Gpu::open().unwrap_or_else(|error| panic!("{error}"))
}

fn teapot() -> Subject {
    let scene = Scene::read(&repository("scenes/teapot.toml")).unwrap_or_else(|error| panic!("{error}"));
    Subject::new(&scene, Instead::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// A tabulated reflectance, isotropic and reddish, as NumPy saves an array.
fn coloured() -> Brdf {
    let ward = Brdf::Ward { alpha: [0.4; 2] };
    let direction = |e: f64, a: f64| [e.sin() * a.cos(), e.sin() * a.sin(), e.cos().max(0.05)];
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let head = "{'descr': '<f4', 'fortran_order': False, 'shape': (19, 1, 19, 60, 3), }\n";
    bytes.extend((head.len() as u16).to_le_bytes());
    bytes.extend(head.bytes());
    for (v, l, a) in (0..19).flat_map(|v| (0..19).flat_map(move |l| (0..60).map(move |a| (v, l, a)))) {
        let elevation = |e: i32| f64::from(5 * e).to_radians();
        let light = direction(elevation(l), f64::from(6 * a).to_radians());
        let value = ward.value(direction(elevation(v), 0.0), light) / light[2];
        bytes.extend([1.0, 0.6, 0.3].iter().flat_map(|share| ((share * value) as f32).to_le_bytes()));
    }
    Measured::from_bytes("coloured", &bytes).unwrap_or_else(|error| panic!("{error}")).into()
}

#[test]
fn the_exact_picture_is_the_brute_force_sum_under_the_first_bands_of_the_light() {
    let gpu = gpu();
    let parsed = |text: &str| text.parse::<Brdf>().unwrap_or_else(|error| panic!("{error}"));
    let analytic = [("lambert", 3), ("phong:20", 6), ("ward:0.3", 5), ("ward:0.3:0.6", 5)];
    let analytic = analytic.map(|(text, order)| (parsed(text), order));
    for (brdf, order) in analytic.into_iter().chain([(coloured(), 5)]) {
        let subject = Subject { brdf: brdf.clone(), ..teapot() };
        let size = [60, 50];
        let stage = Stage::new(&gpu, &subject, size).unwrap_or_else(|error| panic!("{error}"));
        let inputs = Inputs::new(&subject, order);
        let (frame, _) = drawn(&stage, &inputs, Method::Exact, None, false).unwrap_or_else(|e| panic!("{e}"));
        let surfaces = stage.surfaces().unwrap_or_else(|error| panic!("{error}"));
        let covered = |pixels: &[Option<[f64; 3]>]| pixels.iter().map(Option::is_some).collect::<Vec<_>>();
        let lights = Lights::of_bands(&subject.light(order), 64);
        let truth = lights.frame(&brdf, size, &surfaces, 1, || ());
        assert_eq!(covered(&frame.pixels), covered(&truth.pixels));
        assert!(truth.pixels.iter().flatten().count() > 500);
        let errors = Errors::of(&frame, &truth);
        // What a table may err by, 1 % of the coefficients' norm, is an error of either sign.
        assert!(errors.mean < 0.005, "{brdf}, order {order}: {errors:?}");
        // Near grazing Ward's lobes are narrower than a texel, and tables promise but 7 % in their last step.
        let grazing = |surface: &Option<Surface>| surface.is_none_or(|surface| surface.modulated().1[2] < 0.1);
        let errors = pixel_errors(&frame, &truth).into_iter().zip(&surfaces);
        let worst = errors.filter(|(_, s)| !grazing(s)).filter_map(|(error, _)| error).fold(0.0, f64::max);
        assert!(worst < 0.02, "{brdf}, order {order}: {worst}");
    }
}

#[test]
fn the_picture_of_the_readme_is_what_its_command_makes() {
    let subject = teapot();
    assert_eq!(subject.method, Method::Tilt, "the scene's rotation was planned so");
    let (canvas, figures) =
        strip::compared(&gpu(), &subject, 2, &ProgressBar::hidden()).unwrap_or_else(|error| panic!("{error}"));
    let help = "run `cargo render scenes/teapot.toml --compare -o docs/picture.png`";
    let old = image::open(repository("docs/picture.png")).unwrap_or_else(|error| panic!("{error}: {help}")).into_rgb8();
    let size = [old.width() as usize, old.height() as usize];
    assert_eq!(canvas.size, size, "docs/picture.png is stale: {help}");
    // The times under the pictures are others every time, and edges are rasterised a little differently elsewhere.
    let bytes = canvas.pixels.as_flattened().iter().zip(old.as_raw());
    let sum: u64 = bytes.map(|(new, old)| u64::from(new.abs_diff(*old))).sum();
    let mean = sum as f64 / old.as_raw().len() as f64;
    assert!(mean < 0.5, "docs/picture.png is stale, {mean} of 255 off: {help}");

    let old: Figures = serde_json::from_slice(&std::fs::read(repository("docs/picture.json")).expect("is there"))
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((old.scene, old.size, old.order, old.brdf), (figures.scene, figures.size, figures.order, figures.brdf));
    for (new, old) in figures.pictures.iter().zip(&old.pictures) {
        assert_eq!((new.method, &new.spec, new.operations), (old.method, &old.spec, old.operations));
        assert!((new.errors.mean - old.errors.mean).abs() <= 0.05 * old.errors.mean, "{new:?} {old:?}");
    }
    // Simplified normal mapping is what the rotation is measured by.
    let [_, tilt, none] = &figures.pictures[..] else { panic!("three pictures") };
    assert!(none.errors.mean > 20.0 * tilt.errors.mean, "{none:?} {tilt:?}");
}

const SCENE: &str = "name = \"a\"\n[environment]\nmap = \"maps/city_256x128.hdr\"\nsignal = \"radiance\"\nbudget = 0\n\
                     max_order = 3\n";

/// Runs the command on a scene in a folder of its own, which the output must leave as it was if it fails.
fn render(name: &str, scene: &str, arguments: &[&str]) -> (Output, PathBuf) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    let maps = folder.join("maps");
    std::fs::create_dir_all(&maps).expect("a folder");
    std::fs::copy(repository("scenes/maps/city_256x128.hdr"), maps.join("city_256x128.hdr")).expect("copied");
    std::fs::write(folder.join("a.toml"), scene).expect("written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_zonal-render"));
    let output = command.args(["a.toml"]).args(arguments).current_dir(&folder).output().expect("it starts");
    (output, folder)
}

#[test]
fn a_picture_and_its_figures_are_written_together() {
    let scene =
        format!("{SCENE}[brdf]\nkind = \"phong\"\nexponent = 5\n[picture]\nmesh = \"sphere\"\nsize = [40, 30]\n");
    let (output, folder) = render("written", &scene, &["--reference"]);
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{err}");
    for part in ["a: phong:5, order 3, 40 by 30", "rotate:3", "expected rms", "a.png (40 by 30)", "a.json"] {
        assert!(out.contains(part), "`{part}` is not in\n{out}");
    }
    let rows: Vec<Vec<&str>> = out
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .filter(|words| words.len() == 9 && words[0].parse::<usize>().is_ok())
        .collect();
    assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), ["2", "3", "4", "5", "6", "7", "8", "9", "10"]);
    let rms: Vec<f64> = rows.iter().map(|row| row[3].parse().expect("a number")).collect();
    assert!(rms.windows(2).all(|pair| pair[1] < pair[0]) && rms[8] < rms[0] / 50.0, "{rms:?}");
    let png = image::open(folder.join("a.png")).expect("a picture").into_rgb8();
    assert_eq!(png.dimensions(), (40, 30));
    let figures: Figures =
        serde_json::from_slice(&std::fs::read(folder.join("a.json")).expect("written")).expect("figures");
    // Without a tilt in the scene it is drawn exactly.
    assert_eq!((figures.order, figures.pictures[0].method), (3, Method::Exact));
}

#[test]
fn what_cannot_be_drawn_says_why() {
    let picture = |lines: &str| format!("{SCENE}[picture]\n{lines}");
    let sphere = "mesh = \"sphere\"\nsize = [8, 8]\n";
    let irradiance = SCENE.replace("signal = \"radiance\"", "signal = \"irradiance\"");
    for (name, scene, arguments, parts) in [
        ("no_picture", SCENE.to_owned(), &[][..], &["a.toml:1:8", "no `[picture]`", "add the table"][..]),
        ("no_light", format!("name = \"a\"\n[picture]\n{sphere}"), &[], &["a.toml:1:8", "no `[environment]`"]),
        ("irradiance", format!("{irradiance}[picture]\n{sphere}"), &[], &["a.toml:3:7", "radiance"]),
        ("no_mesh", picture("mesh = \"none.obj\"\n"), &[], &["a.toml:8:8", "none.obj: cannot be read"]),
        ("bad_mesh", picture("mesh = \"a.toml\"\n"), &[], &["a.toml:8:8", "a.toml: "]),
        ("no_normals", picture(&format!("{sphere}normals = \"n.png\"\n")), &[], &["a.toml:10:11", "n.png: cannot be"]),
        ("bad_normals", picture(&format!("{sphere}normals = \"a.toml\"\n")), &[], &["a.toml:10:11", "neither a PNG"]),
        ("size", picture("mesh = \"plane\"\nsize = [8, 99999]\n"), &[], &["a.toml:9:8", "8 by 99999 pixels"]),
        ("order", picture(&format!("{sphere}order = 99\n")), &[], &["a.toml:10:9", "orders are 2 to 16"]),
        ("method", picture(&format!("{sphere}method = \"tilted\"\n")), &[], &["a.toml:10:10", "did you mean `tilt`"]),
        (
            "hidden",
            picture("mesh = \"plane\"\nelevation = -40\nsize = [8, 8]\n"),
            &["--reference"],
            &["nothing of the object"],
        ),
        ("output", picture(sphere), &["-o", "a.jpg"], &["`a.jpg` is no name of a PNG file", "end it in `.png`"]),
        ("folder", picture(sphere), &["-o", "a.toml/b.png"], &["cannot create `a.toml`"]),
    ] {
        let (output, folder) = render(name, &scene, arguments);
        let err = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{name}: {err}");
        assert!(!err.contains("panicked"), "{name}: {err}");
        for part in parts {
            assert!(err.contains(part), "{name}: `{part}` is not in\n{err}");
        }
        let count = std::fs::read_dir(&folder).expect("readable").count();
        assert_eq!(count, 2, "{name} wrote something");
    }
    for arguments in [&["--order", "17"][..], &["--method", "magic"], &["--samples", "0"]] {
        assert_eq!(render("usage", &picture(sphere), arguments).0.status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn without_an_adapter_it_says_what_to_install() {
    let scene = format!("{SCENE}[picture]\nmesh = \"sphere\"\nsize = [8, 8]\n");
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("adapter");
    std::fs::create_dir_all(folder.join("maps")).expect("a folder");
    std::fs::copy(repository("scenes/maps/city_256x128.hdr"), folder.join("maps/city_256x128.hdr")).expect("copied");
    std::fs::write(folder.join("a.toml"), scene).expect("written");
    // The loader looks for drivers only where this says, and there are none.
    let mut command = Command::new(env!("CARGO_BIN_EXE_zonal-render"));
    command.arg("a.toml").current_dir(&folder).env("VK_ICD_FILENAMES", "none.json").env("VK_DRIVER_FILES", "none.json");
    let output = command.output().expect("it starts");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("no adapter") && err.contains("apt-get install mesa-vulkan-drivers libvulkan1"), "{err}");
}

#[test]
fn scenes_in_memory_are_drawn_too() {
    let city = std::fs::read(repository("scenes/maps/city_256x128.hdr")).expect("a map");
    let files: &'static [(&str, &[u8])] = vec![("maps/city_256x128.hdr", &*city.leak())].leak();
    let text = format!("{SCENE}[picture]\nmesh = \"sphere\"\n");
    let scene = Scene::parse("a.toml", &text, Maps::Embedded(files)).unwrap_or_else(|error| panic!("{error}"));
    let subject = Subject::new(&scene, Instead { order: Some(4), method: None }).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((subject.order, subject.brdf), (4, Brdf::Lambert));
}
