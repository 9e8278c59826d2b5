// The manifest and the code have the same commands and settings.

import assert from "node:assert/strict";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

const root = join(import.meta.dirname, "..");
const manifest = JSON.parse(readFileSync(join(root, "package.json"), "utf8"));
const code = readdirSync(join(root, "src"))
    .map((file) => readFileSync(join(root, "src", file), "utf8"))
    .join("\n");

test("each command of the manifest is registered, and the reverse", () => {
    const ofShaders = [...code.matchAll(/ofShader\("(\w+)"/g)];
    const others = [...code.matchAll(/registerCommand\("toyproof\.(\w+)"/g)];
    const registered = [...ofShaders, ...others].map((match) => `toyproof.${match[1]}`);
    const declared = manifest.contributes.commands.map(({ command }) => command);
    assert.deepEqual(registered.sort(), declared.sort());
    const used = [...Object.values(manifest.contributes.menus).flat(), ...manifest.contributes.keybindings];
    for (const { command } of used) assert.ok(declared.includes(command), command);
});

test("files that the manifest names exist", () => {
    const { languages, grammars, snippets } = manifest.contributes;
    const files = [
        ...languages.map((language) => language.configuration),
        ...[...grammars, ...snippets].map(({ path }) => path),
    ];
    for (const file of [...files, manifest.icon]) assert.ok(existsSync(join(root, file)), file);
});

test("each setting has a description and a default", () => {
    for (const [name, setting] of Object.entries(manifest.contributes.configuration.properties)) {
        assert.ok(setting.markdownDescription, name);
        assert.notEqual(setting.default, undefined, name);
    }
});
