/** The module that `frontend/helpPages.ts` makes while the pages are built. */
declare module "virtual:help" {
  export const parts: readonly import("./nodes").HelpPart[];
}
