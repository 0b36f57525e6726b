// What the page computes: the camera, the predicted error of a picture and the measured one. It knows nothing of drawing.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/**
 * The camera around the origin, z up: `azimuth` from +x towards +y, `elevation`, and the `field` of view across the picture,
 * which is square, in degrees. Gives where the eye is,
 * the matrix from world to clip space by columns, and the vectors of which a pixel's ray is x right + y up − back.
 */
export function camera({ azimuth, elevation, distance, field }) {
  const [a, e] = [azimuth, elevation].map((degrees) => (degrees * Math.PI) / 180);
  const back = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  const right = [-Math.sin(a), Math.cos(a), 0];
  const up = cross(back, right);
  const eye = back.map((x) => x * distance);
  const slope = Math.tan((field * Math.PI) / 360);
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
 * far and in such a field of view; surfaces that are seen aslant add half a level.
 */
export function levelOf(texels, pixels, { distance, field }) {
  const across = 2 * distance * Math.tan((field * Math.PI) / 360);
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

const norm = (r, g, b) => Math.sqrt(r * r + g * g + b * b);

/** The mean radiance of a picture over the pixels that show the object, and how many those are. */
export function brightness(picture) {
  let [sum, pixels] = [0, 0];
  for (let i = 0; i < picture.length; i += 4) {
    if (picture[i + 3] < 0.5) continue;
    sum += norm(picture[i], picture[i + 1], picture[i + 2]);
    pixels++;
  }
  return { unit: pixels ? sum / pixels : 0, pixels };
}

/** The mean and the worst error of a picture against another, over the pixels that show the object, in shares of `unit`. */
export function measure(picture, other, unit) {
  let [sum, worst, pixels] = [0, 0, 0];
  for (let i = 0; i < other.length; i += 4) {
    if (other[i + 3] < 0.5) continue;
    const error = norm(picture[i] - other[i], picture[i + 1] - other[i + 1], picture[i + 2] - other[i + 2]);
    sum += error;
    worst = error > worst || Number.isNaN(error) ? error : worst;
    pixels++;
  }
  return pixels && unit ? { mean: sum / pixels / unit, worst: worst / unit } : { mean: 0, worst: 0 };
}

/** The share of the object's pixels whose normals lean by more than `limit` radians: a picture of all bands tells leans. */
export function leaning(all, limit) {
  let [beyond, pixels] = [0, 0];
  for (let i = 3; i < all.length; i += 4) {
    if (all[i] < 0.5) continue;
    pixels++;
    beyond += all[i] - 1 > limit;
  }
  return pixels ? beyond / pixels : 0;
}

/**
 * What each order from 1 leaves out, in shares of the mean radiance, if every rotation of the reflectance against the light is
 * as likely as any other: the mean square of band l is then the product of the two energies over 2l + 1. `norms` are those of
 * the reflectance and `energy` the energies of the light, by band.
 */
export function leftOut(norms, energy, unit) {
  let square = 0;
  const errors = [];
  for (let l = norms.length - 1; l > 0; l--) {
    square += (norms[l] ** 2 * energy[l]) / (2 * l + 1);
    errors[l - 1] = Math.sqrt(square) / unit;
  }
  return errors;
}

/** R, G and B of the first bands of a light in a direction; the basis is zonal's (docs/MATH.md, Conventions). */
export function evaluate(coefficients, order, [x, y, z]) {
  const sum = [0, 0, 0];
  const add = (i, value) => {
    for (let k = 0; k < 3; k++) sum[k] += coefficients[3 * i + k] * value;
  };
  let [sectoral, cos, sin] = [0.5 / Math.sqrt(Math.PI), 1, 0];
  for (let m = 0; m < order; m++) {
    if (m > 0) {
      sectoral *= -Math.sqrt(m === 1 ? 3 : (2 * m + 1) / (2 * m));
      [cos, sin] = [x * cos - y * sin, x * sin + y * cos];
    }
    let [before, value, last] = [0, sectoral, 1];
    for (let l = m; l < order; l++) {
      if (l > m) {
        const ratio = Math.sqrt((4 * l * l - 1) / (l * l - m * m));
        [before, value] = [value, ratio * (z * value - before / last)];
        last = ratio;
      }
      add(l * (l + 1) + m, value * cos);
      if (m > 0) add(l * (l + 1) - m, value * sin);
    }
  }
  return sum;
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
