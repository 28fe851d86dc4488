/** The modules that `frontend/helpPages.ts` generates while the pages are built. */
declare module "virtual:help" {
  export const parts: readonly import("./nodes").HelpPart[];
}
