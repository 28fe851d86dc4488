/** What the pictures in a study's texts show, for whoever does not see them. */
export const proseEn = {
  "picture.equipment":
    "A headset, a controller in each hand, and trackers on the waist and both lower legs",
  "picture.t_pose": "A person standing upright, arms stretched out to the sides, feet together",
  "picture.mirror": "The mirror in front shows your body, the time left and the tasks completed",
  "picture.hand_boxes":
    "Four open boxes at chest height: a hand touches the panel inside one of them; a target is above them",
  "picture.foot_boxes":
    "Four open boxes on the floor to step into, with a bar behind them and a square to start from",
};

export const proseDe: Readonly<Record<keyof typeof proseEn, string>> = {
  "picture.equipment":
    "Ein Headset, ein Controller in jeder Hand, Tracker an der Taille und an beiden Unterschenkeln",
  "picture.t_pose": "Eine Person steht aufrecht, die Arme zur Seite gestreckt, die Füße zusammen",
  "picture.mirror":
    "Der Spiegel vor Ihnen zeigt Ihren Körper, die verbleibende Zeit und die erledigten Aufgaben",
  "picture.hand_boxes":
    "Vier offene Kästen in Brusthöhe: Eine Hand berührt die Rückwand in einem davon; darüber ist ein Ziel",
  "picture.foot_boxes":
    "Vier offene Kästen am Boden zum Hineintreten, dahinter ein Balken, davor ein Quadrat als Startplatz",
};
