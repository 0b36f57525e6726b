// The browser as a device of the bench: takes jobs on its standard input, runs them in a page, answers on its standard
// output. A message is two lengths (32 bits, little-endian), JSON of the first and numbers of the second. The first answer
// says what computes; after that each job has one, with an `error` if the page throws.

import { fileURLToPath } from "node:url";
import { launch, open, serve } from "./launch.mjs";

const LENGTHS = 8;

async function* messages(stream) {
  let held = [];
  let size = 0;
  const take = (length) => {
    const all = Buffer.concat(held);
    held = [all.subarray(length)];
    size -= length;
    return all.subarray(0, length);
  };
  let lengths = null;
  for await (const chunk of stream) {
    held.push(chunk);
    size += chunk.length;
    while (true) {
      if (!lengths && size >= LENGTHS) {
        const head = take(LENGTHS);
        lengths = [head.readUInt32LE(0), head.readUInt32LE(4)];
      }
      if (!lengths || size < lengths[0] + lengths[1]) break;
      const head = take(lengths[0]);
      yield { head, body: take(lengths[1]) };
      lengths = null;
    }
  }
}

function answer(head, body = Buffer.alloc(0)) {
  const text = Buffer.from(JSON.stringify(head));
  const lengths = Buffer.alloc(LENGTHS);
  lengths.writeUInt32LE(text.length, 0);
  lengths.writeUInt32LE(body.length, 4);
  return new Promise((written) => process.stdout.write(Buffer.concat([lengths, text, body]), written));
}

/** What the page fetches and what it sends: texts and numbers are too long for the pipe to the page. */
const exchange = { "/job": Buffer.alloc(0), "/inputs": Buffer.alloc(0), "/outputs": Buffer.alloc(0) };

async function routes(request, response) {
  if (!(request.url in exchange)) return false;
  if (request.method === "POST") {
    const parts = [];
    for await (const part of request) parts.push(part);
    exchange[request.url] = Buffer.concat(parts);
    response.writeHead(204).end();
  } else {
    const head = { "content-type": "application/octet-stream", "cache-control": "no-store" };
    response.writeHead(200, head).end(exchange[request.url]);
  }
  return true;
}

const server = await serve(fileURLToPath(new URL("bench", import.meta.url)), routes);
const browser = await launch();
const { page, errors } = await open(browser, `${server.url}/`);
const call = (name) => page.evaluate(async (name) => (await import("/bench.js"))[name](), name);
await answer({ version: browser.version(), ...(await call("names")) });
for await (const { head, body } of messages(process.stdin)) {
  exchange["/job"] = head;
  exchange["/inputs"] = body;
  const thrown = await call("run").then(() => [], (error) => [error.message]);
  const error = [...thrown, ...errors.splice(0)].join("\n");
  if (error) await answer({ error });
  else await answer({}, exchange["/outputs"]);
}
await browser.close();
await server.close();
