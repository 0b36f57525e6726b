// Works the explorer as a person would, in WebGL2 and WebGPU, and tells what it saw as JSON on the standard output; what of
// it must hold is written in tests/gpu/tests/it/explorer.rs.
//
//     node explorer.mjs PAGE WORK
//
// PAGE is the folder that `zonal explore` wrote. WORK holds `checks.json`, the kernels to run, and their inputs; results
// and screenshots are put there.

import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { launch, open, serve } from "./launch.mjs";

const [page, work] = process.argv.slice(2);
const APIS = ["webgl2", "webgpu"];
const WIDE = { width: 900, height: 760 };

async function routes(request, response) {
  const [, kind, name] = request.url.split("/");
  if (kind === "inputs") {
    response.writeHead(200, { "content-type": "application/octet-stream" }).end(await readFile(join(work, name)));
    return true;
  }
  if (kind === "outputs") {
    const parts = [];
    for await (const part of request) parts.push(part);
    await writeFile(join(work, name), Buffer.concat(parts));
    response.writeHead(204).end();
    return true;
  }
  return false;
}

const server = await serve(page, routes);
const browser = await launch();
const facts = { errors: [], foreign: [] };

/** A page of the explorer; `choices` stand in its address. */
async function visit(choices, { before, ...options } = {}) {
  const context = await browser.newContext({ viewport: WIDE, ...options });
  if (before) await context.addInitScript(before);
  context.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(server.url) && !url.startsWith("data:")) facts.foreign.push(url);
  });
  const opened = await open(context, `${server.url}/#resolution=0.5&${choices}`);
  facts.errors.push(opened.errors);
  // A software driver takes its time for the first picture, of which all bands are summed.
  await opened.page.waitForFunction(() => ["ready", "failed"].includes(document.body.dataset.state), null, { timeout: 200000 });
  return opened.page;
}

/** The figures once the pictures rest. */
const ready = (page) => page.evaluate(() => window.zonal.ready());

/** The pixels of a picture, R, G, B and A. */
const pixels = async (page, panel) => Uint8Array.from(Buffer.from(await page.evaluate((id) => {
  const canvas = document.getElementById(id);
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let text = "";
  for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
  return btoa(text);
}, panel), "base64"));

/** The mean and the standard deviation of all colours, from 0 to 255. */
function spread(image) {
  const colours = image.filter((_, i) => i % 4 < 3);
  const mean = colours.reduce((sum, x) => sum + x, 0) / colours.length;
  return { mean, deviation: Math.sqrt(colours.reduce((sum, x) => sum + (x - mean) ** 2, 0) / colours.length) };
}

/** The mean difference of two pictures' colours, and the share of pixels that differ by more than 8 in one. */
function apart(a, b) {
  if (a.length !== b.length) return { mean: 255, share: 1 };
  let [sum, many] = [0, 0];
  for (let i = 0; i < a.length; i += 4) {
    const differences = [0, 1, 2].map((k) => Math.abs(a[i + k] - b[i + k]));
    sum += differences.reduce((x, y) => x + y);
    many += Math.max(...differences) > 8;
  }
  return { mean: sum / (0.75 * a.length), share: many / (a.length / 4) };
}

/** Does something, waits for the figures, and tells how far the picture moved. */
async function act(page, job) {
  const old = await pixels(page, "chosen");
  await job();
  const figures = await ready(page);
  return { figures, moved: apart(old, await pixels(page, "chosen")).mean };
}

// ---- the kernels of the page, on numbers ----

const checks = JSON.parse(await readFile(join(work, "checks.json")));

async function kernels(page, api) {
  for (const { name, count } of checks) {
    await page.evaluate(async ([api, name, count]) => {
      const inputs = new Float32Array(await (await fetch(`/inputs/${name}.in`)).arrayBuffer());
      const body = await window.zonal.check(api, name, count, inputs);
      await fetch(`/outputs/${name}.${api}`, { method: "POST", body });
    }, [api, name, count]);
  }
}

// ---- every control ----

async function controls(page) {
  const seen = { first: await ready(page), methods: {}, selects: {}, unlabelled: [], ringless: [] };
  const start = await pixels(page, "chosen");
  seen.blank = { chosen: spread(start), exact: spread(await pixels(page, "exact")), every: spread(await pixels(page, "every")) };
  const ids = await page.$$eval("select, input, button, #stage", (all) => all.map(({ id }) => id).filter(Boolean));
  const nameless = (all) => all.filter((e) => !e.labels?.length && !e.getAttribute("aria-label") && !e.textContent.trim());
  seen.unlabelled = await page.$$eval("select, input, button, [tabindex], canvas", new Function("all", `return (${nameless})(all).map((e) => e.outerHTML)`));

  // What a method adds is seen against the exact picture of the same order.
  seen.against = await page.inputValue("#against");
  await act(page, () => page.selectOption("#against", "exact"));
  for (const method of await page.$$eval("#method option", (all) => all.map(({ value }) => value))) {
    const { figures } = await act(page, () => page.selectOption("#method", method));
    seen.methods[method] = figures;
    if (method === "exact") seen.black = Math.max(...(await pixels(page, "difference")).filter((_, i, all) => i % 4 < 3 && !isGround(all, i)));
    if (method === "none") seen.colourful = spread(await pixels(page, "difference"));
  }
  await act(page, () => page.selectOption("#method", "tilt"));
  for (const id of ["mesh", "brdf", "normals", "light", "resolution"]) {
    const values = await page.$$eval(`#${id} option`, (all) => all.map(({ value }) => value));
    const chosen = await page.inputValue(`#${id}`);
    seen.selects[id] = [];
    // Finer pictures than these take a software driver long.
    for (const value of values.filter((value) => value !== chosen && !(id === "resolution" && value !== "1"))) {
      const { figures, moved } = await act(page, () => page.selectOption(`#${id}`, value));
      seen.selects[id].push({ value, moved, pixels: figures.pixels, mean: figures.mean, worst: figures.worst, bound: figures.predicted.worst });
    }
    await act(page, () => page.selectOption(`#${id}`, chosen));
  }

  const keys = async (id, key) => {
    await page.focus(`#${id}`);
    return act(page, () => page.keyboard.press(key));
  };
  seen.strength = { least: await keys("strength", "Home"), most: await keys("strength", "End") };
  await page.fill("#strength", "0.35");
  seen.exposure = {};
  for (const key of ["End", "Home"]) {
    await keys("exposure", key);
    seen.exposure[key] = spread(await pixels(page, "chosen")).mean;
  }
  await page.fill("#exposure", "0");
  await ready(page);
  seen.back = apart(start, await pixels(page, "chosen"));
  seen.orders = { least: await keys("order", "Home"), most: await keys("order", "End"), step: await keys("order", "ArrowLeft") };
  await page.fill("#order", "5");
  await ready(page);

  await page.focus("#stage");
  seen.stage = {};
  for (const key of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-"]) {
    const { figures, moved } = await act(page, () => page.keyboard.press(key));
    seen.stage[key] = { moved, azimuth: figures.azimuth, elevation: figures.elevation, distance: figures.distance, pixels: figures.pixels };
  }
  const box = await (await page.$("#exact")).boundingBox();
  const drag = async () => {
    await page.mouse.move(box.x + 40, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 120, box.y + 90, { steps: 4 });
    await page.mouse.up();
  };
  seen.drag = await act(page, drag);
  seen.wheel = await act(page, async () => {
    await page.focus("#stage");
    await page.mouse.move(box.x + 60, box.y + 60);
    await page.mouse.wheel(0, 300);
  });
  seen.reset = await act(page, () => page.click("#reset"));
  seen.home = apart(start, await pixels(page, "chosen"));

  const note = await page.textContent("#measured-note");
  await page.check("#rotate");
  await page.waitForFunction((old) => document.getElementById("measured-note").textContent !== old, note);
  await page.waitForTimeout(500);
  await page.uncheck("#rotate");
  seen.rotated = (await ready(page)).azimuth;
  await act(page, () => page.click("#reset"));

  await page.click("#measure-all");
  await page.waitForFunction(() => !document.getElementById("measure-all").disabled);
  seen.table = await page.$$eval("#methods tbody tr", (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
  await act(page, () => page.click("#methods tbody tr:last-child button"));
  seen.row = await page.inputValue("#method");
  seen.status = await page.textContent("#status");
  seen.source = await page.evaluate(async () => (await (await fetch(document.getElementById("source").href)).text()).slice(0, 300));

  // By the keyboard alone, every control is reached and shows that it has the focus.
  await page.evaluate(() => document.activeElement.blur());
  const reached = new Set();
  for (let i = 0; i < 60; i++) {
    await page.keyboard.press("Tab");
    const { id, ring } = await page.evaluate(() => {
      const element = document.activeElement;
      return { id: element.id, ring: parseFloat(getComputedStyle(element).outlineWidth) };
    });
    if (id && !(ring >= 2)) seen.ringless.push(id);
    reached.add(id);
  }
  seen.unreached = ids.filter((id) => !reached.has(id));

  await act(page, () => page.evaluate(() => { location.hash += "&order=3"; }));
  seen.typed = await page.inputValue("#order");
  seen.address = await page.evaluate(() => location.hash);
  await page.reload();
  await page.waitForFunction(() => document.body.dataset.state === "ready");
  seen.recalled = (await ready(page)).method;
  return seen;
}

/** Whether the colour of a byte's pixel is that of the ground behind the difference. */
function isGround(image, i) {
  const at = i - (i % 4);
  return Math.abs(image[at] - 27) < 3 && Math.abs(image[at + 1] - 34) < 3 && Math.abs(image[at + 2] - 44) < 3;
}

try {
  const pages = {};
  for (const api of APIS) pages[api] = await visit(`api=${api}`);
  for (const api of APIS) await kernels(pages[api], api);

  facts.apis = {};
  const same = {};
  for (const api of APIS) {
    facts.apis[api] = { first: await ready(pages[api]), message: await pages[api].textContent("#message") };
    same[api] = await Promise.all(["chosen", "exact", "every", "difference"].map((panel) => pixels(pages[api], panel)));
  }
  facts.agree = [0, 1, 2, 3].map((i) => apart(same.webgl2[i], same.webgpu[i]));

  facts.controls = await controls(pages.webgl2);
  const switched = pages.webgpu;
  facts.switched = [];
  for (const api of ["webgl2", "webgpu"]) {
    const { figures, moved } = await act(switched, () => switched.selectOption("#api", api));
    facts.switched.push({ api: figures.api, moved });
  }
  await switched.screenshot({ path: join(work, "wide.png"), fullPage: true });

  const withoutGpu = () => Object.defineProperty(Navigator.prototype, "gpu", { get: () => undefined });
  const fallback = await visit("api=webgpu", { before: withoutGpu });
  facts.fallback = { api: (await ready(fallback)).api, message: await fallback.textContent("#message"), select: await fallback.inputValue("#api") };
  const withoutAny = () => {
    Object.defineProperty(Navigator.prototype, "gpu", { get: () => undefined });
    HTMLCanvasElement.prototype.getContext = new Proxy(HTMLCanvasElement.prototype.getContext, {
      apply: (get, canvas, [kind, ...rest]) => (kind === "webgl2" ? null : Reflect.apply(get, canvas, [kind, ...rest])),
    });
  };
  const nothing = await visit("api=webgpu", { before: withoutAny });
  facts.nothing = { state: await nothing.getAttribute("body", "data-state"), message: await nothing.textContent("#message") };

  // This server takes no maps: the page says so.
  await fallback.setInputFiles("#own", { name: "a.hdr", mimeType: "application/octet-stream", buffer: Buffer.from("a map") });
  await fallback.waitForFunction(() => document.getElementById("message").textContent.includes("exported"));
  facts.exported = await fallback.textContent("#message");
  facts.errors = facts.errors.map((errors) => errors.filter((error) => !/status of (404|405)/.test(JSON.stringify(error))));

  const phone = await visit("api=webgl2&mesh=bunny", { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true });
  const first = await ready(phone);
  facts.phone = await phone.evaluate(() => ({
    overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    small: [...document.querySelectorAll("select, #controls button")].filter((e) => e.getBoundingClientRect().height < 36).map(({ id }) => id),
  }));
  await phone.screenshot({ path: join(work, "phone.png"), fullPage: true });
  await phone.evaluate(() => scrollTo(0, 0));
  const touch = await phone.context().newCDPSession(phone);
  const finger = (type, x, y) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ x, y }] });
  const canvas = await (await phone.$("#chosen")).boundingBox();
  const [x, y] = [canvas.x + 100, canvas.y + 100];
  facts.phone.touch = await act(phone, async () => {
    await finger("touchStart", x, y);
    for (let i = 1; i <= 5; i++) await finger("touchMove", x + 12 * i, y);
    await finger("touchEnd");
  });
  facts.phone.turned = facts.phone.touch.figures.azimuth - first.azimuth;

  if (process.env.SCREENSHOT) {
    const shown = await visit("api=webgl2&resolution=2", { viewport: { width: 1280, height: 900 } });
    await shown.click("#measure-all");
    await shown.waitForFunction(() => !document.getElementById("measure-all").disabled, null, { timeout: 300000 });
    await shown.evaluate(() => document.activeElement.blur());
    await shown.mouse.move(0, 0);
    await shown.screenshot({ path: join(work, "explorer.png"), fullPage: true });
  }
  facts.version = browser.version();
  console.log(JSON.stringify(facts));
} finally {
  await browser.close();
  await server.close();
}
