#!/bin/sh
# Checks what the build needs (Rust, make, a C linker) and installs a Vulkan driver that runs on the CPU; with `--tests`,
# also the programs that tests use. Never asks for a password: if installing needs one, the command is printed instead.
# Can be run repeatedly.
set -eu
cd "$(dirname "$0")"

log() { echo "setup: $*" >&2; }
has() { command -v "$1" >/dev/null 2>&1; }

packages_for() {
    if has apt-get; then
        manager="apt-get install -y"
        build="make gcc libc6-dev"
        driver="mesa-vulkan-drivers libvulkan1"
        glslang=glslang-tools
        script=bsdutils
    elif has dnf; then
        manager="dnf install -y"
        build="make gcc"
        driver="mesa-vulkan-drivers vulkan-loader"
        glslang=glslang
        script=util-linux-script
        ffmpeg=ffmpeg-free
    elif has pacman; then
        manager="pacman -S --needed --noconfirm"
        build="make gcc"
        driver="vulkan-swrast vulkan-icd-loader"
        glslang=glslang
    else
        manager=
    fi
}

# Root needs no sudo; other users use sudo only if it works without a password.
root_prefix() {
    if [ "$(id -u)" -eq 0 ]; then
        as_root=
    elif has sudo && sudo -n true 2>/dev/null; then
        as_root="sudo "
    else
        as_root=none
    fi
}

# install WHAT PACKAGES: installs packages, or prints the command.
install() {
    if [ -z "$manager" ]; then
        log "$1 is missing, and the package manager of this system is unknown; install it manually"
        return 1
    fi
    if [ "$as_root" = none ]; then
        log "$1 is missing; run: sudo $manager $2"
        return 1
    fi
    log "$1 is missing; running: $as_root$manager $2"
    if has apt-get && [ -z "${updated:-}" ]; then
        updated=yes
        DEBIAN_FRONTEND=noninteractive
        export DEBIAN_FRONTEND
        ${as_root}apt-get update -q >/dev/null 2>&1 || log "cannot update the list of packages; continuing with the old one"
    fi
    # The words of the command are separate arguments.
    # shellcheck disable=SC2086
    ${as_root}$manager $2 >&2 || { log "installing $1 failed; the messages above state the reason"; return 1; }
}

has_driver() {
    for folder in /usr/share /usr/local/share /etc; do
        for manifest in "$folder"/vulkan/icd.d/lvp_icd*.json; do
            [ -e "$manifest" ] && return 0
        done
    done
    return 1
}

needed=$(sed -n 's/^rust-version = "\([0-9.]*\)".*/\1/p' Cargo.toml)

# Whether cargo is installed and rustc is at least the needed version.
has_rust() {
    has cargo && has rustc || return 1
    found=$(rustc --version | sed -n 's/^rustc \([0-9]*\)\.\([0-9]*\).*/\1 \2/p')
    major=${found% *}
    minor=${found#* }
    [ "${major:-0}" -gt "${needed%%.*}" ] ||
        { [ "${major:-0}" -eq "${needed%%.*}" ] && [ "${minor:-0}" -ge "${needed#*.}" ]; }
}

check_rust() {
    has_rust && return 0
    if has rustup; then
        log "Rust $needed or later is missing; running: rustup update stable"
        rustup update stable >&2 || log "rustup update failed; the messages above state the reason"
        has_rust && return 0
        log "the default toolchain is older than Rust $needed; run: rustup default stable"
        return 1
    fi
    if has rustc; then
        log "$(rustc --version) is too old: Rust $needed or later is needed. Install it from https://rustup.rs:"
    else
        log "Rust $needed or later is missing. Install it from https://rustup.rs:"
    fi
    # Printed for the reader's shell.
    # shellcheck disable=SC2016
    log '    curl --proto "=https" --tlsv1.2 -sSf https://sh.rustup.rs | sh && . "$HOME/.cargo/env"'
    return 1
}

packages_for
root_prefix
ready=yes
check_rust || ready=no
if ! has make || ! has cc; then
    if [ "$(uname -s)" = Darwin ]; then
        log "make or the C linker is missing; run: xcode-select --install"
        ready=no
    else
        install "make or the C linker cc" "${build:-}" || ready=no
    fi
fi
if [ "$(uname -s)" = Darwin ]; then
    log "shaders run on toyproof's CPU evaluator, because Vulkan is not available on macOS"
elif ! has_driver; then
    install "the optional Vulkan driver lavapipe" "${driver:-}" ||
        log "without a Vulkan driver, shaders run on toyproof's CPU evaluator and the toolchain check is skipped"
fi

# What tests use; naga and tint have no package.
install_programs() {
    missing=
    { has chromium || has chromium-browser || has google-chrome; } || missing="$missing chromium"
    has glslangValidator || missing="$missing ${glslang:-glslang}"
    has spirv-val || missing="$missing spirv-tools"
    has povray || missing="$missing povray"
    has clang++ || missing="$missing clang"
    has ffmpeg || missing="$missing ${ffmpeg:-ffmpeg}"
    has nvim || missing="$missing neovim"
    has script || missing="$missing ${script:-util-linux}"
    [ -z "$missing" ] || install "what tests use" "${missing# }"
}

# What pages for three.js are tested with; tests that need it are skipped without it.
install_three() {
    [ -e target/npm/node_modules/three/package.json ] && return 0
    if ! has npm; then
        log "npm is missing, so modules for three.js are not run in tests"
        return 0
    fi
    mkdir -p target/npm
    npm install --prefix target/npm --no-save --no-audit --no-fund three@0.187.0 >&2 ||
        log "three could not be installed by npm, so modules for it are not run in tests"
}

case "${1:-}" in
--tests)
    install_programs || ready=no
    install_three
    ;;
esac
[ "$ready" = yes ] || { log "install what is missing, then run ./setup.sh again"; exit 1; }
