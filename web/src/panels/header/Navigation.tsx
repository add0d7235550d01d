import { type Route, useRoute } from "../../state/route";
import { useConsole } from "../../state/store";

const pages: readonly { readonly route: Route; readonly title: string; readonly adminOnly: boolean }[] = [
  { route: "robot", title: "Robot", adminOnly: false },
  { route: "workflow", title: "Workflow", adminOnly: false },
  { route: "targeting", title: "Targeting", adminOnly: false },
  { route: "proposals", title: "Proposals", adminOnly: false },
  { route: "runs", title: "Runs", adminOnly: false },
  { route: "plots", title: "Plots", adminOnly: false },
  { route: "tuning", title: "Tuning", adminOnly: false },
  { route: "view", title: "3D", adminOnly: false },
  { route: "codes", title: "Codes", adminOnly: false },
  { route: "users", title: "Users", adminOnly: true },
  { route: "audit", title: "Audit", adminOnly: true },
];

/** Where one is, and where else one can go. */
export function Navigation() {
  const login = useConsole((state) => state.login);
  const shown = useRoute();
  if (login.phase !== "in") return null;
  const open = pages.filter((page) => !page.adminOnly || login.user.role === "admin");
  return (
    <nav aria-label="Pages" className="pages">
      {open.map(({ route, title }) => (
        <a key={route} href={`#/${route}`} aria-current={route === shown ? "page" : undefined}>
          {title}
        </a>
      ))}
    </nav>
  );
}
