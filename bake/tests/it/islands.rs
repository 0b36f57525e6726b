//! The second set of texture coordinates says where a texel lies and nothing else: islands that are turned and mirrored show
//! the same picture, and the frame is the normal map's, mirrored or not.

use zonal_bake::basis::Basis;
use zonal_bake::chart::{Chart, filtered};
use zonal_bake::gather::Baker;
use zonal_bake::occluders::Occluders;
use zonal_bake::point::Point;
use zonal_bake::quads::{Lie, Quad, model};
use zonal_bake::sky::Sky;
use zonal_codegen::environment::Map;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::promise::samples::Random;
use zonal_picture::mesh::Model;

const SIZE: usize = 96;

/// A floor with a box on it and a wall, the normal map mirrored on every third rectangle.
fn quads() -> Vec<Quad> {
    let floor = Quad { corner: [-0.6, -0.6, -0.3], along: [1.2, 0.0, 0.0], up: [0.0, 1.2, 0.0], is_mirrored: false };
    let wall = Quad { corner: [-0.6, 0.6, -0.3], along: [0.0, 0.0, 0.7], up: [1.2, 0.0, 0.0], is_mirrored: false };
    let sides = Quad::sides([-0.2, -0.1, -0.3], [0.4, 0.3, 0.35], false);
    // Not the box's bottom, which lies on the floor.
    let mut quads: Vec<Quad> = [floor, wall].into_iter().chain(sides.into_iter().skip(1)).collect();
    quads.iter_mut().step_by(3).for_each(|quad| quad.is_mirrored = true);
    quads
}

/// The irradiance at a normal of the frame.
fn at(coefficients: &[[f64; 3]], normal: [f64; 3]) -> [f64; 3] {
    let mut values = [0.0; 9];
    basis(3, normal, &mut values);
    std::array::from_fn(|k| coefficients.iter().zip(values).map(|(c, y)| c[k] * y).sum())
}

/// The map of a clear sky: bright on one side, so that a frame that is turned shows.
fn sky() -> Sky {
    let mut map = Map { width: 32, height: 16, texels: vec![[0.0; 3]; 512] };
    for i in 0..512 {
        let [x, y, z] = map.direction(i % 32, i / 32);
        map.texels[i] = [1.0 + z, 1.0 + 0.9 * x, (1.0 - y).powi(2)];
    }
    Sky::new(map).expect("light")
}

struct Baked {
    model: Model,
    layers: Vec<Vec<[f64; 3]>>,
}

fn baked(baker: &Baker, lie: impl Fn(usize) -> Lie) -> Baked {
    let model = model(&quads(), 3.0, SIZE, lie).expect("room");
    let chart = Chart::new("a", &model, SIZE).expect("a chart");
    let points: Vec<Point> = chart.points.iter().flatten().copied().collect();
    let layers = chart.filled(&baker.all(&points, || {}));
    Baked { model, layers }
}

#[test]
fn islands_that_are_turned_and_mirrored_show_the_same_picture() {
    let (sky, basis): (_, Basis) = (sky(), "irradiance3".parse().expect("a basis"));
    let occluders = Occluders::new(&model(&quads(), 3.0, SIZE, |_| Lie::default()).expect("room").mesh);
    let baker = Baker { sky: &sky, occluders: &occluders, basis: &basis, rays: 1024, seed: 3, over_pi: false };
    let lie = |i: usize| Lie { quarters: i % 4, is_mirrored: i % 2 == 1 };
    let (plain, moved) = (baked(&baker, |_| Lie::default()), baked(&baker, lie));
    assert_eq!(plain.model.mesh, moved.model.mesh);
    assert_ne!(plain.model.lightmap, moved.model.lightmap);

    let mut random = Random::new(9);
    let (mut errors, mut wrong, mut mean) = ([0.0; 2], 0.0, 0.0);
    let count = 600;
    for number in 0..count {
        let triangle = (random.bits() % (plain.model.mesh.indices.len() as u64 / 3)) as usize;
        let [a, b] = [0, 0].map(|_| 0.5 * (random.signed() + 1.0));
        let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
        let weights = [1.0 - a - b, a, b];
        let point = Point::inside(&plain.model.mesh, triangle, weights);
        // A normal of the map that leans by some 35 degrees.
        let [x, y, z] = random.unit::<3>();
        let normal = zonal_picture::vector::unit([x, y, z.abs() + 1.5]).expect("above the horizon");
        let truth = at(&baker.at(&point, 1_000_000 + number), normal);
        let looked_up = |baked: &Baked, normal: [f64; 3]| {
            let corners = &baked.model.mesh.indices[3 * triangle..3 * triangle + 3];
            let place = [0, 1].map(|k| {
                (0..3).map(|c| weights[c] * f64::from(baked.model.lightmap[corners[c] as usize][k])).sum::<f64>()
            });
            at(&filtered(SIZE, &baked.layers, place), normal)
        };
        let square = |found: [f64; 3]| (0..3).map(|k| (found[k] - truth[k]).powi(2)).sum::<f64>();
        errors[0] += square(looked_up(&plain, normal));
        errors[1] += square(looked_up(&moved, normal));
        mean += truth.iter().map(|v| v * v).sum::<f64>();
        // What it would be if the frame were that of the lightmap's own set, mirrored and turned with its island.
        let Lie { quarters, is_mirrored } = lie(triangle / 2);
        let [mut x, mut y, z] = normal;
        if is_mirrored {
            x = -x;
        }
        (0..quarters).for_each(|_| [x, y] = [y, -x]);
        wrong += square(looked_up(&moved, [x, y, z]));
    }
    let [plain, moved] = errors.map(|error| (error / mean).sqrt());
    let wrong = (wrong / mean).sqrt();
    println!("rms error: plain {plain:.4}, turned and mirrored {moved:.4}; in the lightmap's frame {wrong:.4}");
    // What is left is the texels' own error and that of a thousand rays; islands lie on other centres when they are turned.
    assert!(plain < 0.06, "{plain}");
    assert!(moved < 1.5 * plain && plain < 1.5 * moved, "{plain} {moved}");
    assert!(wrong > 3.0 * moved, "{wrong}");
}
