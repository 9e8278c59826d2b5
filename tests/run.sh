#!/bin/sh
# Runs all tests, also after a failure, in the profile of `make demo`, whose dependencies it reuses; then prints how many
# were skipped, by what was missing. Run by `make test`. If `CI` is set, only tests of naga and tint are skipped: others fail.
set -eu
cd "$(dirname "$0")/.."
TOYPROOF_SKIPPED=$(mktemp)
export TOYPROOF_SKIPPED
trap 'rm -f "$TOYPROOF_SKIPPED"' EXIT

code=0
if [ $# = 0 ]; then
    # Not the examples, which `make lint` compiles.
    cargo test --release --workspace --no-fail-fast --tests || code=$?
    set -- --doc
fi
cargo test --release --workspace --no-fail-fast "$@" || code=$?
# A line is `skipped: TEST: REASON`; a test that lacks several things is counted under each.
tests=$(cut -d ' ' -f 2 "$TOYPROOF_SKIPPED" | sort -u | wc -l)
echo "tests skipped, in whole or in part: $((tests))"
cut -d ' ' -f 3- "$TOYPROOF_SKIPPED" | sort | uniq -c
exit $code
