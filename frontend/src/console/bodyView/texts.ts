/** Texts about bodies in 3-D: looking at one, and choosing how movement is drawn. */
export const bodyViewEn = {
  "bodyView.pose": "Pose",
  "bodyView.pose.rest": "T-pose",
  "bodyView.pose.stand": "Standing",
  "bodyView.pose.walk": "Walking (generated)",
  "bodyView.pose.recorded": "Walking (capture)",
  "bodyView.recorded.loading": "{{title}} is being transferred to the three statures",
  "bodyView.heights":
    "{{stature}} cm is the stature by its skeleton: the joint of the head stands at 87.5 % of it, as in people. What is drawn, hair and the size of the head included, reaches {{drawn}} m.",
  "bodyView.picture": "The body {{name}} in 3-D",
  "bodyView.loading": "Loading the body",
  "bodyView.failed": "The body cannot be shown: {{reason}}",
  "bodyView.failed.skeleton":
    "The body cannot be shown, so the stick figure is drawn instead: {{reason}}",
  "bodyView.plain_one":
    "Drawn without one of its textures, which this browser cannot read. Export the model with PNG or JPEG textures.",
  "bodyView.plain_other":
    "Drawn without {{count}} of its textures, which this browser cannot read. Export the model with PNG or JPEG textures.",
  "bodyView.plain.decoder_one":
    "Drawn without one of its textures: the decoder of compressed textures (KTX2) could not be loaded from the server.",
  "bodyView.plain.decoder_other":
    "Drawn without {{count}} of its textures: the decoder of compressed textures (KTX2) could not be loaded from the server.",
  "bodyView.drawn": "Drawn as",
  "bodyView.drawn.skin": "Body",
  "bodyView.drawn.skeleton": "Stick figure",
} as const;

export const bodyViewDe: Readonly<Record<keyof typeof bodyViewEn, string>> = {
  "bodyView.pose": "Haltung",
  "bodyView.pose.rest": "T-Pose",
  "bodyView.pose.stand": "Stehen",
  "bodyView.pose.walk": "Gehen (erzeugt)",
  "bodyView.pose.recorded": "Gehen (Aufnahme)",
  "bodyView.recorded.loading": "{{title}} wird auf die drei Körpergrößen übertragen",
  "bodyView.heights":
    "{{stature}} cm ist die Größe nach dem Skelett: Das Gelenk des Kopfes ist auf 87,5 % davon, wie bei Menschen. Was gezeichnet ist, mit Haaren und der Größe des Kopfes, reicht bis {{drawn}} m.",
  "bodyView.picture": "Der Körper {{name}} in 3-D",
  "bodyView.loading": "Der Körper wird geladen",
  "bodyView.failed": "Der Körper kann nicht angezeigt werden: {{reason}}",
  "bodyView.failed.skeleton":
    "Der Körper kann nicht angezeigt werden; stattdessen wird die Strichfigur gezeichnet: {{reason}}",
  "bodyView.plain_one":
    "Gezeichnet ohne eine seiner Texturen, die dieser Browser nicht lesen kann. Exportieren Sie das Modell mit Texturen als PNG oder JPEG.",
  "bodyView.plain_other":
    "Gezeichnet ohne {{count}} seiner Texturen, die dieser Browser nicht lesen kann. Exportieren Sie das Modell mit Texturen als PNG oder JPEG.",
  "bodyView.plain.decoder_one":
    "Gezeichnet ohne eine seiner Texturen: Der Decoder für komprimierte Texturen (KTX2) konnte nicht vom Server geladen werden.",
  "bodyView.plain.decoder_other":
    "Gezeichnet ohne {{count}} seiner Texturen: Der Decoder für komprimierte Texturen (KTX2) konnte nicht vom Server geladen werden.",
  "bodyView.drawn": "Gezeichnet als",
  "bodyView.drawn.skin": "Körper",
  "bodyView.drawn.skeleton": "Strichfigur",
};
