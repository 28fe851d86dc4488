/** Reads of imported answers, each with the key under which it is kept. */
import { type ImportMapping, imports } from "@shared/api/imports";
import { keepPreviousData, queryOptions } from "@tanstack/react-query";

export const importsQuery = (key: string) =>
  queryOptions({ queryKey: ["studies", key, "imports"], queryFn: () => imports.list(key) });

export const importQuery = (key: string, id: string) =>
  queryOptions({
    queryKey: ["studies", key, "imports", id],
    queryFn: () => imports.get(key, id),
  });

/** `file` stands for the text, which is long. */
export const checkQuery = (key: string, file: string, text: string, mapping: ImportMapping) =>
  queryOptions({
    queryKey: ["studies", key, "import-check", file, mapping],
    queryFn: () => imports.check(key, text, mapping),
    placeholderData: keepPreviousData,
    retry: false,
    gcTime: 60_000,
  });
