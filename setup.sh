#!/bin/sh
# Installs a Vulkan driver that runs on the CPU, where the system's package manager can and may.
set -eu

for folder in /usr/share /usr/local/share /etc; do
    for manifest in "$folder"/vulkan/icd.d/lvp_icd*.json; do
        [ -e "$manifest" ] && exit 0
    done
done

as_root=
if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
        as_root=sudo
    else
        as_root=none
    fi
fi

if command -v apt-get >/dev/null 2>&1; then
    refresh="apt-get update -q"
    install="env DEBIAN_FRONTEND=noninteractive apt-get install -q -y mesa-vulkan-drivers libvulkan1"
elif command -v dnf >/dev/null 2>&1; then
    refresh=true
    install="dnf install -y mesa-vulkan-drivers vulkan-loader"
elif command -v pacman >/dev/null 2>&1; then
    refresh=true
    install="pacman -S --noconfirm vulkan-swrast vulkan-icd-loader"
else
    echo "setup: no package manager that is known here; install Mesa's lavapipe by hand" >&2
    exit 0
fi

if [ "$as_root" = none ]; then
    echo "setup: lavapipe is missing and only root may install it; run: sudo $install" >&2
    exit 0
fi
echo "setup: installing lavapipe, a Vulkan driver that runs on the CPU"
$as_root $refresh >/dev/null 2>&1 || true
$as_root $install || echo "setup: that failed; without a Vulkan driver no shader can run" >&2
