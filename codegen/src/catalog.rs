//! The checked-in set: every family at every order from 2 to 10, as files in three languages, with a table of costs.

use crate::emit::dialect::Target;
use crate::emit::validate::validate;
use crate::emit::{Function, Module, support};
use crate::families::spec::{Family, Form, Method, Spec};
use crate::families::y_rotation::Small;
use crate::files::File;
use crate::generate::{GenerateError, Row, build, file};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// The orders of the checked-in set.
pub const ORDERS: RangeInclusive<usize> = 2..=10;

/// The table of costs in the checked-in set.
pub const COSTS: &str = "COSTS.md";

/// The bands that irradiance has below order 5: the cosine lobe has no band 3.
pub const IRRADIANCE_BANDS: [usize; 4] = [0, 1, 2, 4];

/// Every spec of the checked-in set, sorted by order.
pub fn standard() -> Vec<Spec> {
    ORDERS.flat_map(of_order).collect()
}

fn of_order(order: usize) -> Vec<Spec> {
    let small = |method: Small| vec![method; order - 1];
    let mut specs = vec![Spec::new(Family::Basis, order), Spec::new(Family::Angles, order)];
    let mut families = vec![
        Family::Eval,
        Family::RotateZ,
        Family::RotateY,
        Family::SwapYz,
        Family::RotateXPlus90,
        Family::RotateXMinus90,
        Family::Rotate(Method::Zyz),
        Family::Rotate(Method::Euler),
        Family::Rotate(Method::Angles),
        Family::Rotate(Method::Zxzxz),
        Family::Rotate(Method::Align),
        Family::Rotate(Method::Zonal),
        Family::Tilt(Small::Lf3.from_band_3(order)),
        Family::RotateSmall(Small::Lf3.from_band_3(order)),
        Family::EvalMonomial,
        Family::ToMonomial,
        Family::Zhf,
        Family::ZhfWeights,
        Family::ZhfTailored,
    ];
    for (method, _) in Small::ALL {
        families.push(Family::SmallY(small(method)));
        families.push(Family::Rotate(Method::Small(small(method))));
    }
    if order <= 3 {
        families.push(Family::Rotate(Method::Tensor));
        families.push(Family::Rotate(Method::Matrix));
    }
    if order > 2 {
        specs.push(Spec::new(Family::Lifted, order));
        families.push(Family::Rotate(Method::Lifted));
    }
    if order > 3 {
        families.push(Family::TiltScale);
        families.push(Family::TiltUnscale);
        for method in [Small::Lf3, Small::Lf5] {
            families.push(Family::TiltPrescaled(method.from_band_3(order)));
        }
        families.push(Family::Tilt(Small::Lf5.from_band_3(order)));
        families.push(Family::RotateSmall(Small::Lf5.from_band_3(order)));
        families.push(Family::RotateAdaptive(Small::Lf3.from_band_3(order)));
    }
    for family in families {
        let spec = Spec::new(family, order);
        specs.push(spec.clone());
        specs.push(spec.rgb());
    }
    if order == 5 {
        let spec = Spec { bands: IRRADIANCE_BANDS.to_vec(), ..Spec::new(Family::Eval, order) };
        specs.push(spec.clone());
        specs.push(spec.rgb());
    }
    let mixed = Family::SmallY([vec![Small::Taylor15; 3], vec![Small::Taylor1]].concat());
    if order == 5 {
        // Paper 000's own mixture.
        specs.push(Spec::new(mixed, order));
    }
    for family in [Family::Basis, Family::Rotate(Method::Zyz), Family::SmallY(small(Small::Taylor15))] {
        let spec = Spec { form: Form::Loop, ..Spec::new(family, order) };
        specs.push(spec.clone());
        if spec.family != Family::Basis {
            specs.push(spec.rgb());
        }
    }
    specs
}

/// The table of costs as Markdown.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = "# What each kernel costs\n\nGenerated with the kernels. A multiplication, an addition or a fused \
                    multiply-add is one operation; an inverse\nsquare root or a reciprocal (special) is counted apart. \
                    Rounding is in f32, relative to what each file's head says, and proven.\n\n\
                    | spec | total | mul | add | fma | special | constants | live | f32 rounding |\n\
                    |---|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for row in rows {
        let (cost, footprint) = (row.cost, row.footprint);
        text += &format!(
            "| `{}` | {} | {} | {} | {} | {} | {} | {} | {:e} |\n",
            row.spec,
            cost.total,
            cost.mul,
            cost.add,
            cost.fma,
            cost.special,
            footprint.constants,
            footprint.live,
            row.accuracy.rounding_f32
        );
    }
    text
}

/// Every file of `generated/`.
///
/// # Errors
///
/// If a kernel is too long or its text is refused: a fault of zonal.
pub fn files() -> Result<Vec<File>, GenerateError> {
    files_of(&build(&standard()))
}

/// The files of some functions, laid out as those of `generated/` are.
///
/// # Errors
///
/// If a kernel is too long or its text is refused: a fault of zonal.
pub fn files_of(functions: &[Function]) -> Result<Vec<File>, GenerateError> {
    let orders: BTreeSet<usize> = functions.iter().map(|function| function.spec.order).collect();
    let shaders: Result<Vec<Vec<File>>, GenerateError> = functions
        .par_iter()
        .map(|function| {
            let (stem, order) = (function.spec.stem(), function.spec.order);
            let module = Module {
                name: function.shader_name(),
                origin: format!("`{}`", function.spec),
                functions: vec![function.clone()],
                constants: vec![],
            };
            [Target::Wgsl, Target::Glsl]
                .into_iter()
                .map(|target| {
                    let extension = target.extension();
                    file(&module, target, format!("{target}/sh{order}/{stem}.{extension}"))
                })
                .collect()
        })
        .collect();
    let mut files: Vec<File> = shaders?.into_iter().flatten().collect();
    let rust: Result<Vec<File>, GenerateError> =
        orders.par_iter().map(|&order| rust_file(order, functions)).collect();
    files.extend(rust?);
    files.extend(rust_frame(&orders, functions));
    let rows: Vec<Row> = functions.iter().map(Row::of).collect();
    files.push(File { path: COSTS.to_owned(), text: markdown(&rows) });
    files.sort();
    Ok(files)
}

fn rust_file(order: usize, functions: &[Function]) -> Result<File, GenerateError> {
    let module = Module {
        name: format!("sh{order}"),
        origin: format!("the standard catalogue, order {order}"),
        functions: functions.iter().filter(|function| function.spec.order == order).cloned().collect(),
        constants: vec![],
    };
    let path = format!("rust/sh{order}.rs");
    let text = module.rust_file();
    validate(Target::Rust, &path, &text)?;
    Ok(File { path, text })
}

/// The module that ties the orders together, what they stand on, and the shaders as text.
fn rust_frame(orders: &BTreeSet<usize>, functions: &[Function]) -> Vec<File> {
    let head = "// @generated by zonal from the standard catalogue; do not edit, generate it again.\n\n";
    let mut root = format!("{head}pub mod real;\n#[cfg(feature = \"shaders\")]\npub mod shaders;\n");
    for order in orders {
        root += &format!(
            "/// Kernels of order {order}: bands 0 to {}, {} coefficients.\npub mod sh{order};\n",
            order - 1,
            order * order
        );
    }
    let mut shaders = format!(
        "{head}//! The shader texts of the standard catalogue.\n\n\
         /// A kernel's text in both shader languages.\n\
         #[derive(Clone, Copy, Debug, PartialEq, Eq)]\n\
         pub struct Shader {{\n\
         \x20   /// The spec that makes it.\n    pub spec: &'static str,\n\
         \x20   /// The function's name.\n    pub name: &'static str,\n\
         \x20   /// WGSL.\n    pub wgsl: &'static str,\n\
         \x20   /// GLSL for 4.50, 3.30 and ES 3.00, without a version of its own.\n    pub glsl: &'static str,\n}}\n"
    );
    let mut all = String::new();
    for function in functions {
        let (spec, name) = (&function.spec, function.shader_name());
        let (order, stem) = (spec.order, spec.stem());
        let constant = name.to_uppercase();
        shaders += &format!(
            "\n/// `{spec}`.\npub const {constant}: Shader = Shader {{\n    spec: \"{spec}\",\n    name: \"{name}\",\n    \
             wgsl: include_str!(\"../wgsl/sh{order}/{stem}.wgsl\"),\n    \
             glsl: include_str!(\"../glsl/sh{order}/{stem}.glsl\"),\n}};\n"
        );
        all += &format!("    {constant},\n");
    }
    shaders += &format!("\n/// All of them, by order.\npub const ALL: &[Shader] = &[\n{all}];\n");
    let real = format!("{head}//! What the kernels are generic over.\n\n{}", support::real(support::Std::ByFeature));
    [("rust/mod.rs", root), ("rust/shaders.rs", shaders), ("rust/real.rs", real)]
        .map(|(path, text)| File { path: path.to_owned(), text })
        .to_vec()
}
