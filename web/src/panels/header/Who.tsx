import { logout } from "../../state/commands";
import { useRoute } from "../../state/route";
import { useConsole } from "../../state/store";
import { KeysHelp } from "../keys/KeysHelp";
import { ThemeButton } from "./ThemeButton";

/** Who is logged in here, and how this user wants the console. */
export function Who() {
  const login = useConsole((state) => state.login);
  const shown = useRoute();
  if (login.phase !== "in") return null;
  const { name, role } = login.user;
  return (
    <div className="who">
      <a
        className="who-link"
        href="#/account"
        aria-current={shown === "account" ? "page" : undefined}
        title="Change your password"
      >
        <span className="visually-hidden">Account </span>
        <strong>{name}</strong> · {role}
      </a>
      <div>
        {shown === "robot" && <ArrangeButton />}
        <ThemeButton user={name} />
        <KeysHelp />
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
