/** All bodies of the lab, and the upload of new ones. */
import { Text, Title } from "@mantine/core";
import type { BodyListed, BodyPage as Page } from "@shared/api/bodies";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { Attention } from "./Attention";
import classes from "./Bodies.module.css";
import { BodyDropZone, BodyUploadList } from "./BodyUploadList";
import { licenceName, licenceWritten, titleOf } from "./names";
import { bodiesQuery } from "./queries";
import { StatureCard } from "./StatureCard";
import { useBodyPicture } from "./useBodyPicture";
import { useBodyUploads } from "./useBodyUploads";

/** The body that is drawn in the paper's three statures. */
const NEUTRAL = "neutral";

export function BodiesPage(): JSX.Element {
  const { t } = useTexts();
  useTitle(t("bodies.title"));
  const canWrite = usePermissions()("body");
  const queue = useBodyUploads();
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{t("bodies.title")}</Title>
          <Text c="dimmed">{t("bodies.lead")}</Text>
        </div>
      </div>
      {canWrite && <BodyDropZone onFiles={queue.add} />}
      <BodyUploadList queue={queue} />
      <Loaded query={useQuery(bodiesQuery)}>
        {(page) =>
          page.total === 0 ? (
            <EmptyState icon="body" title={t("bodies.empty")}>
              {t(canWrite ? "bodies.empty.body" : "bodies.empty.reader")}
            </EmptyState>
          ) : (
            <BodyGrid page={page} />
          )
        }
      </Loaded>
    </>
  );
}

function BodyGrid({ page }: { readonly page: Page }): JSX.Element {
  const { t } = useTexts();
  const neutral = page.humanoids.find(({ name }) => name === NEUTRAL);
  // Bodies that studies can wear come first.
  const sorted = page.humanoids.toSorted(
    (a, b) => Number(a.name === null) - Number(b.name === null),
  );
  return (
    <>
      <p className={`${classes.soft} numbers`} role="status">
        {t("bodies.count", { count: page.total })}
      </p>
      <ul className={classes.grid} aria-label={t("bodies.title")}>
        {sorted.map((body) => (
          <BodyCard key={body.content_hash} body={body} />
        ))}
      </ul>
      {neutral !== undefined && <StatureCard hash={neutral.content_hash} />}
    </>
  );
}

function BodyCard({ body }: { readonly body: BodyListed }): JSX.Element {
  const { t, language } = useTexts();
  const picture = useBodyPicture(body.content_hash, body.size_bytes);
  const facts = [
    t("bodies.stature", { value: decimals(100 * body.stature_m, language, 0) }),
    body.triangles === null
      ? null
      : t("bodies.triangles", { count: number(body.triangles, language) }),
    (body.licence !== null && licenceName(licenceWritten(body.licence), t)) || null,
  ];
  return (
    <li className={classes.card}>
      <Link href={`/bodies/${body.content_hash}`} className={classes.cardLink ?? ""}>
        <span className={classes.picture}>
          {picture === null ? <Icon name="body" size={40} /> : <img src={picture} alt="" />}
        </span>
        <span className={classes.cardWords}>
          <strong className={classes.cardName}>{titleOf(body)}</strong>
          <span className={classes.tags}>
            {body.name === null ? (
              <span className={classes.unnamed}>{t("bodies.unnamed")}</span>
            ) : (
              body.name !== titleOf(body) && <code className={classes.key}>{body.name}</code>
            )}
            {body.origin === "shipped" && <span>{t("bodies.shipped")}</span>}
          </span>
          <span className={`${classes.soft} numbers`}>
            {facts.filter((fact) => fact !== null).join(" · ")}
          </span>
          <Attention body={body} />
        </span>
      </Link>
    </li>
  );
}
