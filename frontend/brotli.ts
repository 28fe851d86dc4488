/**
 * Compress what the pages load once, when they are built, better than a server could per request.
 *
 * Brotli makes scripts about a tenth smaller than gzip does. `NAME.br` is written beside each file
 * for which it is worth it; app/api/pages.py sends it to browsers that take it.
 */
import { readFile, writeFile } from "node:fs/promises";
import { extname, resolve } from "node:path";
import { promisify } from "node:util";
import { constants, brotliCompress as withCallback } from "node:zlib";
import type { Plugin } from "vite";

const brotliCompress = promisify(withCallback);
/** Pictures and fonts are compressed already. */
const KINDS = new Set([".js", ".css", ".svg", ".json", ".wasm"]);
const SMALL_BYTES = 1024;
/** The best quality takes a second per megabyte and more: for megabytes the next one is enough. */
const LARGE_BYTES = 1_000_000;
const [BEST, GOOD] = [11, 9];

export function brotli(): Plugin {
  return {
    name: "brotli",
    apply: "build",
    enforce: "post",
    async writeBundle({ dir = "" }, bundle) {
      const files = Object.keys(bundle).filter((one) => KINDS.has(extname(one)));
      await Promise.all(files.map((one) => compress(resolve(dir, one))));
    },
  };
}

async function compress(file: string): Promise<void> {
  const content = await readFile(file);
  if (content.length <= SMALL_BYTES) return;
  const quality = content.length > LARGE_BYTES ? GOOD : BEST;
  const params = {
    [constants.BROTLI_PARAM_QUALITY]: quality,
    [constants.BROTLI_PARAM_SIZE_HINT]: content.length,
  };
  const compressed = await brotliCompress(content, { params });
  if (compressed.length < content.length) await writeFile(`${file}.br`, compressed);
}
