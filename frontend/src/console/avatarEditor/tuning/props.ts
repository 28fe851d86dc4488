/** What the tuning panel and its parts are given by the editor. */
import type { AvatarVersionDetail } from "../api";
import type { AvatarFile } from "../axes";
import type { Work } from "../useWork";

export interface TuningPanelProps {
  readonly avatarKey: string;
  /** The version on which the work is based. */
  readonly base: AvatarVersionDetail;
  readonly configuration: AvatarFile;
  readonly contentHash: string;
  readonly chosen: string | null;
  readonly selected: ReadonlySet<string>;
  readonly edit: Work["edit"];
  readonly isReadOnly: boolean;
}
