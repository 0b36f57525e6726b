// What is seen of the radiance: the chosen picture, the exact one, all bands and a difference in false colours, side by
// side, over the blurred environment; red where normals lean further than the chosen method takes. Exposure, a filmic curve (Narkowicz 2015) and sRGB.

struct Display {
    // A pixel's ray is x right + y up - back.
    right: vec4<f32>,
    up: vec4<f32>,
    back: vec4<f32>,
    // The false colours, from none to all.
    ramp: array<vec4<f32>, 9>,
    // The size of one picture in pixels.
    size: vec2<f32>,
    // What radiance is multiplied by before the curve.
    exposure: f32,
    // What a difference is measured in.
    unit: f32,
    // So many times so many samples a pixel.
    samples: i32,
    // What the difference is from: 0 for all bands, 1 for the exact picture.
    against: i32,
    // The lean in radians from which on the chosen picture and the difference are red; none is below 0.
    limit: f32,
}

@group(0) @binding(0) var<uniform> display: Display;
@group(0) @binding(1) var chosen: texture_2d<f32>;
@group(0) @binding(2) var exact: texture_2d<f32>;
@group(0) @binding(3) var environment: texture_2d<f32>;
@group(0) @binding(4) var wrapped: sampler;
// All bands; alpha is 1 and the lean.
@group(0) @binding(5) var every: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(select(-1.0, 3.0, i == 1u), select(-1.0, 3.0, i == 2u), 0.0, 1.0);
}

fn tone(radiance: vec3<f32>) -> vec3<f32> {
    let x = max(radiance * display.exposure, vec3<f32>(0.0));
    let y = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(y, vec3<f32>(1.0 / 2.4)) - 0.055, 12.92 * y, y < vec3<f32>(0.0031308));
}

fn background(place: vec2<f32>) -> vec3<f32> {
    let ndc = vec2<f32>(2.0, -2.0) * place / display.size + vec2<f32>(-1.0, 1.0);
    let d = normalize(ndc.x * display.right.xyz + ndc.y * display.up.xyz - display.back.xyz);
    let uv = vec2<f32>(0.5 - atan2(d.y, d.x) / 6.2831855, acos(clamp(d.z, -1.0, 1.0)) / 3.1415927);
    return tone(textureSampleLevel(environment, wrapped, uv, 0.0).rgb);
}

// Logarithmic, from a thousandth of the unit to all of it.
fn false_colour(error: f32) -> vec3<f32> {
    let t = clamp(log2(max(error, 1e-9) * 1000.0) / log2(1000.0), 0.0, 1.0) * 8.0;
    let i = min(i32(t), 7);
    return mix(display.ramp[i].rgb, display.ramp[i + 1].rgb, t - f32(i));
}

@fragment
fn fragment(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    let panel = i32(place.x / display.size.x);
    let corner = vec2<i32>(place.xy) - vec2<i32>(panel * i32(display.size.x), 0);
    var sum = vec3<f32>(0.0);
    for (var j = 0; j < display.samples; j++) {
        for (var i = 0; i < display.samples; i++) {
            let at = corner * display.samples + vec2<i32>(i, j);
            let e = textureLoad(exact, at, 0);
            let c = textureLoad(chosen, at, 0);
            let a = textureLoad(every, at, 0);
            let is_marked = panel == 0 || panel == 3;
            if (display.limit >= 0.0 && e.a >= 0.5 && a.a - 1.0 > display.limit && is_marked) {
                sum += mix(vec3<f32>(0.85, 0.02, 0.05), tone(c.rgb), select(0.0, 0.25, panel == 0));
            } else if (panel == 3) {
                let error = length(c.rgb - select(e.rgb, a.rgb, display.against == 0)) / display.unit;
                sum += select(false_colour(error), vec3<f32>(0.105, 0.133, 0.172), e.a < 0.5);
            } else if (e.a < 0.5) {
                sum += background((vec2<f32>(at) + 0.5) / f32(display.samples));
            } else {
                sum += tone(select(select(a.rgb, e.rgb, panel == 1), c.rgb, panel == 0));
            }
        }
    }
    return vec4<f32>(sum / f32(display.samples * display.samples), 1.0);
}
