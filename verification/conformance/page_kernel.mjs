// Runs a program whose calls (page_calls.c) the kernel of the console's page answers: node page_kernel.mjs MODULE
// PROGRAM ARGUMENT... Ends with the program's exit status.
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";

const ARGUMENTS = 4;
const HEAD_BYTES = 4 * (1 + ARGUMENTS);

const [file, program, ...rest] = process.argv.slice(2);
const instance = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(file)));
const { memory, ilk_request_judge, ilk_output_gate } = instance.exports;
const functions = [ilk_request_judge, ilk_output_gate];
const at = memory.grow(1) * 65536;

/** Answers the call that begins the bytes; gives its length, 0 while it is not whole. */
function answer(bytes, reply) {
  if (bytes.length < HEAD_BYTES) return 0;
  const lengths = Array.from({ length: ARGUMENTS }, (_, index) => bytes.readUInt32LE(4 * (1 + index)));
  const end = lengths.reduce((sum, length) => sum + length, HEAD_BYTES);
  if (bytes.length < end) return 0;
  new Uint8Array(memory.buffer, at).set(bytes.subarray(HEAD_BYTES, end));
  let next = at;
  const pointers = lengths.map((length) => {
    next += length;
    return next - length;
  });
  const word = Buffer.alloc(4);
  word.writeUInt32LE(functions[bytes.readUInt32LE(0)](...pointers) >>> 0);
  reply.write(word);
  return end;
}

const run = spawn(program, rest, { stdio: ["ignore", "inherit", "inherit", "pipe", "pipe"] });
const [, , , calls, answers] = run.stdio;
let left = Buffer.alloc(0);
calls.on("data", (chunk) => {
  left = Buffer.concat([left, chunk]);
  for (let used = answer(left, answers); used > 0; used = answer(left, answers)) left = left.subarray(used);
});
run.on("exit", (code) => {
  process.exitCode = code ?? 1;
});
