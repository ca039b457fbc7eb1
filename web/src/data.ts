// Types of the server's data, defined in robosc/tools/view/description.py and robosc/tools/view/record.py.

/** null: unknown, or not a finite number. */
export type Value = string | number | boolean | null;

export interface Place {
  file: number;
  line: number;
  column: number;
  endLine: number;
  endColumn: number;
}

export interface State {
  name: string;
  initial: boolean;
  marked: boolean;
  place: Place | null;
}

export interface Transition {
  source: number | null;
  target: number | null;
  event: string;
  label: string;
  whole: string;
  place: Place | null;
}

export interface Variable {
  name: string;
  key: string;
  numeric?: boolean;
}

export interface Automaton {
  name: string;
  key: string;
  kind: string;
  variables: Variable[];
  place: Place | null;
  states: State[];
  transitions: Transition[];
}

export interface Input {
  name: string;
  label: string;
  values?: Value[];
  minimum?: number;
  maximum?: number;
}

/** Data that the node stores; `path` contains the names of the fields. */
export interface Beside {
  path: string[];
  label: string;
  kind: "checkbox" | "whole" | "number" | "text";
}

export interface Event {
  words: string;
  controllable: boolean;
  owner: string;
  place: Place | null;
  /** Whether the event is the expiry of a timer. */
  timer?: boolean;
  inputs: Input[];
  kept: Beside[];
}

export interface Requirement {
  event: string;
  name: string;
  text: string;
  place: Place | null;
}

export interface Finding {
  message: string;
  hint: string;
  /** Whether it is a consequence of a finding before it. */
  follows: boolean;
  place: Place | null;
}

export interface Endpoint {
  name: string;
  kind: string;
  direction: "in" | "out" | "both";
  types: string[];
  uses: string[];
}

export interface Description {
  robot: string;
  /** Source of the moments in words: a simulation, a log, a counterexample. */
  source: string;
  /** Number of the moment that violates a property. */
  violation: number | null;
  /** The names of all robots on the server. */
  robots?: string[];
  /** Whether the server accepts actions. */
  acts?: boolean;
  automata: Automaton[];
  events: Record<string, Event>;
  commands: string[];
  requirements: Requirement[];
  properties: Requirement[];
  findings: Finding[];
  communication: Endpoint[];
  files: { name: string; lines: [string, string][][] }[];
}

export interface Verdict {
  by: string;
  reason: string;
}

export interface Moment {
  time: number;
  event?: string;
  words?: string;
  data?: Record<string, unknown>;
  by?: string;
  reason?: string;
  transitions?: [number, number][];
  state: Record<string, Value>;
  commands: Record<string, Verdict | null>;
  enabled: Record<string, boolean>;
  timers: Record<string, number | false>;
  /** Whether the moment contains the complete state instead of changes. */
  whole?: boolean;
}

export interface Explanation {
  allowed: boolean;
  notes: string[];
  otherwise: string;
  changes: string[];
  way: string;
}

export interface Exported {
  description: Description;
  moments: Moment[];
}
