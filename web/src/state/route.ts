/** The page that is shown, kept in the hash, so that reloading, links and the back button work. */
import { useSyncExternalStore } from "react";

export const routes = ["robot", "users", "audit", "account"] as const;
export type Route = (typeof routes)[number];

/** The page that a hash names; the robot for every other. */
export function routeOf(hash: string): Route {
  const name = hash.replace(/^#\/?/, "");
  return routes.find((route) => route === name) ?? "robot";
}

function subscribe(listener: () => void): () => void {
  window.addEventListener("hashchange", listener);
  return () => window.removeEventListener("hashchange", listener);
}

export function useRoute(): Route {
  return useSyncExternalStore(subscribe, () => routeOf(window.location.hash));
}
