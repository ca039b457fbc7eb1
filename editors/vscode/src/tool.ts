// Search for the robosc command, and its installation.

import { execFile } from "node:child_process";
import { access, constants } from "node:fs/promises";
import { delimiter, join } from "node:path";
import { promisify } from "node:util";
import * as vscode from "vscode";

const run = promisify(execFile);
const windows = process.platform === "win32";
const programs = windows ? "Scripts" : "bin";
const executable = windows ? "robosc.exe" : "robosc";

function settings(): vscode.WorkspaceConfiguration {
  return vscode.workspace.getConfiguration("robosc");
}

async function executes(path: string): Promise<boolean> {
  return access(path, constants.X_OK).then(
    () => true,
    () => false,
  );
}

function ownEnvironment(context: vscode.ExtensionContext): string {
  return join(context.globalStorageUri.fsPath, "venv");
}

/** The command from the settings, a `.venv` in the workspace, the PATH, or an earlier setup, in this order; else null. */
export async function findTool(context: vscode.ExtensionContext): Promise<string | null> {
  const set = settings().get<string>("path", "");
  if (set) {
    return set;
  }
  const folders = vscode.workspace.isTrusted ? (vscode.workspace.workspaceFolders ?? []) : [];
  const places = [
    ...folders.map((folder) => join(folder.uri.fsPath, ".venv", programs)),
    ...(process.env["PATH"] ?? "").split(delimiter).filter(Boolean),
    join(ownEnvironment(context), programs),
  ];
  for (const place of places) {
    if (await executes(join(place, executable))) {
      return join(place, executable);
    }
  }
  return null;
}

/** The command as in `findTool`. If there is none, offers to set one up. */
export async function needTool(context: vscode.ExtensionContext): Promise<string | null> {
  const found = await findTool(context);
  if (found !== null) {
    return found;
  }
  const answer = await vscode.window.showWarningMessage(
    "RoboSC's Python package was not found. It can be installed for this editor alone.",
    "Set Up",
    "Choose a Command",
  );
  if (answer === "Set Up") {
    return setUp(context);
  }
  if (answer === "Choose a Command") {
    await vscode.commands.executeCommand("workbench.action.openSettings", "robosc.path");
  }
  return null;
}

/** Installs the package into the extension's own environment. Returns the command, or null on failure. */
export async function setUp(context: vscode.ExtensionContext): Promise<string | null> {
  const place = ownEnvironment(context);
  const python = join(place, programs, windows ? "python.exe" : "python");
  const title = "Setting up RoboSC";
  return vscode.window.withProgress({ location: vscode.ProgressLocation.Notification, title }, async (progress) => {
    try {
      await vscode.workspace.fs.createDirectory(context.globalStorageUri);
      progress.report({ message: "an environment for Python" });
      await run(windows ? "py" : "python3", ["-m", "venv", place]);
      progress.report({ message: "the package" });
      await run(python, ["-m", "pip", "install", "--upgrade", settings().get("package", "robosc[editor]")]);
      return join(place, programs, executable);
    } catch (error) {
      const text = error instanceof Error ? error.message : String(error);
      void vscode.window.showErrorMessage(`RoboSC could not be set up; it needs Python 3.11 or newer. ${text}`);
      return null;
    }
  });
}

/** The options with the search paths for libraries and ROS packages of a file. */
export function searched(file?: vscode.Uri): string[] {
  const set = vscode.workspace.getConfiguration("robosc", file ?? null);
  return [
    ...set.get<string[]>("libraryPaths", []).flatMap((folder) => ["-I", folder]),
    ...set.get<string[]>("interfacePaths", []).flatMap((folder) => ["--interface-path", folder]),
  ];
}

/** The output of the tool with any exit status. Rejects if the tool cannot start. */
export async function printed(tool: string, options: string[], folder: string): Promise<string> {
  return new Promise((resolve, reject) => {
    execFile(tool, options, { cwd: folder, maxBuffer: 64 * 1024 * 1024 }, (error, output, errors) => {
      if (error && typeof error.code !== "number") {
        reject(error);
      } else {
        resolve(output || errors);
      }
    });
  });
}
