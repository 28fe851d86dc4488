/** How to make each kind of tracking software send to a door. */
import { Title } from "@mantine/core";
import type { Door } from "@shared/api/trackers";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../../i18n";
import { Copyable } from "../network/Copyable";
import classes from "./Trackers.module.css";

const SOFTWARE = ["motive", "slimevr", "vmc", "script"] as const;

export function HowToConnect({ doors }: { readonly doors: readonly Door[] }): JSX.Element {
  const { t } = useTexts();
  const door = doors.find((one) => one.door === "json");
  return (
    <section className={classes.how} aria-labelledby="how">
      <Title order={2} id="how">
        {t("trackers.help")}
      </Title>
      <div className={classes.software}>
        {SOFTWARE.map((one) => (
          <div key={one}>
            <h3>{t(`trackers.help.${one}`)}</h3>
            <p>
              {t(`trackers.help.${one}.body`)}
              {one === "script" && (
                <>
                  {" "}
                  <Link href="/help/live/a-skeleton-by-a-script" className={classes.link ?? ""}>
                    {t("trackers.help.script.more")}
                  </Link>
                </>
              )}
            </p>
          </div>
        ))}
      </div>
      {door !== undefined && (
        <div className={classes.script}>
          <Copyable text={script(door)} />
        </div>
      )}
      <p>
        <Link href="/help/live" className={classes.link ?? ""}>
          {t("trackers.help.more")}
        </Link>
      </p>
    </section>
  );
}

/** Three lines of Python that send one tracker. */
const script = ({ interface: address, port }: Door): string =>
  [
    "import json, socket, time",
    "door = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)",
    `door.sendto(json.dumps({"source": "my script", "time_s": time.monotonic(), "trackers": {"left foot": {"position_m": [0, 0.1, 0], "rotation_wxyz": [1, 0, 0, 0]}}}).encode(), ("${address}", ${port}))`,
  ].join("\n");
