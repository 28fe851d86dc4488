/**
 * The console's texts as one module for each language, so that a page loads only the one it shows.
 *
 * The texts are written side by side, which keeps both languages complete; a bundler would therefore
 * send both. `virtual:texts/en` and `virtual:texts/de` contain one table each.
 */
import { resolve } from "node:path";
import { type Plugin, runnerImport } from "vite";

const MODULE = "virtual:texts/";
const TABLES = "console/i18n/tables.ts";

type Table = Readonly<Record<string, string>>;
type Tables = Readonly<Record<string, Table>>;

export function textTables(source: string, alias: Readonly<Record<string, string>>): Plugin {
  const file = resolve(source, TABLES);
  return {
    name: "text-tables",
    resolveId: (id) => (id.startsWith(MODULE) ? `\0${id}` : undefined),
    async load(id) {
      if (!id.startsWith(`\0${MODULE}`)) return undefined;
      const language = id.slice(MODULE.length + 1);
      const { module, dependencies } = await runnerImport<{ readonly tables: Tables }>(file, {
        configFile: false,
        root: source,
        resolve: { alias },
        logLevel: "error",
      });
      for (const one of [file, ...dependencies]) this.addWatchFile(resolve(source, one));
      const table = module.tables[language];
      if (table === undefined) throw new Error(`There are no texts in the language ${language}.`);
      // A string is read faster than a literal of thousands of properties.
      const text = JSON.stringify(JSON.stringify(table));
      return { code: `export default JSON.parse(${text});`, moduleType: "js" };
    },
  };
}
