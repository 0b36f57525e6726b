// The worker in JavaScript of `peers.py`: splat-transform's rotation of splats, read through `bakeTransform`, as its command
// does. `node splats.mjs PACKAGE INPUTS RESULTS` says its rows, one a line, ends them with an empty line, and answers each
// number of a row with nanoseconds a splat; `results` writes what the rows gave.

import { readFileSync, writeFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';

const [entry, inputs, results] = process.argv.slice(2);
const { Transform, bakeTransform } = await import(pathToFileURL(entry).href);

const COUNT = 1024;
const PASSES = 5;
const numbers = (name) => {
    const bytes = readFileSync(`${inputs}/${name}`);
    return new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
};
const signals = numbers('signals');
const turn = new Transform();
turn.rotation.set(...numbers('quaternions').subarray(0, 4));

/** Splats of an order: what is read of them, and where it is read to. */
function splats(order) {
    const [n, width] = [order * order, 3 * order * order];
    const rows = new Float32Array(COUNT * width);
    for (let i = 0; i < COUNT; i++) {
        for (let channel = 0; channel < 3; channel++) {
            const c = signals.subarray(i * 100 + channel * n, i * 100 + (channel + 1) * n);
            rows[i * width + channel] = c[0];
            rows.set(c.subarray(1), i * width + 3 + channel * (n - 1));
        }
    }
    const written = new Float32Array(rows.length);
    const source = {
        meta: { shBands: order - 1, transform: turn },
        read: async () => written.set(rows),
        close: async () => {},
    };
    const baked = bakeTransform(source, new Transform());
    const color = { data: written.buffer, count: COUNT };
    return { name: `splats ${order} splat-transform`, run: () => baked.read({ chunkIndex: 0, color }), written };
}

const jobs = [2, 3, 4].map(splats);
process.stdout.write(jobs.map((job) => `${job.name}\n`).join('') + '\n');
for await (const line of createInterface({ input: process.stdin })) {
    if (line === 'results') {
        jobs.forEach((job, place) => writeFileSync(`${results}/result.${place}`, new Float64Array(job.written)));
        process.stdout.write('\n');
        continue;
    }
    let best = Infinity;
    for (let pass = 0; pass < PASSES; pass++) {
        const start = process.hrtime.bigint();
        await jobs[Number(line)].run();
        best = Math.min(best, Number(process.hrtime.bigint() - start) / COUNT);
    }
    process.stdout.write(`${best}\n`);
}
