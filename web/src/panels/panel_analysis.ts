import { format, parseLength } from '../document/units';
import { unitOf } from '../engine/session_state';
import type { Display } from '../view/display';
import type { App } from './app';
import { field, select, slider } from './dom';
import { numberInput } from './number_input';
import { note, panel } from './panel';

const axes = [['none', 'None'], ['x', 'Across x'], ['y', 'Across y'], ['z', 'Across z']] as const;

/** Lines that are drawn over surfaces to judge their shape. */
export function analysisPanel(app: App): HTMLElement {
  const unit = () => unitOf(app.state);
  const spacing = () => (app.display.sections === 'none' ? 0 : app.viewer.sectionSpacing);
  return panel(app, 'Analysis', (a) => [a.display.sections, spacing(), unit(), a.display.combs, a.viewer.combs.largest], () => {
    const { sections, sectionSpacing } = app.display;
    return [
      field('Sections', select<Display['sections']>('Section curves', axes, sections, (to) => app.setDisplay({ sections: to })),
        'Curves in which planes at equal steps cut the surfaces, from the origin of the file'),
      sections === 'none' ? null : field(`Step, ${unit()}`, numberInput('Step of the section curves', spacing(),
        (x) => (x < 0 ? 'The step is a length, or 0 for a round one that follows from the size' : app.setDisplay({ sectionSpacing: x })),
        (text) => parseLength(text, unit())), `0: a round length that follows from the size${sectionSpacing === 0 ? ', as now' : ''}`),
      ...combFields(app, unit()),
    ];
  }, false);
}

/** Curvature combs of the selected surfaces. */
function combFields(app: App, unit: string): (Node | null)[] {
  const { combs, combCurves, combTeeth, combScale } = app.display;
  const choose = field('Combs', select<Display['combs']>('Curvature combs', [['none', 'None'], ['u', 'Along u'], ['v', 'Along v'], ['both', 'Both ways'], ['sections', 'On section curves']], combs,
    (to) => app.setDisplay({ combs: to })), 'Curvature along isocurves of the selected surfaces, or where sections cut them, away from the centre of curvature');
  if (combs === 'none') return [choose];
  const { largest } = app.viewer.combs;
  const onSections = combs === 'sections';
  return [
    choose,
    onSections ? null : field('Curves', slider('Curves with combs', combCurves, [1, 25], (x) => app.setDisplay({ combCurves: Math.round(x) })), 'In each direction'),
    onSections ? null : field('Teeth', slider('Teeth of the combs', combTeeth, [1, 20], (x) => app.setDisplay({ combTeeth: Math.round(x) })), 'Pieces of every knot span'),
    field('Length', slider('Length of the combs', combScale, [0.02, 1], (x) => app.setDisplay({ combScale: x })), 'Of the largest curvature'),
    note(largest > 0 ? `Largest curvature ${format(largest)} 1/${unit}, radius ${format(1 / largest)} ${unit}` : `Straight, or nothing is selected${onSections ? ', or no section cuts it' : ''}`),
  ];
}
