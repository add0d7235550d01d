/** What is said of the error budget of a pose. */
import type { Alignment } from "../../api/client";

const DECIMALS = 2;

/** Half the width at 95 %, what it is made of, largest first, and what nobody has stated; or why there is none. */
export function errorBudgetWords({
  error_budget: budget,
  error_budget_problem: problem,
}: Pick<Alignment, "error_budget" | "error_budget_problem">): string {
  if (budget === null) return `No error budget. ${problem?.code}: ${problem?.text}`;
  const { treatment, tip, contributions } = budget;
  const mm = (value = 0): string => value.toFixed(DECIMALS);
  const stated = contributions
    .filter(({ not_stated }) => not_stated === null)
    .sort((one, other) => other.treatment_mm - one.treatment_mm)
    .map(({ source, treatment_mm }) => `${source} ${mm(treatment_mm)}`);
  const missing = contributions.flatMap(({ source, not_stated }) => (not_stated === null ? [] : [source]));
  const [at, atTip] = [mm(treatment.half_axes_mm[0]), mm(tip.half_axes_mm[0])];
  return [
    `±${at} mm${missing.length === 0 ? "" : " or more"} at 95 %: ${stated.join(", ")}`,
    ...(atTip === at ? [] : [`tip ±${atTip} mm`]),
    ...(missing.length === 0 ? [] : [`not stated: ${missing.join(", ")}`]),
  ].join("; ");
}
