// Where the states and transitions of an automaton, or the ends of a graph, are drawn: computed by ELK, in a worker.

import ELK, { type ElkExtendedEdge, type ElkNode } from "elkjs/lib/elk-api";

declare global {
  // Set where the page came from files, and no worker may be started: see worker.ts.
  var layoutWorker: (new (url: string | undefined) => Worker) | undefined;
}

export const LETTER = 6.7;
export const LINE = 15;

export interface Box {
  id: string;
  /** The title, then rows. */
  texts: string[];
}

export interface Line {
  id: string;
  source: string;
  target: string;
  texts: string[];
}

export interface Point {
  x: number;
  y: number;
}

export interface Drawing {
  width: number;
  height: number;
  boxes: Map<string, { x: number; y: number; width: number; height: number }>;
  lines: Map<string, { points: Point[]; label: Point }>;
}

const OPTIONS = {
  "elk.algorithm": "layered",
  "elk.direction": "DOWN",
  // States stand in the order of the text, so the initial one first.
  "elk.layered.considerModelOrder.strategy": "NODES_AND_EDGES",
  "elk.layered.cycleBreaking.strategy": "MODEL_ORDER",
  "elk.edgeRouting": "SPLINES",
  "elk.layered.spacing.nodeNodeBetweenLayers": "30",
  "elk.layered.spacing.edgeNodeBetweenLayers": "14",
  "elk.spacing.nodeNode": "26",
  "elk.spacing.edgeEdge": "12",
  "elk.spacing.edgeLabel": "4",
  "elk.edgeLabels.inline": "false",
  "elk.padding": "[top=10,left=22,bottom=10,right=12]",
  "elk.aspectRatio": "1.6",
};

let engine: InstanceType<typeof ELK> | null = null;

function elk(): InstanceType<typeof ELK> {
  const Layouter = globalThis.layoutWorker;
  engine ??= new ELK({
    workerUrl: "layout.js",
    workerFactory: (url) => (Layouter === undefined ? new Worker(url!) : new Layouter(url)),
  });
  return engine;
}

/** Rejects where ELK can't lay it out. */
export async function layout(boxes: Box[], lines: Line[]): Promise<Drawing> {
  const graph: ElkNode = {
    id: "root",
    layoutOptions: OPTIONS,
    children: boxes.map((box) => ({ id: box.id, ...size(box.texts, 24, 12) })),
    edges: lines.map((line) => ({
      id: line.id,
      sources: [line.source],
      targets: [line.target],
      labels: line.texts.length === 0 ? [] : [{ id: `${line.id}-label`, text: "x", ...size(line.texts, 6, 2) }],
    })),
  };
  const laidOut = await elk().layout(graph);
  return {
    width: laidOut.width ?? 0,
    height: laidOut.height ?? 0,
    boxes: new Map(
      (laidOut.children ?? []).map((box) => [
        box.id,
        { x: box.x ?? 0, y: box.y ?? 0, width: box.width ?? 0, height: box.height ?? 0 },
      ]),
    ),
    lines: new Map(
      ((laidOut.edges ?? []) as ElkExtendedEdge[]).map((edge) => {
        const section = edge.sections?.[0];
        const points = section ? [section.startPoint, ...(section.bendPoints ?? []), section.endPoint] : [];
        const label = edge.labels?.[0];
        return [edge.id, { points, label: { x: label?.x ?? 0, y: label?.y ?? 0 } }];
      }),
    ),
  };
}

function size(texts: string[], besides: number, above: number): { width: number; height: number } {
  const longest = Math.max(...texts.map((text) => text.length));
  return { width: longest * LETTER + besides, height: texts.length * LINE + above };
}

/** The path of a line: splines as ELK gives them, three points a piece. */
export function path(points: Point[]): string {
  const [start, ...rest] = points;
  if (start === undefined) return "";
  let drawn = `M${start.x} ${start.y}`;
  let position = 0;
  while (rest.length - position >= 3) {
    const [first, second, end] = rest.slice(position, position + 3);
    drawn += `C${first!.x} ${first!.y} ${second!.x} ${second!.y} ${end!.x} ${end!.y}`;
    position += 3;
  }
  for (const point of rest.slice(position)) drawn += `L${point.x} ${point.y}`;
  return drawn;
}
