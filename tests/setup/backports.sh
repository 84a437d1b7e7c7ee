# shellcheck shell=sh disable=SC2154 # read by run.sh, which sets what it uses
# Each folder of sources/ is a machine: its source files, its release, and the entry for backports that must come out.

for machine in "$here"/sources/*; do
    read -r release distribution <"$machine/release"
    files=$(find "$machine" -name '*.list' -o -name '*.sources' | sort)
    # shellcheck disable=SC2086 # one file a word
    actual=$(awk -v release="$release" -v distribution="$distribution" -f "$scripts/backports.awk" $files)
    check "backports: ${machine##*/}" "$(cat "$machine/expected")" "$actual"

    # apt's own reading of that entry: the one suite that it would fetch.
    if [ -n "$actual" ] && command -v apt-get >/dev/null 2>&1; then
        mkdir -p "$tmp/apt/lists/partial"
        format=sources
        case $actual in deb\ *) format=list ;; esac
        echo "$actual" >"$tmp/apt/entry.$format"
        fetched=$(apt-get update --print-uris -o Dir::Etc::SourceList="$tmp/apt/entry.$format" \
            -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$tmp/apt/lists" 2>/dev/null |
            cut -d"'" -f2 | grep 'InRelease$')
        address=$(echo "$actual" | tr ' ' '\n' | grep '://' | sed 's|/*$||; s|file://|file:|')
        check "backports: ${machine##*/}, as apt reads it" "$address/dists/$release-backports/InRelease" "$fetched"
    fi
done
