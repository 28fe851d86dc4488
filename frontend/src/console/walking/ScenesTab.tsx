/** The scenes: those of the product and the lab's own, each drawn from above. */
import { Button, FileButton, Select, Text, Title } from "@mantine/core";
import { textOf } from "@shared/api/request";
import { type Scene, type SceneListed, walking } from "@shared/api/walking";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useMemo, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { Loaded } from "../ui/Loaded";
import { DeleteButton } from "./DeleteButton";
import { planOf, WIDTH } from "./plan";
import { sceneQuery, scenesQuery } from "./queries";
import { SceneFloor } from "./SceneFloor";
import classes from "./Walking.module.css";

export function ScenesTab(): JSX.Element {
  return <Loaded query={useQuery(scenesQuery)}>{(scenes) => <Scenes scenes={scenes} />}</Loaded>;
}

function Scenes({ scenes }: { readonly scenes: readonly SceneListed[] }): JSX.Element {
  const { t } = useTexts();
  const canWrite = usePermissions()("walking");
  const queries = useQueryClient();
  const [chosenKey, setChosenKey] = useState(scenes[0]?.key ?? "");
  const key = scenes.some((one) => one.key === chosenKey) ? chosenKey : (scenes[0]?.key ?? "");
  const add = useMutation({
    mutationFn: async (file: File) => walking.addScene(await textOf(file)),
    onSuccess: async (scene) => {
      await queries.invalidateQueries({ queryKey: scenesQuery.queryKey });
      setChosenKey(scene.key);
    },
  });
  return (
    <>
      <div className={classes.section}>
        <Select
          label={t("walking.scene")}
          data={scenes.map((one) => ({
            value: one.key,
            label: t("walking.scene.keyed", {
              title: one.shipped ? t("walking.scene.shipped", { title: one.title }) : one.title,
              key: one.key,
            }),
          }))}
          value={key}
          onChange={(value) => value !== null && setChosenKey(value)}
          allowDeselect={false}
          w="min(560px, 100%)"
        />
        {canWrite && (
          <FileButton
            accept=".yaml,.yml,.json"
            onChange={(file) => file !== null && add.mutate(file)}
          >
            {(props) => (
              <Button
                {...props}
                loading={add.isPending}
                leftSection={<Icon name="upload" size={18} />}
              >
                {t("walking.scene.add")}
              </Button>
            )}
          </FileButton>
        )}
      </div>
      {add.isError && (
        <div className={classes.below}>
          <Failure error={add.error} />
        </div>
      )}
      <Loaded query={useQuery(sceneQuery(key))}>{(scene) => <SceneCard scene={scene} />}</Loaded>
    </>
  );
}

/** Join the lines of the file, which are wrapped for editors, into paragraphs. */
const unwrapped = (text: string): string => text.trim().replace(/(\S)\n(?=\S)/g, "$1 ");

function SceneCard({ scene }: { readonly scene: Scene }): JSX.Element {
  const { t, language } = useTexts();
  const canWrite = usePermissions()("walking");
  const plan = useMemo(() => planOf(scene.bounds_m), [scene]);
  return (
    <div className={classes.ask}>
      <section className={classes.card}>
        <svg
          role="img"
          aria-label={t("walking.picture", { scene: scene.title })}
          viewBox={`0 0 ${WIDTH} ${plan.height}`}
          width="100%"
        >
          <SceneFloor scene={scene} plan={plan} />
        </svg>
      </section>
      <section className={classes.card}>
        <Title order={2} size="h3">
          {scene.title}
        </Title>
        <p className={classes.soft}>{t("walking.scene.key", { key: scene.key })}</p>
        <Text className={classes.about ?? ""} my="xs">
          {unwrapped(scene.about)}
        </Text>
        <p className={classes.soft}>
          {t("walking.scene.told", {
            obstacles: scene.obstacles.length,
            places: Object.keys(scene.places).length,
            paths: scene.paths.length,
            clearance: number(scene.clearance_m, language),
          })}
        </p>
        <div className={classes.buttons}>
          <Button
            component="a"
            href={walking.sceneFile(scene.key)}
            download
            variant="default"
            size="compact-sm"
            leftSection={<Icon name="download" size={16} />}
          >
            {t("walking.scene.file")}
          </Button>
          {canWrite && !scene.shipped && (
            <DeleteButton
              title={scene.title}
              remove={() => walking.removeScene(scene.key)}
              changes={scenesQuery.queryKey}
            />
          )}
        </div>
      </section>
    </div>
  );
}
