/**
 * A page for tests and benchmarks in a browser: the try-out of the shipped configuration, of which
 * `tryoutPage.change` changes one axis without saving it. The server ships no such page.
 */
import "@shared/theme/mantine.css";
import { mountPage } from "@shared/ui/Page";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useState } from "react";
import { loaded, translations } from "../../../i18n";
import { type AvatarFile, savedVersionQuery } from "../source";
import { Tryout } from "../Tryout";

type AxisFile = AvatarFile["axes"][string];

declare global {
  var tryoutPage: { change(axis: string, change: Partial<AxisFile>): void };
}

function TryoutPage(): JSX.Element {
  const { data } = useQuery(savedVersionQuery("standard 2"));
  const [axis, setAxis] = useState("LeftUpperArmZ");
  const [working, setWorking] = useState<AvatarFile | null>(null);
  const configuration = working ?? data?.configuration;
  useEffect(() => {
    if (configuration === undefined) return;
    globalThis.tryoutPage = {
      change: (name, change) => {
        const own = configuration.axes[name];
        if (own === undefined) throw new Error(`There is no axis ${name}.`);
        setWorking({
          ...configuration,
          axes: { ...configuration.axes, [name]: { ...own, ...change } },
        });
      },
    };
  }, [configuration]);
  return (
    <main style={{ maxWidth: 1640, margin: "0 auto", padding: 24 }}>
      <h1>Standard</h1>
      {configuration !== undefined && (
        <Tryout title="Standard" configuration={configuration} axis={axis} onAxis={setAxis} />
      )}
    </main>
  );
}

const root = document.createElement("div");
root.id = "root";
document.body.replaceChildren(root);
document.documentElement.lang = "en";
document.title = "Try-out";
void loaded.then(() => mountPage({ translations, children: <TryoutPage /> }));
