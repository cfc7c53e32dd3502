import { selected } from '../engine/session_state';
import { modes } from '../tools/modes';
import type { Side } from '../view/directions';
import type { App } from './app';
import { toggleShortcuts } from './chrome';
import { openLab } from './lab/door';
import { toggleSection } from './section';
import { snakesAreOpen } from './snakes/door';
import { look, toggleParallel, toggleTurntable } from './views';

export function listenToKeys(app: App): void {
  document.addEventListener('keyup', (event) => {
    if (event.key.toLowerCase() === 'c') app.compare(false);
  });
  window.addEventListener('blur', () => app.compare(false));
  document.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (target.closest('input[type=text], textarea') || snakesAreOpen()) return;
    if (handle(app, event)) event.preventDefault();
  });
}

/** True if the key was handled. */
function handle(app: App, event: KeyboardEvent): boolean {
  const key = event.key.toLowerCase();
  const viewport = app.viewer.main;
  if (event.ctrlKey || event.metaKey) {
    if (key === 'z' || key === 'y') {
      const again = key === 'y' || event.shiftKey;
      if (!app.playing() && !app.hand.active && (again ? app.state?.redo : app.state?.undo)) void app.execute([{ do: again ? 'redo' : 'undo' }]);
      return true;
    }
    if (key === 's') void app.saving.cad();
    return key === 's';
  }
  if (key === 'escape') {
    app.viewer.turntable.on = false;
    if (app.hand.active) void app.hand.pointers.cancel();
    else if (document.querySelector('.shortcuts')) toggleShortcuts(app);
    else if (app.viewer.tools.selected) {
      app.viewer.selectTool(null);
      app.changed();
    } else if (app.hand.measure.forget()) app.changed();
    else if (app.viewer.section.on) toggleSection(app);
    return true;
  }
  if (event.key === '?') {
    toggleShortcuts(app);
    return true;
  }
  if (app.hand.points.active) {
    const lock = ({ x: 'x', y: 'y', z: 'z', n: 'normal' } as const)[key];
    if (lock) app.hand.points.setLock(lock);
    return true; // nothing else while points are being dragged
  }
  const mode = modes.find(([, , k]) => k === key);
  if (mode && !event.altKey) {
    app.hand.choose(mode[0]);
    return true;
  }
  const ready = app.state !== null && selected(app.state).length > 0;
  const gizmo = (kind: 'translate' | 'rotate' | 'scale') => {
    for (const v of app.viewer.viewports) v.gizmo.setMode(kind);
    app.changed();
  };
  // Digits by their position on the keyboard, so that Shift does not change them.
  const view = { Digit1: ['front', 'back'], Digit2: ['right', 'left'], Digit3: ['top', 'bottom'] }[event.code];
  if (view) look(app, view[event.shiftKey ? 1 : 0] as Side);
  else if (event.code === 'Digit0') {
    look(app, 'perspective');
    app.viewer.fitAll();
  }
  else if (event.code === 'Digit6') look(app, 'isometric');
  else if (event.code === 'Digit7') toggleParallel(app);
  else if (event.code === 'Digit8') toggleTurntable(app);
  else if (event.code === 'Digit5') app.setDisplay({ view: viewport.axial ? 'perspective' : 'top', fourViews: false });
  else if (event.code === 'Digit4') app.setDisplay({ fourViews: !app.display.fourViews });
  else if (key === ' ' && ready) {
    if (event.target instanceof HTMLButtonElement) return false;
    app.togglePlay();
  } else if (key === '.' && ready && !app.playing()) void app.execute([{ do: 'step' }]);
  else if (key === 'r' && ready) app.togglePlay(true);
  else if (key === 'f') event.shiftKey ? app.viewer.fitAll() : app.viewer.fitSelected();
  else if (key === 'c') app.compare(true);
  else if (key === 'o') document.querySelector<HTMLElement>('.top [aria-label^="Open"]')?.click();
  else if (key === 'x') toggleSection(app);
  else if (key === 'z') app.setDisplay({ stripes: app.display.stripes === 'zebra' ? 'none' : 'zebra' });
  else if (key === 'l') void openLab(app);
  else if (key === 'm') gizmo('translate');
  else if (key === 'n') gizmo('rotate');
  else if (key === 'k') gizmo('scale');
  else if (key === '[' || key === ']') {
    app.hand.brush.settings.radius *= key === ']' ? 1.15 : 1 / 1.15;
    app.changed();
  } else if ((key === 'delete' || key === 'backspace') && app.viewer.tools.selected) {
    void app.execute([{ do: 'remove', tool: app.viewer.tools.selected }]);
  } else return false;
  return true;
}
