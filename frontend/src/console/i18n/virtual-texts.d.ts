/** The modules that `frontend/textTables.ts` generates while the pages are built. */
declare module "virtual:texts/*" {
  const table: Readonly<Record<string, string>>;
  export default table;
}
