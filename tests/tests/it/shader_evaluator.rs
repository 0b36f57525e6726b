//! The evaluator of shader text, held against the same arithmetic written in Rust. Each sample exists in WGSL and in
//! GLSL, and both must give the same bits and the same counts.
//! One file: a small shader a case, and what it gives.

use std::sync::LazyLock;

use Value::{Array, Bool, F32, I32, Mat, U32, Vec};
use zonal_tests::shader::{Counts, Fma, Language, Shader, Value};

const WGSL: &str = r"
const TABLE = array<f32, 5>(0.5, -1.25, 3.0, 0.1, 7.5);
const AXES = array<vec3<f32>, 2>(vec3<f32>(1.0, 2.0, 3.0), vec3<f32>(-4.0, 0.5, 0.25));

fn straight(q: vec4<f32>, c: array<f32, 3>) -> array<f32, 3> {
    let t1 = q.x * q.y + q.z;
    let t2 = inverseSqrt(t1);
    return array<f32, 3>(c[0], t1 * c[1] - t2 * c[2], -(c[2] / q.w) + sqrt(q.x));
}

fn colours(b: f32, c: array<vec3<f32>, 2>) -> array<vec3<f32>, 2> {
    let t = b * c[0] + c[1] * 0.5;
    return array<vec3<f32>, 2>(-t, vec3<f32>(c[1].x, t.yz) / b);
}

fn planes(c: array<vec2<f32>, 3>) -> vec3<f32> {
    return vec3<f32>(c[0].x, c[1].y, c[2].x + c[2].y);
}

fn looped(b: f32, c: array<f32, 5>) -> array<f32, 5> {
    var r: array<f32, 5>;
    r[0] = c[0];
    for (var i = 1; i < 4; i = i + 1) {
        r[i] = c[i] * (1.0 + b * TABLE[i]) + c[i + 1];
    }
    r[4] = c[4];
    return r;
}

fn nested(n: i32, c: array<f32, 5>) -> f32 {
    var copy = c;
    var sum = 0.0;
    for (var i = 0; i < n; i++) {
        var inner = 0.0;
        for (var j = i; j < 5; j++) {
            if (j == 3) { continue; }
            if (i * j > 5) { break; }
            inner += copy[j];
        }
        copy[i] = inner * TABLE[4 - i];
        sum = sum + inner;
    }
    return sum;
}

fn triple(b: f32, c: array<vec3<f32>, 2>) -> vec3<f32> {
    var r = array<vec3<f32>, 2>();
    for (var i = 0u; i < 2u; i++) {
        r[i] = c[i] * b + AXES[1u - i];
        r[i].y = r[i].z;
    }
    return r[0] + r[1];
}

fn branch(x: f32) -> f32 {
    if (x > 1.0 && x != 3.0) {
        return x * 2.0;
    } else if (x < 0.0 || x == 3.0) {
        return -x;
    }
    return x + 1.0;
}

fn matrix(m: mat3x3<f32>, v: vec3<f32>) -> vec3<f32> {
    return m[0] * v.x + m[1] * v.y + m[2] * v.z + vec3<f32>(m[0].y, m[2][1], 0.0);
}

fn transposed(m: mat3x3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(vec3<f32>(m[0].x, m[1].x, m[2].x), vec3<f32>(m[0].y, m[1].y, m[2].y), vec3<f32>(m[0].z, m[1].z, m[2].z));
}

fn limits(x: f32, y: f32) -> array<f32, 6> {
    return array<f32, 6>(min(x, y), max(x, y), abs(x), clamp(x, -1.0, 1.0), select(x, y, x < y), f32(min(i32(y), 7)));
}

fn vectors(x: vec3<f32>, y: vec3<f32>) -> vec3<f32> {
    return max(x, y) * abs(x).zyx - clamp(y, vec3<f32>(-1.0), vec3<f32>(1.0)) + vec3<f32>();
}

fn integers(i: i32, u: u32) -> i32 {
    let bits = ((u << 2u) | 3u) ^ (u & 5u);
    return i % 3 - i / 2 + i32(bits >> 1u) + ((-i) >> 1u) + abs(i) + i32(f32(u) * 1.5);
}

fn naturals(u: u32) -> u32 { return u / 2u * 3u - u % 2u + u32(2.75); }

fn either(a: bool, x: f32) -> bool { return !a || x >= 2.0; }

fn cancel(a: f32, c: f32) -> f32 { return fma(a, a, c); }

fn cancel_colour(a: vec3<f32>, c: vec3<f32>) -> vec3<f32> { return fma(a, a, c); }

fn helper(x: f32, c: array<f32, 3>) -> array<f32, 3> {
    return array<f32, 3>(x * c[0], x * c[1], x * c[2]);
}

fn twice(x: f32, c: array<f32, 3>) -> array<f32, 3> {
    let once = helper(x, c);
    return helper(x + 1.0, once);
}
";

const GLSL: &str = r"
const float TABLE[5] = float[5](0.5, -1.25, 3.0, 0.1, 7.5);
const vec3 AXES[2] = vec3[2](vec3(1.0, 2.0, 3.0), vec3(-4.0, 0.5, 0.25));

float[3] straight(vec4 q, float c[3]) {
    float t1 = q.x * q.y + q.z;
    float t2 = inversesqrt(t1);
    return float[3](c[0], t1 * c[1] - t2 * c[2], -(c[2] / q.w) + sqrt(q.x));
}

vec3[2] colours(float b, vec3 c[2]) {
    vec3 t = b * c[0] + c[1] * 0.5;
    return vec3[2](-t, vec3(c[1].x, t.yz) / b);
}

vec3 planes(vec2 c[3]) {
    return vec3(c[0].x, c[1].y, c[2].x + c[2].y);
}

float[5] looped(float b, float c[5]) {
    float r[5];
    r[0] = c[0];
    for (int i = 1; i < 4; i++) {
        r[i] = c[i] * (1.0 + b * TABLE[i]) + c[i + 1];
    }
    r[4] = c[4];
    return r;
}

float nested(int n, float c[5]) {
    float copy[5] = c;
    float sum = 0.0;
    for (int i = 0; i < n; i++) {
        float inner = 0.0;
        for (int j = i; j < 5; j++) {
            if (j == 3) { continue; }
            if (i * j > 5) { break; }
            inner += copy[j];
        }
        copy[i] = inner * TABLE[4 - i];
        sum = sum + inner;
    }
    return sum;
}

vec3 triple(float b, vec3 c[2]) {
    vec3 r[2];
    for (uint i = 0u; i < 2u; i++) {
        r[i] = c[i] * b + AXES[1u - i];
        r[i].y = r[i].z;
    }
    return r[0] + r[1];
}

float branch(float x) {
    if (x > 1.0 && x != 3.0) {
        return x * 2.0;
    } else if (x < 0.0 || x == 3.0) {
        return -x;
    }
    return x + 1.0;
}

vec3 matrix(mat3 m, vec3 v) {
    return m[0] * v.x + m[1] * v.y + m[2] * v.z + vec3(m[0].y, m[2][1], 0.0);
}

mat3 transposed(mat3 m) {
    return mat3(vec3(m[0].x, m[1].x, m[2].x), vec3(m[0].y, m[1].y, m[2].y), vec3(m[0].z, m[1].z, m[2].z));
}

float[6] limits(float x, float y) {
    return float[6](min(x, y), max(x, y), abs(x), clamp(x, -1.0, 1.0), mix(x, y, x < y), float(min(int(y), 7)));
}

vec3 vectors(vec3 x, vec3 y) {
    return max(x, y) * abs(x).zyx - clamp(y, vec3(-1.0), vec3(1.0)) + vec3(0.0);
}

int integers(int i, uint u) {
    uint bits = ((u << 2u) | 3u) ^ (u & 5u);
    return i % 3 - i / 2 + int(bits >> 1u) + ((-i) >> 1u) + abs(i) + int(float(u) * 1.5);
}

uint naturals(uint u) { return u / 2u * 3u - u % 2u + uint(2.75); }

bool either(bool a, float x) { return !a || x >= 2.0; }

float cancel(float a, float c) { return fma(a, a, c); }

vec3 cancel_colour(vec3 a, vec3 c) { return fma(a, a, c); }

float[3] helper(float x, float c[3]) {
    return float[3](x * c[0], x * c[1], x * c[2]);
}

float[3] twice(float x, float c[3]) {
    float once[3] = helper(x, c);
    return helper(x + 1.0, once);
}
";

static SHADERS: LazyLock<[Shader; 2]> = LazyLock::new(|| [parse(Language::Wgsl, WGSL), parse(Language::Glsl, GLSL)]);

fn parse(language: Language, text: &str) -> Shader {
    Shader::parse(language, text).unwrap_or_else(|error| panic!("{error}"))
}

fn run(shader: &Shader, function: &str, args: &[Value], fma: Fma) -> (Value, Counts) {
    let mut counts = Counts::default();
    let value = shader.call(function, args, &mut counts, fma);
    (value.unwrap_or_else(|error| panic!("{error}")), counts)
}

/// What a sample gives in WGSL, once it is known that GLSL gives the same.
fn call(function: &str, args: &[Value], fma: Fma) -> (Value, Counts) {
    let [wgsl, glsl] = &*SHADERS;
    let result = run(wgsl, function, args, fma);
    assert_eq!(result, run(glsl, function, args, fma), "WGSL and GLSL differ in {function}");
    result
}

fn value(function: &str, args: &[Value]) -> Value {
    call(function, args, Fma::Separate).0
}

fn floats(xs: &[f32]) -> Value {
    Array(xs.iter().copied().map(F32).collect())
}

fn vectors(xs: &[[f32; 3]]) -> Value {
    Array(xs.iter().map(|x| Vec(x.to_vec())).collect())
}

const TABLE: [f32; 5] = [0.5, -1.25, 3.0, 0.1, 7.5];
const C: [f32; 5] = [0.3, -1.7, 2.9, 0.013, -5.1];

#[test]
fn both_languages_list_the_same_functions() {
    let [wgsl, glsl] = &*SHADERS;
    assert_eq!(wgsl.functions(), glsl.functions());
    assert_eq!(wgsl.functions().first().map(String::as_str), Some("straight"));
    assert_eq!(wgsl.functions().len(), 18);
}

#[test]
fn straight_lines_round_as_rust_does() {
    let q = [0.7, 0.3, 1.9, -2.6_f32];
    let c = [C[0], C[1], C[2]];
    let t1 = q[0] * q[1] + q[2];
    let t2 = 1.0 / t1.sqrt();
    let expected = [c[0], t1 * c[1] - t2 * c[2], -(c[2] / q[3]) + q[0].sqrt()];
    let (result, counts) = call("straight", &[Vec(q.to_vec()), floats(&c)], Fma::Separate);
    assert_eq!(result, floats(&expected));
    assert_eq!(counts, Counts { mul: 3, add: 3, fma: 0, choice: 0, special: 3 });
}

#[test]
fn a_vector_counts_once_a_component() {
    let b = 1.3_f32;
    let c = [[0.3, -1.7, 2.9], [0.013, -5.1, 0.77_f32]];
    let t: [f32; 3] = std::array::from_fn(|i| b * c[0][i] + c[1][i] * 0.5);
    let expected = [t.map(|x| -x), [c[1][0] / b, t[1] / b, t[2] / b]];
    let (result, counts) = call("colours", &[F32(b), vectors(&c)], Fma::Separate);
    assert_eq!(result, vectors(&expected));
    assert_eq!(counts, Counts { mul: 6, add: 3, fma: 0, choice: 0, special: 3 });
}

#[test]
fn arrays_of_pairs_are_arguments_too() {
    let c = Array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0_f32]].map(|x| Vec(x.to_vec())).to_vec());
    assert_eq!(value("planes", &[c]), Vec(vec![1.0, 4.0, 11.0]));
}

#[test]
fn loops_index_locals_parameters_and_tables() {
    let b = 0.37_f32;
    let mut expected = C;
    for i in 1..4 {
        expected[i] = C[i] * (1.0 + b * TABLE[i]) + C[i + 1];
    }
    let (result, counts) = call("looped", &[F32(b), floats(&C)], Fma::Separate);
    assert_eq!(result, floats(&expected));
    assert_eq!(counts, Counts { mul: 6, add: 6, fma: 0, choice: 0, special: 0 });
}

#[test]
fn loops_nest_continue_and_break() {
    for n in 0..=5 {
        let mut copy = C;
        let mut sum = 0.0;
        let mut counts = Counts::default();
        for i in 0..n {
            let mut inner = 0.0;
            for j in i..5 {
                if j == 3 {
                    continue;
                }
                if i * j > 5 {
                    break;
                }
                inner += copy[j];
                counts.add += 1;
            }
            copy[i] = inner * TABLE[4 - i];
            counts.mul += 1;
            sum += inner;
            counts.add += 1;
        }
        let result = call("nested", &[I32(n as i32), floats(&C)], Fma::Separate);
        assert_eq!(result, (F32(sum), counts));
    }
}

#[test]
fn loops_store_vectors_and_their_components() {
    let axes = [[1.0, 2.0, 3.0], [-4.0, 0.5, 0.25_f32]];
    let b = -0.83_f32;
    let c = [[0.3, -1.7, 2.9], [0.013, -5.1, 0.77_f32]];
    let mut r = [[0.0; 3]; 2];
    for i in 0..2 {
        r[i] = std::array::from_fn(|k| c[i][k] * b + axes[1 - i][k]);
        r[i][1] = r[i][2];
    }
    let (result, counts) = call("triple", &[F32(b), vectors(&c)], Fma::Separate);
    assert_eq!(result, Vec((0..3).map(|k| r[0][k] + r[1][k]).collect()));
    assert_eq!(counts, Counts { mul: 6, add: 9, fma: 0, choice: 0, special: 0 });
}

#[test]
fn branches_run_and_count_one_side() {
    for (x, expected, mul, add) in [(1.5, 3.0, 1, 0), (3.0, -3.0, 0, 0), (-2.5, 2.5, 0, 0), (0.25, 1.25, 0, 1)] {
        let result = call("branch", &[F32(x)], Fma::Separate);
        assert_eq!(result, (F32(expected), Counts { mul, add, fma: 0, choice: 0, special: 0 }));
    }
}

#[test]
fn matrices_are_columns() {
    let m = [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9_f32]];
    let v = [1.1, -2.3, 3.7_f32];
    let extra = [m[0][1], m[2][1], 0.0];
    let expected = (0..3).map(|r| m[0][r] * v[0] + m[1][r] * v[1] + m[2][r] * v[2] + extra[r]);
    let columns = Mat(m.map(|column| column.to_vec()).to_vec());
    let (result, counts) = call("matrix", &[columns.clone(), Vec(v.to_vec())], Fma::Separate);
    assert_eq!(result, Vec(expected.collect()));
    assert_eq!(counts, Counts { mul: 9, add: 9, fma: 0, choice: 0, special: 0 });

    let transposed = (0..3).map(|r| m.iter().map(|column| column[r]).collect()).collect();
    assert_eq!(value("transposed", &[columns]), Mat(transposed));
}

#[test]
fn minima_maxima_and_selections_of_floats_are_counted() {
    for (x, y) in [(-2.5_f32, 8.9_f32), (0.3, -3.7), (1.0, 1.0)] {
        let expected =
            [x.min(y), x.max(y), x.abs(), x.clamp(-1.0, 1.0), if x < y { y } else { x }, (y as i32).min(7) as f32];
        let result = call("limits", &[F32(x), F32(y)], Fma::Separate);
        assert_eq!(result, (floats(&expected), Counts { choice: 5, ..Counts::default() }));
    }
    let (x, y) = ([-2.0, 0.5, 3.0_f32], [1.5, -0.25, -4.0_f32]);
    let lane = |i: usize| x[i].max(y[i]) * x[2 - i].abs() - y[i].clamp(-1.0, 1.0) + 0.0;
    let (result, counts) = call("vectors", &[Vec(x.to_vec()), Vec(y.to_vec())], Fma::Separate);
    assert_eq!(result, Vec((0..3).map(lane).collect()));
    assert_eq!(counts, Counts { mul: 3, add: 6, choice: 9, ..Counts::default() });
}

/// Of two zeros and where one is not a number the first counts, as the specifications' formulas say; drivers may differ.
#[test]
fn the_first_counts_where_neither_is_less() {
    for (x, y) in [(0.0, -0.0), (-0.0, 0.0), (1.0, f32::NAN), (f32::NAN, 1.0)] {
        for shader in &*SHADERS {
            let Array(items) = run(shader, "limits", &[F32(x), F32(y)], Fma::Separate).0 else { panic!("an array") };
            let bits = [0, 1].map(|i| if let F32(x) = items[i] { x.to_bits() } else { panic!("a float") });
            assert_eq!(bits, [f32::to_bits(x); 2], "{x} {y}");
        }
    }
}

#[test]
fn powers_and_logarithms_are_rusts() {
    let wgsl = "fn powers(x: f32) -> vec2<f32> { return vec2<f32>(exp2(x), log2(x)); }";
    let glsl = "vec2 powers(float x) { return vec2(exp2(x), log2(x)); }";
    for shader in [parse(Language::Wgsl, wgsl), parse(Language::Glsl, glsl)] {
        for x in [0.3_f32, 7.0, 1e-40, 200.0] {
            let (result, counts) = run(&shader, "powers", &[F32(x)], Fma::Separate);
            assert_eq!(result, Vec(vec![x.exp2(), x.log2()]));
            assert_eq!(counts, Counts { special: 2, ..Counts::default() });
        }
    }
}

#[test]
fn integers_and_casts_are_free() {
    for (i, u) in [(7, 5_u32), (-8, 12), (0, 0)] {
        let bits = ((u << 2) | 3) ^ (u & 5);
        let expected = i % 3 - i / 2 + (bits >> 1) as i32 + (-i >> 1) + i.abs();
        let (result, counts) = call("integers", &[I32(i), U32(u)], Fma::Separate);
        assert_eq!(result, I32(expected + (u as f32 * 1.5) as i32));
        assert_eq!(counts, Counts { mul: 1, ..Counts::default() });
        assert_eq!(value("naturals", &[U32(u + 2)]), U32((u + 2) / 2 * 3 - u % 2 + 2));
    }
}

#[test]
fn truth_values_go_in_and_out() {
    for (a, x, expected) in [(true, 1.0, false), (true, 2.0, true), (false, 1.0, true)] {
        assert_eq!(value("either", &[Bool(a), F32(x)]), Bool(expected));
    }
}

#[test]
fn fma_rounds_once_or_twice() {
    let a = 1.0 + f32::EPSILON * 2048.0;
    let c = -(a * a);
    let (fused, counts) = call("cancel", &[F32(a), F32(c)], Fma::Fused);
    assert_eq!(fused, F32(2.0_f32.powi(-24)));
    assert_eq!(counts, Counts { fma: 1, ..Counts::default() });
    assert_eq!(call("cancel", &[F32(a), F32(c)], Fma::Separate), (F32(0.0), counts));

    let colours = [Vec(vec![a; 3]), Vec(vec![c; 3])];
    let (fused, counts) = call("cancel_colour", &colours, Fma::Fused);
    assert_eq!(fused, Vec(vec![2.0_f32.powi(-24); 3]));
    assert_eq!(counts, Counts { fma: 3, ..Counts::default() });
}

#[test]
fn functions_call_functions() {
    let x = 1.7_f32;
    let c = [C[0], C[1], C[2]];
    let (result, counts) = call("twice", &[F32(x), floats(&c)], Fma::Separate);
    assert_eq!(result, floats(&c.map(|c| (x + 1.0) * (x * c))));
    assert_eq!(counts, Counts { mul: 6, add: 1, fma: 0, choice: 0, special: 0 });
}

#[test]
fn counts_add_up_over_calls() {
    let mut counts = Counts::default();
    for _ in 0..3 {
        let args = [F32(0.5), floats(&C)];
        SHADERS[0].call("looped", &args, &mut counts, Fma::Separate).unwrap();
    }
    assert_eq!(counts, Counts { mul: 18, add: 18, fma: 0, choice: 0, special: 0 });
}

#[test]
fn glsl_overloads_are_chosen_by_their_arguments() {
    let shader = parse(Language::Glsl, "float twice(float x) { return x + x; } vec3 twice(vec3 x) { return x + x; }");
    assert_eq!(run(&shader, "twice", &[F32(1.5)], Fma::Separate).0, F32(3.0));
    let (result, counts) = run(&shader, "twice", &[Vec(vec![1.0, 2.0, 3.0])], Fma::Separate);
    assert_eq!(result, Vec(vec![2.0, 4.0, 6.0]));
    assert_eq!(counts.add, 3);
}

#[test]
fn parameters_can_be_written() {
    let glsl = parse(
        Language::Glsl,
        "void scale(inout float c[2], float k) { for (int i = 0; i < 2; i++) { c[i] *= k; } }
         float[2] scaled(float c[2], float k) { scale(c, k); c[0] += 1.0; return c; }",
    );
    let wgsl = parse(
        Language::Wgsl,
        "fn scale(c: ptr<function, array<f32, 2>>, k: f32) { for (var i = 0; i < 2; i++) { (*c)[i] *= k; } }
         fn scaled(c: array<f32, 2>, k: f32) -> array<f32, 2> { var r = c; scale(&r, k); r[0] += 1.0; return r; }",
    );
    for shader in [wgsl, glsl] {
        let (result, counts) = run(&shader, "scaled", &[floats(&[2.0, 3.0]), F32(4.0)], Fma::Fused);
        assert_eq!(result, floats(&[9.0, 12.0]));
        assert_eq!(counts, Counts { mul: 2, add: 1, fma: 0, choice: 0, special: 0 });
    }
}

/// A thousand statements over a hundred coefficients give what the same lines give in Rust.
#[test]
fn long_functions_run() {
    let mut lines = String::new();
    for i in 0..1000 {
        let last = if i == 0 { "c[0]".to_owned() } else { format!("t{}_", i - 1) };
        lines += &format!("let t{i}_ = {last} * 0.75 + c[{}] * c[{}];\n", i % 100, i * 7 % 100);
    }
    let text = format!("fn long(c: array<f32, 100>) -> f32 {{\n{lines}return t999_;\n}}");
    let shader = parse(Language::Wgsl, &text);
    let c: [f32; 100] = std::array::from_fn(|i| (i as f32 * 0.37).sin());
    let expected = (0..1000).fold(c[0], |t, i| t * 0.75 + c[i % 100] * c[i * 7 % 100]);
    for _ in 0..100 {
        let (result, counts) = run(&shader, "long", &[floats(&c)], Fma::Separate);
        assert_eq!(result, F32(expected));
        assert_eq!(counts, Counts { mul: 2000, add: 1000, fma: 0, choice: 0, special: 0 });
    }
}

fn error(language: Language, text: &str, function: &str, args: &[Value]) -> String {
    parse(language, text).call(function, args, &mut Counts::default(), Fma::Fused).unwrap_err()
}

#[test]
fn wrong_calls_are_errors() {
    for shader in &*SHADERS {
        let call =
            |function, args: &[Value]| shader.call(function, args, &mut Counts::default(), Fma::Fused).unwrap_err();
        assert!(call("absent", &[]).contains("no function `absent`"));
        let wrong: [&[Value]; 4] = [&[], &[F32(1.0), F32(2.0)], &[F32(1.0), floats(&[1.0; 4])], &[I32(1), floats(&C)]];
        for args in wrong {
            assert_eq!(call("looped", args), "no `looped` takes arguments of these types");
        }
        let index = call("nested", &[I32(6), floats(&C)]);
        assert!(index.contains("is outside 5 elements"), "{index}");
    }
    assert!(parse_error(Language::Wgsl, "fn f() -> f32 { return 1; ").contains("wgsl"));
    assert!(parse_error(Language::Glsl, "float f() { return x; }").contains('x'));
    assert!(!parse_error(Language::Wgsl, "fn f() -> f32 { return 1u; }").is_empty());
}

fn parse_error(language: Language, text: &str) -> String {
    Shader::parse(language, text).err().expect("the text is wrong")
}

#[test]
fn what_is_not_supported_is_an_error_of_its_call_alone() {
    let text = "
        override scale: f32 = 2.0;
        @group(0) @binding(0) var image: texture_2d<f32>;
        @group(0) @binding(1) var<storage, read_write> cell: atomic<u32>;
        var<workgroup> state: f32;
        struct Pair { a: f32, b: f32 }
        fn overridden(x: f32) -> f32 { return x * scale; }
        fn textured(i: i32) -> f32 { return textureLoad(image, vec2<i32>(i, i), 0).x; }
        fn counted(i: u32) -> u32 { return atomicAdd(&cell, i); }
        fn stateful(x: f32) -> f32 { state += x; return state; }
        fn paired(x: f32) -> f32 { let p = Pair(x, x); return p.a; }
        fn sine(x: f32) -> f32 { return sin(x); }
        fn product(m: mat3x3<f32>, v: vec3<f32>) -> vec3<f32> { return m * v; }
        fn half(m: mat3x3<f32>) -> mat3x3<f32> { return m * 0.5; }
        fn nothing(x: f32) { }
        fn indices(i: i32) -> vec2<i32> { return vec2<i32>(i, i); }
        fn quotient(i: i32, j: i32) -> i32 { return i / j; }
        fn endless(x: f32) -> f32 { var y = x; loop { y += 1.0; if (y < x) { break; } } return y; }
        fn choice(i: i32) -> i32 { switch i { case 1: { return 5; } default: { return 6; } } }
        fn good(x: f32) -> f32 { return x + 1.0; }
    ";
    let matrix = Mat(vec![vec![1.0; 3]; 3]);
    let cases: [(&str, &[Value], &str); 13] = [
        ("overridden", &[F32(1.0)], "Override"),
        ("textured", &[I32(1)], "Image"),
        ("counted", &[U32(1)], "Atomic"),
        ("stateful", &[F32(1.0)], "GlobalVariable"),
        ("paired", &[F32(1.0)], "Struct"),
        ("sine", &[F32(1.0)], "Sin"),
        ("product", &[matrix.clone(), Vec(vec![1.0; 3])], "Multiply of [Matrix, Float]"),
        ("half", &[matrix], "Multiply of [Matrix, Float]"),
        ("nothing", &[F32(1.0)], "returns nothing"),
        ("indices", &[I32(1)], "a result of type"),
        ("quotient", &[I32(1), I32(0)], "no result for [1, 0]"),
        ("endless", &[F32(1.0)], "a loop did not end"),
        ("choice", &[I32(1)], "Switch"),
    ];
    for (function, args, expected) in cases {
        let error = error(Language::Wgsl, text, function, args);
        assert!(error.contains(expected) && error.contains(function), "{function}: {error}");
    }
    let shader = parse(Language::Wgsl, text);
    assert_eq!(run(&shader, "good", &[F32(1.0)], Fma::Fused).0, F32(2.0));
}
