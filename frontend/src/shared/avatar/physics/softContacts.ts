/**
 * Soften the contacts of parts that are deep inside something, so that they are not thrown out. The
 * server's `app/science/avatar/simulation/soft_contacts.py` says why.
 */
import type { Contacts } from "./contacts";
import type { ModelTable } from "./modelTable";
import type { Views } from "./views";

const DEEP_M = 0.03;
const FREE_M = 0.005;
const SOFT_SOLREF = [0.1, 1];
const SOFT_SOLIMP = [0.5, 0.8, 0.05, 0.5, 2];
const SOFT_PRIORITY = 2;

export class SoftContacts {
  private readonly priority: Int32Array;
  private readonly solref: Float64Array;
  private readonly solimp: Float64Array;
  private readonly soft: Uint8Array;
  private readonly deepestM: Float64Array;
  private isAnySoft = false;

  constructor(
    private readonly views: Views,
    private readonly table: ModelTable,
    private readonly contacts: Contacts,
  ) {
    this.priority = views.geomPriority.slice();
    this.solref = views.geomSolref.slice();
    this.solimp = views.geomSolimp.slice();
    this.soft = new Uint8Array(views.model.nbody);
    this.deepestM = new Float64Array(views.model.nbody);
  }

  /** Make every contact of the body soft until its part is no longer deep inside anything. */
  softenAll(): void {
    for (const body of this.table.bodies.values()) this.soft[body] = 1;
    this.write();
  }

  /** Soften parts deep inside something, and restore the others; `contacts` was read. */
  watch(): void {
    if (!this.isAnySoft && !this.isAnyDeep()) return;
    this.measureDepths();
    let isChanged = false;
    for (let body = 0; body < this.soft.length; body++) {
      const limitM = this.soft[body] === 1 ? FREE_M : DEEP_M;
      const isSoft = (this.deepestM[body] as number) > limitM ? 1 : 0;
      if (isSoft !== this.soft[body]) {
        this.soft[body] = isSoft;
        isChanged = true;
      }
    }
    if (isChanged) this.write();
  }

  private isAnyDeep(): boolean {
    for (let row = 0; row < this.contacts.count; row++) {
      if (this.contacts.distanceM(row) < -DEEP_M) return true;
    }
    return false;
  }

  private measureDepths(): void {
    const { deepestM, contacts, table } = this;
    deepestM.fill(0);
    for (let row = 0; row < contacts.count; row++) {
      const depthM = -contacts.distanceM(row);
      for (const side of BOTH) {
        const body = table.geomBodies[contacts.geom(row, side)] as number;
        if (depthM > (deepestM[body] as number)) deepestM[body] = depthM;
      }
    }
    deepestM[0] = 0;
  }

  private write(): void {
    this.isAnySoft = this.soft.includes(1);
    const { geomPriority, geomSolref, geomSolimp } = this.views;
    const { geomBodies } = this.table;
    geomPriority.set(this.priority);
    geomSolref.set(this.solref);
    geomSolimp.set(this.solimp);
    if (!this.isAnySoft) return;
    for (let geom = 0; geom < geomBodies.length; geom++) {
      if (this.soft[geomBodies[geom] as number] !== 1) continue;
      geomPriority[geom] = SOFT_PRIORITY;
      geomSolref.set(SOFT_SOLREF, 2 * geom);
      geomSolimp.set(SOFT_SOLIMP, 5 * geom);
    }
  }
}

const BOTH = [0, 1] as const;
