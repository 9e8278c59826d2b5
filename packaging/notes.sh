#!/bin/sh
# Prints the section of CHANGELOG.md for a tag: `packaging/notes.sh v0.1.0`. Fails if there is none.
set -eu
cd "$(dirname "$0")/.."
notes=$(awk -v heading="## [${1#v}]" '
    index($0, "## ") == 1 || /^\[[^]]*\]: / { inside = 0 }
    inside { print }
    index($0, heading) == 1 { inside = 1 }
' CHANGELOG.md | sed '/./,$!d')
[ -n "$notes" ] || {
    echo "CHANGELOG.md has no section for $1" >&2
    exit 1
}
printf '%s\n' "$notes"
