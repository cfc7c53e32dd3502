import './style.css';
import '../document/document.css';
import '../view/view.css';
import '../view/view_cube.css';
import '../view/measure.css';
import '../view/edges.css';
import '../view/follow.css';

import { busyBar } from '../panels/busy';
import { notices, toolRail, topBar } from '../panels/chrome';
import { h } from '../panels/dom';
import { EdgeCheckup } from '../panels/edge_checkup';
import { edgeLabels, edgeLegend } from '../panels/edge_legend';
import { listenToEdges } from '../panels/edge_popover';
import { followDoor } from '../panels/follow/door';
import { openScene, scenes } from '../panels/gallery';
import { heldBadge } from '../panels/held_badge';
import { listenToKeys } from '../panels/keyboard';
import { legendCard } from '../panels/legend';
import { analysisPanel } from '../panels/panel_analysis';
import { assemblyPanel } from '../panels/panel_assembly';
import { createPanel } from '../panels/panel_create';
import { displayPanel } from '../panels/panel_display';
import { surfacePanel } from '../panels/panel_surface';
import { brushPanel, pointsPanel } from '../panels/panels_hand';
import { checkPanel } from '../panels/panel_check';
import { measurePanel, readingLabels } from '../panels/panel_measure';
import { evolutionPanel, historyPanel, materialPanel } from '../panels/panels_model';
import { constraintsPanel, surfacesPanel, toolsPanel } from '../panels/panels_scene';
import { statusBar } from '../panels/plot';
import { listenToQuestions } from '../panels/question';
import { offerRecovery } from '../panels/recovery';
import { droppedHandle } from '../document/disk';
import { offerTour } from '../panels/tour';
import { sectionHandle } from '../panels/section';
import { viewsPanel } from '../panels/panel_views';
import { viewCube } from '../panels/view_cube';
import { workOffline } from './offline/register';
import { Studio } from './studio';

const app = new Studio();
const checkup = new EdgeCheckup(app);

document.getElementById('studio')!.append(
  topBar(app),
  toolRail(app),
  h('main', { class: 'stage' }, app.viewer.element, legendCard(app), edgeLegend(app, checkup), busyBar(app), notices(app)),
  h('aside', { class: 'side', aria: { label: 'Settings' } },
    measurePanel(app), brushPanel(app), pointsPanel(app), toolsPanel(app), assemblyPanel(app), surfacesPanel(app), surfacePanel(app), createPanel(app), materialPanel(app), evolutionPanel(app), constraintsPanel(app), followDoor(app), checkPanel(app, checkup),
    viewsPanel(app), displayPanel(app), analysisPanel(app), historyPanel(app)),
  statusBar(app),
);
listenToKeys(app);
app.viewer.element.append(readingLabels(app), edgeLabels(app, checkup), heldBadge(app), viewCube(app), sectionHandle(app));
listenToQuestions(app);
listenToEdges(app);

// Files dropped anywhere are opened.
document.addEventListener('dragover', (event) => event.preventDefault());
document.addEventListener('drop', (event) => {
  event.preventDefault();
  const files = [...(event.dataTransfer?.files ?? [])];
  const handles = files.map((_, k) => droppedHandle(event.dataTransfer?.items[k]));
  void app.documents.openFiles(files, handles);
});

// For tests and the curious.
Object.assign(window, { studio: app });

async function start(): Promise<void> {
  await app.client.ready;
  app.askForPictures(false);
  await openScene(app, scenes[0]!);
  await offerRecovery(app);
  offerTour(app);
  app.changed();
  document.documentElement.dataset.ready = 'true';
  await workOffline(app);
}

void start();
