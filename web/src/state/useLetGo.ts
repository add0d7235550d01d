import { useEffect } from "react";

/**
 * Lets go of what is held when the page leaves the operator's hands: another window, another tab, leaving.
 * `letGo` must be the same function in every rendering.
 */
export function useLetGo(letGo: () => void): void {
  useEffect(() => {
    const onVisibility = (): void => {
      if (document.hidden) letGo();
    };
    window.addEventListener("blur", letGo);
    window.addEventListener("pagehide", letGo);
    document.addEventListener("visibilitychange", onVisibility);
    return () => {
      window.removeEventListener("blur", letGo);
      window.removeEventListener("pagehide", letGo);
      document.removeEventListener("visibilitychange", onVisibility);
    };
  }, [letGo]);
}
