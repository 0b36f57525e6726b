// What the page computes: the camera, the predicted error of a picture and the measured one. It knows nothing of drawing.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The field of view in degrees, across the picture, which is square. */
const FIELD = 32;

/**
 * The camera around the origin, z up: `azimuth` from +x towards +y and `elevation` in degrees. Gives where the eye is,
 * the matrix from world to clip space by columns, and the vectors of which a pixel's ray is x right + y up − back.
 */
export function camera({ azimuth, elevation, distance }) {
  const [a, e] = [azimuth, elevation].map((degrees) => (degrees * Math.PI) / 180);
  const back = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  const right = [-Math.sin(a), Math.cos(a), 0];
  const up = cross(back, right);
  const eye = back.map((x) => x * distance);
  const slope = Math.tan((FIELD * Math.PI) / 360);
  const [near, far] = [Math.max(distance - 1.1, 0.01), distance + 1.1];
  const rows = [
    [...right.map((x) => x / slope), 0],
    [...up.map((x) => x / slope), 0],
    [...back.map((x) => (x * far) / (near - far)), (near * far) / (near - far)],
    [...back.map((x) => -x), 0],
  ];
  rows[2][3] -= (dot(back, eye) * far) / (near - far);
  rows[3][3] = dot(back, eye);
  const clip = new Float32Array(16);
  for (let i = 0; i < 4; i++) for (let j = 0; j < 4; j++) clip[4 * j + i] = rows[i][j];
  return { eye, clip, right: right.map((x) => x * slope), up: up.map((x) => x * slope), back };
}

/**
 * The rms and the largest lean in degrees, and the share of each whole degree, of the normals of a texture's level, (n + 1)/2 in RGBA, at a strength. Shaders
 * take z for `leastZ` where it is less.
 */
export function lean(texels, strength, leastZ) {
  let [sum, most] = [0, 0];
  const shares = new Float64Array(91);
  for (let i = 0; i < texels.length; i += 4) {
    const [x, y, z] = [0, 1, 2].map((k) => texels[i + k] / 127.5 - 1);
    const degrees = (Math.atan((strength * Math.hypot(x, y)) / Math.max(z, leastZ)) * 180) / Math.PI;
    sum += degrees * degrees;
    most = Math.max(most, degrees);
    shares[Math.round(degrees)] += 4 / texels.length;
  }
  return { rms: Math.sqrt(sum / (texels.length / 4)), most, shares };
}

/**
 * Which level of a normal map most of the object shows: of `texels` a unit length, on a picture of so many pixels, from so
 * far; surfaces that are seen aslant add half a level.
 */
export function levelOf(texels, pixels, distance) {
  const across = 2 * distance * Math.tan((FIELD * Math.PI) / 360);
  return Math.max(0, Math.round(0.5 + Math.log2((texels * across) / pixels)));
}

/** The error of each band at a lean in degrees, between the whole degrees of a method's table. */
export function bandErrors(table, bands, degrees) {
  const rows = table.length / bands;
  const at = Math.min(Math.max(degrees, 0), rows - 1);
  const [low, part] = [Math.min(Math.floor(at), rows - 2), at - Math.min(Math.floor(at), rows - 2)];
  return Array.from({ length: bands }, (_, l) => table[low * bands + l] * (1 - part) + table[(low + 1) * bands + l] * part);
}

/** The norm of each band: the largest and the rms over all entries of a table of `stride` numbers each. */
export function bandNorms(values, stride, bands) {
  const [most, sum] = [new Float64Array(bands), new Float64Array(bands)];
  for (let start = 0; start < values.length; start += stride) {
    for (let l = 0; l < bands; l++) {
      let square = 0;
      for (let i = l * l; i < (l + 1) * (l + 1); i++) square += values[start + i] ** 2;
      most[l] = Math.max(most[l], square);
      sum[l] += square;
    }
  }
  const count = values.length / stride;
  return { most: Array.from(most, Math.sqrt), rms: Array.from(sum, (x) => Math.sqrt(x / count)) };
}

/** The norm of each band of the light in R, G and B together, and its mean radiance. A radiance is the norm of R, G and B. */
export function lightOf(coefficients, bands) {
  const norms = Array.from({ length: bands }, (_, l) => {
    let square = 0;
    for (let i = 3 * l * l; i < 3 * (l + 1) * (l + 1); i++) square += coefficients[i] ** 2;
    return Math.sqrt(square);
  });
  return { norms, mean: norms[0] / Math.sqrt(4 * Math.PI) };
}

/**
 * What to expect of a picture, in shares of its mean radiance `unit`. `worst` is a bound, by Cauchy and Schwarz in each
 * band at the largest lean; `mean` is an estimate: in band l the error and the light are as good as independent, so that
 * their product is 1/√(2l + 1) of that of their norms, and bands add up as squares; averaged over the leans that are seen. `kernel` is the worst
 * band's error at the rms and at the largest lean.
 */
export function predict({ errors, typical, order, bands, leans, reflectance, light, unit }) {
  const [rms, most] = [leans.rms, leans.most].map((degrees) => bandErrors(errors, bands, degrees).slice(0, order));
  let [mean, worst] = [0, 0];
  leans.shares.forEach((share, degrees) => {
    if (share === 0) return;
    const error = bandErrors(typical, bands, degrees);
    let square = 0;
    for (let l = 1; l < order; l++) square += (error[l] * reflectance.rms[l] * light.norms[l]) ** 2 / (2 * l + 1);
    mean += share * Math.sqrt(square);
  });
  for (let l = 1; l < order; l++) worst += most[l] * reflectance.most[l] * light.norms[l];
  return { mean: mean / unit, worst: worst / unit, kernel: [rms, most].map((all) => Math.max(...all)) };
}

/**
 * The mean and the worst error of a picture, over the pixels that show the object, in shares of the exact picture's mean
 * radiance, which is `unit`.
 */
export function measure(chosen, exact) {
  const norm = (r, g, b) => Math.sqrt(r * r + g * g + b * b);
  let [sum, worst, radiance, pixels] = [0, 0, 0, 0];
  for (let i = 0; i < exact.length; i += 4) {
    if (exact[i + 3] < 0.5) continue;
    const error = norm(chosen[i] - exact[i], chosen[i + 1] - exact[i + 1], chosen[i + 2] - exact[i + 2]);
    sum += error;
    worst = error > worst || Number.isNaN(error) ? error : worst;
    radiance += norm(exact[i], exact[i + 1], exact[i + 2]);
    pixels++;
  }
  return pixels ? { mean: sum / radiance, worst: (worst * pixels) / radiance, unit: radiance / pixels, pixels } : { mean: 0, worst: 0, unit: 0, pixels };
}

/** A share as a person reads it. */
export function percent(share) {
  if (share === 0) return "0 %";
  const value = 100 * share;
  if (value < 1e-3) return "< 0.001 %";
  return `${value >= 100 ? Math.round(value).toLocaleString("en") : value.toPrecision(2)} %`;
}

/** Milliseconds as a person reads them. */
export const duration = (milliseconds) => `${milliseconds < 10 ? milliseconds.toPrecision(2) : Math.round(milliseconds)} ms`;
