import { logout } from "../../state/commands";
import { type Route, useRoute } from "../../state/route";
import { useConsole } from "../../state/store";
import { KeysHelp } from "../keys/KeysHelp";
import { ControlBar } from "./ControlBar";
import { ThemeButton } from "./ThemeButton";

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

/** Where one is, who may move the robot, and who one is. */
export function SessionBar() {
  const login = useConsole((state) => state.login);
  const shown = useRoute();
  if (login.phase !== "in") return null;
  const { name, role } = login.user;
  const open = pages.filter((page) => !page.adminOnly || role === "admin");
  return (
    <div className="session-bar">
      <nav aria-label="Pages">
        {open.map(({ route, title }) => (
          <a key={route} href={`#/${route}`} aria-current={route === shown ? "page" : undefined}>
            {title}
          </a>
        ))}
      </nav>
      <ControlBar />
      <div className="who">
        {shown === "robot" && <ArrangeButton />}
        <ThemeButton user={name} />
        <KeysHelp />
        <a
          href="#/account"
          aria-current={shown === "account" ? "page" : undefined}
          title="Change your password"
        >
          <span className="visually-hidden">Account </span>
          <strong>{name}</strong> · {role}
        </a>
        <button type="button" className="button" onClick={() => void logout()}>
          Log out
        </button>
      </div>
    </div>
  );
}

/** Offers buttons in the head of each panel that move and fold it. */
function ArrangeButton() {
  const arranging = useConsole((state) => state.arranging);
  return (
    <button
      type="button"
      className="button quiet"
      aria-pressed={arranging}
      onClick={() => useConsole.setState({ arranging: !arranging })}
    >
      Arrange
    </button>
  );
}
