import type { App } from './app';
import { h, iconButton } from './dom';

/** The tour for a first visit: a card in the corner of the stage that advances by itself when its step has been done. */

interface Step {
  title: string;
  text: string;
  /** What the card refers to, outlined meanwhile. */
  target?: string;
  enter?(app: App): void;
  /** True as soon as the user has done it; compared with the state when the step began. */
  done?(app: App, before: Mark): boolean;
}

/** What a step may inspect to tell whether something has happened since it began. */
interface Mark {
  steps: number;
  redo: boolean;
  tools: number;
  alpha: string;
  stripes: string;
  camera: string;
}

const steps: Step[] = [
  {
    title: 'Exact clay',
    text: 'This sheet is a B-spline surface, the kind that CAD works with. It is never turned into a mesh: what you sculpt is what you save. Everything stays on your machine.',
  },
  {
    title: 'Press',
    text: 'Drag across the sheet to push a ball into it. With Alt it pulls. Shift-wheel changes the size of the ball, Esc cancels a stroke while you draw it.',
    target: '.rail [aria-label^="Push"]',
    enter: (app) => app.hand.choose('push'),
    done: (app, before) => !app.hand.brush.active && (app.state?.steps ?? 0) > before.steps,
  },
  {
    title: 'Take it back',
    text: 'Ctrl+Z undoes the whole stroke, Ctrl+Shift+Z does it again. The History panel lists every command; saved as a script, they run on the command line too.',
    target: '.top [aria-label^="Undo"]',
    done: (app, before) => !before.redo && app.state?.redo === true,
  },
  {
    title: 'Look around',
    text: 'Drag beside the surface or with the right button to orbit, with the middle button to pan; the wheel zooms. Fingers and other mouse habits: see Display. F fits everything, 4 shows four views.',
    target: '.top [aria-label^="Four"]',
    done: (app, before) => camera(app) !== before.camera,
  },
  {
    title: 'Place a tool',
    text: 'Click the sheet to put a tool there, then drag its arrows and press Space: the clay gives way step by step until you pause. Shape, size and stiffness are in the Tools panel.',
    target: '[data-panel="Tools"]',
    enter: (app) => app.hand.choose('place'),
    done: (app, before) => (app.state?.tools.length ?? 0) > before.tools,
  },
  {
    title: 'Choose a material',
    text: 'Sheet metal resists bending, cloth hardly does, clay gives way only where it is pressed. Choose one and press again.',
    target: '[data-panel="Material"]',
    done: (app, before) => material(app) !== before.alpha,
  },
  {
    title: 'Judge the surface',
    text: 'Zebra stripes (Z) break where tangents jump and kink where curvature does. Colours show curvature or how far the surface has moved; hold C to see it as it was.',
    target: '[data-panel="Display"]',
    done: (app, before) => app.display.stripes !== before.stripes,
  },
  {
    title: 'Your own files',
    text: 'Drop a file anywhere on this page. Click the surface to sculpt, and save: the file that comes out is the file that went in, with that surface changed and nothing else. ? lists all keys.',
    target: '.top [aria-label^="Open"]',
    enter: (app) => app.hand.choose('look'),
  },
];

const seenKey = 'knead-tour';
const camera = (app: App) => JSON.stringify(app.viewer.viewports[0]!.camera.position.toArray());
const material = (app: App) => JSON.stringify(app.state?.surfaces.map((s) => [s.alpha, s.beta]));

function mark(app: App): Mark {
  return {
    steps: app.state?.steps ?? 0, redo: app.state?.redo === true, tools: app.state?.tools.length ?? 0, alpha: material(app),
    stripes: app.display.stripes, camera: camera(app),
  };
}

let end: (() => void) | null = null;

/** Starts the tour, or ends it if it is running. */
export function toggleTour(app: App): void {
  if (end) end();
  else begin(app);
}

/** Offers the tour on the first visit. */
export function offerTour(app: App): void {
  if (seen()) return;
  remember();
  begin(app);
}

function begin(app: App): void {
  const title = h('h2', {});
  const text = h('p', {});
  const count = h('small', {});
  const back = h('button', { class: 'button small', type: 'button', onclick: () => show(current - 1) }, 'Back');
  const next = h('button', { class: 'button small', type: 'button', onclick: () => show(current + 1) });
  const card = h('section', { class: 'tour', aria: { label: 'Guided tour', live: 'polite' } },
    h('header', {}, title, iconButton('close', 'End the tour', () => close())), text,
    h('footer', {}, count, h('span', { class: 'spacer' }), back, next));
  let current = 0;
  let before = mark(app);

  const outline = (selector?: string) => {
    document.querySelector('.tour-target')?.classList.remove('tour-target');
    if (selector) document.querySelector(selector)?.classList.add('tour-target');
  };
  const show = (k: number) => {
    if (k >= steps.length) {
      close();
      return;
    }
    current = k;
    const step = steps[k]!;
    step.enter?.(app);
    before = mark(app);
    title.textContent = step.title;
    text.textContent = step.text;
    count.textContent = `${k + 1} of ${steps.length}`;
    back.disabled = k === 0;
    next.textContent = k === 0 ? 'Show me' : k + 1 === steps.length ? 'Done' : 'Next';
    card.classList.remove('done');
    outline(step.target);
  };
  // A completed step says so, and the tour advances once there was time to see what happened.
  const watch = () => {
    if (card.classList.contains('done') || !steps[current]!.done?.(app, before)) return;
    card.classList.add('done');
    next.textContent = 'Next';
    const at = current;
    setTimeout(() => {
      if (end && current === at && card.classList.contains('done')) show(at + 1);
    }, 1600);
  };
  const timer = setInterval(watch, 300); // cameras move without changing the session
  const close = () => {
    clearInterval(timer);
    outline();
    card.remove();
    end = null;
  };
  end = close;
  app.viewer.element.append(card);
  show(0);
}

/** If the page may not store anything, every visit counts as a later one. */
function seen(): boolean {
  try {
    return localStorage.getItem(seenKey) !== null;
  } catch {
    return true;
  }
}

function remember(): void {
  try {
    localStorage.setItem(seenKey, '1');
  } catch {
    // It will be offered again.
  }
}
