/** Texts of walking: importing walks, and fitting a model. */
export const walkSetEn = {
  "walking.delete": "Delete",
  "walking.delete.of": "Delete {{title}}",
  "walking.delete.title": "Delete permanently?",
  "walking.delete.body": "“{{title}}” cannot be recovered. The deletion is recorded.",
  "walking.models": "Models",
  "walking.models.lead": "Each is fitted in a separate process and does not slow sessions down.",
  "walking.models.none": "No models yet",
  "walking.models.none.body": "Add walks below, then fit a model on them.",
  "walking.model.new": "New model",
  "walking.model.file": "Model file",
  "walking.model.scene": "Planned in",
  "walking.model.scene.hint":
    "The scene of all walks for which the table names none. Paths are planned around its obstacles.",
  "walking.model.scene.open": "the open floor",
  "walking.model.scene.own": "the scenes they were made for",
  "walking.scene.ofModel": "the model’s",
  "walking.scenes.in": "{{count}} in {{scene}}",
  "walking.scenes.open": "{{count}} on the open floor",
  "walking.scenes.ofModel": "{{count}} in the model’s scene",
  "walking.scenes.deleted": "{{key}} (deleted)",
  "walking.numbers.some": "({{some}} of {{all}} walks)",
  "walking.numbers.same": "{{name}}, the same for all walks",
  "walking.numbers.changing": "Changes during every walk, so no model can depend on it: {{names}}.",
  "walking.numbers.spoilt": "{{text}}. Correct it and add the walks again to use the column.",
  "walking.numbers.notOffered": "Not offered, since not every cell is a number",
  "walking.numbers.dependsOn": "Depends on",
  "walking.numbers.dependsOn.hint":
    "Besides length, turning and stature; up to three. Walks without the number are left out.",
  "walking.numbers.dependsOn.none": "nothing else",
  "walking.numbers.names": "Further numbers",
  "walking.numbers.names.hint":
    "What else a model may depend on, with the unit in its name: load_kg, or gaze_on_display as 1 or 0.",
  "walking.numbers.wrong":
    "“{{name}}” is not valid: letters, digits and underscores, a letter first; not length, turning or stature.",
  "walking.numbers.unknown": "not known",
  "walking.sets": "Walks",
  "walking.sets.one": "Walks",
  "walking.sets.lead": "Tracks on the floor, split where people stand still.",
  "walking.sets.none": "No walks yet",
  "walking.sets.none.body":
    "Add a table of tracks, captures of people walking, or synthetic walkers.",
  "walking.set.assumed": "How it was read: {{text}}.",
  "walking.set.doubt":
    "{{text}}. Check the unit of x and y, and the rate; then add the walks again.",
  "walking.sets.new": "New walks",
  "walking.sets.way": "Where the walks come from",
  "walking.sets.add": "Add",
  "walking.way.tracks": "Table of tracks",
  "walking.way.captures": "Captures",
  "walking.way.population": "Synthetic walkers",
  "walking.way.tracks.hint":
    "CSV with the columns id, time_s (or frame), x, y; one row per person and moment. A column scene says where (a scene’s key, or open floor); numbers such as load_kg may be what a model depends on.",
  "walking.way.captures.hint":
    "The centre of mass, hips or belt tracker of stored captures. The walks are kept when a capture is deleted.",
  "walking.way.population.hint":
    "Walkers generated from documented rules. Everything derived from them is marked as synthetic.",
  "walking.name": "Name",
  "walking.table": "Table",
  "walking.table.choose": "Choose a file",
  "walking.table.synthetic": "These tracks were generated; nobody walked them",
  "walking.rate": "Rate (Hz)",
  "walking.rate.hint": "if time is given as frame numbers",
  "walking.unit": "Unit of x and y",
  "walking.unit.header": "as stated in the header",
  "walking.statures": "Statures",
  "walking.statures.hint":
    "One line per person, in metres; without them, models cannot take stature into account.",
  "walking.population": "Population",
  "walking.captures": "Captures",
  "walking.captures.choose": "Choose captures",
  "walking.captures.none": "No captures yet",
  "walking.subject": "Who walks",
  "walking.reading": "Reading of the maps",
  "walking.reading.chosen": "Chosen by cross-validation",
  "walking.reading.paper": "As in the paper",
  "walking.reading.time-aware": "Time-aware",
  "walking.reading.chosen.hint":
    "Ten readings are compared by how well they predict people they were not fitted on.",
  "walking.reading.paper.hint":
    "Suitability is one minus the deviation as a share of the largest deviation.",
  "walking.reading.time-aware.hint":
    "As in the paper, but the further the arrival time is from the person's, the lower the suitability.",
  "walking.advanced": "Advanced",
  "walking.option.steps.hint": "More make the maps finer, and the fit slower: by their cube.",
  "walking.option.k.hint": "How many similar walks a prediction blends.",
  "walking.option.entries.hint":
    "Recorded walks and blends of them, among which similar ones are sought.",
  "walking.option.seed.hint": "The same seed gives the same model.",
  "walking.option.steps": "Values of each parameter",
  "walking.option.k": "Neighbours",
  "walking.option.entries": "Entries after blending",
  "walking.option.seed": "Seed",
  "walking.option.people": "People",
  "walking.option.repetitions": "Repetitions",
  "walking.fit": "Fit",
} as const;

export const walkSetDe: Readonly<Record<keyof typeof walkSetEn, string>> = {
  "walking.delete": "Löschen",
  "walking.delete.of": "{{title}} löschen",
  "walking.delete.title": "Endgültig löschen?",
  "walking.delete.body":
    "„{{title}}“ lässt sich nicht wiederherstellen. Die Löschung wird festgehalten.",
  "walking.models": "Modelle",
  "walking.models.lead":
    "Jedes wird in einem eigenen Prozess angepasst und verlangsamt keine Sitzungen.",
  "walking.models.none": "Noch keine Modelle",
  "walking.models.none.body":
    "Fügen Sie unten Gänge hinzu und passen Sie dann ein Modell an sie an.",
  "walking.model.new": "Neues Modell",
  "walking.model.file": "Modelldatei",
  "walking.model.scene": "Geplant in",
  "walking.model.scene.hint":
    "Die Szene aller Gänge, für die die Tabelle keine nennt. Wege werden um ihre Hindernisse herum geplant.",
  "walking.model.scene.open": "der freien Fläche",
  "walking.model.scene.own": "den Szenen, für die sie gemacht wurden",
  "walking.scene.ofModel": "die des Modells",
  "walking.scenes.in": "{{count}} in {{scene}}",
  "walking.scenes.open": "{{count}} auf der freien Fläche",
  "walking.scenes.ofModel": "{{count}} in der Szene des Modells",
  "walking.scenes.deleted": "{{key}} (gelöscht)",
  "walking.numbers.some": "({{some}} von {{all}} Gängen)",
  "walking.numbers.same": "{{name}}, bei allen Gängen gleich",
  "walking.numbers.changing":
    "Ändert sich in jedem Gang, daher kann kein Modell davon abhängen: {{names}}.",
  "walking.numbers.spoilt":
    "{{text}}. Berichtigen Sie das und fügen Sie die Gänge neu hinzu, um die Spalte zu nutzen.",
  "walking.numbers.notOffered": "Nicht angeboten, weil nicht jede Zelle eine Zahl ist",
  "walking.numbers.dependsOn": "Hängt ab von",
  "walking.numbers.dependsOn.hint":
    "Außer von Länge, Drehung und Körpergröße; bis zu drei. Gänge ohne die Zahl werden ausgelassen.",
  "walking.numbers.dependsOn.none": "nichts weiter",
  "walking.numbers.names": "Weitere Zahlen",
  "walking.numbers.names.hint":
    "Wovon ein Modell noch abhängen kann, mit der Einheit im Namen: load_kg, oder gaze_on_display als 1 oder 0.",
  "walking.numbers.wrong":
    "„{{name}}“ ist nicht gültig: Buchstaben, Ziffern und Unterstriche, zuerst ein Buchstabe; nicht length, turning oder stature.",
  "walking.numbers.unknown": "nicht bekannt",
  "walking.sets": "Gänge",
  "walking.sets.one": "Gänge",
  "walking.sets.lead": "Spuren am Boden, geteilt, wo jemand stillsteht.",
  "walking.sets.none": "Noch keine Gänge",
  "walking.sets.none.body":
    "Fügen Sie eine Tabelle mit Spuren, Aufnahmen gehender Personen oder synthetische Geher hinzu.",
  "walking.set.assumed": "So wurde sie gelesen: {{text}}.",
  "walking.set.doubt":
    "{{text}}. Prüfen Sie die Einheit von x und y und die Rate, und fügen Sie die Gänge neu hinzu.",
  "walking.sets.new": "Neue Gänge",
  "walking.sets.way": "Woher die Gänge kommen",
  "walking.sets.add": "Hinzufügen",
  "walking.way.tracks": "Tabelle mit Spuren",
  "walking.way.captures": "Aufnahmen",
  "walking.way.population": "Synthetische Geher",
  "walking.way.tracks.hint":
    "CSV mit den Spalten id, time_s (oder frame), x, y; eine Zeile je Person und Zeitpunkt. Eine Spalte scene sagt, wo (Schlüssel einer Szene, oder open floor); von Zahlen wie load_kg kann ein Modell abhängen.",
  "walking.way.captures.hint":
    "Schwerpunkt, Hüfte oder Gürteltracker gespeicherter Aufnahmen. Die Gänge bleiben erhalten, wenn eine Aufnahme gelöscht wird.",
  "walking.way.population.hint":
    "Geher, die nach dokumentierten Regeln erzeugt werden. Alles, was daraus entsteht, ist als synthetisch gekennzeichnet.",
  "walking.name": "Name",
  "walking.table": "Tabelle",
  "walking.table.choose": "Datei wählen",
  "walking.table.synthetic": "Diese Spuren wurden erzeugt; niemand ist sie gegangen",
  "walking.rate": "Rate (Hz)",
  "walking.rate.hint": "wenn die Zeit als Bildnummer angegeben ist",
  "walking.unit": "Einheit von x und y",
  "walking.unit.header": "wie im Tabellenkopf angegeben",
  "walking.statures": "Körpergrößen",
  "walking.statures.hint":
    "Eine Zeile je Person, in Metern; ohne sie können Modelle die Körpergröße nicht berücksichtigen.",
  "walking.population": "Population",
  "walking.captures": "Aufnahmen",
  "walking.captures.choose": "Aufnahmen wählen",
  "walking.captures.none": "Noch keine Aufnahmen",
  "walking.subject": "Wer geht",
  "walking.reading": "Lesart der Karten",
  "walking.reading.chosen": "Durch Kreuzvalidierung gewählt",
  "walking.reading.paper": "Wie in der Veröffentlichung",
  "walking.reading.time-aware": "Mit Ankunftszeit",
  "walking.reading.chosen.hint":
    "Zehn Lesarten werden danach verglichen, wie gut sie Personen vorhersagen, an die sie nicht angepasst wurden.",
  "walking.reading.paper.hint":
    "Eignung ist eins minus die Abweichung als Anteil der größten Abweichung.",
  "walking.reading.time-aware.hint":
    "Wie in der Veröffentlichung, aber je weiter die Ankunftszeit von der der Person abweicht, desto geringer die Eignung.",
  "walking.advanced": "Weitere Einstellungen",
  "walking.option.steps.hint":
    "Mehr machen die Karten feiner, die Anpassung aber langsamer: mit der dritten Potenz.",
  "walking.option.k.hint": "Wie viele ähnliche Gänge eine Vorhersage mischt.",
  "walking.option.entries.hint":
    "Aufgezeichnete Gänge und Mischungen daraus, unter denen ähnliche gesucht werden.",
  "walking.option.seed.hint": "Derselbe Startwert gibt dasselbe Modell.",
  "walking.option.steps": "Werte jeder Steuergröße",
  "walking.option.k": "Nachbarn",
  "walking.option.entries": "Einträge nach dem Mischen",
  "walking.option.seed": "Startwert",
  "walking.option.people": "Personen",
  "walking.option.repetitions": "Wiederholungen",
  "walking.fit": "Anpassen",
};
