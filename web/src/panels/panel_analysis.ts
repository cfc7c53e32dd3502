import { parseLength } from '../document/units';
import type { Display } from '../view/display';
import type { App } from './app';
import { field, select } from './dom';
import { numberInput } from './number_input';
import { panel } from './panel';

const axes = [['none', 'None'], ['x', 'Across x'], ['y', 'Across y'], ['z', 'Across z']] as const;

/** Lines that are drawn over surfaces to judge their shape. */
export function analysisPanel(app: App): HTMLElement {
  const unit = () => app.state?.surfaces[0]?.unit ?? 'mm';
  const spacing = () => (app.display.sections === 'none' ? 0 : app.viewer.sectionSpacing);
  return panel(app, 'Analysis', (a) => [a.display.sections, spacing(), unit()], () => {
    const { sections, sectionSpacing } = app.display;
    return [
      field('Sections', select<Display['sections']>('Section curves', axes, sections, (to) => app.setDisplay({ sections: to })),
        'Curves in which planes at equal steps cut the surfaces, from the origin of the file'),
      sections === 'none' ? null : field(`Step, ${unit()}`, numberInput('Step of the section curves', spacing(),
        (x) => (x < 0 ? 'The step is a length, or 0 for a round one that follows from the size' : app.setDisplay({ sectionSpacing: x })),
        (text) => parseLength(text, unit())), `0: a round length that follows from the size${sectionSpacing === 0 ? ', as now' : ''}`),
    ];
  }, false);
}
