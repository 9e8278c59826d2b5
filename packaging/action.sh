#!/usr/bin/env bash
# The steps of action.yml: `action.sh install` and `action.sh check`. Inputs are variables of the environment, so that nothing
# in them is read as a command.
set -euo pipefail

# Installs a release of toyproof, unless there is a toyproof already.
install() {
    if [ "$DRIVER" = true ] && [ "$RUNNER_OS" = Linux ]; then
        sudo apt-get update -qq
        sudo apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers libvulkan1
    fi
    if command -v toyproof >/dev/null; then
        return
    fi
    case $RUNNER_OS-$RUNNER_ARCH in
    Linux-X64) file=toyproof-${VERSION#v}-x86_64-unknown-linux-gnu.tar.gz ;;
    Linux-ARM64) file=toyproof-${VERSION#v}-aarch64-unknown-linux-musl.tar.gz ;;
    macOS-ARM64) file=toyproof-${VERSION#v}-aarch64-apple-darwin.tar.gz ;;
    Windows-X64) file=toyproof-${VERSION#v}-x86_64-pc-windows-gnu.zip ;;
    *)
        echo "::error::toyproof has no release for $RUNNER_OS on $RUNNER_ARCH"
        exit 2
        ;;
    esac
    folder=$RUNNER_TEMP/toyproof-install
    mkdir -p "$folder"
    cd "$folder"
    url=$GITHUB_SERVER_URL/$REPOSITORY/releases/download/$VERSION
    curl --fail --location --silent --show-error --remote-name-all "$url/$file" "$url/SHA256SUMS"
    # macOS has no sha256sum.
    if command -v sha256sum >/dev/null; then
        grep -F "  $file" SHA256SUMS | sha256sum --check
    else
        grep -F "  $file" SHA256SUMS | shasum --algorithm 256 --check
    fi
    case $file in
    *.zip) unzip -q "$file" ;;
    *) tar -xzf "$file" ;;
    esac
    echo "$folder/${file%%.[tz]*}" >>"$GITHUB_PATH"
}

# Checks the shaders, whose messages are shown at their lines, and writes a table to the summary of the job. A shader that
# is not right does not end the job yet: what follows shows the results.
check() {
    report=$RUNNER_TEMP/toyproof
    rm -rf "$report"
    echo "::add-matcher::$GITHUB_ACTION_PATH/packaging/problem-matcher.json"
    # No file name is read as a command of the runner.
    token=$(head -c 16 /dev/urandom | od -An -tx1 | tr -d ' \n')
    echo "::stop-commands::$token"
    code=0
    # Several arguments each.
    # shellcheck disable=SC2086
    toyproof check $SHADERS $ARGUMENTS --out "$report" --format short || code=$?
    echo "::$token::"
    echo "::remove-matcher owner=toyproof::"
    {
        echo "report=$report"
        echo "exit-code=$code"
    } >>"$GITHUB_OUTPUT"
    [ -f "$report/verdict.json" ] || exit "$code"
    # Shaders that compile have no message at a line.
    jq --raw-output '
        def data: gsub("%"; "%25") | gsub("\r"; "%0D") | gsub("\n"; "%0A");
        def property: ltrimstr("./") | data | gsub(":"; "%3A") | gsub(","; "%2C");
        .shaders[] | select(.verdict | IN("correct", "ok", "invalid") | not)
        | "::error file=\(.shader | property),line=\(.fix.line // .suspects[0].line // 1),title=\(.verdict)::\(.reason | data)"
    ' "$report/verdict.json"
    # Names and reasons may come from a stranger's pull request: no character of them is read as Markdown or HTML.
    jq --raw-output '
        def plain: [explode[] | if . > 127 or (. >= 48 and . <= 57) or (. >= 65 and . <= 90) or (. >= 97 and . <= 122) or . == 32
            then [.] | implode else "&#\(.);" end] | join("");
        "### toyproof\n\n| verdict | shader | reason |\n|---|---|---|",
        (.shaders[] | "| \(.verdict) | \(.shader | plain) | \(.reason | plain) |")
    ' "$report/verdict.json" >"$report/summary.md"
    cat "$report/summary.md" >>"$GITHUB_STEP_SUMMARY"
}

"$1"
