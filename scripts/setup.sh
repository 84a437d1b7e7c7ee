#!/bin/sh
# Makes a machine ready to build and run voxgi: scripts/setup.sh [--lints]
#
# Looks at what is there first: with a Rust that is new enough, C and C++ compilers and a good Vulkan device, nothing is
# installed, nothing is asked of the network, and no root is needed. Missing compilers or a missing device are installed
# where the machine has apt and this is root, or may become it by sudo without a password; without that, it carries on
# with the device that is there and says what that costs. --lints asks for rustfmt and clippy too.
#
# Exit codes: 0 ready, 1 voxgi can't be built here (the message says what is missing and how to get it).
set -eu
cd "$(dirname "$0")/.."
# shellcheck source=scripts/common.sh
. scripts/common.sh

stop() {
    say "$@"
    exit 1
}

# --- Rust ---
rust=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
get_rust="install Rust $rust or later from https://rustup.rs (as any user, without root), then run this again"
command -v cargo >/dev/null 2>&1 || stop "there is no cargo: $get_rust"
version=$(rustc --version 2>&1) || stop "rustc does not run ($version): $get_rust"
number=${version#rustc }
number=${number%%[!0-9.]*}
oldest=$(printf '%s\n' "$rust" "$number" | sort -V | head -n 1)
[ "$oldest" = "$rust" ] || stop "voxgi needs Rust $rust, and this is $number: run 'rustup update', or $get_rust"

if [ "${1:-}" = --lints ] && ! { cargo fmt --version && cargo clippy --version; } >/dev/null 2>&1; then
    command -v rustup >/dev/null 2>&1 || stop "rustfmt or clippy is missing: $get_rust"
    say "adding rustfmt and clippy to the Rust toolchain"
    rustup component add rustfmt clippy || stop "rustfmt and clippy could not be added by rustup"
fi

# --- Compilers: Rust links by the one for C, and a measure of error is the C++ of those who defined it ---
{ command -v cc && command -v c++; } >/dev/null 2>&1 || sh scripts/install.sh g++ libc6-dev ||
    stop "there is no C or no C++ compiler (cc, c++): install g++ and libc6-dev, then run this again"

# --- A device ---
good() {
    case $1 in
        gpu\ *) ;;
        software\ *) [ "$(major "${1#software }")" -ge "$oldest_good" ] ;;
        *) false ;;
    esac
}

# What an installation left as it was is not tried again until the device changes or the build folder goes.
tried=${CARGO_TARGET_DIR:-target}/set-up-tried
device=$(sh scripts/device.sh)
if ! good "$device" && [ "$(cat "$tried" 2>/dev/null)" != "$device" ]; then
    say "no good Vulkan device: $device"
    before=$device
    code=0
    sh scripts/install.sh libvulkan1 "$driver" || code=$?
    device=$(sh scripts/device.sh)
    if [ "$device" = "$before" ] && { [ $code = 0 ] || [ $code = 3 ]; }; then
        mkdir -p "${tried%/*}"
        echo "$device" >"$tried"
    fi
fi

say "Vulkan device: $device"
good "$device" || case $device in
    software\ *)
        say "carrying on with it; Mesa before $oldest_good gets GPU timestamps wrong, so stages are timed one at a time" \
            "on the wall clock: slower, and with the cost of submitting in each time"
        ;;
    *)
        say "carrying on without; voxgi builds, but nothing renders, and tests that render fail." \
            "The packages libvulkan1 and $driver (Mesa $oldest_good or later) bring a software device"
        ;;
esac
