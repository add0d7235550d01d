/**
 * A foot on the simulated pedal. The app lets the pedal go by itself 500 ms after the last press or renewal it
 * heard, so a held pedal is renewed again and again. What the foot does goes out one after the other: a release
 * that overtook a renewal would be undone by it. The app refuses a renewal that comes too late; then the foot comes
 * off, since pressing anew would be a consent that nobody gave.
 */

export type Footwork = "press" | "renew" | "release";

/** Sends what the foot does; false when it was refused or not heard. */
export type SendFootwork = (footwork: Footwork) => Promise<boolean>;

export const RENEW_EVERY_MS = 150;

export class PedalFoot {
  private down = false;
  private running = false;
  private wake: () => void = () => undefined;

  /** `onLapse` is told when the foot comes off without `release`. */
  constructor(
    private readonly send: SendFootwork,
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
      await this.send("release");
    }
    this.running = false;
  }

  /** Presses, and renews until the foot comes off. */
  private async hold(): Promise<void> {
    let heard = await this.send("press");
    while (heard && this.down) {
      await this.renewalOrRelease();
      if (this.down) heard = await this.send("renew");
    }
    if (heard) return;
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
