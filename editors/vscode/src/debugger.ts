/** The debugger, `toyproof dap`: it steps through what one pixel of a shader computes. */

import * as vscode from "vscode";
import { executable, requireProgram } from "./program";
import { REFERENCES, baseFolder, language, references } from "./settings";
import { pixelOf } from "./text";

/** The type of the configurations, as in package.json. */
const TYPE = "toyproof";

/** The pixel that was entered last. */
let lastPixel = "320, 180";

/** Asks for the coordinates of a pixel. */
export async function requestPixel(): Promise<[number, number] | undefined> {
    const text = await vscode.window.showInputBox({
        title: "Pixel",
        prompt: "x from the left, y from the bottom, both from 0",
        value: lastPixel,
        validateInput: (value) => (pixelOf(value) ? undefined : "Two integers, such as 320, 180"),
    });
    if (text === undefined) return undefined;
    lastPixel = text;
    return pixelOf(text);
}

/** Starts the debugger for a pixel of a shader. */
export async function debugShader(shader: vscode.Uri): Promise<void> {
    const folder = vscode.workspace.getWorkspaceFolder(shader);
    await vscode.debug.startDebugging(folder, launch(shader));
}

/** The configuration for a shader, without the pixel. */
function launch(shader: vscode.Uri): vscode.DebugConfiguration {
    return {
        type: TYPE,
        request: "launch",
        name: "A pixel of this shader",
        program: shader.fsPath,
        stopOnEntry: true,
    };
}

const CONFIGURATIONS: vscode.DebugConfigurationProvider = {
    // Without launch.json, the configuration has no type.
    resolveDebugConfiguration(_folder, configuration) {
        const active = vscode.window.activeTextEditor?.document;
        if (configuration.type || active?.languageId !== "glsl") return configuration;
        return launch(active.uri);
    },

    // Complete what the configuration does not state; undefined cancels the start.
    async resolveDebugConfigurationWithSubstitutedVariables(_folder, configuration) {
        if (configuration.pixel === undefined) {
            const pixel = await requestPixel();
            if (!pixel) return undefined;
            configuration.pixel = pixel;
        }
        const program: unknown = configuration.program;
        if (typeof program === "string") {
            const shader = vscode.Uri.file(program);
            const isStated = REFERENCES.some((name) => name in configuration);
            return {
                ...(isStated ? {} : references(shader)),
                ...language(shader),
                ...configuration,
            };
        }
        return configuration;
    },
};

const ADAPTERS: vscode.DebugAdapterDescriptorFactory = {
    async createDebugAdapterDescriptor({ configuration, workspaceFolder }) {
        if (!(await requireProgram())) return undefined;
        const program: unknown = configuration.program;
        const ofProgram = typeof program === "string" ? baseFolder(vscode.Uri.file(program)) : undefined;
        const cwd = workspaceFolder?.uri.fsPath ?? ofProgram;
        return new vscode.DebugAdapterExecutable(executable(), ["dap"], cwd === undefined ? {} : { cwd });
    },
};

/** Registers the debugger. */
export function registerDebugger(): vscode.Disposable {
    return vscode.Disposable.from(
        vscode.debug.registerDebugConfigurationProvider(TYPE, CONFIGURATIONS),
        vscode.debug.registerDebugAdapterDescriptorFactory(TYPE, ADAPTERS),
    );
}
