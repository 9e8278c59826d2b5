// The scopes that the grammar gives to the parts of shaders.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import oniguruma from "vscode-oniguruma";
import textmate from "vscode-textmate";

const root = join(import.meta.dirname, "..");
const wasm = readFileSync(createRequire(import.meta.url).resolve("vscode-oniguruma/release/onig.wasm"));
await oniguruma.loadWASM(wasm);
const registry = new textmate.Registry({
    onigLib: Promise.resolve({
        createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
        createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => {
        const path = join(root, "syntaxes/glsl.tmLanguage.json");
        return textmate.parseRawGrammar(readFileSync(path, "utf8"), path);
    },
});
const grammar = await registry.loadGrammar("source.glsl");

/** The tokens of a text that are not spaces: the text of each, and its innermost scope. */
function tokens(text) {
    let state = textmate.INITIAL;
    return text.split("\n").flatMap((line) => {
        const { tokens, ruleStack } = grammar.tokenizeLine(line, state);
        state = ruleStack;
        const parts = tokens.map(({ startIndex, endIndex, scopes }) => [
            line.slice(startIndex, endIndex).trim(),
            scopes.at(-1).replace(/\.glsl$/, ""),
        ]);
        return parts.filter(([part]) => part !== "");
    });
}

/** Asserts the scopes of the tokens that are names, numbers or strings, or which `expected` lists. */
function assertScopes(text, expected) {
    const found = tokens(text).filter(
        ([part]) => /["\w]/.test(part) || expected.some(([other]) => other === part),
    );
    assert.deepEqual(found, expected);
}

test("names by what they are", () => {
    assertScopes("const float EPSILON = 1e-3;", [
        ["const", "storage.modifier"],
        ["float", "storage.type"],
        ["EPSILON", "source"],
        ["1e-3", "constant.numeric.float"],
    ]);
    assertScopes("vec3 col = mix(sky(p.xzy), s.color, iTime);", [
        ["vec3", "storage.type"],
        ["col", "source"],
        ["mix", "support.function.builtin"],
        ["sky", "entity.name.function"],
        ["p", "source"],
        ["xzy", "variable.other.member.swizzle"],
        ["s", "source"],
        ["color", "variable.other.member"],
        ["iTime", "variable.language.input"],
    ]);
    assertScopes("struct Ray { vec3 origin; };", [
        ["struct", "storage.type.struct"],
        ["Ray", "entity.name.type.struct"],
        ["vec3", "storage.type"],
        ["origin", "source"],
    ]);
    assertScopes("for (int i = 0; i < a.length(); ++i) discard;", [
        ["for", "keyword.control.loop"],
        ["int", "storage.type"],
        ["i", "source"],
        ["0", "constant.numeric.integer"],
        ["i", "source"],
        ["a", "source"],
        ["length", "support.function.builtin"],
        ["i", "source"],
        ["discard", "keyword.control"],
    ]);
    // Names that begin like a keyword, a type, a function or an input.
    assertScopes("fortune = vec3x + mixed + iTimes;", [
        ["fortune", "source"],
        ["vec3x", "source"],
        ["mixed", "source"],
        ["iTimes", "source"],
    ]);
});

test("numbers", () => {
    const numbers = {
        float: ["1.0", "1.", ".5", "1e5", "1.5e-3", "2.0f"],
        integer: ["12", "7u"],
        hex: ["0xFFu"],
    };
    for (const [kind, texts] of Object.entries(numbers)) {
        for (const text of texts) assert.deepEqual(tokens(text), [[text, `constant.numeric.${kind}`]]);
    }
});

test("directives, also over several lines", () => {
    assertScopes("#define SQUARE(x) ((x) * \\\n    (x))\nfloat y;", [
        ["define", "keyword.control.directive.define"],
        ["SQUARE", "entity.name.function.preprocessor"],
        ["x", "variable.parameter.preprocessor"],
        ["x", "meta.preprocessor.macro"],
        ["x", "meta.preprocessor.macro"],
        ["float", "storage.type"],
        ["y", "source"],
    ]);
    assertScopes("#if defined(FAST) && 1 // why", [
        ["if", "keyword.control.directive.conditional"],
        ["defined", "keyword.operator.defined"],
        ["FAST", "entity.name.constant.preprocessor"],
        ["1", "constant.numeric.integer"],
        ["why", "comment.line.double-slash"],
    ]);
    assertScopes('#include "noise.glsl"', [
        ["include", "keyword.control.directive.include"],
        ['"noise.glsl"', "string.quoted.include"],
    ]);
});

test("comments, and what toyproof reads in them", () => {
    assertScopes("/* float\n   x */ float x; // toyproof: allow(W0005) noise", [
        ["float", "comment.block"],
        ["x", "comment.block"],
        ["float", "storage.type"],
        ["x", "source"],
        ["toyproof:", "keyword.other.toyproof"],
        ["allow", "keyword.other.toyproof"],
        ["W0005", "constant.other.code"],
        ["noise", "comment.line.double-slash"],
    ]);
});

test("the shaders of the course have no token without a rule, other than names", () => {
    const course = join(root, "../../glsl/12-whitted.glsl");
    const others = tokens(readFileSync(course, "utf8")).filter(
        ([part, scope]) => scope === "source" && !/^[\w\s]+$/.test(part),
    );
    assert.deepEqual(others, []);
});
