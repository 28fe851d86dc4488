/** Requests for motion captures and their retargeting to avatars. */
import { decodeMotion, type PointMotion } from "../stage/motion";
import { accountHeader, answer, errorFromBody, server, Unreachable } from "./request";
import type { components, operations } from "./schema";
import { upload } from "./upload";

type Schemas = components["schemas"];
export type CaptureListed = Schemas["CaptureListed"];
export type Capture = Schemas["CaptureView"];
export type CapturePage = Schemas["CapturePage"];
export type Conventions = Schemas["ConventionsView"];
export type Origin = Schemas["ConventionView"]["origin"];
export type ReadingChoice = Required<Schemas["ReadingChoice"]>;
export type CaptureKind = CaptureListed["kind"];
export type JointMapView = Schemas["JointMapView"];
export type JointSource = JointMapView["sources"][string];
export type Verification = Schemas["VerificationView"];
export type Walker = Schemas["WalkerView"];
export type AnatomyNotice = Schemas["Notice"];
export type AvatarWalker = Schemas["AvatarWalkerView"];
export type MovementFormat = NonNullable<
  operations["get_retargeted_api_captures__capture_id__retargeted_get"]["parameters"]["query"]["format"]
>;
export type MotionView = "recorded" | "skeleton";

/** The one or two files of a capture: an AMC comes with its ASF. */
export interface CaptureFiles {
  readonly file: File;
  readonly companion: File | null;
}

export interface Uploaded {
  readonly capture: Capture;
  /** False if the same content had been uploaded before. */
  readonly isNew: boolean;
}

const at = (id: string) => ({ params: { path: { capture_id: id } } });

export const captures = {
  list: () =>
    answer<CapturePage>(server.GET("/api/captures", { params: { query: { limit: 1000 } } })),
  get: (id: string) => answer<Capture>(server.GET("/api/captures/{capture_id}", at(id))),
  change: (id: string, change: Schemas["CaptureChange"]) =>
    answer<Capture>(server.PATCH("/api/captures/{capture_id}", { ...at(id), body: change })),
  remove: (id: string) => answer<undefined>(server.DELETE("/api/captures/{capture_id}", at(id))),
  motion: (id: string, shown: MotionView) => motionFrom(`${path(id)}/motion?shown=${shown}`),
  onAvatar: (id: string, avatar: string, lockFeet: boolean) =>
    motionFrom(
      `${path(id)}/retargeted-motion?avatar=${avatar}&lock_feet=${lockFeet}&rotations=true`,
    ),
  jointMap: (id: string) =>
    answer<JointMapView>(server.GET("/api/captures/{capture_id}/joint-map", at(id))),
  saveJointMap: (id: string, version: number, map: Readonly<Record<string, string>>) =>
    answer<JointMapView>(
      server.PUT("/api/captures/{capture_id}/joint-map", {
        ...at(id),
        body: { joint_map: { ...map }, version },
      }),
    ),
  resetJointMap: (id: string, version: number) =>
    answer<JointMapView>(
      server.DELETE("/api/captures/{capture_id}/joint-map", {
        params: { path: { capture_id: id }, query: { version } },
      }),
    ),
  verification: (id: string, avatars: readonly string[], lockFeet: boolean) =>
    answer<Verification>(
      server.GET("/api/captures/{capture_id}/verification", {
        params: {
          path: { capture_id: id },
          query: { avatars: [...avatars], lock_feet: lockFeet },
        },
      }),
    ),
  generatedVerification: (avatars: readonly string[]) =>
    answer<Verification>(
      server.GET("/api/captures/generated/verification", {
        params: { query: { avatars: [...avatars] } },
      }),
    ),
  fileUrl: (id: string, companion: boolean) => `${path(id)}/file?companion=${companion}`,
  exportUrl: (id: string, avatar: string, format: MovementFormat, lockFeet: boolean) =>
    `${path(id)}/retargeted?avatar=${avatar}&format=${format}&lock_feet=${lockFeet}`,
};

const path = (id: string): string => `/api/captures/${encodeURIComponent(id)}`;

async function motionFrom(url: string): Promise<PointMotion> {
  const response = await fetch(url, { credentials: "same-origin", headers: accountHeader() }).catch(
    (cause: unknown) => {
      throw new Unreachable("The server cannot be reached.", { cause });
    },
  );
  if (!response.ok) throw errorFromBody(response.status, await response.json().catch(() => null));
  return decodeMotion(await response.arrayBuffer());
}

/** The URL for an upload; its body is the file, followed by its companion. */
export function uploadUrl({ file, companion }: CaptureFiles): string {
  const query = new URLSearchParams({ name: file.name });
  if (companion !== null) {
    query.set("companion", companion.name);
    query.set("companion_bytes", String(companion.size));
  }
  return `/api/captures?${query}`;
}

/** Upload a capture; `onSent` is called with the fraction of bytes sent so far. */
export async function uploadCapture(
  files: CaptureFiles,
  onSent: (share: number) => void,
): Promise<Uploaded> {
  const sent = [files.file, ...(files.companion === null ? [] : [files.companion])];
  const { stored, isNew } = await upload<Capture>(uploadUrl(files), sent, onSent);
  return { capture: stored, isNew };
}
