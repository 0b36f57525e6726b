#version 300 es
// What is seen of the radiance: the chosen picture, the exact one, all bands and a difference in false colours, side by
// side, over the blurred environment; red where normals lean further than the chosen method takes. Exposure, a filmic curve (Narkowicz 2015) and sRGB.

precision highp float;
precision highp int;
precision highp sampler2D;

// A pixel's ray is x right + y up - back.
uniform vec3 right;
uniform vec3 up;
uniform vec3 back;
// The false colours, from none to all.
uniform vec3 ramp[9];
// The size of one picture in pixels.
uniform vec2 size;
// What radiance is multiplied by before the curve.
uniform float exposure;
// What a difference is measured in.
uniform float unit;
// So many times so many samples a pixel.
uniform int samples;
// What the difference is from: 0 for all bands, 1 for the exact picture.
uniform int against;
// The lean in radians from which on the chosen picture and the difference are red; none is below 0.
uniform float limit;
uniform sampler2D chosen;
uniform sampler2D exact;
uniform sampler2D environment;
// All bands; alpha is 1 and the lean.
uniform sampler2D every;

out vec4 colour;

vec3 tone(vec3 radiance) {
    vec3 x = max(radiance * exposure, vec3(0.0));
    vec3 y = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), vec3(0.0), vec3(1.0));
    return mix(1.055 * pow(y, vec3(1.0 / 2.4)) - 0.055, 12.92 * y, lessThan(y, vec3(0.0031308)));
}

vec3 background(vec2 place) {
    vec2 ndc = 2.0 * place / size - 1.0;
    vec3 d = normalize(ndc.x * right + ndc.y * up - back);
    vec2 uv = vec2(0.5 - atan(d.y, d.x) / 6.2831855, acos(clamp(d.z, -1.0, 1.0)) / 3.1415927);
    return tone(textureLod(environment, uv, 0.0).rgb);
}

// Logarithmic, from a thousandth of the unit to all of it.
vec3 false_colour(float error) {
    float t = clamp(log2(max(error, 1e-9) * 1000.0) / log2(1000.0), 0.0, 1.0) * 8.0;
    int i = min(int(t), 7);
    return mix(ramp[i], ramp[i + 1], t - float(i));
}

void main() {
    int panel = int(gl_FragCoord.x / size.x);
    ivec2 corner = ivec2(gl_FragCoord.xy) - ivec2(panel * int(size.x), 0);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < samples; j++) {
        for (int i = 0; i < samples; i++) {
            ivec2 at = corner * samples + ivec2(i, j);
            vec4 e = texelFetch(exact, at, 0);
            vec4 c = texelFetch(chosen, at, 0);
            vec4 a = texelFetch(every, at, 0);
            bool is_beyond = limit >= 0.0 && e.a >= 0.5 && a.a - 1.0 > limit && (panel == 0 || panel == 3);
            if (is_beyond) {
                sum += mix(vec3(0.85, 0.02, 0.05), tone(c.rgb), panel == 0 ? 0.25 : 0.0);
            } else if (panel == 3) {
                float error = length(c.rgb - (against == 0 ? a.rgb : e.rgb)) / unit;
                sum += e.a < 0.5 ? vec3(0.105, 0.133, 0.172) : false_colour(error);
            } else if (e.a < 0.5) {
                sum += background((vec2(at) + 0.5) / float(samples));
            } else {
                sum += tone(panel == 0 ? c.rgb : panel == 1 ? e.rgb : a.rgb);
            }
        }
    }
    colour = vec4(sum / float(samples * samples), 1.0);
}
