//! Names that all three languages take and naga keeps: tables of what is reserved, and one check. Sources: the WGSL
//! specification (keywords, reserved words, predeclared types and functions), the GLSL 4.60 and GLSL ES 3.00
//! specifications (sections 3.6 to 3.8 and the built-in functions), the Rust reference (keywords).

/// Keywords and reserved words of WGSL, and the predeclared types whose names end in a letter.
const WGSL: &str = "NULL Self abstract active alias alignas alignof array as asm asm_fragment async atomic attribute auto \
    await become binding_array bitcast bool break case cast catch class co_await co_return co_yield coherent \
    column_major common compile compile_fragment concept const const_assert const_cast consteval constexpr constinit \
    continue continuing crate debugger decltype default delete demote demote_to_helper diagnostic discard do \
    dynamic_cast else enable enum explicit export extends extern external fallthrough false filter final finally fn \
    for friend from fxgroup get goto groupshared highp if impl implements import inline instanceof interface layout \
    let loop lowp macro macro_rules match mediump meta mod module move mut mutable namespace new nil noexcept noinline \
    nointerpolation non_coherent noncoherent noperspective null nullptr of operator override package packoffset \
    partial partition pass patch pixelfragment precise precision premerge priv protected ptr pub public readonly ref regardless \
    register reinterpret_cast require requires resource restrict return self set shared sizeof smooth snorm static \
    static_assert static_cast std struct subroutine super switch target template this thread_local throw trait true \
    try type typedef typeid typename typeof union unless unorm unsafe unsized use using var varying virtual volatile \
    wgsl where while with writeonly yield";

/// Keywords and reserved words of GLSL whose names end in a letter, but for the opaque types.
const GLSL: &str = "active asm atomic_uint attribute bool break buffer case cast centroid class coherent common const \
    continue default discard do double else enum extern external false filter fixed flat float for goto half highp if \
    in inline inout input int interface invariant layout long lowp main mediump namespace noinline noperspective out \
    output partial patch precise precision public readonly resource restrict return sample sampler samplerShadow \
    shared short sizeof smooth static struct subroutine superp switch template this true typedef uint uniform union \
    unsigned using varying void volatile while writeonly defined";

/// What GLSL's opaque types begin with, after an `i` or a `u` perhaps, and what they end in.
const GLSL_OPAQUE: ([&str; 5], [&str; 14]) = (
    ["sampler", "image", "texture", "subpassInput", "imageBuffer"],
    [
        "1D",
        "2D",
        "3D",
        "Cube",
        "Rect",
        "Array",
        "Buffer",
        "MS",
        "Shadow",
        "1DArray",
        "2DArray",
        "CubeArray",
        "2DRect",
        "2DMS",
    ],
);

/// Keywords and reserved words of Rust.
const RUST: &str = "Self abstract as async await become box break const continue crate do dyn else enum extern false \
    final fn for gen if impl in let loop macro match mod move mut override priv pub ref return self static struct \
    super trait true try type typeof unsafe unsized use virtual where while yield";

/// Built-in functions of the shader languages: GLSL ES allows no second function of their names.
const FUNCTIONS: &str = "abs acos acosh all any asin asinh atan atanh barrier bitCount bitfieldExtract bitfieldInsert \
    bitfieldReverse ceil clamp cos cosh countOneBits cross dFdx dFdy degrees determinant distance dot dpdx dpdy equal \
    exp faceForward faceforward findLSB findMSB firstLeadingBit firstTrailingBit floatBitsToInt floatBitsToUint floor \
    fma fract frexp ftransform fwidth greaterThan greaterThanEqual imageAtomicAdd imageLoad imageSize imageStore \
    insertBits extractBits intBitsToFloat inverse inverseSqrt inversesqrt isinf isnan ldexp length lessThan \
    lessThanEqual log matrixCompMult max memoryBarrier min mix mod modf noise normalize not notEqual outerProduct pow \
    quantizeToF radians reflect refract reverseBits round roundEven saturate select sign sin sinh smoothstep sqrt step \
    storageBarrier tan tanh texelFetch texelFetchOffset texture textureGrad textureLod textureOffset textureProj \
    textureSize textureLoad textureSample textureStore transpose trunc uintBitsToFloat workgroupBarrier";

/// What a name is for, which decides how strict its check is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// A function or a constant, whose name must survive every compiler.
    Item,
    /// The stem of files, which is part of an include guard too.
    Stem,
}

/// The language that reserves a word, if one does, and as what.
fn reserved(name: &str) -> Option<&'static str> {
    let holds = |table: &str| table.split_whitespace().any(|word| word == name);
    let tables = [
        (WGSL, "reserved in WGSL"),
        (GLSL, "reserved in GLSL"),
        (RUST, "reserved in Rust"),
        (FUNCTIONS, "a built-in function of the shader languages"),
    ];
    if let Some((_, why)) = tables.into_iter().find(|(table, _)| holds(table)) {
        return Some(why);
    }
    let bare = name.strip_prefix(['i', 'u']).unwrap_or(name);
    let (heads, tails) = GLSL_OPAQUE;
    let is_opaque =
        |text: &str| heads.iter().any(|head| text.strip_prefix(head).is_some_and(|tail| tails.contains(&tail)));
    (is_opaque(bare) || is_opaque(name)).then_some("reserved in GLSL")
}

/// Why a name cannot be used and what to do, or nothing.
pub fn fault(name: &str, purpose: Use) -> Option<(String, String)> {
    let rule = "write ASCII letters, digits and single underscores, beginning with a letter";
    let fault = |why: &str, help: &str| Some((format!("`{name}` {why}"), help.to_owned()));
    let mut chars = name.chars();
    let begins = chars.next().is_some_and(|c| c.is_ascii_alphabetic());
    if !begins || !chars.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return fault("is no identifier", rule);
    }
    if name.len() > 64 {
        return fault("is longer than 64 characters", "shorten it");
    }
    if name.contains("__") {
        return fault("holds `__`, which is reserved in GLSL and renamed by naga", "write single underscores");
    }
    if name.to_ascii_lowercase().starts_with("gl_") {
        return fault("starts with `gl_`, which is reserved in GLSL", "begin it with another word");
    }
    if name.ends_with('_') {
        return fault("ends in an underscore", rule);
    }
    if let Some(why) = reserved(name) {
        return fault(&format!("is {why}"), "choose another name, with a prefix perhaps");
    }
    if purpose == Use::Item && name.ends_with(|c: char| c.is_ascii_digit()) {
        return fault(
            "ends in a digit, and naga renames such a function",
            &format!("end it in a letter, as in `{name}_fn`, or put the number first"),
        );
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::keywords::wgsl;

    #[test]
    fn everything_that_naga_reserves_is_refused() {
        for word in wgsl::RESERVED {
            assert!(fault(word, Use::Item).is_some(), "{word}");
        }
    }

    #[test]
    fn every_word_of_the_tables_is_refused_and_says_why() {
        for word in [WGSL, GLSL, RUST, FUNCTIONS].iter().flat_map(|table| table.split_whitespace()) {
            let (message, _) = fault(word, Use::Stem).unwrap();
            assert!(message.contains("reserved") || message.contains("built-in"), "{message}");
        }
        for word in ["sampler2D", "isampler2DArray", "uimageBuffer", "gl_city", "GL_city", "samplerCube"] {
            assert!(fault(word, Use::Stem).unwrap().0.contains("reserved"), "{word}");
        }
    }

    #[test]
    fn shapes_of_names() {
        for (name, part) in [
            ("", "no identifier"),
            ("5th", "no identifier"),
            ("_x", "no identifier"),
            ("a-b", "no identifier"),
            ("größe", "no identifier"),
            ("a__b", "`__`"),
            ("a_", "underscore"),
            ("vec3", "digit"),
            ("sh5", "digit"),
        ] {
            assert!(fault(name, Use::Item).unwrap().0.contains(part), "{name}");
        }
        assert_eq!(fault("sh5_rotate", Use::Item), None);
        assert_eq!(fault("scene2", Use::Stem), None);
    }
}
