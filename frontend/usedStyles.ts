/**
 * Check that a page which imports the styles of some Mantine components imports those it uses.
 *
 * All styles together are 250 kB, of which a small page needs a tenth. A component without its style
 * would be drawn bare, which no compiler notices: the build fails instead, and names it.
 */
import { existsSync, readFileSync } from "node:fs";
import { resolve } from "node:path";
import type { Plugin } from "vite";

const STYLES = resolve(import.meta.dirname, "node_modules/@mantine/core/styles");
/** Of a component, or of what several of them share, such as the label beside a checkbox. */
const COMPONENT = /@mantine\/core\/.*\/(\w+)\/[^/]+$/;

/** @param sheet the stylesheet with an `@import` of each component's style */
export function usedStyles(sheet: string): Plugin {
  return {
    name: "used-styles",
    apply: "build",
    generateBundle(_options, bundle) {
      const imported = readFileSync(sheet, "utf8");
      const used = Object.values(bundle)
        .flatMap((one) => (one.type === "chunk" ? one.moduleIds : []))
        .map((id) => COMPONENT.exec(id.replaceAll("\\", "/"))?.[1])
        .filter((name) => name !== undefined && existsSync(resolve(STYLES, `${name}.css`)));
      const missing = [...new Set(used)].filter((name) => !imported.includes(`/${name}.css"`));
      if (missing.length > 0) {
        this.error(`${sheet} lacks the styles of ${missing.sort().join(", ")}.`);
      }
    },
  };
}
