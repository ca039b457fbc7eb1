// Layout of the states and transitions of an automaton, or of the endpoints of a graph. ELK computes it in a worker.

import ELK, { type ElkExtendedEdge, type ElkNode } from "elkjs/lib/elk-api";

declare global {
  // Only set in a page from files, which may not start a worker: see worker.ts.
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
  // States keep the order of the text, so the initial state is first.
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
const drawings = new Map<string, Promise<Drawing>>();

/** Starts the worker early, because the start takes time. */
export function begin(): InstanceType<typeof ELK> {
  const Layouter = globalThis.layoutWorker;
  engine ??= new ELK({
    workerUrl: "layout.js",
    workerFactory: (url) => (Layouter === undefined ? new Worker(url!) : new Layouter(url)),
  });
  return engine;
}

/** Boxes on both sides of a high one, each with a horizontal line to it. ELK would need seconds for 200 boxes. */
export function columns(middle: Box, left: Box[], right: Box[]): Drawing {
  const [apart, between, margin] = [70, 10, 12];
  const sides = [left, right].map((side) => {
    const sizes = side.map((box) => size(box.texts, 24, 12));
    return { side, sizes, width: Math.max(0, ...sizes.map(({ width }) => width)) };
  });
  const height = Math.max(...sides.map(({ sizes }) => sizes.reduce((sum, box) => sum + box.height + between, 0)), LINE + 12);
  const center = size(middle.texts, 24, 12);
  const [before, after] = sides.map(({ side, width }) => (side.length > 0 ? width + apart : 0)) as [number, number];
  const box = { x: margin + before, y: margin, width: center.width, height };
  const drawing: Drawing = {
    width: before + center.width + after + 2 * margin,
    height: height + 2 * margin,
    boxes: new Map([[middle.id, box]]),
    lines: new Map(),
  };
  sides.forEach(({ side, sizes, width }, index) => {
    let y = margin + between / 2;
    side.forEach(({ id }, number) => {
      const own = { x: index === 0 ? margin + width - sizes[number]!.width : box.x + box.width + apart, y, ...sizes[number]! };
      drawing.boxes.set(id, own);
      const level = y + own.height / 2;
      const points = [box.x + (index === 0 ? 0 : box.width), own.x + (index === 0 ? own.width : 0)].map((x) => ({ x, y: level }));
      drawing.lines.set(id, { points, label: points[0]! });
      y += own.height + between;
    });
  });
  return drawing;
}

/** Lays out a graph once for all graphs that differ only in their texts, such as instances of a template. Rejects if ELK fails. */
export function layout(boxes: Box[], lines: Line[]): Promise<Drawing> {
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
  const key = JSON.stringify(graph);
  const made = drawings.get(key) ?? begin().layout(graph).then(drawing);
  drawings.set(key, made);
  return made;
}

function drawing({ width = 0, height = 0, children = [], edges = [] }: ElkNode): Drawing {
  return {
    width,
    height,
    boxes: new Map(
      children.map(({ id, x = 0, y = 0, width = 0, height = 0 }) => [id, { x, y, width, height }]),
    ),
    lines: new Map(
      edges.map((edge: ElkExtendedEdge) => {
        const section = edge.sections?.[0];
        const points = section ? [section.startPoint, ...(section.bendPoints ?? []), section.endPoint] : [];
        const { x = 0, y = 0 } = edge.labels?.[0] ?? {};
        return [edge.id, { points, label: { x, y } }];
      }),
    ),
  };
}

function size(texts: string[], besides: number, above: number): { width: number; height: number } {
  const longest = Math.max(...texts.map((text) => text.length));
  return { width: longest * LETTER + besides, height: texts.length * LINE + above };
}

/** The path of a line with the splines of ELK, three points for each piece. */
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
