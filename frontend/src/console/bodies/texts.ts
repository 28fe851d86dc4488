/** Texts about bodies: uploading, checking, naming and wearing them. */
export const bodiesEn = {
  "bodies.title": "Bodies",
  "bodies.lead":
    "Humanoid models that participants wear as their own body. Each is checked when it is uploaded, and named for use in studies.",
  "bodies.drop": "Drop models here, or",
  "bodies.choose": "Choose models",
  "bodies.drop.hint":
    "A VRM file or a rigged humanoid as a single glTF file (.glb, .gltf), up to 64 MB each. You can add several at once.",
  "bodies.upload.reads": "Sent; the server is measuring the model",
  "bodies.upload.done": "Measured. Give the body a name, so that studies can use it.",
  "bodies.empty": "No bodies yet",
  "bodies.empty.body":
    "A body is a humanoid model that participants see as their own body. Drop a VRM or glTF file above; it is checked before anybody wears it.",
  "bodies.empty.reader": "People who design studies upload bodies here.",
  "bodies.count_one": "{{count}} body",
  "bodies.count_other": "{{count}} bodies",
  "bodies.unnamed": "No name yet",
  "bodies.shipped": "Comes with Reembody",
  "bodies.stature": "{{value}} cm tall",
  "bodies.triangles": "{{count}} triangles",
  "bodies.file": "Download the model",
  "bodies.delete.title": "Delete this body?",
  "bodies.delete.words":
    "{{name}} and its file are deleted permanently. Nothing refers to a body without a name, unless an avatar configuration or a tuning uses it; then it stays.",
  "bodies.checks": "Checks",
  "bodies.status.good": "in order",
  "bodies.status.note": "note",
  "bodies.status.warn": "needs attention",
  "bodies.status.unknown": "unknown",
  "bodies.parts_one": "{{count}} part",
  "bodies.parts_other": "{{count}} parts",
  "bodies.check.parts": "Body parts",
  "bodies.check.parts.good": "All parts of the trunk, arms, legs and head are there.",
  "bodies.check.parts.note":
    "These parts are missing; each moves as one piece with the part above it:",
  "bodies.check.fingers": "Fingers",
  "bodies.check.fingers.good": "Ten fingers, each with all its parts.",
  "bodies.check.fingers.note": "{{value}} of {{limit}} fingers. Missing parts are not simulated:",
  "bodies.check.rest_pose": "Rest pose",
  "bodies.check.rest_pose.good": "The model stands upright in the T-pose.",
  "bodies.check.rest_pose.note": "The model was brought into the T-pose:",
  "bodies.check.proportions": "Proportions",
  "bodies.check.proportions.good": "All lengths occur in people.",
  "bodies.check.proportions.note":
    "Unusual for a person. The body is drawn with its own lengths; masses are computed with the nearest usual ones.",
  "bodies.length.upper_arm": "Upper arm",
  "bodies.length.forearm": "Forearm",
  "bodies.length.hand": "Hand",
  "bodies.length.thigh": "Thigh",
  "bodies.length.shank": "Lower leg",
  "bodies.length.foot": "Foot",
  "bodies.length.trunk": "Trunk",
  "bodies.length.shoulders": "Between the shoulder joints",
  "bodies.length.hips": "Between the hip joints",
  "bodies.length.arm": "Arm, from shoulder to wrist",
  "bodies.length.shoulder_height": "Height of the shoulders",
  "bodies.length.range":
    "{{length}} cm; usual at {{stature}} cm tall: {{usual}} cm, from {{low}} to {{high}} cm",
  "bodies.length.usual": "{{length}} cm; a person {{stature}} cm tall has {{usual}} cm",
  "bodies.check.reach": "Reach",
  "bodies.check.reach.good":
    "Hands match: a participant of this stature who stretches an arm ahead sees the hand of this body at most {{value}} cm from where their own is.",
  "bodies.check.reach.warn":
    "A participant of this stature who stretches an arm ahead sees the hand of this body {{value}} cm from where their own is, because of the lengths below. With more than {{limit}} cm the hand misses a box of the shipped hand task until they correct by sight. Try the task in a test session, or enlarge the boxes in the study.",
  "bodies.check.reach.unknown": "The body lacks parts of an arm, so its reach is not known.",
  "bodies.attention.reach": "Hand {{off}} cm from the participant's own when reaching",
  "bodies.attention.triangles": "{{count}} triangles: too many for a standalone headset",
  "bodies.attention.wearing": "Its author restricts who may wear it",
  "bodies.statures.generated": "Generated walk (not recorded)",
  "bodies.statures.upload": "Go to Captures",
  "bodies.licence.of.cc0": "CC0 (public domain)",
  "bodies.licence.of.cc_by": "Creative Commons Attribution (CC BY)",
  "bodies.licence.of.cc_by_sa": "Creative Commons Attribution-ShareAlike (CC BY-SA)",
  "bodies.licence.of.cc_by_nd": "Creative Commons Attribution-NoDerivatives (CC BY-ND)",
  "bodies.licence.of.cc_by_nc": "Creative Commons Attribution-NonCommercial (CC BY-NC)",
  "bodies.licence.of.cc_by_nc_sa":
    "Creative Commons Attribution-NonCommercial-ShareAlike (CC BY-NC-SA)",
  "bodies.licence.of.cc_by_nc_nd":
    "Creative Commons Attribution-NonCommercial-NoDerivatives (CC BY-NC-ND)",
  "bodies.licence.of.apache": "Apache License 2.0",
  "bodies.licence.of.mit": "MIT License",
  "bodies.licence.of.vrm_public": "VRM Public License 1.0",
  "bodies.licence.of.redistribution_prohibited": "Redistribution prohibited",
  "bodies.licence.of.other": "A licence of its author's own",
  "bodies.licence.means.cc0": "any use, without conditions",
  "bodies.licence.means.cc_by": "any use; its authors must be named",
  "bodies.licence.means.cc_by_sa":
    "any use; its authors must be named, and changed models need the same licence",
  "bodies.licence.means.cc_by_nd": "any use of the unchanged model; its authors must be named",
  "bodies.licence.means.cc_by_nc": "non-commercial use; its authors must be named",
  "bodies.licence.means.cc_by_nc_sa":
    "non-commercial use; its authors must be named, and changed models need the same licence",
  "bodies.licence.means.cc_by_nc_nd":
    "non-commercial use of the unchanged model; its authors must be named",
  "bodies.licence.means.apache": "any use; licence and notices must be kept",
  "bodies.licence.means.mit": "any use; the licence must be kept",
  "bodies.licence.means.vrm_public": "what the lines below allow",
  "bodies.licence.means.redistribution_prohibited":
    "use as the lines below say, but the file must not be passed on",
  "bodies.licence.means.other": "read its terms",
  "bodies.check.triangles": "Triangles",
  "bodies.check.triangles.good": "{{value}}; a standalone headset draws up to {{limit}} smoothly.",
  "bodies.check.triangles.warn":
    "{{value}}; a standalone headset draws only up to {{limit}} smoothly. Simplify the model, or use a headset connected to a computer.",
  "bodies.check.triangles.unknown":
    "Not counted yet, because an earlier release measured this body. Measure it again.",
  "bodies.check.hulls": "Convex hulls for contacts",
  "bodies.check.hulls.good":
    "Every part has a hull; skin is at most {{value}} mm outside its hull.",
  "bodies.check.hulls.note":
    "These parts have too little skin for a hull and keep simple shapes, or have skin more than {{limit}} mm outside their hull:",
  "bodies.check.licence": "Licence",
  "bodies.check.licence.good": "The file names its author or its licence.",
  "bodies.check.licence.unknown":
    "The file does not name its author or licence. Make sure that you may use it.",
  "bodies.check.wearing": "Permission to wear it",
  "bodies.check.wearing.good": "Its author lets everybody wear it.",
  "bodies.check.wearing.note":
    "Its author restricts who may wear it; somebody has confirmed that your participants may.",
  "bodies.check.wearing.warn":
    "Its author restricts who may wear it. Confirm that your participants may before a study uses it.",
  "bodies.check.wearing.unknown": "The file does not say who may wear it.",
  "bodies.measure": "Measure again",
  "bodies.measure.hint":
    "Reads the licence and the counts from the stored file; nothing else changes.",
  "bodies.name": "Name",
  "bodies.name.none":
    "Studies refer to a body by its name. A name is given once: it never changes and never refers to another body.",
  "bodies.name.reader": "This body has no name yet, so conditions of a study cannot refer to it.",
  "bodies.name.given": "is what studies and records call it.",
  "bodies.name.field": "Name for studies",
  "bodies.name.hint": "Small letters, digits, - and _, beginning with a letter.",
  "bodies.name.wrong":
    "The name must begin with a small letter; small letters, digits, - and _ may follow, up to 80 characters in all.",
  "bodies.name.save": "Give it this name",
  "bodies.title.field": "Title (optional)",
  "bodies.title.hint": "The title is shown in lists; you can change it later.",
  "bodies.title.save": "Save the title",
  "bodies.term.only_author":
    "The author of this model has agreed that our participants may wear it",
  "bodies.term.only_author.confirmed":
    "{{by}} confirmed on {{at}} that the author has agreed to this use.",
  "bodies.term.only_licensed_people":
    "Our participants have the author's permission to wear this model",
  "bodies.term.only_licensed_people.confirmed":
    "{{by}} confirmed on {{at}} that participants have the author's permission.",
  "bodies.term.hint":
    "The licence of the model asks for this. Your confirmation is kept in the audit trail.",
  "bodies.use": "Use",
  "bodies.use.nobody": "No study and no avatar configuration uses this body yet.",
  "bodies.use.none": "none",
  "bodies.use.studies": "Studies",
  "bodies.use.configurations": "Avatar configurations",
  "bodies.use.version": "{{key}}, version {{version}}",
  "bodies.use.study": "In a study",
  "bodies.use.unnamed": "Give the body a name first.",
  "bodies.use.lines":
    "Each condition may name the body that participants wear in it. Copy these lines into the study's file and adapt the key, the latency and the label:",
  "bodies.configure": "Save an avatar configuration that wears it",
  "bodies.configure.lead":
    "Participants wear the body of the study's avatar configuration in all conditions that name no body.",
  "bodies.configure.base": "Take gains, limits and masses from",
  "bodies.configure.key": "Key of the configuration",
  "bodies.configure.new": "This creates a new configuration.",
  "bodies.configure.next": "This configuration exists; saving adds its next version.",
  "bodies.configure.save": "Save configuration",
  "bodies.configure.saved": "Saved as {{key}}, version {{version}}.",
  "bodies.licence": "Licence and permissions",
  "bodies.licence.unread": "An earlier release measured this body without reading its licence.",
  "bodies.licence.title": "Title",
  "bodies.licence.authors": "Authors",
  "bodies.licence.name": "Licence",
  "bodies.licence.url": "Terms",
  "bodies.licence.unsaid": "The file does not state: {{names}}.",
  "bodies.permission.allowed": "allowed",
  "bodies.permission.forbidden": "not allowed",
  "bodies.permission.unknown": "not stated",
  "bodies.licence.copyright": "Copyright",
  "bodies.licence.wearers": "Who may wear it",
  "bodies.licence.credit": "Naming the authors",
  "bodies.wearers.author": "its author",
  "bodies.wearers.licensed": "people with the author's permission",
  "bodies.wearers.everyone": "everybody",
  "bodies.wearers.unknown": "not stated",
  "bodies.credit.true": "required",
  "bodies.credit.false": "not required",
  "bodies.credit.unknown": "not stated",
  "bodies.use.commercial": "Commercial use",
  "bodies.use.modification": "Modifying the model",
  "bodies.use.redistribution": "Redistributing the model",
  "bodies.use.violent": "Violent scenes",
  "bodies.use.sexual": "Sexual scenes",
  "bodies.use.political": "Political or religious use",
  "bodies.use.antisocial": "Antisocial or hateful use",
  "bodies.statures": "Three statures",
  "bodies.statures.lead":
    "The body “neutral” at 130, 165 and 190 cm, the statures of the avatars of Degen et al. 2022. The table shows how long their strides and how high their steps are when the same walk is transferred to them.",
  "bodies.statures.capture": "Walk",
  "bodies.statures.none":
    "These are the steps of a walk that the server generates: 70 cm long, by a body 175 cm tall. Upload a recorded walk to see its steps instead.",
  "bodies.statures.all": "The full verification of this capture",
  "bodies.statures.stature": "Stature",
  "bodies.statures.length": "Stride length (cm)",
  "bodies.statures.height": "Step height (cm)",
  "bodies.statures.here": "this walk",
  "bodies.statures.printed": "paper",
  "bodies.statures.caption":
    "Means over the strides of the walk, from one contact of a foot to its next. “Paper” is figure 9 of Degen et al. 2022, which shows another person's walk.",
} as const;

export const bodiesDe: Readonly<Record<keyof typeof bodiesEn, string>> = {
  "bodies.title": "Körper",
  "bodies.lead":
    "Menschenmodelle, die Teilnehmende als eigenen Körper tragen. Jedes wird beim Hochladen geprüft und für Studien benannt.",
  "bodies.drop": "Modelle hier ablegen oder",
  "bodies.choose": "Modelle auswählen",
  "bodies.drop.hint":
    "Eine VRM-Datei oder ein Menschenmodell mit Skelett als einzelne glTF-Datei (.glb, .gltf), je bis 64 MB. Sie können mehrere auf einmal hinzufügen.",
  "bodies.upload.reads": "Gesendet; der Server vermisst das Modell",
  "bodies.upload.done":
    "Vermessen. Geben Sie dem Körper einen Namen, damit Studien ihn verwenden können.",
  "bodies.empty": "Noch keine Körper",
  "bodies.empty.body":
    "Ein Körper ist ein Menschenmodell, das Teilnehmende als ihren eigenen Körper sehen. Legen Sie oben eine VRM- oder glTF-Datei ab; sie wird geprüft, bevor jemand den Körper trägt.",
  "bodies.empty.reader": "Wer Studien entwirft, lädt hier Körper hoch.",
  "bodies.count_one": "{{count}} Körper",
  "bodies.count_other": "{{count}} Körper",
  "bodies.unnamed": "Noch ohne Namen",
  "bodies.shipped": "Wird mit Reembody geliefert",
  "bodies.stature": "{{value}} cm groß",
  "bodies.triangles": "{{count}} Dreiecke",
  "bodies.file": "Modell herunterladen",
  "bodies.delete.title": "Diesen Körper löschen?",
  "bodies.delete.words":
    "{{name}} und die Datei werden endgültig gelöscht. Auf einen Körper ohne Namen verweist nichts, es sei denn, eine Avatar-Konfiguration oder ein Einstellen der Motoren verwendet ihn; dann bleibt er.",
  "bodies.checks": "Prüfungen",
  "bodies.status.good": "in Ordnung",
  "bodies.status.note": "Hinweis",
  "bodies.status.warn": "zu klären",
  "bodies.status.unknown": "unbekannt",
  "bodies.parts_one": "{{count}} Körperteil",
  "bodies.parts_other": "{{count}} Körperteile",
  "bodies.check.parts": "Körperteile",
  "bodies.check.parts.good": "Rumpf, Arme, Beine und Kopf sind vollständig.",
  "bodies.check.parts.note":
    "Diese Teile fehlen; jeder bewegt sich als ein Stück mit dem Teil darüber:",
  "bodies.check.fingers": "Finger",
  "bodies.check.fingers.good": "Zehn Finger, jeder mit allen Gliedern.",
  "bodies.check.fingers.note":
    "{{value}} von {{limit}} Fingern. Fehlende Glieder werden nicht simuliert:",
  "bodies.check.rest_pose": "Ruhehaltung",
  "bodies.check.rest_pose.good": "Das Modell steht aufrecht in der T-Pose.",
  "bodies.check.rest_pose.note": "Das Modell wurde in die T-Pose gebracht:",
  "bodies.check.proportions": "Proportionen",
  "bodies.check.proportions.good": "Alle Längen kommen bei Menschen vor.",
  "bodies.check.proportions.note":
    "Ungewöhnlich für einen Menschen. Gezeichnet wird der Körper mit seinen eigenen Längen; die Massen werden mit den nächsten üblichen berechnet.",
  "bodies.length.upper_arm": "Oberarm",
  "bodies.length.forearm": "Unterarm",
  "bodies.length.hand": "Hand",
  "bodies.length.thigh": "Oberschenkel",
  "bodies.length.shank": "Unterschenkel",
  "bodies.length.foot": "Fuß",
  "bodies.length.trunk": "Rumpf",
  "bodies.length.shoulders": "Zwischen den Schultergelenken",
  "bodies.length.hips": "Zwischen den Hüftgelenken",
  "bodies.length.arm": "Arm, von der Schulter bis zum Handgelenk",
  "bodies.length.shoulder_height": "Höhe der Schultern",
  "bodies.length.range":
    "{{length}} cm; üblich bei {{stature}} cm Größe: {{usual}} cm, von {{low}} bis {{high}} cm",
  "bodies.length.usual": "{{length}} cm; ein Mensch von {{stature}} cm Größe hat {{usual}} cm",
  "bodies.check.reach": "Reichweite",
  "bodies.check.reach.good":
    "Die Hände passen: Wer gleich groß ist und einen Arm nach vorn streckt, sieht die Hand dieses Körpers höchstens {{value}} cm neben der eigenen.",
  "bodies.check.reach.warn":
    "Wer gleich groß ist und einen Arm nach vorn streckt, sieht die Hand dieses Körpers {{value}} cm neben der eigenen; der Grund sind die Längen unten. Bei mehr als {{limit}} cm verfehlt die Hand einen Kasten der mitgelieferten Handaufgabe, bis man nach Sicht ausgleicht. Probieren Sie die Aufgabe in einer Testsitzung aus, oder vergrößern Sie die Kästen in der Studie.",
  "bodies.check.reach.unknown":
    "Dem Körper fehlen Teile eines Arms, deshalb ist seine Reichweite nicht bekannt.",
  "bodies.attention.reach": "Hand beim Greifen {{off}} cm neben der eigenen",
  "bodies.attention.triangles": "{{count}} Dreiecke: zu viele für ein eigenständiges Headset",
  "bodies.attention.wearing": "Der Urheber schränkt ein, wer ihn tragen darf",
  "bodies.statures.generated": "Erzeugter Gang (nicht aufgezeichnet)",
  "bodies.statures.upload": "Zu den Aufnahmen",
  "bodies.licence.of.cc0": "CC0 (gemeinfrei)",
  "bodies.licence.of.cc_by": "Creative Commons Namensnennung (CC BY)",
  "bodies.licence.of.cc_by_sa":
    "Creative Commons Namensnennung, Weitergabe unter gleichen Bedingungen (CC BY-SA)",
  "bodies.licence.of.cc_by_nd": "Creative Commons Namensnennung, keine Bearbeitungen (CC BY-ND)",
  "bodies.licence.of.cc_by_nc": "Creative Commons Namensnennung, nicht kommerziell (CC BY-NC)",
  "bodies.licence.of.cc_by_nc_sa":
    "Creative Commons Namensnennung, nicht kommerziell, Weitergabe unter gleichen Bedingungen (CC BY-NC-SA)",
  "bodies.licence.of.cc_by_nc_nd":
    "Creative Commons Namensnennung, nicht kommerziell, keine Bearbeitungen (CC BY-NC-ND)",
  "bodies.licence.of.apache": "Apache-Lizenz 2.0",
  "bodies.licence.of.mit": "MIT-Lizenz",
  "bodies.licence.of.vrm_public": "VRM Public License 1.0",
  "bodies.licence.of.redistribution_prohibited": "Weitergabe verboten",
  "bodies.licence.of.other": "Eigene Lizenz des Urhebers",
  "bodies.licence.means.cc0": "jede Verwendung, ohne Bedingungen",
  "bodies.licence.means.cc_by": "jede Verwendung; die Urheber müssen genannt werden",
  "bodies.licence.means.cc_by_sa":
    "jede Verwendung; die Urheber müssen genannt werden, und veränderte Modelle brauchen dieselbe Lizenz",
  "bodies.licence.means.cc_by_nd":
    "jede Verwendung des unveränderten Modells; die Urheber müssen genannt werden",
  "bodies.licence.means.cc_by_nc":
    "nicht kommerzielle Verwendung; die Urheber müssen genannt werden",
  "bodies.licence.means.cc_by_nc_sa":
    "nicht kommerzielle Verwendung; die Urheber müssen genannt werden, und veränderte Modelle brauchen dieselbe Lizenz",
  "bodies.licence.means.cc_by_nc_nd":
    "nicht kommerzielle Verwendung des unveränderten Modells; die Urheber müssen genannt werden",
  "bodies.licence.means.apache": "jede Verwendung; Lizenz und Hinweise müssen erhalten bleiben",
  "bodies.licence.means.mit": "jede Verwendung; die Lizenz muss erhalten bleiben",
  "bodies.licence.means.vrm_public": "was die Zeilen darunter erlauben",
  "bodies.licence.means.redistribution_prohibited":
    "Verwendung, wie die Zeilen darunter sagen; die Datei darf nicht weitergegeben werden",
  "bodies.licence.means.other": "lesen Sie ihre Bedingungen",
  "bodies.check.triangles": "Dreiecke",
  "bodies.check.triangles.good":
    "{{value}}; ein eigenständiges Headset zeichnet bis zu {{limit}} flüssig.",
  "bodies.check.triangles.warn":
    "{{value}}; ein eigenständiges Headset zeichnet nur bis zu {{limit}} flüssig. Vereinfachen Sie das Modell, oder verwenden Sie ein Headset an einem Computer.",
  "bodies.check.triangles.unknown":
    "Noch nicht gezählt, weil eine frühere Version diesen Körper vermessen hat. Vermessen Sie ihn neu.",
  "bodies.check.hulls": "Konvexe Hüllen für Kontakte",
  "bodies.check.hulls.good":
    "Jeder Teil hat eine Hülle; die Haut liegt höchstens {{value}} mm außerhalb ihrer Hülle.",
  "bodies.check.hulls.note":
    "Diese Teile haben zu wenig Haut für eine Hülle und behalten einfache Formen, oder ihre Haut liegt mehr als {{limit}} mm außerhalb ihrer Hülle:",
  "bodies.check.licence": "Lizenz",
  "bodies.check.licence.good": "Die Datei nennt Urheber oder Lizenz.",
  "bodies.check.licence.unknown":
    "Die Datei nennt weder Urheber noch Lizenz. Vergewissern Sie sich, dass Sie sie verwenden dürfen.",
  "bodies.check.wearing": "Erlaubnis, ihn zu tragen",
  "bodies.check.wearing.good": "Laut Urheber dürfen ihn alle tragen.",
  "bodies.check.wearing.note":
    "Der Urheber schränkt ein, wer ihn tragen darf; es ist bestätigt, dass Ihre Teilnehmenden das dürfen.",
  "bodies.check.wearing.warn":
    "Der Urheber schränkt ein, wer ihn tragen darf. Bestätigen Sie, dass Ihre Teilnehmenden das dürfen, bevor eine Studie ihn verwendet.",
  "bodies.check.wearing.unknown": "Die Datei sagt nicht, wer ihn tragen darf.",
  "bodies.measure": "Neu vermessen",
  "bodies.measure.hint":
    "Liest die Lizenz und die Anzahlen aus der gespeicherten Datei; sonst ändert sich nichts.",
  "bodies.name": "Name",
  "bodies.name.none":
    "Studien nennen einen Körper bei seinem Namen. Ein Name wird einmal vergeben, ändert sich nie und bezeichnet nie einen anderen Körper.",
  "bodies.name.reader":
    "Dieser Körper hat noch keinen Namen, deshalb können Bedingungen einer Studie ihn nicht nennen.",
  "bodies.name.given": "heißt er in Studien und Aufzeichnungen.",
  "bodies.name.field": "Name für Studien",
  "bodies.name.hint": "Kleinbuchstaben, Ziffern, - und _, am Anfang ein Buchstabe.",
  "bodies.name.wrong":
    "Der Name muss mit einem Kleinbuchstaben beginnen; danach sind Kleinbuchstaben, Ziffern, - und _ möglich, insgesamt höchstens 80 Zeichen.",
  "bodies.name.save": "Diesen Namen geben",
  "bodies.title.field": "Titel (freiwillig)",
  "bodies.title.hint": "Der Titel steht in Listen; Sie können ihn später ändern.",
  "bodies.title.save": "Titel speichern",
  "bodies.term.only_author":
    "Der Urheber dieses Modells ist einverstanden, dass unsere Teilnehmenden es tragen",
  "bodies.term.only_author.confirmed":
    "{{by}} hat am {{at}} bestätigt, dass der Urheber mit dieser Verwendung einverstanden ist.",
  "bodies.term.only_licensed_people":
    "Unsere Teilnehmenden haben die Erlaubnis des Urhebers, dieses Modell zu tragen",
  "bodies.term.only_licensed_people.confirmed":
    "{{by}} hat am {{at}} bestätigt, dass die Teilnehmenden die Erlaubnis des Urhebers haben.",
  "bodies.term.hint": "Die Lizenz des Modells verlangt das. Ihre Bestätigung bleibt im Prüfpfad.",
  "bodies.use": "Verwendung",
  "bodies.use.nobody": "Noch verwendet keine Studie und keine Avatar-Konfiguration diesen Körper.",
  "bodies.use.none": "keine",
  "bodies.use.studies": "Studien",
  "bodies.use.configurations": "Avatar-Konfigurationen",
  "bodies.use.version": "{{key}}, Version {{version}}",
  "bodies.use.study": "In einer Studie",
  "bodies.use.unnamed": "Geben Sie dem Körper zuerst einen Namen.",
  "bodies.use.lines":
    "Jede Bedingung kann den Körper nennen, den Teilnehmende in ihr tragen. Kopieren Sie diese Zeilen in die Datei der Studie, und passen Sie Schlüssel, Latenz und Bezeichnung an:",
  "bodies.configure": "Eine Avatar-Konfiguration mit diesem Körper speichern",
  "bodies.configure.lead":
    "In allen Bedingungen, die keinen Körper nennen, tragen Teilnehmende den Körper der Avatar-Konfiguration der Studie.",
  "bodies.configure.base": "Verstärkungen, Grenzen und Massen übernehmen von",
  "bodies.configure.key": "Schlüssel der Konfiguration",
  "bodies.configure.new": "Damit entsteht eine neue Konfiguration.",
  "bodies.configure.next":
    "Diese Konfiguration gibt es schon; beim Speichern entsteht ihre nächste Version.",
  "bodies.configure.save": "Konfiguration speichern",
  "bodies.configure.saved": "Gespeichert als {{key}}, Version {{version}}.",
  "bodies.licence": "Lizenz und Erlaubnisse",
  "bodies.licence.unread":
    "Eine frühere Version hat diesen Körper vermessen, ohne seine Lizenz zu lesen.",
  "bodies.licence.title": "Titel",
  "bodies.licence.authors": "Urheber",
  "bodies.licence.name": "Lizenz",
  "bodies.licence.url": "Bedingungen",
  "bodies.licence.unsaid": "Die Datei sagt nichts über: {{names}}.",
  "bodies.permission.allowed": "erlaubt",
  "bodies.permission.forbidden": "nicht erlaubt",
  "bodies.permission.unknown": "nicht angegeben",
  "bodies.licence.copyright": "Urheberrecht",
  "bodies.licence.wearers": "Wer ihn tragen darf",
  "bodies.licence.credit": "Nennung der Urheber",
  "bodies.wearers.author": "sein Urheber",
  "bodies.wearers.licensed": "Personen mit Erlaubnis des Urhebers",
  "bodies.wearers.everyone": "alle",
  "bodies.wearers.unknown": "nicht angegeben",
  "bodies.credit.true": "erforderlich",
  "bodies.credit.false": "nicht erforderlich",
  "bodies.credit.unknown": "nicht angegeben",
  "bodies.use.commercial": "Kommerzielle Nutzung",
  "bodies.use.modification": "Verändern des Modells",
  "bodies.use.redistribution": "Weitergeben des Modells",
  "bodies.use.violent": "Gewaltszenen",
  "bodies.use.sexual": "Sexuelle Szenen",
  "bodies.use.political": "Politische oder religiöse Nutzung",
  "bodies.use.antisocial": "Menschenfeindliche Nutzung",
  "bodies.statures": "Drei Körpergrößen",
  "bodies.statures.lead":
    "Der Körper „neutral“ mit 130, 165 und 190 cm, den Körpergrößen der Avatare von Degen et al. 2022. Die Tabelle zeigt, wie lang ihre Doppelschritte und wie hoch ihre Schritte sind, wenn derselbe Gang auf sie übertragen wird.",
  "bodies.statures.capture": "Gang",
  "bodies.statures.none":
    "Das sind die Schritte eines Gangs, den der Server erzeugt: 70 cm lang, von einem 175 cm großen Körper. Laden Sie einen aufgezeichneten Gang hoch, um stattdessen dessen Schritte zu sehen.",
  "bodies.statures.all": "Die vollständige Verifikation dieser Aufnahme",
  "bodies.statures.stature": "Körpergröße",
  "bodies.statures.length": "Doppelschritt (cm)",
  "bodies.statures.height": "Schritthöhe (cm)",
  "bodies.statures.here": "dieser Gang",
  "bodies.statures.printed": "Artikel",
  "bodies.statures.caption":
    "Mittelwerte über die Doppelschritte des Gangs, von einem Aufsetzen eines Fußes bis zu seinem nächsten. „Artikel“ ist Abbildung 9 von Degen et al. 2022, die den Gang einer anderen Person zeigt.",
};
