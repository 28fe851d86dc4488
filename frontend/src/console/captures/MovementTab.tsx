/** The movement in 3-D, as recorded or on an avatar, next to how its file was read. */
import { Center, Checkbox, Loader, SegmentedControl } from "@mantine/core";
import type { Capture } from "@shared/api/captures";
import { type JSX, useState } from "react";
import { type BodyChoice, BodySelect } from "../bodyView/BodyChoice";
import { BodyNotice } from "../bodyView/BodyNotice";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { AvatarChoice } from "./AvatarChoice";
import classes from "./Capture.module.css";
import { ConventionsPanel } from "./ConventionsPanel";
import { NoAvatar, type TabProps } from "./NoAvatar";
import { type StageOptions, useFigures } from "./useFigures";
import type { JointMapDraft } from "./useJointMap";
import { Viewer } from "./Viewer";

const AT_FIRST: StageOptions = { shown: "recorded", avatar: "165cm", lockFeet: false, ghost: true };

export function MovementTab({ capture, map }: TabProps): JSX.Element {
  const [options, setOptions] = useState(AT_FIRST);
  const { figures, error, busy, choice, worn } = useFigures(capture, options, map);
  return (
    <div className={classes.movement}>
      <div>
        <ShownBar
          capture={capture}
          map={map}
          options={options}
          busy={busy}
          onOptions={setOptions}
          choice={choice}
        />
        {error !== null && <Failure error={error} />}
        {figures.length > 0 ? (
          <Viewer figures={figures} title={capture.title}>
            <BodyNotice body={worn} instead />
          </Viewer>
        ) : (
          error === null && (
            <Center className={classes.waiting ?? ""}>
              <Loader />
            </Center>
          )
        )}
        <NoAvatar capture={capture} map={map} />
      </div>
      <ConventionsPanel capture={capture} motion={figures.find(isSource)?.motion ?? null} />
    </div>
  );
}

const isSource = ({ key }: { readonly key: string }): boolean => key === "source";

interface ShownBarProps {
  readonly capture: Capture;
  readonly map: JointMapDraft;
  readonly options: StageOptions;
  readonly busy: boolean;
  readonly onOptions: (wish: StageOptions) => void;
  readonly choice: BodyChoice;
}

function ShownBar(props: ShownBarProps): JSX.Element {
  const { capture, map, options, busy, onOptions, choice } = props;
  const { t } = useTexts();
  const isFitted = capture.summary.skeleton?.origin === "fitted";
  const shown = [
    "recorded",
    ...(isFitted ? ["skeleton"] : []),
    "avatar",
  ] as StageOptions["shown"][];
  const canMove = capture.has_skeleton && map.view?.usable !== false;
  return (
    <div className={classes.shown}>
      <SegmentedControl
        size="xs"
        aria-label={t("capture.shown")}
        value={options.shown}
        onChange={(value) => onOptions({ ...options, shown: value as StageOptions["shown"] })}
        data={shown.map((value) => ({
          value,
          label: t(`capture.shown.${value}`),
          disabled: value === "avatar" && !canMove,
        }))}
      />
      {options.shown === "avatar" && (
        <>
          <AvatarChoice
            avatar={options.avatar}
            onAvatar={(avatar) => onOptions({ ...options, avatar })}
          />
          <BodySelect choice={choice} />
          <Checkbox
            size="xs"
            label={t("capture.ghost")}
            checked={options.ghost}
            onChange={(event) => onOptions({ ...options, ghost: event.currentTarget.checked })}
          />
          <Checkbox
            size="xs"
            label={t("capture.lock")}
            checked={options.lockFeet}
            onChange={(event) => onOptions({ ...options, lockFeet: event.currentTarget.checked })}
          />
        </>
      )}
      {busy && <Loader size="sm" role="status" aria-label={t("stage.loading")} />}
    </div>
  );
}
