/**
 * A foot on the simulated pedal. The app lets the pedal go by itself 500 ms after the last press it heard, so a
 * held pedal is pressed again and again. Presses and the release go out one after the other: a release that
 * overtook a press would leave the pedal down.
 */
export type SendPedal = (pressed: boolean) => Promise<void>;

export const RENEW_EVERY_MS = 150;

export class PedalFoot {
  private down = false;
  private running = false;
  private wake: () => void = () => undefined;

  constructor(private readonly send: SendPedal) {}

  press(): void {
    this.down = true;
    if (!this.running) void this.run();
  }

  release(): void {
    this.down = false;
    this.wake();
  }

  private async run(): Promise<void> {
    this.running = true;
    while (this.down) {
      await this.send(true);
      if (this.down) await this.renewalOrRelease();
      if (!this.down) await this.send(false);
    }
    this.running = false;
  }

  private renewalOrRelease(): Promise<void> {
    return new Promise((resolve) => {
      const timer = setTimeout(resolve, RENEW_EVERY_MS);
      this.wake = () => {
        clearTimeout(timer);
        resolve();
      };
    });
  }
}
