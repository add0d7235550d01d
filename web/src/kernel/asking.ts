/** Asks the kernel in the page about what the newest frame shows. */
import kernelUrl from "../../kernel/kernel.wasm?url";
import type { KernelConfiguration } from "../api/client";
import type { Frame } from "../stream/decode";
import { PageKernel } from "./pageKernel";

/** A kernel in the page that has taken over a configuration. */
export interface ConfiguredKernel {
  readonly kernel: PageKernel;
  readonly configCrc: string;
}

let loaded: Promise<WebAssembly.Module> | null = null;

/** Loads the module once; a load that failed is tried again. */
function module(): Promise<WebAssembly.Module> {
  loaded ??= WebAssembly.compileStreaming(fetch(kernelUrl)).catch((error: unknown) => {
    loaded = null;
    throw error;
  });
  return loaded;
}

/** A kernel with that configuration; null when the module cannot be had, or refuses the configuration. */
export async function kernelWith(configuration: KernelConfiguration): Promise<ConfiguredKernel | null> {
  try {
    const kernel = new PageKernel(await WebAssembly.instantiate(await module()));
    return kernel.configure(bytesOf(configuration.words)) ? { kernel, configCrc: configuration.crc } : null;
  } catch {
    return null;
  }
}

/** What the kernel says of the frame; null when it cannot: no kernel, another configuration, a damaged state. */
export function ask<Answer>(
  configured: ConfiguredKernel | null,
  frame: Frame | null,
  question: (kernel: PageKernel) => Answer,
): Answer | null {
  if (configured === null || frame === null || !frame.connected) return null;
  if (frame.configCrc !== configured.configCrc || !configured.kernel.see(frame.state)) return null;
  return question(configured.kernel);
}

/** Little-endian, as WebAssembly has it. */
function bytesOf(words: readonly number[]): Uint8Array {
  const view = new DataView(new ArrayBuffer(words.length * 4));
  words.forEach((word, index) => {
    view.setUint32(index * 4, word, true);
  });
  return new Uint8Array(view.buffer);
}
