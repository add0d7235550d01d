/** The page that is shown, kept in the hash, so that reloading, links and the back button work. */
import { useSyncExternalStore } from "react";
import { catalog, type Family } from "../generated/catalog";

export const routes = [
  "robot",
  "workflow",
  "targeting",
  "proposals",
  "runs",
  "plots",
  "tuning",
  "view",
  "codes",
  "users",
  "audit",
  "account",
] as const;
export type Route = (typeof routes)[number];

/** A place in the catalog of codes. */
export interface CodePlace {
  readonly family: Family;
  readonly code: string;
}

/** Pages on which one proposal can be looked at. */
type ProposalRoute = "proposals" | "view";

/** Kinds of motion that have a form on the page of proposals. */
export const motionKinds = ["coordinated", "ablation"] as const;
export type MotionKind = (typeof motionKinds)[number];

/** The page that a hash names; the robot for every other. Codes, proposals and runs alone have places within. */
export function routeOf(hash: string): Route {
  const [name, ...place] = segments(hash);
  const named = routes.find((route) => route === name);
  if (named === undefined) return "robot";
  const known =
    place.length === 0 ||
    named === "codes" ||
    proposalOf(hash) !== null ||
    motionOf(hash) !== null ||
    runOf(hash) !== null;
  return known ? named : "robot";
}

/** The number of the proposal that a hash leads to; null when it names none. */
export function proposalOf(hash: string): number | null {
  const [page, id, ...rest] = segments(hash);
  const named = page === "proposals" || page === "view";
  return named && rest.length === 0 ? numberOf(id) : null;
}

/** The hash that leads to a proposal. */
export function proposalHash(page: ProposalRoute, id: number): string {
  return `#/${page}/${id}`;
}

/** A run that is looked at, and the one that it is compared with. */
export interface RunPlace {
  readonly id: number;
  readonly other: number | null;
}

/** The run that a hash leads to; null when it names none. */
export function runOf(hash: string): RunPlace | null {
  const [page, first, second, ...rest] = segments(hash);
  const id = numberOf(first);
  if (page !== "runs" || id === null || rest.length > 0) return null;
  const other = numberOf(second);
  return (second === undefined) === (other === null) && other !== id ? { id, other } : null;
}

/** The hash that leads to a run, beside another one where that is named. */
export function runHash(id: number, other: number | null = null): string {
  return `#/runs/${id}${other === null ? "" : `/${other}`}`;
}

/** The kind of motion whose form a hash leads to; null when it names none. */
export function motionOf(hash: string): MotionKind | null {
  const [page, name, ...rest] = segments(hash);
  if (page !== "proposals" || rest.length > 0) return null;
  return motionKinds.find((kind) => kind === name) ?? null;
}

/** The hash that leads to the form of a kind of motion. */
export function motionHash(kind: MotionKind): string {
  return `#/proposals/${kind}`;
}

/** The code that a hash leads to; null when it names none. */
export function codeOf(hash: string): CodePlace | null {
  const [page, family, code] = segments(hash);
  if (page !== "codes" || family === undefined || !isFamily(family)) return null;
  return catalog[family].some(({ name }) => name === code) ? { family, code: code ?? "" } : null;
}

/** The hash that leads to a code. */
export function codeHash(family: Family, code: string): string {
  return `#/codes/${family}/${code}`;
}

function numberOf(text: string | undefined): number | null {
  return text !== undefined && /^[1-9]\d{0,9}$/.test(text) ? Number(text) : null;
}

function segments(hash: string): string[] {
  return hash.replace(/^#\/?/, "").split("/");
}

function isFamily(name: string): name is Family {
  return Object.hasOwn(catalog, name);
}

function subscribe(listener: () => void): () => void {
  window.addEventListener("hashchange", listener);
  return () => window.removeEventListener("hashchange", listener);
}

function useHash(): string {
  return useSyncExternalStore(subscribe, () => window.location.hash);
}

export function useRoute(): Route {
  return routeOf(useHash());
}

export function useCodePlace(): CodePlace | null {
  const hash = useHash();
  return codeOf(hash);
}

/** The proposal that the page is about; null when it is about none in particular. */
export function useProposalPlace(): number | null {
  return proposalOf(useHash());
}

/** The kind of motion whose form was asked for; null when none was. */
export function useMotionPlace(): MotionKind | null {
  return motionOf(useHash());
}

/** The run that the page is about; null when it is about none in particular. */
export function useRunPlace(): RunPlace | null {
  return runOf(useHash());
}
