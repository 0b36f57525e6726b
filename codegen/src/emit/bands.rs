//! Text that reads the bands of a light from cubemaps: for the signal-tailored rotation, for shading by isotropic
//! decomposition (docs/MATH.md#band-tables), and for mirrors (docs/MATH.md#antialiased-reflections). It knows which directions both take, and nothing of the tables' sizes, which the
//! text asks the textures for.

use crate::emit::language::{Target, shader};
use crate::emit::{docs, plain};
// Names a family: its lobes are where tables are read.
use crate::families::isd::directions::shared;
use crate::families::zhf::lobes::shared_free;
use crate::math::exact::Exact;
use serde::Serialize;
use tera::Context;

/// How many directions text is made for at most: what few textures and compilers take.
pub const MAX_ORDER: usize = 16;

/// What the head says of the tables.
const WHAT: &str = "Reads of the bands of a light, each a cubemap with linear filtering and no levels, in the cube's frame of OpenGL and Direct3D: faces +x, -x, +y, -y, +z, -z, y up. Directions are those of the coefficients: z up.";
/// The matrix of a quaternion.
const MATRIX: usize = 17;
/// A direction turned by a matrix.
const TURNED: usize = 9;
/// The largest component of a direction alone: two maxima, three comparisons that select.
const MAJOR: usize = 8;
/// A direction drawn out for the faces of a size.
const OUTWARD: usize = 3;

/// Returns the operations from the quaternion of a frame to the reads of an order's bands at its directions, n² of them.
pub fn set_up(order: usize) -> usize {
    MATRIX + (2 * order - 1) * (TURNED + MAJOR) + OUTWARD * order * order
}

/// Returns the operations of shading by isotropic decomposition from tables, from the quaternion of the frame and the weights on:
/// of weights and values a multiply-add a channel, of each band's sum one more.
pub fn shaded(order: usize, channels: usize) -> usize {
    set_up(order) + channels * (order * order + order)
}

/// What text is made of.
#[derive(Clone, Copy, Debug)]
pub struct Reads<'a> {
    /// How many bands there are, each a texture.
    pub order: usize,
    /// What its names begin with: a name itself.
    pub name: &'a str,
    /// The bind group of the sampler, binding 0, and the textures, from binding 1 on, where the language has groups.
    pub group: usize,
    /// What the head says it was made from.
    pub origin: &'a str,
}

/// A band's texture.
#[derive(Serialize)]
struct Band {
    band: usize,
    binding: usize,
    /// 1/√(2l + 1), which brings a Gaussian's zonal coefficient to a factor of the band.
    root: String,
}

/// A read of a table.
#[derive(Serialize)]
struct Read {
    band: usize,
    direction: usize,
    weight: usize,
    comma: &'static str,
}

/// The reads of a band and their common factor.
#[derive(Serialize)]
struct Sum {
    band: usize,
    factor: String,
    terms: Vec<Read>,
}

fn vector(of: &[Exact; 3]) -> String {
    of.each_ref().map(shader::literal).join(", ")
}

impl Reads<'_> {
    /// Returns the text in a language; none for one that has no textures, or for more than [`MAX_ORDER`] bands. The signal-tailored
    /// rotation is part of it where there are lobes, to order 10; shading where directions are kept, from order 3 on.
    pub fn text(&self, target: Target) -> Option<String> {
        let (_, template) = zonal_templates::BANDS.iter().find(|(language, _)| *language == target.name)?;
        let order = self.order;
        if !(1..=MAX_ORDER).contains(&order) {
            return None;
        }
        let mut context = Context::new();
        let mut head = plain::head(self.origin);
        head.extend(docs::wrap(WHAT, 0));
        context.insert("head", &head);
        context.insert("guard", &format!("ZONAL_{}_BANDS_GLSL", self.name.to_uppercase()));
        context.insert("name", self.name);
        context.insert("group", &self.group);
        context.insert("order", &order);
        context.insert("size", &(order * order));
        let band =
            |band: usize| Band { band, binding: band + 1, root: shader::literal(&Exact::sqrt_ratio(1, 2 * band + 1)) };
        context.insert("bands", &(0..order).map(band).collect::<Vec<_>>());
        let comma = |place: usize| if place + 1 < order * order { "," } else { "" };
        if let Some(set) = (order > 1).then(|| shared_free(order)).flatten() {
            let lobes: Vec<String> = set.directions.iter().map(|lobe| vector(&lobe.xyz())).collect();
            let of_band = |band: usize| {
                let read = move |(i, &direction): (usize, &usize)| {
                    let weight = band * band + i;
                    Read { band, direction, weight, comma: comma(weight) }
                };
                set.subsets[band].iter().enumerate().map(read).collect::<Vec<_>>()
            };
            context.insert("lobes", &lobes);
            context.insert("samples", &(0..order).flat_map(of_band).collect::<Vec<_>>());
        } else {
            context.insert("lobes", &Vec::<String>::new());
        }
        if let Some(set) = shared(order) {
            let directions: Vec<String> = set.directions.iter().map(vector).collect();
            let of_band = |band: usize| {
                let factor = Exact::sqrt_ratio(4, 2 * band as i64 + 1) * Exact::pi_sqrt_power(1);
                let read = |i: usize| Read { band, direction: i, weight: band * band + i, comma: "" };
                Sum { band, factor: shader::literal(&factor), terms: (0..2 * band + 1).map(read).collect() }
            };
            context.insert("directions", &directions);
            context.insert("sums", &(0..order).map(of_band).collect::<Vec<_>>());
        } else {
            context.insert("directions", &Vec::<String>::new());
        }
        Some(plain::render(template, &context))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    // Names a language: these have textures.
    use crate::emit::language::{GLSL, RUST, WGSL};

    #[test]
    fn every_order_is_valid_where_there_are_textures() {
        for order in 1..=MAX_ORDER {
            let reads = Reads { order, name: "light", group: 1, origin: "a test" };
            let text = reads.text(&WGSL).expect("WGSL has textures");
            (WGSL.check)(&text).unwrap_or_else(|error| panic!("order {order}: {error}"));
            assert_eq!(text.contains("fn light_samples"), (2..=10).contains(&order), "order {order}");
            assert_eq!(text.contains("fn light_shade"), order >= 3, "order {order}");
            let glsl = reads.text(&GLSL).expect("GLSL has textures");
            // Naga's GLSL has textures and samplers apart.
            let mut apart = glsl.replace("(map, outward", "(samplerCube(map, all_sampler), outward");
            apart = apart.replace("textureSize(map, 0)", "textureSize(samplerCube(map, all_sampler), 0)");
            apart = apart.replace("ZONAL_HIGHP samplerCube map", "textureCube map");
            for band in (0..order).rev() {
                let declared = format!("uniform ZONAL_HIGHP samplerCube light_{band}_map;");
                let bound = format!("layout(set = 1, binding = {}) uniform textureCube light_{band}_map;", band + 1);
                assert!(apart.contains(&declared), "{apart}");
                apart = apart.replace(&declared, &bound);
            }
            apart = apart.replacen(
                "layout(set",
                "layout(set = 1, binding = 0) uniform sampler all_sampler;\nlayout(set",
                1,
            );
            (GLSL.check)(&apart).unwrap_or_else(|error| panic!("order {order}: {error}\n{apart}"));
        }
        assert_eq!(Reads { order: 3, name: "light", group: 1, origin: "a test" }.text(&RUST), None);
        assert_eq!(Reads { order: MAX_ORDER + 1, name: "light", group: 1, origin: "a test" }.text(&WGSL), None);
    }
}
