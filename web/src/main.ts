import './style.css';
import './document/document.css';
import './view/view.css';

import { App } from './app';
import { workOffline } from './offline/register';
import { offerRecovery } from './ui/recovery';
import { openScene, scenes } from './gallery';
import { notices, toolRail, topBar } from './ui/chrome';
import { h } from './ui/dom';
import { listenToEdges } from './ui/edge_popover';
import { listenToKeys } from './ui/keyboard';
import { legendCard } from './ui/legend';
import { createPanel } from './ui/panel_create';
import { displayPanel } from './ui/panel_display';
import { surfacePanel } from './ui/panel_surface';
import { brushPanel, pointsPanel } from './ui/panels_hand';
import { constraintsPanel, surfacesPanel, toolsPanel } from './ui/panels_scene';
import { evolutionPanel, historyPanel, materialPanel } from './ui/panels_model';
import { statusBar } from './ui/plot';
import { offerTour } from './ui/tour';

const app = new App();

document.getElementById('studio')!.append(
  topBar(app),
  toolRail(app),
  h('main', { class: 'stage' }, app.viewer.element, legendCard(app), notices(app)),
  h('aside', { class: 'side', aria: { label: 'Settings' } },
    brushPanel(app), pointsPanel(app), toolsPanel(app), surfacesPanel(app), surfacePanel(app), createPanel(app), materialPanel(app), evolutionPanel(app), constraintsPanel(app),
    displayPanel(app), historyPanel(app)),
  statusBar(app),
);
listenToKeys(app);
listenToEdges(app);

// Files dropped anywhere are opened.
document.addEventListener('dragover', (event) => event.preventDefault());
document.addEventListener('drop', (event) => {
  event.preventDefault();
  const file = event.dataTransfer?.files[0];
  if (file) void app.documents.openFile(file);
});

// For tests and the curious.
Object.assign(window, { studio: app });

async function start(): Promise<void> {
  await app.client.ready;
  await app.attempt(async () => void (await app.client.paint({ detail: app.display.detail, field: app.display.field })));
  await openScene(app, scenes[0]!);
  await offerRecovery(app);
  offerTour(app);
  app.changed();
  document.documentElement.dataset.ready = 'true';
  await workOffline(app);
}

void start();
