import type { App } from './app';
import { h, icon } from './dom';
import { openScene, pictureOf, scenes } from './gallery';

/** Ready scenes, each with its picture. */
export function galleryMenu(app: App): HTMLElement {
  const close = () => {
    element.open = false;
  };
  const items = scenes.map((scene) => {
    const picture = pictureOf(scene);
    return h('button', { type: 'button', class: 'menu-item scene', onclick: () => {
      close();
      void openScene(app, scene);
    } }, picture ? h('img', { src: picture, alt: '', loading: 'lazy', width: 132, height: 88 }) : null, h('b', {}, scene.name), h('small', {}, scene.about));
  });
  const element = h('details', { class: 'menu' },
    h('summary', { class: 'button labelled', title: 'Gallery of ready scenes', aria: { label: 'Gallery of ready scenes' } }, icon('gallery'), h('span', {}, 'Gallery')),
    h('div', { class: 'menu-list scenes' }, ...items));
  document.addEventListener('pointerdown', (e) => {
    if (!element.contains(e.target as Node)) close();
  });
  element.addEventListener('keydown', (e) => {
    if (e.key === 'Escape') close();
  });
  return element;
}
