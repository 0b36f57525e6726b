//! The approximate rotations that are compared, and the law that each one's error follows while lβ is small.

use zonal_codegen::kernel::Kernel;
use zonal_codegen::kernels::y_rotation::{Small, about_y};
use zonal_codegen::kernels::{rotate, tilt};
use zonal_codegen::listing::Listing;

/// How a band is rotated about y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Band {
    /// Exactly, from the cosine and the sine.
    Exact,
    /// Approximately, from the angle.
    Small(Small),
}

impl Band {
    /// Exact first, then every approximation.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Exact).chain(Small::ALL.map(|(small, _)| Self::Small(small)))
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Small(small) => small.name(),
        }
    }

    /// What a band's error comes to, by its law, at an angle in radians.
    pub fn law(self, l: usize, beta: f64) -> f64 {
        law(self.name(), l, beta)
    }
}

/// What an approximate rotation does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Every band about y by one method.
    Uniform(Small),
    /// Bands 1 and 2 about y exactly, the others by three shears.
    ExactThenLf3,
    /// The tilt from a normal.
    Tilt,
}

/// An approximate rotation of all bands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Method {
    /// Its name in reports.
    pub name: &'static str,
    /// Its name in plots.
    pub label: &'static str,
    /// What it does.
    pub way: Way,
}

impl Method {
    /// All of them: the methods of y rotations, then those that are exact in bands 1 and 2.
    pub fn all() -> Vec<Self> {
        let uniform = Small::ALL.map(|(small, name)| Self { name, label: label(name), way: Way::Uniform(small) });
        let exact = Self { name: "exact2+lf3", label: "LF3, l ≤ 2 exact", way: Way::ExactThenLf3 };
        let tilt = Self { name: "tilt", label: "tilt", way: Way::Tilt };
        uniform.into_iter().chain([exact, tilt]).collect()
    }

    /// The law of its largest error in any band.
    pub fn law(&self, order: usize, beta: f64) -> f64 {
        let first = if matches!(self.way, Way::Uniform(_)) { 1 } else { 3 };
        let name = if first == 1 { self.name } else { "lf3" };
        (first..order).map(|l| law(name, l, beta)).fold(0.0, f64::max)
    }
}

/// The name of a method as a reader knows it.
pub fn label(name: &str) -> &'static str {
    match name {
        "taylor1" => "Taylor 1",
        "taylor15" => "Taylor 1.5",
        "taylor2" => "Taylor 2",
        "lf3" => "LF3",
        "lf5" => "LF5",
        "exact" => "exact",
        _ => "other",
    }
}

/// The formula of a method's law, L = lβ.
pub fn formula(name: &str) -> &'static str {
    match name {
        "taylor1" => "L²/2",
        "taylor15" => "≈ L²/4 (l = 1: L³/6)",
        "taylor2" => "L³/6",
        "lf3" => "L³/24, l odd: (l³ − l) β³/24",
        "lf5" => "(7 − 3√5) L³/96, l odd: (l³ − l) β³",
        "exact2+lf3" | "tilt" => "as LF3, 0 for l ≤ 2",
        "exact" => "0",
        _ => "none",
    }
}

/// The largest error of band l for a small lβ; infinite for a method whose law is not known.
fn law(name: &str, l: usize, beta: f64) -> f64 {
    let wide = l as f64 * beta;
    match (name, l) {
        ("exact", _) => 0.0,
        ("taylor1", _) => wide.powi(2) / 2.0,
        ("taylor15", 2..) => wide.powi(2) / 4.0,
        ("taylor15" | "taylor2", _) => wide.powi(3) / 6.0,
        ("lf5", _) => law("lf3", l, beta) * 24.0 * (7.0 - 3.0 * 5f64.sqrt()) / 96.0,
        ("lf3", 1) => 0.0,
        ("lf3", _) if l % 2 == 1 => ((l * l * l - l) as f64) * beta.powi(3) / 24.0,
        ("lf3", _) => wide.powi(3) / 24.0,
        _ => f64::INFINITY,
    }
}

/// A kernel's operations as far as the bands that are kept need them.
pub fn restricted(kernel: &Kernel, keep: impl Fn(usize) -> bool) -> Listing {
    let mut kernel = kernel.clone();
    let mut place = 0;
    kernel.outputs.retain(|_| {
        place += 1;
        keep((place - 1usize).isqrt())
    });
    Listing::new(&kernel)
}

/// What a y rotation costs whose bands 1, 2, … are done in different ways, given β and, for exact bands, (cos β, sin β).
pub fn mixed_cost(exact: &Kernel, bands: &[Band]) -> usize {
    let order = bands.len() + 1;
    let small: Vec<Small> = bands
        .iter()
        .map(|band| match band {
            Band::Exact => Small::Taylor1,
            Band::Small(small) => *small,
        })
        .collect();
    let is_exact = |l: usize| l == 0 || bands[l - 1] == Band::Exact;
    let approximate = restricted(&about_y(order, &small), |l| !is_exact(l));
    restricted(exact, is_exact).cost(1).total + approximate.cost(1).total
}

/// The kernel of a method and its exact twin about y.
pub fn kernels(way: Way, order: usize) -> [Kernel; 2] {
    let approximate = match way {
        Way::Uniform(small) => about_y(order, &vec![small; order - 1]),
        Way::ExactThenLf3 => about_y(order, &vec![Small::Lf3; order - 1]),
        Way::Tilt => tilt::tilt(order, &Small::Lf3.from_band_3(order), false),
    };
    [approximate, rotate::rotate_y(order)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_has_a_label_and_a_law() {
        for method in Method::all() {
            assert!(method.label != "other" && formula(method.name) != "none", "{}", method.name);
            assert!(method.law(6, 0.1).is_finite(), "{}", method.name);
        }
    }

    #[test]
    fn uniform_mixtures_cost_what_their_kernels_cost() {
        for order in [3, 6] {
            let exact = rotate::rotate_y(order);
            let whole = Listing::new(&exact).cost(1).total;
            assert_eq!(mixed_cost(&exact, &vec![Band::Exact; order - 1]), whole);
            for (small, _) in Small::ALL {
                let kernel = about_y(order, &vec![small; order - 1]);
                let bands = vec![Band::Small(small); order - 1];
                assert_eq!(mixed_cost(&exact, &bands), Listing::new(&kernel).cost(1).total);
            }
        }
    }
}
