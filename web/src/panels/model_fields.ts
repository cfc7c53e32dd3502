import type { SurfaceInfo } from '@knead/generated';
import { unitInWords } from '../document/units';
import type { App } from './app';
import { field, toggle } from './dom';
import { numberInput } from './number_input';
import { note, row } from './panel';

/** What resists in a surface: the linear model of sculpting, or one that follows any rotation. */
const models = [
  ['linear', 'Linear', 'Fast; for small deformations. Large rotations are taken for stretch'],
  ['shell', 'Shell', 'A sheet of real material and thickness (Koiter): forces, stresses, modes'],
  ['fundamental', 'Forms', 'Keeps lengths and curvatures as they were (both fundamental forms), without a material'],
] as const;

const modelOf = (s: SurfaceInfo) => (s.shell ? 'shell' : s.fundamental ? 'fundamental' : 'linear');

/** Steel in N, mm and t, and a hundredth of the size thick. */
function steel(s: SurfaceInfo) {
  const size = Math.hypot(...s.upper.map((x, k) => x - s.lower[k]!));
  return { young: 210000, poisson: 0.3, thickness: Number((size / 100).toPrecision(2)), density: 7.85e-9 };
}

export function modelFields(app: App, s: SurfaceInfo): (Node | null)[] {
  const model = modelOf(s);
  return [
    row(...models.map(([name, label, help]) => toggle(label, name === model, () => void app.execute([
      { do: 'material', model: name, ...(name === 'shell' ? steel(s) : {}) }]), help))),
    note(models.find(([name]) => name === model)![2] + '.'),
  ];
}

/** The numbers of a shell, or of the weights of the forms; null where the model is linear. */
export function shellFields(app: App, s: SurfaceInfo): (Node | null)[] | null {
  if (s.shell) {
    const number = (name: 'young' | 'poisson' | 'thickness' | 'density', label: string, title: string, help: string) =>
      field(label, numberInput(title, s.shell![name], (x) => app.offer([{ do: 'material', [name]: x }])), help);
    return [
      number('young', 'Young E', "Young's modulus", 'Force per area; 210000 N/mm² for steel'),
      number('poisson', 'Poisson ν', "Poisson's ratio", 'Above -1, up to 0.5'),
      number('thickness', 'Thickness t', 'Thickness', `In ${unitInWords(s.unit)}`),
      number('density', 'Density ρ', 'Density', 'Mass per volume: for gravity and modes; 7.85e-9 t/mm³ for steel'),
      note('Hold edges, load it, and choose Balance under Evolution; the colours Von Mises stress and Bending strain are under Display.'),
    ];
  }
  if (!s.fundamental) return null;
  const weight = (name: 'w1' | 'w2', label: string, title: string, help: string) =>
    field(label, numberInput(title, s.fundamental![name][0]!, (x) => app.offer([{ do: 'material', [name]: [x, x, x] }])), help);
  return [
    weight('w1', 'Lengths w1', 'Weight of lengths', 'Of differences of the first fundamental form'),
    weight('w2', 'Bending w2', 'Weight of curvatures', 'Of differences of the second fundamental form'),
  ];
}
