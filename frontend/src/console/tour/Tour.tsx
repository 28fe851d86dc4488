/**
 * The tour of a session's page: a callout that points at one part after the other.
 *
 * It blocks no clicks on the page. While it is open, the page's own keys are inactive, because the
 * callout is a dialog; arrow keys turn its pages and Escape ends it.
 */
import { Button, Popover } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useEffect, useRef } from "react";
import { useTexts } from "../i18n";
import classes from "./Tour.module.css";
import { endTour, TOUR_STEPS, type TourStep, turnTour, useTourStep } from "./tourStore";
import { type Place, useAnchor } from "./useAnchor";

export function Tour(): JSX.Element | null {
  const number = useTourStep();
  const step = number === null ? undefined : TOUR_STEPS[number];
  // Leaving the session's page ends the tour.
  useEffect(() => () => endTour(), []);
  return number === null || step === undefined ? null : (
    <Callout key={step.key} number={number} step={step} />
  );
}

interface CalloutProps {
  readonly number: number;
  readonly step: TourStep;
}

/** A target stands on either side of the page: beside it is the side with room. */
function sideOf({ side }: TourStep, place: Place | null): TourStep["side"] {
  if (place === null || (side !== "left" && side !== "right")) return side;
  return place.left + place.width / 2 > window.innerWidth / 2 ? "left" : "right";
}

const KEYS: Readonly<Record<string, () => void>> = {
  ArrowRight: () => turnTour(1),
  ArrowLeft: () => turnTour(-1),
  Escape: endTour,
};

function Callout({ number, step }: CalloutProps): JSX.Element {
  const { t } = useTexts();
  const place = useAnchor(step);
  const next = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    next.current?.focus({ preventScroll: true });
    const onKey = (event: KeyboardEvent) => {
      const act = KEYS[event.key];
      if (act === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      event.stopPropagation();
      act();
    };
    // In the capture phase, before the page's own keys.
    document.addEventListener("keydown", onKey, true);
    return () => document.removeEventListener("keydown", onKey, true);
  }, []);
  const isLast = number === TOUR_STEPS.length - 1;
  return (
    <Popover
      opened
      position={sideOf(step, place)}
      width={340}
      offset={12}
      withArrow={place !== null}
      arrowSize={12}
      shadow="lg"
      zIndex={250}
      transitionProps={{ duration: 0 }}
      closeOnClickOutside={false}
      closeOnEscape={false}
      returnFocus={false}
      middlewares={{ flip: true, shift: { padding: 8 } }}
    >
      <Popover.Target>
        <div
          className={`${classes.spot} ${place === null ? classes.noTarget : ""}`}
          style={place === null ? undefined : { ...place }}
          aria-hidden="true"
        />
      </Popover.Target>
      <Popover.Dropdown className={classes.callout ?? ""} aria-label={t("tour.label")}>
        <div className={`${classes.kicker} numbers`}>
          {t("tour.of", { number: number + 1, total: TOUR_STEPS.length })}
        </div>
        <h2 className={classes.title}>{t(`tour.${step.key}.title`)}</h2>
        <p className={classes.body} aria-live="polite">
          {t(`tour.${step.key}.body`)}
        </p>
        <div className={classes.actions}>
          <Button variant="subtle" color="gray" size="xs" onClick={endTour}>
            {t("tour.skip")}
          </Button>
          <span className={classes.navigation}>
            {number > 0 && (
              <Button
                variant="default"
                size="xs"
                leftSection={<Icon name="back" size={14} />}
                onClick={() => turnTour(-1)}
              >
                {t("tour.back")}
              </Button>
            )}
            <Button ref={next} size="xs" onClick={() => turnTour(1)}>
              {t(isLast ? "tour.end" : "tour.next")}
            </Button>
          </span>
        </div>
        {number === 0 && <p className={classes.keys}>{t("tour.keys")}</p>}
      </Popover.Dropdown>
    </Popover>
  );
}
