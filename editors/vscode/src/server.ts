/** The language server, `toyproof lsp`: started, restarted and stopped. */

import * as vscode from "vscode";
import { DidChangeConfigurationNotification, LanguageClient, State } from "vscode-languageclient/node";
import { executable, requireProgram } from "./program";
import type { VerdictStatus } from "./verdict";

/** Files other than open documents that diagnostics depend on: tabs, includes, projects and assignments. */
const WATCHED = "**/*.{glsl,frag,fs,vert,shadertoy,toml,json}";

/** All settings of the extension; the server ignores those that it does not read. */
function serverSettings(): unknown {
    return vscode.workspace.getConfiguration().get("toyproof");
}

export class Server implements vscode.Disposable {
    private client: LanguageClient | undefined;
    /** The last start or stop: they run one after another. */
    private pending = Promise.resolve();
    private readonly files = vscode.workspace.createFileSystemWatcher(WATCHED);

    constructor(
        private readonly channel: vscode.LogOutputChannel,
        private readonly status: VerdictStatus,
    ) {}

    /** Starts the server, after the running one has ended. */
    restart(): Promise<void> {
        return this.after(async () => {
            await this.end();
            if (await requireProgram()) await this.start();
        });
    }

    stop(): Promise<void> {
        return this.after(() => this.end());
    }

    dispose(): void {
        void this.stop();
        this.files.dispose();
    }

    /** Sends the settings; the path of the executable takes effect by a new start. */
    async changeSettings(event: vscode.ConfigurationChangeEvent): Promise<void> {
        if (event.affectsConfiguration("toyproof.path")) {
            await this.restart();
        } else if (event.affectsConfiguration("toyproof") && this.client?.state === State.Running) {
            const settings = { toyproof: serverSettings() };
            await this.client.sendNotification(DidChangeConfigurationNotification.type, { settings });
        }
    }

    /** Runs a command of the server. */
    async command(name: string, ...args: unknown[]): Promise<unknown> {
        if (this.client?.state !== State.Running) {
            throw new Error("The language server does not run.");
        }
        return this.client.sendRequest("workspace/executeCommand", { command: name, arguments: args });
    }

    private after(step: () => Promise<void>): Promise<void> {
        this.pending = this.pending.then(step).catch((error: unknown) => {
            this.channel.error(String(error));
        });
        return this.pending;
    }

    private async start(): Promise<void> {
        // It starts the server again after a crash, but not after the fifth within three minutes.
        this.client = new LanguageClient(
            "toyproof",
            "toyproof",
            { command: executable(), args: ["lsp"] },
            {
                documentSelector: [
                    { scheme: "file", language: "glsl" },
                    { scheme: "untitled", language: "glsl" },
                ],
                initializationOptions: serverSettings,
                outputChannel: this.channel,
                synchronize: { fileEvents: this.files },
                middleware: {
                    provideCodeLenses: async (document, token, next) => {
                        const lenses = await next(document, token);
                        this.status.update(document.uri, lenses ?? []);
                        return lenses;
                    },
                },
            },
        );
        await this.client.start();
    }

    private async end(): Promise<void> {
        const client = this.client;
        this.client = undefined;
        this.status.clear();
        await client?.dispose();
    }
}
