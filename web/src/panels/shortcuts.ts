import { conventionText } from '../view/conventions';
import type { App } from './app';

/** What the overlay of shortcuts lists. */
export function shortcuts(app: App): [string, string][] {
  const [orbit, pan, zoom] = conventionText[app.display.convention];
  return [
    ['Orbit', orbit], ['Pan', pan], ['Zoom', zoom], ['Fingers', 'one: brush, or orbit beside the surface; two: pan, zoom, turn; three: orbit'],
    ['1 2 3', 'front, right, top; Shift: the other side'], ['0', 'as at the start, all of it'], ['6', 'isometric'], ['7', 'parallel projection or perspective'], ['8', 'turntable'], ['X', 'section: hide what is before a plane'], ['5', 'along an axis or free'], ['4', 'four views or one'],
    ['Double click a label', 'that view alone, or all'], ['F', 'what is selected; Shift: everything'],
    ['V B U S G', 'look, push, pull, smooth, grab'], ['W', 'brushes: inflate, flatten, crease, mask and more'], ['E', 'control points'], ['T', 'place a tool'], ['P I A D', 'pin, freeze, material, edges'], ['Q', 'measure distances, angles, radii'],
    ['Alt, Shift with a brush', 'the other way, smooth'], ['Alt with paint', 'takes it away'],
    ['Shift-, Alt-wheel', 'size, depth of the brush'], ['Ctrl-drag', 'to the side size, upwards depth'], ['[ ]', 'size of the brush'],
    ['X Y Z N while dragging points', 'along an axis or the normal'], ['Ctrl-, Alt-click a point', 'its row along u, v'],
    ['M N K', 'move, turn, resize a tool'], ['Delete', 'take the tool away'], ['Esc', 'takes back what is under way'],
    ['Space', 'play or pause'], ['.', 'one step'], ['R', 'run to rest'], ['Ctrl+Z, Shift: redo', 'undo'], ['Ctrl+S', 'save the CAD file'],
    ['O', 'open'], ['C, held', 'the shape as it was opened'], ['Z', 'zebra stripes'], ['L', 'basis functions and Gramians'], ['?', 'this list'],
  ];
}
