/** Requests for importing answers that were collected elsewhere. */
import { answer, server } from "./request";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type ImportMapping = Required<Schemas["Mapping"]>;
export type ImportPreview = Omit<Schemas["LookView"], "proposal" | "offer"> & {
  readonly proposal: ImportMapping | null;
  readonly offer: OfferedInstrument | null;
};
export type ImportCheck = Schemas["CheckView"];
export type CellProblem = Schemas["CellProblem"];
export type AnswerImport = Schemas["ImportView"];
export type OfferedInstrument = Required<Schemas["OfferedInstrument"]>;
export type ImportDetail = Schemas["ImportDetail"];
export type ScoreResult = Schemas["ScoreResult"];

const of = (key: string) => ({ params: { path: { key } } });
const one = (key: string, id: string) => ({ params: { path: { key, import_id: id } } });

export const imports = {
  list: (key: string) =>
    answer<readonly AnswerImport[]>(server.GET("/api/studies/{key}/imports", of(key))),
  get: (key: string, id: string) =>
    answer<ImportDetail>(server.GET("/api/studies/{key}/imports/{import_id}", one(key, id))),
  preview: (key: string, text: string, instrument: string | null, headerRows: number | null) =>
    answer<ImportPreview>(
      server.POST("/api/studies/{key}/imports/look", {
        ...of(key),
        body: { text, instrument, header_rows: headerRows },
      }),
    ),
  check: (key: string, text: string, mapping: ImportMapping) =>
    answer<ImportCheck>(
      server.POST("/api/studies/{key}/imports/check", { ...of(key), body: { text, mapping } }),
    ),
  makeInstrument: (key: string, offered: OfferedInstrument) =>
    answer<Schemas["LookedInstrument"]>(
      server.POST("/api/studies/{key}/imports/instrument", { ...of(key), body: offered }),
    ),
  takeIn: (key: string, fileName: string, text: string, mapping: ImportMapping) =>
    answer<AnswerImport>(
      server.POST("/api/studies/{key}/imports", {
        ...of(key),
        body: { file_name: fileName, text, mapping },
      }),
    ),
  undo: (key: string, id: string, reason: string) =>
    answer<AnswerImport>(
      server.POST("/api/studies/{key}/imports/{import_id}/undo", {
        ...one(key, id),
        body: { reason },
      }),
    ),
  tableUrl: (key: string, id: string) =>
    `/api/studies/${encodeURIComponent(key)}/imports/${encodeURIComponent(id)}/table`,
};
