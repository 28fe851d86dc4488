/** What the tuning panel and its parts are given by the editor. */
import type { AvatarVersionDetail, Operation } from "../api";
import type { AvatarFile } from "../axes";

export interface TuningPanelProps {
  readonly avatarKey: string;
  /** The version on which the work is based. */
  readonly base: AvatarVersionDetail;
  readonly configuration: AvatarFile;
  readonly contentHash: string;
  readonly chosen: string | null;
  readonly selected: ReadonlySet<string>;
  readonly edit: (operations: readonly Operation[], label: string) => Promise<boolean>;
  readonly isReadOnly: boolean;
}
