/** The layouts of a study's tasks, from the `tasks` of the welcome. */
import * as v from "valibot";
import { buildLayout, type LayoutSpec, type Limb, type TaskLayout } from "./layout";

const Metres3 = v.tuple([v.number(), v.number(), v.number()]);
const Block = v.object({ center_m: Metres3, size_m: Metres3 });
const side = v.picklist(["left", "right", "top", "bottom", "front_rim", "front", "back"]);
const common = {
  target: Block,
  wall_thickness_m: v.number(),
  panel_thickness_m: v.number(),
  sides: v.array(side),
  direction: v.picklist(["by_hand", "left_to_right", "right_to_left"]),
  reverse_after_task: v.boolean(),
};

const HandTask = v.object({
  ...common,
  boxes: v.array(v.object({ number: v.number(), center_m: Metres3, inner_size_m: Metres3 })),
});

const FootTask = v.object({
  ...common,
  boxes: v.array(
    v.object({
      number: v.number(),
      center_m: Metres3,
      inner_width_m: v.number(),
      inner_height_m: v.number(),
    }),
  ),
  base_length_m: v.number(),
  length_factor: v.number(),
  start_square: Block,
  counting_foot: v.picklist(["either", "left", "right"]),
});

const Tasks = v.object({ hand: v.nullish(HandTask), foot: v.nullish(FootTask) });

/** The layout of every task that the study has; throws `v.ValiError` for anything else. */
export function layoutsOf(tasks: unknown): ReadonlyMap<Limb, TaskLayout> {
  const { hand, foot } = v.parse(Tasks, tasks);
  const specs: LayoutSpec[] = [];
  if (hand) {
    specs.push({
      ...commonOf(hand),
      limb: "hand",
      boxes: hand.boxes.map((box) => ({
        number: box.number,
        centerM: box.center_m,
        innerSizeM: box.inner_size_m,
      })),
      startSquare: null,
      countingFoot: null,
    });
  }
  if (foot) {
    const lengthM = foot.base_length_m * foot.length_factor;
    specs.push({
      ...commonOf(foot),
      limb: "foot",
      boxes: foot.boxes.map((box) => ({
        number: box.number,
        centerM: box.center_m,
        innerSizeM: [box.inner_width_m, box.inner_height_m, lengthM],
      })),
      startSquare: blockOf(foot.start_square),
      countingFoot: foot.counting_foot === "either" ? null : foot.counting_foot,
    });
  }
  return new Map(specs.map((spec) => [spec.limb, buildLayout(spec)]));
}

const blockOf = ({ center_m, size_m }: v.InferOutput<typeof Block>) => ({
  centerM: center_m,
  sizeM: size_m,
});

function commonOf(task: v.InferOutput<typeof HandTask> | v.InferOutput<typeof FootTask>) {
  return {
    target: blockOf(task.target),
    wallThicknessM: task.wall_thickness_m,
    panelThicknessM: task.panel_thickness_m,
    sides: task.sides,
    direction: task.direction,
    reverseAfterTask: task.reverse_after_task,
  };
}
