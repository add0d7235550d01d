import { lazy, Suspense } from "react";
import { AccountPage } from "./panels/account/AccountPage";
import { AuditPage } from "./panels/audit/AuditPage";
import { BenchPanel } from "./panels/bench/BenchPanel";
import { BiopsyPanel } from "./panels/biopsy/BiopsyPanel";
import { CodesPage } from "./panels/codes/CodesPage";
import { CommunicationPanel } from "./panels/communication/CommunicationPanel";
import { Cover } from "./panels/cover/Cover";
import { Header } from "./panels/header/Header";
import { LogPanel } from "./panels/log/LogPanel";
import { LoginPage } from "./panels/login/LoginPage";
import { MotorsPanel } from "./panels/motors/MotorsPanel";
import { NavigationPanel } from "./panels/navigation/NavigationPanel";
import { ProposalsPanel } from "./panels/proposals/ProposalsPanel";
import { StatusPanel } from "./panels/status/StatusPanel";
import { UsersPage } from "./panels/users/UsersPage";
import { WhyPanel } from "./panels/why/WhyPanel";
import { useRoute } from "./state/route";
import { useConsole } from "./state/store";

/** Loaded with the first look at it: drawing takes more code than all the rest. */
const PlotsPage = lazy(() => import("./panels/plots/PlotsPage"));
const ViewPage = lazy(() => import("./panels/view/ViewPage"));

export function App() {
  const loggedIn = useConsole((state) => state.login.phase === "in");
  return (
    <>
      <Header />
      {loggedIn ? <Page /> : <LoginPage />}
    </>
  );
}

function Page() {
  const route = useRoute();
  const admin = useConsole((state) => state.login.phase === "in" && state.login.user.role === "admin");
  if (route === "plots") return <Loaded of={PlotsPage} />;
  if (route === "view") return <Loaded of={ViewPage} />;
  if (route === "codes") return <Sheet of={CodesPage} />;
  if (route === "account") return <Sheet of={AccountPage} />;
  if (route === "users" && admin) return <Sheet of={UsersPage} />;
  if (route === "audit" && admin) return <Sheet of={AuditPage} />;
  return <RobotPage />;
}

function Sheet({ of: Content }: { readonly of: () => React.ReactNode }) {
  return (
    <main className="sheet">
      <Content />
    </main>
  );
}

function Loaded({ of: Content }: { readonly of: React.ComponentType }) {
  return (
    <Suspense fallback={<p className="sheet">The page is being loaded.</p>}>
      <Content />
    </Suspense>
  );
}

function RobotPage() {
  const level = useConsole((state) => state.freshness.level);
  const takesBiopsies = useConsole((state) => state.robot?.modes.includes("cooperative_biopsy") ?? false);
  const simulated = useConsole((state) => state.frame?.simulated ?? false);
  return (
    <div className="stage">
      <main className="panels" data-level={level} inert={level === "covered"}>
        <div className="main-column">
          <MotorsPanel />
          <LogPanel />
          <CommunicationPanel />
          <NavigationPanel />
        </div>
        <div className="side">
          {simulated && <BenchPanel />}
          {takesBiopsies && <BiopsyPanel />}
          <ProposalsPanel />
          <WhyPanel />
          <StatusPanel />
        </div>
      </main>
      <Cover />
    </div>
  );
}
