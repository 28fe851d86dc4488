/** The pictures that a study's texts can show, by their names in the file: `![t_pose]`. */
export const PICTURES = ["equipment", "t_pose", "mirror", "hand_boxes", "foot_boxes"] as const;

export type PictureName = (typeof PICTURES)[number];

export const isPicture = (name: string): name is PictureName =>
  (PICTURES as readonly string[]).includes(name);
