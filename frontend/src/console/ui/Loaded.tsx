/** The three states of data from the server: loading, failed, loaded. */
import { Center, Loader } from "@mantine/core";
import type { UseQueryResult } from "@tanstack/react-query";
import type { JSX, ReactNode } from "react";
import { Failure } from "../errors";

interface LoadedProps<Data> {
  readonly query: UseQueryResult<Data>;
  readonly children: (data: Data) => ReactNode;
  /** As high as the window until then, where what comes below must not be pushed down. */
  readonly isTall?: boolean;
  /** As high as some lines, where nothing or little may come and what is below must not jump up. */
  readonly isShort?: boolean;
}

export function Loaded<Data>(props: LoadedProps<Data>): JSX.Element {
  const { query, children, isTall = false, isShort = false } = props;
  if (query.data !== undefined) return <>{children(query.data)}</>;
  if (query.isError) return <Failure error={query.error} onRetry={() => void query.refetch()} />;
  return <Waiting isTall={isTall} isShort={isShort} />;
}

/** What stands where something is still on its way. */
export function Waiting({
  isTall = false,
  isShort = false,
}: Pick<LoadedProps<unknown>, "isTall" | "isShort">): JSX.Element {
  return (
    <Center mih={isTall ? "90dvh" : isShort ? 48 : 240}>
      <Loader />
    </Center>
  );
}
