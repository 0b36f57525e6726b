//! What the three languages write differently: types, components, literals, the few operations with a name of their
//! own. Everything else about a kernel's text is the same in all of them.

use crate::ir::eval::Number;
use crate::ir::graph::Kind;
use crate::ir::kernel::{Param, Shape};
use crate::math::exact::Exact;
use half::f16;
use std::fmt;
use std::str::FromStr;

/// A language to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Target {
    /// WebGPU's shading language.
    Wgsl,
    /// GLSL that is the same text in 4.50, 3.30 and ES 3.00.
    Glsl,
    /// Rust, generic over the scalar and the signal.
    Rust,
}

impl Target {
    /// All targets.
    pub const ALL: [Self; 3] = [Self::Wgsl, Self::Glsl, Self::Rust];

    /// Its name, which is the name of its folder too.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::Rust => "rust",
        }
    }

    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::Rust => "rs",
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Target {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|target| target.name() == text)
            .ok_or_else(|| format!("`{text}` is no target; known are wgsl, glsl, rust"))
    }
}

/// A target and whether the signal has three channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dialect {
    /// The language.
    pub target: Target,
    /// Whether the signal is a vector of three in a shader. Rust is generic over it.
    pub rgb: bool,
    /// Whether numbers are f16, in WGSL.
    pub half: bool,
}

impl Dialect {
    /// The name of a floating-point type of WGSL.
    fn float(self) -> &'static str {
        if self.half { "f16" } else { "f32" }
    }

    /// The type of one number of this kind.
    pub fn number(self, kind: Kind) -> &'static str {
        match (self.target, kind, self.rgb) {
            (Target::Rust, Kind::Scalar, _) => "T",
            (Target::Rust, Kind::Signal, _) => "V",
            (Target::Wgsl, Kind::Signal, true) if self.half => "vec3<f16>",
            (Target::Wgsl, Kind::Signal, true) => "vec3<f32>",
            (Target::Glsl, Kind::Signal, true) => "vec3",
            (Target::Wgsl, ..) => self.float(),
            (Target::Glsl, ..) => "float",
        }
    }

    /// The type of a parameter or a result.
    pub fn type_of(self, shape: Shape, kind: Kind) -> String {
        let (number, float) = (self.number(kind), self.float());
        match self.target {
            Target::Wgsl => match shape {
                Shape::Scalar => number.to_owned(),
                Shape::Vec3 => format!("vec3<{float}>"),
                Shape::Vec4 => format!("vec4<{float}>"),
                Shape::Mat3 => format!("mat3x3<{float}>"),
                Shape::Pair => format!("vec2<{float}>"),
                Shape::Pairs(n) => format!("array<vec2<{float}>, {n}>"),
                Shape::Array(n) => format!("array<{number}, {n}>"),
                Shape::Vectors(n) => format!("array<vec3<{float}>, {n}>"),
            },
            Target::Glsl => match shape {
                Shape::Scalar => number.to_owned(),
                Shape::Vec3 => "vec3".to_owned(),
                Shape::Vec4 => "vec4".to_owned(),
                Shape::Mat3 => "mat3".to_owned(),
                Shape::Pair => "vec2".to_owned(),
                Shape::Pairs(n) => format!("vec2[{n}]"),
                Shape::Array(n) => format!("{number}[{n}]"),
                Shape::Vectors(n) => format!("vec3[{n}]"),
            },
            Target::Rust => match shape {
                Shape::Scalar => number.to_owned(),
                Shape::Vec3 => format!("[{number}; 3]"),
                Shape::Vec4 => format!("[{number}; 4]"),
                Shape::Mat3 => format!("[[{number}; 3]; 3]"),
                Shape::Pair => format!("[{number}; 2]"),
                Shape::Pairs(n) => format!("[[{number}; 2]; {n}]"),
                Shape::Array(n) => format!("[{number}; {n}]"),
                Shape::Vectors(n) => format!("[[{number}; 3]; {n}]"),
            },
        }
    }

    /// A parameter in a signature; Rust takes arrays of arrays and of signals by reference.
    pub fn parameter(self, param: &Param) -> String {
        let of = self.type_of(param.shape, param.kind);
        match (self.target, param.shape) {
            (Target::Wgsl, _) => format!("{}: {of}", param.name),
            (Target::Glsl, _) => format!("{of} {}", param.name),
            (Target::Rust, Shape::Array(_) | Shape::Pairs(_) | Shape::Mat3) => format!("{}: &{of}", param.name),
            (Target::Rust, _) => format!("{}: {of}", param.name),
        }
    }

    /// Component `index`, in flat order, of a value of this shape.
    pub fn component(self, name: &str, shape: Shape, index: usize) -> String {
        let letter = |i: usize| match self.target {
            Target::Rust => format!("[{i}]"),
            _ => format!(".{}", ["x", "y", "z", "w"][i]),
        };
        match shape {
            Shape::Scalar => name.to_owned(),
            Shape::Vec3 | Shape::Vec4 | Shape::Pair => format!("{name}{}", letter(index)),
            Shape::Mat3 => format!("{name}[{}]{}", index / 3, letter(index % 3)),
            Shape::Pairs(_) => format!("{name}[{}]{}", index / 2, letter(index % 2)),
            Shape::Array(_) => format!("{name}[{index}]"),
            Shape::Vectors(_) => format!("{name}[{}]{}", index / 3, letter(index % 3)),
        }
    }

    /// What opens a constructor of this shape, how its items are grouped, and what closes it; `None` for a scalar.
    pub fn constructor(self, shape: Shape, kind: Kind) -> Option<Constructor> {
        let of = self.type_of(shape, kind);
        let (size, inner) = match shape {
            Shape::Scalar => return None,
            Shape::Pairs(_) => (2, Some(self.type_of(Shape::Pair, kind))),
            Shape::Vectors(_) => (3, Some(self.type_of(Shape::Vec3, kind))),
            Shape::Mat3 => (3, None),
            _ => (1, None),
        };
        let brackets = |of: String| match self.target {
            Target::Rust => ("[".to_owned(), "]"),
            _ => (format!("{of}("), ")"),
        };
        let (open, close) = brackets(of);
        let group = match (self.target, size) {
            (_, 1) => None,
            (Target::Rust, _) => Some(("[".to_owned(), "]")),
            _ => inner.map(brackets),
        };
        Some(Constructor { open, close, size, group })
    }

    /// A positive or negative constant.
    pub fn literal(self, value: &Exact) -> String {
        match self.target {
            Target::Rust => rust_literal(value),
            _ if self.half => format!("{:?}h", f16::nearest(value).to_f32()),
            _ => shader_literal(value.to_f32()),
        }
    }

    /// The constant that is too small to change anything but a zero.
    pub fn tiny(self) -> &'static str {
        match self.target {
            Target::Rust => "T::TINY",
            _ => "1e-15",
        }
    }

    /// 1 / √x.
    pub fn rsqrt(self, x: &str) -> String {
        match self.target {
            Target::Wgsl => format!("inverseSqrt({x})"),
            Target::Glsl => format!("inversesqrt({x})"),
            Target::Rust => format!("T::rsqrt({x})"),
        }
    }

    /// 1 / x.
    pub fn recip(self, x: &str) -> String {
        match self.target {
            Target::Rust => format!("T::recip({x})"),
            _ => format!("1.0 / ({x})"),
        }
    }

    /// The start of a line that names a value.
    pub fn binding(self, name: &str, kind: Kind) -> String {
        match self.target {
            Target::Glsl => format!("{} {name}", self.number(kind)),
            _ => format!("let {name}"),
        }
    }

    /// The parts of a constant table of scalars: what stands before the values and after.
    pub fn table(self, name: &str, shape: Shape) -> (String, &'static str) {
        let of = self.type_of(shape, Kind::Scalar);
        match self.target {
            Target::Wgsl => (format!("const {name} = {of}("), ");"),
            Target::Glsl => (format!("const {of} {name} = {of}("), ");"),
            Target::Rust => (format!("pub const {name}: {} = [", of.replace('T', "f64")), "];"),
        }
    }
}

/// How a result is put together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Constructor {
    /// What stands before the items.
    pub open: String,
    /// What stands after them.
    pub close: &'static str,
    /// How many items are one line.
    pub size: usize,
    /// What stands around each line.
    pub group: Option<(String, &'static str)>,
}

/// The shortest decimal that reads back as the same f32, also through f64.
pub fn shader_literal(value: f32) -> String {
    let short = format!("{value:?}");
    match short.parse::<f64>() {
        Ok(wide) if wide as f32 == value => short,
        _ => format!("{:?}", f64::from(value)),
    }
}

/// The nearest f64; both roundings where the f64 would not round to the nearest f32.
fn rust_literal(value: &Exact) -> String {
    let (wide, narrow) = (value.to_f64(), value.to_f32());
    match wide as f32 == narrow {
        true => format!("T::lit({wide:?})"),
        false => format!("T::lit2({narrow:?}, {wide:?})"),
    }
}
