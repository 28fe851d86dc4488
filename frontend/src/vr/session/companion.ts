/** The companion in this session's world: who it is, drawn with their body as it is loaded. */
import { type CompanionBody, CompanionLink } from "../companion";
import type { World } from "../world";
import { loadModel } from "./avatars";
import { socketUrl } from "./sockets";

export interface CompanionParts {
  readonly world: World;
  readonly token: string;
  readonly onFailure: (error: unknown) => void;
}

export class SessionCompanion {
  readonly #parts: CompanionParts;
  #link: CompanionLink | null = null;
  #body: CompanionBody | null = null;

  constructor(parts: CompanionParts) {
    this.#parts = parts;
  }

  /** The socket; null before somebody looks at the world. */
  get link(): CompanionLink | null {
    return this.#link;
  }

  /** Somebody looks at the world from now on. */
  open(): void {
    const { token } = this.#parts;
    const url = socketUrl("/api/vr/companion");
    this.#link ??= new CompanionLink({ url, token, onBody: (body) => this.#be(body) });
  }

  close(): void {
    this.#link?.close();
  }

  /** A plain body until its model is there. */
  #be(body: CompanionBody | null): void {
    const { world, token, onFailure } = this.#parts;
    this.#body = body;
    world.companion.be(body?.statureM ?? null, null);
    if (body === null || body.model === null) return;
    loadModel(token, body.model).then((model) => {
      // Another one may have been chosen while this model was on its way.
      if (this.#body === body) world.companion.be(body.statureM, model);
    }, onFailure);
  }
}
