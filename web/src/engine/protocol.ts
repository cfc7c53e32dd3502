import type { Assembly } from './context';
import type { DisplayChoice, DisplayInfo, DisplayRange } from './displays';
import type { Asked, Query } from '@knead/engine';
import type { BodyPicture, Combs, Command, EngineErrorInfo, LatticeSettings, Picture, PictureWindow, SectionPlane, SessionInfo, StepInfo, ToolPicture } from './session_types';

/** How surfaces are drawn. */
export interface PictureSettings {
  lattice?: LatticeSettings;
  detail: number;
  display: DisplayChoice;
  /** The shapes as they were opened, for comparison. */
  opened?: boolean;
  /** On how many curves each way, and in how many pieces of every span, the selected surfaces have curvature combs. */
  combs?: { curves: [number, number]; teeth: number };
  /** What the views show from nearby, of each surface. Only frames that answer this request have them. */
  windows?: readonly (PictureWindow | null)[];
  /** Planes at whose cuts the selected surfaces have them. */
  sectionCombs?: readonly SectionPlane[];
}

/** Requests of the page to the worker. Every request is answered by one `Reply` with its number. */
export type Request =
  /** A session on a file, or on nothing. The first `opened` of its commands, or all, belong to the document: undo does not go behind them. */
  | { kind: 'open'; bytes: Uint8Array; name: string; commands: Command[]; opened?: number }
  | { kind: 'fresh'; name: string; commands: Command[]; opened?: number }
  /**
   * Commands that are one act: with `join` they also belong to the entry of the history before them; with `opening` the
   * document is open only now.
   */
  | { kind: 'execute'; commands: Command[]; join: boolean; opening?: boolean }
  | { kind: 'pictures'; settings: PictureSettings }
  /** Steps until `stop`, or, to rest, until nothing moves. */
  | { kind: 'play'; toRest: boolean }
  | { kind: 'stop' }
  /** The page has drawn the last frame: the next one may come. */
  | { kind: 'drawn' }
  /** The other faces of the file, and the trims of the surfaces. */
  | { kind: 'context' }
  /** Anything else that the engine answers. */
  | { kind: 'query'; query: Query; request: Asked<Query>[0] }
  /** `Snapshot`. `kept`: nothing up to here needs recomputing. */
  | { kind: 'snapshot'; historyBytes: number; kept: boolean }
  | { kind: 'restore'; source: Uint8Array | null; name: string; snapshot: Uint8Array; opened: number };

/** `opened`: how many commands of the journal belong to the document. */
export interface Snapshot {
  snapshot: Uint8Array;
  journal: string;
  opened: number;
}

export interface Frame {
  state: SessionInfo;
  /** The figures of the last step, and the plot, are of this state. */
  stands: boolean;
  pictures: Picture[];
  /** Of the colours of the pictures; null without any. */
  range: DisplayRange | null;
  /** The colours are those of an earlier shape, or none yet: pictures that are asked for at rest have them. */
  late: boolean;
  combs: Combs[];
  /** Curves and volumes, in the order of the state. */
  bodies: BodyPicture[];
  /** The block of the command `lattice`, where it is shown. */
  lattice: BodyPicture | null;
  /** Of tools that are new or have changed shape since the previous frame, by name. */
  toolPictures: Record<string, ToolPicture>;
  /** Of the opened file; only in the first frame of a session. */
  assembly?: Assembly | null;
  /** Steps from number `firstStep` on, for the plot. */
  firstStep: number;
  steps: StepInfo[];
  origin: [number, number, number];
  playing: boolean;
  /** The largest distance of the drawn selected surfaces from where they were opened; while a stroke or steps go on that of the last step. File units. */
  moved: number;
  /** Milliseconds that the worker took for commands and for pictures. */
  computeTime: number;
  pictureTime: number;
  memory: number;
  /** Milliseconds of commands since the last snapshot: what a recovery would have to recompute. */
  unkept: number;
}

export type Reply =
  /** `lock` is held (Web Locks) as long as the worker lives; empty where the browser has none. */
  | { kind: 'ready'; displays: DisplayInfo[]; lock: string }
  /** So many steps of the command under way are done. */
  | { kind: 'progress'; done: number; total: number }
  | { kind: 'frame'; frame: Frame }
  | { kind: 'done'; id: number; answer?: unknown }
  | { kind: 'failed'; id: number; error: EngineErrorInfo }
  /** The module has trapped: nothing that it holds can be relied on. */
  | { kind: 'died'; message: string };
