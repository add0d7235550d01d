/** Compressed files beside those of the build: app/http/static_files.cpp sends them to who understands them. */
import { readdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import type { Plugin } from "vite";

/** The same bytes on every machine: gzip has neither time nor name in its header. */
const encoders = {
  br: (bytes: Buffer) =>
    brotliCompressSync(bytes, {
      params: {
        [constants.BROTLI_PARAM_QUALITY]: constants.BROTLI_MAX_QUALITY,
        [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
      },
    }),
  gz: (bytes: Buffer) => gzipSync(bytes, { level: constants.Z_BEST_COMPRESSION }),
};

/** What is left of a file at most, else it is sent as it is. */
const worthwhile = 0.95;

/** Writes `x.br` and `x.gz` for each file `x` of the build that they make smaller. */
export function compress(): Plugin {
  let folder = "";
  return {
    name: "interlock-compress",
    apply: "build",
    configResolved: (config) => {
      folder = join(config.root, config.build.outDir);
    },
    closeBundle: async () => {
      for (const entry of await readdir(folder, { recursive: true, withFileTypes: true })) {
        if (!entry.isFile()) continue;
        const file = join(entry.parentPath, entry.name);
        const bytes = await readFile(file);
        for (const [ending, encoded] of Object.entries(encoders)) {
          const smaller = encoded(bytes);
          if (smaller.length <= worthwhile * bytes.length) await writeFile(`${file}.${ending}`, smaller);
        }
      }
    },
  };
}
