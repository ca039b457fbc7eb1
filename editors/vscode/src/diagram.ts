// The diagram of a model beside its text, redrawn on save.

import { dirname } from "node:path";
import * as vscode from "vscode";
import { printed, searched } from "./tool";

const kinds = ["behaviour", "ros-graph", "plants"];

export class Diagrams {
  private readonly panels = new Map<string, vscode.WebviewPanel>();

  async show(tool: string, file: vscode.Uri): Promise<void> {
    const kind = await vscode.window.showQuickPick(kinds, { title: "What is drawn" });
    if (kind === undefined) {
      return;
    }
    const key = `${kind} ${file}`;
    let panel = this.panels.get(key);
    if (panel === undefined) {
      const title = `${file.path.split("/").at(-1)}: ${kind}`;
      panel = vscode.window.createWebviewPanel("robosc.diagram", title, vscode.ViewColumn.Beside, {});
      const saved = vscode.workspace.onDidSaveTextDocument((document) => {
        if (document.uri.toString() === file.toString()) {
          void this.draw(key, tool, file, kind);
        }
      });
      panel.onDidDispose(() => {
        saved.dispose();
        this.panels.delete(key);
      });
      this.panels.set(key, panel);
    }
    panel.reveal(undefined, true);
    await this.draw(key, tool, file, kind);
  }

  private async draw(key: string, tool: string, file: vscode.Uri, kind: string): Promise<void> {
    const options = ["diagram", file.fsPath, "--kind", kind, "--format", "svg", ...searched(file)];
    const text = await printed(tool, options, dirname(file.fsPath)).catch(String);
    const panel = this.panels.get(key);
    // If the text has errors, the previous picture remains.
    if (panel !== undefined && (text.startsWith("<svg") || panel.webview.html === "")) {
      panel.webview.html = page(text);
    }
  }
}

/** The picture as an image, which cannot run scripts or load files. Any other output is shown as text. */
function page(text: string): string {
  const policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
  const shown = text.startsWith("<svg")
    ? `<img alt="diagram" src="data:image/svg+xml;base64,${Buffer.from(text).toString("base64")}">`
    : `<pre>${text.replace(/[&<>"']/g, (character) => `&#${character.charCodeAt(0)};`)}</pre>`;
  return `<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<style>body { background: white; color: black } img { max-width: 100% }</style></head><body>${shown}</body></html>`;
}
