// Works the explorer with things of one's own, as `zonal explore` serves them, and tells what it saw as JSON on the standard
// output; what of it must hold is written in tests/gpu/tests/it/explorer.rs.
//
//     node own.mjs URL WORK
//
// URL is where the page is served. WORK holds the maps: `sky.hdr`, the faces `px.hdr` to `nz.hdr`, `no-map.txt`.

import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { launch, open } from "./launch.mjs";

const [url, work] = process.argv.slice(2);
const FACES = ["px", "nx", "py", "ny", "pz", "nz"].map((name) => `${name}.hdr`);
const browser = await launch();
const facts = { orders: {} };

/** A page whose pictures are so small that brute force can look at each of their pixels. */
async function visit(choices) {
  const context = await browser.newContext({ viewport: { width: 780, height: 700 } });
  const opened = await open(context, `${url}/#resolution=0.5&${choices}`);
  await opened.page.waitForFunction(() => ["ready", "failed"].includes(document.body.dataset.state), null, { timeout: 120000 });
  return opened;
}

const ready = (page) => page.evaluate(() => window.zonal.ready());

/** How many pixels of a picture are red, as normals beyond a domain are, and the brightest byte of all. */
const look = (page, panel) => page.evaluate((id) => {
  const canvas = document.getElementById(id);
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let [red, most] = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = data.subarray(i, i + 3);
    red += r > 150 && g < 0.6 * r && b < 0.6 * r;
    // The ground behind a difference is dark blue.
    if (Math.abs(r - 27) > 3 || Math.abs(g - 34) > 3 || Math.abs(b - 44) > 3) most = Math.max(most, r, g, b);
  }
  return { red, most };
}, panel);

const light = (page) => page.$eval("#light", (select) => ({ value: select.value, label: select.selectedOptions[0].textContent }));

/** Waits until another light is shown, and tells what the page says of it. */
async function taken(page, before) {
  await page.waitForFunction((old) => document.getElementById("light").value !== old, before, { timeout: 60000 });
  const figures = await ready(page);
  return { figures, ...(await light(page)), told: await page.textContent("#light-note"), message: await page.textContent("#message") };
}

try {
  const { page, errors } = await visit("api=webgl2");
  facts.first = { ...(await light(page)), figures: await ready(page), words: await page.textContent("#every-words") };
  for (const order of [2, 5, 10]) {
    await page.fill("#order", String(order));
    facts.orders[order] = { ...(await ready(page)), verdict: await page.textContent("#verdict") };
  }
  await page.fill("#order", "5");
  await ready(page);
  const second = await visit("api=webgpu&order=5");
  facts.webgpu = await ready(second.page);
  facts.errors = [second.errors];
  await second.page.context().close();

  await page.selectOption("#method", "exact");
  const exact = await ready(page);
  await page.selectOption("#against", "exact");
  await ready(page);
  facts.against = { exact: await look(page, "difference"), figures: exact };
  await page.selectOption("#against", "all");
  await ready(page);
  facts.against.all = await look(page, "difference");
  await page.selectOption("#method", "tilt");
  await page.fill("#strength", "2");
  const steep = await ready(page);
  facts.red = { before: await look(page, "chosen"), share: steep.beyond, pixels: steep.pixels, text: await page.textContent("#beyond") };
  await page.check("#domain");
  await ready(page);
  facts.red.after = await look(page, "chosen");
  await page.selectOption("#method", "exact");
  facts.red.exact = { ...(await ready(page)), ...(await look(page, "chosen")) };
  await page.selectOption("#method", "tilt");
  await page.fill("#strength", "0.25");
  await ready(page);

  await page.click("#measure-orders");
  await page.waitForFunction(() => !document.getElementById("measure-orders").disabled, null, { timeout: 120000 });
  facts.plots = await page.evaluate(() => ({
    dots: document.querySelectorAll("#orders .measured").length,
    bars: document.querySelectorAll("#bands rect").length,
    held: document.querySelectorAll("#bands .held").length,
    label: document.getElementById("orders").getAttribute("aria-label"),
    series: document.getElementById("series-note").textContent,
    maps: ["map", "series"].map((id) => [document.getElementById(id).width, document.getElementById(id).height]),
  }));

  let shown = (await light(page)).value;
  await page.setInputFiles("#own", join(work, "sky.hdr"));
  facts.chosen = await taken(page, shown);
  shown = facts.chosen.value;
  const faces = await Promise.all(FACES.map(async (name) => [name, (await readFile(join(work, name))).toString("base64")]));
  const drag = (files) => page.evaluate((files) => {
    const transfer = new DataTransfer();
    for (const [name, text] of files) transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
    for (const type of ["dragover", "drop"]) document.body.dispatchEvent(new DragEvent(type, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, files);
  await drag(faces);
  facts.dropped = await taken(page, shown);
  facts.errors.push([...errors]);

  const refused = async (act, old) => {
    await act();
    await page.waitForFunction((old) => !["", old].includes(document.getElementById("message").textContent) && !document.getElementById("message").textContent.startsWith("Reading"), old, { timeout: 60000 });
    return page.textContent("#message");
  };
  facts.refused = [await refused(() => page.setInputFiles("#own", join(work, "no-map.txt")), "")];
  facts.refused.push(await refused(() => drag(faces.slice(1)), facts.refused[0]));
  facts.still = (await light(page)).value;
  await page.screenshot({ path: join(work, "own.png"), fullPage: true });
  console.log(JSON.stringify(facts));
} finally {
  await browser.close();
}
