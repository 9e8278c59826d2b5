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
edit 03-shading wrong 's/AMBIENT = vec3(0.1/AMBIENT = vec3(0.3/'
edit 03-shading undefined 's/^\( *\)fragColor = .*/&\n\1fragColor.y = sqrt(fragCoord.x - 100.0);/'
edit 03-shading zero 's/^\( *\)fragColor = .*/&\n\1fragColor.z = float(floatBitsToUint(mat2(0.0 - floor(fragCoord.x * 0.1))[1][1]) >> 31u);/'
edit 03-shading slow 's/^\( *\)fragColor = .*/&\n\1float a[900]; for (int i = 0; i < 900; i++) a[i] = fragCoord.x * float(i); fragColor.x = a[int(fragCoord.y)];/'
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

for pass in missing-built-ins is-nan matrices booleans negations remainders out-arguments switches missing-returns; do
    reduce "naga: $pass" harbor.glsl --lenient --fault naga --without $pass
done
for pass in inexact-functions indices uninitialized do-while; do
    reduce "toolchain: $pass" harbor.glsl --lenient --fault toolchain --without $pass
done
reduce 'toolchain: bits of NaN' nan.glsl --fault toolchain
reduce 'toolchain: sign of zero' zero.glsl --fault toolchain
reduce 'driver: time limit' slow.glsl --fault driver --timeout 1
reduce 'naga itself' plain.frag --command 'naga --input-kind glsl --shader-stage frag {} out.wgsl'
reduce 'error' error.glsl
reduce 'warning of the text' harbor.glsl --lenient --fault warning=W0003
reduce 'warning of a run' undefined.glsl --fault warning=W0603
reduce 'wrong image' wrong.glsl --fault verdict=wrong --scene 03-shading
