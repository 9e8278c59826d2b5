/** Functions of texts only, which tests run without an editor. */

/** The verdicts of `toyproof check`, each with the icon of the status bar. */
const ICONS: Readonly<Record<string, string>> = {
    correct: "pass",
    ok: "pass",
    wrong: "error",
    unstable: "warning",
    chaotic: "warning",
    inconclusive: "question",
    invalid: "error",
    timeout: "watch",
    error: "error",
};

/** The verdict in the title of a code lens, such as `toyproof: wrong: 3 pixels differ`, and its icon. */
export function verdictOf(title: string): { icon: string; verdict: string } | undefined {
    const verdict = /^toyproof: ([a-z]+)\b/.exec(title)?.[1] ?? "";
    const icon = ICONS[verdict];
    return icon === undefined ? undefined : { icon, verdict };
}

/** The coordinates of a pixel, as in `311,142` or `311 142`. */
export function pixelOf(text: string): [number, number] | undefined {
    const match = /^\s*(\d{1,5})\s*[, ]\s*(\d{1,5})\s*$/.exec(text);
    return match ? [Number(match[1]), Number(match[2])] : undefined;
}

/** The address that `toyproof watch` prints: a page of this machine only. */
export function watchAddress(line: string): URL | undefined {
    const text = line.trim();
    if (!URL.canParse(text)) return undefined;
    const url = new URL(text);
    return url.protocol === "http:" && url.hostname === "127.0.0.1" ? url : undefined;
}

/** A text as the text or an attribute of HTML. */
export function escapeHtml(text: string): string {
    const entities: Readonly<Record<string, string>> = {
        "&": "&amp;",
        "<": "&lt;",
        ">": "&gt;",
        '"': "&quot;",
    };
    return text.replace(/[&<>"]/g, (character) => entities[character] ?? character);
}

/** The codes that `toyproof explain --list` prints, each with its title. */
export function explainedCodes(list: string): { code: string; title: string }[] {
    return list.split("\n").flatMap((line) => {
        const match = /^(\S+) {2,}(.+)$/.exec(line);
        return match ? [{ code: match[1] ?? "", title: match[2] ?? "" }] : [];
    });
}

/** The end of a text, from the start of a line, at most this many characters. */
export function lastLines(text: string, length: number): string {
    if (text.length <= length) return text;
    const end = text.slice(-length);
    return end.slice(end.indexOf("\n") + 1);
}
