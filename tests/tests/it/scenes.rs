//! Scenes as the library plans them: two that the project ships, budgets of light, and rotations chosen by their errors.

use std::path::Path;
use zonal_codegen::builder::Builder;
use zonal_codegen::plan::{Plan, price};
use zonal_codegen::promise::accuracy::method_error;
use zonal_codegen::promise::registers::Registers;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::{Maps, Scene};
use zonal_tests::command::Folder;
use zonal_tests::{repository, spec};

fn plan(text: &str) -> Result<Plan, Diagnostic> {
    Plan::new(&Scene::parse("scene.toml", text, Maps::Folder(repository("scenes")))?)
}

fn shipped(name: &str) -> Plan {
    Builder::scene(repository("scenes").join(name)).plan().unwrap_or_else(|error| panic!("{error}"))
}

fn specs(plan: &Plan) -> Vec<&str> {
    plan.kernels.iter().map(|chosen| chosen.row.spec.as_str()).collect()
}

fn rotation(kind: &str, order: usize, max_angle: f64, max_error: f64) -> Result<Plan, Diagnostic> {
    plan(&format!(
        "name = \"a\"\n[[rotation]]\nkind = \"{kind}\"\norder = {order}\nmax_angle = {max_angle}\nmax_error = {max_error}\n"
    ))
}

#[test]
fn diffuse_finds_that_three_bands_suffice() {
    let plan = shipped("diffuse.toml");
    assert_eq!(specs(&plan), ["eval:3:rgb"]);
    let environment = plan.environment.expect("has one");
    assert_eq!((environment.order, environment.max_order), (3, 8));
    assert_eq!(environment.vanishing, [3, 5, 7]);
    assert_eq!(environment.values.len(), 9);
    assert!(environment.errors[2] <= environment.budget && environment.errors[1] > environment.budget);
    assert!(environment.kept && environment.requirement.is_none());
    assert_eq!(environment.coefficients, [9, 64]);
    assert!(environment.operations[0] < environment.operations[1] / 4);
    assert!((environment.energy.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    assert!(environment.held > 0.999);
}

#[test]
fn glossy_finds_its_order_and_picks_the_tilt() {
    let plan = shipped("glossy.toml");
    assert_eq!(specs(&plan)[0], "rotate:7:rgb");
    let environment = plan.environment.as_ref().expect("has one");
    assert_eq!((environment.order, environment.max_order, environment.kept), (7, 10, true));
    assert!(environment.error() <= 0.05 && environment.errors[5] > 0.05);
    let tilt = &plan.kernels[1];
    assert!(tilt.row.spec.starts_with("tilt:7") && tilt.method_error.expect("approximate") <= 0.05);
    // What the method adds is told apart from what the order leaves out.
    let seen = tilt.seen_error.expect("is of the environment's order");
    assert!(seen > 1e-4 && seen < tilt.method_error.expect("approximate"), "{seen}");
    assert!(tilt.rivals.len() >= 6);
    for verdict in ["chosen", "keeps the error too, but costs more", "leaves the spin about the normal open"] {
        assert!(tilt.rivals.iter().any(|rival| rival.verdict == verdict), "{verdict}");
    }
}

#[test]
fn a_budget_is_against_all_bands_unless_it_says_otherwise() {
    let with = |more: &str| {
        let plan = plan(&format!(
            "name = \"a\"\n[environment]\nmap = \"maps/courtyard_256x128.hdr\"\nsignal = \"radiance\"\nmax_order = 5\n\
             budget = 0.05\n{more}\n[brdf]\nkind = \"ward\"\nalpha = [0.3, 0.6]\n"
        ));
        plan.unwrap_or_else(|error| panic!("{error}")).environment.expect("has one")
    };
    let all = with("");
    assert!(!all.kept && all.order == 5 && all.error() > 0.1);
    let warning = all.warning().expect("is not kept");
    for part in
        ["order 5, the most that the scene affords, does not keep the budget of 5.00 %", "order 8 would keep it"]
    {
        assert!(warning.contains(part), "{warning}");
    }
    assert!(all.constants_doc().contains("does not keep the budget"), "{}", all.constants_doc());
    assert_eq!(with("relative_to = \"all_bands\""), all);
    let own = with("relative_to = \"max_order\"");
    assert!(own.kept && own.order == 5 && own.warning().is_none() && own.costs[4] == 0.0);
    assert!(own.summary().contains("Against all bands"), "{}", own.summary());
    // The same figures, whatever the budget is relative to.
    assert_eq!(own.errors, all.errors);
    let refused = plan(
        "name = \"a\"\n[environment]\nmap = \"a.hdr\"\nsignal = \"radiance\"\nbudget = 0\nrelative_to = \"all\"\n",
    );
    let refused = refused.expect_err("is no such thing").to_string();
    assert!(refused.starts_with("scene.toml:6:15") && refused.contains("did you mean `all_bands`?"), "{refused}");
}

#[test]
fn vanishing_bands_are_not_stored_where_only_eval_and_basis_read_them() {
    let with = |kernels: &str| {
        plan(&format!(
            "name = \"a\"\n[environment]\nmap = \"maps/studio_256x128.hdr\"\nsignal = \"irradiance\"\nbudget = 0.04\n{kernels}"
        ))
        .unwrap_or_else(|error| panic!("{error}"))
    };
    let eval = with("[[kernel]]\nspec = \"eval:environment:rgb\"\n");
    assert_eq!(specs(&eval), ["eval:5:bands=0+1+2+4:rgb"]);
    assert_eq!(eval.environment.expect("has one").values.len(), 18);
    let rotated = with("[[kernel]]\nspec = \"eval:environment:rgb\"\n[[kernel]]\nspec = \"rotate:environment:rgb\"\n");
    assert_eq!(specs(&rotated), ["eval:5:rgb", "rotate:5:rgb"]);
    assert_eq!(rotated.environment.expect("has one").values.len(), 25);
    // The constants alone are whole too: their index is l(l+1)+m.
    assert_eq!(with("").environment.expect("has one").values.len(), 25);
}

#[test]
fn a_uniform_map_needs_one_coefficient() {
    let folder = Folder::new();
    let texels = [128, 64, 32, 129].repeat(8);
    folder.put("even.hdr", [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n", &texels[..]].concat());
    let scene = "name = \"a\"\n[environment]\nmap = \"even.hdr\"\nsignal = \"radiance\"\nbudget = 0\n\
                 [[kernel]]\nspec = \"eval:environment:rgb\"\n";
    let path = folder.put("even.toml", scene);
    let plan = Builder::scene(path).plan().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(specs(&plan), ["eval:2:bands=0:rgb"]);
    assert_eq!(plan.environment.expect("has one").values.len(), 1);
}

/// Several signals that one quaternion turns share its set-up, lifted inside of the domain, by planes outside of it.
#[test]
fn what_turns_alike_is_prepared_once() {
    let plan = |order: usize, max_angle: f64, more: &str| {
        let head =
            format!("name = \"a\"\n[[rotation]]\nkind = \"quaternion\"\norder = {order}\nmax_angle = {max_angle}");
        plan(&format!("{head}\nmax_error = 1e-4\n{more}")).unwrap_or_else(|error| panic!("{error}"))
    };
    assert_eq!(specs(&plan(5, 30.0, "")), ["rotate:5"]);
    assert_eq!(specs(&plan(5, 30.0, "rgb = true\n")), ["rotate:5:rgb"]);
    assert_eq!(specs(&plan(5, 30.0, "rgb = true\nsignals = 2\n")), ["rotate:5:lifted:rgb", "lifted:5"]);
    assert_eq!(specs(&plan(8, 15.0, "rgb = true\n")), ["rotate:8:rgb"]);
    // Lifted it would do fewer operations, with more numbers at once than there are registers.
    assert_eq!(specs(&plan(8, 15.0, "rgb = true\nsignals = 2\n")), ["rotate:8:rgb"]);
    assert_eq!(specs(&plan(5, 30.1, "signals = 9\n")), ["rotate:5:angles", "angles:5"]);
    // At order 2 angles are as many numbers to read as they save operations.
    assert_eq!(specs(&plan(2, 30.0, "signals = 9\n")).len(), 1);
    assert_eq!(specs(&plan(3, 30.0, "signals = 9\n")).len(), 2);
    let plan = plan(5, 30.0, "rgb = true\nsignals = 16\n");
    let [chosen, set_up] = &plan.kernels[..] else { panic!("a rotation and its set-up") };
    let rival = |spec: &str| chosen.rivals.iter().find(|rival| rival.spec == spec).expect("was weighed");
    let lifted = rival("rotate:5:lifted:rgb");
    assert_eq!(lifted.total, 16 * chosen.row.cost.total + set_up.row.cost.total);
    assert_eq!((lifted.takes.as_slice(), lifted.set_up.as_deref()), (&["q"][..], Some("lifted:5")));
    assert!(100 * lifted.price < 92 * rival("rotate:5:angles:rgb").price);
    assert_eq!(plan.module.functions.len(), 2);
}

/// The domain is refused where a scene names the kernel, too.
#[test]
fn a_lifted_rotation_is_refused_outside_of_its_domain() {
    let plan = |degrees: f64| {
        plan(&format!("name = \"a\"\n[[kernel]]\nspec = \"rotate:8:lifted:rgb\"\nmax_angle = {degrees}\n"))
    };
    assert!(plan(17.14).is_ok());
    let refused = plan(17.15).expect_err("is too far").to_string();
    assert!(refused.contains("takes angles up to 17.14 degrees, not 17.15"), "{refused}");
    let refused =
        "rotate:2:lifted".parse::<zonal_codegen::families::Spec>().expect_err("has no such order").to_string();
    assert!(refused.contains("orders from 3 on"), "{refused}");
}

#[test]
fn the_cheapest_rotation_within_the_error_is_chosen() {
    let mut chosen = Vec::new();
    for kind in ["tilt", "y", "zyz"] {
        for order in [2, 3, 5, 8] {
            for max_angle in [1.0, 5.0, 15.0, 25.0, 60.0, 180.0] {
                for max_error in [0.001, 0.05, 0.3] {
                    let plan = rotation(kind, order, max_angle, max_error).unwrap_or_else(|error| panic!("{error}"));
                    let best = &plan.kernels[0];
                    let function = &plan.module.functions[0];
                    let code = &function.built.code;
                    let cost = price(code, 1, Registers::of(&function.spec, code).registers);
                    let angle = f64::to_radians(max_angle);
                    assert!(method_error(&function.spec, angle) + best.row.accuracy.rounding_f32 <= max_error);
                    assert!(function.spec.max_angle().is_none_or(|limit| angle <= limit));
                    for rival in best.rivals.iter().filter(|rival| rival.admissible) {
                        assert!(rival.price >= cost, "{} beats {}", rival.spec, best.row.spec);
                        assert!(rival.method_error + rival.rounding_f32 <= max_error);
                    }
                    chosen.push(best.row.spec.clone());
                }
            }
        }
    }
    for family in ["tilt:", "rotate_y:", "taylor1:", "mix:", "rotate:8:euler", "rotate:8"] {
        assert!(chosen.iter().any(|spec| spec.starts_with(family)), "{family} is never chosen: {chosen:?}");
    }
}

#[test]
fn errors_are_one_plain_line_in_the_library() {
    let error = rotation("tilt", 5, 15.0, 1e-9).expect_err("too small");
    let text = error.to_string();
    assert!(text.starts_with("scene.toml:6:13: no method keeps an error of 0.000000001; allow "), "{text}");
    assert_eq!(format!("{error:?}"), text, "a build script that returns it shows the same");
    let error = Scene::read(Path::new("no/such.toml")).expect_err("missing");
    assert!(error.to_string().starts_with("no/such.toml: cannot be read"), "{error}");
}

#[test]
fn a_rotation_that_is_there_already_is_not_printed_twice() {
    let plan = plan(
        "name = \"a\"\n[[kernel]]\nspec = \"tilt:3\"\n[[rotation]]\nkind = \"tilt\"\norder = 3\nmax_angle = 10\n\
         max_error = 0.1\n[[rotation]]\nkind = \"tilt\"\norder = 3\nmax_angle = 5\nmax_error = 0.1\nname = \"bump\"\n",
    )
    .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(specs(&plan), ["tilt:3"; 3]);
    let names: Vec<String> = plan.module.functions.iter().map(|function| function.shader_name()).collect();
    assert_eq!(names, ["sh3_tilt", "bump"]);
}

#[test]
fn plans_are_json_too() {
    let plan = serde_json::to_value(shipped("diffuse.toml")).expect("JSON");
    assert_eq!(plan["environment"]["order"], 3);
    assert_eq!(plan["kernels"][0]["total"], plan["environment"]["operations"][0]);
    assert_eq!(plan["targets"], serde_json::json!(["wgsl", "glsl", "rust"]));
    assert_eq!(spec(plan["kernels"][0]["spec"].as_str().expect("a spec")).order, 3);
}
