/**
 * Something that is held over the network: the simulated pedal, a jog. The app lets it go by itself soon after the last
 * press or renewal that it heard, so it is renewed again and again. What is done goes out one after the other: a release
 * that overtook a renewal would be undone by it. The app refuses a renewal that comes too late; then it is let go, since
 * pressing anew would be a consent that nobody gave.
 */

export type HoldStep = "press" | "renew" | "release";

/** Sends what is done; false when it was refused or not heard. */
export type SendStep = (step: HoldStep) => Promise<boolean>;

export class Hold {
  private down = false;
  private running = false;
  private wake: () => void = () => undefined;

  /** `onLapse` is told when it ends without `release`. */
  constructor(
    private readonly send: SendStep,
    private readonly onLapse: () => void,
    private readonly renewEveryMs: number,
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

  /** Presses, and renews until it is let go. */
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
      const timer = setTimeout(resolve, this.renewEveryMs);
      this.wake = () => {
        clearTimeout(timer);
        resolve();
      };
    });
  }
}
