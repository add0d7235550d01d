/** Times of the app, which are UTC, in the zone of the one who reads. */
const clock = new Intl.DateTimeFormat(undefined, { timeStyle: "long" });
const calendar = new Intl.DateTimeFormat(undefined, { dateStyle: "medium", timeStyle: "long" });

/** Time of day with its zone; what the app sent when it is no time. */
export function localTime(utc: string): string {
  return shown(clock, utc);
}

/** Day and time with its zone; what the app sent when it is no time. */
export function localDate(utc: string): string {
  return shown(calendar, utc);
}

function shown(format: Intl.DateTimeFormat, utc: string): string {
  const time = new Date(utc);
  return Number.isNaN(time.getTime()) ? utc : format.format(time);
}
