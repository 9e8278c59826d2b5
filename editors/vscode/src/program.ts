/** The executable `toyproof`: where it is, and how it is run. */

import { type ChildProcess, execFile } from "node:child_process";
import { homedir } from "node:os";
import * as path from "node:path";
import * as vscode from "vscode";

/** The longest output that is read, in bytes: that of a converted shader. */
const MAX_OUTPUT = 64 << 20;

/** The result of a run. */
export interface Output {
    /** The exit code; null if a signal ended the program. */
    code: number | null;
    stdout: string;
    stderr: string;
}

/** The path of the executable, or its name if it is to be found on the search path. */
export function executable(): string {
    const configured = vscode.workspace.getConfiguration("toyproof").get<string>("path", "").trim();
    if (configured === "") return "toyproof";
    return /^~[/\\]/.test(configured) ? path.join(homedir(), configured.slice(2)) : configured;
}

/**
 * Runs the program to its end.
 *
 * Rejects only if it cannot be started.
 */
export function run(
    args: string[],
    folder: string | undefined,
    token?: vscode.CancellationToken,
): Promise<Output> {
    return new Promise((resolve, reject) => {
        const options = { cwd: folder, maxBuffer: MAX_OUTPUT };
        const child: ChildProcess = execFile(executable(), args, options, (error, stdout, stderr) => {
            // A string is the code of an error of the operating system: the program did not start.
            if (typeof error?.code === "string")
                reject(Object.assign(new Error(error.message), { code: error.code }));
            else resolve({ code: child.exitCode, stdout, stderr });
        });
        token?.onCancellationRequested(() => child.kill());
    });
}

/** Returns whether the program can be started; otherwise reports why not, and offers what helps. */
export async function requireProgram(): Promise<boolean> {
    try {
        await run(["--version"], undefined);
        return true;
    } catch (error) {
        // Not awaited: the message may stay for as long as the user likes.
        void reportMissing(error);
        return false;
    }
}

async function reportMissing(error: unknown): Promise<void> {
    const program = executable();
    const place = program === "toyproof" ? "on the search path" : `at ${program}`;
    const isMissing = error instanceof Error && "code" in error && error.code === "ENOENT";
    const reason = isMissing ? "was not found" : "cannot be started";
    const choose = "Choose the Executable…";
    const settings = "Open the Settings";
    const answer = await vscode.window.showErrorMessage(
        `toyproof ${reason} ${place}. Errors, completion and images need the program.`,
        choose,
        settings,
    );
    if (answer === settings) {
        await vscode.commands.executeCommand("workbench.action.openSettings", "toyproof.path");
    } else if (answer === choose) {
        const [file] = (await vscode.window.showOpenDialog({ title: "The executable toyproof" })) ?? [];
        if (file) {
            const configuration = vscode.workspace.getConfiguration("toyproof");
            await configuration.update("path", file.fsPath, vscode.ConfigurationTarget.Global);
        }
    }
}
