/** One body, or two side by side that are given the same commands at the same times. */
import type { Mujoco } from "@shared/avatar/mujoco";
import type { Command } from "./commands";
import { Deflection, type PushFigures } from "./deflection";
import { type Shape, shapesOf } from "./shapes";
import { type Stops, stopsOf } from "./stops";
import { type BodyToTry, COLUMNS, type Following, TICK_S, TriedBody } from "./triedBody";

/** Numbers of a reading of an axis: target, angle (radians), torque (N m). */
export const READING = 3;

/** How one body fared in the last advance. */
export interface Progress extends Following {
  /** Position and rotation of every body of its model (7 numbers each), in the world. */
  readonly places: Float32Array;
  /** A reading of the watched axis after every 10 ms. */
  readonly readings: Float64Array;
  /** The greatest torque of the watched axis' motor, N m; NaN if the model has no hinge for it. */
  readonly limitNm: number;
  /** Where the push acts; null when nobody pushes. */
  readonly pushedAtM: readonly [number, number, number] | null;
  /** What the last push has done since; null without one since the last reset. */
  readonly push: PushFigures | null;
  /** What stands in the way of a push at the part that was asked for; null if none was. */
  readonly stops: Stops | null;
  /** Frames after which the simulation had failed and was restored, since it was opened. */
  readonly restored: number;
  /** Times at which MuJoCo had started anew by itself. */
  readonly resets: number;
  readonly isFinite: boolean;
}

interface Tried {
  readonly given: BodyToTry;
  readonly body: TriedBody;
  deflection: Deflection | null;
}

export class Tryout {
  private tried: readonly Tried[];
  /** Whether the target moves by itself. */
  private isMoving = false;

  /** Throws SimulationError for a model that is not an avatar with a box. */
  constructor(
    private readonly mujoco: Mujoco,
    given: readonly BodyToTry[],
    private readonly hipsScales: readonly number[] = [],
  ) {
    this.tried = given.map((one, row) => this.opened(one, row));
  }

  get bodies(): readonly TriedBody[] {
    return this.tried.map(({ body }) => body);
  }

  get timeS(): number {
    return this.tick * TICK_S;
  }

  get longestLatencyS(): number {
    return Math.min(...this.bodies.map((body) => body.longestLatencyS));
  }

  shapes(): readonly (readonly Shape[])[] {
    return this.bodies.map(({ avatar }) => shapesOf(this.mujoco, avatar.model, avatar.table));
  }

  /** Give all bodies a command; throws SimulationError if one of them cannot obey. */
  obey(command: Command): void {
    for (const one of this.tried) give(one, command, this.isMoving);
    if (command.kind === "play") this.isMoving = true;
    if (command.kind === "drive") this.isMoving = (command.drive?.wave.kind ?? "hold") !== "hold";
  }

  /**
   * Try other bodies. Those that were there go on as they are; others begin at rest, at this time,
   * in the pose of the standing commands. Returns what they could not obey.
   */
  change(given: readonly BodyToTry[], standing: Iterable<Command>): readonly unknown[] {
    const { tick, tried } = this;
    const left = [...tried];
    const problems: unknown[] = [];
    const next = given.map((one, row) => {
      const at = left.findIndex((other) => isAlike(other.given, one));
      const kept = at < 0 ? undefined : left.splice(at, 1)[0];
      if (kept !== undefined) return kept;
      const joins = this.opened(one, row);
      for (const command of standing) {
        try {
          give(joins, command, true);
        } catch (problem) {
          problems.push(problem);
        }
      }
      give(joins, { kind: "reset", atTick: tick }, true);
      return joins;
    });
    this.tried = next;
    for (const { body } of left) body.dispose();
    return problems;
  }

  /** Simulate a number of ticks of 10 ms; watch an axis, and what a push at a part would meet. */
  advance(ticks: number, axis: string, part?: string): readonly Progress[] {
    const column = COLUMNS.get(axis) ?? -1;
    return this.tried.map((one) => {
      const { body } = one;
      const readings = new Float64Array(READING * ticks);
      for (let tick = 0; tick < ticks; tick++) {
        body.tick();
        body.writeReading(column, readings, READING * tick);
        const { deflection } = one;
        deflection?.turned(directionOf(body, deflection.part), body.pushedAt() !== null);
      }
      const places = new Float32Array(7 * body.avatar.model.nbody);
      body.writePlaces(places);
      const { restored, resets } = body.health;
      return {
        ...body.following,
        places,
        readings,
        limitNm: limitOf(body, column),
        pushedAtM: body.pushedAt(),
        push: one.deflection?.figures ?? null,
        stops: part === undefined ? null : stopsOf(body, part),
        restored,
        resets,
        isFinite: body.isFinite,
      };
    });
  }

  dispose(): void {
    for (const body of this.bodies) body.dispose();
  }

  private get tick(): number {
    return this.bodies[0]?.commandTick ?? 0;
  }

  private opened(given: BodyToTry, row: number): Tried {
    const body = new TriedBody(this.mujoco, given, this.hipsScales[row]);
    return { given, body, deflection: null };
  }
}

/** Give one body a command; `isMoving`: its target moves by itself. */
function give(one: Tried, command: Command, isMoving: boolean): void {
  const { body, deflection } = one;
  if (command.kind === "push" && command.push !== null) {
    const { part, forS } = command.push;
    // Whoever pulls changes the force again and again: that is one push.
    const goesOn = forS === null && deflection?.part === part && body.pushedAt() !== null;
    body.obey(command);
    if (goesOn) return;
    const isAtRest = !isMoving && deflection?.isOver !== false;
    one.deflection = new Deflection(part, directionOf(body, part), isAtRest);
    return;
  }
  body.obey(command);
  if (command.kind === "reset") one.deflection = null;
  else if (command.kind !== "push") deflection?.disturb();
}

/** A part's `world_from_part`. */
function directionOf({ avatar }: TriedBody, part: string): Float64Array {
  const at = 4 * (avatar.table.bodies.get(part) as number);
  return avatar.views.renewed().xquat.subarray(at, at + 4);
}

function limitOf({ avatar: { table, views } }: TriedBody, column: number): number {
  const motor = table.motors[table.columns.indexOf(column)];
  return motor === undefined
    ? Number.NaN
    : (views.renewed().actuatorForcerange[2 * motor + 1] as number);
}

const isAlike = (one: BodyToTry, other: BodyToTry): boolean =>
  one.mjcf === other.mjcf &&
  JSON.stringify(one.configuration) === JSON.stringify(other.configuration);
