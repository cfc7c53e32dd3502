/** Samples per direction: a net is rarely finer under a brush. */
const samples = 64;

/** The lightness of an image as the rows of heights of a stamp: white is 1, black and what is transparent 0. The longer side fills the square. */
export async function heightsOf(file: Blob): Promise<number[][]> {
  const image = await createImageBitmap(file).catch(() => {
    throw new Error('This is no image that the browser can read: choose a PNG, JPEG or WebP file.');
  });
  const canvas = new OffscreenCanvas(samples, samples);
  const context = canvas.getContext('2d')!;
  const scale = samples / Math.max(image.width, image.height);
  const [width, height] = [image.width * scale, image.height * scale];
  context.fillStyle = 'black';
  context.fillRect(0, 0, samples, samples);
  context.drawImage(image, (samples - width) / 2, (samples - height) / 2, width, height);
  image.close();
  const { data } = context.getImageData(0, 0, samples, samples);
  const lightness = (k: number) => (0.2126 * data[k]! + 0.7152 * data[k + 1]! + 0.0722 * data[k + 2]!) / 255;
  return Array.from({ length: samples }, (_, row) =>
    Array.from({ length: samples }, (_, column) => Math.round(1000 * lightness(4 * (row * samples + column))) / 1000));
}
