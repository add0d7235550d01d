import { Fragment, type ReactNode, useEffect, useRef, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { api } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { Refusal } from "../../design/Refusal";
import { isOpen } from "../../state/proposals";
import { type ConsoleState, useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { Pedal } from "../bench/BenchPanel";
import { BiopsyPanel } from "../biopsy/BiopsyPanel";
import { LivePage } from "../cover/LivePage";
import { MotionPanel } from "../proposals/MotionPanel";
import { ProposalDetail } from "../proposals/ProposalDetail";
import { AimPanel } from "../targeting/AimPanel";
import { AlignmentPanel } from "../targeting/AlignmentPanel";
import { PosesPanel } from "../targeting/PosesPanel";
import { RegistrationPanel } from "../targeting/RegistrationPanel";
import { useTargeting } from "../targeting/useTargeting";
import { StepLine } from "./StepLine";
import {
  type AxisNow,
  heldTicks,
  oldest,
  type Situation,
  type StepName,
  stepsOf,
  type TickName,
  type Ticks,
  tickOf,
} from "./workflow";
import "../proposals/proposals.css";
import "../proposals/detail.css";
import "../targeting/targeting.css";
import "./workflow.css";

const IMAGER_EVERY_MS = 1000;

/** From opening a case to closing it: each step, whether it is done, and what it waits for, beside the panel that does it. */
export default function WorkflowPage() {
  return (
    <LivePage className="workflow-page">
      <Content />
    </LivePage>
  );
}

const FIELDS_OF_AXIS = 5;

function axisFields({ motors, frame }: ConsoleState): unknown[] {
  return motors.flatMap(({ slot }) => {
    const axis = frame?.axes[slot];
    return [axis?.state, axis?.homed, axis?.homedByHand, axis?.positionCounts, axis?.minCounts];
  });
}

/** What the steps need of the axes; anew when some of that changes, not with every frame. */
function useAxes(): AxisNow[] {
  const fields = useConsole(useShallow(axisFields));
  return Array.from({ length: fields.length / FIELDS_OF_AXIS }, (_, at) => {
    const [state, homed, homedByHand, positionCounts, minCounts] = fields.slice(FIELDS_OF_AXIS * at);
    return { state, homed, homedByHand, positionCounts, minCounts } as AxisNow;
  });
}

type PanelOfStep = "registration" | "aim" | "alignment" | "poses" | "motion" | "biopsy";

function panelOf(step: StepName, modes: readonly string[]): PanelOfStep | null {
  const takesBiopsies = modes.includes("cooperative_biopsy");
  switch (step) {
    case "register":
      return "registration";
    case "target":
      return "aim";
    case "review":
    case "align":
      return "alignment";
    case "confirm":
      return "poses";
    case "insert":
      return takesBiopsies ? "biopsy" : "alignment";
    case "treat":
      return takesBiopsies ? "biopsy" : modes.includes("ablation") ? "motion" : null;
    default:
      return null;
  }
}

/** Their forms keep what is typed, whatever step is next meanwhile. */
const forms: ReadonlySet<StepName> = new Set(["register", "target"]);

function Content() {
  const robot = useConsole((state) => state.robot);
  const motors = useConsole((state) => state.motors);
  const mode = useConsole((state) => state.glance?.mode ?? "UNKNOWN");
  const proposals = useConsole((state) => state.proposals);
  const refusal = useConsole((state) => state.notices.robot);
  const axes = useAxes();
  const { cases, targeting, view, history, notice, off, refresh } = useTargeting();
  const imager = usePolled(api.imager, IMAGER_EVERY_MS);
  const [ticks, setTicks] = useState<Ticks>({ confirm: null, treat: null });
  const [chosen, setChosen] = useState<StepName | null>(null);
  const work = useRef<HTMLElement>(null);

  const isKnown = robot !== null && cases.value !== null && targeting.value !== null && view.value !== null;
  const situation: Situation | null = isKnown
    ? {
        ...{ robot, motors, axes, mode, proposals, imager: imager.value },
        ...{ cases: cases.value, targeting: targeting.value, view: view.value },
        ticks:
          motors.length === 0
            ? ticks
            : heldTicks(ticks, motors, tickOf({ axes, targeting: targeting.value })),
      }
    : null;
  const steps = situation === null ? [] : stepsOf(situation);
  const now = steps.find(({ state }) => state === "now")?.name ?? null;

  // What no longer holds does not come back by itself.
  useEffect(() => {
    if (situation !== null && situation.ticks !== ticks) setTicks(situation.ticks);
  });
  useEffect(() => {
    if (now !== null) setChosen((known) => (known !== null && forms.has(known) ? known : null));
  }, [now]);

  const onSet = async (): Promise<void> => {
    setChosen(null);
    await refresh();
  };
  const goTo = (step: StepName): void => {
    setChosen(step);
    work.current?.focus();
    work.current?.scrollIntoView({ block: "start" });
  };
  const onTick = (name: TickName, ticked: boolean): void => {
    if (situation !== null) setTicks({ ...ticks, [name]: ticked ? tickOf(situation) : null });
  };

  const running = proposals.find(isOpen);
  const shownStep = chosen ?? now;
  const shown = shownStep === null || robot === null ? null : panelOf(shownStep, robot.modes);
  const form = { history: history.value, asked: targeting.asked, off, onSet };
  const asked = oldest([cases.asked, targeting.asked, view.asked]);
  return (
    <>
      <div className="main-column">
        {notice !== null && (
          <p className="panel-notice page-notice" role="alert">
            <NoticeText lead="No newer values:" notice={notice} />
          </p>
        )}
        <Panel title="Workflow" className="workflow" {...(asked === undefined ? {} : { asked })}>
          {refusal !== undefined && (
            <Refusal place="robot" notice={refusal} dismissLabel="Dismiss the refusal of the robot" />
          )}
          {situation === null ? (
            <p className="workflow-words">The state of the case is not known yet.</p>
          ) : (
            <>
              <p role="status" className="visually-hidden">
                {now !== null && `Now: ${steps.find(({ name }) => name === now)?.title}`}
              </p>
              <ol className="steps" aria-label="Steps">
                {steps.map((step) => (
                  <StepLine
                    key={step.name}
                    step={step}
                    situation={situation}
                    onGoTo={() => goTo(step.name)}
                    onTick={onTick}
                    onChanged={refresh}
                  />
                ))}
              </ol>
            </>
          )}
        </Panel>
      </div>
      <section ref={work} tabIndex={-1} className="main-column targeting-page" aria-label="Work">
        <SimulatedPedal />
        {running !== undefined && <ProposalDetail key={`proposal ${running.id}`} proposal={running} />}
        {targeting.value !== null && (
          // What was edited in one case must not reach another.
          <Fragment key={`case ${targeting.value.case}`}>
            <Form isShown={shown === "registration"} onEdit={() => setChosen("register")}>
              <RegistrationPanel targeting={targeting.value} {...form} />
            </Form>
            <Form isShown={shown === "aim"} onEdit={() => setChosen("target")}>
              <AimPanel targeting={targeting.value} {...form} />
            </Form>
          </Fragment>
        )}
        {shown === "alignment" && running === undefined && (
          <AlignmentPanel view={view.value} asked={view.asked} retracts={false} />
        )}
        {shown === "poses" && (
          <PosesPanel
            view={view.value}
            reported={targeting.value?.reported_position ?? null}
            history={history.value}
            asked={view.asked}
          />
        )}
        {shown === "motion" && <MotionPanel only="ablation" />}
        {shown === "biopsy" && <BiopsyPanel />}
      </section>
    </>
  );
}

interface FormProps {
  readonly isShown: boolean;
  readonly onEdit: () => void;
  readonly children: ReactNode;
}

/** Stays on the page while another step is shown, with what is typed in it. */
function Form({ isShown, onEdit, children }: FormProps) {
  return (
    <div hidden={!isShown} onInput={onEdit}>
      {children}
    </div>
  );
}

/** On the page, as whoever leaves the page lifts the foot. */
function SimulatedPedal() {
  const isThere = useConsole(({ frame }) => frame?.simulated === true && !frame.replay);
  const refusal = useConsole((state) => state.benchRefusal);
  if (!isThere) return null;
  return (
    <Panel title="Simulated pedal" className="bench-panel">
      <Pedal />
      {refusal?.command === "pedal" && (
        <p className="bench-notice" role="alert">
          <NoticeText lead="Refused pedal:" notice={refusal.notice} />
        </p>
      )}
    </Panel>
  );
}
