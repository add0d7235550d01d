/** The numbers of a simulated motor that the bench changes; ranges are the plant's, which refuses what is outside. */

export interface Knob {
  /** In the plant file and in the command. */
  readonly name: string;
  readonly label: string;
}

export const knobs: readonly Knob[] = [
  { name: "dead_zone_fraction", label: "Dead zone, of full drive" },
  { name: "full_speed_counts_per_s", label: "Full speed, counts/s" },
  { name: "lag_ms", label: "Lag, ms" },
  { name: "backlash_counts", label: "Play before the encoder, counts" },
  { name: "tool_play_counts", label: "Play behind the encoder, counts" },
  { name: "load_fraction", label: "Load, of the speed" },
  { name: "heat_droop_fraction", label: "Lost when warm, of the speed" },
  { name: "heat_time_s", label: "Time to warm, s" },
  { name: "resonance_hz", label: "Resonance above the map, Hz" },
  { name: "resonance_drift_hz", label: "Resonance lost when warm, Hz" },
  { name: "noise_counts", label: "Noise, counts" },
  { name: "noise_chance", label: "Noise, chance" },
];

/** What was typed, as far as it is a number. */
export function draftedValues(drafts: Readonly<Record<string, string>>): Record<string, number> {
  const typed = Object.entries(drafts).filter(([, text]) => text.trim() !== "");
  return Object.fromEntries(typed.map(([name, text]) => [name, Number(text)]));
}
