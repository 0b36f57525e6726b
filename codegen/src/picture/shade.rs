//! Whole shaders around the kernels: a normal-mapped surface under a distant light, as Křivánek et al. 2005 shade it
//! (section 4.1). Per pixel the coefficients of the reflectance are looked up for the view in the frame of the normal
//! map's normal, turned into the frame of the surface by the method that is asked for, then exactly into the world, and
//! multiplied with those of the light. (The paper turns the light into the frame of each vertex and interpolates it;
//! here no error of interpolation is mixed with that of the method.)
//!
//! The templates hold what surrounds the kernels and no coefficient. What a host binds:
//!
//! | WGSL, group 0 | GLSL ES 3.00 | what |
//! |---|---|---|
//! | binding 0 | `clip`, `eye`, `strength` | the camera, and what the slopes of the normal map are multiplied by |
//! | bindings 1, 2 | `normals` | the normal map, (n + 1)/2, repeated and filtered |
//! | binding 3 | `light` | order² vec4: R, G, B and nothing |
//! | binding 4 | `views` | [`Table`](super::brdf::Table): RGBA32F, a row an elevation, stride/4 texels an azimuth |
//! | vertex locations 0 to 3 | the same | position, normal, tangent, texture coordinates, as in [`Mesh`](super::mesh::Mesh) |
//!
//! The result is linear radiance, negative where a lobe rings, with alpha 1.

use super::normal_map::LEAST_Z;
use crate::emit::dialect::Dialect;
use crate::emit::language::{GLSL, Target, WGSL, shader};
use crate::emit::{Function, Limit, Module, docs};
use crate::families::about_y::SMALL_ZYZ;
use crate::families::axis::ROTATE_Z;
use crate::families::text::{hint, usual};
use crate::families::tilt::TILT;
use crate::families::{SmallAngle, Spec};
use crate::generate;
use crate::ir::graph::Kind;
use crate::ir::kernel::Param;
use crate::ir::listing::Cost;
use crate::promise::law;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;
use tera::{Context, Tera};

/// How the coefficients of the reflectance are turned from the frame of the normal map's normal into that of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// `rotate`, by the quaternion of the shortest rotation.
    Exact,
    /// `tilt`, from the normal alone.
    Tilt,
    /// `tilt:n:lf5`, likewise, by five shears.
    Tilt5,
    /// `rotate:n:lf3`, from the phases of the shortest rotation and its angle.
    Lf3,
    /// `rotate:n:taylor15`, likewise.
    Taylor15,
    /// Not at all: the normal map only changes which reflectance is looked up ("simplified normal mapping").
    None,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 6] = [Self::Exact, Self::Tilt, Self::Tilt5, Self::Lf3, Self::Taylor15, Self::None];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Tilt => "tilt",
            Self::Tilt5 => "tilt5",
            Self::Lf3 => "lf3",
            Self::Taylor15 => "taylor15",
            Self::None => "none",
        }
    }

    /// The kernel of an order, if it is one.
    pub fn spec(self, order: usize) -> Option<Spec> {
        // Names a family: these are the ways that a picture compares.
        match self {
            Self::Exact => Some(rotation(order)),
            Self::Tilt => Some(Spec::new(&TILT, order)),
            Self::Tilt5 => Some(Spec::new(&TILT, order).by(SmallAngle::Lf5)),
            Self::Lf3 => Some(Spec::new(&SMALL_ZYZ, order)),
            Self::Taylor15 => Some(Spec::new(&SMALL_ZYZ, order).by(SmallAngle::Taylor15)),
            Self::None => None,
        }
    }

    /// What the kernel of an order costs.
    pub fn cost(self, order: usize) -> Cost {
        self.spec(order).map_or_else(Cost::default, |spec| spec.code().cost(1))
    }

    /// For each angle in radians between the two normals, the error of each band as a spectral norm.
    pub fn band_errors(self, order: usize, angles: &[f64]) -> Vec<Vec<f64>> {
        match self.spec(order) {
            Some(spec) => by_law(&spec, angles, |error| error.max),
            None => left_out(order, angles, |shares| shares.iter().copied().fold(0.0, f64::max).sqrt()),
        }
    }

    /// The same as a root mean square over all signals.
    pub fn typical_band_errors(self, order: usize, angles: &[f64]) -> Vec<Vec<f64>> {
        match self.spec(order) {
            Some(spec) => by_law(&spec, angles, |error| error.mean),
            None => left_out(order, angles, |shares| (shares.iter().sum::<f64>() / shares.len() as f64).sqrt()),
        }
    }

    /// The largest error of any band at an angle in radians.
    pub fn error(self, order: usize, angle: f64) -> f64 {
        self.band_errors(order, &[angle])[0].iter().copied().fold(0.0, f64::max)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name);
        let found = Self::ALL.into_iter().find(|method| method.name() == text);
        found.ok_or_else(|| format!("`{text}` is no way to turn coefficients; {}", hint(text, &names)))
    }
}

/// One of the errors of each band, at each angle.
fn by_law(spec: &Spec, angles: &[f64], which: fn(&law::Error) -> f64) -> Vec<Vec<f64>> {
    angles.iter().map(|&angle| law::errors(spec, angle).iter().map(which).collect()).collect()
}

/// What leaving a rotation out does to each band: its eigenvalues are e^{imβ}, and `norm` is given the squares of their
/// distances from 1.
fn left_out(order: usize, angles: &[f64], norm: fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
    let square = |m: isize, angle: f64| 4.0 * (0.5 * m as f64 * angle).sin().powi(2);
    let band = |l: isize, angle: f64| norm(&(-l..=l).map(|m| square(m, angle)).collect::<Vec<f64>>());
    angles.iter().map(|&angle| (0..order as isize).map(|l| band(l, angle)).collect()).collect()
}

/// The exact rotation from a quaternion.
fn rotation(order: usize) -> Spec {
    // Names a family: a picture's exact way.
    usual("rotate", order, false)
}

/// What a shader is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Shading {
    /// The order of the reflectance and of the light, within that of unrolled kernels.
    pub order: usize,
    /// How coefficients are turned.
    pub method: Method,
    /// Whether the reflectance is: then the table has one azimuth.
    pub isotropic: bool,
}

fn templates() -> &'static Tera {
    static TEMPLATES: OnceLock<Tera> = OnceLock::new();
    TEMPLATES.get_or_init(|| {
        let mut tera = Tera::default();
        tera.add_raw_templates([
            ("picture/head", include_str!("../../templates/picture/head.tera")),
            ("picture/shade.wgsl", include_str!("../../templates/picture/shade.wgsl.tera")),
            ("picture/shade.glsl", include_str!("../../templates/picture/shade.glsl.tera")),
            ("picture/vertex.glsl", include_str!("../../templates/picture/vertex.glsl.tera")),
            ("picture/check.wgsl", include_str!("../../templates/picture/check.wgsl.tera")),
            ("picture/check.glsl", include_str!("../../templates/picture/check.glsl.tera")),
        ])
        .expect("the templates parse: a test renders each");
        tera
    })
}

fn render(template: &str, context: &Context) -> String {
    templates().render(template, context).expect("the context has what the template names")
}

fn number(x: f64) -> String {
    shader::literal_of(x as f32)
}

fn kernels(functions: Vec<Function>, name: String, target: Target) -> Result<String, Limit> {
    let specs: Vec<String> = functions.iter().map(|function| format!("`{}`", function.spec)).collect();
    Module { name, origin: specs.join(", "), functions, ..Module::default() }.text(target)
}

impl Shading {
    /// The kernels that the shader calls: the method's, the rotation into the world, and for an isotropic reflectance
    /// that about z.
    pub fn specs(&self) -> Vec<Spec> {
        let mut specs = vec![rotation(self.order)];
        specs.extend(self.method.spec(self.order).filter(|spec| *spec != specs[0]));
        if self.isotropic {
            specs.push(Spec::new(&ROTATE_Z, self.order));
        }
        specs
    }

    fn head(&self) -> Vec<String> {
        let Self { order, method, isotropic } = *self;
        let surface = if isotropic { "isotropic" } else { "anisotropic" };
        docs::wrap(&format!("A normal-mapped surface, {surface}, order {order}, method {method}."), 0)
    }

    /// `functions` holds the kernels, others perhaps among them.
    fn context(&self, functions: &[Function], target: Target) -> Result<Context, Limit> {
        let of = |spec: &Spec| functions.iter().find(|function| function.spec == *spec).cloned();
        let functions = self.specs().iter().filter_map(of).collect();
        let size = self.order * self.order;
        let name = |spec: Option<Spec>| spec.map_or_else(String::new, |spec| spec.name());
        let values: Vec<String> = (0..size).map(|i| format!("v{}.{}", i / 4, ["x", "y", "z", "w"][i % 4])).collect();
        let chunks = values.chunks(4);
        let last = chunks.len() - 1;
        let rows = chunks.enumerate().map(|(i, row)| format!("{}{}", row.join(", "), if i < last { "," } else { "" }));
        let mut context = Context::new();
        context.insert("head", &self.head());
        context.insert("gbuffer", &false);
        context.insert("kernels", &kernels(functions, format!("picture{}", self.order), target)?);
        context.insert("isotropic", &self.isotropic);
        context.insert("method", self.method.name());
        context.insert("rotate", &rotation(self.order).name());
        context.insert("kernel", &name(self.method.spec(self.order)));
        context.insert("rotate_z", &Spec::new(&ROTATE_Z, self.order).name());
        context.insert("size", &size);
        context.insert("indices", &(0..size).collect::<Vec<_>>());
        context.insert("texels", &(0..size.div_ceil(4)).collect::<Vec<_>>());
        context.insert("values", &rows.collect::<Vec<_>>());
        context.insert("least_z", &number(LEAST_Z));
        context.insert("half_pi", &number(0.5 * PI));
        context.insert("two_pi", &number(2.0 * PI));
        Ok(context)
    }

    /// A WGSL module with the entry points `vertex` and `fragment`, or a fragment shader in GLSL ES 3.00, with which
    /// [`glsl_vertex`] goes. `functions` holds the [`Shading::specs`] as [`generate::build`] makes them, others perhaps
    /// among them.
    ///
    /// # Errors
    ///
    /// If a kernel is too long for compilers.
    pub fn text(&self, functions: &[Function], target: Target) -> Result<String, Limit> {
        Ok(render(&format!("picture/shade.{target}"), &self.context(functions, target)?))
    }

    /// [`Shading::text`] in WGSL, its kernels built for it alone.
    ///
    /// # Errors
    ///
    /// If a kernel is too long for compilers.
    pub fn wgsl(&self) -> Result<String, Limit> {
        self.text(&generate::build(&self.specs()), &WGSL)
    }

    /// [`Shading::text`] in GLSL ES 3.00, its kernels built for it alone.
    ///
    /// # Errors
    ///
    /// If a kernel is too long for compilers.
    pub fn glsl_fragment(&self) -> Result<String, Limit> {
        self.text(&generate::build(&self.specs()), &GLSL)
    }
}

/// The vertex shader in GLSL ES 3.00, the same for all.
pub fn glsl_vertex() -> String {
    let mut context = Context::new();
    context.insert("head", &["A normal-mapped surface: its vertices."]);
    render("picture/vertex.glsl", &context)
}

/// A WGSL module with the entry points `vertex` and `fragment` that writes what is known of each point before it is
/// shaded, into three RGBA32F targets: the quaternion from the surface's frame to the world, the normal map's normal in
/// that frame (with 1 where there is a surface), the direction to the eye in that frame.
pub fn wgsl_gbuffer() -> String {
    let mut context = Context::new();
    context.insert("head", &["What is known of a normal-mapped surface before it is shaded."]);
    context.insert("gbuffer", &true);
    context.insert("least_z", &number(LEAST_Z));
    render("picture/shade.wgsl", &context)
}

/// A shader that runs a kernel on many inputs: fragment (x, y) writes numbers 4x to 4x + 3 of the result for the inputs in
/// row y of the texture `inputs`, the numbers of all parameters one after the other.
///
/// # Errors
///
/// If the kernel is too long for compilers.
pub fn check(function: &Function, target: Target) -> Result<String, Limit> {
    let dialect = Dialect::new(target);
    let mut places = 0..;
    let mut next = || {
        let place = places.next().unwrap_or(0);
        format!("v{}.{}", place / 4, ["x", "y", "z", "w"][place % 4])
    };
    let mut argument = |param: &Param| {
        let items: Vec<String> = (0..param.shape.len()).map(|_| next()).collect();
        dialect.argument(param.shape, Kind::Scalar, &items)
    };
    let params = function.built.code.params();
    let arguments: Vec<String> = params.iter().map(&mut argument).collect();
    let count: usize = params.iter().map(|param| param.shape.len()).sum();
    let name = function.shader_name();
    let mut context = Context::new();
    context.insert("head", &[format!("Runs `{}` on many inputs.", function.spec)]);
    context.insert("kernels", &kernels(vec![function.clone()], name.clone(), target)?);
    context.insert("texels", &(0..count.div_ceil(4)).collect::<Vec<_>>());
    context.insert("call", &format!("{name}({})", arguments.join(", ")));
    context.insert("last", &(function.built.code.result().0.len() - 1));
    Ok(render(&format!("picture/check.{target}"), &context))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalog::ORDERS;
    use crate::emit::validate::validate;

    #[test]
    fn every_shader_is_valid_wgsl() {
        for order in [2, 3, 4, 10] {
            for (method, isotropic) in Method::ALL.into_iter().flat_map(|method| [(method, true), (method, false)]) {
                let shading = Shading { order, method, isotropic };
                let text = shading.wgsl().expect("fits");
                validate(&WGSL, &format!("{shading:?}"), &text).unwrap_or_else(|error| panic!("{error}"));
            }
        }
        validate(&WGSL, "gbuffer", &wgsl_gbuffer()).unwrap_or_else(|error| panic!("{error}"));
    }

    #[test]
    fn every_check_is_valid_wgsl() {
        let shading = |method, isotropic| Shading { order: 5, method, isotropic };
        let specs: Vec<Spec> = Method::ALL.into_iter().flat_map(|method| shading(method, true).specs()).collect();
        for function in generate::build(&specs) {
            let text = check(&function, &WGSL).expect("fits");
            validate(&WGSL, &function.spec.to_string(), &text).unwrap_or_else(|error| panic!("{error}"));
        }
    }

    #[test]
    fn methods_read_back_and_tell_their_cost_and_error() {
        for method in Method::ALL {
            assert_eq!(method.to_string().parse(), Ok(method));
        }
        let wrong = "tillt".parse::<Method>().expect_err("misspelt");
        assert!(wrong.contains("did you mean `tilt`"), "{wrong}");
        for order in ORDERS {
            let angle = 0.2;
            assert!(Method::Exact.error(order, angle) == 0.0 && Method::None.cost(order).total == 0);
            assert!(Method::Tilt.cost(order).total < Method::Exact.cost(order).total, "{order}");
            // Below half a turn of the last band its error is the largest.
            let none = 2.0 * (0.5 * (order - 1) as f64 * angle).sin();
            assert!((Method::None.error(order, angle) - none).abs() < 1e-12, "{order}");
            for method in [Method::Tilt, Method::Lf3, Method::Taylor15] {
                assert!(method.error(order, angle) < none, "{method} {order}");
            }
        }
    }

    #[test]
    fn the_error_of_leaving_a_turn_out_is_that_of_its_matrix() {
        use crate::ir::eval::{Contraction, Program};
        use crate::ir::listing::Listing;
        let order = 5;
        let program = Program::<f64>::new(&Listing::new(&Spec::new(&crate::families::axis::ROTATE_Y, order).kernel()));
        for angle in [0.1f64, 0.5, 1.0, 1.5] {
            let errors = &Method::None.band_errors(order, &[angle])[0];
            let typical = &Method::None.typical_band_errors(order, &[angle])[0];
            for l in 1..order {
                let columns: Vec<Vec<f64>> = (l * l..(l + 1) * (l + 1))
                    .map(|j| {
                        let mut unit = vec![0.0; order * order];
                        unit[j] = 1.0;
                        let turned = program.run(&[&[angle.cos(), angle.sin()], &unit], Contraction::Separate);
                        (l * l..(l + 1) * (l + 1)).map(|i| turned[i] - unit[i]).collect()
                    })
                    .collect();
                let norm = crate::math::linear::spectral_norm(&columns);
                assert!((errors[l] - norm).abs() < 1e-9, "{l} {angle}: {} {norm}", errors[l]);
                let square = columns.iter().flatten().map(|x| x * x).sum::<f64>() / columns.len() as f64;
                assert!((typical[l] - square.sqrt()).abs() < 1e-12, "{l} {angle}: {} {square}", typical[l]);
            }
        }
    }
}
