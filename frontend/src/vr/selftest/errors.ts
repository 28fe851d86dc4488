/** Errors of the page while it is tested, one line each: the first ten. */

export const MOST_ERRORS = 10;
const LONGEST_LINE = 200;

export class PageErrors {
  readonly #lines: string[] = [];
  readonly #listening = new AbortController();

  /** Listen for what nobody caught, and for what the page's policy has refused. */
  constructor() {
    const { signal } = this.#listening;
    window.addEventListener("error", ({ message }) => this.note("page", message), { signal });
    window.addEventListener(
      "unhandledrejection",
      ({ reason }: PromiseRejectionEvent) => this.note("page", reason),
      { signal },
    );
    document.addEventListener(
      "securitypolicyviolation",
      ({ violatedDirective }) => this.note("policy", violatedDirective),
      { signal },
    );
  }

  get lines(): readonly string[] {
    return [...this.#lines];
  }

  /** Note a failure of a part of the test, which goes on without it. */
  note(part: string, error: unknown): void {
    if (this.#lines.length >= MOST_ERRORS) return;
    const said = error instanceof Error ? error.message : String(error);
    this.#lines.push(`${part}: ${said.replace(/\s+/g, " ")}`.slice(0, LONGEST_LINE));
  }

  forget(): void {
    this.#lines.length = 0;
  }

  dispose(): void {
    this.#listening.abort();
  }
}
