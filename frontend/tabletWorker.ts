/**
 * Add the build's version and list of files to the tablet's service worker.
 *
 * The worker is an entry of its own with a fixed name. The files of the tablet's page are known
 * only
 * after everything is written: their list, with a hash of all of them, is then prepended to the
 * worker, so that the browser sees each build as a different worker.
 */
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import type { Plugin } from "vitest/config";

export const WORKER = "tablet-worker";
export const TABLET_MANIFEST = ".vite/tablet.json";
const PAGE = "tablet/index.html";

interface Part {
  readonly file: string;
  readonly imports?: readonly string[];
  readonly dynamicImports?: readonly string[];
  readonly css?: readonly string[];
  readonly assets?: readonly string[];
}

type Manifest = Readonly<Record<string, Part>>;

export function tabletWorker(): Plugin {
  return {
    name: "tablet-worker",
    apply: "build",
    writeBundle({ dir = "" }) {
      const read = (name: string) => readFileSync(resolve(dir, name), "utf8");
      const worker = `${WORKER}.js`;
      const code = read(worker);
      if (/\bimport\b|\bexport\b/.test(code)) {
        this.error("The tablet's service worker must be one script without imports and exports.");
      }
      const files = filesOf(JSON.parse(read(TABLET_MANIFEST)) as Manifest, PAGE);
      const version = createHash("sha256")
        .update([code, read(PAGE), ...files].join("\n"))
        .digest("hex")
        .slice(0, 16);
      const build = { version, page: "/tablet", files: files.map((file) => `/${file}`) };
      writeFileSync(resolve(dir, worker), `self.BUILD=${JSON.stringify(build)};\n${code}`);
    },
  };
}

/** All files that a page loads, directly or lazily, with its own script first. */
function filesOf(manifest: Manifest, page: string): readonly string[] {
  const files = new Set<string>();
  const seen = new Set<string>();
  const follow = (key: string) => {
    const part = manifest[key];
    if (part === undefined || seen.has(key)) return;
    seen.add(key);
    for (const file of [part.file, ...(part.css ?? []), ...(part.assets ?? [])]) files.add(file);
    for (const next of [...(part.imports ?? []), ...(part.dynamicImports ?? [])]) follow(next);
  };
  follow(page);
  return [...files];
}
