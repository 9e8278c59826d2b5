#!/bin/sh
# Reduces shaders with known faults, and prints the table of docs/evidence/reduction.md. Takes a few minutes.
# Usage: tests/reductions/measure.sh [PROGRAM], in the root of the repository.
program=$(realpath "${1:-target/release/toyproof}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cp tests/reductions/*.glsl tests/reductions/*.frag glsl/*.glsl "$folder"
# Faults in shaders of the course.
edit() { sed "$3" "glsl/$1.glsl" > "$folder/$2.glsl"; }
edit 12-whitted error 's/reflect(/reflekt(/'
edit 12-whitted nan 's/^\( *\)fragColor = .*/&\n\1fragColor.z = float(floatBitsToUint(unpackHalf2x16(0x7c01u).x) >> 9u);/'
edit 03-shading wrong 's/0\.5/0.25/'
cd "$folder" || exit 2

# The tokens of a shader, roughly: words, numbers and operators.
tokens() { sed 's://.*::' "$1" | grep -oE '[A-Za-z_][A-Za-z_0-9]*|[0-9.]+|[^ \t]' | wc -l; }

echo '| fault | shader, options | bytes | tokens | lines | tries | seconds |'
echo '|---|---|---|---|---|---|---|'
reduce() {
    fault=$1
    file=$2
    shift 2
    start=$(date +%s.%N)
    if ! line=$("$program" reduce "$file" -o small.glsl "$@" 2> errors); then
        echo "$file $*: $(cat errors)" >&2
        return
    fi
    seconds=$(echo "$(date +%s.%N) - $start" | bc)
    numbers=$(echo "$line" | sed -E 's/^[^:]*: (.*) bytes, (.*) lines?, .* s, (.*) tr.*/\1 | TOKENS | \2 | \3/')
    numbers=$(echo "$numbers" | sed "s/TOKENS/$(tokens "$file") → $(tokens small.glsl)/")
    printf '| %s | `%s` | %s | %.1f |\n' "$fault" "$file $*" "$numbers" "$seconds"
    [ -z "$KEEP" ] || cp small.glsl "$KEEP/$(echo "$fault" | tr -c 'a-zA-Z0-9\n' -).glsl"
}

for pass in missing-built-ins is-nan matrices booleans negations remainders out-arguments switches sequences \
    missing-returns; do
    reduce "naga: $pass" harbor.glsl --lenient --fault naga --without $pass
done
for pass in inexact-functions indices uninitialized do-while; do
    reduce "toolchain: $pass" harbor.glsl --lenient --fault toolchain --without $pass
done
reduce 'toolchain: bits of NaN' nan.glsl --fault toolchain
reduce 'naga itself' plain.frag --command 'naga --input-kind glsl --shader-stage frag {} out.wgsl'
reduce 'error' error.glsl
reduce 'warning of the text' harbor.glsl --lenient --fault warning=W0003
reduce 'warning of a run' 12-whitted.glsl --fault warning=W0602
reduce 'wrong image' wrong.glsl --fault verdict=wrong --scene 03-shading
