import './style.css';

import { App } from './app';
import { autosave } from './document/autosave';
import { scenes } from './gallery';
import { notices, toolRail, topBar } from './ui/chrome';
import { h } from './ui/dom';
import { listenToKeys } from './ui/keyboard';
import { brushPanel, constraintsPanel, surfacesPanel, toolsPanel } from './ui/panels_scene';
import { displayPanel, evolutionPanel, historyPanel, materialPanel } from './ui/panels_model';
import { statusBar } from './ui/plot';
import { offerTour } from './ui/tour';

const app = new App();

document.getElementById('studio')!.append(
  topBar(app),
  toolRail(app),
  h('main', { class: 'stage' }, app.viewer.element, notices(app)),
  h('aside', { class: 'side', aria: { label: 'Settings' } },
    brushPanel(app), toolsPanel(app), surfacesPanel(app), materialPanel(app), evolutionPanel(app), constraintsPanel(app),
    displayPanel(app), historyPanel(app)),
  statusBar(app),
);
listenToKeys(app);

// Files dropped anywhere are opened.
document.addEventListener('dragover', (event) => event.preventDefault());
document.addEventListener('drop', (event) => {
  event.preventDefault();
  const file = event.dataTransfer?.files[0];
  if (file) void app.openFile(file);
});

// For tests and the curious.
Object.assign(window, { studio: app });

async function start(): Promise<void> {
  await app.client.ready;
  await app.attempt(async () => void (await app.client.paint({ detail: app.display.detail, field: app.display.field })));
  const saved = await autosave.read().catch(() => undefined);
  await scenes[0]!.open(app);
  if (saved && saved.commands > 0) {
    app.notify({
      kind: 'info',
      text: `“${saved.name}”, ${saved.commands} commands, from ${new Date(saved.when).toLocaleString()}, is still here.`,
      actions: [
        { label: 'Recover', act: () => void app.recover(saved) },
        { label: 'Forget it', act: () => void autosave.forget() },
      ],
    });
  }
  offerTour(app);
  app.changed();
  document.documentElement.dataset.ready = 'true';
}

void start();
