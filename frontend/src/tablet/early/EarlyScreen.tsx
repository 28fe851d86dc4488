/** The first page of a form as the application draws it, without what needs the application. */
import type { TabletState } from "@shared/api/types";
import { FormPage, PageDots } from "@shared/forms/FormPage";
import { type Filling, type Pages, pageOf } from "@shared/forms/filling";
import type { FormTexts } from "@shared/forms/texts";
import type { JSX } from "react";
import { Frame } from "../Frame";

interface EarlyScreenProps {
  readonly state: TabletState;
  readonly administration: NonNullable<TabletState["administration"]>;
  readonly pages: Pages;
  readonly filling: Filling;
  readonly texts: FormTexts;
  readonly simulated: string;
}

export function EarlyScreen(props: EarlyScreenProps): JSX.Element {
  const { state, pages, filling, texts } = props;
  const page = pageOf(filling, pages);
  return (
    <Frame simulated={state.simulated ? props.simulated : null} offline={null} tools={null}>
      <FormPage
        id="early"
        administration={props.administration}
        language={state.language}
        questions={pages[page] ?? []}
        isFirst={page === 0}
        disabled={false}
        valueOf={({ key }) => filling.draft.data[key]}
        problemOf={() => null}
        onAnswer={() => {}}
      >
        <span />
        <PageDots page={page} pages={pages.length} label={texts.page} />
      </FormPage>
    </Frame>
  );
}
