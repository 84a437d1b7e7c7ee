#!/bin/sh
# Compares the pipelines on the built-in scenes: scripts/demo.sh VOXGI [OUT]
#
# VOXGI is the release binary; the comparison goes to OUT (default: out/demo), which is made anew. Each scene gets its
# reference, then every shipped pipeline that can be held against it is run, one of them at several settings. Says where
# the report is.
#
# Exit codes: 0 the report is there, otherwise those of voxgi.
set -eu
cd "$(dirname "$0")/.."
voxgi=$1
out=${2:-out/demo}

rm -rf "$out" # no picture of an earlier run passes for one of this
mkdir -p "$(dirname "$out")"
"$voxgi" compare scenes/*.glb -p cones -p cones,bounces=1 -p cones,hemisphere=hemisphere/spiral -p cones,resolution=32 \
    --size 192x192 --frames 3 --error 0.01 --out "$out" </dev/null
if ! [ -s "$out/index.html" ]; then
    echo "demo: there is no report in $out" >&2
    exit 1
fi
echo "demo: open $out/index.html"
