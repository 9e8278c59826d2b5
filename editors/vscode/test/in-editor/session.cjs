// Runs in the extension host of a real editor: the extension with the real program. `run.mjs` starts it.

const assert = require("node:assert/strict");
const { execFileSync } = require("node:child_process");
const { readFileSync, writeFileSync } = require("node:fs");
const { join } = require("node:path");
const vscode = require("vscode");

const HANG_GUARD = 60_000; // milliseconds

const folder = vscode.workspace.workspaceFolders[0].uri;
const uri = vscode.Uri.joinPath(folder, "ball.glsl");

/** Waits until `condition` returns something true; returns that. */
async function waitFor(what, condition) {
    for (const start = Date.now(); Date.now() - start < HANG_GUARD;) {
        const value = await condition();
        if (value) return value;
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`waited too long for ${what}`);
}

const run = (command, ...args) => vscode.commands.executeCommand(command, ...args);

/** The place of the nth occurrence of a text, plus some characters. */
function placeOf(document, part, nth = 1, offset = 0) {
    let at = -1;
    for (let count = 0; count < nth; count++) at = document.getText().indexOf(part, at + 1);
    assert.ok(at >= 0, part);
    return document.positionAt(at + offset);
}

async function replace(document, range, text) {
    const edit = new vscode.WorkspaceEdit();
    edit.replace(document.uri, range, text);
    assert.ok(await vscode.workspace.applyEdit(edit));
}

/** The processes `toyproof COMMAND` of this test. */
function processes(command) {
    const lines = execFileSync("ps", ["-eo", "pid=,args="], { encoding: "utf8" }).split("\n");
    const program = vscode.workspace.getConfiguration("toyproof").get("path");
    const found = lines.filter((line) => line.includes(`${program} ${command}`) && !line.includes("ps -eo"));
    return found.map((line) => Number(line.trim().split(" ")[0]));
}

const errors = () => vscode.languages.getDiagnostics(uri).filter(({ severity }) => severity === 0);

const steps = {
    async "an error is reported, and its quick fix applied"(document) {
        await waitFor("the error", () => errors().length > 0);
        const [error] = errors();
        assert.equal(error.range.start.line, 12);
        assert.equal(error.code.value ?? error.code, "E0100");
        const actions = await run("vscode.executeCodeActionProvider", uri, error.range, "quickfix");
        const fix = actions.find((action) => action.edit);
        assert.ok(await vscode.workspace.applyEdit(fix.edit));
        assert.match(document.getText(), /radius\*radius;\n/);
        await waitFor("no error", () => errors().length === 0);
    },

    async "completion, hover and signature help"(document) {
        const at = placeOf(document, "    Ray ray = ");
        await replace(document, new vscode.Range(at, at), "    p.\n");
        const list = await run(
            "vscode.executeCompletionItemProvider",
            uri,
            at.translate(0, "    p.".length),
            ".",
        );
        const labels = list.items.map(({ label }) => label.label ?? label);
        assert.ok(labels.includes("x") && labels.includes("yx") && !labels.includes("z"), labels.join(" "));
        await replace(document, new vscode.Range(at, at.translate(1)), "");
        await waitFor("no error", () => errors().length === 0);
        const [hover] = await run("vscode.executeHoverProvider", uri, placeOf(document, "normalize("));
        assert.match(hover.contents.map(({ value }) => value).join("\n"), /vec3 normalize\(vec3/);
        const inCall = placeOf(document, "intersectBall(ray, 1.0)", 1, "intersectBall(ray, ".length);
        const help = await run("vscode.executeSignatureHelpProvider", uri, inCall);
        assert.match(help.signatures[help.activeSignature].label, /intersectBall\(Ray ray, float radius\)/);
    },

    async "definition, references and rename"(document) {
        // The line has a character outside of the Basic Multilingual Plane.
        const use = placeOf(document, "CENTER", 2);
        const [definition] = await run("vscode.executeDefinitionProvider", uri, use);
        assert.equal(
            (definition.targetSelectionRange ?? definition.targetRange ?? definition.range).start.line,
            1,
        );
        const references = await run("vscode.executeReferenceProvider", uri, use);
        assert.equal(references.length, 2);
        const name = placeOf(document, "intersectBall");
        const edit = await run("vscode.executeDocumentRenameProvider", uri, name, "distanceToBall");
        assert.ok(await vscode.workspace.applyEdit(edit));
        assert.equal(document.getText().match(/distanceToBall/g).length, 2);
        assert.ok(!document.getText().includes("intersectBall"));
    },

    async "symbols, folding, semantic tokens, colors and hints"(document) {
        const symbols = await run("vscode.executeDocumentSymbolProvider", uri);
        assert.deepEqual(
            symbols.map(({ name }) => name),
            ["CENTER", "Ray", "distanceToBall", "mainImage"],
        );
        assert.ok((await run("vscode.executeFoldingRangeProvider", uri)).length >= 3);
        const tokens = await run("vscode.provideDocumentSemanticTokens", uri);
        assert.ok(tokens.data.length > 100);
        const colors = await run("vscode.executeDocumentColorProvider", uri);
        assert.ok(colors.length >= 2, String(colors.length));
        const all = new vscode.Range(0, 0, document.lineCount, 0);
        const hints = await run("vscode.executeInlayHintProvider", uri, all);
        assert.ok(hints.some(({ label }) => JSON.stringify(label).includes("radius")));
    },

    async formatting(document) {
        const edits = await run("vscode.executeFormatDocumentProvider", uri, {
            tabSize: 4,
            insertSpaces: true,
        });
        const edit = new vscode.WorkspaceEdit();
        edit.set(uri, edits);
        await vscode.workspace.applyEdit(edit);
        assert.match(document.getText(), /radius \* radius;/);
    },

    async "a verdict after a save"(document) {
        await vscode.workspace.getConfiguration("toyproof").update("check.reference", "reference.glsl");
        await replace(document, new vscode.Range(0, 0, 0, 0), " ");
        await document.save();
        const lens = await waitFor("the verdict", async () => {
            const lenses = await run("vscode.executeCodeLensProvider", uri, 100);
            return lenses.find(({ command }) => /correct|wrong/.test(command?.title ?? ""));
        });
        assert.match(lens.command.title, /wrong/);
    },

    async "values of a pixel as hints"(document) {
        const all = new vscode.Range(0, 0, document.lineCount, 0);
        const hints = () => run("vscode.executeInlayHintProvider", uri, all);
        const before = (await hints()).length;
        await run("toyproof.debugPixel", uri.toString(), 320, 180);
        await waitFor("the values", async () => (await hints()).length > before);
        await run("toyproof.hidePixel");
        await waitFor("no values", async () => (await hints()).length === before);
    },

    async "the image beside the shader, and the end of its process"() {
        await run("toyproof.watch");
        const isPanel = ({ input }) =>
            input instanceof vscode.TabInputWebview && /toyproof\.watch/.test(input.viewType);
        const panels = () => vscode.window.tabGroups.all.flatMap(({ tabs }) => tabs).filter(isPanel);
        await waitFor("the panel", () => panels().length === 1 && processes("watch").length === 1);
        await run("workbench.action.focusFirstEditorGroup");
        await run("toyproof.watch");
        assert.equal(panels().length, 1);
        await vscode.window.tabGroups.close(panels());
        await waitFor("the end of the process", () => processes("watch").length === 0);
    },

    async "the shader as WGSL"() {
        await run("toyproof.convert");
        const isWgsl = ({ uri }) => uri.scheme === "toyproof" && uri.path === "/ball.wgsl";
        const document = await waitFor("the document", () => vscode.workspace.textDocuments.find(isWgsl));
        assert.match(document.getText(), /fn distanceToBall\(/);
        await run("workbench.action.focusFirstEditorGroup");
    },

    async "an explanation"() {
        await run("toyproof.explainCode", "E0301");
        const isText = ({ uri }) => uri.scheme === "toyproof" && uri.path === "/E0301.txt";
        const document = await waitFor("the document", () => vscode.workspace.textDocuments.find(isText));
        assert.match(document.getText(), /E0301/);
        await run("workbench.action.focusFirstEditorGroup");
    },

    async "the debugger steps forward and back"() {
        const stops = [];
        const tracker = vscode.debug.registerDebugAdapterTrackerFactory("toyproof", {
            createDebugAdapterTracker: () => ({
                onDidSendMessage: (message) => message.event === "stopped" && stops.push(message.body),
            }),
        });
        const started = await vscode.debug.startDebugging(vscode.workspace.workspaceFolders[0], {
            type: "toyproof",
            request: "launch",
            name: "a pixel",
            program: uri.fsPath,
            pixel: [320, 180],
            size: [640, 360],
            stopOnEntry: true,
        });
        assert.ok(started);
        await waitFor("the first stop", () => stops.length > 0);
        const session = vscode.debug.activeDebugSession;
        const line = async () =>
            (await session.customRequest("stackTrace", { threadId: 1 })).stackFrames[0].line;
        const lines = [await line()];
        for (const step of ["next", "next", "stepBack"]) {
            const count = stops.length;
            await session.customRequest(step, { threadId: 1 });
            await waitFor(step, () => stops.length > count);
            lines.push(await line());
        }
        assert.equal(lines[3], lines[1], lines.join(" "));
        await vscode.debug.stopDebugging(session);
        await waitFor("the end of the debugger", () => processes("dap").length === 0);
        tracker.dispose();
    },

    async "a server that crashes is started again"(document) {
        const [before] = processes("lsp");
        process.kill(before, "SIGKILL");
        await waitFor("another process", () => processes("lsp").some((id) => id !== before));
        await replace(document, new vscode.Range(0, 0, 0, 0), "?");
        await waitFor("an error", () => errors().length > 0);
    },
};

exports.run = async () => {
    const results = {};
    const only = JSON.parse(readFileSync(join(folder.fsPath, "steps.json"), "utf8"));
    const document = await vscode.workspace.openTextDocument(uri);
    await vscode.window.showTextDocument(document);
    for (const [name, step] of Object.entries(steps)) {
        if (only.length > 0 && !only.some((part) => name.includes(part))) continue;
        try {
            await step(document);
            results[name] = "ok";
        } catch (error) {
            results[name] = String(error?.stack ?? error);
        }
        const text = JSON.stringify({ version: vscode.version, results }, null, 2);
        writeFileSync(join(folder.fsPath, "results.json"), text);
    }
    writeFileSync(join(folder.fsPath, "done"), "");
};
