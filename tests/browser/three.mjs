// Asks the page below `three` what three.js does, and prints its answer as JSON on the standard output; what must hold of
// it is written in tests/gpu/tests/it/three.rs.
//
//     node three.mjs WORK lit|probed
//
// WORK holds `job.json`. To have normals lit by three.js's own shader and by a kernel of zonal, in WebGL2: `normals`, `probe` (the coefficients of a light probe), `coefficients` and the `kernel` that
// takes them, in GLSL, with its `name`. For the light probe of a cubemap: `faces`, the bytes of six images.

import { access, readFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, open, serve } from "./launch.mjs";

const here = dirname(fileURLToPath(import.meta.url));
await access(join(here, "node_modules/three/build/three.module.js")).catch(() => {
  throw new Error("three is missing; install it: npm ci --prefix tests/browser");
});
const job = JSON.parse(await readFile(join(process.argv[2], "job.json"), "utf8"));
const server = await serve(here);
const browser = await launch();
try {
  const { page, errors } = await open(browser, `${server.url}/three/`);
  await page.waitForFunction(() => window.lit);
  const answer = await page.evaluate(([what, given]) => window[what](given), [process.argv[3], job]);
  if (errors.length) throw new Error(errors.join("\n"));
  process.stdout.write(JSON.stringify(answer));
} finally {
  await browser.close();
  await server.close();
}
