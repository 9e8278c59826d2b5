/** The commands that run the program once: check, convert and explain. */

import * as path from "node:path";
import * as vscode from "vscode";
import type { Documents } from "./documents";
import { type Output, executable, requireProgram, run } from "./program";
import { baseFolder, checkArguments, languageArguments } from "./settings";
import { explainedCodes } from "./text";

/** The type of tasks, as in package.json. */
const TASK = "toyproof";

/** The shader in the active editor, saved to its file, since the program reads files. */
export async function activeShader(): Promise<vscode.Uri | undefined> {
    const document = vscode.window.activeTextEditor?.document;
    if (document?.languageId !== "glsl") {
        void vscode.window.showInformationMessage("The active editor has no GLSL shader.");
        return undefined;
    }
    const isSaved = !document.isUntitled && (!document.isDirty || (await document.save()));
    if (isSaved && document.uri.scheme === "file") return document.uri;
    void vscode.window.showInformationMessage("Save the shader to a file first.");
    return undefined;
}

/** A task that checks a shader or a folder. */
function checkTask(
    definition: vscode.TaskDefinition,
    shader: string,
    args: string[],
    folder: string,
): vscode.Task {
    const execution = new vscode.ProcessExecution(executable(), ["check", shader, ...args], { cwd: folder });
    const name = `check ${path.basename(shader)}`;
    const task = new vscode.Task(definition, vscode.TaskScope.Workspace, name, "toyproof", execution);
    task.presentationOptions = { clear: true, focus: false };
    return task;
}

/** Checks a shader in the terminal, where the whole result can be read. */
export async function check(shader: vscode.Uri): Promise<void> {
    if (!(await requireProgram())) return;
    const definition = { type: TASK, shader: shader.fsPath };
    await vscode.tasks.executeTask(
        checkTask(definition, shader.fsPath, checkArguments(shader), baseFolder(shader)),
    );
}

/** Completes tasks of `.vscode/tasks.json`. */
export const TASKS: vscode.TaskProvider = {
    provideTasks: () => [],
    resolveTask(task) {
        const { shader, arguments: args = [] } = task.definition;
        const folder = typeof task.scope === "object" ? task.scope : vscode.workspace.workspaceFolders?.[0];
        if (typeof shader !== "string" || !Array.isArray(args) || !folder) return undefined;
        // The same definition, as the editor requires.
        return checkTask(task.definition, shader, args.map(String), folder.uri.fsPath);
    },
};

/** Shows a shader as WGSL beside it. */
export async function convert(shader: vscode.Uri, documents: Documents): Promise<void> {
    if (!(await requireProgram())) return;
    const args = ["convert", shader.fsPath, ...languageArguments(shader)];
    const output = await runWithProgress("Converting to WGSL", args, shader);
    if (!output) return;
    if (output.code === 0) await documents.show(`${path.parse(shader.fsPath).name}.wgsl`, output.stdout);
    else await documents.show(`${path.basename(shader.fsPath)}: not converted.txt`, output.stderr);
}

/** Runs the program with a notification, by which it can be cancelled; returns nothing then. */
async function runWithProgress(
    title: string,
    args: string[],
    shader: vscode.Uri,
): Promise<Output | undefined> {
    const options = { location: vscode.ProgressLocation.Notification, title, cancellable: true };
    return vscode.window.withProgress(options, async (_progress, token) => {
        const output = await run(args, baseFolder(shader), token);
        return token.isCancellationRequested ? undefined : output;
    });
}

/** Explains a code, which the user chooses unless it is given. */
export async function explain(code: unknown, documents: Documents): Promise<void> {
    if (!(await requireProgram())) return;
    const chosen = typeof code === "string" ? code : await chooseCode();
    if (chosen === undefined) return;
    const output = await run(["explain", chosen], undefined);
    await documents.show(`${chosen}.txt`, output.stdout + output.stderr);
}

/** Offers all codes and mistakes, those at the cursor first. */
async function chooseCode(): Promise<string | undefined> {
    const { stdout } = await run(["explain", "--list"], undefined);
    const here = new Set(codesAtCursor());
    const items = explainedCodes(stdout).map(({ code, title }) => ({ label: code, description: title }));
    items.sort((a, b) => Number(here.has(b.label)) - Number(here.has(a.label)));
    const options = { title: "Explain a code or a mistake", matchOnDescription: true };
    return (await vscode.window.showQuickPick(items, options))?.label;
}

/** The codes of the diagnostics on the line of the cursor. */
function codesAtCursor(): string[] {
    const editor = vscode.window.activeTextEditor;
    if (!editor) return [];
    const line = editor.document.lineAt(editor.selection.active.line).range;
    return vscode.languages
        .getDiagnostics(editor.document.uri)
        .filter(({ range }) => range.intersection(line) !== undefined)
        .flatMap(({ code }) => {
            const value = typeof code === "object" ? code.value : code;
            return value === undefined ? [] : [String(value)];
        });
}
