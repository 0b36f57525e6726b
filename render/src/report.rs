//! `docs/PICTURES.md`: what per-pixel rotation buys over simplified normal mapping, and how pictures near brute force as
//! the order grows, measured on a scene.

use crate::figures::{Errors, Inputs, Row, Truth, convergence, drawn, percent};
use crate::gpu::{Gpu, Stage};
use crate::subject::Subject;
use indicatif::ProgressBar;
use std::fmt::Write;
use zonal_codegen::environment::Map;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::method::{Judged, Method};

/// The reflectances of the paper's figure 5.
pub const BRDFS: [(&str, Brdf); 4] = [
    ("Lambert", Brdf::Lambert),
    ("Phong", Brdf::Phong { exponent: 20.0 }),
    ("Ward, isotropic", Brdf::Ward { alpha: [0.3, 0.3] }),
    ("Ward, anisotropic", Brdf::Ward { alpha: [0.3, 0.6] }),
];
/// The exponents whose pictures are followed from order to order.
pub const EXPONENTS: [f64; 3] = [5.0, 20.0, 80.0];
/// The orders that they are followed through.
pub const ORDERS: std::ops::RangeInclusive<usize> = 2..=10;
/// The reflectances that are followed under spherical lights.
pub const LIT: [Brdf; 3] = [Brdf::Lambert, Brdf::Phong { exponent: 5.0 }, Brdf::Phong { exponent: 20.0 }];
/// What stands in for the exact kernel, the last by doing nothing.
pub const METHODS: [Method; 4] = [Method::Taylor15, Method::Lf3, Method::Tilt, Method::None];
/// The size of the pictures that are measured.
const SIZE: [usize; 2] = [220, 180];
/// How many of their pixels are summed by brute force.
const POINTS: usize = 800;

/// One reflectance under one map.
#[derive(Clone, Debug)]
pub struct Case {
    /// The name of the reflectance.
    pub brdf: &'static str,
    /// The reflectance as scenes write it.
    pub text: String,
    /// Against the exact kernel's picture, by method.
    pub against_exact: [Errors; 4],
    /// Against brute force: the exact kernel, then by method.
    pub against_truth: [Errors; 5],
}

/// Everything that is measured.
#[derive(Clone, Debug)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// Its order.
    pub order: usize,
    /// How steep its normals are: the angles in degrees that half of them, nine of ten and 99 of a hundred stay below.
    pub tilts: [f64; 3],
    /// The maps and what was measured under each.
    pub maps: Vec<(String, Vec<Case>)>,
    /// The map under which pictures were followed, and the exponents' rows.
    pub convergence: (String, Vec<(f64, Vec<Row>)>),
    /// The scene with spherical lights, how many, and the rows of each of [`LIT`].
    pub lit: (String, usize, Vec<(Brdf, Vec<Row>)>),
}

/// Writes a table of what was followed from order to order, a column each: its error, and in brackets what theory expects.
fn write_followed<T>(text: &mut String, followed: &[(T, Vec<Row>)], name: impl Fn(&T) -> String) {
    let names: String = followed.iter().map(|(what, _)| format!(" `{}` |", name(what))).collect();
    let _ = writeln!(text, "| order |{names}\n|---|{}", "---|".repeat(followed.len()));
    for (i, order) in ORDERS.enumerate() {
        let cells =
            followed.iter().map(|(_, rows)| format!("{} ({})", percent(rows[i].errors.rms), percent(rows[i].expected)));
        let _ = writeln!(text, "| {order} | {} |", cells.collect::<Vec<_>>().join(" | "));
    }
}

impl Report {
    /// Measures a subject under maps, the first of which serves for the convergence, and another one, `lit`, under the
    /// spherical lights of its scene.
    ///
    /// # Errors
    ///
    /// If a shader is too long or the device fails.
    pub fn measure(
        gpu: &Gpu,
        subject: &Subject,
        maps: &[(&str, Map)],
        lit: &Subject,
        bar: &ProgressBar,
    ) -> Result<Self, Diagnostic> {
        let mut of_maps = Vec::new();
        for (name, map) in maps {
            let cases: Result<Vec<Case>, Diagnostic> =
                BRDFS.iter().map(|(title, brdf)| case(gpu, subject, title, brdf, map, bar)).collect();
            of_maps.push(((*name).to_owned(), cases?));
        }
        let mut followed = Vec::new();
        for exponent in EXPONENTS {
            let brdf = Brdf::Phong { exponent };
            bar.set_message(brdf.to_string());
            let subject = Subject { brdf, map: maps[0].1.clone(), ..subject.clone() };
            followed.push((exponent, follow(gpu, &subject, bar)?));
        }
        let mut of_lit = Vec::new();
        for brdf in LIT {
            bar.set_message(brdf.to_string());
            let rows = follow(gpu, &Subject { brdf: brdf.clone(), ..lit.clone() }, bar)?;
            of_lit.push((brdf, rows));
        }
        let slopes = subject.normals.slopes();
        let tilt = |share: f64| {
            let slope = slopes[((slopes.len() - 1) as f64 * share) as usize];
            (subject.strength * slope).atan().to_degrees()
        };
        Ok(Self {
            scene: subject.name.clone(),
            order: subject.order,
            tilts: [0.5, 0.9, 0.99].map(tilt),
            maps: of_maps,
            convergence: (maps[0].0.to_owned(), followed),
            lit: (lit.name.clone(), lit.lights.len(), of_lit),
        })
    }

    /// The page.
    pub fn markdown(&self) -> String {
        let mut text = format!(
            "# Pictures, measured\n\n\
             <!-- Generated: UPDATE=1 cargo test -p zonal-render --test report -->\n\n\
             The object, its relief and the camera are those of `scenes/{}.toml`: half of the normals lean by less than \
             {:.0} degrees, nine of ten by less than {:.0}, 99 of a hundred by less than {:.0}. Errors are means over \
             the pixels, in shares of the mean radiance; the radiance of a pixel is the norm of R, G and B.\n\n",
            self.scene, self.tilts[0], self.tilts[1], self.tilts[2]
        );
        self.write_claim(&mut text);
        self.write_convergence(&mut text);
        self.write_lit(&mut text);
        text
    }

    fn write_lit(&self, text: &mut String) {
        let (scene, count, followed) = &self.lit;
        let _ = write!(
            text,
            "\n## Under spherical lights\n\n\
             ![A teapot at night under three spheres of light]({scene}.png)\n\n\
             The picture of `scenes/{scene}.toml`: its map and {count} spheres of their own size, colour and distance, each \
             added to the map's coefficients by `light_sphere:n`. Against brute force, which sums every texel of the map \
             and many directions to each sphere, the root mean square error of the exact kernel, and in brackets what \
             theory expects. Map and spheres are seen from the middle of the object.\n\n"
        );
        write_followed(text, followed, |brdf| brdf.to_string());
    }

    fn write_claim(&self, text: &mut String) {
        let order = self.order;
        let _ = write!(
            text,
            "## What the rotation buys\n\n\
             Křivánek et al. (2005, section 4.1) turn the coefficients of the reflectance from the frame of \
             the normal map's normal to that of the surface, per pixel and approximately, and compare that with leaving \
             the turn out: *simplified normal mapping*. Order {order}. A factor says how many times smaller the error \
             is than without the turn.\n\n\
             {}\n\n\
             | method | kernel | operations |\n|---|---|---|\n",
            self.summary()
        );
        for method in Method::TURNS {
            let spec = method.spec(order).map_or_else(|| "none".to_owned(), |spec| format!("`{spec}`"));
            let _ = writeln!(text, "| {method} | {spec} | {} |", method.cost(order).total);
        }
        for (map, cases) in &self.maps {
            let _ = write!(
                text,
                "\n### Under `{map}`\n\n\
                 Against the picture of the exact kernel:\n\n\
                 | reflectance | taylor15 | lf3 | tilt | no rotation | taylor15 better by | lf3 by | tilt by |\n\
                 |---|---|---|---|---|---|---|---|\n"
            );
            for case in cases {
                let [taylor, lf3, tilt, none] = case.against_exact.map(|errors| errors.mean);
                let row = [taylor, lf3, tilt, none].map(percent).join(" | ");
                let factors = [taylor, lf3, tilt].map(|error| factor(none / error)).join(" | ");
                let _ = writeln!(text, "| {} (`{}`) | {row} | {factors} |", case.brdf, case.text);
            }
            text.push_str(
                "\nAgainst brute force, which has all bands, so that what the order leaves out is in every column:\n\n\
                 | reflectance | exact | taylor15 | lf3 | tilt | no rotation | tilt better by |\n\
                 |---|---|---|---|---|---|---|\n",
            );
            for case in cases {
                let means = case.against_truth.map(|errors| errors.mean);
                let row = means.map(percent).join(" | ");
                let _ = writeln!(text, "| {} (`{}`) | {row} | {} |", case.brdf, case.text, factor(means[4] / means[3]));
            }
        }
    }

    /// The order, between two by interpolation, at which a picture's root mean square error falls to `error`.
    pub fn order_for(rows: &[Row], error: f64) -> Option<f64> {
        rows.windows(2).find_map(|pair| {
            let [high, low] = [pair[0].errors.rms, pair[1].errors.rms].map(f64::ln);
            let place = (high - error.ln()) / (high - low);
            (0.0..=1.0).contains(&place).then(|| pair[0].order as f64 + place)
        })
    }

    /// The claim in one sentence.
    fn summary(&self) -> String {
        let span = |ratio: fn([f64; 4]) -> f64| {
            let cases = self.maps.iter().flat_map(|(_, cases)| cases);
            let ratios: Vec<f64> = cases.map(|case| ratio(case.against_exact.map(|errors| errors.mean))).collect();
            let (least, most) =
                (ratios.iter().copied().fold(f64::MAX, f64::min), ratios.iter().copied().fold(0.0, f64::max));
            format!("{} to {} times", digits(least), digits(most))
        };
        let cost = |method: Method| method.cost(self.order).total as f64;
        format!(
            "The paper's `taylor15` errs {} less than simplified normal mapping; `tilt` errs {} less than `taylor15`, \
             with {} of its operations and no trigonometry, and `lf3` {} less, with {}.",
            span(|[taylor, .., none]| none / taylor),
            span(|[taylor, _, tilt, _]| taylor / tilt),
            percent(cost(Method::Tilt) / cost(Method::Taylor15)),
            span(|[taylor, lf3, ..]| taylor / lf3),
            percent(cost(Method::Lf3) / cost(Method::Taylor15)),
        )
    }

    fn write_convergence(&self, text: &mut String) {
        let (map, followed) = &self.convergence;
        let _ = write!(
            text,
            "\n## How pictures near the truth\n\n\
             The exact kernel's picture under `{map}` against brute force on the CPU (every texel of the map times the \
             analytic reflectance, f64), for Phong lobes: the root mean square error, and in brackets what theory \
             expects, the root of Σ |b_l|² |L_l|² / (2l+1) over the bands l that are left out, averaged over the views. \
             The energy of a Phong lobe of exponent s falls with the band as exp(−l²/s), so that it needs some √s \
             bands: twice as many for four times the exponent.\n\n"
        );
        write_followed(text, followed, |exponent| format!("phong:{exponent}"));
        let half = followed.iter().map(|(_, rows)| {
            Self::order_for(rows, 0.5).map_or_else(|| "none of these".to_owned(), |order| format!("{order:.1}"))
        });
        let _ = writeln!(text, "| for 50 % | {} |", half.collect::<Vec<_>>().join(" | "));
    }
}

/// How a subject's pictures near brute force.
fn follow(gpu: &Gpu, subject: &Subject, bar: &ProgressBar) -> Result<Vec<Row>, Diagnostic> {
    let stage = Stage::new(gpu, subject, SIZE)?;
    let truth = Truth::new(&stage, POINTS, bar)?;
    convergence(&stage, &truth, ORDERS)
}

fn case(
    gpu: &Gpu,
    subject: &Subject,
    title: &'static str,
    brdf: &Brdf,
    map: &Map,
    bar: &ProgressBar,
) -> Result<Case, Diagnostic> {
    bar.set_message(brdf.to_string());
    let subject = Subject { brdf: brdf.clone(), map: map.clone(), ..subject.clone() };
    let stage = Stage::new(gpu, &subject, SIZE)?;
    let truth = Truth::new(&stage, POINTS, bar)?;
    let inputs = Inputs::new(&subject, subject.order);
    let (exact, _) = drawn(&stage, &inputs, Method::Exact, None, false)?;
    let mut against_exact = [Errors::default(); 4];
    let mut against_truth = [Errors::of(&exact, &truth.frame); 5];
    for (i, method) in METHODS.into_iter().enumerate() {
        let (frame, picture) = drawn(&stage, &inputs, method, Some(&exact), false)?;
        against_exact[i] = picture.errors;
        against_truth[i + 1] = Errors::of(&frame, &truth.frame);
    }
    Ok(Case { brdf: title, text: brdf.to_string(), against_exact, against_truth })
}

/// A factor in a table.
fn factor(value: f64) -> String {
    digits(value) + "×"
}

/// A number to two digits, or as many as it has before the point.
fn digits(value: f64) -> String {
    match value {
        v if v >= 10.0 => format!("{v:.0}"),
        v => format!("{v:.1}"),
    }
}
