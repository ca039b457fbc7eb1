// Tasks: commands of the tool on a model, with their findings in the Problems view.

import { relative } from "node:path";
import * as vscode from "vscode";
import { findTool, searched } from "./tool";

interface Definition extends vscode.TaskDefinition {
  command: string;
  model: string;
  options?: string[];
}

const defaults: ReadonlyArray<[string, string[]]> = [
  ["check", []],
  ["verify", []],
  ["transform", ["--to", "ros2"]],
];

/** The task that runs a command of the tool on a model. */
export function taskFor(tool: string, definition: Definition, folder: vscode.WorkspaceFolder | undefined): vscode.Task {
  const { command, model, options = [] } = definition;
  const file = folder ? vscode.Uri.joinPath(folder.uri, model) : vscode.Uri.file(model);
  const words = [command, model, ...options, ...searched(file)];
  const execution = new vscode.ProcessExecution(tool, words, folder ? { cwd: folder.uri.fsPath } : {});
  const task = new vscode.Task(
    definition,
    folder ?? vscode.TaskScope.Workspace,
    `${command} ${model}`,
    "robosc",
    execution,
    "$robosc",
  );
  task.presentationOptions = { clear: true, reveal: vscode.TaskRevealKind.Always };
  if (command === "transform") {
    task.group = vscode.TaskGroup.Build;
  }
  return task;
}

/** The definition of a command on a file, and the workspace folder of the file. */
export function definitionFor(
  command: string,
  file: vscode.Uri,
  options: string[] = [],
): [Definition, vscode.WorkspaceFolder | undefined] {
  const folder = vscode.workspace.getWorkspaceFolder(file);
  const model = folder ? relative(folder.uri.fsPath, file.fsPath) : file.fsPath;
  return [{ type: "robosc", command, model, options }, folder];
}

export class Tasks implements vscode.TaskProvider {
  constructor(private readonly context: vscode.ExtensionContext) {}

  async provideTasks(): Promise<vscode.Task[]> {
    const tool = await findTool(this.context);
    if (tool === null) {
      return [];
    }
    const files = await vscode.workspace.findFiles("**/*.rscd", "**/{build,node_modules,.venv}/**", 100);
    return files.flatMap((file) =>
      defaults.map(([command, options]) => taskFor(tool, ...definitionFor(command, file, options))),
    );
  }

  async resolveTask(task: vscode.Task): Promise<vscode.Task | undefined> {
    const tool = await findTool(this.context);
    const folder = typeof task.scope === "object" ? task.scope : undefined;
    return tool === null ? undefined : taskFor(tool, task.definition as Definition, folder);
  }
}
