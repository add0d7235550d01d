import type { Alarm } from "../../api/client";
import { AlarmSign } from "../../design/AlarmSign";
import { CodeLink } from "../../design/CodeLink";
import { familyOf } from "../../state/alarms";

export const signs: Readonly<Record<Alarm["priority"], string>> = { high: "⬣", medium: "▲", low: "●" };

/** Sign, code, text and next step; the code leads to its place in the catalog where it has one. */
export function AlarmWords({ alarm }: { readonly alarm: Alarm }) {
  const family = familyOf(alarm.code);
  return (
    <>
      <AlarmSign priority={alarm.acknowledged === null ? alarm.priority : null}>
        {signs[alarm.priority]}
      </AlarmSign>{" "}
      <strong>{family === null ? alarm.code : <CodeLink family={family} code={alarm.code} />}</strong>{" "}
      {alarm.text} <span className="next-step">{alarm.next_step}</span>
    </>
  );
}
