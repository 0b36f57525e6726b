//! The registers that a scene allows: kernels that need more are printed in pieces, and what needs more in every form is
//! refused.

use zonal_codegen::catalog::standard;
use zonal_codegen::plan::Plan;
use zonal_codegen::promise::registers::{Called, MOST, measured, registers};
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::{Maps, Scene};
use zonal_tests::{repository, spec};

fn plan(text: &str) -> Result<Plan, Diagnostic> {
    Plan::new(&Scene::parse("scene.toml", text, Maps::Folder(repository("scenes")))?)
}

fn kernel(spec: &str, registers: &str) -> Result<Plan, Diagnostic> {
    plan(&format!("name = \"a\"\n{registers}[[kernel]]\nspec = \"{spec}\"\n"))
}

fn specs(plan: &Plan) -> Vec<&str> {
    plan.kernels.iter().map(|chosen| chosen.row.spec.as_str()).collect()
}

fn taken(text: &str, called: Called) -> usize {
    registers(&spec(text), called).expect("it can be called so").needed()
}

#[test]
fn every_kernel_of_the_catalogue_was_measured() {
    for spec in standard() {
        assert!(measured(&spec, Called::Whole).is_some(), "{spec}: `cargo measure-gpu`");
        let has_pieces = !spec.in_pieces().is_empty();
        assert_eq!(measured(&spec, Called::Pieces).is_some(), has_pieces, "{spec}: `cargo measure-gpu`");
    }
}

#[test]
fn a_kernel_that_is_too_large_is_printed_in_pieces() {
    let [whole, pieces, channels] =
        [Called::Whole, Called::Pieces, Called::Channels].map(|called| taken("rotate:8:rgb", called));
    assert!(channels < pieces && pieces <= MOST && MOST < whole, "{whole}, {pieces}, {channels}");
    let allowed = |count: usize| {
        kernel("rotate:8:rgb", &format!("registers = {count}\n")).unwrap_or_else(|error| panic!("{error}"))
    };
    let plan = allowed(pieces);
    let bands: Vec<String> = (1..8).map(|l| format!("rotate:8:rgb:band={l}")).collect();
    assert_eq!(specs(&plan)[0], "rotate:8:setup");
    assert_eq!(specs(&plan)[1..], bands);
    let text = plan.to_string();
    let why =
        format!("takes whole {whole} registers on RDNA 2, where the scene allows {pieces}, and in pieces {pieces}");
    assert!(text.contains(&why), "{text}");
    // With fewer, the pieces of one channel, which a shader calls for one after the other.
    assert_eq!(specs(&allowed(channels))[1], "rotate:8:band=1");
    let refused = kernel("rotate:8:rgb", "registers = 30\n").expect_err("too few").to_string();
    assert!(refused.starts_with("scene.toml:2:13: `rotate:8:rgb` takes whole"), "{refused}");
    assert!(refused.contains(&format!("the scene allows 30; allow {channels} at least")), "{refused}");
}

#[test]
fn without_a_limit_kernels_stay_whole_and_what_they_lack_is_said() {
    let plan = |spec: &str| kernel(spec, "").unwrap_or_else(|error| panic!("{error}"));
    let large = plan("rotate:8:rgb");
    assert_eq!(specs(&large), ["rotate:8:rgb"]);
    let spilled = measured(&spec("rotate:8:rgb"), Called::Whole).expect("was measured").spilled;
    let said = format!("on RDNA 2 memory stands in for {spilled} of its registers; `rotate:8:rgb:pieces`: in pieces ");
    assert!(large.kernels[0].reason.contains(&said), "{}", large.kernels[0].reason);
    assert!(!plan("rotate:5").kernels[0].reason.contains("memory stands in"));
    // What suffices is left alone, whatever is allowed beyond.
    let enough = kernel("rotate:5", "registers = 256\n").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((specs(&enough), &*enough.kernels[0].reason), (vec!["rotate:5"], "asked for by the scene"));
}

/// Names of one's own go on to the pieces, and of two kernels that share a set-up it is printed once.
#[test]
fn pieces_are_functions_of_a_module() {
    let text = "name = \"a\"\nregisters = 128\n[[kernel]]\nspec = \"rotate:8\"\n[[kernel]]\nspec = \"rotate:5:rgb\"\n\
                name = \"turn\"\n";
    let plan = plan(text).unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<String> = plan.module.functions.iter().map(|function| function.shader_name()).collect();
    assert!(names.contains(&"turn_setup".to_owned()) && names.contains(&"band_4_turn".to_owned()), "{names:?}");
    for target in &plan.targets {
        zonal_codegen::generate::file(&plan.module, target, "").unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn a_rotation_is_chosen_among_those_that_fit() {
    let rotation = |registers: usize, more: &str| {
        plan(&format!(
            "name = \"a\"\nregisters = {registers}\n[[rotation]]\nkind = \"quaternion\"\norder = 8\nmax_angle = 10\n\
             max_error = 1e-4\n{more}"
        ))
    };
    let plan = rotation(128, "rgb = true\nsignals = 9\n").unwrap_or_else(|error| panic!("{error}"));
    let all = specs(&plan);
    assert!(all.iter().all(|spec| !spec.contains("lifted")), "{all:?}");
    let lifted = plan.kernels.iter().flat_map(|chosen| &chosen.rivals).find(|rival| rival.spec.contains("lifted"));
    let verdict = &lifted.expect("was weighed").verdict;
    assert!(verdict.ends_with("registers at least"), "{verdict}");
    let refused = rotation(20, "").expect_err("too few").to_string();
    assert!(refused.starts_with("scene.toml:2:13: no method that keeps an error of"), "{refused}");
    assert!(refused.contains("allow ") && refused.contains("at least"), "{refused}");
}

/// A kernel that was not measured is counted: what it holds is more than it computes.
#[test]
fn what_was_not_measured_is_counted() {
    let whole = registers(&spec("rotate:12"), Called::Whole).expect("has one form");
    assert!(!whole.measured && whole.needed() > 2 * 144 && whole.registers == MOST, "{whole:?}");
    let pieces = registers(&spec("rotate:12"), Called::Pieces).expect("leaves bands apart");
    assert!(pieces.needed() < whole.needed() / 2, "{pieces:?}, whole {whole:?}");
    assert!(registers(&spec("eval:12"), Called::Pieces).is_none());
}

#[test]
fn a_limit_is_a_number_of_registers() {
    for text in ["0", "-4", "257"] {
        let refused = kernel("rotate:3", &format!("registers = {text}\n")).expect_err(text).to_string();
        assert!(refused.contains("out of range; write a number from 1 to 256"), "{refused}");
    }
}
