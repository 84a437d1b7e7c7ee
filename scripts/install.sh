#!/bin/sh
# Installs packages on Debian, Ubuntu and their relatives: scripts/install.sh PACKAGE...
#
# The Vulkan driver comes from the release where that has Mesa 25 or later (scripts/common.sh says why), otherwise from
# its backports. The address of those is derived from the machine's own sources (scripts/backports.awk), and used in a
# folder that is removed afterwards: apart from the packages, the machine is left as it was. Packages that are there
# may be upgraded for it, but none is removed.
#
# Exit codes: 0 installed, 1 tried and failed, 3 neither the release nor its backports have anything better, 4 not
# possible here (no apt, or neither root nor sudo without a password). All but 0 say why on standard error.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=scripts/common.sh
. "$here/common.sh"

if ! command -v apt-get >/dev/null 2>&1; then
    say "there is no apt-get here; install by hand what your system has in place of: $*"
    exit 4
fi
if [ "$(id -u)" != 0 ]; then
    if command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
        exec sudo -n sh "$here/install.sh" "$@"
    fi
    say "not root, and no sudo without a password, so not installed: $*"
    exit 4
fi

# Sources and lists of our own, which apt's unprivileged user must be able to read.
ours=$(mktemp -d)
trap 'rm -rf "$ours"' EXIT
trap 'exit 1' HUP INT TERM
chmod 755 "$ours"
mkdir -p "$ours/parts" "$ours/lists/partial"
eval "$(apt-config shell machine_main Dir::Etc::sourcelist/f machine_parts Dir::Etc::sourceparts/d)"
if [ -f "${machine_main:=/dev/null}" ]; then cp "$machine_main" "$ours/main.list"; else : >"$ours/main.list"; fi
for file in "${machine_parts:=/etc/apt/sources.list.d}"/*.list "$machine_parts"/*.sources; do
    if [ -f "$file" ]; then cp "$file" "$ours/parts/"; fi
done

# apt TOOL ARGUMENT...: on our sources and lists; waits for another apt to end; never asks.
apt() {
    tool=$1
    shift
    DEBIAN_FRONTEND=noninteractive LC_ALL=C "$tool" \
        -o Dir::Etc::SourceList="$ours/main.list" -o Dir::Etc::SourceParts="$ours/parts" \
        -o Dir::State::Lists="$ours/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= \
        -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 -o Acquire::http::Timeout=30 \
        "$@" </dev/null
}

# driver_version Installed|Candidate [OPTION...]
driver_version() {
    field=$1
    shift
    apt apt-cache "$@" policy "$driver" 2>/dev/null | sed -n "s/^  $field: //p"
}

# add_backports RELEASE DISTRIBUTION: makes them known to apt, unless the sources have them or the mirror has none.
add_backports() {
    # shellcheck disable=SC2046 # apt takes no file names with blanks in them
    awk -v release="$1" -v distribution="$2" -f "$here/backports.awk" \
        "$ours/main.list" $(find "$ours/parts" -type f | sort) >"$ours/entry"
    [ -s "$ours/entry" ] || return 0
    added=$ours/parts/added-backports.sources
    if grep -q '^deb ' "$ours/entry"; then added=${added%.sources}.list; fi
    cp "$ours/entry" "$added"
    apt apt-get update -qq >"$ours/log" 2>&1 || rm -f "$added"
}

if ! apt apt-get update -qq >"$ours/log" 2>&1; then
    cat "$ours/log" >&2
    say "this machine's mirrors could not be read, so not installed: $*"
    exit 1
fi

suite=
case " $* " in
    *" $driver "*)
        if [ "$(major "$(driver_version Candidate)")" -lt "$oldest_good" ]; then
            release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
            suite=$release-backports
            add_backports "$release" "$(. /etc/os-release && echo "${ID:-}")"
            newest=$(driver_version Candidate -o APT::Default-Release="$suite")
            if [ "$(major "$newest")" -lt "$oldest_good" ]; then
                suite=
                newest=$(driver_version Candidate)
                if [ "$(driver_version Installed)" = "$newest" ]; then
                    say "neither this release nor its backports have Mesa $oldest_good; $newest is installed, the newest"
                    exit 3
                fi
            fi
        fi
        ;;
esac

say "installing${suite:+ from $suite}: $*"
if ! apt apt-get install -y --no-remove --no-install-recommends -o Dpkg::Options::=--force-confold \
    ${suite:+-t "$suite"} "$@" >"$ours/log" 2>&1; then
    cat "$ours/log" >&2
    say "not installed: $*"
    exit 1
fi
