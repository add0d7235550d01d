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
  { name: "backlash_counts", label: "Backlash, counts" },
  { name: "noise_counts", label: "Noise, counts" },
  { name: "noise_chance", label: "Noise, chance" },
];

/** What was typed, as far as it is a number. */
export function draftedValues(drafts: Readonly<Record<string, string>>): Record<string, number> {
  const typed = Object.entries(drafts).filter(([, text]) => text.trim() !== "");
  return Object.fromEntries(typed.map(([name, text]) => [name, Number(text)]));
}
