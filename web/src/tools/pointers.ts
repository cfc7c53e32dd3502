import type { Navigator } from '../view/navigator';
import type { Viewport } from '../view/viewport';

/** What the pointer does in one of the modes. Only one mode is active at a time. */
export interface PointerTool {
  readonly active: boolean;
  /** A press of the main button; false leaves it to the view. */
  press(viewport: Viewport, event: PointerEvent): boolean;
  drag(event: PointerEvent): void;
  release(event: PointerEvent): void;
  /** As if the act had never begun. */
  cancel(): Promise<void>;
  /** The pointer moves without a button, or, without a viewport, has left. */
  hover?(viewport: Viewport | null, event?: PointerEvent): void;
  /** Pressed and released in one place, and not handled by anything else; false if there is nothing for it. */
  click?(viewport: Viewport, event: PointerEvent): boolean;
  doubleClick?(viewport: Viewport, event: MouseEvent): void;
  /** True if it handles the wheel. */
  wheel?(event: WheelEvent): boolean;
}

/** Gives each press to the tool of the mode, to the gizmo of a tool, or to the view. */
export class Pointers {
  private busy: PointerTool | null = null;
  private pressed: { x: number; y: number; moved: boolean } | null = null;
  private readonly fingers = new Map<number, { clientX: number; clientY: number }>();

  constructor(viewports: readonly Viewport[], private readonly navigator: Navigator, private readonly tool: () => PointerTool,
    /** A click that the tool has nothing for. */
    private readonly clicked: (viewport: Viewport, event: PointerEvent) => void,
    /** A press that the tool takes. */
    private readonly taken: () => void,
    /** Before a press or a click of the tool. */
    private readonly reached: (viewport: Viewport, event: PointerEvent) => void) {
    for (const viewport of viewports) this.listen(viewport);
  }

  private listen(viewport: Viewport): void {
    const { element } = viewport;
    const first = { capture: true }; // before the gizmo sees it
    element.addEventListener('pointerdown', (e) => this.down(viewport, e), first);
    element.addEventListener('pointermove', (e) => this.move(viewport, e), first);
    element.addEventListener('pointerup', (e) => this.up(viewport, e), first);
    element.addEventListener('pointercancel', (e) => this.lost(viewport, e), first);
    // Only now does the gizmo know whether a finger is on it; the view takes only what it leaves.
    element.addEventListener('pointerdown', (e) => this.downAfterGizmo(viewport, e));
    element.addEventListener('pointerleave', () => this.tool().hover?.(null));
    element.addEventListener('wheel', (e) => this.wheel(viewport, e), { capture: true, passive: false });
    element.addEventListener('contextmenu', (e) => e.preventDefault());
    element.addEventListener('dblclick', (e) => {
      if (e.target === element) this.tool().doubleClick?.(viewport, e);
    });
  }

  private down(viewport: Viewport, event: PointerEvent): void {
    if (event.target !== viewport.element) {
      event.stopImmediatePropagation(); // a label: the gizmo would take its pointer away
      return;
    }
    if (event.pointerType === 'touch') {
      this.fingers.set(event.pointerId, { clientX: event.clientX, clientY: event.clientY });
      if (this.fingers.size > 1) {
        event.stopImmediatePropagation();
        void this.busy?.cancel(); // the second finger: the gesture was meant to move the view
        this.busy = null;
        this.pressed = null;
        viewport.element.setPointerCapture(event.pointerId);
        this.navigator.touched(viewport, this.fingers);
        return;
      }
    }
    if (this.busy) {
      event.stopImmediatePropagation();
      return;
    }
    this.pressed = { x: event.clientX, y: event.clientY, moved: false };
    if (event.button !== 0 || this.onGizmo(viewport)) return;
    const tool = this.tool();
    this.reached(viewport, event);
    if (!tool.press(viewport, event)) return;
    this.taken();
    this.busy = tool;
    viewport.element.setPointerCapture(event.pointerId);
    viewport.element.focus({ preventScroll: true });
    event.stopImmediatePropagation();
    event.preventDefault();
  }

  private downAfterGizmo(viewport: Viewport, event: PointerEvent): void {
    if (event.target !== viewport.element || this.busy || viewport.gizmo.dragging) return;
    viewport.element.focus({ preventScroll: true });
    if (this.navigator.press(viewport, event)) event.preventDefault();
  }

  private onGizmo(viewport: Viewport): boolean {
    return viewport.gizmo.axis !== null && viewport.gizmo.object !== undefined;
  }

  private move(viewport: Viewport, event: PointerEvent): void {
    const { pressed } = this;
    if (pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > 4) pressed.moved = true;
    if (this.fingers.has(event.pointerId)) {
      this.fingers.set(event.pointerId, { clientX: event.clientX, clientY: event.clientY });
      if (this.fingers.size > 1) {
        event.stopImmediatePropagation();
        this.navigator.touched(viewport, this.fingers);
        return;
      }
    }
    if (this.busy) {
      event.stopImmediatePropagation();
      this.busy.drag(event);
    } else if (this.navigator.active) this.navigator.move(event);
    else if (event.buttons === 0) this.tool().hover?.(this.onGizmo(viewport) ? null : viewport, event);
  }

  private up(viewport: Viewport, event: PointerEvent): void {
    const { pressed, busy } = this;
    const several = this.fingers.size > 1;
    this.fingers.delete(event.pointerId);
    if (several) {
      event.stopImmediatePropagation();
      this.navigator.touched(viewport, this.fingers);
      return;
    }
    if (busy) {
      event.stopImmediatePropagation();
      this.free(viewport, event);
      busy.release(event);
      return;
    }
    this.navigator.release(event);
    this.pressed = null;
    if (event.button === 0 && pressed && !pressed.moved && event.target === viewport.element && !this.onGizmo(viewport)) {
      if (!this.tool().click?.(viewport, event)) this.clicked(viewport, event);
    }
  }

  private free(viewport: Viewport, event: PointerEvent): void {
    this.busy = null;
    this.pressed = null;
    if (viewport.element.hasPointerCapture(event.pointerId)) viewport.element.releasePointerCapture(event.pointerId);
  }

  private lost(viewport: Viewport, event: PointerEvent): void {
    this.fingers.delete(event.pointerId);
    void this.busy?.cancel();
    this.navigator.cancel();
    this.free(viewport, event);
  }

  /** Esc. False if there was nothing to revert. */
  async cancel(): Promise<boolean> {
    const { busy } = this;
    this.busy = null;
    this.pressed = null;
    if (!busy?.active) return false;
    await busy.cancel();
    return true;
  }

  private wheel(viewport: Viewport, event: WheelEvent): void {
    if (this.tool().wheel?.(event)) event.preventDefault();
    else this.navigator.wheel(viewport, event);
  }
}
