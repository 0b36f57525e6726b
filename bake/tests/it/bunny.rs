//! What `zonal bake` writes of the bunny, against sums over all texels of the map with a plain loop over all triangles: no
//! tree, no random numbers, no part of the baker.

use crate::repository;
use rayon::prelude::*;
use std::process::Command;
use zonal_codegen::environment::Map;
use zonal_codegen::environment::harmonics::{basis, cosine_lobe};

/// How far above a vertex rays start, in radii of the mesh, as the baker says.
const LIFT: f64 = zonal_bake::point::LIFT;
const RAYS: usize = 16_384;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A PLY file: what its properties are called, the numbers of each vertex, the triangles.
struct Ply {
    names: Vec<String>,
    vertices: Vec<Vec<f64>>,
    faces: Vec<[usize; 3]>,
}

fn ply(bytes: &[u8]) -> Ply {
    let end = bytes.windows(11).position(|window| window == b"end_header\n").expect("a head") + 11;
    let head = String::from_utf8(bytes[..end].to_vec()).expect("text");
    let count = |of: &str| -> usize {
        let line = head.lines().find_map(|line| line.strip_prefix(&format!("element {of} "))).expect("an element");
        line.parse().expect("a number")
    };
    let names: Vec<String> =
        head.lines().filter_map(|line| line.strip_prefix("property float ")).map(str::to_owned).collect();
    let split = end + 4 * names.len() * count("vertex");
    let numbers: Vec<f64> = bytes[end..split].as_chunks().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect();
    let face = |face: &[u8]| {
        assert_eq!(face[0], 3);
        let index = |k: usize| u32::from_le_bytes(face[4 * k + 1..4 * k + 5].try_into().expect("four bytes")) as usize;
        [0, 1, 2].map(index)
    };
    let faces: Vec<[usize; 3]> = bytes[split..].chunks(13).map(face).collect();
    assert_eq!(faces.len(), count("face"));
    Ply { vertices: numbers.chunks(names.len()).map(<[f64]>::to_vec).collect(), names, faces }
}

/// y up to z up.
fn upright(v: &[f64]) -> [f64; 3] {
    [v[0], -v[2], v[1]]
}

#[test]
fn twenty_vertices_get_what_sums_over_all_texels_and_triangles_say() {
    let folder = std::env::temp_dir().join(format!("zonal-bake-bunny-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let map = repository("scenes/maps/courtyard_256x128.hdr");
    let run = Command::new(env!("CARGO_BIN_EXE_zonal-bake"))
        .arg(repository("scenes/meshes/bunny.obj"))
        .arg("--map")
        .arg(&map)
        .args(["--basis", "irradiance3", "--seed", "7", "--rays", &RAYS.to_string(), "-o", "bunny.ply"])
        .current_dir(&folder)
        .output()
        .expect("the command starts");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let bytes = std::fs::read(folder.join("bunny.ply")).expect("written");
    let toml = std::fs::read_to_string(folder.join("bunny.toml")).expect("written");
    std::fs::remove_dir_all(&folder).expect("removed");
    for line in
        ["basis = \"irradiance3\"", "over_pi = false", "convention = \"zonal\"", "space = \"tangent\"", "scale = 1.0"]
    {
        assert!(toml.contains(line), "{line}: {toml}");
    }
    let Ply { names, vertices, faces } = ply(&bytes);
    assert_eq!(names.len(), 10 + 27);
    assert_eq!(names[9..13], ["tw", "c0_r", "c0_g", "c0_b"]);

    let places: Vec<[f64; 3]> = vertices.iter().map(|v| upright(&v[..3])).collect();
    let bound = |pick: fn(f64, f64) -> f64| [0, 1, 2].map(|k| places.iter().map(|p| p[k]).reduce(pick).expect("some"));
    let (low, high) = (bound(f64::min), bound(f64::max));
    let centre = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
    let radius = places.iter().map(|&p| dot(minus(p, centre), minus(p, centre)).sqrt()).fold(0.0, f64::max);
    let triangles: Vec<[[f64; 3]; 3]> = faces.iter().map(|face| face.map(|i| places[i])).collect();
    let map = Map::read(&map).expect("a map");
    let lights: Vec<([f64; 3], [f64; 3])> = (0..map.texels.len())
        .map(|i| {
            let (x, y) = (i % map.width, i / map.width);
            (map.direction(x, y), map.texels[i].map(|v| v * map.solid_angle(x, y)))
        })
        .collect();
    let total: f64 = lights.iter().flat_map(|(_, power)| power).sum();

    let mut worst: f64 = 0.0;
    let (mut shadowed, mut squares) = (0, 0.0);
    for number in (0..20).map(|i| i * vertices.len() / 20) {
        let vertex = &vertices[number];
        let (normal, tangent) = (upright(&vertex[3..6]), upright(&vertex[6..9]));
        let bitangent = cross(normal, tangent).map(|b| b * vertex[9]);
        let from = [0, 1, 2].map(|k| places[number][k] + LIFT * radius * normal[k]);
        let seen: Vec<([f64; 3], [f64; 3])> = lights
            .par_iter()
            .filter(|(direction, _)| dot(*direction, normal) > 0.0)
            .filter(|(direction, _)| {
                // A ray meets a triangle if it passes all three edges on one side.
                !triangles.iter().any(|corners| {
                    let [a, b, c] = corners.map(|p| minus(p, from));
                    let volumes = [(b, c), (c, a), (a, b)].map(|(p, q)| dot(*direction, cross(p, q)));
                    let one_side = volumes.iter().all(|v| *v > 0.0) || volumes.iter().all(|v| *v < 0.0);
                    one_side && dot(a, cross(minus(b, a), minus(c, a))) * volumes.iter().sum::<f64>() > 0.0
                })
            })
            .copied()
            .collect();
        let above = lights.iter().filter(|(direction, _)| dot(*direction, normal) > 0.0).count();
        shadowed += usize::from(seen.len() < above * 9 / 10);
        // The sums, and the mean square of what one ray brings: its power is the map's, its colour the texel's.
        let (mut sums, mut second) = ([[0.0; 3]; 9], [[0.0; 3]; 9]);
        let mut values = [0.0; 9];
        for (direction, power) in &seen {
            let local = [tangent, bitangent, normal].map(|axis| dot(*direction, axis));
            basis(3, local, &mut values);
            let chance = power.iter().sum::<f64>() / total;
            for i in 0..9 {
                for k in 0..3 {
                    let brought = values[i] * cosine_lobe(i.isqrt()) * power[k];
                    sums[i][k] += brought;
                    if chance > 0.0 {
                        second[i][k] += brought * brought / chance;
                    }
                }
            }
        }
        for i in 0..9 {
            for k in 0..3 {
                let found = vertex[10 + 3 * i + k];
                let sigma = ((second[i][k] - sums[i][k] * sums[i][k]) / RAYS as f64).max(0.0).sqrt();
                let apart = (found - sums[i][k]).abs();
                worst = worst.max(apart / sigma);
                squares += (apart / sigma).powi(2) / (20.0 * 27.0);
            }
        }
    }
    println!("{shadowed} vertices in shadow; worst {worst:.2} standard errors, rms {:.2}", squares.sqrt());
    assert!(shadowed >= 8, "the bunny stands in its own light");
    // Independent rays would err by one standard error in the root mean square, and 540 of them by 4.5 once in three hundred
    // tests; parts of 0 to 1 err by less. What they see of a texel beside its centre adds to that.
    assert!(worst < 4.5 && squares.sqrt() < 1.0, "{worst} {squares}");
}
