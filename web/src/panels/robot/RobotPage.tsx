import { useState } from "react";
import { flushSync } from "react-dom";
import { moveButtonId, PlaceContext } from "../../design/PanelPlace";
import {
  canFold,
  canMove,
  chosenLayout,
  type Layout,
  type Move,
  moved,
  type PanelName,
  rememberLayout,
  withFolded,
} from "../../state/layout";
import { useConsole } from "../../state/store";
import { BenchPanel } from "../bench/BenchPanel";
import { BiopsyPanel } from "../biopsy/BiopsyPanel";
import { CommunicationPanel } from "../communication/CommunicationPanel";
import { LivePage } from "../cover/LivePage";
import { LogPanel } from "../log/LogPanel";
import { MotorsPanel } from "../motors/MotorsPanel";
import { NavigationPanel } from "../navigation/NavigationPanel";
import { ProposalsPanel } from "../proposals/ProposalsPanel";
import { StatusPanel } from "../status/StatusPanel";
import { WhyPanel } from "../why/WhyPanel";

const panels: Readonly<Record<PanelName, () => React.ReactNode>> = {
  motors: MotorsPanel,
  log: LogPanel,
  communication: CommunicationPanel,
  navigation: NavigationPanel,
  bench: BenchPanel,
  biopsy: BiopsyPanel,
  proposals: ProposalsPanel,
  why: WhyPanel,
  status: StatusPanel,
};
const moves: readonly Move[] = ["up", "down", "across"];

/** The panels, where the user wants them. */
export function RobotPage({ user }: { readonly user: string }) {
  const arranging = useConsole((state) => state.arranging);
  const takesBiopsies = useConsole((state) => state.robot?.modes.includes("cooperative_biopsy") ?? false);
  const simulated = useConsole((state) => state.frame?.simulated ?? false);
  const replay = useConsole((state) => state.frame?.replay ?? false);
  const [layout, setLayout] = useState(() => chosenLayout(localStorage, user));
  const exists: Partial<Record<PanelName, boolean>> = {
    bench: simulated && !replay,
    biopsy: takesBiopsies,
  };
  const shown = [...layout.main, ...layout.side].filter((name) => exists[name] ?? true);

  const change = (next: Layout): void => {
    rememberLayout(localStorage, user, next);
    setLayout(next);
  };
  const move = (name: PanelName, way: Move): void => {
    // The browser takes the focus from what it moves.
    flushSync(() => change(moved(layout, name, way, shown)));
    document.getElementById(moveButtonId(name, way))?.focus();
  };
  const place = (name: PanelName) => {
    const Content = panels[name];
    const value = {
      name,
      folded: layout.folded.includes(name),
      foldable: canFold(name),
      onFold: (folded: boolean) => change(withFolded(layout, name, folded)),
      moves: arranging ? moves.filter((way) => canMove(layout, name, way, shown)) : null,
      onMove: (way: Move) => move(name, way),
    };
    return (
      <PlaceContext key={name} value={value}>
        <Content />
      </PlaceContext>
    );
  };
  return (
    <LivePage>
      <div className="main-column">{layout.main.filter((name) => shown.includes(name)).map(place)}</div>
      <div className="side">{layout.side.filter((name) => shown.includes(name)).map(place)}</div>
    </LivePage>
  );
}
