// The functions of texts.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { build } from "esbuild";

const { outputFiles } = await build({
    entryPoints: [join(import.meta.dirname, "../src/text.ts")],
    format: "esm",
    write: false,
});
const { verdictOf, pixelOf, watchAddress, escapeHtml, explainedCodes, lastLines } = await import(
    `data:text/javascript,${encodeURIComponent(outputFiles[0].text)}`
);

test("verdicts of code lenses", () => {
    assert.deepEqual(verdictOf("toyproof: wrong: 15,819 pixels differ"), { icon: "error", verdict: "wrong" });
    assert.deepEqual(verdictOf("toyproof: correct (when last saved): all pixels agree"), {
        icon: "pass",
        verdict: "correct",
    });
    for (const other of ["", "toyproof: checking…", "3 references", "toyproof: the check exceeded the limit"])
        assert.equal(verdictOf(other), undefined);
});

test("coordinates of pixels", () => {
    for (const text of ["311,142", " 311, 142 ", "311 142"]) assert.deepEqual(pixelOf(text), [311, 142]);
    for (const text of ["", "311", "1.5, 2", "-1, 2", "1, 2, 3", "1234567, 1"])
        assert.equal(pixelOf(text), undefined);
});

test("only pages of this machine are shown", () => {
    assert.equal(watchAddress("http://127.0.0.1:4711/a1b2/\n")?.port, "4711");
    for (const line of [
        "",
        "listening",
        "https://example.org/",
        "http://127.0.0.1.example.org/",
        "file:///etc/passwd",
    ]) {
        assert.equal(watchAddress(line), undefined);
    }
});

test("texts in HTML", () => {
    assert.equal(escapeHtml(`<a href="x">&</a>`), "&lt;a href=&quot;x&quot;&gt;&amp;&lt;/a&gt;");
});

test("the list of codes", () => {
    const list = "E0100  expected something else\nfar-root  the farther root\n\nnote: words\n";
    assert.deepEqual(explainedCodes(list), [
        { code: "E0100", title: "expected something else" },
        { code: "far-root", title: "the farther root" },
    ]);
});

test("the end of a text begins with a whole line", () => {
    assert.equal(lastLines("first\nsecond\nthird\n", 12), "third\n");
    assert.equal(lastLines("first\n", 12), "first\n");
});
