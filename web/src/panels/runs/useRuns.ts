import { useCallback, useEffect, useMemo, useState } from "react";
import { api, type Outcome, type RunRetention } from "../../api/client";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { type Asked, type Polled, usePolled } from "../../state/usePolled";
import { type Filter, type Known, nothingKnown, queryOf, type WholeRun, withNewest, withOlder } from "./runs";

/** A run goes on for seconds, and the app keeps it every five. */
const EVERY_MS = 2000;

export interface ListedRuns extends Known {
  readonly retention: RunRetention | null;
  readonly asked: Asked;
  readonly notice: Notice | null;
  readonly older: () => Promise<void>;
  readonly refresh: () => Promise<void>;
}

/** The runs that a filter lets through, newest first; the newest of them are asked for again and again. */
export function useRuns(filter: Filter): ListedRuns {
  const ask = useCallback(async () => {
    const answer = await api.runs(queryOf(filter));
    return answer.ok ? { ok: true as const, value: { filter, page: answer.value } } : answer;
  }, [filter]);
  const { value, asked, notice, refresh } = usePolled(ask, EVERY_MS);
  const [known, setKnown] = useState<Known & { readonly filter: Filter }>({ ...nothingKnown, filter });
  const [refusal, setRefusal] = useState<Notice | null>(null);
  useEffect(() => {
    if (value === null) return;
    setKnown((before) => ({
      ...withNewest(before.filter === value.filter ? before : nothingKnown, value.page),
      filter: value.filter,
    }));
  }, [value]);
  const older = async (): Promise<void> => {
    const answer = await api.runs(queryOf(filter, known.runs.at(-1)?.id));
    setRefusal(answer.ok ? null : noticeOfProblem(answer.problem));
    if (!answer.ok) return;
    setKnown((before) =>
      before.filter === filter ? { ...withOlder(before, answer.value), filter } : before,
    );
  };
  return {
    ...known,
    retention: value?.page.retention ?? null,
    asked: known.filter === filter ? asked : { ...asked, answeredAtMs: null },
    notice: refusal ?? notice,
    older,
    refresh,
  };
}

/** Asks for a run, and for its samples only when there are newer ones; the same object as long as nothing changed. */
function asker(id: number | null): () => Promise<Outcome<WholeRun | null>> {
  let last: WholeRun | null = null;
  return async () => {
    if (id === null) return { ok: true, value: null };
    const run = await api.run(id);
    if (!run.ok) return run;
    if (JSON.stringify(last?.run) === JSON.stringify(run.value)) return { ok: true, value: last };
    const samples =
      last?.run.kept === run.value.kept
        ? { ok: true as const, value: last.samples }
        : await api.runSamples(id);
    if (!samples.ok) return samples;
    last = { run: run.value, samples: samples.value };
    return { ok: true, value: last };
  };
}

/** A run as it is kept, followed while it goes on; nothing of no run. */
export function useRun(id: number | null): Polled<WholeRun | null> {
  const ask = useMemo(() => asker(id), [id]);
  return usePolled(ask, EVERY_MS);
}
