/**
 * A foot on the simulated pedal. The app lets the pedal go by itself 500 ms after the last press it heard, so a
 * held pedal is pressed again and again. Presses and the release go out one after the other: a release that
 * overtook a press would leave the pedal down. A renewal that comes too late would be a new press that nobody
 * made, so it is not sent: the foot comes off instead.
 */

/** Sends one press or release; false when it was refused or not heard. */
export type SendPedal = (pressed: boolean) => Promise<boolean>;

export const RENEW_EVERY_MS = 150;
export const RENEW_BEFORE_MS = 400;

export class PedalFoot {
  private down = false;
  private running = false;
  private pressedAtMs = 0;
  private wake: () => void = () => undefined;

  /** `onLapse` is told when the foot comes off without `release`. */
  constructor(
    private readonly send: SendPedal,
    private readonly onLapse: () => void,
  ) {}

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
      await this.hold();
      await this.send(false);
    }
    this.running = false;
  }

  /** Presses and renews until the foot comes off. */
  private async hold(): Promise<void> {
    this.pressedAtMs = performance.now();
    while (this.down) {
      const inTime = performance.now() - this.pressedAtMs < RENEW_BEFORE_MS;
      this.pressedAtMs = performance.now();
      if (!inTime || !(await this.send(true))) this.lapse();
      else if (this.down) await this.renewalOrRelease();
    }
  }

  private lapse(): void {
    this.down = false;
    this.onLapse();
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
