import type { Scene } from '../document/scene';
import { scenes } from '../document/scenes';
import type { App } from './app';

/** Drawn by scripts/studio_pictures.sh; fetched when the gallery is opened. */
const pictures = import.meta.glob<string>('../../../docs/pictures/gallery/*.png', { query: '?url', import: 'default', eager: true });

/** The name of a scene in file names. */
export const slug = (name: string): string => name.toLowerCase().replace(/\W+/g, '-');

export const pictureOf = (scene: Scene): string | undefined => pictures[`../../../docs/pictures/gallery/${slug(scene.name)}.png`];

export async function openScene(app: App, scene: Scene): Promise<void> {
  const { file } = scene;
  const fetchFile = file === undefined ? undefined : async () => {
    const response = await fetch(file).catch(() => null);
    if (response?.ok) return new Uint8Array(await response.arrayBuffer());
    app.notify({ kind: 'error', text: `“${scene.name}” could not be loaded`, remedy: 'see whether the network is there, and try again' });
    return null;
  };
  await app.documents.openScene(scene.document, scene.commands ?? [], fetchFile);
}

export { scenes };
