/** The page of `toyproof watch` as a panel beside the shader. */

import { type ChildProcessWithoutNullStreams, spawn } from "node:child_process";
import { randomBytes } from "node:crypto";
import { createInterface } from "node:readline";
import * as path from "node:path";
import * as vscode from "vscode";
import { executable, requireProgram } from "./program";
import { baseFolder, checkArguments } from "./settings";
import { escapeHtml, lastLines, watchAddress } from "./text";

/** How much of the program's messages the panel shows after its end, in characters. */
const MAX_MESSAGE = 2000;

/** The open panels: one for each shader. */
export class WatchPanels implements vscode.Disposable {
    private readonly panels = new Map<string, WatchPanel>();

    constructor(private readonly channel: vscode.LogOutputChannel) {}

    /** Shows the panel of a shader, and starts its process unless it runs. */
    async show(shader: vscode.Uri): Promise<void> {
        const key = shader.toString();
        const open = this.panels.get(key);
        if (open) {
            open.reveal();
        } else if (await requireProgram()) {
            const panel = new WatchPanel(shader, this.channel, () => this.panels.delete(key));
            this.panels.set(key, panel);
        }
    }

    /** Closes all panels and ends their processes. */
    dispose(): void {
        for (const panel of this.panels.values()) panel.close();
    }
}

class WatchPanel {
    private readonly panel: vscode.WebviewPanel;
    private process: ChildProcessWithoutNullStreams | undefined;
    /** The last lines on standard error. */
    private messages = "";

    constructor(
        private readonly shader: vscode.Uri,
        private readonly channel: vscode.LogOutputChannel,
        whenClosed: () => void,
    ) {
        this.panel = vscode.window.createWebviewPanel(
            "toyproof.watch",
            `Image of ${path.basename(shader.fsPath)}`,
            { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
            // Without scripts, the sandbox of the panel would also forbid those of the page in it. A hidden
            // panel keeps its page, so that a shader with feedback does not start again.
            { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [] },
        );
        this.panel.onDidDispose(() => {
            this.end();
            whenClosed();
        });
        this.panel.webview.onDidReceiveMessage((message) => {
            if (message === "restart") this.start();
        });
        this.start();
    }

    reveal(): void {
        this.panel.reveal(undefined, true);
        if (!this.process) this.start();
    }

    close(): void {
        this.panel.dispose();
    }

    private start(): void {
        this.end();
        this.messages = "";
        this.show("<p>Starting…</p>");
        const args = ["watch", this.shader.fsPath, ...checkArguments(this.shader)];
        const child = spawn(executable(), args, { cwd: baseFolder(this.shader) });
        this.process = child;
        // The first line is the address; later ones are read too, so that the pipe does not fill.
        const lines = createInterface({ input: child.stdout });
        lines.once("line", (line) => {
            void this.showPage(child, line);
        });
        child.stderr.setEncoding("utf8").on("data", (text: string) => {
            this.channel.info(text.trimEnd());
            this.messages = lastLines(this.messages + text, MAX_MESSAGE);
        });
        child.on("error", (error) => {
            this.messages += error.message;
        });
        // After all output was read, also if the process could not be started.
        child.on("close", (code) => {
            if (this.process === child) {
                this.process = undefined;
                this.showEnd(code);
            }
        });
    }

    private end(): void {
        const child = this.process;
        this.process = undefined;
        child?.kill();
    }

    private async showPage(child: ChildProcessWithoutNullStreams, line: string): Promise<void> {
        const address = watchAddress(line);
        if (!address) {
            this.messages += `toyproof watch printed no address: ${line}`;
            child.kill();
            return;
        }
        // For a remote machine, the editor forwards the port. In a browser it would offer a proxy with another
        // host name, which the program refuses; the address itself is right if the browser runs here.
        const isDesktop = vscode.env.uiKind === vscode.UIKind.Desktop;
        const uri = vscode.Uri.parse(address.href, true);
        const source = (isDesktop ? await vscode.env.asExternalUri(uri) : uri).toString(true);
        if (this.process !== child) return;
        this.show(
            `<iframe title="The image of the shader" src="${escapeHtml(source)}"></iframe>`,
            new URL(source),
        );
    }

    private showEnd(code: number | null): void {
        const reason = code === null ? "was ended by a signal" : `ended with exit code ${code}`;
        this.show(
            `<p>toyproof watch ${reason}.</p>
<pre>${escapeHtml(this.messages)}</pre>
<button>Start again</button>`,
        );
    }

    /** Shows a body, which may embed pages of one address only. */
    private show(body: string, embedded?: URL): void {
        const nonce = randomBytes(16).toString("hex");
        const policy = [
            "default-src 'none'",
            `style-src 'nonce-${nonce}'`,
            `script-src 'nonce-${nonce}'`,
            `frame-src ${embedded ? embedded.origin : "'none'"}`,
        ].join("; ");
        this.panel.webview.html = `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<style nonce="${nonce}">
    html, body { height: 100%; margin: 0; padding: 0; }
    body > p, body > pre, body > button { margin: 1em; }
    pre { white-space: pre-wrap; }
    iframe { display: block; width: 100%; height: 100%; border: 0; }
</style>
</head>
<body>
${body}
<script nonce="${nonce}">
    const editor = acquireVsCodeApi();
    document.querySelector("button")?.addEventListener("click", () => editor.postMessage("restart"));
</script>
</body>
</html>`;
    }
}
