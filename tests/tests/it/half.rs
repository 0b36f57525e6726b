//! Kernels in f16: their text, what they compute, what is promised of it, and where they are refused.

use half::f16;
use std::path::PathBuf;
use zonal_codegen::catalog::standard;
use zonal_codegen::emit::Module;
use zonal_codegen::emit::language::{GLSL, RUST, WGSL};
use zonal_codegen::families::Spec;
use zonal_codegen::generate::{build, file};
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::math::half::Half;
use zonal_codegen::plan::Plan;
use zonal_codegen::promise::accuracy::rounding;
use zonal_codegen::promise::built::Built;
use zonal_codegen::scene::{Maps, Scene};
use zonal_tests::{Runner, spec};

fn halves() -> Vec<Spec> {
    let all = standard()
        .into_iter()
        .filter(|spec| spec.takes_half() && [2, 3, 5, 8].contains(&spec.order) && !(spec.order == 8 && spec.rgb));
    all.map(|spec| Spec { half: true, ..spec }).collect()
}

fn text(spec: &Spec) -> String {
    let module = Module { functions: build(std::slice::from_ref(spec)), origin: spec.to_string(), ..Module::default() };
    file(&module, &WGSL, "").unwrap_or_else(|error| panic!("{spec}: {error}")).text
}

#[test]
fn every_kernel_that_takes_f16_is_valid_wgsl_in_it() {
    let specs = halves();
    assert!(specs.len() > 100);
    for spec in &specs {
        assert_eq!(spec.to_string().parse::<Spec>().as_ref(), Ok(spec));
        let text = text(spec);
        assert!(text.contains("\nenable f16;\n") && !text.contains("f32>"), "{spec}:\n{text}");
        assert!(text.contains("Error: f16 rounding at most"), "{spec}");
    }
}

/// f16's unit roundoff is 2⁻¹¹, 8192 times f32's: no kernel may be worse than that against its f32 form, and none may fail.
#[test]
fn rounding_in_f16_is_that_of_f32_times_what_the_formats_differ_by() {
    for text in [
        "basis:8",
        "eval:5",
        "eval_monomial:5",
        "tilt:5",
        "tilt:5:lf5",
        "tilt_prescaled:6",
        "lf3:8",
        "rotate:4:angles",
        "rotate:8:euler",
        "rotate:3:matrix",
        "rotate_z:8",
    ] {
        let half = spec(&format!("{text}:f16"));
        let (narrow, wide) = (Built::new(&half).accuracy, Built::new(&spec(text)).accuracy);
        assert!(!narrow.proven && narrow.rounding_f32.is_finite(), "{text}");
        let ratio = narrow.measured_f32 / wide.measured_f32;
        // Inputs are f32 numbers, whose own rounding to f16 comes on top: as much again and the amplification of it.
        assert!((1000.0..80_000.0).contains(&ratio), "{text}: {ratio}");
        let code = half.code();
        for contraction in [Contraction::Separate, Contraction::Fused] {
            let other = rounding::<Half>(&half, &code, 4242, 2000, contraction);
            assert!(other <= narrow.rounding_f32, "{text}: {other:e} above {:e}", narrow.rounding_f32);
        }
    }
}

/// docs/MATH.md#half-precision: the basis in f16 errs by 8e-4 at order 3 and 3.7e-3 at order 8 of a band's norm.
#[test]
fn the_basis_in_f16_errs_as_known() {
    let mut random = zonal_codegen::promise::samples::Random::new(8);
    for (order, most) in [(3, 8e-4), (8, 3.7e-3)] {
        let spec = spec(&format!("basis:{order}"));
        let (narrow, wide) = (Runner::<Half>::new(&spec), Runner::<f64>::new(&spec));
        let mut worst = 0.0f64;
        for _ in 0..2000 {
            let dir = random.unit::<3>().map(|x| Half::round(x).to_f64());
            let error = zonal_tests::band_error(&narrow.run(&[dir.to_vec()]), &wide.run(&[dir.to_vec()]));
            worst = worst.max(error);
        }
        println!("basis:{order}: {worst:e}");
        assert!(worst < 1.5 * most && worst > most / 10.0, "basis:{order}: {worst:e}");
    }
}

#[test]
fn f16_arithmetic_rounds_once() {
    // Products and sums of f16 are exact in f64, so that rounding them is the definition.
    let mut random = zonal_codegen::promise::samples::Random::new(1);
    for _ in 0..20_000 {
        let [a, b, c] = [(); 3].map(|()| Half::round(random.signed() * 100.0));
        let wide = [a, b, c].map(Half::to_f64);
        assert_eq!(a + b, Half::round(wide[0] + wide[1]));
        assert_eq!(a * b, Half::round(wide[0] * wide[1]));
        assert_eq!(Number::fused(a, b, c), Half::round(wide[0].mul_add(wide[1], wide[2])));
    }
}

/// The crate half rounds f32 as hardware does.
#[test]
fn f16_numbers_are_those_of_the_crate_half() {
    let mut random = zonal_codegen::promise::samples::Random::new(16);
    let check = |value: f32| {
        let (own, other) = (Half::round(f64::from(value)).to_f64(), f16::from_f32(value).to_f64());
        assert!(own.to_bits() == other.to_bits() || own.is_nan() && other.is_nan(), "{value}: {own}, not {other}");
    };
    for _ in 0..200_000 {
        check(f32::from_bits(random.bits() as u32));
        // Most of those overflow or vanish: once more where they do neither.
        check((random.signed() * 2f64.powi((random.bits() % 44) as i32 - 27)) as f32);
    }
}

#[test]
fn what_f16_cannot_do_is_refused() {
    for text in [
        "rotate:5:f16",
        "rotate:4:zxzxz:f16",
        "rotate:4:align:f16",
        "angles:4:f16",
        "zhf:4:f16",
        "basis:12:f16",
        "basis:5:loop:f16",
        "rotate_small:5:f16",
    ] {
        let error = text.parse::<Spec>().expect_err(text).to_string();
        assert!(error.contains("does not work in f16") && error.contains("need f32"), "{text}: {error}");
    }
    for target in [&GLSL, &RUST] {
        let module = Module { functions: build(&[spec("tilt:4:f16")]), ..Module::default() };
        let error = file(&module, target, "").expect_err("only WGSL has f16").to_string();
        assert!(error.contains("only WGSL has f16"), "{error}");
    }
}

fn scene(rest: &str) -> Result<Plan, String> {
    let text = format!("name = \"a\"\n{rest}");
    let scene = Scene::parse("a.toml", &text, Maps::Folder(PathBuf::new())).map_err(|error| error.to_string())?;
    Plan::new(&scene).map_err(|error| error.to_string())
}

#[test]
fn the_planner_takes_f16_where_the_error_has_room_for_it() {
    let rotation = |precision: &str, error: &str, targets: &str| {
        scene(&format!(
            "targets = [{targets}]\n[[rotation]]\nkind = \"tilt\"\norder = 5\nmax_angle = 10\nmax_error = {error}\nprecision = \"{precision}\""
        ))
    };
    let chosen = |precision: &str, error: &str| -> String {
        rotation(precision, error, "\"wgsl\"").expect("is planned").kernels[0].row.spec.clone()
    };
    assert_eq!(chosen("auto", "0.05"), "tilt:5:f16");
    assert_eq!(chosen("auto", "0.005"), "tilt:5:lf5");
    assert_eq!(chosen("f32", "0.05"), "tilt:5");
    assert!(rotation("f16", "0.0001", "\"wgsl\"").expect_err("f16 is too coarse").contains("no method keeps"));
    assert!(rotation("auto", "0.05", "\"wgsl\", \"rust\"").expect_err("Rust has none").contains("only WGSL"));
    let named = scene("[[kernel]]\nspec = \"tilt:4:f16\"").expect_err("all targets");
    assert!(named.contains("only WGSL has f16"), "{named}");
}
