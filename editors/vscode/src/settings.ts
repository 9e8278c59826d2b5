/** The settings for a shader, in the forms that the command line and the debugger expect. */

import * as path from "node:path";
import * as vscode from "vscode";

/** The names of what a shader is compared with: at most one of them is set. */
export const REFERENCES = ["scene", "reference", "assignment"] as const;

/** What a shader is compared with, by these names. */
export type References = Partial<Record<(typeof REFERENCES)[number], string>>;

function configurationOf(shader: vscode.Uri): vscode.WorkspaceConfiguration {
    return vscode.workspace.getConfiguration("toyproof", shader);
}

/** What a shader is compared with, without empty settings. */
export function references(shader: vscode.Uri): References {
    const configuration = configurationOf(shader);
    const settings: References = {};
    for (const name of REFERENCES) {
        const value = configuration.get<string>(`check.${name}`, "");
        if (value !== "") settings[name] = value;
    }
    return settings;
}

/** The language of a shader, without settings that have their default. */
export function language(shader: vscode.Uri): { lenient?: true; dialect?: string; includeDir?: string[] } {
    const configuration = configurationOf(shader);
    const dialect = configuration.get<string>("dialect", "auto");
    const includeDir = configuration.get<string[]>("includeFolders", []);
    return {
        ...(configuration.get<boolean>("lenient", false) ? { lenient: true } : {}),
        ...(dialect === "auto" ? {} : { dialect }),
        ...(includeDir.length === 0 ? {} : { includeDir }),
    };
}

/** The language of a shader, as arguments of any command. */
export function languageArguments(shader: vscode.Uri): string[] {
    const { lenient, dialect, includeDir = [] } = language(shader);
    return [
        ...(lenient ? ["--lenient"] : []),
        ...(dialect === undefined ? [] : ["--dialect", dialect]),
        ...includeDir.flatMap((folder) => ["--include-dir", folder]),
    ];
}

/** What a shader is compared with, hints, and its language, as arguments of `check` and `watch`. */
export function checkArguments(shader: vscode.Uri): string[] {
    const given = Object.entries(references(shader)).flatMap(([name, value]) => [`--${name}`, value]);
    const hints = configurationOf(shader).get<string>("check.hints", "");
    return [...given, ...(hints === "" ? [] : ["--hints", hints]), ...languageArguments(shader)];
}

/** The folder from which the paths in the settings start. */
export function baseFolder(shader: vscode.Uri): string {
    const folder = vscode.workspace.getWorkspaceFolder(shader);
    return folder?.uri.fsPath ?? path.dirname(shader.fsPath);
}
