//! `docs/HEIGHT_FIELD.md` is what is measured of light turned into every frame. Written with
//! `UPDATE=1 cargo test -p zonal-render --test it height_field`, which draws and takes times.

use crate::report::{repository, split};
use zonal_codegen::environment::Map;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_render::compute;
use zonal_render::field::ground::Ground;
use zonal_render::field::page::{Subject, TIMES};
use zonal_render::field::shader::{Inputs, text};
use zonal_render::field::tables::Cube;
use zonal_render::field::transfer::bake;
use zonal_render::field::ways::{Shader, Turn, WAYS};
use zonal_render::gpu::Gpu;

#[test]
fn the_page_is_what_is_measured_and_all_ways_are_one() {
    let map = Map::read(&repository("scenes/maps/interior_256x128.hdr")).unwrap_or_else(|error| panic!("{error}"));
    let subject = Subject::new("interior", &map);
    let report = subject.measure().unwrap_or_else(|error| panic!("{error}"));
    let (path, fresh) = (repository("docs/HEIGHT_FIELD.md"), report.markdown());
    if std::env::var_os("UPDATE").is_some() {
        let gpu = Gpu::open().unwrap_or_else(|error| panic!("{error}"));
        let (canvas, times) = subject.draw(&gpu).unwrap_or_else(|error| panic!("{error}"));
        std::fs::write(&path, fresh.clone() + &times).expect("writable");
        std::fs::write(repository("docs/height_field.png"), canvas.png()).expect("writable");
    }
    let old = std::fs::read_to_string(&path).unwrap_or_default();
    let old = old.split(&format!("\n{TIMES}")).next().unwrap_or_default();
    let ((words, numbers), (old_words, old_numbers)) = (split(&fresh), split(old));
    let help = "docs/HEIGHT_FIELD.md is stale; run `UPDATE=1 cargo test -p zonal-render --test it height_field`";
    assert_eq!(words, old_words, "{help}");
    for (new, old) in numbers.iter().zip(&old_numbers) {
        // Two digits are printed, and the last may be rounded the other way.
        assert!((new - old).abs() <= 0.02 * new.abs().max(old.abs()) + 1e-9, "{help}: {new} stands as {old}");
    }

    let object = report.rows.last().expect("there are ways").operations[0];
    for row in &report.rows {
        // f32 rounds some hundred times, and the mean radiance is less than the norms of light and transfer.
        assert!(row.exact.worst <= 1e-12 || !row.way.is_exact(), "{}: {:?}", row.way.name, row.exact);
        match row.way.turn {
            _ if !row.way.is_exact() => assert!(row.exact.worst > 1e-3, "{:?}", row.exact),
            // What is read errs by a hundredth of each band's largest value, which is more than a point's share of it.
            Turn::Samples => assert!((1e-4..0.3).contains(&row.errors.rms), "{:?}", row.errors),
            _ => assert!(row.errors.worst <= 1e-5, "{}: {:?}", row.way.name, row.errors),
        }
        assert!(row.operations[0] >= object);
    }
    // The steeper, the worse; within five degrees a hundredth.
    let leans = &report.leans;
    assert!(leans.is_sorted_by(|flat, steep| flat[2] < steep[2]) && leans[0][2] < 0.01, "{leans:?}");
    let [symmetric, isotropic] = report.kept;
    assert!(symmetric.rms > 1e-3 && isotropic.rms > symmetric.rms, "{:?}", report.kept);
}

/// What the adapter computes of each way is what the interpreter does, tables read by its own filter.
#[test]
fn every_way_is_on_the_adapter_what_it_is_in_the_interpreter() {
    const ORDER: usize = 3;
    let map = Map::read(&repository("scenes/maps/interior_256x128.hdr")).unwrap_or_else(|error| panic!("{error}"));
    let light = map.project(ORDER).coefficients;
    let tables: Vec<Cube> = (0..ORDER).map(|l| Cube::new(&light, l)).collect();
    let (ground, points): (Ground, Vec<usize>) = (Ground::new(2, 10), (0..100).collect());
    let transfer = bake(&ground, &points, &Brdf::Phong { exponent: 6.0 }, [0.0, 0.6, 0.8], ORDER);
    let wide = |[a, b, c]: [f64; 3]| [a as f32, b as f32, c as f32, 0.0];
    let (e, normals): (Vec<_>, Vec<_>) =
        (light.iter().map(|&e| wide(e)).collect(), points.iter().map(|&point| wide(ground.normal(point))).collect());
    let gpu = Gpu::open().unwrap_or_else(|error| panic!("{error}"));
    for way in WAYS {
        let of = |i: usize| {
            transfer.iter().map(move |of| if way.turn == Turn::None { of.object[i] } else { of.local[i] } as f32)
        };
        let narrow: Vec<f32> = (0..ORDER * ORDER).flat_map(of).collect();
        let inputs = Inputs { transfer: &narrow, light: &e, normals: &normals, cubes: &tables };
        let text = text(way, ORDER).unwrap_or_else(|error| panic!("{error}"));
        let ran = compute::run(&gpu, way, ORDER, &text, &inputs).unwrap_or_else(|error| panic!("{error}"));
        let tabled = (way.turn == Turn::Samples).then_some(&tables[..]);
        let shader = Shader::<f32>::new(way, &light, tabled).unwrap_or_else(|error| panic!("{error}"));
        // Filters of adapters have a few bits for a place between texels, and go over a cube's edges.
        let allowed = if tabled.is_some() { 0.1 } else { 1e-5 };
        assert_eq!(ran.result.len(), points.len());
        for (point, found) in ran.result.iter().enumerate() {
            let wanted = shader.shade(ground.normal(point), &transfer[point]);
            for k in 0..3 {
                let apart = (f64::from(found[k]) - wanted[k]).abs();
                assert!(apart <= allowed * wanted[k].abs().max(0.1), "{}: {found:?} {wanted:?}", way.name);
            }
        }
    }
}
