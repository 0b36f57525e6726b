//! What the light of a point is stored as: the names of the bases, the harmonics that are gathered for one, and the kernel
//! that makes its coefficients of them. The constants are the kernels'.

use std::str::FromStr;
use zonal_codegen::environment::harmonics::{basis, cosine_lobe};
use zonal_codegen::families::Spec;
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;

/// The kind of a basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Radiance in spherical harmonics.
    Radiance,
    /// Irradiance by the normal, in spherical harmonics.
    Irradiance,
    /// Radiance over the normal's hemisphere, in hemispherical harmonics.
    Hemisphere,
    /// Irradiance over the normal's hemisphere, in the H-basis or the Half-Life 2 basis.
    Normals,
    /// Whether the sky is seen, 1 or 0, in spherical harmonics in the axes of the object.
    Visibility,
}

/// A basis that irradiance over the hemisphere is stored in.
struct Named {
    name: &'static str,
    coefficients: usize,
    /// How many bands of radiance it is made of.
    order: usize,
    /// The kernel that makes it of them.
    spec: &'static str,
}

/// The bases over the hemisphere, whose names stand for themselves.
const NAMED: [Named; 3] = [
    Named { name: "h4", coefficients: 4, order: 5, spec: "sh5_to_h4" },
    Named { name: "h6", coefficients: 6, order: 5, spec: "sh5_to_h6" },
    Named { name: "hl2", coefficients: 3, order: 3, spec: "sh3_to_hl2" },
];
/// The orders of light.
pub const ORDERS: std::ops::RangeInclusive<usize> = 2..=10;
/// The orders of visibility, which no kernel makes.
pub const VISIBILITY: std::ops::RangeInclusive<usize> = 2..=20;

/// A basis.
#[derive(Clone, Debug)]
pub struct Basis {
    /// The name, as [`Basis::from_str`] takes it.
    pub name: String,
    /// The kind.
    pub kind: Kind,
    /// How many bands of radiance are gathered for it.
    pub order: usize,
    /// How many coefficients it has.
    pub coefficients: usize,
    /// What makes them of the radiance, or of hemispherical harmonics what they are in a direction; none if harmonics of the
    /// sphere are scaled by band alone.
    kernel: Option<Program<f64>>,
}

/// The kernel of a spec.
fn program(spec: &str) -> Result<Option<Program<f64>>, Fault> {
    let spec: Spec = spec.parse().map_err(|error| Fault::new(format!("`{spec}`: {error}"), ""))?;
    Ok(Some(Program::new(&Listing::new(&spec.kernel()))))
}

impl FromStr for Basis {
    type Err = Fault;

    /// Reads a name: sh3, irradiance3, hsh3, visibility3 and so on, h4, h6, hl2.
    fn from_str(name: &str) -> Result<Self, Fault> {
        let unknown = || {
            let [light, seen] = [ORDERS, VISIBILITY].map(|orders| format!("{} to {}", orders.start(), orders.end()));
            let named: Vec<&str> = NAMED.iter().map(|named| named.name).collect();
            let help = format!(
                "name sh, irradiance or hsh with an order from {light}, as in irradiance3, visibility with one from {seen}, or one of {}",
                named.join(", ")
            );
            Fault::new(format!("there is no basis `{name}`"), help)
        };
        if let Some(Named { coefficients, order, spec, .. }) = NAMED.iter().find(|named| named.name == name) {
            let kernel = program(spec)?;
            let (kind, coefficients, order) = (Kind::Normals, *coefficients, *order);
            return Ok(Self { name: name.to_owned(), kind, order, coefficients, kernel });
        }
        let digits = name.trim_start_matches(|c: char| c.is_ascii_lowercase());
        let (kind, orders) = match name.strip_suffix(digits) {
            Some("sh") => (Kind::Radiance, ORDERS),
            Some("irradiance") => (Kind::Irradiance, ORDERS),
            Some("hsh") => (Kind::Hemisphere, ORDERS),
            Some("visibility") => (Kind::Visibility, VISIBILITY),
            _ => return Err(unknown()),
        };
        let order: usize = digits.parse().ok().filter(|order| orders.contains(order)).ok_or_else(unknown)?;
        if digits != order.to_string() {
            return Err(unknown());
        }
        let kernel = if kind == Kind::Hemisphere { program(&format!("hsh_basis:{order}"))? } else { None };
        Ok(Self { name: name.to_owned(), kind, order, coefficients: order * order, kernel })
    }
}

impl Basis {
    /// Whether its coefficients are of irradiance, which may be divided by π.
    pub fn is_irradiance(&self) -> bool {
        matches!(self.kind, Kind::Irradiance | Kind::Normals)
    }

    /// What its coefficients are of.
    pub fn of(&self) -> &'static str {
        match self.kind {
            Kind::Radiance | Kind::Hemisphere => "radiance",
            Kind::Irradiance | Kind::Normals => "irradiance",
            Kind::Visibility => "visibility",
        }
    }

    /// How many numbers a coefficient has: R, G and B of light, one of what is seen.
    pub fn channels(&self) -> usize {
        if self.is_of_object() { 1 } else { 3 }
    }

    /// Whether it is in the axes of the object, which all points share, and not in the frame of the surface; of the object
    /// alone it takes no map.
    pub fn is_of_object(&self) -> bool {
        self.kind == Kind::Visibility
    }

    /// Writes what is gathered of a direction of the basis's frame, above the horizon: the harmonics of the sphere, or those of
    /// the hemisphere. `values` has the square of the order.
    pub fn values(&self, direction: [f64; 3], values: &mut [f64]) {
        match (&self.kernel, self.kind) {
            (Some(kernel), Kind::Hemisphere) => {
                values.copy_from_slice(&kernel.run(&[&direction], Contraction::Separate));
            }
            _ => basis(self.order, direction, values),
        }
    }

    /// Returns the coefficients of what was gathered, a sum a channel for each value.
    pub fn coefficients(&self, sums: &[[f64; 3]]) -> Vec<[f64; 3]> {
        match (&self.kernel, self.kind) {
            (Some(program), Kind::Normals) => {
                let channel = |k: usize| {
                    let one: Vec<f64> = sums.iter().map(|sum| sum[k]).collect();
                    program.run(&[&one], Contraction::Separate)
                };
                let [r, g, b] = [0, 1, 2].map(channel);
                (0..self.coefficients).map(|i| [r[i], g[i], b[i]]).collect()
            }
            (_, Kind::Irradiance) => {
                sums.iter().enumerate().map(|(i, sum)| sum.map(|v| v * cosine_lobe(i.isqrt()))).collect()
            }
            _ => sums.to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};
    use zonal_codegen::math::quadrature::gauss_legendre;

    #[test]
    fn names_are_read_and_others_refused_with_the_list() {
        for (name, kind, coefficients) in [
            ("sh3", Kind::Radiance, 9),
            ("irradiance2", Kind::Irradiance, 4),
            ("hsh10", Kind::Hemisphere, 100),
            ("h4", Kind::Normals, 4),
            ("h6", Kind::Normals, 6),
            ("hl2", Kind::Normals, 3),
            ("visibility20", Kind::Visibility, 400),
        ] {
            let basis: Basis = name.parse().expect("a basis");
            assert_eq!((basis.kind, basis.coefficients, basis.name.as_str()), (kind, coefficients, name));
        }
        let wrong = ["", "sh", "sh1", "sh11", "sh03", "h5", "H6", "h6 ", "3", "sh3x", "irradiance99999999999999999999"];
        for name in wrong.into_iter().chain(["visibility", "visibility1", "visibility21"]) {
            let error = name.parse::<Basis>().expect_err("no basis").to_string();
            assert!(error.contains(&format!("no basis `{name}`")) && error.contains("h4, h6, hl2"), "{error}");
        }
    }
    /// Each basis at a normal, by the kernel of its sum.
    const SUMS: [(&str, &str); 7] = [
        ("irradiance3", "eval:3"),
        ("irradiance7", "eval:7"),
        ("h4", "h4_eval"),
        ("h6", "h6_eval"),
        ("hl2", "hl2_eval"),
        ("sh6", "eval:6"),
        ("hsh6", "hsh_eval:6"),
    ];

    #[test]
    fn what_a_basis_holds_is_near_what_was_gathered() {
        // The whole upper half shines: irradiance is π (1 + z)/2, and radiance 1 above.
        let rows: Vec<(f64, f64)> = gauss_legendre(40, 0.0, 1.0).collect();
        let light: Vec<([f64; 3], f64)> = rows
            .iter()
            .flat_map(|&(z, weight)| {
                (0..60).map(move |i| {
                    let (sin, cos) = (TAU * f64::from(i) / 60.0).sin_cos();
                    let radius = (1.0 - z * z).sqrt();
                    ([radius * cos, radius * sin, z], weight * TAU / 60.0)
                })
            })
            .collect();
        for (name, spec) in SUMS {
            let stored: Basis = name.parse().expect("a basis");
            let count = stored.order * stored.order;
            let (mut sums, mut values) = (vec![[0.0; 3]; count], vec![0.0; count]);
            for (direction, weight) in &light {
                stored.values(*direction, &mut values);
                sums.iter_mut().zip(&values).for_each(|(sum, y)| sum[1] += y * weight);
            }
            let found = stored.coefficients(&sums);
            assert_eq!(found.len(), stored.coefficients, "{name}");
            let sum = program(spec).expect("a kernel").expect("one");
            let (mut error, mut whole) = (0.0, 0.0);
            for (direction, weight) in &light {
                let green: Vec<f64> = found.iter().map(|c| c[1]).collect();
                let value = sum.run(&[direction, &green], Contraction::Separate)[0];
                let truth = if stored.is_irradiance() { 0.5 * PI * (1.0 + direction[2]) } else { 1.0 };
                (error, whole) = (error + weight * (value - truth).powi(2), whole + weight * truth * truth);
            }
            let error = f64::sqrt(error / whole);
            // Hemispherical harmonics hold a constant, and what is linear in the normal holds this irradiance but for the bands
            // of radiance that are not gathered. Harmonics of the sphere overshoot at its edge, and the best that has no constant
            // errs by the root of 3/28, which is 0.327.
            let most = match name {
                "hsh6" => 1e-12,
                "irradiance3" | "h4" | "h6" => 0.03,
                "irradiance7" => 0.005,
                "hl2" => 0.33,
                _ => 0.2,
            };
            assert!(error < most, "{name}: {error}");
            assert!(found.iter().all(|c| c[0] == 0.0 && c[2] == 0.0));
        }
    }
}
