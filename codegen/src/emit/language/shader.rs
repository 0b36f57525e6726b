//! What the languages of shaders have in common: literals, components, the words of their built-in functions, and naga,
//! which checks their texts.

use crate::emit::language::expression::{Binding, Text};
use crate::emit::language::record::{Spelling, Words};
use crate::ir::op::Op;
use crate::math::exact::Exact;
use crate::math::half::Half;

/// A shader function of more statements than this is refused: compilers take seconds for it.
pub const MAX_STATEMENTS: usize = 5000;

/// The most values of a table in a shader: beyond it, compilers take long, and copies of constant arrays take more than
/// a thread has.
pub const MAX_TABLE: usize = 16384;

/// Built-in functions of the shader languages: GLSL ES allows no second function of their names. From the specifications
/// of WGSL, GLSL 4.60 and GLSL ES 3.00.
pub const FUNCTIONS: Words = Words {
    what: "a built-in function of the shader languages",
    words: "abs acos acosh all any asin asinh atan atanh barrier bitCount bitfieldExtract bitfieldInsert \
        bitfieldReverse ceil clamp cos cosh countOneBits cross dFdx dFdy degrees determinant distance dot dpdx dpdy equal \
        exp faceForward faceforward findLSB findMSB firstLeadingBit firstTrailingBit floatBitsToInt floatBitsToUint floor \
        fma fract frexp ftransform fwidth greaterThan greaterThanEqual imageAtomicAdd imageLoad imageSize imageStore \
        insertBits extractBits intBitsToFloat inverse inverseSqrt inversesqrt isinf isnan ldexp length lessThan \
        lessThanEqual log matrixCompMult max memoryBarrier min mix mod modf noise normalize not notEqual outerProduct pow \
        quantizeToF radians reflect refract reverseBits round roundEven saturate select sign sin sinh smoothstep sqrt step \
        storageBarrier tan tanh texelFetch texelFetchOffset texture textureGrad textureLod textureOffset textureProj \
        textureSize textureLoad textureSample textureStore transpose trunc uintBitsToFloat workgroupBarrier",
};

/// Returns the shortest decimal that reads back as the same f32, also through f64.
pub fn literal_of(value: f32) -> String {
    let short = format!("{value:?}");
    match short.parse::<f64>() {
        Ok(wide) if wide as f32 == value => short,
        _ => format!("{:?}", f64::from(value)),
    }
}

/// Returns a constant rounded to f32.
pub fn literal(value: &Exact) -> String {
    literal_of(value.to_f32())
}

/// Returns a constant rounded to f16, with its suffix.
pub fn half_literal(value: &Exact) -> String {
    format!("{:?}h", Half::round(value.to_f64()).to_f64() as f32)
}

/// Returns a component of a vector.
pub fn component(place: usize) -> &'static str {
    [".x", ".y", ".z", ".w"][place]
}

/// Returns what stands before and after the items of a value: a constructor.
pub fn constructor(of: &str) -> (String, &'static str) {
    (format!("{of}("), ")")
}

/// Returns the line that opens a branch where one number is at most another.
pub fn at_most(a: &str, b: &str) -> String {
    format!("if ({a} <= {b}) {{")
}

/// Returns how an operation is written, for which only the inverse square root and the selection differ.
pub fn spelling(op: &Op<()>, inverse_root: &'static str, select: fn(&[Text], of: &str) -> String) -> Spelling {
    match op {
        Op::Neg(_) | Op::Add(..) | Op::Sub(..) | Op::Mul(..) | Op::Fma(..) => Spelling::Infix,
        Op::Recip(_) => Spelling::Own(|x, _| format!("1.0 / ({})", x[0].text), Binding::Product),
        Op::Rsqrt(_) => Spelling::Call(inverse_root),
        Op::Sqrt(_) => Spelling::Call("sqrt"),
        Op::Exp2(_) => Spelling::Call("exp2"),
        Op::Log2(_) => Spelling::Call("log2"),
        Op::Abs(_) => Spelling::Call("abs"),
        Op::Min(..) => Spelling::Call("min"),
        Op::Max(..) => Spelling::Call("max"),
        Op::Select(..) => Spelling::Own(select, Binding::Atom),
    }
}

/// Validates what naga has parsed of a text.
///
/// # Errors
///
/// What naga says, with its place in the text.
#[cfg(feature = "check")]
pub fn validate(module: &naga::Module, text: &str) -> Result<(), String> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16)
        .validate(module)
        .map(|_| ())
        .map_err(|error| error.emit_to_string(text))
}
