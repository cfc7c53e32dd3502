import { format, parseLength, parseNumber, unitInWords } from '../document/units';
import { type DisplayInfo, type DisplaySetting, unitIn } from '../engine/displays';
import { unitOf } from '../engine/session_state';
import { conventionNames, conventionText } from '../view/conventions';
import type { Display } from '../view/display';
import { lookNames } from '../view/looks';
import type { App } from './app';
import { field, h, select, slider, toggle } from './dom';
import { autoLimitsAgain } from './legend';
import { numberInput } from './number_input';
import { note, panel, row } from './panel';

export function displayPanel(app: App): HTMLElement {
  return panel(app, 'Display', (a) => [{ ...a.display, limits: a.display.colour ? a.display.limits.map(format) : [] }, unitOf(a.state), a.client.displays.length], () => {
    const d = app.display;
    const chip = (name: keyof Display, label: string, tip?: string) =>
      toggle(label, d[name] as boolean, (on) => app.setDisplay({ [name]: on }), tip);
    return [
      row(chip('surface', 'Surface'), chip('isocurves', 'Isocurves'), chip('knotLines', 'Knot lines'),
        chip('points', 'Points', 'Control points; held ones in orange'), chip('net', 'Net', 'Control net'), chip('normals', 'Normals'),
        chip('grid', 'Grid'),
        chip('context', 'Context', 'The other faces of the file, in grey'),
        chip('trimmed', 'Trimmed', 'Only what the faces of the file show of their surfaces; all of each can be sculpted'),
        chip('relief', 'Relief', 'What stands out is brightened, what lies in a hollow darkened'),
        chip('sides', 'Sides', 'The back of surfaces is tinted, where their normals point away'),
        chip('flipped', 'Flip normals', 'To the eye alone: of the tint of the back and of drawn normals; surfaces keep theirs')),
      lookField(app),
      ...stripeFields(app),
      ...colourFields(app),
      field('Point size', slider('Point size', d.pointSize, [2, 14], (pointSize) => app.setDisplay({ pointSize }))),
      field('Detail', select('Detail', [['48', 'Coarse'], ['96', 'Normal'], ['192', 'Fine']], String(d.detail) as '96',
        (v) => app.setDisplay({ detail: Number(v) })), 'Lines of the picture per direction; the surface itself is exact'),
      field('Mouse', select('Mouse as in', conventionNames, d.convention, (convention) => app.setDisplay({ convention }))),
      h('dl', { class: 'bindings' }, ...['Orbit', 'Pan', 'Zoom'].flatMap((what, k) =>
        [h('dt', {}, what), h('dd', {}, conventionText[d.convention][k]!)])),
    ];
  });
}

/** A look for plain surfaces, or stripes. */
function lookField(app: App): HTMLElement {
  const { look, stripes } = app.display;
  const options = [...lookNames, ['zebra', 'Zebra'], ['highlight', 'Highlight lines']] as const;
  return field('Look', select('Look of surfaces', options, stripes === 'none' ? look : stripes, (chosen) =>
    app.setDisplay(chosen === 'zebra' || chosen === 'highlight' ? { stripes: chosen } : { look: chosen, stripes: 'none' })),
    'Zebra: reflection stripes; kinks show curvature that jumps (Z). Highlight lines: where normals point at straight lamps, whatever the view');
}

/** How stripes are turned, and how far they are apart. */
function stripeFields(app: App): (Node | null)[] {
  const { stripes, stripeAngle, stripeSpacing } = app.display;
  if (stripes === 'none') return [];
  return [
    field('Direction', slider('Direction of the stripes', stripeAngle, [0, 180], (angle) => app.setDisplay({ stripeAngle: angle })),
      stripes === 'zebra' ? 'Turns the stripes about the line of sight' : 'Turns the lamps about the vertical'),
    field('Spacing', slider('Spacing of the stripes', stripeSpacing, [1, 40], (spacing) => app.setDisplay({ stripeSpacing: spacing })),
      'Angle between two stripes of the surroundings, or between two lamps'),
  ];
}

/** What colours the surfaces: the displays that the engine describes, the colour limits, the settings of the display. */
function colourFields(app: App): (Node | null)[] {
  const { colour } = app.display;
  const { displays } = app.client;
  const options = [['none', 'Plain'], ...displays.map((d) => [d.name, d.title])] as [string, string][];
  const choose = field('Colour', select('Colour by', options, colour?.name ?? 'none', (name) =>
    app.setDisplay({ colour: displays.find((d) => d.name === name) ?? null, stripes: 'none', autoLimits: true })));
  if (!colour) return [choose];
  return [choose, note(colour.help), limitFields(app, colour), ...colour.settings.map((s) => settingField(app, colour, s))];
}

/** One number if the colours are symmetric, otherwise two. */
function limitFields(app: App, colour: DisplayInfo): HTMLElement {
  const { limits: [lower, upper], autoLimits } = app.display;
  const parse = (text: string) => (colour.unit === 'length' ? parseLength(text, unitOf(app.state)) : parseNumber(text));
  const number = (label: string, value: number, limits: (x: number) => [number, number]) =>
    numberInput(label, value, (x) => app.setDisplay(x === 0 ? {} : { limits: limits(Math.abs(x)), autoLimits: false }), parse);
  const inputs = colour.limits
    ? [number('Lower limit of the colours', lower, (x) => [-x, upper]), number('Upper limit of the colours', upper, (x) => [lower, x])]
    : [number('Limit of the colours', upper, (x) => [colour.signed ? -x : 0, x])];
  return field(colour.limits ? 'Limits' : '± limit', row(...inputs,
    toggle('Auto', autoLimits, (on) => (on ? autoLimitsAgain(app) : app.setDisplay({ autoLimits: on })),
      colour.limits ? 'Those of the display' : 'By the values that are seen, each as far as its share of the area goes')));
}

/** A number or a vector that a display needs. */
function settingField(app: App, colour: DisplayInfo, setting: DisplaySetting): HTMLElement {
  const own = app.display.colourSettings[colour.name] ?? {};
  const value = own[setting.name] ?? setting.value;
  const set = (to: number | number[]) =>
    app.setDisplay({ colourSettings: { ...app.display.colourSettings, [colour.name]: { ...own, [setting.name]: to } } });
  const title = setting.unit ? `${setting.title}, ${unitIn(setting.unit, unitInWords(unitOf(app.state)))}` : setting.title;
  const inputs = typeof value === 'number' ? [numberInput(setting.title, value, set)]
    : value.map((x, k) => numberInput(`${setting.title} ${'xyz'[k]}`, x, (y) => set(value.map((z, l) => (l === k ? y : z)))));
  const element = field(title, row(...inputs), setting.help);
  if (inputs.length > 1) element.classList.add('wide');
  return element;
}
