/** Alarms for who does not look at the page: the tab's title, and, where the user wants them, a sound and a notification. */
import type { Alarm } from "../api/client";
import { keep, kept } from "./shelf";
import { type ConsoleState, useConsole } from "./store";

const SOUND = "interlock.alarm.sound";
const NOTICES = "interlock.alarm.notices";
export const PAUSE_MS = 120_000;

/** Bursts after IEC 60601-1-8: when each pulse begins, s, and when the burst comes again. What is low makes no sound. */
const bursts = {
  high: { pulses: [0, 0.2, 0.4, 0.7, 0.9, 1.5, 1.7, 1.9, 2.2, 2.4], everyMs: 8_000 },
  medium: { pulses: [0, 0.3, 0.6], everyMs: 15_000 },
} as const;
const PULSE_S = 0.15;
const PITCH_HZ = 523;

let context: AudioContext | null = null;
let again: ReturnType<typeof setTimeout> | undefined;
let pausedUntilMs = 0;
let announced = "";

export const wantsSound = (): boolean => kept(localStorage, SOUND) === "on";
export const wantsNotices = (): boolean =>
  kept(localStorage, NOTICES) === "on" && Notification.permission === "granted";

/** What the tab is called: the worst alarm that nobody has acknowledged, robot and mode. */
export function titleOf({ alarms, status, glance, login }: ConsoleState): string {
  if (login.phase !== "in" || status === null) return "Interlock";
  const worst = open(alarms);
  const alarm = worst === undefined ? "" : `⚠ ${worst.code} · `;
  return `${alarm}${status.robot} · ${glance?.mode ?? "unknown"} · Interlock`;
}

function open(alarms: readonly Alarm[]): Alarm | undefined {
  return alarms.find(({ acknowledged }) => acknowledged === null);
}

/** Follows the store for as long as the page is there. */
export function announceAlarms(): void {
  useConsole.subscribe((state, before) => {
    const title = titleOf(state);
    if (document.title !== title) document.title = title;
    if (state.alarms !== before.alarms) announce(open(state.alarms));
  });
}

function announce(worst: Alarm | undefined): void {
  const key = worst === undefined ? "" : `${worst.id} ${worst.count} ${worst.axes.length}`;
  if (key === announced) return;
  announced = key;
  sound(worst);
  if (worst !== undefined && worst.priority !== "low" && document.hidden && wantsNotices()) {
    new Notification(worst.code, { body: `${worst.text} ${worst.next_step}`, tag: "interlock" });
  }
}

function sound(worst: Alarm | undefined): void {
  clearTimeout(again);
  if (worst === undefined || worst.priority === "low" || context === null || !wantsSound()) return;
  const { pulses, everyMs } = bursts[worst.priority];
  if (performance.now() >= pausedUntilMs) for (const begin of pulses) pulse(context, begin);
  again = setTimeout(() => sound(open(useConsole.getState().alarms)), everyMs);
}

function pulse(audio: AudioContext, begin: number): void {
  const tone = audio.createOscillator();
  const volume = audio.createGain();
  const at = audio.currentTime + begin;
  tone.type = "triangle";
  tone.frequency.value = PITCH_HZ;
  volume.gain.setValueAtTime(0, at);
  volume.gain.linearRampToValueAtTime(0.4, at + 0.02);
  volume.gain.setValueAtTime(0.4, at + PULSE_S - 0.02);
  volume.gain.linearRampToValueAtTime(0, at + PULSE_S);
  tone.connect(volume).connect(audio.destination);
  tone.start(at);
  tone.stop(at + PULSE_S);
}

/** Sound on or off on this computer. A browser plays none before somebody has pressed something on the page. */
export function setSound(on: boolean): void {
  keep(localStorage, SOUND, on ? "on" : "off");
  if (on) allowSound();
  sound(open(useConsole.getState().alarms));
}

/** To be called when somebody presses something: before that, a browser plays nothing on a page that was loaded anew. */
export function allowSound(): void {
  if (!wantsSound()) return;
  context ??= new AudioContext();
  void context.resume();
}

/** No sound for two minutes; what is shown stays. */
export function pauseSound(): void {
  pausedUntilMs = performance.now() + PAUSE_MS;
}

/** Notifications of the computer while the page is hidden; false when the browser does not let them. */
export async function setNotices(on: boolean): Promise<boolean> {
  const granted = on && (await Notification.requestPermission()) === "granted";
  keep(localStorage, NOTICES, granted ? "on" : "off");
  return granted === on;
}
