/** Texts of the verification: whether a walk keeps its character on avatars of several statures. */
export const verificationEn = {
  "verify.lead":
    "The movement on several avatars, checked as in Degen et al. (2022): feet lift as often and at the same times as the source's, and strides are longer or shorter in proportion to the legs.",
  "verify.avatars": "Avatars",
  "verify.avatar.remove": "Remove {{avatar}}",
  "verify.avatar.add": "Add an avatar",
  "verify.avatar.stature": "Stature (cm)",
  "verify.avatar.most": "Up to {{count}} avatars at once.",
  "verify.lock": "Lock feet",
  "verify.lock.hint": "Feet on the ground stay in place; the legs bend to allow it.",
  "verify.busy": "Retargeting the movement to the avatars",
  "verify.agree":
    "Every avatar lifts each foot as often as the source ({{left}} left, {{right}} right).",
  "verify.agree.timing":
    "The same lift or contact differs by at most {{milliseconds}} ms between any two bodies.",
  "verify.differ": "The number of lifts differs: {{told}}.",
  "verify.differ.one":
    "{{avatar}}: {{left}} left and {{right}} right instead of {{wantedLeft}} and {{wantedRight}}",
  "verify.differ.remedy":
    "Look at the lifts below: a foot that barely leaves the ground may count on one body and not on another.",
  "verify.noStep": "No strides found",
  "verify.noStep.body":
    "No foot leaves the ground and comes down again within the capture, so there are no strides to compare. Angles and paths are shown.",
  "verify.impossible": "There is nothing to verify",
  "verify.unmapped": "Not mapped, so in the T-pose on every avatar: {{names}}",
  "verify.source": "Source",
  "verify.left": "left",
  "verify.right": "right",
  "verify.table": "The source and the avatars",
  "verify.column.body": "Body",
  "verify.column.leg": "Leg length (m)",
  "verify.column.ratio": "Leg ratio",
  "verify.column.length": "Stride length (m)",
  "verify.column.height": "Step height (m)",
  "verify.column.start": "Toe at start (m)",
  "verify.column.contact": "Toe at contact (m)",
  "verify.column.lifts": "Lifts",
  "verify.column.slide": "Foot slide (m/s)",
  "verify.column.export": "Export",
  "verify.ratio": "× {{value}}",
  "verify.slide.before": "{{before}} before locking",
  "verify.lowered": "hips up to {{centimetres}} cm lower",
  "verify.reach": "out of reach in {{count}} frames",
  "verify.raised": "Raised smoothly where a foot would be under the floor: {{told}}.",
  "verify.raised.one":
    "{{avatar}} by up to {{most}} cm and {{mean}} cm on average (a foot would be {{sunk}} cm deep)",
  "verify.lifted":
    "Feet lifted singly where their lowest point would be under the floor: {{told}}.",
  "verify.lifted.one":
    "{{avatar}} by up to {{most}} cm (unlocked, a foot would be {{sunk}} cm deep)",
  "verify.table.caption":
    "Means over whole strides (from one contact of a foot to its next). Slide is the mean speed of feet on the ground.",
  "verify.export": "{{avatar}} as {{format}}",
  "verify.angles": "Leg angles of the source",
  "verify.angles.caption":
    "Positive angles: thigh forward, knee bent, toes up. 0° is a straight hip, a straight knee and an ankle at a right angle.",
  "verify.angle.hip": "Hip (deg)",
  "verify.angle.knee": "Knee (deg)",
  "verify.angle.ankle": "Ankle (deg)",
  "verify.time": "Time (s)",
  "verify.toe": "Path of the toe joint",
  "verify.toe.caption": "Along the walk and above the ground, as in figure 9 of the paper.",
  "verify.toe.forward.left": "Forward, left foot (m)",
  "verify.toe.forward.right": "Forward, right foot (m)",
  "verify.toe.height": "Height (m)",
  "verify.lifts": "When each foot is off the ground",
  "verify.lifts.caption": "The left foot is above each line, the right foot below it.",
  "verify.lift": "{{side}} foot, {{from}} s to {{to}} s",
  "verify.drawing": "Drawing the figure",
  "verify.notDrawn": "The figure could not be drawn. Its numbers are in the table.",
} as const;

export const verificationDe: Readonly<Record<keyof typeof verificationEn, string>> = {
  "verify.lead":
    "Die Bewegung auf mehreren Avataren, überprüft wie bei Degen et al. (2022): Die Füße heben sich so oft und zu denselben Zeiten wie die der Quelle, und die Länge der Doppelschritte ändert sich im Verhältnis der Beinlänge.",
  "verify.avatars": "Avatare",
  "verify.avatar.remove": "{{avatar}} entfernen",
  "verify.avatar.add": "Avatar hinzufügen",
  "verify.avatar.stature": "Körpergröße (cm)",
  "verify.avatar.most": "Bis zu {{count}} Avatare zugleich.",
  "verify.lock": "Füße festhalten",
  "verify.lock.hint": "Füße am Boden bleiben an ihrem Platz; dazu beugen sich die Beine.",
  "verify.busy": "Die Bewegung wird auf die Avatare übertragen",
  "verify.agree":
    "Jeder Avatar hebt jeden Fuß so oft wie die Quelle ({{left}} links, {{right}} rechts).",
  "verify.agree.timing":
    "Dasselbe Heben oder Aufsetzen weicht zwischen zwei Körpern um höchstens {{milliseconds}} ms ab.",
  "verify.differ": "Die Zahl der Hebungen weicht ab: {{told}}.",
  "verify.differ.one":
    "{{avatar}}: {{left}} links und {{right}} rechts statt {{wantedLeft}} und {{wantedRight}}",
  "verify.differ.remedy":
    "Sehen Sie sich die Hebungen unten an: Ein Fuß, der den Boden kaum verlässt, zählt vielleicht bei einem Körper und beim anderen nicht.",
  "verify.noStep": "Keine Doppelschritte gefunden",
  "verify.noStep.body":
    "Kein Fuß verlässt in der Aufnahme den Boden und setzt wieder auf; deshalb gibt es keine Doppelschritte zu vergleichen. Winkel und Wege werden gezeigt.",
  "verify.impossible": "Es gibt nichts zu überprüfen",
  "verify.unmapped": "Nicht zugeordnet, also auf jedem Avatar in der T-Pose: {{names}}",
  "verify.source": "Quelle",
  "verify.left": "links",
  "verify.right": "rechts",
  "verify.table": "Die Quelle und die Avatare",
  "verify.column.body": "Körper",
  "verify.column.leg": "Beinlänge (m)",
  "verify.column.ratio": "Beinverhältnis",
  "verify.column.length": "Doppelschrittlänge (m)",
  "verify.column.height": "Schritthöhe (m)",
  "verify.column.start": "Zehen am Anfang (m)",
  "verify.column.contact": "Zehen beim Aufsetzen (m)",
  "verify.column.lifts": "Hebungen",
  "verify.column.slide": "Fußrutschen (m/s)",
  "verify.column.export": "Export",
  "verify.ratio": "× {{value}}",
  "verify.slide.before": "{{before}} vor dem Festhalten",
  "verify.lowered": "Hüfte bis zu {{centimetres}} cm tiefer",
  "verify.reach": "in {{count}} Bildern außer Reichweite",
  "verify.raised": "Sanft angehoben, wo ein Fuß unter dem Boden wäre: {{told}}.",
  "verify.raised.one":
    "{{avatar}} um bis zu {{most}} cm, im Mittel {{mean}} cm (ein Fuß wäre {{sunk}} cm tief)",
  "verify.lifted": "Füße einzeln angehoben, wo ihr tiefster Punkt unter dem Boden wäre: {{told}}.",
  "verify.lifted.one":
    "{{avatar}} um bis zu {{most}} cm (ohne Festhalten wäre ein Fuß {{sunk}} cm tief)",
  "verify.table.caption":
    "Mittelwerte über ganze Doppelschritte (von einem Aufsetzen eines Fußes bis zu seinem nächsten). Rutschen ist die mittlere Geschwindigkeit der Füße am Boden.",
  "verify.export": "{{avatar}} als {{format}}",
  "verify.angles": "Beinwinkel der Quelle",
  "verify.angles.caption":
    "Positive Winkel: Oberschenkel nach vorn, Knie gebeugt, Zehen nach oben. 0° ist eine gestreckte Hüfte, ein gestrecktes Knie und ein Knöchel im rechten Winkel.",
  "verify.angle.hip": "Hüfte (Grad)",
  "verify.angle.knee": "Knie (Grad)",
  "verify.angle.ankle": "Knöchel (Grad)",
  "verify.time": "Zeit (s)",
  "verify.toe": "Weg des Zehengelenks",
  "verify.toe.caption":
    "In Gangrichtung und über dem Boden, wie in Abbildung 9 der Veröffentlichung.",
  "verify.toe.forward.left": "Vorwärts, linker Fuß (m)",
  "verify.toe.forward.right": "Vorwärts, rechter Fuß (m)",
  "verify.toe.height": "Höhe (m)",
  "verify.lifts": "Wann welcher Fuß vom Boden abgehoben ist",
  "verify.lifts.caption": "Der linke Fuß ist über jeder Linie, der rechte darunter.",
  "verify.lift": "Fuß {{side}}, {{from}} s bis {{to}} s",
  "verify.drawing": "Die Abbildung wird gezeichnet",
  "verify.notDrawn": "Die Abbildung ließ sich nicht zeichnen. Ihre Zahlen stehen in der Tabelle.",
};
