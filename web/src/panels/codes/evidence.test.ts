import { expect, test } from "vitest";
import { type CatalogEntry, catalog } from "../../generated/catalog";
import { evidencePlace } from "./evidence";

test("every fault, verdict, gate and cause that the kernel answers for rests on a property with a page", () => {
  for (const family of ["fault", "verdict", "gate", "cause"] as const) {
    const codes: readonly CatalogEntry[] = catalog[family];
    for (const code of codes) {
      for (const property of code.properties) {
        expect(evidencePlace(property)).toMatch(/^\/docs\/report\/trace\.html#[PL]\d+$/);
      }
    }
    expect(codes.filter(({ properties }) => properties.length === 0)).toEqual([]);
  }
});
