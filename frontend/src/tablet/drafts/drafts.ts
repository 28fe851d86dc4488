import { DraftStore } from "./store";

/** What is stored on this tablet. */
export const drafts = new DraftStore();
