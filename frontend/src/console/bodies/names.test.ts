import type { BodyListed } from "@shared/api/bodies";
import { describe, expect, it } from "vitest";
import { knownLicence, titleOf } from "./names";

describe("licences of bodies", () => {
  it("are recognised in the spellings of VRM and of other glTF files", () => {
    expect(knownLicence("CC_BY")).toBe("cc_by");
    expect(knownLicence("CC-BY-4.0 (http://creativecommons.org/licenses/by/4.0/)")).toBe("cc_by");
    expect(knownLicence("CC_BY_NC_SA")).toBe("cc_by_nc_sa");
    expect(knownLicence("CC0")).toBe("cc0");
    expect(knownLicence("Apache-2.0")).toBe("apache");
    expect(knownLicence("VRM Public License 1.0")).toBe("vrm_public");
    expect(knownLicence("Redistribution_Prohibited")).toBe("redistribution_prohibited");
    expect(knownLicence("House licence")).toBeNull();
  });
});

describe("the title of a body", () => {
  const body = { title: null, name: null, file_name: "a.b.vrm", licence: null };
  it("is the lab's, else its author's, else its name, else its file's without the ending", () => {
    const titled = (more: object) => titleOf({ ...body, ...more } as unknown as BodyListed);
    expect(titled({})).toBe("a.b");
    expect(titled({ name: "worn" })).toBe("worn");
    expect(titled({ name: "worn", licence: { title: "" } })).toBe("worn");
    expect(titled({ name: "worn", licence: { title: "undefined" } })).toBe("worn");
    expect(titled({ name: "worn", licence: { title: "Godette" } })).toBe("Godette");
    expect(titled({ title: "Ours", licence: { title: "Godette" } })).toBe("Ours");
  });
});
