/** An instrument of the lab's own, offered for columns of answers that no known one asks. */
import { Button, Checkbox, NumberInput, TextInput, Title } from "@mantine/core";
import { type ImportPreview, imports, type OfferedInstrument } from "@shared/api/imports";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import classes from "./Imports.module.css";

interface OfferProps {
  readonly study: StudyDetail;
  readonly preview: ImportPreview;
  /** Read the file again, as answers to this instrument. */
  readonly onPreview: (instrument: string, headerRows: number | null) => void;
}

export function OfferPanel({ study, preview, onPreview }: OfferProps): JSX.Element {
  const { t } = useTexts();
  const { offer, left_out } = preview;
  return (
    <section
      className={classes.check}
      aria-label={t(offer === null ? "imports.offer.leftOut" : "imports.offer.title", {
        count: left_out.length,
      })}
    >
      {offer !== null && (
        <Offer study={study} offer={offer} onMade={(key) => onPreview(key, preview.header_rows)} />
      )}
      {left_out.length > 0 && (
        <details open={left_out.some(({ reason }) => typeof reason === "string")}>
          <summary className={classes.summary}>
            {t("imports.offer.leftOut", { count: left_out.length })}
          </summary>
          <LeftOutColumns columns={left_out} />
        </details>
      )}
    </section>
  );
}

/** Columns that look like answers with the reason against each, then all others by name. */
function LeftOutColumns({ columns }: { readonly columns: ImportPreview["left_out"] }): JSX.Element {
  const { t } = useTexts();
  const named = columns.filter(({ reason }) => typeof reason === "string");
  const others = columns.filter(({ reason }) => typeof reason !== "string");
  return (
    <>
      {named.length > 0 && (
        <ul className={classes.reasons}>
          {named.map(({ name, filled, reason }) => (
            <li key={name}>
              <strong>{name}</strong> ({filled}): {reason}
            </li>
          ))}
        </ul>
      )}
      {others.length > 0 && (
        <p className={classes.soft}>
          {t("imports.offer.others")}{" "}
          {others.map(({ name, filled }) => `${name} (${filled})`).join(", ")}
        </p>
      )}
    </>
  );
}

interface OfferedProps extends Pick<OfferProps, "study"> {
  readonly offer: OfferedInstrument;
  readonly onMade: (instrument: string) => void;
}

function Offer({ study, offer, onMade }: OfferedProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [edited, setEdited] = useState(offer);
  const change = (part: Partial<OfferedInstrument>): void => setEdited({ ...edited, ...part });
  const make = useMutation({
    mutationFn: () => imports.makeInstrument(study.key, edited),
    onSuccess: async ({ instrument }) => {
      await queries.invalidateQueries({ queryKey: ["instruments"] });
      onMade(instrument);
    },
  });
  const submit = useSingleSubmit(make, { isReused: true });
  const kept = edited.items.length;
  return (
    <>
      <Title order={3} size="h5">
        {t("imports.offer.title")}
      </Title>
      <p>{t("imports.offer.about", { count: offer.items.length, seen: offer.seen })}</p>
      {(offer.doubts ?? []).map((doubt) => (
        <Notice key={doubt} tone="warn">
          {doubt}
        </Notice>
      ))}
      <div className={classes.fields}>
        <TextInput
          label={t("imports.offer.name")}
          value={edited.title}
          onChange={({ currentTarget }) => change({ title: currentTarget.value })}
        />
        <TextInput
          label={t("imports.offer.key")}
          value={edited.key}
          onChange={({ currentTarget }) => change({ key: currentTarget.value })}
        />
        <NumberInput
          label={t("imports.offer.minimum")}
          value={edited.minimum}
          allowDecimal={false}
          onChange={(value) => typeof value === "number" && change({ minimum: value })}
        />
        <NumberInput
          label={t("imports.offer.maximum")}
          value={edited.maximum}
          allowDecimal={false}
          onChange={(value) => typeof value === "number" && change({ maximum: value })}
        />
      </div>
      <Checkbox
        size="sm"
        label={t("imports.offer.confirmed", { low: edited.minimum, high: edited.maximum })}
        description={t("imports.offer.guess")}
        checked={edited.guessed_minimum === null && edited.guessed_maximum === null}
        onChange={({ currentTarget }) =>
          change({
            guessed_minimum: currentTarget.checked ? null : offer.guessed_minimum,
            guessed_maximum: currentTarget.checked ? null : offer.guessed_maximum,
          })
        }
      />
      <details open={offer.items.length <= 12}>
        <summary className={classes.summary}>
          {t("imports.offer.items", { kept, count: offer.items.length })}
        </summary>
        <ul className={classes.offered}>
          {offer.items.map((item) => (
            <li key={item.column}>
              <label>
                <input
                  type="checkbox"
                  checked={edited.items.some(({ column }) => column === item.column)}
                  onChange={({ currentTarget }) =>
                    change({
                      items: offer.items.filter(({ column }) =>
                        column === item.column
                          ? currentTarget.checked
                          : edited.items.some((one) => one.column === column),
                      ),
                    })
                  }
                />
                <strong>{item.column}</strong>
                {item.text !== item.column && <span className={classes.soft}>{item.text}</span>}
              </label>
            </li>
          ))}
        </ul>
      </details>
      {make.isError && <Failure error={make.error} />}
      <div>
        <Button
          size="xs"
          variant="default"
          leftSection={<Icon name="add" size={15} />}
          disabled={kept === 0 || edited.title.trim() === ""}
          loading={make.isPending}
          onClick={() => submit()}
        >
          {t("imports.offer.make")}
        </Button>
      </div>
    </>
  );
}
