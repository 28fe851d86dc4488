/** Blocks that stand in the scene: walls and panels of boxes, targets, places to start from. */

/** How a block looks: `plain` as it stands there; the others mean something and glow. */
export type BlockTone = "plain" | "good" | "touched" | "odd" | "bad";

export interface Block {
  readonly key: string;
  /** Walls are seen through; the others are there to be touched. */
  readonly wall: boolean;
  /** Metres, in the world of the figures. */
  readonly center: readonly [x: number, y: number, z: number];
  readonly halfSize: readonly [x: number, y: number, z: number];
}

/** What is not `plain`, by the blocks' keys. */
export type BlockTones = ReadonlyMap<string, BlockTone>;

/** Told apart with any kind of colour vision, and by how strongly they are drawn. */
export const BLOCK_COLOURS: Readonly<Record<Exclude<BlockTone, "plain">, string>> = {
  good: "#009e73",
  touched: "#3a8fd6",
  odd: "#e0a100",
  bad: "#d43d1a",
};
