/**
 * The space that the headset guards, as far as its browser tells: the corners of WebXR's
 * `bounded-floor`, in the study's world.
 */

/** Of a reference space with bounds; its corners are in its own frame. */
interface Bounded extends XRReferenceSpace {
  readonly boundsGeometry?: Iterable<DOMPointReadOnly>;
}

export class Boundary {
  private constructor(private readonly space: Bounded | null) {}

  /** Null where the browser gives no bounds to pages at all, which says nothing about the room. */
  static async of(session: XRSession): Promise<Boundary | null> {
    const features: readonly string[] = session.enabledFeatures ?? [];
    if (!features.includes("bounded-floor")) return null;
    try {
      const space = (await session.requestReferenceSpace("bounded-floor")) as Bounded;
      return space.boundsGeometry === undefined ? null : new Boundary(space);
    } catch {
      // Granted, and refused now: nothing was set up, or only a circle to stand in.
      return new Boundary(null);
    }
  }

  /** The corners on the floor of `world`; null if nothing is guarded. */
  corners(
    frame: XRFrame,
    world: XRSpace,
  ): readonly { readonly x: number; readonly z: number }[] | null {
    const bounds = [...(this.space?.boundsGeometry ?? [])];
    const pose = this.space === null ? undefined : frame.getPose(this.space, world);
    if (pose === undefined || pose === null || bounds.length === 0) return null;
    const { matrix } = pose.transform;
    const at = (index: number): number => matrix[index] ?? 0;
    return bounds.map(({ x, z }) => ({
      x: at(0) * x + at(8) * z + at(12),
      z: at(2) * x + at(10) * z + at(14),
    }));
  }
}
