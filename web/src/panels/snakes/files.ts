import type { Pixels } from './module';

const mostPixels = 16e6;

/** A decoded image: what the module takes, what the page draws. */
export interface Opened {
  name: string;
  pixels: Pixels;
  bitmap: ImageBitmap;
  /** The file has 16 bits a channel, of which the browser keeps 8. */
  reduced: boolean;
}

export const imageEndings = ['.png', '.jpg', '.jpeg'] as const;

/** Bits per channel of a PNG file; null of any other. */
export function pngDepth(head: Uint8Array): number | null {
  const signature = [0x89, 0x50, 0x4e, 0x47];
  return head.length > 24 && signature.every((byte, k) => head[k] === byte) ? head[24]! : null;
}

/** Decodes an image by the browser; what is transparent lies on white, as for the command line. */
export async function openImage(file: File): Promise<Opened> {
  const head = new Uint8Array(await file.slice(0, 32).arrayBuffer());
  const bitmap = await createImageBitmap(file, { colorSpaceConversion: 'none' }).catch(() => {
    throw new Error(`“${file.name}” is no image that the browser can read: save it as PNG or JPEG again.`);
  });
  const { width, height } = bitmap;
  if (width * height > mostPixels) throw new Error(`“${file.name}” has ${width} × ${height} pixels: scale it down to 16 million or fewer.`);
  const context = new OffscreenCanvas(width, height).getContext('2d')!;
  context.fillStyle = 'white';
  context.fillRect(0, 0, width, height);
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  return { name: file.name, pixels: { width, height, data }, bitmap, reduced: pngDepth(head) === 16 };
}

/** One byte a pixel as a grey image. */
export function greyImage({ width, height, data }: { width: number; height: number; data: Uint8Array }): OffscreenCanvas {
  const canvas = new OffscreenCanvas(width, height);
  const image = new ImageData(width, height);
  data.forEach((v, k) => image.data.set([v, v, v, 255], 4 * k));
  canvas.getContext('2d')!.putImageData(image, 0, 0);
  return canvas;
}
