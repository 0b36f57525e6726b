// What three.js makes of functions: reads a list of { language, text } from the file named first, and prints for each the
// name, the type and the inputs that glslFn or wgslFn sees.

import { readFileSync } from 'node:fs';
import GLSLNodeFunction from 'three/src/nodes/parsers/GLSLNodeFunction.js';
import WGSLNodeFunction from 'three/src/renderers/webgpu/nodes/WGSLNodeFunction.js';

const parsers = { glsl: GLSLNodeFunction, wgsl: WGSLNodeFunction };
const jobs = JSON.parse(readFileSync(process.argv[2], 'utf8'));
const seen = jobs.map(({ language, text }) => {
    try {
        const { name, type, inputs } = new parsers[language](text);
        return { name, type, inputs: inputs.map((input) => input.name) };
    } catch (error) {
        return { error: error.message };
    }
});
console.log(JSON.stringify(seen));
