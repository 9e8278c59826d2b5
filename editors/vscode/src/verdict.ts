/** The verdict of the shader in the active editor, in the status bar. */

import * as vscode from "vscode";
import { verdictOf } from "./text";

export class VerdictStatus implements vscode.Disposable {
    private readonly item: vscode.StatusBarItem;
    private readonly changes: vscode.Disposable;
    /** The title of the server's code lens with the verdict, by document. */
    private readonly titles = new Map<string, string>();

    constructor() {
        this.item = vscode.window.createStatusBarItem("toyproof.verdict", vscode.StatusBarAlignment.Left);
        this.item.name = "toyproof: verdict";
        this.item.command = "toyproof.watch";
        this.changes = vscode.Disposable.from(
            vscode.window.onDidChangeActiveTextEditor(() => {
                this.show();
            }),
            vscode.workspace.onDidCloseTextDocument((document) =>
                this.titles.delete(document.uri.toString()),
            ),
        );
    }

    /** Takes the verdict from the code lenses of a document. */
    update(document: vscode.Uri, lenses: readonly vscode.CodeLens[]): void {
        const titles = lenses.map((lens) => lens.command?.title ?? "");
        const title = titles.find((candidate) => verdictOf(candidate) !== undefined);
        if (title === undefined) this.titles.delete(document.toString());
        else this.titles.set(document.toString(), title);
        this.show();
    }

    /** Forgets all verdicts. */
    clear(): void {
        this.titles.clear();
        this.show();
    }

    dispose(): void {
        this.changes.dispose();
        this.item.dispose();
    }

    private show(): void {
        const active = vscode.window.activeTextEditor?.document.uri.toString() ?? "";
        const title = this.titles.get(active);
        const found = title === undefined ? undefined : verdictOf(title);
        if (title === undefined || found === undefined) {
            this.item.hide();
            return;
        }
        this.item.text = `$(${found.icon}) toyproof: ${found.verdict}`;
        this.item.tooltip = title;
        this.item.show();
    }
}
