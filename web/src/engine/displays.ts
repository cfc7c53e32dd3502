/** What can colour surfaces, as the engine describes it (bindings/wasm/studio_displays.hpp). */

export type SettingValue = number | number[];

export interface DisplaySetting {
  name: string;
  title: string;
  unit: string;
  /** Default. */
  value: SettingValue;
  help: string;
}

export interface DisplayInfo {
  name: string;
  title: string;
  /** With "length" for the unit of the file. */
  unit: string;
  signed: boolean;
  palette: 'diverging' | 'rising';
  help: string;
  /** The values at the ends of the palette; null: those of `DisplayRange`. */
  limits: [number, number] | null;
  /** The setting up to whose magnitude values have the neutral colour; "" for none. */
  tolerance: string;
  /** Compared with the shape as it was opened. */
  compares: boolean;
  /** Looks at the whole model from every point, which takes longer than a frame may. */
  sees_model: boolean;
  settings: DisplaySetting[];
}

/** Where colours end by themselves, and the least and greatest of all visible values (knead/scene/display_range.hpp). */
export interface DisplayRange {
  lower: number;
  upper: number;
  least: number;
  greatest: number;
}

/** A display and its settings, as a request for pictures names them. */
export interface DisplayChoice {
  display: string;
  settings?: Record<string, SettingValue>;
}

/** Stands for a value that is none (bindings/wasm/studio_picture.hpp). */
export const noValue = -1e30;

export const plain: DisplayChoice = { display: 'none' };

/** "1/length²" in a file of mm is "1/mm²". */
export const unitIn = (unit: string, fileUnit: string): string => unit.replace('length', fileUnit);
