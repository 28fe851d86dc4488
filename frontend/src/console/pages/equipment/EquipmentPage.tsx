/** The measured delay of each device, newest first, and the self-tests of the headsets. */
import { Button, Modal, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import type { Calibration } from "@shared/api/records";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { calibrationsQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { Loaded } from "../../ui/Loaded";
import { useTitle } from "../../ui/page";
import { AddForm } from "./AddForm";
import classes from "./EquipmentPage.module.css";
import { History } from "./History";
import { SelfTests } from "./SelfTests";

export function EquipmentPage(): JSX.Element {
  const { t } = useTexts();
  useTitle(t("equipment.title"));
  const [adding, dialog] = useDisclosure();
  const canWrite = usePermissions()("design");
  const add = canWrite ? (
    <Button leftSection={<Icon name="add" size={18} />} onClick={dialog.open}>
      {t("equipment.add")}
    </Button>
  ) : null;
  const query = useQuery(calibrationsQuery);
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{t("equipment.title")}</Title>
          <p className={classes.lead}>{t("equipment.lead")}</p>
          <Link href="/trackers" className={classes.link ?? ""}>
            {t("trackers.link")}
          </Link>
        </div>
        {add}
      </div>
      <Loaded query={query}>
        {(all) =>
          all.length === 0 ? (
            <EmptyState icon="headset" title={t("equipment.empty")}>
              {t("equipment.empty.body")}
            </EmptyState>
          ) : (
            names(all).map((name) => (
              <History
                key={name}
                name={name}
                own={all.filter((one) => one.equipment === name)}
                canWrite={canWrite}
              />
            ))
          )
        }
      </Loaded>
      <SelfTests />
      <Modal
        opened={adding}
        onClose={dialog.close}
        title={t("equipment.add")}
        size="lg"
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <AddForm existing={names(query.data ?? [])} onClose={dialog.close} />
      </Modal>
    </>
  );
}

const names = (all: readonly Calibration[]): string[] => [
  ...new Set(all.map((one) => one.equipment)),
];
