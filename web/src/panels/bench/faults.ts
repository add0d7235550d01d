import type { PlantStatus } from "./benchStatus";

/** Sends a command of models/plant/README.md, and asks the plant how it stands then. */
export type SendBench = (command: string, fields: Record<string, unknown>) => Promise<void>;

export interface FaultsProps {
  readonly plant: PlantStatus;
  readonly send: SendBench;
}
