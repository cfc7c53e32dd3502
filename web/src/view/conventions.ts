/** What the mouse does to a view, as in well-known programs. A brush or a tool under the pointer comes first. */

export type Motion = 'orbit' | 'pan' | 'zoom';
export const conventions = ['knead', 'blender', 'rhino', 'fusion'] as const;
export type Convention = (typeof conventions)[number];

export interface Press {
  button: number;
  shiftKey: boolean;
  ctrlKey: boolean;
  altKey: boolean;
}

export const conventionNames: readonly (readonly [Convention, string])[] = [
  ['knead', 'Knead'], ['blender', 'Blender'], ['rhino', 'Rhino'], ['fusion', 'Fusion'],
];

/** In words, for the panel and the list of shortcuts: orbit, pan, zoom. */
export const conventionText: Record<Convention, [string, string, string]> = {
  knead: ['right drag; left drag beside the surface', 'middle drag, Shift + right drag', 'wheel, Ctrl + right drag'],
  blender: ['middle drag, Alt + left drag', 'Shift + middle drag', 'wheel, Ctrl + middle drag'],
  rhino: ['right drag, Alt + left drag', 'Shift + right drag', 'wheel, Ctrl + right drag'],
  fusion: ['Shift + middle drag, Alt + left drag', 'middle drag', 'wheel, Ctrl + middle drag'],
};

const [left, middle, right] = [0, 1, 2];

/** Null if the press means nothing to the view. A view along an axis pans where others orbit. */
export function motionOf(convention: Convention, press: Press, axial: boolean): Motion | null {
  const turns: Motion = axial ? 'pan' : 'orbit';
  if (press.button === left) return convention === 'knead' || press.altKey ? turns : null;
  switch (convention) {
    case 'knead':
      if (press.button === middle) return 'pan';
      return press.button === right ? withModifiers(press, turns, 'pan') : null;
    case 'blender':
      return press.button === middle ? withModifiers(press, turns, 'pan') : null;
    case 'rhino':
      return press.button === right ? withModifiers(press, turns, 'pan') : null;
    case 'fusion':
      return press.button === middle ? withModifiers(press, 'pan', turns) : null;
  }
}

function withModifiers(press: Press, plain: Motion, shifted: Motion): Motion {
  if (press.ctrlKey) return 'zoom';
  return press.shiftKey ? shifted : plain;
}
