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
  /** The values at the ends of the palette; null: the largest value present, times `share`. */
  limits: [number, number] | null;
  share: number;
  /** Compared with the shape as it was opened. */
  compares: boolean;
  settings: DisplaySetting[];
}

/** A display and its settings, as a request for pictures names them. */
export interface DisplayChoice {
  display: string;
  settings?: Record<string, SettingValue>;
}

export const plain: DisplayChoice = { display: 'none' };

/** "1/length²" in a file of mm is "1/mm²". */
export const unitIn = (unit: string, fileUnit: string): string => unit.replace('length', fileUnit);
