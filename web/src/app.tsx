import { useEffect } from "react";
import { AxesPanel } from "./panels/axes/AxesPanel";
import { BenchPanel } from "./panels/bench/BenchPanel";
import { Cover } from "./panels/cover/Cover";
import { Header } from "./panels/header/Header";
import { ProposalsPanel } from "./panels/proposals/ProposalsPanel";
import { startSession } from "./state/session";
import { useConsole } from "./state/store";

export function App() {
  useEffect(startSession, []);
  const level = useConsole((state) => state.freshness.level);
  const simulated = useConsole((state) => state.frame?.simulated ?? false);
  return (
    <>
      <Header />
      <div className="stage">
        <main className="panels" data-level={level} inert={level === "covered"}>
          <AxesPanel />
          <div className="side">
            {simulated && <BenchPanel />}
            <ProposalsPanel />
          </div>
        </main>
        <Cover />
      </div>
    </>
  );
}
