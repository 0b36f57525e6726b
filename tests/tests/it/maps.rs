//! Maps in every format and layout that is read, each written here, against the series that they were made of; and files that
//! are refused, with what is said of them. The cube's directions are those of the tables of OpenGL and its extensions
//! (OpenGL 4.6, section 8.13), not zonal's own.

use std::fs;
use std::path::Path;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::environment::{Layout, Loaded, Map, Projection};
use zonal_codegen::promise::samples::Random;
use zonal_tests::command::Folder;

/// The order of the sky.
const ORDER: usize = 4;
/// The side of a face: texels hold the sky at their centres, which changes band l by l (l + 1) Δ²/24 at first order: of
/// band 3, with Δ = 2/64, 4.9e-4.
const SIDE: usize = 64;
const SAMPLED: f64 = 5e-4;

/// A sky of four bands that is nowhere negative and nowhere above 1, with no symmetry.
fn sky() -> Projection {
    let mut random = Random::new(7);
    let mut coefficients: Vec<[f64; 3]> =
        (0..ORDER * ORDER).map(|_| [(); 3].map(|()| 0.08 * random.signed())).collect();
    coefficients[0] = [1.6, 1.7, 1.5];
    Projection { order: ORDER, coefficients, beyond: 0.0 }
}

/// An image: its width and its texels.
#[derive(Clone)]
struct Image {
    width: usize,
    texels: Vec<[f64; 3]>,
}

impl Image {
    fn height(&self) -> usize {
        self.texels.len() / self.width
    }
}

/// The direction of a cube's face at s and t from −1 to 1, by the table of OpenGL, in zonal's frame: the cube's y is up.
fn cube_direction(face: usize, s: f64, t: f64) -> [f64; 3] {
    let [x, y, z] = [[1.0, -t, -s], [-1.0, -t, s], [s, 1.0, t], [s, -1.0, -t], [s, -t, 1.0], [-s, -t, -1.0]][face];
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, z / length, y / length]
}

fn faces(side: usize) -> Vec<Image> {
    let sky = sky();
    let at = |i: usize| (2 * i + 1) as f64 / side as f64 - 1.0;
    let texel = |face: usize, i: usize| sky.evaluate(cube_direction(face, at(i % side), at(i / side)));
    let face = |face: usize| Image { width: side, texels: (0..side * side).map(|i| texel(face, i)).collect() };
    (0..6).map(face).collect()
}

/// An image of so many squares, with faces in some of them, turned by half a turn or not; what is left is black.
fn composed(squares: [usize; 2], places: [([usize; 2], bool); 6]) -> Image {
    let (width, height) = (squares[0] * SIDE, squares[1] * SIDE);
    let mut image = Image { width, texels: vec![[0.0; 3]; width * height] };
    for (face, ([column, row], is_turned)) in faces(SIDE).iter().zip(places) {
        for (i, texel) in face.texels.iter().enumerate() {
            let i = if is_turned { SIDE * SIDE - 1 - i } else { i };
            image.texels[(row * SIDE + i / SIDE) * width + column * SIDE + i % SIDE] = *texel;
        }
    }
    image
}

/// The sky in every layout of one image.
fn layouts() -> Vec<(Layout, Image)> {
    let plain = |places: [[usize; 2]; 6]| places.map(|place| (place, false));
    let sky = sky();
    let map = Map { width: 256, height: 128, texels: vec![] };
    let texels = (0..256 * 128).map(|i| sky.evaluate(map.direction(i % 256, i / 256))).collect();
    let mut cross = plain([[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [1, 3]]);
    cross[5].1 = true;
    vec![
        (Layout::LatitudeLongitude, Image { width: 256, texels }),
        (Layout::HorizontalStrip, composed([6, 1], plain([0, 1, 2, 3, 4, 5].map(|i| [i, 0])))),
        (Layout::VerticalStrip, composed([1, 6], plain([0, 1, 2, 3, 4, 5].map(|i| [0, i])))),
        (Layout::HorizontalCross, composed([4, 3], plain([[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]]))),
        (Layout::VerticalCross, composed([3, 4], cross)),
    ]
}

/// How far coefficients are from the sky's, in shares of their norm.
fn distance(found: &Projection) -> f64 {
    let wanted = sky();
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let pairs = found.coefficients.iter().flatten().zip(wanted.coefficients.iter().flatten());
    norm(&mut pairs.map(|(a, b)| a - b)) / norm(&mut wanted.coefficients.iter().flatten().copied())
}

fn exr(image: &Image, names: [&str; 3]) -> Vec<u8> {
    use exr::prelude::*;
    let channel = |k: usize| {
        let samples: Vec<f32> = image.texels.iter().map(|texel| texel[k] as f32).collect();
        AnyChannel::new(names[k], FlatSamples::F32(samples))
    };
    let list: Vec<AnyChannel<FlatSamples>> = (0..3).map(channel).collect();
    written((image.width, image.height()), list)
}

fn written(size: (usize, usize), list: Vec<exr::prelude::AnyChannel<exr::prelude::FlatSamples>>) -> Vec<u8> {
    use exr::prelude::*;
    let channels = AnyChannels::sort(list.into_iter().collect());
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = exr::image::Image::from_channels(size, channels);
    image.write().to_buffered(&mut bytes).expect("written");
    bytes.into_inner()
}

/// A Radiance HDR file with texels one after another in the order that its size line says; mantissas are rounded.
fn hdr(image: &Image, line: &str) -> Vec<u8> {
    let (width, height) = (image.width, image.height());
    let words: Vec<&str> = line.split(' ').collect();
    let by_columns = words[0].ends_with('X');
    let (x_word, y_word) = if by_columns { (words[0], words[2]) } else { (words[2], words[0]) };
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{line}\n").into_bytes();
    for i in 0..width * height {
        let (x, y) = if by_columns { (i / height, i % height) } else { (i % width, i / width) };
        let x = if x_word == "-X" { width - 1 - x } else { x };
        let y = if y_word == "+Y" { height - 1 - y } else { y };
        let texel = image.texels[y * width + x];
        let most = texel.iter().copied().fold(0.0, f64::max);
        let exponent = if most > 0.0 { most.log2().floor() as i32 + 1 } else { 0 };
        let byte = |v: f64| (v * f64::from(8 - exponent).exp2()).round().min(255.0) as u8;
        let [r, g, b] = texel.map(byte);
        // Three ones would begin a run.
        let r = if [r, g, b] == [1; 3] { 2 } else { r };
        bytes.extend([r, g, b, if most > 0.0 { (exponent + 128) as u8 } else { 0 }]);
    }
    bytes
}

/// A PNG file, its values encoded by sRGB's curve, or linear and said to be.
fn png(image: &Image, depth: png::BitDepth, is_linear: bool) -> Vec<u8> {
    let encoded = |v: f64| match v {
        v if is_linear => v,
        v if v <= 0.003_130_8 => 12.92 * v,
        v => 1.055 * v.powf(1.0 / 2.4) - 0.055,
    };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width as u32, image.height() as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(depth);
    if is_linear {
        encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    }
    let data: Vec<u8> = match depth {
        png::BitDepth::Sixteen => {
            let values = image.texels.iter().flatten().map(|&v| (65535.0 * encoded(v)).round() as u16);
            values.flat_map(u16::to_be_bytes).collect()
        }
        _ => image.texels.iter().flatten().map(|&v| (255.0 * encoded(v)).round() as u8).collect(),
    };
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&data).expect("written");
    writer.finish().expect("finished");
    bytes
}

fn loaded(bytes: &[u8]) -> Loaded {
    Loaded::from_bytes("sky", bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn message(bytes: &[u8]) -> String {
    Loaded::from_bytes("sky", bytes).expect_err("it is refused").to_string()
}

#[test]
fn every_layout_gives_the_coefficients_of_the_sky() {
    for (layout, image) in layouts() {
        let found = loaded(&exr(&image, ["R", "G", "B"]));
        assert_eq!(found.layout, layout);
        assert_eq!(found.size, [image.width, image.height()]);
        let error = distance(&found.map.project(ORDER));
        assert!(error < SAMPLED, "{layout}: {error}");
        // The way by which no map stands in memory.
        let (projection, size) = Projection::from_bytes("sky", &exr(&image, ["R", "G", "B"]), ORDER).expect("a map");
        assert_eq!((&projection, size), (&found.map.project(ORDER), found.size));
        println!("{layout}: {error:.1e}");
    }
}

#[test]
fn a_cube_is_integrated_exactly() {
    // Of a uniform map only band 0 is there: rounding and the quadrature are left. Its sides are no multiples of the blocks.
    for side in [1, 2, 5, 64, 100] {
        let map = Map { width: side, height: 6 * side, texels: vec![[2.5; 3]; 6 * side * side] };
        for order in [1, 3, 10, 32] {
            let found = map.project(order);
            let wanted = 2.0 * std::f64::consts::PI.sqrt() * 2.5;
            let rest = found.coefficients[1..].iter().flatten().map(|c| c.abs()).fold(0.0, f64::max);
            let error = (found.coefficients[0][0] / wanted - 1.0).abs().max(rest / wanted);
            assert!(error < 1e-9, "side {side}, order {order}: {error:e}");
        }
        let sphere: f64 = (0..6 * side * side).map(|i| map.solid_angle(i % side, i / side)).sum();
        assert!((sphere - 4.0 * std::f64::consts::PI).abs() < 1e-11, "{side}");
    }
    // Of one texel of a face, by a fine rule: 200 x 200 points of equal weight in the face's own coordinates.
    let (side, order, fine) = (3, 8, 200);
    for (face, x, y) in [(0, 0, 0), (1, 2, 1), (2, 1, 0), (3, 0, 2), (4, 2, 2), (5, 1, 1)] {
        let mut map = Map { width: side, height: 6 * side, texels: vec![[0.0; 3]; 6 * side * side] };
        map.texels[(face * side + y) * side + x] = [1.0; 3];
        let found = map.project(order);
        let step = 2.0 / (side * fine) as f64;
        let (mut wanted, mut values) = (vec![0.0; order * order], vec![0.0; order * order]);
        for (i, j) in (0..fine).flat_map(|i| (0..fine).map(move |j| (i, j))) {
            let [s, t] = [(x, i), (y, j)].map(|(k, i)| (k * fine + i) as f64 * step + 0.5 * step - 1.0);
            let weight = step * step / (1.0 + s * s + t * t).powf(1.5);
            basis(order, cube_direction(face, s, t), &mut values);
            wanted.iter_mut().zip(&values).for_each(|(sum, value)| *sum += weight * value);
        }
        // The midpoint rule errs by about l (l + 1) step²/24 of the texel's 0.5 sr: 1.3e-5.
        for (c, wanted) in found.coefficients.iter().zip(&wanted) {
            assert!((c[0] - wanted).abs() < 2e-5, "face {face}: {} {wanted}", c[0]);
        }
    }
}

#[test]
fn parseval_holds_for_a_cube() {
    let mut random = Random::new(3);
    let texels = (0..6 * 4 * 4).map(|_| [(); 3].map(|()| random.signed().abs())).collect();
    let map = Map { width: 4, height: 24, texels };
    let whole = map.project(48);
    assert!((whole.energy() / map.energy() - 1.0).abs() < 1e-9 && whole.beyond > 0.0);
    let part = map.project(6);
    let beyond = whole.beyond + whole.band_energy()[6..].iter().sum::<f64>();
    assert!((part.beyond / beyond - 1.0).abs() < 1e-8, "{} {beyond}", part.beyond);
    // Texels are found in their directions, and a cube unrolled is the same sky but for the sampling.
    for i in 0..map.texels.len() {
        assert_eq!(map.radiance(map.direction(i % 4, i / 4)), map.texels[i]);
    }
    let (unrolled, cube) = (map.unrolled(64).project(3), map.project(3));
    assert!((unrolled.coefficients[0][0] / cube.coefficients[0][0] - 1.0).abs() < 1e-3);
}

#[test]
fn every_encoding_gives_the_coefficients_of_the_sky() {
    let (_, image) = layouts().swap_remove(0);
    // RGBE rounds to 1 in 256 of the largest channel, errors of which average out over 32,768 texels; eight bits of sRGB
    // to 0.5/255 of its curve; sixteen to less than what sampling leaves.
    let all = [
        ("OpenEXR", exr(&image, ["R", "G", "B"]), SAMPLED),
        ("OpenEXR, layer `diffuse`", exr(&image, ["diffuse.R", "diffuse.G", "diffuse.B"]), SAMPLED),
        ("Radiance HDR", hdr(&image, "-Y 128 +X 256"), 1e-3),
        ("PNG of 16 bits, decoded from sRGB", png(&image, png::BitDepth::Sixteen, false), SAMPLED),
        ("PNG of 16 bits, linear, as it says", png(&image, png::BitDepth::Sixteen, true), SAMPLED),
        ("PNG of 8 bits, decoded from sRGB", png(&image, png::BitDepth::Eight, false), 1e-3),
    ];
    for (encoding, bytes, tolerance) in all {
        let found = loaded(&bytes);
        assert_eq!(found.encoding, encoding);
        let error = distance(&found.map.project(ORDER));
        assert!(error < tolerance, "{encoding}: {error}");
        println!("{encoding}: {error:.1e}");
    }
}

#[test]
fn a_radiance_file_may_begin_in_any_corner() {
    let (_, image) = layouts().swap_remove(0);
    let upright = loaded(&hdr(&image, "-Y 128 +X 256"));
    let lines = ["+Y 128 +X 256", "-Y 128 -X 256", "+Y 128 -X 256"];
    let turned = ["+X 256 -Y 128", "-X 256 -Y 128", "+X 256 +Y 128", "-X 256 +Y 128"];
    for line in lines.iter().chain(&turned) {
        let bytes = hdr(&image, line);
        assert!(loaded(&bytes) == upright, "{line}");
        let (projection, _) = Projection::from_bytes("sky", &bytes, ORDER).expect("a map");
        assert_eq!(projection.coefficients, upright.map.project(ORDER).coefficients, "{line}");
    }
    let cube = composed([6, 1], [0, 1, 2, 3, 4, 5].map(|i| ([i, 0], false)));
    let (projection, size) = Projection::from_bytes("sky", &hdr(&cube, "-Y 64 +X 384"), ORDER).expect("a map");
    assert!(size == [384, 64] && distance(&projection) < 1e-3, "{}", distance(&projection));
}

/// Its decoder asks for as much memory as a block says that its parts hold.
#[test]
fn a_block_in_dwa_compression_names_no_size_that_none_has() {
    use exr::prelude::*;
    let (_, image) = layouts().swap_remove(0);
    let channel = |k: usize, name: &str| {
        AnyChannel::new(name, FlatSamples::F32(image.texels.iter().map(|texel| texel[k] as f32).collect()))
    };
    let list = ["R", "G", "B"].iter().enumerate().map(|(k, name)| channel(k, name)).collect();
    let encoding = Encoding { compression: Compression::DWAA(None), ..Encoding::FAST_LOSSLESS };
    let image =
        exr::image::Image::from_encoded_channels((image.width, image.height()), encoding, AnyChannels::sort(list));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).expect("written");
    let bytes = bytes.into_inner();
    let found = loaded(&bytes);
    assert!(distance(&found.map.project(ORDER)) < 0.05, "what is lossy is read");
    // A block begins with eleven counters, the first of which is the version.
    let counters = |block: &[u8]| -> Vec<u64> {
        block.chunks_exact(8).map(|word| u64::from_le_bytes(word.try_into().expect("eight"))).collect()
    };
    let is_block = |block: &[u8]| {
        let counters = counters(block);
        counters[0] == 2 && counters.iter().all(|counter| *counter < bytes.len() as u64)
    };
    let start = bytes.windows(88).position(is_block).expect("a block of version 2");
    for counter in 1..10 {
        let mut bytes = bytes.clone();
        bytes[start + 8 * counter..][..8].copy_from_slice(&(1u64 << 40).to_le_bytes());
        let text = message(&bytes);
        assert!(text.contains("names a size that none has"), "counter {counter}: {text}");
    }
}

#[test]
fn layers_and_luminance_of_openexr_are_read_or_refused_with_a_hint() {
    use exr::prelude::{AnyChannel, FlatSamples};
    let (_, image) = layouts().swap_remove(0);
    let size = (image.width, image.height());
    let channel = |name: &str, k: usize| {
        let samples = image.texels.iter().map(|texel| texel[k] as f32).collect();
        AnyChannel::new(name, FlatSamples::F32(samples))
    };
    let layer =
        |name: &str| ["R", "G", "B"].iter().enumerate().map(|(k, c)| channel(&format!("{name}.{c}"), k)).collect();
    let layers = |names: &[&str]| -> Vec<AnyChannel<FlatSamples>> {
        names.iter().flat_map(|name| -> Vec<AnyChannel<FlatSamples>> { layer(name) }).collect()
    };
    let blender = written(size, layers(&["View Layer.Combined", "View Layer.DiffDir"]));
    let found = loaded(&blender);
    assert_eq!(found.encoding, "OpenEXR, layer `View Layer.Combined`");
    assert!(distance(&found.map.project(ORDER)) < SAMPLED);
    let text = message(&written(size, layers(&["key", "fill"])));
    assert!(
        text.contains("`fill`, `key`") && text.ends_with("save the one that you want as channels R, G and B"),
        "{text}"
    );
    let grey = loaded(&written(size, vec![channel("Y", 1)]));
    assert_eq!(grey.encoding, "OpenEXR, luminance alone: grey");
    assert!(grey.map.texels.iter().all(|[r, g, b]| r == g && g == b));
    let wanted = sky().coefficients[5][1];
    assert!((grey.map.project(ORDER).coefficients[5][0] - wanted).abs() < SAMPLED, "{wanted}");
    let text = message(&written(size, vec![channel("Y", 0), channel("RY", 1), channel("BY", 2)]));
    assert!(text.contains("luminance and chroma"), "{text}");
    let text = message(&written(size, vec![channel("Z", 0)]));
    assert!(text.contains("the channels `Z`, but neither R, G and B nor a luminance"), "{text}");
}

#[test]
fn six_files_are_a_cube() {
    let folder = Folder::new();
    let faces = faces(SIDE);
    let sets = [
        ["px", "nx", "py", "ny", "pz", "nz"],
        ["posx", "negx", "posy", "negy", "posz", "negz"],
        ["right", "left", "top", "bottom", "front", "back"],
    ];
    for (at, names) in sets.iter().enumerate() {
        let below = folder.path(&format!("sky{at}"));
        fs::create_dir(&below).expect("created");
        for (face, name) in faces.iter().zip(names) {
            fs::write(below.join(format!("Day_{name}.png")), png(face, png::BitDepth::Sixteen, false))
                .expect("written");
        }
        // What is no face does not disturb.
        fs::write(below.join("preview.png"), "a preview").expect("written");
        let paths = [below.clone(), below.join("Day_*.png")];
        for path in &paths {
            let found = Loaded::read(path).unwrap_or_else(|error| panic!("{error}"));
            let told = format!("{SIDE} × {SIDE}, a cubemap in six files, PNG of 16 bits, decoded from sRGB");
            assert_eq!(found.to_string(), told);
            let error = distance(&found.map.project(ORDER));
            assert!(error < SAMPLED, "{names:?}: {error}");
            assert_eq!(Projection::read(path, ORDER).expect("a map").0, found.map.project(ORDER));
        }
        let files: Vec<(String, Vec<u8>)> = faces
            .iter()
            .zip(names)
            .rev()
            .map(|(face, name)| (format!("{name}.exr"), exr(face, ["R", "G", "B"])))
            .collect();
        let dropped = Loaded::from_files(&files).unwrap_or_else(|error| panic!("{error}"));
        assert!(distance(&dropped.map.project(ORDER)) < SAMPLED);
        let few = Loaded::from_files(&files[1..]).expect_err("one is missing").to_string();
        assert!(
            few.contains("hold only 5 faces of a cube") && few.contains(&format!("{} is missing", names[5])),
            "{few}"
        );
    }
    let refused = |path: &Path| Loaded::read(path).expect_err("it is refused").to_string();
    let empty = folder.path("empty");
    fs::create_dir(&empty).expect("created");
    assert!(refused(&empty).contains("hold no face of a cube by their names; name the six files by their faces"));
    let text = refused(&folder.path("sky0/Night_*.png"));
    assert!(text.contains("names no six files: there is no ") && text.contains("Night_px.png"), "{text}");
    let first = folder.path("sky0");
    fs::write(first.join("Day_px.exr"), exr(&faces[0], ["R", "G", "B"])).expect("written");
    assert!(refused(&first).contains("hold the face +x twice"), "{}", refused(&first));
    fs::remove_file(first.join("Day_px.exr")).expect("removed");
    let small = self::faces(32);
    fs::write(first.join("Day_ny.png"), png(&small[3], png::BitDepth::Eight, false)).expect("written");
    let text = refused(&first);
    assert!(text.contains("Day_ny.png: is 32×32 texels, and the face before it 64×64"), "{text}");
    let (_, wide) = layouts().swap_remove(0);
    fs::write(first.join("Day_ny.png"), png(&wide, png::BitDepth::Eight, false)).expect("written");
    assert!(refused(&first).contains("a face of a cube is square"), "{}", refused(&first));
    let mut dark = small[3].clone();
    dark.texels[5] = [-1.0, 0.0, 0.0];
    let files: Vec<(String, Vec<u8>)> = sets[0]
        .iter()
        .enumerate()
        .map(|(i, name)| (format!("{name}.exr"), exr(if i == 3 { &dark } else { &small[i] }, ["R", "G", "B"])))
        .collect();
    let text = Loaded::from_files(&files).expect_err("it is refused").to_string();
    assert!(
        text.contains("face -y: 1 of its texels hold negative radiance, down to -1, the first at column 5, row 0"),
        "{text}"
    );
}

#[test]
fn what_is_no_map_is_refused_with_a_hint_that_helps() {
    let faces = faces(8);
    let text = message(&png(&faces[0], png::BitDepth::Eight, false));
    assert!(
        text.contains("is 8×8 texels, the size of no map") && text.contains("name the folder that holds them all"),
        "{text}"
    );
    let narrow = Image { width: 10, texels: vec![[0.5; 3]; 30] };
    let text = message(&png(&narrow, png::BitDepth::Eight, false));
    assert!(text.contains("convert it to latitude and longitude"), "{text}");
    let text = message(b"\xff\xd8\xff\xe0\0\x10JFIF");
    assert!(text.contains("holds a Jpeg image") && text.contains("nothing brighter than white"), "{text}");
    let text = message(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 16384\n");
    assert!(
        text.contains("16384×8192 texels, above the limit of 8192 columns") && text.contains("reduce it"),
        "{text}"
    );
    let text = message(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4096 +X 24576\n");
    assert!(text.contains("above the limit of 2048 for a face's side"), "{text}");
    let text = message(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 8 +X 16\n");
    assert!(text.contains("XYZ colours") && text.contains("ra_xyze"), "{text}");
    for line in ["Y 8 X 16", "-Y 8 +Y 16", "-Y 8", "*Y 8 +X 16", "-Y -8 +X 16"] {
        let text = message(format!("#?RADIANCE\n\n{line}\n").as_bytes());
        assert!(text.contains("its size is no `-Y HEIGHT +X WIDTH` or the like"), "{text}");
    }
    let whole = png(&layouts()[0].1, png::BitDepth::Eight, false);
    for length in [9, 30, 40, 100, whole.len() / 2] {
        assert!(message(&whole[..length]).contains("cannot be decoded"), "{length}: {}", message(&whole[..length]));
    }
}
