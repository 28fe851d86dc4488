/** Asked when somebody starts although a check has failed. */
import type { SessionView } from "@shared/api/types";
import type { JSX } from "react";
import type { useSession } from "../session/useSession";
import { OverrideDialog } from "./OverrideDialog";
import type { Flight } from "./usePreflight";
import { failing } from "./words";

interface StartAnywayProps {
  readonly session: SessionView;
  readonly live: Pick<ReturnType<typeof useSession>, "sendAnew">;
  readonly flight: Flight;
}

export function StartAnyway({ session, live, flight }: StartAnywayProps): JSX.Element {
  const failed = failing(flight.query.data?.checks ?? []);
  const { asking, stopAsking } = flight;
  return (
    <OverrideDialog
      session={session}
      checks={asking ? failed : null}
      onClose={stopAsking}
      then={() => live.sendAnew(session, { type: "start" })}
    />
  );
}
