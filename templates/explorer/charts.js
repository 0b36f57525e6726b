// Plots of what an order leaves out, and the map beside what an order holds of it. It knows nothing of drawing surfaces.

import { evaluate, percent } from "./figures.js";

const SVG = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT] = [360, 200, 60, 34, 12, 10];

function element(name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

/** The frame of a plot: powers of ten from `least` to `most` upwards, whole numbers from `first` to `last` sideways. */
function axes(svg, { least, most, first, last, step, sideways, upwards }) {
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
  const x = (value) => LEFT + ((value - first) / (last - first)) * (WIDTH - LEFT - RIGHT);
  const y = (value) => {
    const share = Math.log(Math.min(Math.max(value, least), most) / least) / Math.log(most / least);
    return HEIGHT - BOTTOM - share * (HEIGHT - BOTTOM - TOP);
  };
  for (let value = least; value <= most * 1.01; value *= 10) {
    svg.append(
      element("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), class: "grid" }),
      element("text", { x: LEFT - 5, y: y(value) + 4, "text-anchor": "end" }, `${+(100 * value).toPrecision(1)} %`),
    );
  }
  for (let value = Math.ceil(first); value <= last; value += step) {
    svg.append(element("text", { x: x(value), y: HEIGHT - BOTTOM + 15, "text-anchor": "middle" }, value));
  }
  svg.append(
    element("text", { x: (LEFT + WIDTH) / 2, y: HEIGHT - 4, "text-anchor": "middle", class: "axis" }, sideways),
    element("title", {}, upwards),
  );
  return { x, y };
}

/**
 * The error over the order: what theory expects each order to leave out, a line; what was measured on the picture, dots; and
 * the chosen method with what it adds, a ring.
 */
export function drawOrders(svg, { expected, measured, whole, order, last }) {
  const { x, y } = axes(svg, {
    least: 1e-3, most: 10, first: 1, last, step: last > 16 ? 4 : 1, sideways: "order", upwards: "Error over the order",
  });
  const line = expected.slice(0, last).map((error, i) => `${i ? "L" : "M"}${x(i + 1).toFixed(1)} ${y(error).toFixed(1)}`);
  svg.append(
    element("line", { x1: x(order), x2: x(order), y1: TOP, y2: HEIGHT - BOTTOM, class: "chosen" }),
    element("path", { d: line.join(""), class: "expected" }),
    ...[...measured].map(([at, error]) => element("circle", { cx: x(at), cy: y(error), r: 3.5, class: "measured" })),
  );
  if (whole !== null) svg.append(element("circle", { cx: x(order), cy: y(whole), r: 6, class: "whole" }));
  const dots = [...measured].sort(([a], [b]) => a - b).map(([at, error]) => `order ${at} ${percent(error)}`);
  svg.setAttribute("aria-label", `Error over the order. Measured: ${dots.join(", ") || "nothing yet"}`);
}

/** The share of each band in the energy of the light: those of the order bright, the others dim; the last bar is all beyond. */
export function drawBands(svg, { shares, beyond, order }) {
  const all = [...shares, beyond];
  const { x, y } = axes(svg, {
    least: 1e-6, most: 1, first: -0.7, last: all.length - 0.3, step: 4, sideways: `band; the last bar: all from ${shares.length} on`,
    upwards: "Energy by band",
  });
  const width = 0.75 * (x(1) - x(0));
  all.forEach((share, l) => {
    if (share <= 0) return;
    const bar = element("rect", {
      x: x(l) - width / 2, width, y: y(share), height: HEIGHT - BOTTOM - y(share), class: l < order ? "held" : "left",
    });
    bar.append(element("title", {}, `${l < shares.length ? `band ${l}` : "beyond"}: ${percent(share)}`));
    svg.append(bar);
  });
  const held = shares.slice(0, order).reduce((sum, share) => sum + share, 0);
  svg.setAttribute("aria-label", `Energy by band: the ${order} bands of the order hold ${percent(held)}`);
  return held;
}

/** A texel of RGB9E5. */
function radiance(bits) {
  const scale = 2 ** ((bits >>> 27) - 24);
  return [bits & 511, (bits >>> 9) & 511, (bits >>> 18) & 511].map((mantissa) => mantissa * scale);
}

/** The curve of the pictures (display.frag). */
function tone(value) {
  const x = Math.max(value, 0);
  const y = Math.min(Math.max((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0), 1);
  return 255 * (y < 0.0031308 ? 12.92 * y : 1.055 * y ** (1 / 2.4) - 0.055);
}

function fill(canvas, width, height, colour) {
  [canvas.width, canvas.height] = [width, height];
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height);
  for (let i = 0; i < width * height; i++) image.data.set([...colour(i % width, Math.floor(i / width)), 255], 4 * i);
  context.putImageData(image, 0, 0);
}

/**
 * The map, and what an order holds of it, magenta where that is negative in a channel. Returns the share of all directions in
 * which it is, and the lowest value of a channel in shares of the mean one.
 */
export function drawMaps(canvases, { environment, coefficients, order, exposure }) {
  const { width, height, texels } = environment;
  fill(canvases[0], width, height, (x, y) => radiance(texels[y * width + x]).map((value) => tone(exposure * value)));
  let [negative, all, lowest] = [0, 0, 0];
  fill(canvases[1], width, height, (x, y) => {
    const [azimuth, polar] = [Math.PI - (2 * Math.PI * (x + 0.5)) / width, (Math.PI * (y + 0.5)) / height];
    const value = evaluate(coefficients, order, [
      Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar),
    ]);
    const least = Math.min(...value);
    all += Math.sin(polar);
    lowest = Math.min(lowest, least);
    if (least >= 0) return value.map((channel) => tone(exposure * channel));
    negative += Math.sin(polar);
    return [214, 40, 178];
  });
  const mean = (coefficients[0] + coefficients[1] + coefficients[2]) / 3 / Math.sqrt(4 * Math.PI);
  return { negative: negative / all, lowest: mean > 0 ? lowest / mean : 0 };
}
