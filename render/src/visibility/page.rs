//! `docs/VISIBILITY.md` and its pictures: what shading with visibility costs and errs by, and under lights nearby.

use crate::canvas::{BRIGHT, Canvas, GROUND, MUTED, Text, over_ground};
use crate::figures::{Errors, percent};
use crate::frame::Frame;
use crate::tone;
use crate::visibility::lamps::{self, Adder};
use crate::visibility::multiplier::{Grid, Multiplier};
use crate::visibility::paper::Paper;
use crate::visibility::seen::{Convergence, KERNELS, Object, Place, Shader, convergence, mixed};
use rayon::prelude::*;
use std::fmt::Write;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::environment::{Map, Projection};
use zonal_codegen::families::Spec;
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::picture::Camera;
use zonal_picture::lights::Lights;
use zonal_picture::mesh::Mesh;
use zonal_picture::vector::dot;

/// How objects are looked at.
const CAMERA: Camera = Camera { azimuth: 30.0, elevation: 15.0, distance: 4.0, field: 24.0 };
/// What places are drawn from, of which few are to be off the object.
const NEARER: Camera = Camera { field: 21.0, ..CAMERA };
/// What they reflect: an exponent that the orders hold.
const BRDF: Brdf = Brdf::Phong { exponent: 10.0 };
/// The size of a picture.
pub const TILE: [usize; 2] = [200, 180];
/// The size at which errors are measured.
const MEASURED: [usize; 2] = [50, 45];
/// The orders of the pictures.
const SHOWN: [usize; 3] = [5, 9, 16];
/// The orders under lights nearby.
const LIT: [usize; 3] = [3, 5, 9];
/// The orders whose costs are told.
const COUNTED: [usize; 4] = [3, 4, 5, 6];
/// How many rays a vertex casts.
const RAYS: usize = 1024;
/// How many directions a place of the convergence casts.
const DENSE: usize = 8192;
/// Its places.
const PLACES: usize = 32;
/// Of how many of them one is looked at where two ways are compared.
const EACH: usize = 4;
/// How much of its hemisphere such a place sees at most.
const OPEN: f64 = 0.85;
/// How many lights brute force takes for the map.
const LIGHTS: usize = 1024;
/// The most bands.
const MOST: usize = 20;

/// What a pixel shows.
struct Pixel {
    /// By rays: of all lights, and of those that nothing hides.
    truth: [[f64; 3]; 2],
    /// At each order without and with visibility.
    found: Vec<[[f64; 3]; 2]>,
}

/// How far pictures of an object are from brute force with visibility.
pub struct Pictured {
    /// The object's name.
    pub name: String,
    /// At each order without and with visibility.
    pub errors: Vec<[Errors; 2]>,
    /// By rays without visibility.
    pub blind: Errors,
}

/// What shading with visibility costs at an order, in operations of R, G and B.
#[derive(Clone, Debug, PartialEq)]
pub struct Costs {
    /// The order.
    pub order: usize,
    /// The paper's three steps a pixel.
    pub paper: [usize; 3],
    /// `shade` a pixel.
    pub pixel: usize,
    /// `shade_isotropic` a pixel.
    pub isotropic: usize,
    /// The product a vertex.
    pub vertex: usize,
}

/// How far two ways are from the quadrature of what they integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equal {
    /// The order.
    pub order: usize,
    /// In f64 the paper's way and the product's, as shares of the root mean square.
    pub wide: [f64; 2],
    /// In f32.
    pub narrow: [f64; 2],
    /// Where the light has no more bands than the visibility, against the light's all.
    pub cut: f64,
}

/// All that is measured.
pub struct Report {
    /// The map's name, and that of the one with lights nearby.
    pub maps: [String; 2],
    /// Whether the ways are one.
    pub equal: Vec<Equal>,
    /// What they cost.
    pub costs: Vec<Costs>,
    /// How shading converges on the first object.
    pub convergence: Vec<Convergence>,
    /// The pictures.
    pub pictured: Vec<Pictured>,
    /// Under lights nearby: at each order those around the pixel, and around the object's middle.
    pub lit: Vec<[Errors; 2]>,
    /// What a light nearby costs at each order, and its roots and reciprocals.
    pub added: Vec<[usize; 2]>,
}

fn frame<T>(pixels: &[Option<T>], size: [usize; 2], of: impl Fn(&T) -> [f64; 3]) -> Frame {
    Frame { size, pixels: pixels.iter().map(|pixel| pixel.as_ref().map(&of)).collect(), milliseconds: 0.0 }
}

fn spec(text: &str) -> Result<Spec, Fault> {
    text.parse().map_err(|error| Fault::new(format!("`{text}`: {error}"), ""))
}

fn listing(text: &str) -> Result<Listing, Fault> {
    Ok(Listing::new(&spec(text)?.kernel()))
}

/// Places of the object's picture, spread over those from which something of the sky is hidden.
fn places(object: &Object) -> Vec<Place> {
    let all: Vec<Place> = object.places(&NEARER, [60, 54]).into_iter().flatten().collect();
    let all: Vec<Place> = all.into_par_iter().filter(|place| place.openness(object) <= OPEN).collect();
    let step = (all.len() / PLACES).max(1);
    all.into_iter().step_by(step).take(PLACES).collect()
}

/// The largest difference of lists of colours, over the root mean square of the second.
fn apart(found: &[[f64; 3]], wanted: &[[f64; 3]]) -> f64 {
    let size = (wanted.iter().map(|v| dot(*v, *v)).sum::<f64>() / wanted.len() as f64).sqrt();
    let differ = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    found.iter().zip(wanted).map(differ).fold(0.0, f64::max) / size
}

/// Each way at places in numbers of a kind: the paper's, and the product once a vertex, then one inner product.
fn ways<T: Number>(
    order: usize,
    light: &Projection,
    multiplier: &Multiplier,
    inputs: &[(Place, Vec<f64>, Vec<f64>)],
) -> Result<[Vec<[f64; 3]>; 2], Fault> {
    let bands = 2 * order - 1;
    let none = || Fault::new(format!("no directions are kept of order {order}"), "");
    let paper = Paper::<T>::new(multiplier).ok_or_else(none)?;
    let product = Program::<T>::new(&listing(&format!("product:{bands}+{order}:{order}"))?);
    let shade = Program::<T>::new(&listing(&format!("shade:{order}"))?);
    let round = |v: &[f64]| -> Vec<T> { v.iter().map(|&x| T::from_f64(x)).collect() };
    let e = [0, 1, 2].map(|k| round(&light.coefficients[..bands * bands].iter().map(|e| e[k]).collect::<Vec<_>>()));
    let mut found = [vec![], vec![]];
    for (place, c, v) in inputs {
        let (q, c, v) = (place.q.map(T::from_f64), round(c), round(v));
        found[0].push(paper.shade(q, &c, &v).map(T::to_f64));
        found[1].push([0, 1, 2].map(|k| {
            let seen = product.run(&[&e[k], &v], Contraction::Separate);
            shade.run(&[&q, &seen, &c], Contraction::Separate)[0].to_f64()
        }));
    }
    Ok(found)
}

fn equal(object: &Object, places: &[Place], light: &Projection, order: usize) -> Result<Equal, Fault> {
    let bands = 2 * order - 1;
    let inputs: Vec<(Place, Vec<f64>, Vec<f64>)> = places
        .iter()
        .step_by(EACH)
        .cloned()
        .map(|place| {
            let (c, v) = (BRDF.coefficients(place.view, order), place.visibility(object, order, 512));
            (place, c, v)
        })
        .collect();
    // The quadrature knows no product: the three functions in every direction, of the light more bands than matter.
    let grid = Grid::of_degree(2 * (order - 1) + 2 * bands);
    let (in_world, wide) = (grid.harmonics(order), grid.harmonics(bands + 2));
    let sum = |c: &[f64], y: &[f64]| c.iter().zip(y).map(|(c, y)| c * y).sum::<f64>();
    let e = [0, 1, 2].map(|k| light.coefficients.iter().map(|e| e[k]).collect::<Vec<f64>>());
    let truth = |(place, c, v): &(Place, Vec<f64>, Vec<f64>)| {
        let (mut total, mut own) = ([0.0; 3], vec![0.0; order * order]);
        for (at, direction) in grid.directions.iter().enumerate() {
            basis(order, place.axes.map(|axis| dot(axis, *direction)), &mut own);
            let factor = grid.weights[at] * sum(c, &own) * sum(v, &in_world[at]);
            (0..3).for_each(|k| total[k] += factor * sum(&e[k], &wide[at]));
        }
        total
    };
    let truth: Vec<[f64; 3]> = inputs.par_iter().map(truth).collect();
    let multiplier = Multiplier::new(light, order);
    let (wide, narrow) =
        (ways::<f64>(order, light, &multiplier, &inputs)?, ways::<f32>(order, light, &multiplier, &inputs)?);
    let own = Projection { order, coefficients: light.coefficients[..order * order].to_vec(), beyond: 0.0 };
    let cut = ways::<f64>(order, light, &Multiplier::new(&own, order), &inputs)?;
    Ok(Equal {
        order,
        wide: wide.map(|found| apart(&found, &truth)),
        narrow: narrow.map(|found| apart(&found, &truth)),
        cut: apart(&cut[0], &truth),
    })
}

fn costs(light: &Projection, order: usize) -> Result<Costs, Fault> {
    let none = || Fault::new(format!("no directions are kept of order {order}"), "");
    let paper = Paper::<f32>::new(&Multiplier::new(light, order)).ok_or_else(none)?;
    let bands = 2 * order - 1;
    let rgb = |name: &str| Ok::<usize, Fault>(listing(&format!("{name}:{order}:rgb"))?.cost(3).total);
    Ok(Costs {
        order,
        paper: paper.operations,
        pixel: rgb("shade")?,
        isotropic: rgb("shade_isotropic")?,
        vertex: 3 * listing(&format!("product:{bands}+{order}:{order}"))?.cost(1).total,
    })
}

fn pictured(
    object: &Object,
    size: [usize; 2],
    lights: &Lights,
    light: &Projection,
    multiplier: &Multiplier,
    shaders: &[Shader],
) -> Result<Vec<Option<Pixel>>, Fault> {
    let most = SHOWN.into_iter().max().unwrap_or(2);
    let places = object.places(&CAMERA, size);
    let visibility = object.visibility(&places, most, RAYS, 1)?;
    let of_order = |order: usize| -> Vec<Vec<[f64; 3]>> {
        visibility.par_iter().map(|v| multiplier.product(&v[..(order * order).min(v.len())])).collect()
    };
    let ways: Vec<(&Shader, Vec<Vec<[f64; 3]>>)> = shaders.iter().zip(SHOWN.map(of_order)).collect();
    let pixel = |place: &Option<Place>| {
        let place = place.as_ref()?;
        let found =
            ways.iter().map(|(shader, seen)| shader.shade(place, [&light.coefficients[..], &mixed(place, seen)]));
        Some(Pixel { truth: place.by_rays(object, &BRDF, &lights.0), found: found.collect() })
    };
    Ok(places.par_iter().map(pixel).collect())
}

/// What shades at the orders of the pictures.
fn shaders() -> Result<Vec<Shader>, Fault> {
    SHOWN.into_iter().map(|order| Shader::new(&BRDF, order)).collect()
}

/// What is shaded: the objects with their names, and a map for them and one for lights nearby, with theirs.
pub struct Subjects {
    /// The objects.
    pub objects: Vec<(String, Object)>,
    /// The maps.
    pub maps: [(String, Map); 2],
}

impl Subjects {
    /// Returns the subjects of meshes and maps.
    pub fn new(meshes: Vec<(String, Mesh)>, maps: [(String, Map); 2]) -> Self {
        Self { objects: meshes.into_iter().map(|(name, mesh)| (name, Object::new(mesh))).collect(), maps }
    }

    /// Measures all but the pictures.
    ///
    /// # Errors
    ///
    /// If a kernel is not known.
    pub fn measure(&self) -> Result<Report, Fault> {
        let [(name, map), (other, night)] = &self.maps;
        let light = map.project(2 * MOST - 1);
        let multiplier = Multiplier::new(&light, SHOWN[2]);
        let (_, first) = &self.objects[0];
        let (all, places) = (Lights::of(map), places(first));
        let (few, shaders) = (all.gathered(LIGHTS), shaders()?);
        let of_object = |(name, object): &(String, Object)| -> Result<Pictured, Fault> {
            let pixels = pictured(object, MEASURED, &few, &light, &multiplier, &shaders)?;
            let truth = frame(&pixels, MEASURED, |pixel| pixel.truth[1]);
            let errors = |of: &dyn Fn(&Pixel) -> [f64; 3]| Errors::of(&frame(&pixels, MEASURED, of), &truth);
            Ok(Pictured {
                name: name.clone(),
                errors: (0..SHOWN.len()).map(|i| [0, 1].map(|k| errors(&|pixel| pixel.found[i][k]))).collect(),
                blind: errors(&|pixel| pixel.truth[0]),
            })
        };
        let pixels = lamps::picture(first, &CAMERA, MEASURED, &BRDF, night, &LIT)?;
        let truth = frame(&pixels, MEASURED, |pixel| pixel.truth);
        let lit = |i: usize| [0, 1].map(|k| Errors::of(&frame(&pixels, MEASURED, |pixel| pixel.found[i][k]), &truth));
        let added = |order: usize| Adder::new(order).map(|adder| [adder.operations, adder.special]);
        Ok(Report {
            maps: [name.clone(), other.clone()],
            equal: [3, 5].into_iter().map(|order| equal(first, &places, &light, order)).collect::<Result<_, _>>()?,
            costs: COUNTED.into_iter().map(|order| costs(&light, order)).collect::<Result<_, _>>()?,
            convergence: convergence(first, &places, &BRDF, &all, &light, 2..=MOST, DENSE),
            pictured: self.objects.iter().map(of_object).collect::<Result<_, _>>()?,
            lit: (0..LIT.len()).map(lit).collect(),
            added: LIT.into_iter().map(added).collect::<Result<_, _>>()?,
        })
    }

    /// Draws the objects, as figure 7 does: by rays, then at each order, without visibility above and with it below.
    ///
    /// # Errors
    ///
    /// If a kernel is not known.
    pub fn visible(&self, samples: usize) -> Result<Canvas, Fault> {
        let map = &self.maps[0].1;
        let light = map.project(2 * SHOWN[2] - 1);
        let (multiplier, lights) = (Multiplier::new(&light, SHOWN[2]), Lights::of(map).gathered(LIGHTS));
        let (size, shaders) = (TILE.map(|side| side * samples), shaders()?);
        let mut rows = Vec::new();
        for (_, object) in &self.objects {
            let pixels = pictured(object, size, &lights, &light, &multiplier, &shaders)?;
            for which in [0, 1] {
                let mut row = vec![frame(&pixels, size, |pixel| pixel.truth[which])];
                row.extend((0..SHOWN.len()).map(|i| frame(&pixels, size, |pixel| pixel.found[i][which])));
                rows.push(row);
            }
        }
        let titles: Vec<String> =
            std::iter::once("by rays".to_owned()).chain(SHOWN.map(|order| format!("order {order}"))).collect();
        Ok(sheet(&titles, &rows, samples, |row| &rows[row | 1][0]))
    }

    /// Draws the first object under lights nearby: by brute force, at each order, and with the lights taken around its middle.
    ///
    /// # Errors
    ///
    /// If a kernel is not known.
    pub fn lit(&self, samples: usize) -> Result<Canvas, Fault> {
        let size = TILE.map(|side| side * samples);
        let pixels = lamps::picture(&self.objects[0].1, &CAMERA, size, &BRDF, &self.maps[1].1, &LIT)?;
        let mut row = vec![frame(&pixels, size, |pixel| pixel.truth)];
        row.extend((0..LIT.len()).map(|i| frame(&pixels, size, |pixel| pixel.found[i][0])));
        row.push(frame(&pixels, size, |pixel| pixel.found[LIT.len() - 1][1]));
        let mut titles = vec!["brute force".to_owned()];
        titles.extend(LIT.map(|order| format!("order {order}")));
        titles.push("as if far".to_owned());
        let rows = [row];
        Ok(sheet(&titles, &rows, samples, |_| &rows[0][0]))
    }
}

/// Pictures in rows, exposed for one of them.
fn sheet<'a>(
    titles: &[String],
    rows: &'a [Vec<Frame>],
    samples: usize,
    exposed: impl Fn(usize) -> &'a Frame,
) -> Canvas {
    const GAP: usize = 12;
    const LINE: usize = 28;
    let [width, height] = TILE;
    let size = [titles.len() * (width + GAP) + GAP, rows.len() * (height + GAP) + LINE + GAP];
    let mut canvas = Canvas::new(size, GROUND);
    for (column, title) in titles.iter().enumerate() {
        let colour = if column == 0 { BRIGHT } else { MUTED };
        canvas.write([GAP + column * (width + GAP), GAP - 4], title, Text::Title, colour);
    }
    for (row, frames) in rows.iter().enumerate() {
        let exposure = tone::exposure(exposed(row), 0.0);
        for (column, frame) in frames.iter().enumerate() {
            let place = [GAP + column * (width + GAP), GAP + LINE + row * (height + GAP)];
            canvas.put(place, &over_ground(frame, samples, exposure));
        }
    }
    canvas
}

impl Report {
    /// The page.
    pub fn markdown(&self) -> String {
        let [map, night] = &self.maps;
        let mut text = format!(
            "# Shading with visibility, measured\n\n\
             <!-- Generated: UPDATE=1 cargo test -p zonal-render --test it visibility -->\n\n\
             ![A bunny and a teapot by rays and at three orders, without visibility and with it](visibility.png)\n\n\
             After figure 7 of Soler et al. (2015): a bunny and a teapot under `{map}`, reflecting as `{BRDF}` does, by rays (the \
             first column) and at orders {}; above without visibility, below with it. What is seen of the sky lies in the \
             vertices, as `zonal bake MESH --basis visibility{}` writes it with {RAYS} rays a vertex, in the axes of the object; \
             it is multiplied with the light once a vertex, and what is made is interpolated over the triangles and shaded by \
             `shade` (beyond order {KERNELS} by quadrature, which is the same integral). Errors are shares of the mean radiance by rays with visibility.\n\n\
             | object | by rays, nothing hidden: rms |",
            SHOWN.map(|order| order.to_string()).join(", "),
            SHOWN[2]
        );
        for order in SHOWN {
            let _ = write!(text, " order {order}, without: rms | with: mean | rms |");
        }
        let _ = writeln!(text, "\n|---|---|{}", "---|".repeat(3 * SHOWN.len()));
        for Pictured { name, errors, blind } in &self.pictured {
            let _ = write!(text, "| {name} | {} |", percent(blind.rms));
            for [without, with] in errors {
                let _ = write!(text, " {} | {} | {} |", percent(without.rms), percent(with.mean), percent(with.rms));
            }
            text.push('\n');
        }
        self.write_ways(&mut text);
        self.write_convergence(&mut text);
        self.write_lit(&mut text, night);
        text
    }

    fn write_ways(&self, text: &mut String) {
        let _ = write!(
            text,
            "\n## Two ways to one integral\n\n\
             The paper's appendix A makes weights of the reflectance times the light a pixel, in three steps: the reflectance's \
             coefficients in the axes of the object, a matrix γ of n² by n² numbers, made from the map, of which all bands to \
             2n − 2 matter, and equation 22 with the visibility for the light. (As printed the first step has y(R_m⁻¹ R_n z) \
             where y(R_n⁻¹ z^m) is right, and the last is without R_n.) The other way multiplies light and visibility once a \
             vertex by `product:(2n−1)+n:n`; a pixel then takes what it takes without visibility. Both are the integral of the \
             three functions in their bands: the largest difference from its quadrature at {} places of the bunny, as a share of \
             the root mean square. The last column is what the paper's way errs by if γ is made from n bands of the light.\n\n\
             | order | γ, f64 | product, f64 | γ, f32 | product, f32 | γ of n bands |\n|---|---|---|---|---|---|\n",
            PLACES / EACH
        );
        for Equal { order, wide, narrow, cut } in &self.equal {
            // What rounds is told by its power of ten: it hangs on the last bits of every sum.
            let bound = |x: f64| if x < 1e-12 { "below 1e-12".to_owned() } else { format!("above 1e-12: {x:.0e}") };
            let narrow =
                narrow.map(|x| if x < 1e-6 { "below 1e-6".to_owned() } else { format!("above 1e-6: {x:.0e}") });
            let [a, b] = wide.map(bound);
            let _ = writeln!(text, "| {order} | {a} | {b} | {} | {} | {} |", narrow[0], narrow[1], percent(*cut));
        }
        text.push_str(
            "\nOperations for R, G and B of a light and a grey reflectance, and bytes of f32. A vertex is multiplied again where \
             the light or what is seen changes; where both stand still it keeps the product.\n\n\
             | order | γ, a pixel: the steps | all | `shade`, a pixel | `shade_isotropic` | product, a vertex | visibility, bytes a vertex | its product, bytes | γ, bytes |\n\
             |---|---|---|---|---|---|---|---|---|\n",
        );
        for Costs { order, paper, pixel, isotropic, vertex } in &self.costs {
            let (steps, all) = (paper.map(|step| step.to_string()).join(" + "), paper.iter().sum::<usize>());
            let count = order * order;
            let _ = writeln!(
                text,
                "| {order} | {steps} | {all} | {pixel} | {isotropic} | {vertex} | {} | {} | {} |",
                4 * count,
                12 * count,
                12 * count * count
            );
        }
    }

    fn write_convergence(&self, text: &mut String) {
        let _ = write!(
            text,
            "\n## Convergence\n\n\
             The bunny at {PLACES} places that see at most {} of their hemisphere, against brute force, all texels of the map that \
             nothing hides: the root mean square error relative to its root mean square. Visibility is that of the place itself, by \
             {DENSE} directions; no table is looked up. Without visibility nothing is gained by more bands.\n\n\
             | order | without visibility | with it |\n|---|---|---|\n",
            percent(OPEN)
        );
        for row in &self.convergence {
            let _ = writeln!(text, "| {} | {} | {} |", row.order, percent(row.without), percent(row.with));
        }
    }

    fn write_lit(&self, text: &mut String, night: &str) {
        let _ = write!(
            text,
            "\n## Lights nearby\n\n\
             ![The bunny under two spheres of light nearby](local_lights.png)\n\n\
             After the paper's figure 10: the bunny under `{night}` and two spheres that are as near as twice its radius. A \
             sphere's direction and size are those that the pixel sees; `light_sphere` adds it to the light of the map, and \
             `shade` takes the sum. By brute force and at orders {}, then the last of them with the spheres as they lie around the \
             object's middle, as light from afar is taken. Nothing is hidden. Errors as above, against brute force.\n\n\
             | order | a sphere, operations | special | as the pixel sees it: mean | rms | as the middle does: mean | rms |\n\
             |---|---|---|---|---|---|---|\n",
            LIT.map(|order| order.to_string()).join(", ")
        );
        for ((order, [near, far]), [operations, special]) in LIT.iter().zip(&self.lit).zip(&self.added) {
            let _ = writeln!(
                text,
                "| {order} | {operations} | {special} | {} | {} | {} | {} |",
                percent(near.mean),
                percent(near.rms),
                percent(far.mean),
                percent(far.rms)
            );
        }
    }
}
