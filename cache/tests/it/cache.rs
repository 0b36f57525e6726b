//! The cache: a record serves at its own place as it is, a seed gives the same records on any number of threads, the picture
//! comes near brute force, and all methods show much the same.

use zonal_cache::basis::{Basis, HSH6, SH6};
use zonal_cache::cache::{Cache, Count};
use zonal_cache::gloss::Slices;
use zonal_cache::page::{Size, measured, rows};
use zonal_cache::record::{Record, Sampling};
use zonal_cache::scene::{OBJECTS, Scene};
use zonal_cache::study::{CAMERA, Setup, filled, table};
use zonal_cache::view::View;

fn at_its_own_place<const C: usize>(scene: &Scene, view: &View, basis: Basis<C>) {
    let sampling = Sampling { rays: 256, seed: 3 };
    let place = view.glossy[view.glossy.len() / 2].place;
    let mut cache = Cache::new(basis, 0.2);
    cache.insert(Record::new(&basis, scene, place, sampling, 0));
    let record = &cache.records[0];
    let norm = record.light.as_flattened().iter().map(|x| x.abs()).fold(0.0, f32::max);
    assert!(norm > 0.01 && record.slopes[0].as_flattened().iter().any(|x| x.abs() > 1e-4));
    for method in basis.methods {
        let mut count = Count::default();
        let light = cache.light(&place, method, 0.1, &mut count).expect("it serves there");
        assert_eq!(count.all, 1);
        for (found, wanted) in light.as_flattened().iter().zip(record.light.as_flattened()) {
            // f32 rounds; what is extended below the horizon and taken back is off by what the extension's 10⁻³ weighs, and by
            // what eight spherical bands do not hold.
            let tolerance = match method.name {
                "table C D_y E" => 5e-2,
                "method 1, 8 bands" => 0.2,
                _ => 1e-5,
            };
            assert!((found - wanted).abs() < tolerance * norm, "{}: {found} {wanted}", method.name);
        }
    }
    // Far away none serves.
    let other = view.glossy.iter().find(|pixel| !cache.serves(&pixel.place)).expect("some pixel is far away");
    assert_eq!(cache.light(&other.place, &basis.methods[0], 0.1, &mut Count::default()), None);
}

#[test]
fn a_record_comes_back_at_its_own_place() {
    let scene = Scene::objects().expect("the bunny is there");
    let view = View::new(&scene, &CAMERA, 24);
    at_its_own_place(&scene, &view, SH6);
    at_its_own_place(&scene, &view, HSH6);
}

#[test]
fn a_seed_gives_the_same_records_on_any_number_of_threads() {
    let scene = Scene::objects().expect("the bunny is there");
    let view = View::new(&scene, &CAMERA, 24);
    let records = |threads: usize, seed: u32| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut cache = Cache::new(SH6, 0.4);
            cache.fill(&scene, view.places(), Sampling { rays: 300, seed }, || ());
            cache.records
        })
    };
    let one = records(1, 7);
    assert!(one.len() > 5 && one == records(3, 7));
    assert_ne!(one, records(1, 8));
}

#[test]
fn the_cache_comes_near_brute_force_and_turning_records_pays() {
    let scene = Scene::objects().expect("the bunny is there");
    let view = View::new(&scene, &CAMERA, 48);
    let truth = view.brute_force(&scene, 256, 1, || ()).radiance;
    let sampling = Sampling { rays: 512, seed: 1 };
    let setup = Setup { scene: &scene, gloss: OBJECTS, view: &view, truth: &truth, sampling };
    let (cache, _) = filled(&setup, SH6, 0.3, &|| ());
    let found = table(&setup, &cache, 0.0);
    let at = |name: &str| found.rows.iter().find(|row| row.name == name).expect("a method of that name");
    // Order 6 of a lobe of exponent 12, and few rays: a fifth; without the turn it is more.
    assert!(at("exact").truth < 0.25, "{}", rows(&found));
    assert!(at("ignored").truth > at("exact").truth && at("ignored").exact > 0.02, "{}", rows(&found));
    assert!(at("LF3").exact < at("Taylor 1.5").exact && at("Taylor 1.5").exact < at("ignored").exact);
    for name in ["zxzxz", "Ivanic and Ruedenberg"] {
        assert!(at(name).exact < 1e-4, "{}", rows(&found));
    }
    let count = at("exact").count;
    assert!(count.any == count.all && count.all >= view.glossy.len());
    // The lower the limit, the more turns are exact.
    let (slices, method) = (Slices::new(SH6, &OBJECTS), SH6.methods.iter().find(|method| method.small.is_some()));
    let method = method.expect("there is one for small angles");
    let shares = [0.0, 0.02, 1.0].map(|limit| view.cached(&cache, &slices, method, limit).count.any);
    assert!(shares[0] > shares[1] && shares[1] > 0 && shares[2] == 0, "{shares:?}");
    // A record at its own place is not turned at all: one a record at most.
    assert!(shares[0] + cache.records.len() >= count.all, "{shares:?}");
}

#[test]
fn the_page_has_all_its_parts_at_any_size() {
    let small = Size { side: 12, rays: 32, wall_rays: 32, truth: 8, seed: 1 };
    let files = measured(&small, &indicatif::ProgressBar::hidden()).expect("it is measured");
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["CACHE.md", "cache_sh6.png", "cache_hsh6.png", "cache_wall.png"]);
    let text = String::from_utf8_lossy(&files[0].1);
    // So that it is replaced unasked.
    assert!(text.lines().take(3).any(|line| line.contains("@generated by zonal")));
    for name in ["Taylor 1.5", "LF3 on B", "equation 13", "table C D_y E", "held at"] {
        assert!(text.contains(name), "{name}");
    }
    assert!(files[1..].iter().all(|(_, bytes)| bytes.starts_with(b"\x89PNG")));
}
