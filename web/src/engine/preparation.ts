const quiet = 1000; // milliseconds without a request: what the page draws first comes first
const longest = 3000; // milliseconds of a warm-up
const most = 3; // warm-ups that were stopped before they were done

/**
 * Uses the time in which nobody asks the engine for anything, so that the first frame of a stroke comes as fast as those that
 * follow: one stroke in the session (`rehearse` of strokes.ts), which makes what is kept for the first one, and then, once,
 * strokes in another worker (warm_up.ts), which end when the user begins something.
 */
export class Preparation {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private worker: Worker | null = null;
  private begun = 0;
  private warm = false;
  private open = false; // a session
  private due = false; // its rehearsal

  /** `rehearse`: false where it could not be done now. */
  constructor(private readonly core: Promise<WebAssembly.Module>, private readonly makeWorker: () => Worker,
    private readonly rehearse: () => Promise<boolean>) {}

  /** Another session has begun. */
  renew(): void {
    this.open = this.due = true;
  }

  /** A request has come, or is done. `works`: it may take long, and should have the processor. */
  interrupt(works: boolean): void {
    if (works) this.end();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.timer = undefined;
      void this.goOn();
    }, quiet);
  }

  private async goOn(): Promise<void> {
    if (this.worker) return;
    if (this.due) {
      this.due = false;
      if (!(await this.rehearse())) this.due = true;
      if (this.timer !== undefined || this.worker) return; // a request has come meanwhile
    }
    if (!this.open || this.warm || this.begun === most) return;
    ++this.begun;
    // Where it fails everything is right, but slow.
    let worker: Worker;
    try {
      worker = this.worker = this.makeWorker();
    } catch {
      this.warmed(null);
      return;
    }
    worker.onmessage = () => this.warmed(worker);
    worker.onerror = (event) => {
      event.preventDefault();
      this.warmed(worker);
    };
    worker.postMessage({ module: await this.core, longest });
  }

  private warmed(worker: Worker | null): void {
    if (this.worker !== worker) return; // one that was ended
    this.end();
    this.warm = true;
    if (this.timer === undefined) void this.goOn();
  }

  private end(): void {
    this.worker?.terminate();
    this.worker = null;
  }
}
