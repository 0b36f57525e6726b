//! Shading by isotropic decomposition (Soler et al. 2015): the conditions of its mother functions, which is their Figure 13;
//! what its forms cost beside the direct one; how it converges to brute force (docs/MATH.md#isotropic-decomposition).

use crate::markdown::{file, short, table as rows_of};
use crate::svg::{self, Axis, Panel, Picture, Series, Stroke, key};
use crate::{File, Progress, each, significant};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use zonal_codegen::emit::bands;
use zonal_codegen::environment::Texel;
use zonal_codegen::environment::bands::bound_side;
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::families::Spec;
// Names a family: its directions and mother functions are what is measured.
use zonal_codegen::families::isd::directions::best_of;
use zonal_codegen::families::isd::mother::{Decomposition, HOPELESS, Levels, Mother};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::{Random, matrix_of};
use zonal_codegen::reflectance::brdf::Brdf;

/// The profiles of the figure.
const PROFILES: [Mother; 4] = [Mother::Legendre, Mother::Gaussian, Mother::Phong, Mother::GaussLegendre];
/// The numbers of bands of the figure; beyond ten every second one.
const BANDS: [usize; 15] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18, 20];
/// The orders whose costs are told.
const ORDERS: [usize; 6] = [3, 4, 5, 6, 7, 8];
/// The reflectances that are shaded.
const REFLECTANCES: [&str; 3] = ["phong:20", "ward:0.3", "ward:0.25:0.6"];
/// The bands that they are shaded by.
const REACHED: [usize; 6] = [2, 4, 8, 12, 16, 19];
/// How many views and frames each is shaded for.
const VIEWS: usize = 12;
/// The error that the bands' tables are sized for, relative to a band's largest value.
const TABLE_ERROR: f64 = 0.01;

/// The conditions of one profile over the bands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// The profile.
    pub mother: String,
    /// Whether the levels share directions.
    pub shared: bool,
    /// Whether directions that they do not share are those of a search, instead of a spiral.
    #[serde(default)]
    pub searched: bool,
    /// The numbers of bands.
    pub bands: Vec<usize>,
    /// The condition number of M for each.
    pub conditions: Vec<f64>,
}

/// What shading costs at an order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Forms {
    /// The order.
    pub order: usize,
    /// Operations for one channel and for three: equation 22 by its kernel, the direct form, the isotropic one, equation 34
    /// by its kernel, the direct form of a zonal light.
    pub operations: Vec<[usize; 2]>,
    /// Operations for one channel and for three where the bands' functions are read from tables.
    pub tabulated: [usize; 2],
    /// Reads from those tables.
    pub reads: usize,
    /// Bytes of the tables.
    pub bytes: usize,
}

/// How far a reflectance's shading errs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Convergence {
    /// The reflectance.
    pub reflectance: String,
    /// The mother functions.
    pub mother: String,
    /// The number of bands above 0.
    pub bands: usize,
    /// The condition number of M.
    pub condition: f64,
    /// The root mean square error against brute force, relative to its root mean square.
    pub error: f64,
    /// What f32 adds, relative to the same.
    pub rounding: f64,
}

/// All that is measured of shading.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shading {
    /// Figure 13.
    pub conditions: Vec<Conditions>,
    /// The costs.
    pub forms: Vec<Forms>,
    /// The convergence.
    pub convergence: Vec<Convergence>,
}

/// Where the directions of the levels come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spread {
    /// The spiral.
    Spiral,
    /// The kept set of the mother functions.
    Searched,
    /// The kept set that levels share, of one band the axes.
    Shared,
}

fn kept(mother: Option<Mother>, bands: usize) -> Option<Vec<[f64; 3]>> {
    let unit = |v: &[f64; 3]| {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| x / length)
    };
    Some(best_of(mother, bands)?.directions.iter().map(unit).collect())
}

impl Spread {
    fn levels(self, mother: Mother, bands: usize) -> Option<Levels> {
        let axes = || vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        match self {
            Self::Spiral => Some(Levels::dealt(bands)),
            Self::Searched => Levels::own(bands, &kept(Some(mother), bands)?).ok(),
            Self::Shared if bands == 1 => Levels::shared(1, &axes()).ok(),
            Self::Shared => Levels::shared(bands, &kept(None, bands)?).ok(),
        }
    }
}

fn conditions(&(mother, spread): &(Mother, Spread)) -> Conditions {
    let of = |&bands: &usize| {
        let levels = spread.levels(mother, bands)?;
        Some((bands, significant(Decomposition::measured(mother, &levels).condition.min(1e18))))
    };
    let (bands, conditions) = BANDS.iter().filter_map(of).unzip();
    let [shared, searched] = [Spread::Shared, Spread::Searched].map(|other| other == spread);
    Conditions { mother: mother.name().to_owned(), shared, searched, bands, conditions }
}

fn forms(&order: &usize) -> Forms {
    let cost = |name: &str| {
        let spec: Spec = format!("{name}:{order}").parse().unwrap_or_else(|error| panic!("{error}"));
        let rgb = Spec { rgb: true, ..spec.clone() };
        // A name without a method may mean another kernel for three channels.
        let rgb: Spec = format!("{name}:{order}:rgb").parse().unwrap_or(rgb);
        [Listing::new(&spec.kernel()).cost(1).total, Listing::new(&rgb.kernel()).cost(3).total]
    };
    let bytes = |l: usize| 6 * bound_side(l, TABLE_ERROR).pow(2) * Texel::Half.bytes();
    Forms {
        order,
        operations: ["isd_shade", "shade", "shade_isotropic", "isd_shade_zonal", "shade_zonal"].map(cost).to_vec(),
        tabulated: [1, 3].map(|channels| bands::shaded(order, channels)),
        reads: order * order,
        bytes: (0..order).map(bytes).sum(),
    }
}

/// Lobes of light, each a direction, a sharpness and a strength: exp(κ (cos − 1)).
const LAMPS: [([f64; 3], f64, f64); 3] =
    [([0.36, 0.48, 0.8], 40.0, 3.0), ([-0.6, 0.64, 0.48], 15.0, 1.0), ([0.8, -0.36, 0.48], 25.0, 2.0)];

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn shine(dir: [f64; 3]) -> f64 {
    0.2 + LAMPS.iter().map(|(axis, kappa, size)| size * (kappa * (dot(axis, &dir) - 1.0)).exp()).sum::<f64>()
}

/// The light's coefficients of an order, by those of its lobes.
fn light(order: usize) -> Vec<f64> {
    let mut sums = vec![0.0; order * order];
    let mut values = vec![0.0; order * order];
    sums[0] = 0.2 * (4.0 * PI).sqrt();
    for (axis, kappa, size) in LAMPS {
        let mut zonal = vec![0.0; order];
        for (z, weight) in gauss_legendre(120, -1.0, 1.0) {
            basis(order, [(1.0 - z * z).sqrt(), 0.0, z], &mut values);
            let value = 2.0 * PI * weight * size * (kappa * (z - 1.0)).exp();
            zonal.iter_mut().enumerate().for_each(|(l, sum)| *sum += value * values[l * (l + 1)]);
        }
        basis(order, axis, &mut values);
        for (place, sum) in sums.iter_mut().enumerate() {
            let l = place.isqrt();
            *sum += zonal[l] * (4.0 * PI / (2 * l + 1) as f64).sqrt() * values[place];
        }
    }
    sums
}

/// Solves M x = b for several b at once, with the largest pivot of each column.
fn solved(matrix: &[Vec<f64>], right: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let mut rows: Vec<Vec<f64>> = matrix
        .iter()
        .enumerate()
        .map(|(i, row)| row.iter().copied().chain(right.iter().map(|b| b[i])).collect())
        .collect();
    for column in 0..n {
        let pivot = (column..n).max_by(|&i, &j| rows[i][column].abs().total_cmp(&rows[j][column].abs()));
        rows.swap(column, pivot.unwrap_or(column));
        let lead = rows[column].clone();
        for row in rows.iter_mut().skip(column + 1) {
            let factor = row[column] / lead[column];
            if factor != 0.0 {
                row.iter_mut().zip(&lead).skip(column).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    for column in (0..n).rev() {
        let lead = rows[column].clone();
        for value in &mut rows[column][n..] {
            *value /= lead[column];
        }
        let solved = rows[column][n..].to_vec();
        for row in &mut rows[..column] {
            let factor = row[column];
            row[n..].iter_mut().zip(&solved).for_each(|(x, y)| *x -= factor * y);
        }
    }
    (0..right.len()).map(|i| rows.iter().map(|row| row[n + i]).collect()).collect()
}

/// A view in the frame of a surface, and the quaternion that takes the world there.
fn views() -> Vec<([f64; 3], [f64; 4])> {
    let mut random = Random::new(19);
    let view = |i: usize| {
        let z = 0.15 + 0.8 * i as f64 / VIEWS as f64;
        let (sin, cos) = (2.4 * i as f64).sin_cos();
        let rim = (1.0 - z * z).sqrt();
        [rim * cos, rim * sin, z]
    };
    (0..VIEWS).map(|i| (view(i), random.unit::<4>())).collect()
}

/// A rotation by its inverse.
fn back(q: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let m = matrix_of(q);
    std::array::from_fn(|i| dot(&m[3 * i..3 * i + 3], &v))
}

fn brute_force(brdf: &Brdf, view: [f64; 3], q: [f64; 4]) -> f64 {
    const AROUND: usize = 360;
    let mut sum = 0.0;
    for (z, weight) in gauss_legendre(180, 0.0, 1.0) {
        for i in 0..AROUND {
            let (sin, cos) = (2.0 * PI * (i as f64 + 0.5) / AROUND as f64).sin_cos();
            let rim = (1.0 - z * z).sqrt();
            let dir = [rim * cos, rim * sin, z];
            sum += weight * 2.0 * PI / AROUND as f64 * brdf.value(view, dir) * shine(back(q, dir));
        }
    }
    sum
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    (values.map(|x| x * x).sum::<f64>() / VIEWS as f64).sqrt()
}

/// Equation 6 of the paper, of which 22 is a case: the weights times the light, convolved with each level's function, at the
/// turned directions.
fn converged(text: &str) -> Vec<Convergence> {
    let brdf: Brdf = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
    let views = views();
    let want: Vec<f64> = views.iter().map(|&(view, q)| brute_force(&brdf, view, q)).collect();
    let size = root_mean_square(want.iter().copied());
    let harmonic = REACHED.map(|bands| (Mother::Harmonic, bands));
    let gaussian = [2, 4, 8].map(|bands| (Mother::Gaussian, bands));
    let of = |(mother, bands): (Mother, usize)| {
        let spread = if mother == Mother::Harmonic { Spread::Shared } else { Spread::Searched };
        let levels = spread.levels(mother, bands)?;
        let made = Decomposition::new(mother, &levels).ok()?;
        let slices: Vec<Vec<f64>> = views.iter().map(|&(view, _)| brdf.coefficients(view, bands + 1)).collect();
        let e = light(bands + 1);
        let mut values = vec![0.0; e.len()];
        let (mut got, mut narrow) = (Vec::new(), Vec::new());
        for (lambda, &(_, q)) in solved(&made.matrix, &slices).iter().zip(&views) {
            let (mut sum, mut sum_narrow) = (0.0, 0.0f32);
            let mut weights = lambda.iter();
            for (l, directions) in levels.directions().iter().enumerate() {
                let beta = mother.beta(l, bands);
                for &direction in directions {
                    basis(bands + 1, back(q, direction), &mut values);
                    let of_place = |place: usize| {
                        let band = place.isqrt();
                        beta[band] * (4.0 * PI / (2 * band + 1) as f64).sqrt() * e[place] * values[place]
                    };
                    let convolved: f64 = (0..e.len()).map(of_place).sum();
                    let weight = weights.next().copied().unwrap_or_default();
                    sum += weight * convolved;
                    sum_narrow += weight as f32 * convolved as f32;
                }
            }
            got.push(sum);
            narrow.push(f64::from(sum_narrow));
        }
        let error = |a: &[f64], b: &[f64]| root_mean_square(a.iter().zip(b).map(|(a, b)| a - b)) / size;
        Some(Convergence {
            reflectance: text.to_owned(),
            mother: mother.name().to_owned(),
            bands,
            condition: significant(made.condition),
            error: significant(error(&got, &want)),
            // To one digit: it hangs on the last bits of every sum.
            rounding: format!("{:.0e}", error(&narrow, &got)).parse().unwrap_or_default(),
        })
    };
    harmonic.into_iter().chain(gaussian).filter_map(of).collect()
}

/// Measures shading.
pub fn measure(progress: &dyn Progress) -> Shading {
    let of = |&mother: &Mother| [Spread::Spiral, Spread::Shared, Spread::Searched].map(|spread| (mother, spread));
    let mut profiles: Vec<(Mother, Spread)> = PROFILES.iter().flat_map(of).collect();
    profiles.retain(|(mother, spread)| *spread != Spread::Searched || *mother != Mother::Legendre);
    Shading {
        conditions: each(progress, "mother functions", &profiles, conditions),
        forms: each(progress, "shading", &ORDERS, forms),
        convergence: each(progress, "convergence", &REFLECTANCES, |text| converged(text)).concat(),
    }
}

/// The page.
pub fn table(shading: &Shading) -> File {
    let pair = |[one, three]: [usize; 2]| format!("{one} / {three}");
    let costs = shading.forms.iter().map(|form| {
        // What a read may cost before the direct form is the cheaper, in operations of three channels.
        let spared = form.operations[1][1] as f64 - form.tabulated[1] as f64;
        let price = if spared > 0.0 { short(spared / form.reads as f64) } else { "nothing".to_owned() };
        let mut row = vec![form.order.to_string()];
        row.extend(form.operations[..3].iter().map(|&cost| pair(cost)));
        row.extend([pair(form.tabulated), form.reads.to_string(), form.bytes.to_string(), price]);
        row.extend(form.operations[3..].iter().map(|&cost| pair(cost)));
        row
    });
    let converged = shading.convergence.iter().map(|row| {
        let (bands, condition) = (row.bands.to_string(), short(row.condition));
        vec![row.reflectance.clone(), row.mother.clone(), bands, condition, short(row.error), short(row.rounding)]
    });
    let parts = [
        "![The condition of M over the bands](conditions.svg)\n\nFigure 13 of Soler et al. 2015: the condition number of M for \
         four profiles of mother functions. Shared directions are those that `zonal search-directions` keeps, to 19 bands; \
         others are spread over the sphere by the golden angle and dealt to the levels, or are those that \
         `zonal search-directions --mother` keeps, to 8 bands. Kept sets hold harmonics and \
         Legendre polynomials, which differ from them by a factor a band, below what spread directions reach; sharing \
         ruins the profiles with local support, as the paper says; the search takes the condition of those that do not share \
         from some thousands to below a hundred."
            .to_owned(),
        "## Operations, reads, bytes\n\nThe forms of one integral, in operations for one channel / for three, set-up from a \
         quaternion included. Equation 22 evaluates the light's bands at the turned directions; of tables it reads 2l + 1 \
         values of band l instead, from cubemaps whose sides keep a bilinear read within 1 % of the band's largest value by \
         its bound, three halves a texel; what keeps reads within their faces is counted ([BANDS.md](../BANDS.md) has \
         measured sides, errors, and what is cheaper where the reflectance has one channel). The direct form turns the light and multiplies: it is cheaper than equation 22 at every \
         order. Tables are the cheapest where a read costs less than the operations of the last column but two."
            .to_owned(),
        rows_of(
            &[
                "order",
                "equation 22",
                "`shade`",
                "`shade_isotropic`",
                "tables",
                "reads",
                "bytes",
                "a read may cost",
                "equation 34",
                "`shade_zonal`",
            ],
            costs,
        ),
        format!(
            "## Convergence\n\nThree lobes of light on three reflectances, for {VIEWS} views and frames: the root mean square \
             error of the shading against a quadrature of 64,800 directions, relative to it, and what f32 adds where weights \
             and convolved light are rounded to it. M above {HOPELESS:e} is refused."
        ),
        rows_of(&["reflectance", "mother", "bands", "condition", "error", "rounding of f32"], converged),
    ];
    file("shading", "Shading by isotropic decomposition", &parts)
}

/// The plot of the conditions.
pub fn plot(shading: &Shading) -> File {
    let colour = |name: &str| PROFILES.iter().position(|mother| mother.name() == name).unwrap_or_default();
    let stroke = |row: &Conditions| match (row.shared, row.searched) {
        (true, _) => Stroke::Dashed,
        (_, true) => Stroke::Solid,
        _ => Stroke::Dotted,
    };
    let series = shading.conditions.iter().map(|row| Series {
        colour: colour(&row.mother),
        stroke: stroke(row),
        points: row.bands.iter().map(|bands| *bands as f64).zip(row.conditions.iter().copied()).collect(),
    });
    let how = |row: &Conditions| match (row.shared, row.searched) {
        (true, _) => "shared",
        (_, true) => "not shared, searched",
        _ => "not shared",
    };
    let label = |row: &Conditions| format!("{}, {}", row.mother, how(row));
    let picture = Picture {
        title: "Conditions of isotropic decomposition".to_owned(),
        subtitle: "Figure 13 of Soler et al. 2015; beyond 1e16 f64 cannot tell".to_owned(),
        size: [715.0, 520.0],
        columns: 1,
        panels: vec![Panel {
            title: String::new(),
            x: Axis::linear("highest band", 1.0, 20.0, &[1.0, 5.0, 10.0, 15.0, 20.0]),
            y: Axis::decades("condition number of M", 1.0, 1e18),
            series: series.collect(),
        }],
        keys: shading.conditions.iter().map(|row| key(&label(row), colour(&row.mother), stroke(row))).collect(),
    };
    svg::file("conditions", &picture)
}
