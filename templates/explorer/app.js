// The page: its controls, what they mean for the pictures, and the figures that it shows.

import { drawBands, drawMaps, drawOrders } from "./charts.js";
import {
  bandNorms, brightness, camera, duration, lean, leaning, leftOut, levelOf, lightOf, measure, percent, predict,
} from "./figures.js";
import { listenForMaps } from "./own.js";
import * as webgl2 from "./webgl.js";
import * as webgpu from "./webgpu.js";

const APIS = { webgpu, webgl2 };
const NAMES = { webgpu: "WebGPU", webgl2: "WebGL2" };
const $ = (id) => document.getElementById(id);
const panels = ["chosen", "exact", "every", "difference"].map($);
const contexts = panels.map((panel) => panel.getContext("2d"));

/** Where the first view is from. */
const VIEW = { azimuth: -60, elevation: 20, distance: 3.7, field: 32 };
const FIRST = {
  method: "tilt", order: 5, mesh: "teapot", brdf: "ward:0.4", normals: "0015", strength: 0.35, light: "interior", exposure: 0,
  api: "webgpu", resolution: 0, rotate: 0, against: "all", domain: 0, ...VIEW,
};
/** The pictures that the difference may be from, as the shaders number them. */
const AGAINST = { all: 0, exact: 1 };
/** Pictures that take less than this, in milliseconds, are drawn finer by themselves. */
const FAST = 3;
/** Pictures that take longer are drawn coarser while they move. */
const SLOW = 40;
/** How long a picture moves, in milliseconds, before it is measured again. */
const GLANCE = 700;

/** All choices, also those in the address after `#`. */
const state = { ...FIRST };

const load = (path, kind) => fetch(path).catch(() => {
  throw new Error("What served this page has ended: run `zonal explore` again, and load the page again.");
}).then((answer) => {
  if (!answer.ok) throw new Error(`${path} is missing (${answer.status}): run \`zonal explore\` again.`);
  return answer[kind]();
});
const cached = new Map();
const once = (key, make) => {
  if (!cached.has(key)) {
    const made = make();
    cached.set(key, made);
    // What failed may be tried again.
    made.catch?.(() => cached.delete(key));
  }
  return cached.get(key);
};
const shader = (name) => once(name, () => load(`shaders/${name}`, "text"));
const bytes = (path) => once(path, () => load(path, "arrayBuffer"));

let index, errors;
let backend = null;
/** What is on the screen: choices with their data and programs; nothing until the first is ready. */
let shown = null;
let dirty = false;
let moving = false;
let generation = 0;
/** How often something changed, and when the last measured change was. */
let settling = 0;
let settled = 0;
/** From when on the pictures count as resting. */
let rest = 0;
/** The last figures, for the page and for tests. */
let figures = null;
let waiting = [];
/** What was measured of each method since anything else was changed. */
let measured = new Map();
/** What each order was seen to leave out since anything else was changed, but for the method. */
let left = new Map();
/** When a picture that moves was last measured. */
let glanced = 0;
let milliseconds = { chosen: 0, exact: 0, all: 0 };
let fast = false;

const row = (list, id) => index[list].find((entry) => entry.id === id);
const bands = () => index.orders.at(-1);

// ---- what the choices need ----

async function meshOf({ file, vertices, indices }) {
  const buffer = await bytes(file);
  return { vertices: new Float32Array(buffer, 0, 12 * vertices), indices: new Uint32Array(buffer, 48 * vertices, indices) };
}

async function normalsOf({ file, width, height }) {
  const all = new Uint8Array(await bytes(file));
  const levels = [];
  for (let start = 0, i = 0; start < all.length; i++) {
    const size = 4 * Math.max(width >> i, 1) * Math.max(height >> i, 1);
    levels.push(all.subarray(start, start + size));
    start += size;
  }
  return { width, height, levels };
}

/** A map's coefficients, its lights as a texture, and its small picture. */
async function lightDataOf({ file, width, height, rows }) {
  const buffer = await bytes(file);
  const coefficients = new Float32Array(buffer, 0, 3 * bands() ** 2);
  const [start, count] = [coefficients.byteLength, (rows[0] + rows[1]) * index.lightsARow];
  return {
    coefficients,
    lights: { width: 2 * index.lightsARow, height: rows[0] + rows[1], texels: new Float32Array(buffer, start, 8 * count) },
    environment: { width, height, texels: new Uint32Array(buffer, start + 32 * count) },
  };
}

/** The first bands of a table, as the shaders of an order expect them. */
async function viewsOf({ file, elevations, azimuths }, order) {
  const all = new Float32Array(await bytes(file));
  const whole = 4 * Math.ceil(bands() ** 2 / 4);
  const stride = 4 * Math.ceil(order ** 2 / 4);
  const texels = new Float32Array(elevations * azimuths * stride);
  for (let i = 0; i < elevations * azimuths; i++) {
    texels.set(all.subarray(i * whole, i * whole + stride), i * stride);
  }
  return { width: (azimuths * stride) / 4, height: elevations, texels };
}

/** The light of an order as shaders take it: four numbers a coefficient. */
function padded(coefficients, order) {
  const values = new Float32Array(4 * order ** 2);
  for (let i = 0; i < order ** 2; i++) values.set(coefficients.subarray(3 * i, 3 * i + 3), 4 * i);
  return values;
}

const programName = (method, order, brdf) => `${order}-${method}-${row("brdfs", brdf).isotropic ? "isotropic" : "anisotropic"}`;

/** Makes the pictures follow the choices: loads and compiles what is new, then shows all of it at once. */
async function apply() {
  const mine = ++generation;
  document.body.dataset.state = "loading";
  const wanted = { ...state };
  const { order, method } = wanted;
  try {
    const [mesh, normals, environment, brdf] = ["mesh", "normals", "light", "brdf"].map((key) =>
      row({ mesh: "meshes", normals: "normals", light: "maps", brdf: "brdfs" }[key], wanted[key]));
    const target = backend;
    const [meshData, normalData, { coefficients, ...lightData }, views, exact, chosen, all, table] = await Promise.all([
      meshOf(mesh), normalsOf(normals), lightDataOf(environment), viewsOf(brdf, order),
      target.program(programName("exact", order, wanted.brdf)), target.program(programName(method, order, wanted.brdf)),
      target.program("all-bands"), bytes(brdf.file),
    ]);
    if (mine !== generation) return;
    const is = (...keys) => shown?.target === target && keys.every((key) => shown.choices[key] === wanted[key]);
    if (!is("mesh")) target.setMesh(meshData);
    if (!is("normals")) target.setNormals(normalData);
    if (!is("light")) {
      target.setEnvironment(lightData.environment);
      target.setLights(lightData.lights);
    }
    if (!is("brdf", "order")) target.setViews(views);
    if (!is("light", "order")) target.setLight(padded(coefficients, order));
    if (!is("mesh", "normals", "light", "brdf", "order", "strength")) measured = new Map();
    if (!is("mesh", "normals", "light", "brdf", "strength")) left = new Map();
    shown = {
      target, choices: wanted, programs: { chosen, exact, all }, coefficients, environment: lightData.environment,
      looks: [wanted.mesh, wanted.normals, wanted.light, wanted.brdf], light: lightOf(coefficients, bands()),
      reflectance: once(`norms ${brdf.id}`, () => bandNorms(new Float32Array(table), 4 * Math.ceil(bands() ** 2 / 4), bands())),
      normals: normalData, leans: null, generation: mine,
    };
    shown.unit = shown.light.mean;
    lookAtLeans();
    lookAtLight();
    describe();
    document.body.dataset.state = "busy";
    touch();
  } catch (error) {
    if (mine !== generation) return;
    say(error.message);
    document.body.dataset.state = "failed";
  }
}

// ---- drawing ----

/** The size of a picture in pixels, and how many samples a pixel has along a side. */
function size() {
  const coarse = moving && milliseconds.chosen + milliseconds.exact > SLOW ? 0.5 : 1;
  const scale = (state.resolution || (fast ? 2 : 1)) * coarse;
  const side = Math.max(16, Math.round(panels[0].clientWidth * Math.min(devicePixelRatio, 2) * Math.min(scale, 1)));
  return { width: Math.min(side, 1000), height: Math.min(side, 1000), samples: scale > 1 ? 2 : 1 };
}

/** The lean in radians beyond which the chosen method is not meant to be used; nothing is below 0. */
function limit() {
  const degrees = row("methods", shown.choices.method).kernels[shown.choices.order]?.limit ?? null;
  return degrees === null ? -1 : (degrees * Math.PI) / 180;
}

/** What all bands are summed from, fewer lights while a picture moves that is slow to sum; the key tells what is drawn. */
function allBands(view) {
  const { light, brdf } = shown.choices;
  const map = row("maps", light);
  const few = moving && milliseconds.all > SLOW / 2;
  const range = few ? [0, map.lights[0]] : [map.rows[0] * index.lightsARow, map.lights[1]];
  return { brdf: row("brdfs", brdf).numbers, range, key: JSON.stringify([shown.looks, state.strength, view, range]) };
}

function frame() {
  const { light, programs } = shown;
  const view = camera(state);
  return {
    ...size(), programs, camera: view, strength: Number(state.strength), unit: shown.unit,
    all: allBands([...view.clip]), against: AGAINST[state.against], limit: state.domain ? limit() : -1,
    exposure: (0.95 * 2 ** Number(state.exposure)) / light.mean, ramp: index.ramp.map(colour),
  };
}

const colour = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);

async function draw() {
  const now = frame();
  for (const panel of panels) if (panel.width !== now.width) [panel.width, panel.height] = [now.width, now.height];
  await backend.draw(now, contexts);
  return now;
}

/** Something changed: draw again, and look at the numbers once it rests. */
function touch() {
  dirty = true;
  settling++;
  if (document.body.dataset.state === "ready") document.body.dataset.state = "busy";
}

let before = 0;
/** Whether the graphics are at work: then nothing else is drawn. */
let working = false;

async function work(job) {
  working = true;
  try {
    await job();
  } catch (error) {
    say(`The pictures cannot be drawn: ${error.message}`);
  } finally {
    working = false;
  }
}

function tick(now) {
  requestAnimationFrame(tick);
  if (!shown || shown.target !== backend || working) return;
  const passed = Math.min(now - before, 250);
  before = now;
  moving = Boolean(state.rotate) || dragging;
  if (state.rotate) {
    state.azimuth += 0.012 * passed;
    dirty = true;
  }
  if (dirty) {
    dirty = false;
    rest = performance.now() + (state.rotate ? 600 : 120);
    if (moving) $("time-note").textContent = `one frame every ${Math.max(passed, 1).toFixed(0)} ms while it moves`;
    work(state.rotate && performance.now() > glanced + GLANCE ? glance : draw);
  } else if (settled !== settling && shown.generation === generation && performance.now() > rest) {
    work(settle);
  }
}

/** Draws and measures the errors of a picture that moves; its time only once it rests. */
async function glance() {
  const now = await draw();
  const result = judged(await backend.read());
  glanced = performance.now();
  if (shown?.generation === generation) report(result, now);
}

/** What the pictures say: what the method adds, what the order leaves out, and both, in shares of the mean radiance. */
function judged([chosen, exact, all]) {
  const { unit, pixels } = brightness(all);
  const most = limit();
  return {
    ...measure(chosen, exact, unit), left: measure(exact, all, unit), whole: measure(chosen, all, unit), unit, pixels,
    beyond: most < 0 ? 0 : leaning(all, most),
  };
}

/** How long a picture takes, in milliseconds: repeated until the clock can tell. */
async function timed(which, now) {
  await backend.repeat(which, now, 1);
  for (let times = 1; ; times *= 4) {
    const start = performance.now();
    await backend.repeat(which, now, times);
    const passed = performance.now() - start;
    if (passed > 8 || times >= 64) return passed / times;
  }
}

/** The picture of all bands that was timed last. */
let summed = null;

/** Measures the picture that rests on the screen. */
async function settle() {
  const mine = settling;
  moving = dragging;
  const start = performance.now();
  const now = await draw();
  const pictures = await backend.read();
  if (now.all.key !== summed) milliseconds.all = performance.now() - start;
  summed = now.all.key;
  const result = judged(pictures);
  if (Math.abs(result.unit / now.unit - 1) > 0.01) {
    // The scale of the false colours is only known now.
    shown.unit = result.unit || now.unit;
    await draw();
  }
  milliseconds = { ...milliseconds, chosen: await timed("chosen", now), exact: await timed("exact", now) };
  settled = mine;
  if (!state.resolution && !fast && milliseconds.chosen + milliseconds.exact < FAST) {
    fast = true;
    touch();
  }
  if (mine !== settling || shown?.generation !== generation) return;
  measured.set(shown.choices.method, result);
  left.set(shown.choices.order, result.left.mean);
  report(result, now);
  document.body.dataset.state = "ready";
  waiting.forEach((done) => done(figures));
  waiting = [];
  remember();
}

// ---- figures ----

const kernelOf = (method, order) => method.kernels[order] ?? { total: 0, special: 0, name: null };

/** How far the normals lean that are seen: filtered as they are from this far, at worst as they are from close by. */
function lookAtLeans() {
  const { normals, choices } = shown;
  const now = size();
  const level = Math.min(levelOf(index.repeats * normals.width, now.width * now.samples, state), normals.levels.length - 1);
  const of = (i) => once(`lean ${choices.normals} ${choices.strength} ${i}`, () => lean(normals.levels[i], choices.strength, index.leastZ));
  shown.leans = { ...of(level), most: of(0).most };
}

/** The light itself: how it is read, its bands, and what the order holds of it. */
function lookAtLight() {
  const { choices, coefficients, environment, light } = shown;
  const map = row("maps", choices.light);
  $("light-note").textContent = map.told;
  const held = drawBands($("bands"), { shares: map.shares, beyond: map.beyond, order: choices.order });
  $("bands-note").textContent = `The ${choices.order} bands of the order hold ${percent(held)} of the light’s energy; small bright lights fill all bands.`;
  const exposure = 0.95 / light.mean;
  shown.signs = drawMaps([$("map"), $("series")], { environment, coefficients, order: choices.order, exposure });
  const { negative, lowest } = shown.signs;
  $("series-note").textContent = `The map, and what order ${choices.order} holds of it: ${
    negative ? `negative in ${percent(negative)} of the directions (magenta), down to −${(-lowest).toFixed(2)} of the mean` : "nowhere negative"
  }.`;
  const apart = Math.max(...map.apart);
  $("every-note").textContent = `brute force: ${map.lights[1].toLocaleString("en")} lights times the reflectance`;
  $("every-words").textContent = `All bands are summed by brute force, with no harmonics: ${map.lights[1].toLocaleString("en")} lights, gathered from the map’s ${map.texels.toLocaleString("en")} texels, times the reflectance itself. Against the sum over all texels it errs by ${percent(apart)} of the mean radiance, in the mean over surfaces that lie anyhow, with the reflectance of this page for which that is the most.`;
}

/** What each order is expected to leave out. */
const expectedLeft = () => {
  const { choices, unit } = shown;
  return leftOut(row("brdfs", choices.brdf).norms, row("maps", choices.light).energy, unit);
};

/** What is known of a method before it is drawn. */
function expected(method) {
  const { choices, leans, reflectance, light, unit } = shown;
  const size = index.degrees * bands();
  const at = index.methods.findIndex(({ id }) => id === method);
  return predict({
    errors: errors.subarray(at * size, (at + 1) * size),
    typical: errors.subarray((index.methods.length + at) * size, (index.methods.length + at + 1) * size),
    order: choices.order, bands: bands(), leans, reflectance, light, unit,
  });
}

function describe() {
  const { choices } = shown;
  const { order } = choices;
  const method = row("methods", choices.method);
  const [kernel, exact] = [kernelOf(method, order), kernelOf(row("methods", "exact"), order)];
  const special = kernel.special ? ` and ${kernel.special} special` : "";
  const share = Math.round(100 * (1 - kernel.total / exact.total));
  $("chosen-name").textContent = method.label;
  $("chosen-note").textContent = kernel.name ? `${kernel.name}, order ${order}` : `order ${order}, no kernel`;
  $("exact-note").textContent = `${exact.name}, ${exact.total} operations`;
  $("operations").textContent = kernel.total;
  $("operations-note").textContent = kernel.name
    ? `${kernel.name}${special}${share ? `; ${share} % fewer than exact` : ""}`
    : "nothing is turned";
  $("law").textContent = method.law;
  $("source").href = `shaders/${programName(choices.method, order, choices.brdf)}.${backend.api === "webgpu" ? "wgsl" : "frag"}`;
  $("source").textContent = `Shader of this picture (${backend.api === "webgpu" ? "WGSL" : "GLSL"})`;
  $("methods-caption").textContent = `All methods, order ${order}; errors of the picture where they were measured`;
  table();
}

function table() {
  const { choices } = shown;
  const rows = index.methods.map((method) => {
    const line = document.createElement("tr");
    if (method.id === choices.method) line.setAttribute("aria-current", "true");
    const head = document.createElement("th");
    head.scope = "row";
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = method.label.split(":")[0];
    button.setAttribute("aria-label", `Choose ${method.label}`);
    button.addEventListener("click", () => choose("method", method.id));
    head.append(button);
    const got = measured.get(method.id);
    const cells = [
      kernelOf(method, choices.order).total,
      method.id === "exact" ? "rounding" : percent(expected(method.id).kernel[0]),
      got ? percent(got.mean) : "–", got ? percent(got.worst) : "–", got ? percent(got.whole.mean) : "–",
    ].map((text) => {
      const cell = document.createElement("td");
      cell.textContent = text;
      return cell;
    });
    line.append(head, ...cells);
    return line;
  });
  const body = $("methods").tBodies[0];
  const focused = [...body.rows].findIndex((line) => line.contains(document.activeElement));
  body.replaceChildren(...rows);
  body.rows[focused]?.querySelector("button").focus();
}

function report(result, now) {
  lookAtLeans();
  const { choices, leans } = shown;
  const plan = expected(choices.method);
  const kernel = kernelOf(row("methods", choices.method), choices.order);
  const most = limit();
  figures = {
    ...state, ...result, predicted: plan, expected: expectedLeft(), signs: shown.signs, operations: kernel.total, milliseconds,
    adapter: backend.adapter, api: backend.api, width: now.width, samples: now.samples,
  };
  const bound = plan.worst > 10 ? "nothing bounds the worst" : `worst at most ${percent(plan.worst)}`;
  $("predicted").textContent = percent(plan.mean);
  $("predicted-note").textContent = `of the method: mean, estimated; ${bound}. Normals lean by ${leans.rms.toFixed(0)}° rms, ${leans.most.toFixed(0)}° at most`;
  $("measured").textContent = percent(result.mean);
  $("measured-note").textContent = `mean; worst ${percent(result.worst)}, of ${result.pixels.toLocaleString("en")} pixels`;
  $("left").textContent = percent(result.left.mean);
  $("left-note").textContent = `mean; worst ${percent(result.left.worst)}: the exact picture against all bands`;
  $("whole").textContent = percent(result.whole.mean);
  $("whole-note").textContent = `mean; worst ${percent(result.whole.worst)}: what is seen against all bands`;
  $("beyond").textContent = result.beyond
    ? `${percent(result.beyond)} of the pixels lean by more than ${((most * 180) / Math.PI).toFixed(0)}°, for which this method is not meant`
    : "";
  $("time").textContent = duration(milliseconds.chosen);
  $("time-note").textContent = `exact ${duration(milliseconds.exact)}; ${now.width * now.samples} × ${now.height * now.samples}`;
  table();
  const method = row("methods", choices.method).label;
  $("verdict").textContent = `Left out by order ${choices.order}: ${percent(result.left.mean)}; added by the method: ${percent(result.mean)}.`;
  drawOrders($("orders"), { expected: figures.expected, measured: left, whole: result.whole.mean, order: choices.order, last: 16 });
  const text = `${method}, order ${choices.order}: ${kernel.total} operations, left out by the order ${percent(result.left.mean)}, added by the method: mean error ${percent(result.mean)}, worst ${percent(result.worst)}.`;
  if (!state.rotate && $("status").textContent !== text) $("status").textContent = text;
}

/** Draws every order once, so that the plot is full, and comes back to the chosen one. */
async function measureOrders() {
  const { order } = state;
  $("measure-orders").disabled = true;
  for (const other of [...index.orders.filter((each) => each !== order), order]) {
    choose("order", other);
    await ready();
  }
  $("measure-orders").disabled = false;
}

/** Draws every method once, so that the table is full, and comes back to the chosen one. */
async function measureAll() {
  const { method } = state;
  $("measure-all").disabled = true;
  for (const { id } of [...index.methods.filter(({ id }) => id !== method), { id: method }]) {
    choose("method", id);
    await ready();
  }
  $("measure-all").disabled = false;
}

function say(text) {
  $("message").textContent = text;
}

// ---- graphics ----

/** Opens the wanted interface, or the other one with a message. */
async function connect(wanted) {
  generation++;
  document.body.dataset.state = "loading";
  const order = [wanted, ...Object.keys(APIS).filter((api) => api !== wanted)];
  const reasons = [];
  const old = backend;
  for (const api of order) {
    try {
      const opened = await APIS[api].open(shader);
      backend = opened;
      break;
    } catch (error) {
      reasons.push(error.message);
    }
  }
  if (backend === old) {
    say([...reasons, "Nothing can be drawn."].join(" "));
    document.body.dataset.state = "failed";
    return;
  }
  shown = null;
  old?.close();
  state.api = backend.api;
  $("api").value = backend.api;
  $("adapter").textContent = backend.adapter;
  say(reasons.length ? `${reasons.join(" ")} Drawn in ${NAMES[backend.api]} instead.` : "");
  const mine = backend;
  mine.onLost((reason) => {
    if (mine !== backend) return;
    say(`The pictures stand still: ${reason}. Choose the other kind of graphics, or load the page again.`);
    shown = null;
  });
  await apply();
}

// ---- controls ----

const NUMBERS = ["order", "strength", "exposure", "resolution", "azimuth", "elevation", "distance", "field", "rotate", "domain"];

function show() {
  for (const key of ["method", "mesh", "brdf", "normals", "light", "resolution", "against", "order", "strength", "exposure"]) $(key).value = state[key];
  for (const key of ["rotate", "domain"]) $(key).checked = Boolean(state[key]);
  $("order-value").textContent = `${state.order} (${state.order ** 2} coefficients)`;
  $("strength-value").textContent = `${Number(state.strength).toFixed(2)}`;
  $("exposure-value").textContent = `${state.exposure > 0 ? "+" : ""}${state.exposure} EV`;
}

function choose(key, value) {
  state[key] = NUMBERS.includes(key) ? Number(value) : value;
  show();
  if (["exposure", "resolution", "rotate", "against", "domain"].includes(key)) return touch();
  settling++;
  return apply();
}

function remember() {
  const changed = Object.keys(FIRST).filter((key) => state[key] !== FIRST[key]);
  const text = changed.map((key) => `${key}=${NUMBERS.includes(key) ? +state[key].toFixed(2) : state[key]}`).join("&");
  history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
}

/** Takes over what the address says, as far as it makes sense. */
function recall() {
  Object.assign(state, FIRST);
  const lists = { method: "methods", mesh: "meshes", brdf: "brdfs", normals: "normals", light: "maps" };
  for (const [key, value] of new URLSearchParams(location.hash.slice(1))) {
    if (!(key in FIRST)) continue;
    const known = key in lists ? row(lists[key], value) : key === "api" ? value in APIS : key === "against" ? value in AGAINST : Number.isFinite(Number(value));
    if (known) state[key] = NUMBERS.includes(key) ? Number(value) : value;
  }
  const within = (key, least, most) => (state[key] = Math.min(Math.max(state[key], least), most));
  within("order", index.orders[0], bands());
  state.order = Math.round(state.order);
  within("strength", 0, Math.max(2, FIRST.strength));
  within("exposure", -4, 4);
  within("elevation", -85, 85);
  within("distance", Math.min(2.2, FIRST.distance), Math.max(9, FIRST.distance));
  within("field", 1, 120);
  if (![0, 0.5, 1, 2].includes(state.resolution)) state.resolution = FIRST.resolution;
}

function orbit(sideways, upwards) {
  state.azimuth = ((((state.azimuth - sideways) % 360) + 540) % 360) - 180;
  state.elevation = Math.min(Math.max(state.elevation + upwards, -85), 85);
  touch();
}

function zoom(factor) {
  state.distance = Math.min(Math.max(state.distance * factor, Math.min(2.2, FIRST.distance)), Math.max(9, FIRST.distance));
  touch();
}

function first() {
  Object.assign(state, VIEW);
  touch();
}

let dragging = false;
const pointers = new Map();

function pointer(event) {
  const old = pointers.get(event.pointerId);
  if (!old) return;
  const all = [...pointers.values()];
  const spread = () => Math.hypot(...["x", "y"].map((axis) => all[0][axis] - all[1][axis]));
  const wide = all.length === 2 ? spread() : 0;
  const [dx, dy] = [event.clientX - old.x, event.clientY - old.y];
  [old.x, old.y] = [event.clientX, event.clientY];
  if (all.length === 2) return zoom(wide / Math.max(spread(), 1));
  const degrees = 220 / panels[0].clientWidth;
  orbit(dx * degrees, dy * degrees);
}

function release(event) {
  pointers.delete(event.pointerId);
  dragging = pointers.size > 0;
  if (!dragging) touch();
}

function listen() {
  for (const key of ["method", "mesh", "brdf", "normals", "light", "resolution", "against"]) {
    $(key).addEventListener("change", () => choose(key, $(key).value));
  }
  for (const key of ["order", "strength", "exposure"]) $(key).addEventListener("input", () => choose(key, $(key).value));
  for (const key of ["rotate", "domain"]) $(key).addEventListener("change", () => choose(key, $(key).checked ? 1 : 0));
  $("api").addEventListener("change", () => {
    settling++;
    connect($("api").value);
  });
  $("reset").addEventListener("click", first);
  $("measure-all").addEventListener("click", measureAll);
  $("measure-orders").addEventListener("click", measureOrders);
  listenForMaps(index.drop, $("own"), {
    busy: (names) => say(`Reading ${names.join(", ")} …`),
    failed: say,
    taken: (map) => {
      index.maps.unshift(map);
      $("light").prepend(new Option(map.label, map.id));
      say("");
      choose("light", map.id);
    },
  });
  for (const panel of panels) {
    panel.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      panel.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      dragging = true;
    });
    panel.addEventListener("pointermove", pointer);
    panel.addEventListener("pointerup", release);
    panel.addEventListener("pointercancel", release);
  }
  const stage = $("stage");
  stage.addEventListener("wheel", (event) => {
    if (document.activeElement !== stage) return;
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.001));
  }, { passive: false });
  stage.addEventListener("keydown", (event) => {
    const steps = {
      ArrowLeft: () => orbit(-5, 0), ArrowRight: () => orbit(5, 0), ArrowUp: () => orbit(0, 5), ArrowDown: () => orbit(0, -5),
      "+": () => zoom(0.9), "=": () => zoom(0.9), "-": () => zoom(1.1), 0: first,
    };
    if (!steps[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    steps[event.key]();
  });
  new ResizeObserver(touch).observe(panels[0]);
  addEventListener("hashchange", () => {
    recall();
    show();
    settling++;
    return state.api === backend?.api ? apply() : connect(state.api);
  });
}

/** Resolves with the figures once the pictures follow the choices and are measured. */
const ready = () => (document.body.dataset.state === "ready" ? Promise.resolve(figures) : new Promise((done) => waiting.push(done)));

/** Runs a kernel of the page, by its name, on rows of inputs in WebGPU or WebGL2: its self-check. */
async function check(api, name, count, inputs) {
  const { outputs } = index.checks.find((entry) => entry.name === name);
  const opened = await once(`check ${api}`, () => APIS[api].open(shader));
  return opened.check(name, count, inputs, outputs);
}

async function start() {
  try {
    index = await load("data/index.json", "json");
    errors = new Float32Array(await bytes("data/errors.bin"));
  } catch (error) {
    document.body.dataset.state = "failed";
    return say(error.message);
  }
  const options = { method: "methods", mesh: "meshes", brdf: "brdfs", normals: "normals", light: "maps" };
  for (const [key, list] of Object.entries(options)) {
    $(key).replaceChildren(...index[list].map(({ id, label }) => new Option(label, id)));
  }
  Object.assign(FIRST, index.first);
  for (const key of Object.keys(VIEW)) VIEW[key] = FIRST[key];
  $("strength").max = Math.max(2, FIRST.strength);
  [$("order").min, $("order").max] = [index.orders[0], bands()];
  $("ramp").style.background = `linear-gradient(to right, ${index.ramp.join(", ")})`;
  recall();
  show();
  listen();
  window.zonal = { ready, check, state, index };
  await connect(state.api);
  requestAnimationFrame(tick);
}

start();
