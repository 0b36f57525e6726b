//! The ways to shade a point by its transfer: the light turned into the frame of the point by a kernel, or not turned at all.

use crate::field::tables::{Cube, band};
use crate::field::transfer::{Transfer, axes, world};
use zonal_codegen::families::Spec;
// Names a family: its lobes are where the light is read.
use zonal_codegen::families::zhf;
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::promise::samples::matrix_of;

/// How light gets to a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// By the quaternion of the shortest rotation.
    Quaternion,
    /// By its matrix.
    Matrix,
    /// By values of its bands in the lobes' directions, turned back.
    Samples,
    /// By the normal.
    Normal,
    /// Not at all: transfer is in the axes of the object.
    None,
}

/// A way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    /// What a table calls it.
    pub name: &'static str,
    /// The kernel's family, empty for none.
    pub family: &'static str,
    /// What it is given.
    pub turn: Turn,
}

/// All ways.
pub const WAYS: [Way; 5] = [
    Way { name: "rotate", family: "rotate", turn: Turn::Quaternion },
    Way { name: "zhf", family: "zhf", turn: Turn::Matrix },
    Way { name: "zhf_tailored", family: "zhf_tailored", turn: Turn::Samples },
    Way { name: "tilt", family: "tilt", turn: Turn::Normal },
    Way { name: "object", family: "", turn: Turn::None },
];

impl Way {
    /// Returns the spec of its kernel at an order, if it has one.
    pub fn text(&self, order: usize) -> Option<String> {
        (!self.family.is_empty()).then(|| format!("{}:{order}", self.family))
    }

    /// Returns the spec at an order, for R, G and B or for one channel, if a kernel turns anything.
    ///
    /// # Errors
    ///
    /// If there is no such kernel.
    pub fn spec(&self, order: usize, rgb: bool) -> Result<Option<Spec>, Fault> {
        let Some(text) = self.text(order) else { return Ok(None) };
        let text = format!("{text}{}", if rgb { ":rgb" } else { "" });
        text.parse().map(Some).map_err(|error| Fault::new(format!("`{text}`: {error}"), ""))
    }

    /// Whether it is exact but for rounding, if what it reads is.
    pub fn is_exact(&self) -> bool {
        // Names a family: of all that turns light here this one is for small angles.
        self.family != "tilt"
    }

    /// Returns the operations of a point for R, G and B, with the inner product, and the special ones: what turns the lobes'
    /// directions counts, what makes a quaternion or a matrix of the normal does not.
    ///
    /// # Errors
    ///
    /// If there is no such kernel.
    pub fn operations(&self, order: usize) -> Result<[usize; 2], Fault> {
        let cost = self.spec(order, true)?.map(|spec| Listing::new(&spec.kernel()).cost(3)).unwrap_or_default();
        let directions = if self.turn == Turn::Samples { 9 * zhf::lobes(order).directions.len() } else { 0 };
        Ok([cost.total + directions + 3 * order * order, cost.special])
    }
}

/// The unit quaternion that takes the world to the frame of a normal.
pub fn to_local([x, y, z]: [f64; 3]) -> [f64; 4] {
    let length = (x * x + y * y + (1.0 + z) * (1.0 + z)).sqrt();
    [y / length, -x / length, 0.0, (1.0 + z) / length]
}

/// Where the lobes of a band are, by the lobe's number.
pub struct Lobes {
    /// The directions.
    pub directions: Vec<[f64; 3]>,
    /// Those that a band uses, in their order.
    pub bands: Vec<Vec<usize>>,
}

impl Lobes {
    /// Returns those of an order.
    pub fn of(order: usize) -> Self {
        let set = zhf::lobes(order);
        let directions = set.directions.iter().map(|lobe| lobe.xyz().map(|x| x.to_f64())).collect();
        Self { directions, bands: set.subsets.clone() }
    }
}

/// A way at work in numbers of a kind.
pub struct Shader<'a, T> {
    way: Way,
    kernel: Option<Program<T>>,
    /// The light, a channel after the other.
    light: [Vec<T>; 3],
    e: &'a [[f64; 3]],
    lobes: Lobes,
    /// Cubes to read the light's bands from; without them they are summed.
    tables: Option<&'a [Cube]>,
}

impl<'a, T: Number> Shader<'a, T> {
    /// Returns a way under a light.
    ///
    /// # Errors
    ///
    /// If there is no kernel of the light's order.
    pub fn new(way: Way, e: &'a [[f64; 3]], tables: Option<&'a [Cube]>) -> Result<Self, Fault> {
        let order = e.len().isqrt();
        let kernel = way.spec(order, false)?.map(|spec| Program::new(&Listing::new(&spec.kernel())));
        let light = [0, 1, 2].map(|k| e.iter().map(|e| T::from_f64(e[k])).collect());
        Ok(Self { way, kernel, light, e, lobes: Lobes::of(order), tables })
    }

    /// Returns what a point of a normal sends to the view.
    pub fn shade(&self, normal: [f64; 3], transfer: &Transfer) -> [f64; 3] {
        let kept = if self.way.turn == Turn::None { &transfer.object } else { &transfer.local };
        let kept: Vec<T> = kept.iter().map(|&t| T::from_f64(t)).collect();
        let narrow = |v: &[f64]| -> Vec<T> { v.iter().map(|&x| T::from_f64(x)).collect() };
        let q = to_local(normal);
        let samples: Vec<[f64; 3]> = match self.way.turn {
            Turn::Samples => self.samples(normal),
            _ => vec![],
        };
        [0, 1, 2].map(|k| {
            let light = &self.light[k];
            let one: Vec<f64> = samples.iter().map(|f| f[k]).collect();
            let local = self.kernel.as_ref().map(|kernel| match self.way.turn {
                Turn::Quaternion => kernel.run(&[&narrow(&q), light], Contraction::Separate),
                Turn::Matrix => kernel.run(&[&narrow(&matrix_of(q)), light], Contraction::Separate),
                Turn::Normal => {
                    // The rotation back is the one to the normal that leans to the other side.
                    kernel.run(&[&narrow(&[-normal[0], -normal[1], normal[2]]), light], Contraction::Separate)
                }
                Turn::Samples | Turn::None => kernel.run(&[&narrow(&one)], Contraction::Separate),
            });
            let light = local.as_ref().unwrap_or(light);
            light.iter().zip(&kept).fold(T::ZERO, |sum, (&e, &t)| sum + e * t).to_f64()
        })
    }

    /// What the bands are at their lobes, turned back to the world.
    fn samples(&self, normal: [f64; 3]) -> Vec<[f64; 3]> {
        let axes = axes(normal);
        let back: Vec<[f64; 3]> = self.lobes.directions.iter().map(|&v| world(&axes, v)).collect();
        let of_band = |(l, members): (usize, &Vec<usize>)| {
            let read = |&at: &usize| match self.tables {
                Some(tables) => tables[l].read(back[at]),
                None => band(self.e, l, back[at]),
            };
            members.iter().map(read).collect::<Vec<_>>()
        };
        self.lobes.bands.iter().enumerate().flat_map(of_band).collect()
    }
}
