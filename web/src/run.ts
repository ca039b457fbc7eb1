// The moments of a run; each says what has changed, and any of them can be looked at whole.

import type { Moment, Value, Verdict } from "./data";

export interface Whole {
  state: Map<string, Value>;
  commands: Map<string, Verdict | null>;
  enabled: Set<string>;
  timers: Map<string, number>;
}

/** From one moment that is kept whole to the next. */
const APART = 64;

export class Run {
  moments: Moment[] = [];
  private kept: Whole[] = [];
  private last: { number: number; whole: Whole } | null = null;

  /** Replaces all moments from a number on. */
  replace(from: number, moments: Moment[]): void {
    this.moments.length = from;
    this.kept.length = Math.min(this.kept.length, Math.ceil(from / APART));
    if (this.last !== null && this.last.number >= from) this.last = null;
    for (const moment of moments) this.moments.push(moment);
  }

  /** Everything at a moment. What it returns is not to be changed. */
  at(number: number): Whole {
    if (this.last !== null && this.last.number === number) return this.last.whole;
    const isNear = this.last !== null && this.last.number < number && number - this.last.number < APART;
    let from = isNear ? this.last!.number : this.keptBefore(number);
    const whole = isNear ? this.last!.whole : copy(this.kept[from / APART] ?? empty());
    if (!isNear && from === 0 && this.kept.length === 0) from = -1;
    for (let next = from + 1; next <= number; next++) {
      apply(whole, this.moments[next]!);
      if (next % APART === 0 && this.kept.length === next / APART) this.kept.push(copy(whole));
    }
    this.last = { number, whole };
    return whole;
  }

  private keptBefore(number: number): number {
    return Math.max(0, Math.min(Math.floor(number / APART), this.kept.length - 1)) * APART;
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
