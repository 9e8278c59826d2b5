import js from "@eslint/js";
import typescript from "typescript-eslint";

export default typescript.config(
    { ignores: ["out/"] },
    js.configs.recommended,
    {
        files: ["src/**/*.ts"],
        extends: [typescript.configs.strictTypeChecked, typescript.configs.stylisticTypeChecked],
        languageOptions: { parserOptions: { projectService: true } },
        rules: { "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true }] },
    },
    {
        files: ["**/*.cjs"],
        languageOptions: { sourceType: "commonjs", globals: { process: "readonly", setTimeout: "readonly" } },
    },
    {
        files: ["**/*.mjs"],
        languageOptions: {
            globals: { process: "readonly", setTimeout: "readonly", URLSearchParams: "readonly" },
        },
    },
);
