import { lazy, Suspense } from "react";
import { AccountPage } from "./panels/account/AccountPage";
import { AuditPage } from "./panels/audit/AuditPage";
import { CodesPage } from "./panels/codes/CodesPage";
import { Header } from "./panels/header/Header";
import { Navigation } from "./panels/header/Navigation";
import { LoginPage } from "./panels/login/LoginPage";
import { RobotPage } from "./panels/robot/RobotPage";
import { UsersPage } from "./panels/users/UsersPage";
import { useRoute } from "./state/route";
import { useConsole } from "./state/store";

/** Loaded with the first look at them: drawing takes more code than all the rest. */
const PlotsPage = lazy(() => import("./panels/plots/PlotsPage"));
const ProposalsPage = lazy(() => import("./panels/proposals/ProposalsPage"));
const RunsPage = lazy(() => import("./panels/runs/RunsPage"));
const TuningPage = lazy(() => import("./panels/tuning/TuningPage"));
const ViewPage = lazy(() => import("./panels/view/ViewPage"));
const TargetingPage = lazy(() => import("./panels/targeting/TargetingPage"));
const WorkflowPage = lazy(() => import("./panels/workflow/WorkflowPage"));

export function App() {
  const loggedIn = useConsole((state) => state.login.phase === "in");
  return (
    <>
      <Header />
      <div className="frame">
        <Navigation />
        {loggedIn ? <Page /> : <LoginPage />}
      </div>
    </>
  );
}

function Page() {
  const route = useRoute();
  const user = useConsole((state) => (state.login.phase === "in" ? state.login.user : null));
  const admin = user?.role === "admin";
  if (route === "workflow") return <Loaded of={WorkflowPage} />;
  if (route === "targeting") return <Loaded of={TargetingPage} />;
  if (route === "proposals") return <Loaded of={ProposalsPage} />;
  if (route === "runs") return <Loaded of={RunsPage} />;
  if (route === "plots") return <Loaded of={PlotsPage} />;
  if (route === "tuning") return <Loaded of={TuningPage} />;
  if (route === "view") return <Loaded of={ViewPage} />;
  if (route === "codes") return <Sheet of={CodesPage} />;
  if (route === "account") return <Sheet of={AccountPage} />;
  if (route === "users" && admin) return <Sheet of={UsersPage} />;
  if (route === "audit" && admin) return <Sheet of={AuditPage} />;
  return user === null ? null : <RobotPage user={user.name} />;
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
