#!/bin/sh
# Regenerates the charts in docs/evidence/accuracy and the marked parts of docs/evidence/accuracy.md: `make accuracy`.
set -eu
program=$1
out=docs/evidence/accuracy
page=docs/evidence/accuracy.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# fill NAME: puts standard input between the marks of that name.
fill() {
    cat >"$work/part"
    awk -v name="$1" -v part="$work/part" '
        $0 == "<!-- end " name " -->" { while ((getline line < part) > 0) print line; skip = 0 }
        !skip { print }
        $0 == "<!-- begin " name " -->" { skip = 1 }
    ' "$page" >"$work/page"
    cp "$work/page" "$page"
}

# block: standard input as a code block.
block() {
    printf '```text\n'
    cat
    printf '```\n'
}

"$program" stress -v -o "$work" 2>&1 | grep -v "$work" | block | fill stress
cp "$work"/stress-*.png "$work"/stress-*.svg "$out"

for exercise in 03-shading 06-reflections 09-soft-shadows 12-whitted; do
    size=320x180
    [ $exercise = 09-soft-shadows ] && size=160x90
    "$program" trade -q "glsl/$exercise.toml" -o "$work/$exercise" --size $size >"$work/$exercise.lines"
    cp "$work/$exercise/trade.svg" "$out/trade-$exercise.svg"
    cp "$work/$exercise/trade.png" "$out/trade-$exercise.png"
    block <"$work/$exercise.lines"
done | fill trade
