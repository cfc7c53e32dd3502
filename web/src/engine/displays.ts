export type { DisplayInfo, DisplayRange, DisplaySetting } from '@knead/generated';

export type SettingValue = number | number[];

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
