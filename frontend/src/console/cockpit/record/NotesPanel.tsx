/** The experimenter's notes with their times, written without leaving the page. */
import { Textarea } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import { timeOfDay } from "@shared/format";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import { Key } from "../../ui/Key";
import cockpit from "../Cockpit.module.css";
import classes from "../Panels.module.css";
import type { Send } from "../session/useSession";

interface NotesPanelProps {
  readonly session: SessionView;
  readonly send: Send;
  readonly sending: boolean;
}

export function NotesPanel({ session, send, sending }: NotesPanelProps): JSX.Element {
  const { t, language } = useTexts();
  const [text, setText] = useState("");
  const save = () => {
    // The text stays in the field until the server has stored it.
    if (text.trim() !== "") send({ type: "note", text: text.trim() }, () => setText(""));
  };
  return (
    <section>
      <h2 className={cockpit.sectionTitle}>
        {t("notes.title")}
        {session.allowed.includes("note") && <Key name="N" />}
      </h2>
      {session.allowed.includes("note") && (
        <Textarea
          id="note"
          aria-label={t("notes.field")}
          placeholder={t("notes.placeholder")}
          description={text === "" ? undefined : t("notes.hint")}
          inputWrapperOrder={["label", "input", "description", "error"]}
          autosize
          minRows={1}
          maxRows={6}
          maxLength={2000}
          readOnly={sending}
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
          onKeyDown={(event) => {
            if (event.key === "Escape") event.currentTarget.blur();
            if (event.key !== "Enter" || event.shiftKey) return;
            event.preventDefault();
            save();
          }}
        />
      )}
      {session.notes.length === 0 ? (
        <p className={classes.empty}>{t("notes.empty")}</p>
      ) : (
        <ol className={classes.notes}>
          {[...session.notes].reverse().map((note) => (
            <li key={note.id} className={classes.note}>
              <time className={`${classes.when} numbers`} dateTime={note.at} title={note.by}>
                {timeOfDay(note.at, language)}
              </time>
              <span>{note.text}</span>
            </li>
          ))}
        </ol>
      )}
    </section>
  );
}
