// The debugger, driven by the client that the debug adapters of VS Code themselves are tested with: `npm test`.
// ROBOSC is the command line of the tool, if that is not `robosc`.

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

test("it stops where a requirement begins to forbid, and says why", async () => {
  const requirement = line("requirement Passage");
  // The breakpoint is at the requirement, the robot stops at the transition that makes it forbid.
  await client.hitBreakpoint(launched, { path: program, line: requirement }, { path: program, line: line("on response from weight if value >") });
  const { body } = await client.scopesRequest({ frameId: 1 });
  const scopes = new Map(body.scopes.map((scope) => [scope.name, scope.variablesReference]));
  assert.equal((await children(scopes.get("Components"))).get("Load").value, "heavy");
  const drive = (await children(scopes.get("Cannot happen"))).get("message_drive.c_trigger");
  assert.match(drive.value, /forbidden by requirement Passage/);
  const reasons = await children(drive.variablesReference);
  assert.ok([...reasons.keys()].includes(`cart.rscd:${requirement}:3`), [...reasons.keys()].join());
});

test("what the console asks for happens, and is taken back", async () => {
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

test("the script goes on to its end", async () => {
  const refused = client.waitForEvent("stopped");
  await client.continueRequest({ threadId: 1 });
  assert.equal((await refused).body.reason, "exception");
  const ended = client.waitForEvent("terminated");
  await client.continueRequest({ threadId: 1 });
  await ended;
});
