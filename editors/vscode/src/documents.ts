/** Texts that commands of the program print, as documents that cannot be edited. */

import * as vscode from "vscode";

const SCHEME = "toyproof";

export class Documents implements vscode.TextDocumentContentProvider, vscode.Disposable {
    private readonly texts = new Map<string, string>();
    private readonly changes = new vscode.EventEmitter<vscode.Uri>();
    private readonly registrations: vscode.Disposable;

    readonly onDidChange = this.changes.event;

    constructor() {
        this.registrations = vscode.Disposable.from(
            vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
            vscode.workspace.onDidCloseTextDocument(({ uri }) => this.texts.delete(uri.path)),
            this.changes,
        );
    }

    provideTextDocumentContent(uri: vscode.Uri): string {
        return this.texts.get(uri.path) ?? "";
    }

    /** Shows a text beside the active editor; replaces the text if a document with this path is open. */
    async show(path: string, text: string): Promise<void> {
        const uri = vscode.Uri.from({ scheme: SCHEME, path: `/${path}` });
        this.texts.set(uri.path, text);
        this.changes.fire(uri);
        const document = await vscode.workspace.openTextDocument(uri);
        const column = vscode.ViewColumn.Beside;
        await vscode.window.showTextDocument(document, {
            viewColumn: column,
            preserveFocus: true,
            preview: true,
        });
    }

    dispose(): void {
        this.registrations.dispose();
    }
}
