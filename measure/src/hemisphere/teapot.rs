//! Figure 6 and Table 1 of Gautron et al. 2004: a teapot under one light, its reflectance looked up as harmonics of the light
//! in a table over the view; and what a pixel costs under an environment map.

use super::bases::{Basis, HSH, SH};
use super::grid::{Node, hemisphere};
use super::turn::conversion;
use crate::papers::FRAMES;
use crate::raster::Raster;
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_picture::camera::{Camera, View};
use zonal_picture::mesh::Mesh;
use zonal_picture::vector::{across, add, cross, dot, unit};

/// The name of the picture.
pub const NAME: &str = "hemisphere_teapot.png";
/// The number of bands.
pub const ORDER: usize = 7;
/// The texels along a side of the tables.
pub const SIZES: [usize; 3] = [16, 32, 64];
/// The side of the paper's table.
pub const SIDE: usize = 32;
/// How far below nothing a pixel is counted as seen, relative to one that two per cent are brighter than.
pub const DARK: f64 = 0.02;
const TILE: [usize; 2] = [256, 176];
const CAMERA: Camera = Camera { azimuth: -90.0, elevation: 25.0, distance: 4.0, field: 20.0 };
const LIGHT: [f64; 3] = [-1.5, -2.5, 2.5];
/// Rings of the nodes that a view's coefficients are integrated with.
const RINGS: usize = 40;
/// Every so many-th pixel is computed without a table.
const SAMPLED: usize = 16;

/// The reflectances by their names.
pub fn reflectances() -> [Brdf; 2] {
    [Brdf::Phong { exponent: 20.0 }, Brdf::Ward { alpha: [0.2, 0.5] }]
}

/// What pictures of one reflectance err by; all relative to the root mean square of the analytic picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Teapot {
    /// The reflectance.
    pub reflectance: String,
    /// The lit pixels.
    pub pixels: usize,
    /// The root mean square of the error in HSH and in SH.
    pub errors: [f64; 2],
    /// The share of lit pixels that are negative in HSH and in SH.
    pub negative: [f64; 2],
    /// The share of lit pixels below minus [`DARK`] of the bright ones, in HSH and in SH.
    pub dark: [f64; 2],
    /// The root mean square of the error in HSH and in SH if the coefficients are those of the product with the cosine.
    pub premultiplied: [f64; 2],
    /// For each of [`SIZES`] the root mean square that the table in HSH adds, against coefficients at the very view.
    pub tables: Vec<f64>,
}

/// What a pixel costs under an environment map at an order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pixel {
    /// The order.
    pub order: usize,
    /// Operations to rotate the light, to take it to the hemisphere and to sum, for light of one channel.
    pub steps: [usize; 3],
    /// The same for light of three channels.
    pub steps_rgb: [usize; 3],
    /// Bytes of the reflectance's coefficients in f32.
    pub bytes: usize,
}

/// A lit pixel: its place, the directions to the eye and to the light in the frame of the surface, and the light's share
/// there.
struct Lit {
    place: [usize; 2],
    view: [f64; 3],
    light: [f64; 3],
    share: f64,
}

/// What is seen at a place of the picture.
#[derive(Clone, Copy)]
struct Seen {
    depth: f64,
    position: [f64; 3],
    normal: [f64; 3],
}

/// What of a mesh is seen through each pixel.
fn seen(mesh: &Mesh) -> Vec<Option<Seen>> {
    let [width, height] = TILE;
    let matrix = CAMERA.matrix(width as f64 / height as f64);
    let mut buffer: Vec<Option<Seen>> = vec![None; width * height];
    let corner = |i: u32| {
        let [position, normal] = [&mesh.positions, &mesh.normals].map(|list| list[i as usize].map(f64::from));
        let clip: [f64; 4] =
            std::array::from_fn(|row| (0..3).map(|k| matrix[k][row] * position[k]).sum::<f64>() + matrix[3][row]);
        let x = (clip[0] / clip[3] + 1.0) * 0.5 * width as f64;
        let y = (1.0 - clip[1] / clip[3]) * 0.5 * height as f64;
        ([x, y], Seen { depth: clip[2] / clip[3], position, normal })
    };
    for triangle in mesh.indices.chunks_exact(3) {
        let corners = [corner(triangle[0]), corner(triangle[1]), corner(triangle[2])];
        let [a, b, c] = corners.map(|(place, _)| place);
        let edge =
            |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let area = edge(a, b, c);
        if area == 0.0 {
            continue;
        }
        let range = |axis: usize, most: usize| {
            let all = [a[axis], b[axis], c[axis]];
            let least = all.into_iter().fold(f64::INFINITY, f64::min).floor().max(0.0) as usize;
            least..((all.into_iter().fold(0.0, f64::max).ceil().max(0.0)) as usize).min(most)
        };
        for y in range(1, height) {
            for x in range(0, width) {
                let p = [x as f64 + 0.5, y as f64 + 0.5];
                let share = [edge(b, c, p), edge(c, a, p), edge(a, b, p)].map(|part| part / area);
                if share.iter().any(|part| *part < 0.0) {
                    continue;
                }
                let mix =
                    |of: &dyn Fn(&Seen) -> f64| share.iter().zip(&corners).map(|(s, (_, at))| s * of(at)).sum::<f64>();
                let depth = mix(&|at| at.depth);
                let pixel = &mut buffer[y * width + x];
                if pixel.is_none_or(|known| depth < known.depth) {
                    let [position, normal] = [0, 1].map(|which| {
                        [0, 1, 2].map(|k| mix(&|at| if which == 0 { at.position[k] } else { at.normal[k] }))
                    });
                    *pixel = Some(Seen { depth, position, normal });
                }
            }
        }
    }
    buffer
}

/// The lit pixels of the teapot, and the places of all: its tangents run around its axis, as a lathe leaves them. Nothing
/// throws shadows.
fn lit() -> (Vec<Lit>, Vec<[usize; 2]>) {
    let bytes = zonal_scenes::embedded("meshes/teapot.obj").expect("the project has a teapot");
    let mesh = Mesh::from_obj("teapot.obj", bytes).expect("the teapot can be read");
    let eye = CAMERA.eye();
    let buffer = seen(&mesh);
    let place = |i: usize| [i % TILE[0], i / TILE[0]];
    let pixel = |(i, seen): (usize, &Option<Seen>)| {
        let seen = (*seen)?;
        let normal = unit(seen.normal)?;
        let around = unit([-seen.position[1], seen.position[0], 0.0]).unwrap_or([1.0, 0.0, 0.0]);
        let tangent = across(around, normal);
        let frame = [tangent, cross(normal, tangent), normal];
        let local = |to: [f64; 3]| Some(frame.map(|axis| dot(axis, to)));
        let view = local(unit(add(eye, -1.0, seen.position))?)?;
        let light = local(unit(add(LIGHT, -1.0, seen.position))?)?;
        let share = light[2];
        (view[2] > 0.0 && share > 0.0).then_some(Lit { place: place(i), view, light, share })
    };
    let all = buffer.iter().enumerate().filter(|(_, seen)| seen.is_some()).map(|(i, _)| place(i)).collect();
    (buffer.iter().enumerate().filter_map(pixel).collect(), all)
}

/// Nodes with the functions of a basis there, times their weights.
struct Weighted<'a> {
    nodes: &'a [Node],
    values: Vec<Vec<f64>>,
}

impl<'a> Weighted<'a> {
    fn new(basis: &Basis, nodes: &'a [Node]) -> Self {
        let at = |(direction, weight): &Node| basis.at(ORDER, *direction).into_iter().map(|v| weight * v).collect();
        Self { nodes, values: nodes.iter().map(at).collect() }
    }

    /// The coefficients of a reflectance as a function of the light (equation 17), times the cosine or without it.
    fn coefficients(&self, brdf: &Brdf, cosine: bool, view: [f64; 3]) -> Vec<f64> {
        let mut sums = vec![0.0; ORDER * ORDER];
        for ((light, _), values) in self.nodes.iter().zip(&self.values) {
            let f = brdf.value(view, *light) / if cosine { 1.0 } else { light[2] };
            if f > 1e-12 {
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += f * value);
            }
        }
        sums
    }
}

/// Coefficients over the views by the paraboloid of Heidrich and Seidel 1999, (u, v) = (x, y) / (1 + z).
struct Table {
    side: usize,
    texels: Vec<Vec<f64>>,
}

impl Table {
    fn new(progress: &dyn Progress, weighted: &Weighted<'_>, (brdf, cosine): (&Brdf, bool), side: usize) -> Self {
        let texels: Vec<usize> = (0..side * side).collect();
        let at = |i: usize| 2.0 * (i as f64 + 0.5) / side as f64 - 1.0;
        let coefficients = |i: &usize| {
            let (u, v) = (at(i % side), at(i / side));
            let square = u * u + v * v;
            // Beyond the horizon stands what is seen at it.
            let view = match square >= 1.0 {
                true => [u / square.sqrt(), v / square.sqrt(), 0.0],
                false => [2.0 * u, 2.0 * v, 1.0 - square].map(|x| x / (1.0 + square)),
            };
            weighted.coefficients(brdf, cosine, view)
        };
        Self { side, texels: each(progress, "reflectance tables", &texels, coefficients) }
    }

    /// The coefficients for a view, interpolated from four texels.
    fn at(&self, view: [f64; 3]) -> Vec<f64> {
        let place = |x: f64| (x / (1.0 + view[2]) + 1.0) * 0.5 * self.side as f64 - 0.5;
        let ends = |x: f64| {
            let low = x.floor();
            let inside = |i: f64| i.clamp(0.0, (self.side - 1) as f64) as usize;
            [(inside(low), 1.0 - (x - low)), (inside(low + 1.0), x - low)]
        };
        let mut sums = vec![0.0; ORDER * ORDER];
        for (row, down) in ends(place(view[1])) {
            for (column, along) in ends(place(view[0])) {
                let texel = &self.texels[row * self.side + column];
                sums.iter_mut().zip(texel).for_each(|(sum, c)| *sum += down * along * c);
            }
        }
        sums
    }
}

/// Σ c_i B_i(light).
fn evaluated(basis: &Basis, coefficients: &[f64], lit: &Lit) -> f64 {
    let at = basis.at(ORDER, lit.light);
    coefficients.iter().zip(at).map(|(c, b)| c * b).sum()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), x| (sum + x * x, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// The figures and the picture: analytic, in HSH and in SH from left to right, a reflectance a row.
pub fn measure(progress: &dyn Progress) -> (Vec<Teapot>, Raster) {
    let (lit, all) = lit();
    let nodes = hemisphere(RINGS);
    let (hsh, sh) = (Weighted::new(&HSH, &nodes), Weighted::new(&SH, &nodes));
    let mut raster = Raster::new(NAME, [3 * TILE[0], 2 * TILE[1]]);
    let teapot = |(row, brdf): (usize, &Brdf)| {
        // The reflectance's product with the cosine is what the analytic picture shows.
        let analytic: Vec<f64> = lit.iter().map(|lit| brdf.value(lit.view, lit.light)).collect();
        let plain = (brdf, false);
        let by_size = SIZES.map(|side| Table::new(progress, &hsh, plain, side));
        let spherical = Table::new(progress, &sh, plain, SIDE);
        let of = |basis: &Basis, table: &Table| -> Vec<f64> {
            lit.iter().map(|lit| lit.share * evaluated(basis, &table.at(lit.view), lit)).collect()
        };
        let premultiplied = [(&HSH, &hsh), (&SH, &sh)].map(|(basis, weighted)| -> Vec<f64> {
            let table = Table::new(progress, weighted, (brdf, true), SIDE);
            lit.iter().map(|lit| evaluated(basis, &table.at(lit.view), lit)).collect()
        });
        let middle = SIZES.iter().position(|size| *size == SIDE).expect("it is one of them");
        let pictures = [of(&HSH, &by_size[middle]), of(&SH, &spherical)];
        let whole = rms(analytic.iter().copied());
        let error = |picture: &Vec<f64>| significant(rms(picture.iter().zip(&analytic).map(|(a, b)| a - b)) / whole);
        let mut sorted = analytic.clone();
        sorted.sort_by(f64::total_cmp);
        let white = sorted[sorted.len() * 98 / 100];
        let below = |picture: &Vec<f64>, limit: f64| {
            significant(picture.iter().filter(|value| **value < limit).count() as f64 / lit.len() as f64)
        };
        let sampled: Vec<&Lit> = lit.iter().step_by(SAMPLED).collect();
        let exact = each(progress, "reflectance without a table", &sampled, |lit| {
            evaluated(&HSH, &hsh.coefficients(brdf, false, lit.view), lit)
        });
        let table = |table: &Table| {
            let value = |lit: &Lit| evaluated(&HSH, &table.at(lit.view), lit);
            let off = sampled.iter().zip(&exact).map(|(lit, exact)| lit.share * (value(lit) - exact));
            significant(rms(off) / whole)
        };
        for (column, picture) in [&analytic, &pictures[0], &pictures[1]].into_iter().enumerate() {
            all.iter().for_each(|[x, y]| raster.set([column * TILE[0] + x, row * TILE[1] + y], [0.0; 3]));
            for (lit, value) in lit.iter().zip(picture) {
                let [x, y] = lit.place;
                raster
                    .set([column * TILE[0] + x, row * TILE[1] + y], [0.9, 0.75, 0.5].map(|tint| tint * value / white));
            }
        }
        Teapot {
            reflectance: brdf.to_string(),
            pixels: lit.len(),
            errors: pictures.each_ref().map(error),
            negative: pictures.each_ref().map(|picture| below(picture, 0.0)),
            dark: pictures.each_ref().map(|picture| below(picture, -DARK * white)),
            premultiplied: premultiplied.each_ref().map(error),
            tables: by_size.iter().map(table).collect(),
        }
    };
    let teapots = reflectances().iter().enumerate().map(teapot).collect();
    (teapots, raster)
}

/// The operations of a kernel for so many channels, if a spec names one.
fn operations(spec: &str, channels: usize) -> Option<usize> {
    Some(Listing::new(&spec.parse::<Spec>().ok()?.kernel()).cost(channels).total)
}

/// Table 1. What takes light to the hemisphere is a kernel where there is one, a multiply-add for each number of C else.
pub fn pixels() -> Vec<Pixel> {
    let pixel = |order: usize| {
        let c = conversion(order, order);
        let numbers = (0..c.rows()).flat_map(|i| c.row(i).to_vec()).filter(|x| x.abs() > 1e-12).count();
        let steps = |channels: usize| {
            // Names a family: the rotation that a pixel would take, and what makes hemispherical coefficients of it.
            let rotation = operations(&format!("rotate:{order}"), channels).expect("every order can be rotated");
            let conversion = operations(&format!("sh_to_hsh:{order}"), channels).unwrap_or(channels * numbers);
            [rotation, conversion, channels * order * order]
        };
        Pixel { order, steps: steps(1), steps_rgb: steps(3), bytes: 4 * order * order }
    };
    FRAMES.into_iter().map(|(order, _, _)| pixel(order)).collect()
}
