/** The script of the page: it shows what can be shown at once, and loads the application. */
import "./mantine.css";
import "./tablet.css";
import "@shared/theme/tokens.css";
import "@shared/theme/narrow.css";
import { reload } from "@shared/ui/unloaded";
import { beginEarly } from "./early/begin";

const RETRY_MS = 5000;

async function start(): Promise<void> {
  const root = document.getElementById("root");
  if (root === null) throw new Error("The page has no element #root to draw into.");
  const early = beginEarly(root);
  // The application's script would take the processor from what is drawn first.
  await early.shown;
  try {
    const { mount } = await import("./main");
    await early.takeOver(mount);
  } catch (error) {
    reportError(error);
    setTimeout(() => void retry(), RETRY_MS);
  }
}

/** Start anew once the server answers: what was filled in so far is kept on the tablet. */
async function retry(): Promise<void> {
  await reload();
  setTimeout(() => void retry(), RETRY_MS);
}

void start();
