import { describe, expect, it } from "vitest";
import { ApiError, errorFromBody, isApiError, isUnauthorised } from "./request";

describe("errors of the server", () => {
  it("keep their message, remedy and details", () => {
    const error = errorFromBody(422, {
      error: {
        code: "invalid_config",
        message: "the study has a problem",
        remedy: "Mend it.",
        details: [{ path: "orders.replicates", line: 12, column: 3, message: "too few" }],
      },
    });
    expect(error.message).toBe("the study has a problem");
    expect(error.remedy).toBe("Mend it.");
    expect(error.details[0]?.line).toBe(12);
    expect(isApiError(error, "invalid_config")).toBe(true);
    expect(isApiError(error, "stale")).toBe(false);
  });

  it("are understood even if something other than the server answered", () => {
    const error = errorFromBody(502, null);
    expect(error).toBeInstanceOf(ApiError);
    expect(error.message).toContain("502");
  });

  it("distinguish an expired sign-in from every other error", () => {
    expect(isUnauthorised(errorFromBody(401, null))).toBe(true);
    expect(isUnauthorised(errorFromBody(403, null))).toBe(false);
    expect(isUnauthorised(new Error("x"))).toBe(false);
  });
});
