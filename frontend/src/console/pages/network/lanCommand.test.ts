import { describe, expect, it } from "vitest";
import { lanCommand } from "./lanCommand";

describe("The command for other devices", () => {
  it("names the port of this server unless it is the usual one", () => {
    expect(lanCommand("8321")).toBe("./run --lan");
    expect(lanCommand("9000")).toBe("./run --lan --port 9000");
  });
});
