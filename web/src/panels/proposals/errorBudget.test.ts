import { describe, expect, it } from "vitest";
import type { ErrorBudget } from "../../api/client";
import { errorBudgetWords } from "./errorBudget";

const ellipsoid = (longest: number): ErrorBudget["tip"] => ({
  centre_mm: [0, 0, 0],
  half_axes_mm: [longest, 0.5, 0.2],
  directions: [1, 0, 0, 0, 1, 0, 0, 0, 1],
  covariance_mm2: [1, 0, 0, 0, 1, 0, 0, 0, 1],
});
const part = (
  source: ErrorBudget["contributions"][number]["source"],
  treatment_mm: number,
  not_stated: string | null = null,
) => ({ source, treatment_mm, tip_mm: treatment_mm, not_stated });
const budget: ErrorBudget = {
  treatment: ellipsoid(1),
  tip: ellipsoid(1.25),
  contributions: [
    part("registration", 0.9),
    part("encoder", 0.2),
    part("play", 0.4),
    part("calibration", 0),
    part("image", 0.1),
  ],
};

describe("errorBudgetWords", () => {
  it("name the half width at 95 % and what it is made of, the largest first", () => {
    expect(errorBudgetWords({ error_budget: budget, error_budget_problem: null })).toBe(
      "±1.00 mm at 95 %: registration 0.90, play 0.40, encoder 0.20, image 0.10, calibration 0.00; tip ±1.25 mm",
    );
  });

  it("say that it is the least, and what is not in it, where something is not stated", () => {
    const contributions = [part("registration", 0, "It has no residual."), part("encoder", 0.2)];
    const error_budget = { ...budget, tip: ellipsoid(1), contributions };
    expect(errorBudgetWords({ error_budget, error_budget_problem: null })).toBe(
      "±1.00 mm or more at 95 %: encoder 0.20; not stated: registration",
    );
  });

  it("say why there is none near a singular pose", () => {
    const error_budget_problem = { code: "SINGULAR", text: "It leaves an angle undetermined." };
    expect(errorBudgetWords({ error_budget: null, error_budget_problem })).toBe(
      "No error budget. SINGULAR: It leaves an angle undetermined.",
    );
  });
});
