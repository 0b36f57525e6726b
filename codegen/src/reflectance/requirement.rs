//! What a scene requires of its harmonics besides its order, and nothing more: from its map, its reflectance and the error
//! that its order leaves room for, the bands, the symmetries, the channels and the precision that are enough, and what
//! leaving out the rest saves.
//!
//! Reflected light is Σ_i b_i(view) (D(R) L)_i. For a frame R that may be any, band l of it has the energy
//! |b_l|² |L_l|² / (2l + 1), which falls with l much faster than the light's own where the reflectance is smooth; that is
//! what decides. Each thing that is left out adds its squared error, and is left out while the sum keeps the budget
//! (docs/MATH.md#the-order-that-a-budget-asks-for). These errors are integrals over all frames and need no samples; that of
//! f16 is measured.

use crate::environment::project::Projection;
use crate::families::Spec;
use crate::families::family::MAX_HALF_ORDER;
use crate::ir::eval::{Contraction, Number, Program};
use crate::ir::listing::Listing;
use crate::math::half::Half;
use crate::math::index::band_degree;
use crate::promise::samples::Random;
use crate::reflectance::brdf::{Brdf, Table};
use crate::reflectance::seen::views;
use serde::Serialize;

/// How many frames each view is measured in.
const FRAMES: usize = 100;
/// A share of the energy below this is nothing: f64's rounding.
const NOTHING: f64 = 1e-20;

/// What an order leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room<'a> {
    /// The order.
    pub order: usize,
    /// The most bands that could be afforded.
    pub max_order: usize,
    /// The relative rms error that everything left out may cost together.
    pub budget: f64,
    /// The relative rms error of the order alone.
    pub error: f64,
    /// How much of each band of the light is seen, for `max_order` bands at least.
    pub weights: &'a [f64],
    /// The energy of what is seen that errors are relative to.
    pub energy: f64,
}

/// Something of the light that may be left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Left {
    /// What happens, in words.
    pub what: String,
    /// The relative rms error that it costs by itself.
    pub error: f64,
}

/// What is needed, and what it costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Requirement {
    /// The reflectance.
    pub brdf: String,
    /// How many bands are enough.
    pub order: usize,
    /// Those of them that hold anything.
    pub bands: Vec<usize>,
    /// 1 if the light may be grey, else 3.
    pub channels: usize,
    /// Whether the light may be the same all around z.
    pub zonal: bool,
    /// Whether the light may be its own mirror image at the plane of x and z.
    pub mirror: bool,
    /// Whether turning view and frame about the normal changes nothing: a table of one azimuth, without the terms of
    /// negative degree.
    pub isotropic: bool,
    /// Whether f16 is enough.
    pub half: bool,
    /// What may be left out of the light besides bands, in this order.
    pub left: Vec<Left>,
    /// The relative rms error of the order and all of that together.
    pub error: f64,
    /// Operations a pixel, of a rotation and the product with the light: what is needed, and all.
    pub operations: [usize; 2],
    /// Bytes of the light's coefficients and of the reflectance's table: what is needed, and all.
    pub bytes: [usize; 2],
}

/// The share of what is seen that a change of the light takes away.
fn share(light: &[[f64; 3]], room: &Room, changed: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> f64 {
    let mut lost = 0.0;
    for (i, &own) in light.iter().enumerate() {
        let other = changed(i, own);
        let square: f64 = (0..3).map(|c| (own[c] - other[c]).powi(2)).sum();
        lost += room.weights[band_degree(i).0] * square;
    }
    lost / room.energy
}

fn grey(_: usize, [r, g, b]: [f64; 3]) -> [f64; 3] {
    [(r + g + b) / 3.0; 3]
}

/// Keeps what `keep` says of a degree.
fn only(keep: fn(isize) -> bool) -> impl Fn(usize, [f64; 3]) -> [f64; 3] {
    move |i, value| if keep(band_degree(i).1) { value } else { [0.0; 3] }
}

fn is_zonal(m: isize) -> bool {
    m == 0
}

fn is_even(m: isize) -> bool {
    m >= 0
}

impl Requirement {
    /// What a light seen by `brdf` requires in the bands below an order; `half` says whether f16 may be taken, and `empty`
    /// which bands hold nothing.
    ///
    /// # Panics
    ///
    /// If the orders are not ones of a kernel's, or the light or the weights have fewer bands.
    pub fn new(light: &Projection, brdf: &Brdf, room: &Room, empty: &[usize], half: bool) -> Self {
        let kept = &light.coefficients[..room.order * room.order];
        let mut requirement = Self {
            brdf: brdf.to_string(),
            order: room.order,
            bands: (0..room.order).filter(|l| !empty.contains(l)).collect(),
            channels: 3,
            zonal: false,
            mirror: false,
            isotropic: brdf.is_isotropic(),
            half: false,
            left: vec![],
            error: room.error,
            operations: [0, 0],
            bytes: [0, 0],
        };
        requirement.zonal =
            requirement.takes("it is made the same all around the vertical", share(kept, room, only(is_zonal)), room);
        requirement.mirror = requirement.zonal
            || requirement.takes(
                "its two sides, left and right of the map's centre, are made alike",
                share(kept, room, only(is_even)),
                room,
            );
        if requirement.takes(
            "its light is made grey: one channel is stored instead of three",
            share(kept, room, grey),
            room,
        ) {
            requirement.channels = 1;
        }
        if half && room.order <= MAX_HALF_ORDER && room.error < room.budget {
            let rounding = requirement.rounding(kept, brdf);
            requirement.half =
                requirement.takes("it is stored and summed in f16 instead of f32", rounding * rounding, room);
        }
        requirement.count(brdf, room.max_order);
        requirement
    }

    /// Leaves something out if the budget has room for the share of what is seen that it takes away.
    fn takes(&mut self, what: &str, share: f64, room: &Room) -> bool {
        let error = (self.error * self.error + share).sqrt();
        let fits = error <= room.budget || share <= NOTHING;
        if fits {
            self.error = error;
            self.left.push(Left { what: what.to_owned(), error: share.sqrt() });
        }
        fits
    }

    /// How many coefficients of the light are stored.
    pub fn coefficients(&self) -> usize {
        let of_band = |l: &usize| match (self.zonal, self.mirror) {
            (true, _) => 1,
            (false, true) => l + 1,
            (false, false) => 2 * l + 1,
        };
        self.bands.iter().map(of_band).sum()
    }

    fn count(&mut self, brdf: &Brdf, max_order: usize) {
        let rotation = |order: usize| {
            // Names a family: the exact rotation is what a renderer that turns the light does.
            let spec: Spec = format!("rotate:{order}").parse().expect("is a spec");
            spec.code().cost(1).total
        };
        let all = max_order * max_order;
        let kept = self.coefficients();
        self.operations = [rotation(self.order) + self.channels * kept, rotation(max_order) + 3 * all];
        let [elevations, azimuths] = Table::shape(brdf, self.order);
        let [all_elevations, all_azimuths] = Table::shape(brdf, max_order);
        // A table that knows nothing of symmetry has as many azimuths as one of a reflectance without it.
        let all_azimuths = if self.isotropic { 2 * (all_elevations - 1) } else { all_azimuths };
        let columns = |l: &usize| if self.isotropic { l + 1 } else { 2 * l + 1 };
        let entries = elevations * azimuths * self.bands.iter().map(columns).sum::<usize>();
        let bytes = if self.half { 2 } else { 4 };
        self.bytes = [(self.channels * kept + entries) * bytes, (3 + all_elevations * all_azimuths) * all * 4];
    }

    /// The relative rms error of storing and summing in f16, over views and seeded frames.
    fn rounding(&self, light: &[[f64; 3]], brdf: &Brdf) -> f64 {
        // Names a family: z, y, z turns what is asked whether it is symmetric.
        let spec: Spec = format!("rotate:{}:zyz", self.order).parse().expect("is a spec");
        let rotate = Program::<f64>::new(&Listing::new(&spec.kernel()));
        let mut random = Random::new(0x5ce);
        let (mut error, mut size) = (0.0, 0.0);
        for (view, weight) in views(brdf) {
            let b = brdf.coefficients(view, self.order);
            for _ in 0..FRAMES {
                let q = random.unit::<4>();
                // The inverse turn of the light is the turn of the reflectance: b stays where it is looked up.
                let turned = rotate.run(&[&q, &b], Contraction::Separate);
                for c in 0..3 {
                    let want: f64 = turned.iter().zip(light).map(|(x, y)| x * y[c]).sum();
                    let narrow = |x: f64| Half::round(x);
                    let products = turned.iter().zip(light).filter(|(_, y)| y[c] != 0.0);
                    let got =
                        products.fold(Half::ZERO, |sum, (x, y)| Number::fused(narrow(*x), narrow(y[c]), sum)).to_f64();
                    error += weight * (got - want) * (got - want);
                    size += weight * want * want;
                }
            }
        }
        (error / size).sqrt()
    }
}
