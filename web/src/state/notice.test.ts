import { describe, expect, it } from "vitest";
import type { Proposal } from "../api/client";
import { catalog, entry } from "../generated/catalog";
import { noticeOfProblem, noticeOfProposal } from "./notice";

describe("noticeOfProblem", () => {
  it.each(catalog.verdict)("says what $name means and what to do next", ({ name, meaning, next_step }) => {
    expect(noticeOfProblem({ code: name, detail: "" })).toEqual({ code: name, meaning, nextStep: next_step });
  });

  it("adds what and where to the meaning, once", () => {
    const meaning = entry("verdict", "DISABLED").meaning;
    expect(noticeOfProblem({ code: "DISABLED", detail: "Axis yaw." }).meaning).toBe(`${meaning} Axis yaw.`);
    expect(noticeOfProblem({ code: "DISABLED", detail: `yaw: ${meaning}` }).meaning).toBe(`yaw: ${meaning}`);
    expect(noticeOfProblem({ code: "DISABLED", detail: meaning }).meaning).toBe(meaning);
  });

  it("says a next step that the detail repeats only once", () => {
    const { meaning, next_step } = entry("verdict", "DISABLED");
    const notice = noticeOfProblem({ code: "DISABLED", detail: `yaw: ${meaning} ${next_step}` });
    expect(notice).toEqual({ code: "DISABLED", meaning: `yaw: ${meaning}`, nextStep: next_step });
  });

  it("takes the app's next step and what it expected for codes of its own", () => {
    const problem = {
      code: "INVALID",
      detail: "target is 1e9.",
      expected: "a number",
      next_step: "Ask for less.",
    };
    expect(noticeOfProblem(problem)).toEqual({
      code: "INVALID",
      meaning: "target is 1e9. Expected a number.",
      nextStep: "Ask for less.",
    });
  });
});

describe("noticeOfProposal", () => {
  const refused = { state: "refused", verdict: "RANGE", detail: "Beyond 12.5°." } as Proposal;

  it("explains a refusal", () => {
    expect(noticeOfProposal(refused)).toMatchObject({
      code: "RANGE",
      nextStep: entry("verdict", "RANGE").next_step,
    });
    expect(noticeOfProposal(refused)?.meaning).toContain("Beyond 12.5°.");
  });

  it("is silent about proposals that were not refused", () => {
    expect(noticeOfProposal({ ...refused, state: "done" })).toBeNull();
  });
});
