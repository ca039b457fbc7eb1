// Tests of the debugger with the test client for debug adapters of VS Code: `npm test`.
// The environment variable ROBOSC contains the command line of the tool; default: `robosc`.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { DebugClient } from "@vscode/debugadapter-testsupport";

const at = (name) => fileURLToPath(new URL(name, import.meta.url));
const program = at("cart.rscd");
const text = readFileSync(program, "utf8").split("\n");
const line = (begin) => 1 + text.findIndex((one) => one.trimStart().startsWith(begin));
const launched = { type: "robosc", request: "launch", program, script: at("cart.script"), stopOnEntry: false };

const client = new DebugClient(process.env.ROBOSC ?? "robosc", "dap", "robosc", { shell: true });
client.defaultTimeout = 120_000;

async function children(reference) {
  const { body } = await client.variablesRequest({ variablesReference: reference });
  return new Map(body.variables.map((one) => [one.name, one]));
}

before(() => client.start());
after(() => client.stop());

test("the debugger stops when a requirement forbids a command, and shows the reason", async () => {
  const requirement = line("requirement Passage");
  // The breakpoint is at the requirement. The robot stops at the transition after which the requirement forbids its command.
  await client.hitBreakpoint(launched, { path: program, line: requirement }, { path: program, line: line("on response from weight if value >") });
  const { body } = await client.scopesRequest({ frameId: 1 });
  const scopes = new Map(body.scopes.map((scope) => [scope.name, scope.variablesReference]));
  assert.equal((await children(scopes.get("Components"))).get("Load").value, "heavy");
  const drive = (await children(scopes.get("Cannot happen"))).get("message_drive.c_trigger");
  assert.match(drive.value, /forbidden by requirement Passage/);
  const reasons = await children(drive.variablesReference);
  assert.ok([...reasons.keys()].includes(`cart.rscd:${requirement}:3`), [...reasons.keys()].join());
});

test("the console performs an event, and a step back undoes it", async () => {
  const asked = { expression: 'message_weight.u_response {"value": 5.0}', context: "repl" };
  const moved = client.waitForEvent("stopped");
  await client.evaluateRequest(asked);
  await moved;
  assert.equal((await client.evaluateRequest({ expression: "Load", context: "repl" })).body.result, "light");
  const back = client.waitForEvent("stopped");
  await client.stepBackRequest({ threadId: 1 });
  await back;
  assert.equal((await client.evaluateRequest({ expression: "Load", context: "repl" })).body.result, "heavy");
});

test("the script continues to its end", async () => {
  const refused = client.waitForEvent("stopped");
  await client.continueRequest({ threadId: 1 });
  assert.equal((await refused).body.reason, "exception");
  const ended = client.waitForEvent("terminated");
  await client.continueRequest({ threadId: 1 });
  await ended;
});
