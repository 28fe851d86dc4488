/** What an export of a study holds, file by file. */
export const exportsEn = {
  "export.files": "What is in the archive",
  "export.download": "Download",
  "export.start": "Download (zip with CSV)",
  "export.codebook": "Codebook",
  "export.codebookLead": "Every column of every table, with its unit.",
  "export.column": "Column",
  "export.unit": "Unit",
  "export.meaning": "Meaning",
  "export.table": "Table",
  "export.conventions":
    "UTF-8, one row per observation, times as UTC (ISO 8601) or seconds, angles in degrees, lengths in metres. Every table says whether it is simulated and which avatar was used.",
  "export.file.sessions": "sessions.csv",
  "export.about.sessions": "One row per visit: participant code, order, version, times, outcome.",
  "export.file.phases": "phases.csv",
  "export.about.phases":
    "One row per timed task: latency, limb, active time, completions, time in contact with the sides.",
  "export.file.answers": "answers.csv",
  "export.about.answers": "One row per answer, with the order in which the items were shown.",
  "export.file.scores": "scores.csv",
  "export.about.scores": "Scores of each questionnaire; empty where an answer is missing.",
  "export.file.completions": "completions.csv",
  "export.about.completions": "One row per completed task, with its active time in seconds.",
  "export.file.contacts": "contacts.csv",
  "export.about.contacts":
    "One row per contact of a body part with a side: begin and end in seconds.",
  "export.file.jointErrors": "joint_errors.csv",
  "export.about.jointErrors":
    "Joint error per phase, joint and axis in degrees: mean, RMS, p95, maximum, clipped share.",
  "export.file.jointErrorCourse": "joint_error_course.csv",
  "export.about.jointErrorCourse":
    "How the joint error went within each phase: its mean in degrees for every 5 s of active time.",
  "export.file.events": "events.csv",
  "export.about.events": "The event log of every session, with the hash that chains it.",
  "export.file.quality": "quality.csv",
  "export.about.quality":
    "One row per phase and stream: frame rate, gaps, jumps, frozen joints, values that are none.",
  "export.file.alarms": "alarms.csv",
  "export.about.alarms": "Every alarm of a session, when it was raised and when it was cleared.",
  "export.file.clocks": "clock_probes.csv, clock_mapping.csv",
  "export.about.clocks":
    "The headset's clock beside the server's: raw readings, and offset, drift and uncertainty from them.",
  "export.file.samples": "samples/*.csv",
  "export.about.samples": "One wide file per session: target and actual pose over time.",
  "export.file.receipts": "receipts/*.json",
  "export.about.receipts":
    "One per session: how many frames were made, are stored and are missing, with the proof.",
  "export.file.imported": "imported/*.csv",
  "export.about.imported": "Answers collected elsewhere, one file per import; in no other table.",
  "export.file.calibrations": "calibrations.csv",
  "export.about.calibrations": "Latency of the lab’s own equipment, where it was measured.",
  "export.file.codebook": "codebook.csv",
  "export.about.codebook": "Every column: meaning, unit, valid values.",
};

export const exportsDe: Readonly<Record<keyof typeof exportsEn, string>> = {
  "export.files": "Was das Archiv enthält",
  "export.download": "Herunterladen",
  "export.start": "Herunterladen (Zip mit CSV)",
  "export.codebook": "Codebuch",
  "export.codebookLead": "Jede Spalte jeder Tabelle, mit ihrer Einheit.",
  "export.column": "Spalte",
  "export.unit": "Einheit",
  "export.meaning": "Bedeutung",
  "export.table": "Tabelle",
  "export.conventions":
    "UTF-8, eine Zeile je Beobachtung, Zeiten als UTC (ISO 8601) oder Sekunden, Winkel in Grad, Längen in Metern. Jede Tabelle sagt, ob sie simuliert ist und welcher Avatar benutzt wurde.",
  "export.file.sessions": "sessions.csv",
  "export.about.sessions": "Eine Zeile je Besuch: Code, Reihenfolge, Version, Zeiten, Ausgang.",
  "export.file.phases": "phases.csv",
  "export.about.phases":
    "Eine Zeile je Aufgabe: Latenz, Gliedmaße, aktive Zeit, Erledigungen, Kontaktzeit mit den Seiten.",
  "export.file.answers": "answers.csv",
  "export.about.answers": "Eine Zeile je Antwort, mit der gezeigten Reihenfolge der Items.",
  "export.file.scores": "scores.csv",
  "export.about.scores": "Werte jedes Fragebogens; leer, wo eine Antwort fehlt.",
  "export.file.completions": "completions.csv",
  "export.about.completions": "Eine Zeile je erledigter Aufgabe, mit der aktiven Zeit in Sekunden.",
  "export.file.contacts": "contacts.csv",
  "export.about.contacts":
    "Eine Zeile je Kontakt eines Körperteils mit einer Seite: Beginn und Ende in Sekunden.",
  "export.file.jointErrors": "joint_errors.csv",
  "export.about.jointErrors":
    "Gelenkfehler je Phase, Gelenk und Achse in Grad: Mittel, RMS, P95, Maximum, gekappter Anteil.",
  "export.file.jointErrorCourse": "joint_error_course.csv",
  "export.about.jointErrorCourse":
    "Wie der Gelenkfehler innerhalb jeder Aufgabe verlief: sein Mittel in Grad je 5 s aktiver Zeit.",
  "export.file.events": "events.csv",
  "export.about.events": "Das Ereignisprotokoll jeder Sitzung, mit dem Hash, der es verkettet.",
  "export.file.quality": "quality.csv",
  "export.about.quality":
    "Eine Zeile je Aufgabe und Strom: Bildrate, Lücken, Sprünge, starre Gelenke, ungültige Werte.",
  "export.file.alarms": "alarms.csv",
  "export.about.alarms": "Jeder Alarm einer Sitzung: wann er begann und wann er endete.",
  "export.file.clocks": "clock_probes.csv, clock_mapping.csv",
  "export.about.clocks":
    "Die Uhr des Headsets neben der des Servers: rohe Ablesungen, daraus Versatz, Drift und Unsicherheit.",
  "export.file.samples": "samples/*.csv",
  "export.about.samples": "Eine breite Datei je Sitzung: Ziel- und Ist-Haltung über die Zeit.",
  "export.file.receipts": "receipts/*.json",
  "export.about.receipts":
    "Eine je Sitzung: wie viele Bilder entstanden, gespeichert sind und fehlen, mit dem Nachweis.",
  "export.file.imported": "imported/*.csv",
  "export.about.imported":
    "Anderswo erhobene Antworten, je Import eine Datei; in keiner anderen Tabelle.",
  "export.file.calibrations": "calibrations.csv",
  "export.about.calibrations": "Latenz der eigenen Geräte, soweit sie gemessen wurde.",
  "export.file.codebook": "codebook.csv",
  "export.about.codebook": "Jede Spalte: Bedeutung, Einheit, gültige Werte.",
};
