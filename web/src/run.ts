// The moments of a run. Each contains changes; `at` returns the complete state of a moment.

import type { Moment, Value, Verdict } from "./data";

export interface Whole {
  state: Map<string, Value>;
  commands: Map<string, Verdict | null>;
  enabled: Set<string>;
  timers: Map<string, number>;
}

/** Verdict on a command: allowed, forbidden, or the robot is not ready for it. */
export function verdictOf(verdict: Verdict | null): "allowed" | "forbidden" | "unready" {
  return verdict === null ? "allowed" : verdict.by === "plant" ? "unready" : "forbidden";
}

/** Number of moments between two stored complete states. */
const APART = 64;
/** Greatest number of stored moments of a running robot. A simulation is shorter, so that all its steps can be undone. */
export const MOST = 40_000;

/**
 * The stored moments of a run. Above the limit, the older half is deleted.
 *
 * The number of a moment counts from the beginning of the run, including deleted moments.
 */
export class Run {
  first = 0;
  private moments: Moment[] = [];
  private kept: Whole[] = [];
  private last: { index: number; whole: Whole } | null = null;
  private readonly most: number;

  constructor(most = Infinity) {
    this.most = most;
  }

  get end(): number {
    return this.first + this.moments.length - 1;
  }

  moment(number: number): Moment {
    return this.moments[number - this.first]!;
  }

  /** Replaces all moments from a number on. Deletes earlier moments if there is a gap. */
  replace(from: number, moments: Moment[]): void {
    if (from < this.first || from > this.end + 1) {
      this.clear([]);
      this.first = from;
    }
    const length = from - this.first;
    this.moments.length = length;
    this.kept.length = Math.min(this.kept.length, Math.ceil(length / APART));
    if (this.last !== null && this.last.index >= length) this.last = null;
    for (const moment of moments) this.moments.push(moment);
    if (this.moments.length > this.most) this.forget(this.moments.length - (this.most >> 1));
  }

  /** The complete state at a moment. The caller must not change it. */
  at(number: number): Whole {
    const index = number - this.first;
    if (this.last !== null && this.last.index === index) return this.last.whole;
    const isNear = this.last !== null && this.last.index < index && index - this.last.index < APART;
    let from = isNear ? this.last!.index : this.keptBefore(index);
    const whole = isNear ? this.last!.whole : copy(this.kept[from / APART] ?? empty());
    if (!isNear && from === 0 && this.kept.length === 0) from = -1;
    for (let next = from + 1; next <= index; next++) {
      apply(whole, this.moments[next]!);
      if (next % APART === 0 && this.kept.length === next / APART) this.kept.push(copy(whole));
    }
    this.last = { index, whole };
    return whole;
  }

  private keptBefore(index: number): number {
    return Math.max(0, Math.min(Math.floor(index / APART), this.kept.length - 1)) * APART;
  }

  private clear(moments: Moment[]): void {
    this.moments = moments;
    this.kept = [];
    this.last = null;
  }

  private forget(number: number): void {
    const whole = this.at(this.first + number);
    const oldest: Moment = {
      ...this.moments[number]!,
      whole: true,
      state: Object.fromEntries(whole.state),
      commands: Object.fromEntries(whole.commands),
      enabled: Object.fromEntries([...whole.enabled].map((event) => [event, true])),
      timers: Object.fromEntries(whole.timers),
    };
    this.clear([oldest, ...this.moments.slice(number + 1)]);
    this.first += number;
  }
}

function empty(): Whole {
  return { state: new Map(), commands: new Map(), enabled: new Set(), timers: new Map() };
}

function copy(whole: Whole): Whole {
  return {
    state: new Map(whole.state),
    commands: new Map(whole.commands),
    enabled: new Set(whole.enabled),
    timers: new Map(whole.timers),
  };
}

function apply(whole: Whole, moment: Moment): void {
  if (moment.whole === true) {
    whole.state.clear();
    whole.commands.clear();
    whole.enabled.clear();
    whole.timers.clear();
  }
  for (const [name, value] of Object.entries(moment.state)) whole.state.set(name, value);
  for (const [name, verdict] of Object.entries(moment.commands)) whole.commands.set(name, verdict);
  for (const [name, can] of Object.entries(moment.enabled)) {
    if (can) whole.enabled.add(name);
    else whole.enabled.delete(name);
  }
  for (const [name, left] of Object.entries(moment.timers)) {
    if (left === false) whole.timers.delete(name);
    else whole.timers.set(name, left);
  }
}
