import { useEffect, useState } from "react";
import { chosenTheme, nextTheme, rememberTheme, type Theme } from "../../state/theme";

const shapes: Record<Theme, string> = { system: "◐", light: "○", dark: "●" };

/** Goes from the computer's theme to light, dark and back, for this user on this computer. */
export function ThemeButton({ user }: { readonly user: string }) {
  const [theme, setTheme] = useState(() => chosenTheme(localStorage, user));
  useEffect(() => {
    document.documentElement.dataset.theme = theme;
  }, [theme]);
  const onClick = (): void => {
    const next = nextTheme(theme);
    rememberTheme(localStorage, user, next);
    setTheme(next);
  };
  return (
    <button type="button" className="button quiet" aria-label={`Theme: ${theme}`} onClick={onClick}>
      <i aria-hidden="true">{shapes[theme]}</i> {theme}
    </button>
  );
}
