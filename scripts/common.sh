# Read (`.`) by the other scripts; runs nothing.
# shellcheck shell=sh

# The package with the software driver. Before Mesa 25 its GPU timestamps are wrong as soon as raster work is on the
# queue (compute reads as almost nothing, its time falls between the stages), so a software device older than
# that counts as none where a newer one can be had.
# shellcheck disable=SC2034 # used by the scripts that read this
driver=mesa-vulkan-drivers
# shellcheck disable=SC2034
oldest_good=25

say() { echo "set-up: $*" >&2; }

# The first number of a version, without a package's epoch; 0 for something that is none.
major() {
    set -- "${1#*:}"
    set -- "${1%%[!0-9]*}"
    echo "${1:-0}"
}
