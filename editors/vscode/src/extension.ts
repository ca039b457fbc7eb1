// RoboSC in VS Code: an adapter to `robosc lsp`, `robosc dap` and the commands of the tool.

import { dirname } from "node:path";
import * as vscode from "vscode";
import { LanguageClient, type LanguageClientOptions } from "vscode-languageclient/node";
import { Diagrams } from "./diagram";
import { Tasks, definitionFor, taskFor } from "./tasks";
import { findTool, needTool, printed, searched, setUp } from "./tool";

const targets = ["ros2", "ros1", "supervisor", "cif", "ros2-layer", "xmi"];

let client: LanguageClient | undefined;
/** The last start of the language server. The next start waits for it. */
let serving: Promise<void> = Promise.resolve();

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const diagrams = new Diagrams();
  const answers = vscode.window.createOutputChannel("RoboSC answers");
  const commands: Record<string, () => unknown> = {
    "robosc.synthesize": () => onModel(context, (tool, file) => start(tool, "synthesize", file)),
    "robosc.verify": () => onModel(context, (tool, file) => start(tool, "verify", file)),
    "robosc.transform": () => onModel(context, transform),
    "robosc.run": () => onModel(context, run),
    "robosc.explain": () => onModel(context, (tool, file, editor) => explain(tool, file, editor, answers)),
    "robosc.diagram": () => onModel(context, (tool, file) => diagrams.show(tool, file)),
    "robosc.debug": () => onModel(context, (_tool, file) => debug(file)),
    "robosc.chooseLibraryFolder": () => chooseLibraryFolder(),
    "robosc.setUp": async () => (await setUp(context)) !== null && (await serve(context)),
    "robosc.restart": () => serve(context),
  };
  context.subscriptions.push(
    answers,
    ...Object.entries(commands).map(([name, command]) => vscode.commands.registerCommand(name, command)),
    vscode.tasks.registerTaskProvider("robosc", new Tasks(context)),
    vscode.debug.registerDebugAdapterDescriptorFactory("robosc", {
      async createDebugAdapterDescriptor() {
        const tool = await needTool(context);
        return tool === null ? undefined : new vscode.DebugAdapterExecutable(tool, ["dap"]);
      },
    }),
    vscode.debug.registerDebugConfigurationProvider("robosc", {
      // F5 in a workspace without a launch.json.
      resolveDebugConfiguration: (_folder, configuration) =>
        configuration.type ? configuration : configurationFor("${file}"),
    }),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("robosc")) {
        void serve(context);
      }
    }),
  );
  await serve(context);
}

export async function deactivate(): Promise<void> {
  await serving.catch(() => undefined);
  await client?.stop();
}

/** Starts or restarts the language server after all pending starts. */
function serve(context: vscode.ExtensionContext): Promise<void> {
  serving = serving.then(
    () => restart(context),
    () => restart(context),
  );
  return serving;
}

async function restart(context: vscode.ExtensionContext): Promise<void> {
  await client?.stop();
  client = undefined;
  const tool = await needTool(context);
  if (tool === null) {
    return;
  }
  const set = vscode.workspace.getConfiguration("robosc");
  const options: LanguageClientOptions = {
    documentSelector: [{ language: "robosc" }],
    initializationOptions: {
      libraryPaths: set.get("libraryPaths", []),
      interfacePaths: set.get("interfacePaths", []),
      commands: true,
    },
    middleware: {
      // The server would lose the folder at the end of the session, so it goes to the settings; their change restarts the server.
      executeCommand: (command, parameters, next) =>
        command === "robosc.addLibraryFolder"
          ? addLibraryFolder(vscode.Uri.parse(String(parameters[0])))
          : next(command, parameters),
    },
  };
  client = new LanguageClient("robosc", "RoboSC", { command: tool, args: ["lsp"] }, options);
  await client.start().catch((error: unknown) => {
    const hint = "`pip install 'robosc[editor]'` installs what the language server needs.";
    void vscode.window.showErrorMessage(`${tool} lsp did not start: ${String(error)}. ${hint}`);
  });
}

/** Saves the model in the active editor and calls a function with it. */
async function onModel(
  context: vscode.ExtensionContext,
  action: (tool: string, file: vscode.Uri, editor: vscode.TextEditor) => unknown,
): Promise<void> {
  const editor = vscode.window.activeTextEditor;
  if (editor?.document.languageId !== "robosc") {
    void vscode.window.showInformationMessage("Open a model, a .rscd file, first.");
    return;
  }
  const tool = (await findTool(context)) ?? (await needTool(context));
  if (tool !== null && (await editor.document.save())) {
    await action(tool, editor.document.uri, editor);
  }
}

async function start(tool: string, command: string, file: vscode.Uri, options: string[] = []): Promise<void> {
  await vscode.tasks.executeTask(taskFor(tool, ...definitionFor(command, file, options)));
}

async function transform(tool: string, file: vscode.Uri): Promise<void> {
  const chosen = await vscode.window.showQuickPick(targets, { canPickMany: true, title: "What is generated" });
  if (chosen !== undefined && chosen.length > 0) {
    await start(tool, "transform", file, ["--to", chosen.join(",")]);
  }
}

/** Runs the controller as a node until the task ends. */
async function run(tool: string, file: vscode.Uri): Promise<void> {
  await start(tool, "run", file, []);
}

async function addLibraryFolder(folder: vscode.Uri): Promise<void> {
  const set = vscode.workspace.getConfiguration("robosc");
  const folders = set.get<string[]>("libraryPaths", []);
  if (!folders.includes(folder.fsPath)) {
    const target = vscode.workspace.workspaceFolders
      ? vscode.ConfigurationTarget.Workspace
      : vscode.ConfigurationTarget.Global;
    await set.update("libraryPaths", [...folders, folder.fsPath], target);
  }
}

async function chooseLibraryFolder(): Promise<void> {
  const title = "Where else libraries are looked for";
  const [folder] = (await vscode.window.showOpenDialog({ canSelectFolders: true, canSelectFiles: false, title })) ?? [];
  if (folder !== undefined) {
    await addLibraryFolder(folder);
  }
}

async function explain(
  tool: string,
  file: vscode.Uri,
  editor: vscode.TextEditor,
  answers: vscode.OutputChannel,
): Promise<void> {
  const range = editor.document.getWordRangeAtPosition(editor.selection.active);
  const value = range ? editor.document.getText(range) : "";
  const prompt = "An event: `move`, `Platform.move`, `drive.cancel`; with `, ` a state, as in `move, Door=open`";
  const asked = await vscode.window.showInputBox({ title: "Why can it not happen?", value, prompt });
  if (asked === undefined || asked === "") {
    return;
  }
  const [event, ...state] = asked.split(/,\s*/);
  const where = state.length > 0 ? ["--state", state.join(",")] : [];
  const options = ["explain", file.fsPath, "--event", event ?? "", ...where, ...searched(file)];
  answers.replace(await printed(tool, options, dirname(file.fsPath)).catch(String));
  answers.show(true);
}

function configurationFor(program: string): vscode.DebugConfiguration {
  return { type: "robosc", request: "launch", name: "Simulate", program, stopOnEntry: true };
}

async function debug(file: vscode.Uri): Promise<void> {
  await vscode.debug.startDebugging(vscode.workspace.getWorkspaceFolder(file), configurationFor(file.fsPath));
}
