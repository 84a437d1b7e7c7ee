#!/bin/sh
# Tests of the set-up: tests/setup/run.sh
#
# Nothing is installed and nothing asked of the network: machines are made of files in a temporary folder, and of commands
# that stand in for apt, sudo, rustc and vulkaninfo. Exit codes: 0 all passed, 1 some failed.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck disable=SC2034 # used by the files read below
scripts=$(cd "$here/../../scripts" && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
unset VK_DRIVER_FILES VK_ICD_FILENAMES CARGO_TARGET_DIR

# The tools that the scripts may use. Whatever else the machine has (a cargo, a vulkaninfo) stays out of sight.
mkdir "$tmp/tools"
for tool in sh awk cat chmod cp dirname env find grep head mkdir mktemp readlink rm sed sort tail timeout tr uname; do
    ln -s "$(command -v "$tool")" "$tmp/tools/$tool"
done

passed=0
failures=0

# check NAME EXPECTED ACTUAL
check() {
    if [ "$2" = "$3" ]; then
        passed=$((passed + 1))
    else
        failures=$((failures + 1))
        printf 'FAILED %s\n  expected: %s\n  but got:  %s\n' "$1" "$2" "$3" >&2
    fi
}

# stub FILE: makes a command of the text on standard input.
stub() {
    { echo '#!/bin/sh' && cat; } >"$1"
    chmod +x "$1"
}

for tests in backports device install setup; do
    # shellcheck source=/dev/null
    . "$here/$tests.sh"
done

echo "set-up tests: $passed passed, $failures failed"
[ $failures = 0 ]
