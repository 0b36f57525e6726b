//! What a scene requires of its harmonics, and nothing more: from its map, its reflectance and the error it may have, the
//! order, the bands, the symmetries, the channels and the precision that are enough, and what leaving out the rest saves.
//!
//! Reflected light is Σ_i b_i(view) (D(R) L)_i. For a frame R that may be any, band l of it has the energy
//! |b_l|² |L_l|² / (2l + 1), which falls with l much faster than the light's own where the reflectance is smooth; that is
//! what decides. Each thing that is left out adds its squared error, and is left out while the sum keeps the budget
//! (docs/MATH.md#the-order-that-a-budget-asks-for).

use crate::environment::project::Projection;
use crate::families::Spec;
use crate::families::family::{MAX_HALF_ORDER, MIN_ORDER};
use crate::ir::eval::{Contraction, Number, Program};
use crate::ir::listing::Listing;
use crate::math::half::Half;
use crate::math::index::{band, band_degree};
use crate::math::quadrature::gauss_legendre;
use crate::promise::samples::Random;
use crate::reflectance::brdf::{Brdf, Table};
use serde::Serialize;
use std::fmt;

/// Elevations and azimuths of the views that a reflectance is averaged over.
const VIEWS: [usize; 2] = [6, 4];
/// How many frames each view is measured in.
const FRAMES: usize = 300;
/// A band whose share of the energy is below this holds nothing: f64's rounding.
const NOTHING: f64 = 1e-20;

/// What is needed, and what it costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Requirement {
    /// The reflectance.
    pub brdf: String,
    /// The relative rms error that everything left out may cost together, against all of `max_order` in f32.
    pub budget: f64,
    /// The most bands that could be afforded.
    pub max_order: usize,
    /// How many bands are enough.
    pub order: usize,
    /// Those of them that hold anything.
    pub bands: Vec<usize>,
    /// The share of each band below `max_order` in the energy of the reflected light.
    pub energy: Vec<f64>,
    /// 1 if the light is grey, else 3.
    pub channels: usize,
    /// Whether the light is the same all around z.
    pub zonal: bool,
    /// Whether the light is its own mirror image at the plane of x and z.
    pub mirror: bool,
    /// Whether turning view and frame about the normal changes nothing: a table of one azimuth, without the terms of
    /// negative degree.
    pub isotropic: bool,
    /// Whether f16 is enough.
    pub half: bool,
    /// The relative rms error that all this should cost.
    pub predicted: f64,
    /// What it does cost, over seeded frames.
    pub measured: f64,
    /// Operations a pixel, of a rotation and the product with the light: what is needed, and all.
    pub operations: [usize; 2],
    /// Bytes of the light's coefficients and of the reflectance's table: what is needed, and all.
    pub bytes: [usize; 2],
}

/// The views a reflectance is averaged over, with weights that add up to one.
fn views(brdf: &Brdf, shift: f64) -> Vec<([f64; 3], f64)> {
    let azimuths = if brdf.is_isotropic() { 1 } else { VIEWS[1] };
    let elevations: Vec<(f64, f64)> = gauss_legendre(VIEWS[0], 0.0, 1.0).collect();
    let mut views = Vec::new();
    for (cos, weight) in elevations {
        for i in 0..azimuths {
            let azimuth = std::f64::consts::PI * (i as f64 + 0.5 + shift) / azimuths as f64;
            let sin = (1.0 - cos * cos).sqrt();
            views.push(([sin * azimuth.cos(), sin * azimuth.sin(), cos], weight / azimuths as f64));
        }
    }
    views
}

/// The share of the reflected energy that a change of the light takes away.
fn share(light: &[[f64; 3]], weights: &[f64], changed: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> f64 {
    let (mut lost, mut all) = (0.0, 0.0);
    for (i, &own) in light.iter().enumerate() {
        let (other, weight) = (changed(i, own), weights[band_degree(i).0]);
        for c in 0..3 {
            lost += weight * (own[c] - other[c]).powi(2);
            all += weight * own[c] * own[c];
        }
    }
    lost / all
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
    /// What a map's radiance seen by `brdf` requires for a relative rms error of `budget` against all of `max_order`; `half` says
    /// whether f16 may be taken.
    ///
    /// # Panics
    ///
    /// If `max_order` is not one of a kernel's or beyond that of `radiance`, or `budget` is below 0.
    pub fn new(radiance: &Projection, brdf: &Brdf, budget: f64, max_order: usize, half: bool) -> Self {
        assert!(budget >= 0.0, "budget {budget}");
        let light = &radiance.coefficients[..max_order * max_order];
        let mut weights = vec![0.0; max_order];
        for (view, share) in views(brdf, 0.0) {
            let b = brdf.coefficients(view, max_order);
            for (l, weight) in weights.iter_mut().enumerate() {
                *weight += share * b[band(l)].iter().map(|x| x * x).sum::<f64>() / (2 * l + 1) as f64;
            }
        }
        let of_band = |l: usize| weights[l] * light[band(l)].iter().flatten().map(|x| x * x).sum::<f64>();
        let mut energy: Vec<f64> = (0..max_order).map(of_band).collect();
        let all: f64 = energy.iter().sum();
        energy.iter_mut().for_each(|share| *share /= all);
        let beyond = |order: usize| energy[order..].iter().sum::<f64>();
        let room = budget * budget;
        let order = (MIN_ORDER..max_order).find(|&order| beyond(order) <= room).unwrap_or(max_order);
        let mut spent = beyond(order);
        // Whatever else keeps the sum below the budget goes too, the cheapest to miss first.
        let mut take = |share: f64| {
            let fits = spent + share <= room;
            spent += if fits { share } else { 0.0 };
            fits
        };
        let zonal = take(share(light, &weights, only(is_zonal)));
        let mirror = zonal || take(share(light, &weights, only(is_even)));
        let channels = if take(share(light, &weights, grey)) { 1 } else { 3 };
        // Light and reflectance rounded to 2⁻¹¹ at worst, and as many sums as the root of the products, each as much.
        let rounding = (order as f64 + 2.0) / 2048.0;
        let half = half && order <= MAX_HALF_ORDER && take(rounding * rounding);
        let bands: Vec<usize> = (0..order).filter(|&l| energy[l] > NOTHING).collect();
        let mut requirement = Self {
            brdf: brdf.to_string(),
            budget,
            max_order,
            order,
            bands,
            channels,
            zonal,
            mirror,
            isotropic: brdf.is_isotropic(),
            half,
            predicted: spent.sqrt(),
            measured: 0.0,
            operations: [0, 0],
            bytes: [0, 0],
            energy,
        };
        requirement.count(brdf);
        requirement.measured = requirement.measure(light, brdf);
        requirement
    }

    /// Whether a band below `max_order` holds anything.
    pub fn holds(&self, l: usize) -> bool {
        self.energy[l] > NOTHING
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

    fn count(&mut self, brdf: &Brdf) {
        let rotation = |order: usize| {
            // Names a family: the exact rotation is what a renderer that turns the light does.
            let spec: Spec = format!("rotate:{order}").parse().expect("is a spec");
            spec.code().cost(1).total
        };
        let all = self.max_order * self.max_order;
        let kept = self.coefficients();
        self.operations = [rotation(self.order) + self.channels * kept, rotation(self.max_order) + 3 * all];
        let [elevations, azimuths] = Table::shape(brdf, self.order);
        let [all_elevations, all_azimuths] = Table::shape(brdf, self.max_order);
        // A table that knows nothing of symmetry has as many azimuths as one of a reflectance without it.
        let all_azimuths = if self.isotropic { 2 * (all_elevations - 1) } else { all_azimuths };
        let columns = |l: &usize| if self.isotropic { l + 1 } else { 2 * l + 1 };
        let entries = elevations * azimuths * self.bands.iter().map(columns).sum::<usize>();
        let bytes = if self.half { 2 } else { 4 };
        self.bytes = [(self.channels * kept + entries) * bytes, (3 + all_elevations * all_azimuths) * all * 4];
    }

    /// The relative rms error over views and frames.
    fn measure(&self, light: &[[f64; 3]], brdf: &Brdf) -> f64 {
        // Names a family: z, y, z turns what is asked whether it is symmetric.
        let spec: Spec = format!("rotate:{}:zyz", self.max_order).parse().expect("is a spec");
        let rotate = Program::<f64>::new(&Listing::new(&spec.kernel()));
        let channel = |c: usize| -> Vec<f64> { light.iter().map(|value| value[c]).collect() };
        let lights = [channel(0), channel(1), channel(2)];
        let kept: Vec<[f64; 3]> = light
            .iter()
            .enumerate()
            .map(|(i, &value)| {
                let (l, m) = band_degree(i);
                let stays = self.bands.contains(&l) && (!self.zonal || is_zonal(m)) && (!self.mirror || is_even(m));
                match (stays, self.channels) {
                    (false, _) => [0.0; 3],
                    (true, 1) => grey(i, value),
                    (true, _) => value,
                }
            })
            .collect();
        let mut random = Random::new(0x5ce);
        let (mut error, mut size) = (0.0, 0.0);
        for (view, weight) in views(brdf, 0.25) {
            let b = brdf.coefficients(view, self.max_order);
            for _ in 0..FRAMES {
                let q = random.unit::<4>();
                // The inverse turn of the light is the turn of the reflectance: b stays where it is looked up.
                let turned = rotate.run(&[&q, &b], Contraction::Separate);
                for c in 0..3 {
                    let want: f64 = turned.iter().zip(&lights[c]).map(|(x, y)| x * y).sum();
                    let got = match self.half {
                        false => turned.iter().zip(&kept).map(|(x, y)| x * y[c]).sum(),
                        true => {
                            let narrow = |x: f64| Half::round(x);
                            let products = turned.iter().zip(&kept).filter(|(_, y)| y[c] != 0.0);
                            products
                                .fold(Half::ZERO, |sum, (x, y)| Number::fused(narrow(*x), narrow(y[c]), sum))
                                .to_f64()
                        }
                    };
                    error += weight * (got - want) * (got - want);
                    size += weight * want * want;
                }
            }
        }
        (error / size).sqrt()
    }

    /// What is left out, in words, one thing a line.
    pub fn left_out(&self) -> Vec<String> {
        let mut list = Vec::new();
        if self.order < self.max_order {
            list.push(format!("bands {} to {}", self.order, self.max_order - 1));
        }
        let missing: Vec<String> = (0..self.order)
            .filter(|l| !self.bands.contains(l))
            .map(|l| format!("band {l}, which holds nothing"))
            .collect();
        list.extend(missing);
        if self.isotropic {
            list.push("the azimuths of the view, and the terms of negative degree with them".to_owned());
        }
        match (self.zonal, self.mirror) {
            (true, _) => list.push("all of the light but its zonal part".to_owned()),
            (false, true) => list.push("the light's terms of negative degree".to_owned()),
            _ => {}
        }
        if self.channels == 1 {
            list.push("two of three channels".to_owned());
        }
        if self.half {
            list.push("f32: f16 is enough".to_owned());
        }
        list
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |x: f64| format!("{:.2} %", 100.0 * x);
        writeln!(f, "## What `{}` requires of this light\n", self.brdf)?;
        writeln!(
            f,
            "Order {} of {}, for an error of {} (predicted {}, measured {}). Left out: {}.",
            self.order,
            self.max_order,
            percent(self.budget),
            percent(self.predicted),
            percent(self.measured),
            match &self.left_out()[..] {
                [] => "nothing".to_owned(),
                list => list.join("; "),
            }
        )?;
        writeln!(
            f,
            "\nA pixel costs {} operations instead of {}, light and reflectance {} bytes instead of {}.",
            self.operations[0], self.operations[1], self.bytes[0], self.bytes[1]
        )
    }
}
