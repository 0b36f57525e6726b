//! `zonal project`: a map's coefficients, and which order it takes for a mirror, for a diffuse surface and for one that is
//! asked about, with the reason. What draws a plot of it prints the same.

use crate::terminal::{Failure, out, out_json};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};
use zonal_codegen::emit::language;
use zonal_codegen::emit::names::{self, Use};
use zonal_codegen::emit::{Constants, Module};
use zonal_codegen::environment::{Loaded, Negative, Survey};
use zonal_codegen::fault::Fault;
use zonal_codegen::generate;
use zonal_codegen::math::convention::{self, Convention, ZONAL};
use zonal_codegen::math::index;
use zonal_codegen::plan::light;
use zonal_codegen::plan::order::{smallest, weights};
use zonal_codegen::plan::text::{percent, table};
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::reflectance::measured::Measured;
use zonal_codegen::scene::{Light, frame};

/// Maps are projected at least this far, so that what lies beyond is known.
const DEPTH: usize = 64;
/// The errors for which an order is told.
const ERRORS: [f64; 4] = [0.1, 0.05, 0.02, 0.01];
/// What coefficients are printed as, besides a table: a language, or lines of numbers.
const CSV: &str = "csv";

/// What is asked of a map.
#[derive(Clone, Debug, Args)]
pub struct Asked {
    /// The map, .hdr, .exr or .png: latitude and longitude, or a cubemap in a strip, a cross or six files, which their
    /// folder names or a pattern, as in `sky/day_*.png`.
    pub map: PathBuf,
    /// How many bands; 5 if left out, or as many as the convention has.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=64))]
    pub order: Option<u64>,
    /// Irradiance instead of radiance: the light that a diffuse surface gets, by its normal.
    #[arg(long)]
    pub irradiance: bool,
    /// Tells the orders for a surface of this reflectance too: phong:EXPONENT, ward:ALPHA, ward:ALPHA:ALPHA or measured:FILE,
    /// a tabulated one as docs/SCENE.md has them.
    #[arg(long, value_name = "BRDF", value_parser = reflectance)]
    pub brdf: Option<Brdf>,
    /// The program that takes the coefficients: its axes, signs and factors. docs/ENGINES.md says what they are. Without
    /// it, zonal's: z is up, the map's centre along +x, -y to its right, which no engine with y up has.
    #[arg(long, value_name = "NAME", value_parser = convention::names())]
    pub convention: Option<String>,
    /// Other axes: a convention's, by its name, or those to the map's centre, to the left of it and up, as in x,-z,y.
    #[arg(long, value_name = "AXES", allow_hyphen_values = true)]
    pub axes: Option<String>,
    /// Prints JSON.
    #[arg(long)]
    pub json: bool,
    /// Prints the coefficients alone, as text of a language or as lines of numbers.
    #[arg(long = "as", value_name = "FORMAT", conflicts_with = "json", value_parser = formats())]
    pub format: Option<String>,
}

fn formats() -> Vec<&'static str> {
    language::ALL.iter().map(|language| language.name).chain([CSV]).collect()
}

/// A reflectance by its text, or tabulated in a file.
fn reflectance(text: &str) -> Result<Brdf, Fault> {
    match text.strip_prefix("measured:") {
        Some(file) => Ok(Measured::read(Path::new(file))?.into()),
        None => text.parse().map_err(Fault::from),
    }
}

/// By how much every order errs of something that is seen of the light.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What is seen, in a few words.
    pub what: String,
    /// A word for it, as a key.
    pub key: &'static str,
    /// The relative rms errors of the orders from 1 on, against all bands; at most.
    pub errors: Vec<f64>,
    /// The share of each band in the energy of what is seen.
    pub shares: Vec<f64>,
}

/// What is to be found about a map that is read.
#[derive(Clone, Debug)]
pub struct Question {
    /// What coefficients are wanted of.
    pub signal: Light,
    /// How many bands.
    pub order: usize,
    /// How they are held.
    pub convention: Convention,
    /// A reflectance that is asked about.
    pub brdf: Option<Brdf>,
}

/// What was found about a map.
#[derive(Clone, Debug)]
pub struct Projected {
    /// The map with what its file said.
    pub loaded: Loaded,
    /// Its bands.
    pub survey: Survey,
    /// What its coefficients are of.
    pub signal: Light,
    /// How many bands are printed.
    pub order: usize,
    /// How they are held.
    pub convention: Convention,
    /// The coefficients.
    pub coefficients: Vec<[f64; 3]>,
    /// The light itself, diffuse light and what was asked about.
    pub curves: Vec<Curve>,
    /// Where the order is negative.
    pub negative: Negative,
}

impl Projected {
    /// Reads a map and projects it.
    ///
    /// # Errors
    ///
    /// If the map or what is asked is at fault.
    pub fn new(asked: &Asked) -> Result<Self, Failure> {
        let convention = frame::wanted(asked.convention.as_deref(), asked.axes.as_deref())?;
        let order = asked.order.map_or(convention.max_order.min(5), |order| order as usize);
        let signal = if asked.irradiance { Light::Irradiance } else { Light::Radiance };
        frame::check(&convention, signal, order)?;
        let loaded = Loaded::read(&asked.map).map_err(Fault::from)?;
        Ok(Self::of(loaded, &Question { signal, order, convention, brdf: asked.brdf.clone() }))
    }

    /// Projects a map that is read.
    pub fn of(loaded: Loaded, &Question { signal, order, convention, ref brdf }: &Question) -> Self {
        let survey = loaded.map.survey(DEPTH.max(order));
        let irradiance = survey.projection.irradiance();
        let projection = match signal {
            Light::Radiance => &survey.projection,
            Light::Irradiance => &irradiance,
        };
        let depth = projection.order;
        let light = survey.projection.spectrum();
        let curve = |what: String, key: &'static str, signal: Light, brdf: Option<&Brdf>| {
            let seen = weights(signal, brdf, depth).seen(&light, &survey.parts);
            let all = seen.energy();
            Curve { what, key, errors: seen.errors(), shares: seen.bands.iter().map(|band| band / all).collect() }
        };
        let mut curves = vec![
            curve("the light itself (a mirror)".to_owned(), "light", Light::Radiance, None),
            curve("diffuse light".to_owned(), "diffuse", Light::Irradiance, None),
        ];
        if let Some(brdf) = brdf {
            curves.push(curve(format!("what `{brdf}` reflects"), "reflected", Light::Radiance, Some(brdf)));
        }
        Self {
            coefficients: convention.convert_to(&projection.coefficients[..order * order]),
            negative: projection.negative(order),
            loaded,
            signal,
            order,
            convention,
            curves,
            survey,
        }
    }

    /// The curve of what the coefficients are of.
    pub fn own(&self) -> &Curve {
        &self.curves[usize::from(self.signal == Light::Irradiance)]
    }

    fn word(&self) -> &'static str {
        match self.signal {
            Light::Radiance => "radiance",
            Light::Irradiance => "irradiance",
        }
    }

    /// The unit of the coefficients, in words.
    fn unit(&self) -> String {
        let unit = match self.signal {
            Light::Radiance => "the map's radiance times sr^1/2",
            Light::Irradiance => "the map's radiance times sr^3/2",
        };
        match self.convention.has_own_basis() {
            true => unit.to_owned(),
            false => format!("{unit}, times the factors of `{}`", self.convention.name),
        }
    }

    /// The coefficients in their order, with their bands and degrees.
    fn rows(&self) -> impl Iterator<Item = ((usize, isize), [f64; 3])> + '_ {
        let mut places: Vec<(usize, isize)> = index::coefficients(self.order).collect();
        places.sort_by_key(|&(l, m)| self.convention.place(l, m));
        places.into_iter().zip(self.coefficients.iter().copied())
    }

    /// Prints what was asked for.
    ///
    /// # Errors
    ///
    /// If it cannot be printed.
    pub fn print(&self, asked: &Asked) -> Result<(), Failure> {
        match asked.format.as_deref() {
            Some(CSV) => out(&self.csv()),
            Some(name) => {
                let text = self.text(&asked.map, name)?;
                out(&text)
            }
            None if asked.json => out_json(&self.json(&asked.map)),
            None => out(&self.told(&asked.map)),
        }
    }

    fn csv(&self) -> String {
        let lines = self.rows().map(|((l, m), [r, g, b])| format!("{l},{m},{r:e},{g:e},{b:e}\n"));
        std::iter::once("l,m,r,g,b\n".to_owned()).chain(lines).collect()
    }

    /// The coefficients as constants of a language.
    fn text(&self, path: &Path, name: &str) -> Result<String, Failure> {
        let target = language::named(name).map_err(|message: String| Fault::new(message, ""))?;
        let name = name_of(path, "");
        let module = Module {
            origin: format!("the map `{}`", path.display()),
            constants: vec![Constants {
                name: name.clone(),
                doc: format!(
                    "The {} of `{}`: RGB coefficients of order {}, in {}. Of {} they leave out {}, against all bands. Axes: {}.",
                    self.word(),
                    path.display(),
                    self.order,
                    self.unit(),
                    self.own().what,
                    percent(self.own().errors[self.order - 1]),
                    self.convention.sentence()
                ),
                values: self.coefficients.clone(),
            }],
            name,
            ..Module::default()
        };
        Ok(generate::file(&module, target, "")?.text)
    }

    fn json(&self, path: &Path) -> serde_json::Value {
        let own = self.own();
        let energy = match self.signal {
            Light::Radiance => self.survey.projection.spectrum(),
            Light::Irradiance => self.survey.projection.irradiance().spectrum(),
        };
        let bands: Vec<_> = (0..self.order)
            .map(|l| json!({"band": l, "energy": energy.bands[l], "share": own.shares[l], "error": own.errors[l]}))
            .collect();
        let curves: Vec<_> = self
            .curves
            .iter()
            .map(|curve| {
                let orders: Vec<_> = ERRORS
                    .iter()
                    .map(|&error| json!({"error": error, "order": smallest(&curve.errors, error)}))
                    .collect();
                json!({"of": curve.key, "what": curve.what, "errors": curve.errors, "orders": orders})
            })
            .collect();
        let axes = &self.convention.axes;
        json!({
            "map": path.display().to_string(),
            "width": self.loaded.size[0],
            "height": self.loaded.size[1],
            "layout": self.loaded.layout.to_string(),
            "encoding": self.loaded.encoding,
            "signal": self.word(),
            "unit": self.unit(),
            "convention": self.convention.name,
            "axes": {
                "centre": axes.centre().to_string(),
                "right": axes.right().to_string(),
                "up": axes.up().to_string(),
            },
            "order": self.order,
            "energy": energy.energy(),
            "lamps": self.survey.lamps,
            "negative": self.negative,
            "seen": curves,
            "bands": bands,
            "coefficients": self.coefficients,
        })
    }

    fn told(&self, path: &Path) -> String {
        let [width, height] = self.loaded.size;
        let others = match self.convention == ZONAL {
            true => "; for normals of three.js: `--axes three_js`, for its shader: `--convention three_js`",
            false => "",
        };
        let mut text = format!(
            "{}: {width} x {height}, {}; {}, {}\nAxes: {}{others}.\n\nWhich order? An error is a root mean square, \
             relative to what is seen of the light with all of its bands.\n",
            path.display(),
            self.word(),
            self.loaded.layout,
            self.loaded.encoding,
            self.convention.sentence()
        );
        let mut orders = vec![
            std::iter::once("order for an error of at most".to_owned()).chain(ERRORS.map(percent)).collect::<Vec<_>>(),
        ];
        for curve in &self.curves {
            let of = |error: f64| match smallest(&curve.errors, error) {
                Some(order) => order.to_string(),
                None => format!("> {}", curve.errors.len()),
            };
            orders.push(std::iter::once(curve.what.clone()).chain(ERRORS.map(of)).collect());
        }
        text += &format!("\n{}\n", table(&orders));
        let own = self.own();
        let mut sentences: Vec<String> = light::lamps(&self.survey.lamps).into_iter().collect();
        sentences.push(format!(
            "Of {}, order {} leaves out {}",
            own.what,
            self.order,
            percent(own.errors[self.order - 1])
        ));
        let what = match self.signal {
            Light::Radiance => "The radiance",
            Light::Irradiance => "The irradiance",
        };
        sentences.push(light::negative(what, self.order, &self.negative));
        text += &sentences.into_iter().map(|sentence| format!("{sentence}.\n")).collect::<String>();

        let head = ["band".to_owned(), format!("share of the energy of {}", own.what)].into_iter();
        let errors = self.curves.iter().map(|curve| format!("error of {} if it is the last", curve.what));
        let mut lines = vec![head.chain(errors).collect::<Vec<_>>()];
        for l in 0..self.order {
            let errors = self.curves.iter().map(|curve| percent(curve.errors[l]));
            lines.push([l.to_string(), percent(own.shares[l])].into_iter().chain(errors).collect());
        }
        let largest = self.coefficients.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
        let mut values = vec![["l", "m", "R", "G", "B"].map(str::to_owned).to_vec()];
        for ((l, m), rgb) in self.rows() {
            let [r, g, b] = rgb.map(|value| figure(value, largest));
            values.push(vec![l.to_string(), m.to_string(), r, g, b]);
        }
        text += &format!("\n{}\nThe coefficients, in {}:\n\n{}", table(&lines), self.unit(), table(&values));
        text
    }
}

/// Returns a name for what is made of a map that every language takes: that of its file, if it can be one with an `ending`.
pub fn name_of(path: &Path, ending: &str) -> String {
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().to_lowercase());
    let stem: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let names = [format!("{stem}{ending}"), format!("{stem}_map{ending}")];
    let known = names.into_iter().find(|name| names::fault(name, Use::Item, &language::ALL).is_none());
    known.unwrap_or_else(|| format!("environment{ending}"))
}

/// A number with six digits of the largest beside it: with a point where that is read easily, else with an exponent.
fn figure(value: f64, largest: f64) -> String {
    match largest {
        0.0 => "0".to_owned(),
        _ if (1e-3..1e6).contains(&largest) => {
            let decimals = (5.0 - largest.log10().floor()).clamp(0.0, 9.0) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.5e}"),
    }
}
