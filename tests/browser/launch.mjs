// What every browser test starts from: a server of a folder on 127.0.0.1, which a page needs to have WebGPU, and Debian's
// Chromium without a window, with WebGPU and WebGL2 on SwiftShader. What is missing is an error that says how to get it.

import { createReadStream } from "node:fs";
import { access, constants, stat } from "node:fs/promises";
import { createServer } from "node:http";
import { delimiter, extname, join, normalize, resolve, sep } from "node:path";

const NAMES = ["chromium", "chromium-browser", "google-chrome"];

const ARGUMENTS = [
  "--no-sandbox",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--enable-unsafe-webgpu",
  "--use-webgpu-adapter=swiftshader",
];

const TYPES = {
  ".bin": "application/octet-stream",
  ".css": "text/css",
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".json": "application/json",
  ".mjs": "text/javascript",
  ".png": "image/png",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
};

/** The browser's program: the first of the known names on PATH. */
export async function findChromium() {
  const folders = (process.env.PATH ?? "").split(delimiter);
  for (const path of NAMES.flatMap((name) => folders.map((folder) => join(folder, name)))) {
    const found = await access(path, constants.X_OK).then(() => true, () => false);
    if (found) return path;
  }
  throw new Error("Chromium is missing; install it: apt-get install -y --no-install-recommends chromium");
}

/** Starts the browser. Close it when done: `await browser.close()`. */
export async function launch() {
  const { chromium } = await import("playwright-core").catch(() => {
    throw new Error("playwright-core is missing; install it: npm ci --prefix tests/browser");
  });
  return chromium.launch({ executablePath: await findChromium(), headless: true, args: ARGUMENTS });
}

/**
 * Serves a folder on a free port of 127.0.0.1. `routes(request, response)` may answer first: it returns true if it has
 * taken the request. Returns the address, without a slash at its end, and a function that ends the server.
 */
export async function serve(folder, routes = () => false) {
  const root = resolve(folder);
  const server = createServer(async (request, response) => {
    if (await routes(request, response)) return;
    const asked = decodeURIComponent(new URL(request.url, "http://127.0.0.1").pathname);
    const path = join(root, normalize(asked.endsWith("/") ? `${asked}index.html` : asked));
    const inside = path.startsWith(root + sep);
    const found = inside && (await stat(path).then((file) => file.isFile(), () => false));
    if (!found) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" });
    createReadStream(path).pipe(response);
  });
  await new Promise((listening, failed) => server.once("error", failed).listen(0, "127.0.0.1", listening));
  const close = () => {
    server.closeAllConnections();
    return new Promise((closed) => server.close(closed));
  };
  return { url: `http://127.0.0.1:${server.address().port}`, close };
}

/** Opens an address in a new page; what the page says as an error, or throws, is collected in the list `errors`. */
export async function open(browser, url, options = {}) {
  const page = await browser.newPage(options);
  const errors = [];
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(url);
  return { page, errors };
}
