/** One body from all sides, with its checks, its name, and the studies that use it. */
import { Button, Title } from "@mantine/core";
import { type BodyView, bodies } from "@shared/api/bodies";
import { bytes, dateTime, decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { nameOf } from "../account";
import { BodyViewer } from "../bodyView/BodyViewer";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import classes from "./Bodies.module.css";
import { Checks } from "./Checks";
import { DeleteBody } from "./DeleteBody";
import { Licence } from "./Licence";
import { NameCard } from "./NameCard";
import { titleOf } from "./names";
import { bodyQuery } from "./queries";
import { UseCard } from "./UseCard";

export function BodyPage({ hash }: { readonly hash: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Link href="/bodies" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("bodies.title")}
      </Link>
      <Loaded query={useQuery(bodyQuery(hash))}>{(body) => <Body body={body} />}</Loaded>
    </>
  );
}

function Body({ body }: { readonly body: BodyView }): JSX.Element {
  const { t } = useTexts();
  const canWrite = usePermissions()("body");
  const title = titleOf(body);
  useTitle(title);
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1} className={classes.title ?? ""}>
            {title}
          </Title>
          <Facts body={body} />
        </div>
        <div className={classes.row}>
          <Button
            component="a"
            href={bodies.fileUrl(body.content_hash)}
            download={body.file_name}
            variant="default"
            size="xs"
            leftSection={<Icon name="download" size={15} />}
          >
            {t("bodies.file")}
          </Button>
          {canWrite && body.name === null && body.origin !== "shipped" && (
            <DeleteBody body={body} />
          )}
        </div>
      </div>
      <div className={classes.body}>
        <div className={classes.column}>
          <BodyViewer hash={body.content_hash} name={title} height="clamp(320px, 60vh, 640px)" />
          <UseCard body={body} canWrite={canWrite} />
        </div>
        <div className={classes.column}>
          <NameCard body={body} canWrite={canWrite} />
          <section className={classes.panel} aria-labelledby="body-checks">
            <Title order={2} size="h3" id="body-checks">
              {t("bodies.checks")}
            </Title>
            <Checks checks={body.checks} />
            {body.triangles === null && canWrite && <MeasureAgain body={body} />}
          </section>
          <Licence body={body} />
        </div>
      </div>
    </>
  );
}

function Facts({ body }: { readonly body: BodyView }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <div className={`${classes.meta} numbers`}>
      {body.name !== null && <code className={classes.key}>{body.name}</code>}
      <span>{body.origin === "shipped" ? t("bodies.shipped") : body.file_name}</span>
      <span>{t("bodies.stature", { value: decimals(100 * body.stature_m, language, 0) })}</span>
      {body.triangles !== null && (
        <span>{t("bodies.triangles", { count: number(body.triangles, language) })}</span>
      )}
      <span>{bytes(body.size_bytes, language)}</span>
      <span>
        {dateTime(body.at, language)} {t("captures.by", { by: nameOf(body.by) })}
      </span>
    </div>
  );
}

/** Bodies that an earlier release has measured lack what it did not read. */
function MeasureAgain({ body }: { readonly body: BodyView }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const measure = useMutation({
    mutationFn: () => bodies.measure(body.content_hash),
    onSuccess: (measured) => {
      queries.setQueryData(bodyQuery(body.content_hash).queryKey, measured);
      void queries.invalidateQueries({ queryKey: ["bodies"], exact: true });
    },
  });
  return (
    <div className={classes.row}>
      <Button
        size="xs"
        variant="default"
        loading={measure.isPending}
        onClick={() => measure.mutate()}
        leftSection={<Icon name="redo" size={15} />}
      >
        {t("bodies.measure")}
      </Button>
      <span className={classes.soft}>{t("bodies.measure.hint")}</span>
      {measure.isError && <Failure error={measure.error} />}
    </div>
  );
}
