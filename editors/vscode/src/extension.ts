/** The extension: a language client, a debugger and commands around the program `toyproof`. */

import * as vscode from "vscode";
import { TASKS, activeShader, check, convert, explain } from "./commands";
import { debugShader, registerDebugger, requestPixel } from "./debugger";
import { Documents } from "./documents";
import { Server } from "./server";
import { VerdictStatus } from "./verdict";
import { WatchPanels } from "./watch";

let server: Server | undefined;

/** Called by the editor when the extension is first needed. */
export async function activate(context: vscode.ExtensionContext): Promise<void> {
    const channel = vscode.window.createOutputChannel("toyproof", { log: true });
    const status = new VerdictStatus();
    const documents = new Documents();
    const panels = new WatchPanels(channel);
    const started = new Server(channel, status);
    server = started;

    /** A command for the shader in the active editor, or one that a menu names. */
    const ofShader = (name: string, action: (shader: vscode.Uri) => Promise<void>) =>
        vscode.commands.registerCommand(`toyproof.${name}`, async () => {
            const shader = await activeShader();
            if (shader) await action(shader);
        });
    context.subscriptions.push(
        channel,
        status,
        documents,
        panels,
        started,
        registerDebugger(),
        vscode.tasks.registerTaskProvider("toyproof", TASKS),
        vscode.workspace.onDidChangeConfiguration((event) => started.changeSettings(event)),
        ofShader("watch", (shader) => panels.show(shader)),
        ofShader("checkShader", async (shader) => {
            await started.command("toyproof.check", shader.toString());
        }),
        ofShader("checkInTerminal", check),
        ofShader("debug", debugShader),
        ofShader("convert", (shader) => convert(shader, documents)),
        ofShader("showPixel", async (shader) => {
            const pixel = await requestPixel();
            if (pixel) await started.command("toyproof.debugPixel", shader.toString(), ...pixel);
        }),
        ofShader("hidePixel", async (shader) => {
            await started.command("toyproof.debugPixel", shader.toString(), null);
        }),
        vscode.commands.registerCommand("toyproof.explainCode", (code) => explain(code, documents)),
        vscode.commands.registerCommand("toyproof.restart", () => started.restart()),
    );
    await started.restart();
}

/** Called by the editor before it ends; the server ends before the editor does. */
export async function deactivate(): Promise<void> {
    await server?.stop();
}
