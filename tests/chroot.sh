#!/bin/bash
# Installs each package of a release in a bare Debian 12, and measures the seconds until the first verdict.
# Needs root, debootstrap and the files that `cargo xtask dist` writes: `tests/chroot.sh dist`. Downloads 60 MB for the
# bare system, which it keeps in the folder that the second argument names.
set -euo pipefail
release=$(realpath "${1:?usage: tests/chroot.sh RELEASE [BASE]}")
work=$(mktemp -d)
base=$(realpath -m "${2:-$work/base}")
trap 'umount -q "$work"/*/proc "$work"/*/dev || true; rm -rf --one-file-system "$work"' EXIT

[ -d "$base" ] || debootstrap --variant=minbase bookworm "$base" >"$work/debootstrap.log"

# machine NAME FILE: makes a copy of the bare system, with a file of the release in its /root.
machine() {
    root=$work/$1
    cp -a --reflink=auto "$base" "$root"
    cp /etc/resolv.conf "$root/etc"
    # A pattern.
    # shellcheck disable=SC2086
    cp "$release"/$2 "$root/root"
    mount -t proc proc "$root/proc"
    mount --bind /dev "$root/dev"
    total=0
    printf '\n%s: %s\n' "$1" "$(cd "$root/root" && ls)"
}

# step COMMAND: runs a command in the machine and prints the time that it took.
step() {
    local begin end seconds
    begin=$(date +%s%N)
    chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin /bin/sh -c "cd && $1" >"$work/log" 2>&1 || {
        cat "$work/log"
        echo "chroot: failed: $1" >&2
        exit 1
    }
    end=$(date +%s%N)
    seconds=$(((end - begin) / 1000000))
    total=$((total + seconds))
    printf '%7d.%d s  %s\n' $((seconds / 1000)) $((seconds % 1000 / 100)) "$1"
}

# verdict TOYPROOF DEVICE: the first verdict, on a shader of the course, by a device with this name, or none.
verdict() {
    step "$1 scenes --write course"
    step "$1 check course/04-many-objects.glsl --out report"
    grep '^correct' "$work/log"
    grep -qi "\"device\": \"\?$2" "$root/root/report/verdict.json"
    printf '%7d.%d s  in all, with a compiler: %s\n' $((total / 1000)) $((total % 1000 / 100)) \
        "$(chroot "$root" sh -c 'command -v cc gcc rustc' || echo none)"
}

machine static 'toyproof-*-x86_64-unknown-linux-musl.tar.gz'
step 'tar -xzf toyproof-*.tar.gz --strip-components=1'
verdict ./toyproof null
step './toyproof doctor'
head -n 1 "$work/log"

machine deb 'toyproof_*_amd64.deb'
step 'apt-get update'
step 'apt-get install -y ./toyproof_*.deb'
verdict toyproof llvmpipe
step 'toyproof check course/04-many-objects.glsl --device lavapipe -q'

machine deb-without-driver 'toyproof_*_amd64.deb'
step 'dpkg -i toyproof_*.deb'
verdict toyproof null

machine wheel 'toyproof-*-manylinux_*_x86_64.whl'
step 'apt-get update'
step 'apt-get install -y --no-install-recommends python3-venv'
step 'python3 -m venv toyproof'
step 'toyproof/bin/pip install --no-index toyproof-*.whl'
verdict toyproof/bin/toyproof null
step 'apt-get install -y --no-install-recommends mesa-vulkan-drivers libvulkan1'
step 'toyproof/bin/toyproof check course/04-many-objects.glsl --device lavapipe -q'

# Gradescope's layout: the archive unpacked, run_autograder copied, setup.sh run once.
machine gradescope 'toyproof_*_amd64.deb'
step 'dpkg -i toyproof_*.deb && toyproof scenes --write course'
step 'toyproof new assignment many --from course/04-many-objects.toml'
step 'toyproof autograder gradescope many -o autograder.zip && dpkg -r toyproof'
mkdir -p "$root/autograder/source"
python3 -m zipfile -e "$root/root/autograder.zip" "$root/autograder/source"
cp "$root/autograder/source/run_autograder" "$root/autograder"
chmod +x "$root/autograder/run_autograder"
step 'sh /autograder/source/setup.sh'
python3 "$(dirname "$0")/gradescope.py" "$root" "$root/root/course/04-many-objects.glsl"

# The other platforms, whose machines have Python and make.
machine autograders 'toyproof_*_amd64.deb'
step 'dpkg -i toyproof_*.deb && toyproof scenes --write course'
step 'toyproof new assignment many --from course/04-many-objects.toml'
for platform in prairielearn autolab coderunner classroom50; do
    step "toyproof autograder $platform many -o $platform"
done
step 'dpkg -r toyproof && apt-get update && apt-get install -y --no-install-recommends make python3'
python3 "$(dirname "$0")/autograders.py" "$root" "$root/root/course/04-many-objects.glsl"
