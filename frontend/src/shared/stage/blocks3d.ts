/**
 * Blocks in the scene: translucent bodies with edges, which can be recoloured without rebuilding
 * them.
 */
import {
  BoxGeometry,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
} from "three";
import {
  BLOCK_COLOURS,
  type Block,
  type BlockTone,
  type BlockTones,
  type StagePalette,
} from "./figure";

/** How opaque a block is. */
const OPACITY = { wall: 0.1, solid: 0.5, glowing: 0.82 } as const;

export class Blocks3d {
  readonly group = new Group();
  readonly #parts: readonly Part[];

  constructor(
    blocks: readonly Block[],
    private readonly palette: StagePalette,
  ) {
    this.#parts = blocks.map((block) => makePart(block, palette));
    for (const { body, edges } of this.#parts) this.group.add(body, edges);
    this.light(new Map());
  }

  /** The centre of the blocks that can be touched, metres. */
  get middle(): [x: number, y: number, z: number] {
    const touched = this.#parts.filter(({ block }) => !block.wall);
    const mean = (axis: 0 | 1 | 2) =>
      touched.reduce((sum, { block }) => sum + block.center[axis], 0) / Math.max(1, touched.length);
    return [mean(0), mean(1), mean(2)];
  }

  /** Show the blocks in their current tones. */
  light(tones: BlockTones): void {
    for (const { block, body, edges } of this.#parts) {
      const tone: BlockTone = tones.get(block.key) ?? "plain";
      const glows = tone !== "plain";
      const colour = glows ? BLOCK_COLOURS[tone] : this.palette.lineStrong;
      body.material.color.set(colour);
      body.material.opacity = glows ? OPACITY.glowing : block.wall ? OPACITY.wall : OPACITY.solid;
      edges.material.color.set(glows ? colour : this.palette.lineStrong);
      edges.material.opacity = glows ? 1 : 0.55;
    }
  }

  dispose(): void {
    for (const { body, edges } of this.#parts) {
      for (const one of [body, edges]) {
        one.geometry.dispose();
        one.material.dispose();
      }
    }
  }
}

interface Part {
  readonly block: Block;
  readonly body: Mesh<BoxGeometry, MeshLambertMaterial>;
  readonly edges: LineSegments<EdgesGeometry, LineBasicMaterial>;
}

function makePart(block: Block, palette: StagePalette): Part {
  const [x, y, z] = block.halfSize;
  const box = new BoxGeometry(2 * x, 2 * y, 2 * z);
  const body = new Mesh(
    box,
    new MeshLambertMaterial({ transparent: true, depthWrite: false, color: palette.lineStrong }),
  );
  const edges = new LineSegments(
    new EdgesGeometry(box),
    new LineBasicMaterial({ transparent: true, color: palette.lineStrong }),
  );
  body.position.set(...block.center);
  edges.position.copy(body.position);
  return { block, body, edges };
}
