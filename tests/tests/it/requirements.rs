//! What scenes require besides their order: what is left out is what can be, and keeps the budget together with the order.
//! That orders keep it is tested by brute force in `orders.rs`.

use zonal_codegen::environment::{Map, Projection};
use zonal_codegen::plan::Plan;
use zonal_codegen::plan::order::smallest;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::reflectance::requirement::{Requirement, Room};
use zonal_codegen::reflectance::seen;
use zonal_codegen::scene::{Maps, Scene};
use zonal_tests::repository;

const MAPS: [&str; 8] = ["city", "courtyard", "forest", "interior", "night", "studio", "sunrise", "sunset"];

fn light(name: &str) -> Projection {
    Map::read(&repository(&format!("scenes/maps/{name}_256x128.hdr"))).expect("is a map").project(10)
}

/// What a light requires for a budget, relative to its first `max_order` bands.
fn required(light: &Projection, brdf: &str, budget: f64, max_order: usize, half: bool) -> Requirement {
    let brdf: Brdf = brdf.parse().expect("is a reflectance");
    let weights = seen::weights(&brdf, light.order);
    let seen = weights.seen(&light.spectrum(), &[]);
    let costs = seen.errors_against(max_order);
    let order = smallest(&costs, budget).expect("the last errs by nothing");
    let energy = seen.bands[..max_order].iter().sum();
    let empty: Vec<usize> = (0..max_order).filter(|&l| seen.bands[l] <= 1e-26 * energy).collect();
    let room = Room { order, max_order, budget, error: costs[order - 1], weights: &weights.of_band, energy };
    Requirement::new(light, &brdf, &room, &empty, half)
}

#[test]
fn what_is_left_out_keeps_the_budget_together_with_the_order() {
    let mut left = 0;
    for name in MAPS {
        let light = light(name);
        for brdf in ["lambert", "phong:20"] {
            for (budget, half) in [(0.1, true), (0.02, false)] {
                let required = required(&light, brdf, budget, 10, half);
                // What is left out is told with what it costs, and the costs add up.
                assert!(required.error <= budget, "{name}, {brdf}: {required:?}");
                let squares: f64 = required.left.iter().map(|left| left.error * left.error).sum();
                assert!(squares <= required.error * required.error + 1e-12, "{required:?}");
                assert!(required.operations[0] <= required.operations[1] && required.bytes[0] <= required.bytes[1]);
                assert_eq!(required.channels == 1, required.left.iter().any(|left| left.what.contains("made grey")));
                assert!(half || !required.half);
                left += required.left.len();
            }
        }
    }
    assert!(left > 10, "{left} things are left out");
}

#[test]
fn a_diffuse_surface_needs_neither_band_3_nor_more_than_a_few() {
    for name in MAPS {
        let required = required(&light(name), "lambert", 1e-3, 10, false);
        // The cosine lobe holds nothing in odd bands from 3 on.
        assert!(required.bands.iter().all(|l| *l < 3 || l % 2 == 0), "{name}: {:?}", required.bands);
        assert!(required.isotropic, "{name}");
    }
}

#[test]
fn sharper_lobes_need_more_bands_and_real_light_has_no_symmetry() {
    for name in ["city", "studio", "sunset"] {
        let light = light(name);
        let [dull, middle, sharp] =
            ["phong:2", "phong:8", "phong:80"].map(|brdf| required(&light, brdf, 0.05, 10, false));
        assert!(dull.order < middle.order && middle.order <= sharp.order, "{name}");
        assert!(!sharp.zonal && !sharp.mirror, "{name}");
    }
}

/// A map that is made: a value for each direction.
fn made(value: impl Fn([f64; 3]) -> [f64; 3]) -> Projection {
    let (width, height) = (64, 32);
    let mut map = Map { width, height, texels: vec![[0.0; 3]; width * height] };
    let directions: Vec<[f64; 3]> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| map.direction(x, y)).collect();
    map.texels = directions.into_iter().map(value).collect();
    map.project(8)
}

#[test]
fn symmetries_of_the_light_are_found_and_kept_apart() {
    let sky = made(|[_, _, z]| [1.0 + z, 1.0 + z, 1.0 + z]);
    let found = required(&sky, "phong:8", 0.01, 8, false);
    assert!(found.zonal && found.channels == 1, "{found:?}");
    assert_eq!(found.coefficients(), found.bands.len(), "one coefficient a band");

    let mirrored = made(|[x, y, z]| [1.0 + x + z, 2.0 + y * y, 1.0]);
    let found = required(&mirrored, "phong:8", 0.01, 8, false);
    assert!(!found.zonal && found.mirror && found.channels == 3, "{found:?}");
    assert!(found.error <= 0.01);

    let skewed = made(|[x, y, z]| [1.0 + x + y + z; 3]);
    let found = required(&skewed, "phong:8", 0.01, 8, false);
    assert!(!found.zonal && !found.mirror && found.channels == 1, "{found:?}");
}

#[test]
fn f16_is_taken_where_the_budget_has_room_only() {
    let light = light("sunset");
    let of = |budget: f64, half: bool| required(&light, "lambert", budget, 5, half);
    assert!(of(0.05, true).half && !of(0.05, false).half);
    assert!(!of(1e-4, true).half, "2⁻¹¹ is above a ten-thousandth");
    assert!(of(0.05, true).bytes[0] * 2 == of(0.05, false).bytes[0]);
}

#[test]
fn a_scene_with_a_reflectance_takes_the_order_that_it_needs() {
    let text = |brdf: &str| {
        format!(
            "name = \"a\"\n[environment]\nmap = \"city_256x128.hdr\"\nsignal = \"radiance\"\nbudget = 0.05\n{brdf}\n[[kernel]]\nspec = \"rotate:environment\""
        )
    };
    let order = |brdf: &str| {
        let scene = Scene::parse("a.toml", &text(brdf), Maps::Folder(repository("scenes/maps")))
            .unwrap_or_else(|error| panic!("{error}"));
        let plan = Plan::new(&scene).unwrap_or_else(|error| panic!("{error}"));
        let shown = plan.to_string();
        assert_eq!(shown.contains("needs of this light"), !brdf.is_empty(), "{shown}");
        plan.environment.expect("has one").order
    };
    assert_eq!(order(""), 10, "a city's own light fills every order");
    let [dull, sharp] = ["2", "20"].map(|s| order(&format!("[brdf]\nkind = \"phong\"\nexponent = {s}\n")));
    assert!(dull < sharp && sharp <= 10, "{dull}, {sharp}");
}
