// Bundles the extension into out/extension.js, and the licenses of the packages in it into out/LICENSES.txt.

import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { build } from "esbuild";

const root = import.meta.dirname;
const { metafile } = await build({
    absWorkingDir: root,
    entryPoints: ["src/extension.ts"],
    outfile: "out/extension.js",
    bundle: true,
    external: ["vscode"],
    format: "cjs",
    platform: "node",
    // That of the oldest supported version of the editor.
    target: "node20",
    minify: true,
    metafile: true,
});

const folders = new Set();
for (const file of Object.keys(metafile.inputs)) {
    // The innermost package: one may be nested in another.
    const match = /^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(file);
    if (match) folders.add(match[1]);
}
const notices = [...folders].sort().map((folder) => {
    const { name, version, license } = JSON.parse(readFileSync(join(root, folder, "package.json"), "utf8"));
    const file = readdirSync(join(root, folder)).find((entry) => /^licen[cs]e/i.test(entry));
    if (!file) throw new Error(`${name} has no license file`);
    return `${name} ${version} (${license})\n\n${readFileSync(join(root, folder, file), "utf8").trim()}\n`;
});
writeFileSync(join(root, "out/LICENSES.txt"), notices.join(`\n${"-".repeat(80)}\n\n`));
