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
//! | binding 3 | `light` | order² vec4: R, G, B and nothing; of a method that reads tables what their texels are multiplied by |
//! | binding 4 | `views` | [`Table`](zonal_codegen::reflectance::brdf::Table): RGBA32F, a row an elevation, stride/4 texels an azimuth |
//! | vertex locations 0 to 3 | the same | position, normal, tangent, texture coordinates, as in [`Mesh`](super::mesh::Mesh) |
//!
//! A method that reads the light's bands from tables is there in WGSL alone, and finds in group 1 what
//! [`Reads`] says; for [`Method::IsdTables`] `views` holds the weights of rotated zonal
//! harmonics.
//!
//! The result is linear radiance, negative where a lobe rings, with alpha 1.

use super::normal_map::LEAST_Z;
use crate::method::Method;
use std::f64::consts::PI;
use std::sync::OnceLock;
use tera::{Context, Tera};
use zonal_codegen::emit::bands::Reads;
use zonal_codegen::emit::dialect::Dialect;
// Names a language: pictures are drawn in these.
use zonal_codegen::emit::language::{GLSL, Target, WGSL, shader};
use zonal_codegen::emit::{Function, Limit, Module, docs};
use zonal_codegen::families::Spec;
// Names a family: the reflectance of an anisotropic surface is turned about its normal.
use zonal_codegen::families::axis::ROTATE_Z;
use zonal_codegen::families::text::usual;
use zonal_codegen::generate;
use zonal_codegen::ir::graph::Kind;
use zonal_codegen::ir::kernel::Param;

/// What the names begin with by which a shader reads the light's bands.
const TABLES: &str = "light_band";

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
        tera.add_raw_templates(zonal_templates::PICTURE.iter().copied())
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
    /// The kernels that the shader calls: the method's, and where that turns the reflectance, the rotation into the world, and
    /// for an isotropic reflectance that about z.
    pub fn specs(&self) -> Vec<Spec> {
        if self.method.reads_tables() {
            return self.method.spec(self.order).into_iter().collect();
        }
        let mut specs = vec![rotation(self.order)];
        specs.extend(self.method.spec(self.order).filter(|spec| *spec != specs[0]));
        if self.isotropic {
            specs.push(Spec::new(&ROTATE_Z, self.order));
        }
        specs
    }

    /// What reads the light's bands, for a method that does.
    fn reads(&self, target: Target) -> Result<String, Limit> {
        if !self.method.reads_tables() {
            return Ok(String::new());
        }
        // Names a language: pictures that read tables are drawn in this one.
        let (is_wgsl, fits) = (target.name == WGSL.name, self.method.orders().contains(&self.order));
        let reads = Reads { order: self.order, name: TABLES, group: 1, origin: "tables of a light's bands" };
        let text = reads.text(target).filter(|_| is_wgsl && fits);
        text.ok_or_else(|| Limit {
            spec: format!("{}:{}", self.method, self.order),
            target,
            why: "no picture reads tables so".to_owned(),
            help: "take WGSL, and an order that the method has".to_owned(),
        })
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
        context.insert("brute", &false);
        context.insert("kernels", &kernels(functions, format!("picture{}", self.order), target)?);
        context.insert("isotropic", &self.isotropic);
        context.insert("tables", &self.method.reads_tables());
        context.insert("reads", &self.reads(target)?);
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
    context.insert("brute", &false);
    context.insert("least_z", &number(LEAST_Z));
    render("picture/shade.wgsl", &context)
}

/// How many lights a row of the texture of [`brute()`] holds, two texels each.
pub const LIGHTS_A_ROW: usize = 64;

/// A shader that adds up many lights times the reflectance, with no harmonics: brute force. It is bound as
/// [`Shading::text`] says, but for binding 3, which holds what is reflected and which lights, and binding 4, the texture of
/// the lights: RGBA32F, [`LIGHTS_A_ROW`] a row, the direction and then the radiance times the solid angle. Alpha is 1 and the
/// angle in radians by which the normal map's normal leans.
///
/// The reflectances are those of [`Brdf::value`](zonal_codegen::reflectance::brdf::Brdf::value); the tests of the explorer
/// hold the one to the other.
pub fn brute(target: Target) -> String {
    let mut context = Context::new();
    context.insert("head", &["A normal-mapped surface under many lights, by brute force."]);
    context.insert("gbuffer", &false);
    context.insert("brute", &true);
    context.insert("least_z", &number(LEAST_Z));
    context.insert("pi", &number(PI));
    context.insert("two_pi", &number(2.0 * PI));
    context.insert("lights_a_row", &LIGHTS_A_ROW);
    render(&format!("picture/shade.{target}"), &context)
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
    use zonal_codegen::emit::validate::validate;

    #[test]
    fn every_shader_is_valid_wgsl() {
        for order in [2, 3, 4, 10] {
            let methods = Method::ALL.into_iter().filter(|method| method.orders().contains(&order));
            for (method, isotropic) in methods.flat_map(|method| [(method, true), (method, false)]) {
                let shading = Shading { order, method, isotropic };
                let text = shading.wgsl().expect("fits");
                validate(&WGSL, &format!("{shading:?}"), &text).unwrap_or_else(|error| panic!("{error}"));
            }
        }
        validate(&WGSL, "brute", &brute(&WGSL)).unwrap_or_else(|error| panic!("{error}"));
        validate(&WGSL, "gbuffer", &wgsl_gbuffer()).unwrap_or_else(|error| panic!("{error}"));
        for (order, method) in [(11, Method::ZhfTailored), (2, Method::IsdTables)] {
            assert!(!method.orders().contains(&order));
            let refused = Shading { order, method, isotropic: true }.reads(&WGSL).expect_err("it has no such order");
            assert!(refused.to_string().contains("no picture reads tables so"), "{refused}");
        }
    }

    #[test]
    fn every_check_is_valid_wgsl() {
        let shading = |method, isotropic| Shading { order: 5, method, isotropic };
        let specs: Vec<Spec> = Method::TURNS.into_iter().flat_map(|method| shading(method, true).specs()).collect();
        for function in generate::build(&specs) {
            let text = check(&function, &WGSL).expect("fits");
            validate(&WGSL, &function.spec.to_string(), &text).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}
