#!/bin/sh
# What can be tested of other platforms on a Debian machine: Windows under wine, aarch64 under qemu, and type checks
# for macOS and WebAssembly. Run by `make platforms`; takes about 40 minutes on two cores from an empty target.
set -eu
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target}/platforms
export CARGO_TARGET_DIR="$target"

say() { printf '\n== %s\n' "$1"; }
needs() { command -v "$1" >/dev/null 2>&1 || { echo "skipped: $1 is missing; $2"; return 1; }; }

rustup target add x86_64-pc-windows-gnu aarch64-unknown-linux-gnu aarch64-unknown-linux-musl aarch64-apple-darwin wasm32-unknown-unknown

say "macOS: cargo check"
cargo check --target aarch64-apple-darwin

say "WebAssembly: cargo check of the crates that need no processes"
cargo check --target wasm32-unknown-unknown -p toyproof-math -p toyproof-diagnostic -p toyproof-image -p toyproof-glsl \
    -p toyproof-lint -p toyproof-translate -p toyproof-eval -p toyproof-eval-native -p toyproof-scene -p toyproof-tracer
cargo check --target wasm32-unknown-unknown -p toyproof-explain

say "aarch64: the bit-exactness tests of math, tracer and evaluator"
if needs aarch64-linux-gnu-gcc "apt-get install gcc-aarch64-linux-gnu" && needs qemu-aarch64 "apt-get install qemu-user"; then
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
        CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu" \
        cargo test --target aarch64-unknown-linux-gnu --lib -p toyproof-math -p toyproof-tracer -p toyproof-eval
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

say "aarch64: the static program of a release"
if needs aarch64-linux-gnu-gcc "apt-get install gcc-aarch64-linux-gnu" && needs qemu-aarch64 "apt-get install qemu-user"; then
    cargo xtask dist --out "$folder/dist" aarch64-unknown-linux-musl
    tar -xzf "$folder"/dist/toyproof-*-aarch64-unknown-linux-musl.tar.gz -C "$folder" --strip-components=1
    qemu-aarch64 "$folder/toyproof" check glsl/02-sphere.glsl --size 160x90 --out "$folder/arm"
    qemu-aarch64 "$folder/toyproof" doctor | grep 'linked statically'
    grep -q '"verdict": "correct"' "$folder/arm/verdict.json"
fi

say "Windows: check, render and convert under wine"
if needs x86_64-w64-mingw32-gcc "apt-get install mingw-w64" && needs wine "apt-get install wine64" &&
    needs zip "apt-get install zip" && needs unzip "apt-get install unzip"; then
    cargo xtask dist --out "$folder/dist" x86_64-pc-windows-gnu
    unzip -qj "$folder"/dist/toyproof-*-x86_64-pc-windows-gnu.zip '*/toyproof.exe' -d "$folder"
    # Debian's wine 8.0 lacks a library that Rust's standard library takes random numbers from; Windows has it.
    printf '%s\n' '#include <windows.h>' \
        'BOOLEAN NTAPI SystemFunction036(PVOID, ULONG);' \
        '__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) { return SystemFunction036(data, size); }' \
        >"$folder/prng.c"
    x86_64-w64-mingw32-gcc -shared -o "$folder/bcryptprimitives.dll" "$folder/prng.c" -ladvapi32
    cp glsl/02-sphere.glsl glsl/02-sphere.toml "$folder"
    run() { (cd "$folder" && HOME="$folder" WINEDEBUG=-all wine toyproof.exe "$@"); }
    run check 02-sphere.glsl --device cpu --size 160x90 --out out
    run render 02-sphere.toml -o sphere.png --size 160x90
    run convert 02-sphere.glsl -o sphere.wgsl
    # The first line names the file.
    tail -n +2 tests/snapshots/wgsl/02-sphere.wgsl >"$folder/expected"
    tail -n +2 "$folder/sphere.wgsl" | cmp - "$folder/expected"
    [ -s "$folder/sphere.png" ] && [ -s "$folder/out/verdict.json" ]
fi
echo "platforms: done"
