//! A map as the page needs it: its coefficients, the lights of the picture of all bands, a small picture of it, and figures
//! of its bands. It knows nothing of pages.

use rayon::prelude::*;
use serde_json::{Value, json};
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::environment::{Loaded, Map};
use zonal_codegen::promise::samples::Random;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_picture::lights::Lights;
use zonal_picture::shade::LIGHTS_A_ROW;
use zonal_picture::vector::{across, add, cross, length};

/// A file of the page: its path below the folder, with `/`, and its bytes.
pub type Asset = (String, Vec<u8>);

/// The order of the light and of the tables of the page; lower ones are their first bands.
pub const ORDER: usize = *ORDERS.end();
/// The bands whose energies the page shows.
pub const BANDS: usize = 32;
/// How many lights stand for a map: while a picture moves on a slow device, and when it rests.
const LIGHTS: [usize; 2] = [256, 4096];
/// From how many lights at most those are gathered: of a larger map blocks of texels.
const GATHERED_FROM: usize = 1 << 17;
/// The rows of the small picture of a map.
const SMALL: usize = 64;
/// How many surfaces tell how well the lights stand for the map.
const SURFACES: usize = 12;

/// A map and what it is called.
pub struct Lit {
    /// What it is called in addresses and files: a word of ASCII letters, digits and hyphens.
    pub id: String,
    /// What people read.
    pub label: String,
    /// The map.
    pub loaded: Loaded,
}

/// The row of a map in the page's index, and its file: coefficients of R, G and B; the lights, eight numbers each, few and
/// then many, each filled up to whole rows of a texture; the small picture, four bytes a texel. `brdfs` are those that the
/// page has.
pub fn prepared(lit: &Lit, brdfs: &[Brdf]) -> (Value, Asset) {
    let map = &lit.loaded.map;
    let deep = map.project(BANDS);
    let mut bytes = floats(deep.coefficients[..ORDER * ORDER].iter().flatten().map(|value| *value as f32));
    let all = Lights::at_most(map, GATHERED_FROM);
    let sets = LIGHTS.map(|count| all.gathered(count));
    let mut rows = Vec::new();
    for set in &sets {
        let light = |light: &zonal_picture::lights::Light| {
            let ([x, y, z], [r, g, b]) = (light.direction, light.power);
            [x, y, z, 0.0, r, g, b, 0.0].map(|value| value as f32)
        };
        let mut numbers: Vec<f32> = set.0.iter().flat_map(light).collect();
        numbers.resize(set.0.len().next_multiple_of(LIGHTS_A_ROW) * 8, 0.0);
        rows.push(numbers.len() / 8 / LIGHTS_A_ROW);
        bytes.extend(floats(numbers));
    }
    let small = small(map);
    bytes.extend(small.texels.iter().flat_map(|texel| shared_exponent(*texel).to_le_bytes()));
    let file = format!("data/light-{}.bin", lit.id);
    let energy = deep.energy();
    let row = json!({
        "id": lit.id,
        "label": lit.label,
        "told": lit.loaded.to_string(),
        "width": small.width,
        "height": small.height,
        "file": file,
        "lights": sets.each_ref().map(|set| set.0.len()),
        "rows": rows,
        "texels": map.texels.len(),
        "apart": brdfs.iter().map(|brdf| apart(&sets[1], &all, brdf)).collect::<Vec<_>>(),
        "energy": deep.band_energy(),
        "shares": deep.band_energy().iter().map(|band| band / energy).collect::<Vec<_>>(),
        "beyond": deep.beyond / energy,
    });
    (row, (file, bytes))
}

/// What gathered lights err by against all, in the mean over surfaces that lie anyhow, in shares of the mean radiance.
fn apart(few: &Lights, all: &Lights, brdf: &Brdf) -> f64 {
    let mut random = Random::new(1);
    let surfaces: Vec<_> = (0..SURFACES)
        .map(|_| {
            let z = random.unit::<3>();
            let x = across(random.unit(), z);
            let [a, b, c] = random.unit::<3>();
            ([x, cross(z, x), z], [a, b, c.abs()])
        })
        .collect();
    let both: Vec<[f64; 2]> = surfaces
        .into_par_iter()
        .map(|(axes, view)| {
            let (found, wanted) = (few.radiance(brdf, axes, view), all.radiance(brdf, axes, view));
            [length(add(found, -1.0, wanted)), length(wanted)]
        })
        .collect();
    let sum = |i: usize| both.iter().map(|pair| pair[i]).sum::<f64>();
    if sum(1) > 0.0 { sum(0) / sum(1) } else { 0.0 }
}

/// The norm of each band of a reflectance, as a root mean square over the views that a sphere shows, seen from afar.
pub fn norms(brdf: &Brdf) -> Vec<f64> {
    const VIEWS: usize = 16;
    let view = |i: usize| {
        // As many pixels for each step of the squared sine.
        let square = (i as f64 + 0.5) / VIEWS as f64;
        brdf.coefficients([square.sqrt(), 0.0, (1.0 - square).sqrt()], BANDS)
    };
    let views: Vec<Vec<f64>> = (0..VIEWS).into_par_iter().map(view).collect();
    let square = |values: &[f64], l: usize| values[l * l..(l + 1) * (l + 1)].iter().map(|v| v * v).sum::<f64>();
    let mean = |l: usize| views.iter().map(|values| square(values, l)).sum::<f64>() / VIEWS as f64;
    (0..BANDS).map(|l| mean(l).sqrt()).collect()
}

/// Numbers as the page reads them.
pub fn floats(values: impl IntoIterator<Item = f32>) -> Vec<u8> {
    values.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// A small latitude-longitude picture of a map under a small binomial filter.
fn small(map: &Map) -> Map {
    // Blocks of texels are averaged first, so that the filter is of the same width for every map.
    let map = averaged(&map.unrolled(2 * SMALL));
    blurred(&map)
}

/// A latitude-longitude map of twice the rows of the small picture, or of fewer if the map has no more.
fn averaged(map: &Map) -> Map {
    let height = map.height.min(2 * SMALL);
    let width = 2 * height;
    let texel = |i: usize| {
        let part = |at: usize, of: usize, all: usize| (at * all / of, ((at + 1) * all).div_ceil(of));
        let ((left, right), (top, bottom)) = (part(i % width, width, map.width), part(i / width, height, map.height));
        let mut sum = [0.0; 3];
        for y in top..bottom {
            for x in left..right {
                (0..3).for_each(|k| sum[k] += map.texels[y * map.width + x][k]);
            }
        }
        sum.map(|value| value / ((right - left) * (bottom - top)) as f64)
    };
    Map { width, height, texels: (0..width * height).into_par_iter().map(texel).collect() }
}

/// The map at half its size under a small binomial filter.
fn blurred(map: &Map) -> Map {
    const WEIGHTS: [f64; 6] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    let height = (map.height / 2).max(1);
    let width = 2 * height;
    let texel = |x: usize, y: usize| {
        let mut sum = [0.0; 3];
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            let column = (2 * x + 2 * map.width + i - 2) % map.width;
            let row = (2 * y + j).saturating_sub(2).min(map.height - 1);
            let weight = WEIGHTS[i] * WEIGHTS[j] / 1024.0;
            let texel = map.texels[row * map.width + column];
            (0..3).for_each(|k| sum[k] += weight * texel[k]);
        }
        sum
    };
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
    Map { width, height, texels }
}

/// A colour in the format RGB9E5 of the texture units: three mantissas of nine bits and one exponent (OpenGL ES 3.0,
/// section 3.8.3).
fn shared_exponent(texel: [f64; 3]) -> u32 {
    const MOST: f64 = 65408.0;
    let texel = texel.map(|value| value.clamp(0.0, MOST));
    let most = texel.iter().copied().fold(0.0, f64::max);
    let first = if most > 0.0 { (most.log2().floor() as i32).max(-16) + 1 } else { -15 };
    let step = |exponent: i32| f64::from(exponent - 9).exp2();
    // The largest may round up to 512.
    let exponent = if (most / step(first)).round() > 511.0 { first + 1 } else { first };
    let [r, g, b] = texel.map(|value| (value / step(exponent)).round() as u32);
    r | g << 9 | b << 18 | ((exponent + 15) as u32) << 27
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_exponent_keeps_eight_bits_of_the_largest() {
        let back = |bits: u32| {
            let scale = f64::from((bits >> 27) as i32 - 15 - 9).exp2();
            [0, 9, 18].map(|shift| f64::from(bits >> shift & 511) * scale)
        };
        for texel in
            [[0.0; 3], [1.0, 0.5, 0.25], [511.9, 3.0, 0.1], [1e-6, 2e-6, 0.0], [7e4, 1.0, 0.0], [0.3, 0.9999, 0.2]]
        {
            let most = texel.iter().copied().fold(0.0, f64::max);
            for (got, want) in back(shared_exponent(texel)).into_iter().zip(texel) {
                // Half a step: of the smallest exponent, or of a largest mantissa from 255.5, rounded up, to 511.
                let tolerance = (most / 255.5 / 2.0).max(1.0 / f64::from(1 << 25));
                assert!((got - want.min(65408.0)).abs() <= tolerance, "{texel:?}: {got}");
            }
        }
    }

    #[test]
    fn a_map_of_any_size_has_a_small_picture_of_its_radiance() {
        let cube = |side: usize| [side, 6 * side];
        for [width, height] in [[2, 1], [6, 3], [256, 128], [1000, 500], cube(1), cube(40)] {
            let map = Map { width, height, texels: vec![[1.0, 2.0, 3.0]; width * height] };
            let small = small(&map);
            assert!(small.width == 2 * small.height && small.height <= SMALL, "{width}: {}", small.width);
            for texel in &small.texels {
                assert!((0..3).all(|k| (texel[k] / (k + 1) as f64 - 1.0).abs() < 1e-12), "{width}: {texel:?}");
            }
        }
    }

    #[test]
    fn norms_are_those_of_bands_that_no_view_changes() {
        let found = norms(&Brdf::Lambert);
        let wanted = Brdf::Lambert.coefficients([0.0, 0.0, 1.0], BANDS);
        assert!((0..BANDS).all(|l| (found[l] - wanted[l * (l + 1)].abs()).abs() < 1e-12));
    }
}
